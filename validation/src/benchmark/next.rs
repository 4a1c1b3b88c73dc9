//! Sets that leave several effects, measured further: under recommended conditions, and under conditions
//! drawn from the same grid.

use configs::Model;
use diagnosis::bench::{Bench, DEFAULT_SEED};
use diagnosis::diagnose::diagnose;
use diagnosis::next::{Recommendation, judged};
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

/// Conditions that are added, one after the other.
const ADDED: usize = 2;

/// Numbers of one stream lie closer together than this.
const STREAM: u64 = 1 << 52;

/// Whether the truth stands alone after one more condition, and after two.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Resolved {
    /// By the recommended ones.
    pub recommended: [bool; ADDED],
    /// By as many that were drawn.
    pub drawn: [bool; ADDED],
}

/// Which of the feasible conditions is measured.
#[derive(Clone, Copy)]
enum Choice {
    Recommended,
    Drawn,
}

impl Resolved {
    /// Measures `set` further in the world of `plan`; none if it leaves not several effects.
    ///
    /// # Errors
    /// If a diagnosis fails, or a sphere does not stop.
    pub(super) fn of(
        plan: &Plan,
        nature: &Nature,
        set: &MeasurementSet,
        model: &Model,
    ) -> Result<Option<Self>, String> {
        let first = Look::at(set, model)?;
        if first.diagnosis.verdict != Verdict::NotSeparable {
            return Ok(None);
        }
        let further = |choice: Choice| -> Result<[bool; ADDED], String> {
            let (mut set, mut resolved) = (set.clone(), [false; ADDED]);
            let mut later = None;
            for (step, resolved) in resolved.iter_mut().enumerate() {
                let look = later.as_ref().unwrap_or(&first);
                let stream = 1 + ADDED * choice as usize + step;
                let mut chance = Chance::new(plan.seed + STREAM * stream as u64);
                let there = match choice {
                    Choice::Recommended => look.grid.first(),
                    Choice::Drawn => look.grid.get(chance.below(look.grid.len())),
                };
                // Nothing is recommended where nothing is left to be told apart.
                if let Some(there) = there {
                    add(&mut set, there, (plan, nature), &mut chance)?;
                    later = Some(Look::at(&set, model)?);
                }
                let diagnosis = &later.as_ref().unwrap_or(&first).diagnosis;
                *resolved = is_right(plan, diagnosis);
            }
            Ok(resolved)
        };
        let (recommended, drawn) = (further(Choice::Recommended)?, further(Choice::Drawn)?);
        Ok(Some(Self { recommended, drawn }))
    }
}

/// What a set says, and what could be measured next.
struct Look {
    diagnosis: Diagnosis,
    grid: Vec<Recommendation>,
}

impl Look {
    fn at(set: &MeasurementSet, model: &Model) -> Result<Self, String> {
        let observed = Observed::of(set);
        let forward = ResistiveForward::new(model, set, &observed.layouts())
            .map_err(|error| error.to_string())?;
        let bench = Bench { set, observed: &observed, forward: &forward };
        let diagnosis = diagnose(&bench, DEFAULT_SEED).map_err(|error| error.to_string())?;
        let grid = judged(&bench, model, &diagnosis);
        Ok(Self { diagnosis, grid })
    }
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
    let design = Design {
        settings: vec![setting],
        held_out: 0,
        repeats: next.repeats,
        ..plan.design.clone()
    };
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
