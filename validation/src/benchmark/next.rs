//! Sets that leave several effects, told apart neither by what is named nor by what is below the noise, measured further:
//! under recommended conditions, under those of which the effects expect most different things, and under conditions
//! drawn from the same grid.

use configs::Model;
use diagnosis::diagnose::diagnose;
use diagnosis::fit::problem::{DEFAULT_SEED, FitProblem};
use diagnosis::next::{Next, Recommendation, recommend};
use diagnosis::observed::Observed;
use diagnosis::resistive::ResistiveForward;
use diagnosis::verdict::{Diagnosis, Verdict};
use measurements::{Condition, MeasurementSet};
use serde::{Deserialize, Serialize};

use super::chance::Chance;
use super::design::Design;
use super::forces::Setting;
use super::laboratory::{Nature, measure};
use super::plan::Plan;

/// Conditions that are added together.
const ADDED: usize = 2;

/// Runs of each of them.
const REPEATS: usize = 4;

/// Numbers of one stream lie closer together than this.
const STREAM: u64 = 1 << 52;

/// Whether the truth stands alone after `ADDED` more conditions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Resolved {
    /// The recommended ones.
    pub recommended: bool,
    /// Those with the largest difference of χ² between two effects that explain the set.
    pub spread: bool,
    /// As many that were drawn.
    pub drawn: bool,
}

/// Which of the feasible conditions are measured.
#[derive(Clone, Copy)]
enum Choice {
    Recommended,
    Spread,
    Drawn,
}

impl Resolved {
    /// Measures `set` further in the world of `plan`; none if nothing is recommended, because it leaves one effect or none.
    ///
    /// # Errors
    /// If a diagnosis fails, or a sphere does not stop.
    pub(super) fn of(
        plan: &Plan,
        nature: &Nature,
        set: &MeasurementSet,
        model: &Model,
    ) -> Result<Option<Self>, String> {
        let (_, Some(next)) = look(set, model)? else { return Ok(None) };
        let further = |choice: Choice| -> Result<bool, String> {
            let mut chance = Chance::new(plan.seed + STREAM * (1 + choice as u64));
            let mut set = set.clone();
            for there in chosen(choice, &next, &mut chance) {
                add(&mut set, there, (plan, nature), &mut chance)?;
            }
            Ok(is_right(plan, &look(&set, model)?.0))
        };
        Ok(Some(Self {
            recommended: further(Choice::Recommended)?,
            spread: further(Choice::Spread)?,
            drawn: further(Choice::Drawn)?,
        }))
    }
}

/// [`ADDED`] of the conditions of `next`. Where fewer are recommended, the others are the next best.
fn chosen<'a>(choice: Choice, next: &'a Next, chance: &mut Chance) -> Vec<&'a Recommendation> {
    let by = |of: fn(&Recommendation) -> f64| {
        let mut all: Vec<&Recommendation> = next.feasible.iter().collect();
        all.sort_by(|a, b| of(b).total_cmp(&of(a)));
        all
    };
    let mut order = match choice {
        Choice::Recommended => {
            let others = by(|one| one.expected_bits);
            let is_other = |one: &&&Recommendation| {
                next.best.iter().all(|best| best.condition.id != one.condition.id)
            };
            next.best.iter().chain(others.iter().filter(is_other).copied()).collect()
        }
        Choice::Spread => by(|one| one.expected_delta),
        Choice::Drawn => {
            let mut all: Vec<&Recommendation> = next.feasible.iter().collect();
            let n = all.len();
            for at in 0..n.min(ADDED) {
                all.swap(at, at + chance.below(n - at));
            }
            all
        }
    };
    order.truncate(ADDED);
    order
}

/// What a set says, and what could be measured next.
fn look(set: &MeasurementSet, model: &Model) -> Result<(Diagnosis, Option<Next>), String> {
    let observed = Observed::of(set);
    let forward = ResistiveForward::new(model, set, &observed.layouts())
        .map_err(|error| error.to_string())?;
    let problem = FitProblem { set, observed: &observed, forward: &forward };
    let mut diagnosis = diagnose(&problem, DEFAULT_SEED).map_err(|error| error.to_string())?;
    let next = recommend(&problem, model, &mut diagnosis);
    Ok((diagnosis, next))
}

fn is_right(plan: &Plan, diagnosis: &Diagnosis) -> bool {
    let hidden = |id: &String| plan.hidden.iter().any(|hidden| hidden.id() == id);
    diagnosis.verdict == Verdict::Supported && diagnosis.effects.iter().all(hidden)
}

/// Measures `next` and adds it to `set`, to be fitted to.
fn add(
    set: &mut MeasurementSet,
    next: &Recommendation,
    (plan, nature): (&Plan, &Nature),
    chance: &mut Chance,
) -> Result<(), String> {
    let setting = setting(&next.condition, &plan.design);
    let design =
        Design { settings: vec![setting], held_out: 0, repeats: REPEATS, ..plan.design.clone() };
    let measured = measure(&design, nature, chance).map_err(|error| error.to_string())?;
    let (at, last) = (set.conditions.len(), set.runs.len() as i64);
    set.conditions.extend(
        measured
            .conditions
            .into_iter()
            .map(|condition| Condition { id: format!("c{:02}", at + 1), ..condition }),
    );
    set.runs.extend(measured.runs.into_iter().map(|mut run| {
        run.name = format!("c{:02}-{}", at + 1, run.repeat.unwrap_or(0));
        run.condition = at;
        run.order = run.order.map(|order| last + order);
        run
    }));
    Ok(())
}

/// `condition` as the world takes it; every condition of a benchmark has a packing and a depth.
fn setting(condition: &Condition, design: &Design) -> Setting {
    let like = design.settings[0];
    Setting {
        speed: condition.speed,
        angle_deg: condition.angle_deg,
        mass: condition.mass,
        diameter: condition.diameter,
        spin: condition.spin,
        packing: condition.packing.unwrap_or(like.packing),
        bed_depth: condition.bed_depth.unwrap_or(like.bed_depth),
    }
}
