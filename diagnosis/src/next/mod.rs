//! Which conditions to measure next, so that effects are told apart that the set does not separate.
//!
//! The hypotheses are the effects that cannot be told apart and the two that follow them, each with its
//! likelihood. A condition is worth the information that its runs are expected to give about which of them holds
//! (`prospect`), for what they cost where the set says so. The conditions of a recommendation are chosen one after the other, each with those
//! before it, so the second tells what the first leaves open.

mod designs;
mod follow_up;
mod foreseen;
mod grid;
mod hypothesis;
mod prospect;

use measurements::{Condition, MeasurementSet};
use rayon::prelude::*;
use serde_json::{Value, json};
use statrs::distribution::{ContinuousCDF, Normal};

use crate::fit::problem::{DEFAULT_SEED, FitProblem};
use crate::forward::SEPARATE;
use crate::rounding::rounded;
use crate::verdict::{Diagnosis, Verdict};
pub use designs::Designs;
pub use follow_up::{FollowUp, NewRuns, Share, follow_up};
use foreseen::Foreseen;
use hypothesis::Hypothesis;
use prospect::{Prospect, entropy, information};

/// Most conditions that are recommended together.
const TOGETHER: usize = 3;

/// Fewest repeats that are recommended.
const REPEATS: usize = 3;

/// Effects that are ranked next to those that are not told apart, and are kept apart from them.
const FOLLOWERS: usize = 2;

/// What a condition has to add at least to what those before it tell (bits).
const TELLING: f64 = 0.05;

/// A condition that could be measured next.
#[derive(Clone, Debug, PartialEq)]
pub struct Recommendation {
    /// The condition.
    pub condition: Condition,
    /// The name of its bed, in a set of several.
    pub bed: Option<String>,
    /// Runs of it.
    pub repeats: usize,
    /// What it is expected to tell, together with those before it in a recommendation (bits).
    pub expected_bits: f64,
    /// The two effects between which it makes the largest difference.
    pub separates: [String; 2],
    /// Difference of χ² that it is expected to make between the two.
    pub expected_delta: f64,
    /// What it costs after those before it, in the unit of the set; none where the set says nothing of costs.
    pub cost: Option<f64>,
}

impl Recommendation {
    /// Probability that the two are told apart by it, if one of them is there.
    pub(crate) fn probability_separated(&self) -> f64 {
        let sd = 2.0 * self.expected_delta.sqrt();
        if sd > 0.0 { Normal::standard().cdf((self.expected_delta - SEPARATE) / sd) } else { 0.0 }
    }

    /// As JSON for a report; `open_bits` is what there is to be told.
    fn to_json(&self, open_bits: f64) -> Value {
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
            "bed": self.bed,
            "repeats": self.repeats,
            "cost": self.cost.map(rounded),
            "expected_bits": rounded(self.expected_bits),
            "open_bits": rounded(open_bits),
            "expected_delta": rounded(self.expected_delta),
            "probability_separated": rounded(self.probability_separated()),
            "separates": self.separates,
        })
    }
}

/// What could be measured next.
#[derive(Clone, Debug, PartialEq)]
pub struct Next {
    /// What is not known: the entropy of the effects that may be there (bits).
    pub open_bits: f64,
    /// The conditions to measure, in this order; none if no feasible one tells anything.
    pub best: Vec<Recommendation>,
    /// Every feasible condition that can be predicted, each judged alone, in the order of the grid.
    pub feasible: Vec<Recommendation>,
}

/// A feasible condition, and what hypotheses expect of it.
struct Feasible {
    alone: Recommendation,
    prospect: Prospect,
}

/// What to measure next, which `diagnosis` then carries; `None` unless `diagnosis` names several effects that it does not
/// tell apart, or would if they were above the noise. Equal input gives equal bytes.
pub fn recommend(
    problem: &FitProblem<'_>,
    designs: &dyn Designs,
    diagnosis: &mut Diagnosis,
) -> Option<Next> {
    let is_open = matches!(diagnosis.verdict, Verdict::NotSeparable | Verdict::BelowNoise);
    if !is_open || diagnosis.leaders.len() < 2 {
        return None;
    }
    let hypotheses = hypotheses(problem, diagnosis);
    let leader = hypotheses.first()?;
    let probabilities = probabilities(&hypotheses);
    let noise = &diagnosis.proposed.as_ref()?.noise;
    let repeats = repeats(problem);
    let options: Vec<Feasible> = grid::feasible(problem.set)
        .into_par_iter()
        .filter_map(|condition| {
            let foreseen = Foreseen::of(problem, designs, (condition, repeats), leader)?;
            let before = (foreseen.forward(), 0);
            let prospect = Prospect::of(before, foreseen.observed(), noise, &hypotheses)?;
            let expected_bits = information(&[&prospect], &probabilities, DEFAULT_SEED)?;
            let (expected_delta, [k, l]) = most_apart(&prospect, &hypotheses)?;
            let separates = [k, l].map(|at| hypotheses[at].name().to_owned());
            let condition = foreseen.condition().clone();
            let bed = condition.bed.and_then(|at| problem.set.beds.get(at));
            let bed = bed.map(|named| named.name.clone());
            let alone = Recommendation {
                condition,
                bed,
                repeats,
                expected_bits,
                separates,
                expected_delta,
                cost: None,
            };
            let cost = grid::cost(problem.set, &[], &alone);
            let alone = Recommendation { cost, ..alone };
            Some(Feasible { alone, prospect })
        })
        .collect();
    let next = Next {
        open_bits: entropy(&probabilities),
        best: together(problem.set, &options, &probabilities),
        feasible: options.into_iter().map(|one| one.alone).collect(),
    };
    diagnosis.next = next.best.iter().map(|one| one.to_json(next.open_bits)).collect();
    Some(next)
}

/// The conditions that tell most together for what they cost, found one after the other.
fn together(
    set: &MeasurementSet,
    options: &[Feasible],
    probabilities: &[f64],
) -> Vec<Recommendation> {
    let mut best: Vec<Recommendation> = Vec::new();
    let mut chosen: Vec<&Prospect> = Vec::new();
    while best.len() < TOGETHER {
        let told: Vec<f64> = options
            .par_iter()
            .map(|option| {
                let with: Vec<&Prospect> =
                    chosen.iter().copied().chain([&option.prospect]).collect();
                information(&with, probabilities, DEFAULT_SEED).unwrap_or(0.0)
            })
            .collect();
        let before = best.last().map_or(0.0, |one| one.expected_bits);
        let telling = told.iter().enumerate().filter(|(_, bits)| **bits - before >= TELLING);
        let worth = telling.map(|(at, &expected_bits)| {
            let cost = grid::cost(set, &best, &options[at].alone);
            let one = Recommendation { expected_bits, cost, ..options[at].alone.clone() };
            ((expected_bits - before) / cost.unwrap_or(1.0), at, one)
        });
        // Among equals the first of the grid.
        let worth: Vec<_> = worth.collect();
        let most = worth.into_iter().rev().max_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, at, one)) = most else { break };
        chosen.push(&options[at].prospect);
        best.push(one);
    }
    best
}

/// The two hypotheses that are furthest apart, of those that explain what was measured, and how far (a difference of χ²).
fn most_apart(prospect: &Prospect, hypotheses: &[Hypothesis]) -> Option<(f64, [usize; 2])> {
    let explaining: Vec<usize> =
        (0..hypotheses.len()).filter(|&at| hypotheses[at].explains()).collect();
    let pairs = explaining
        .iter()
        .enumerate()
        .flat_map(|(n, &k)| explaining[n + 1..].iter().map(move |&l| [k, l]));
    let apart = pairs.filter_map(|[k, l]| Some((prospect.delta(k, l)?, [k, l])));
    apart.max_by(|a, b| a.0.total_cmp(&b.0))
}

/// The effects that are not told apart, in the order of the ranking, and those that follow; the leader
/// first. One around whose fit the model cannot be integrated is left out.
fn hypotheses(problem: &FitProblem<'_>, diagnosis: &Diagnosis) -> Vec<Hypothesis> {
    let Some(proposed) = &diagnosis.proposed else { return Vec::new() };
    let best = diagnosis.ranking.first().and_then(|effect| effect.delta).unwrap_or(0.0);
    let is_named = |id: &String| diagnosis.leaders.contains(id);
    let ranked = || diagnosis.ranking.iter();
    let named = ranked().filter(|effect| is_named(&effect.id));
    let followers = ranked().filter(|effect| !is_named(&effect.id)).take(FOLLOWERS);
    named
        .chain(followers)
        .filter_map(|effect| {
            let which = (effect.point.as_ref()?, best - effect.delta?);
            Hypothesis::fitted(problem, &proposed.weights, which).ok()
        })
        .collect()
}

/// Of hypotheses that are equally likely before anything is measured.
fn probabilities(hypotheses: &[Hypothesis]) -> Vec<f64> {
    let sum: f64 = hypotheses.iter().map(Hypothesis::likelihood).sum();
    hypotheses.iter().map(|one| one.likelihood() / sum).collect()
}

/// Runs of each condition of the set, at least [`REPEATS`]: the most common number, of the common ones
/// the largest.
fn repeats(problem: &FitProblem<'_>) -> usize {
    let runs = || problem.observed.fit.iter().map(|&at| problem.observed.conditions[at].runs.len());
    let common = runs().max_by_key(|&n| (runs().filter(|&other| other == n).count(), n));
    common.unwrap_or(0).max(REPEATS)
}
