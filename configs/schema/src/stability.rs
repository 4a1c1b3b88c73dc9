//! How fast contacts can change, and the time step that follows from it.

use engine::contact::Partner;

use crate::model::{BedSource, GrainModel, TimeStep};

/// Steps per shortest collision when `time_step = "auto"`.
pub const STEPS_PER_COLLISION: f64 = 30.0;
/// Steps per shortest relaxation by damping when `time_step = "auto"`. Half as many and a bed of
/// many contacts per grain never comes to rest: each contact's damping overshoots.
pub const STEPS_PER_DAMPING_TIME: f64 = 4.0;
/// Fewer steps per relaxation than this are refused.
pub const FEWEST_STEPS_PER_DAMPING_TIME: f64 = 1.0;
/// Fewer steps per relaxation than this are accepted with a warning.
pub const FEW_STEPS_PER_DAMPING_TIME: f64 = 3.0;
/// Fewer steps per collision than this are refused.
pub const FEWEST_STEPS_PER_COLLISION: f64 = 10.0;
/// Fewer steps per collision than this are accepted with a warning.
pub const FEW_STEPS_PER_COLLISION: f64 = 20.0;

/// The mass of the lightest grain (kg).
fn lightest_grain(model: GrainModel<'_>) -> f64 {
    let lightest = |masses: &mut dyn Iterator<Item = f64>| masses.fold(f64::INFINITY, f64::min);
    match &model.medium.bed.source {
        BedSource::Settle(settle) => {
            let mut masses =
                settle.grains.iter().filter(|kind| kind.count > 0).map(|kind| kind.mass);
            lightest(&mut masses)
        }
        BedSource::Csv(csv) => lightest(&mut csv.grains.iter().map(|grain| grain.mass)),
    }
}

/// How long the shortest collision of two grains lasts without damping, π √(m*/k_n) (s); `None`
/// for a law without a constant normal stiffness.
#[must_use]
pub fn grain_collision_time(model: GrainModel<'_>) -> Option<f64> {
    collision_time(model, 0.5 * lightest_grain(model))
}

/// How long the shortest collision of the run lasts, the intruder's included (s).
#[must_use]
pub fn shortest_collision_time(model: GrainModel<'_>) -> Option<f64> {
    let (grain, intruder) = (lightest_grain(model), model.model.intruder.mass);
    // Written so that a tiny mass cannot underflow in a product.
    let with_intruder = grain / (1.0 + grain / intruder);
    collision_time(model, with_intruder.min(0.5 * grain))
}

fn collision_time(model: GrainModel<'_>, mass_eff: f64) -> Option<f64> {
    let law = &model.medium.contact_law;
    (law.entry.build)(&law.params).collision_time(Partner::Grain, mass_eff)
}

/// In how short a time damping stops the relative motion of two grains (s), if the law has any.
#[must_use]
pub fn damping_time(model: GrainModel<'_>) -> Option<f64> {
    let law = &model.medium.contact_law;
    (law.entry.build)(&law.params).damping_time(Partner::Grain)
}

/// The automatic step (s), when the shortest collision lasts `collision` (s).
fn automatic(model: GrainModel<'_>, collision: f64) -> f64 {
    let relaxation = damping_time(model).unwrap_or(f64::INFINITY);
    (collision / STEPS_PER_COLLISION).min(relaxation / STEPS_PER_DAMPING_TIME)
}

/// The step of the run, its factor included (s); `None` when it is automatic and the law has no
/// constant normal stiffness.
#[must_use]
pub fn time_step(model: GrainModel<'_>) -> Option<f64> {
    let step = match model.medium.stepping.time_step {
        TimeStep::Fixed(step) => step,
        TimeStep::Auto => automatic(model, shortest_collision_time(model)?),
    };
    Some(step * model.medium.stepping.time_step_factor)
}

/// The step while the bed settles (s); `None` as for [`time_step`], and for a bed from a file.
#[must_use]
pub fn preparation_time_step(model: GrainModel<'_>) -> Option<f64> {
    let BedSource::Settle(settle) = &model.medium.bed.source else {
        return None;
    };
    match settle.preparation_time_step {
        TimeStep::Fixed(step) => Some(step),
        TimeStep::Auto => Some(automatic(model, grain_collision_time(model)?)),
    }
}
