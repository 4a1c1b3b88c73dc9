//! Which condition to measure next, so that effects are told apart that the set does not separate.
//!
//! Every feasible condition is held against the rivals: the effects that cannot be told apart, and the
//! two that follow them. Each rival predicts what would be measured, with the uncertainty of its fit;
//! a condition is worth as much as it separates the two of them that it separates least, one of which
//! explains what was measured (Hunter & Reiner 1965, Technometrics 7, 307; with the covariance of the predictions, Buzzi-Ferraris & Forzatti
//! 1983, Chem. Eng. Sci. 38, 225).

mod criterion;
mod designs;
mod foreseen;
mod grid;
mod rival;

use measurements::Condition;
use rayon::prelude::*;
use serde_json::{Value, json};
use statrs::distribution::{ContinuousCDF, Normal};

use crate::bench::Bench;
use crate::forward::SEPARATE;
use crate::rounding::rounded;
use crate::verdict::{Diagnosis, Verdict};
pub use designs::Designs;
use foreseen::Foreseen;
use rival::Rival;

/// How many recommendations a diagnosis carries.
const BEST: usize = 3;

/// Fewest repeats that are recommended.
const REPEATS: usize = 3;

/// Effects that are ranked next to those that are not told apart, and are kept apart from them.
const FOLLOWERS: usize = 2;

/// A condition that could be measured next.
#[derive(Clone, Debug, PartialEq)]
pub struct Recommendation {
    /// The condition.
    pub condition: Condition,
    /// Runs of it.
    pub repeats: usize,
    /// Least difference of χ² that it is expected to make between two rivals, if one of them is there.
    pub expected_delta: f64,
    /// The two rivals between which it makes that difference.
    pub separates: [String; 2],
}

impl Recommendation {
    /// Probability that the two are told apart by it, odds 20 to 1.
    #[must_use]
    pub fn probability_separated(&self) -> f64 {
        let sd = 2.0 * self.expected_delta.sqrt();
        if sd > 0.0 { Normal::standard().cdf((self.expected_delta - SEPARATE) / sd) } else { 0.0 }
    }

    /// Whether more is expected of it than what counts as told apart.
    #[must_use]
    pub fn is_enough(&self) -> bool {
        self.expected_delta >= SEPARATE
    }

    /// As JSON for a report.
    #[must_use]
    pub fn to_json(&self) -> Value {
        let condition = &self.condition;
        json!({
            "speed_m_per_s": rounded(condition.speed),
            "angle_deg": rounded(condition.angle_deg),
            "shape": condition.shape,
            "diameter_m": rounded(condition.diameter),
            "mass_kg": rounded(condition.mass),
            "spin_rad_per_s": rounded(condition.spin),
            "packing": condition.packing.map(rounded),
            "bed_depth_m": condition.bed_depth.map(rounded),
            "repeats": self.repeats,
            "expected_delta": rounded(self.expected_delta),
            "probability_separated": rounded(self.probability_separated()),
            "separates": self.separates,
        })
    }
}

/// Every feasible condition that can be predicted, best first; nothing unless `diagnosis` names
/// several effects that it does not tell apart, or would if they were above the noise. Equal input gives equal bytes.
pub fn judged(
    bench: &Bench<'_>,
    designs: &dyn Designs,
    diagnosis: &Diagnosis,
) -> Vec<Recommendation> {
    let is_open = matches!(diagnosis.verdict, Verdict::NotSeparable | Verdict::BelowNoise);
    let (true, Some(proposed)) = (is_open && diagnosis.leaders.len() > 1, &diagnosis.proposed)
    else {
        return Vec::new();
    };
    let rivals = rivals(bench, diagnosis);
    let Some(leader) = rivals.first() else { return Vec::new() };
    let repeats = repeats(bench);
    let noise = &proposed.noise;
    let mut judged: Vec<Recommendation> = grid::feasible(bench.set)
        .into_par_iter()
        .filter_map(|condition| {
            let foreseen = Foreseen::of(bench, designs, (condition, repeats), leader)?;
            let (delta, [k, l]) = criterion::least(&foreseen, noise, &rivals)?;
            let separates = [k, l].map(|at| rivals[at].id.clone());
            let condition = foreseen.condition().clone();
            Some(Recommendation { condition, repeats, expected_delta: delta, separates })
        })
        .collect();
    // Stable: among equals the order of the grid decides.
    judged.sort_by(|a, b| b.expected_delta.total_cmp(&a.expected_delta));
    judged
}

/// Puts the best of [`judged`] into `diagnosis`, and gives them.
pub fn recommend(
    bench: &Bench<'_>,
    designs: &dyn Designs,
    diagnosis: &mut Diagnosis,
) -> Vec<Recommendation> {
    let mut best = judged(bench, designs, diagnosis);
    best.truncate(BEST);
    diagnosis.next = best.iter().map(Recommendation::to_json).collect();
    best
}

/// The effects that are not told apart, in the order of the ranking, and those that follow; the leader
/// first. One around whose fit the model cannot be integrated is left out.
fn rivals(bench: &Bench<'_>, diagnosis: &Diagnosis) -> Vec<Rival> {
    let Some(proposed) = &diagnosis.proposed else { return Vec::new() };
    let best = diagnosis.ranking.first().and_then(|effect| effect.delta).unwrap_or(0.0);
    let is_named = |id: &String| diagnosis.leaders.contains(id);
    let ranked = || diagnosis.ranking.iter();
    let named = ranked().filter(|effect| is_named(&effect.id));
    let followers = ranked().filter(|effect| !is_named(&effect.id)).take(FOLLOWERS);
    named
        .chain(followers)
        .filter_map(|effect| {
            let behind = best - effect.delta?;
            Some(((effect.id.clone(), behind), effect.point.as_ref()?))
        })
        .filter_map(|(which, point)| Rival::fitted(bench, &proposed.weights, which, point).ok())
        .collect()
}

/// Runs of each condition of the set, at least [`REPEATS`]: the most common number, of the common ones
/// the largest.
fn repeats(bench: &Bench<'_>) -> usize {
    let runs = || bench.observed.fit.iter().map(|&at| bench.observed.conditions[at].runs.len());
    let common = runs().max_by_key(|&n| (runs().filter(|&other| other == n).count(), n));
    common.unwrap_or(0).max(REPEATS)
}
