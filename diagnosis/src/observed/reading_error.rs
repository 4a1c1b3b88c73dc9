//! The error of one reading of each observable, as the instrument states it or as it is known.

use measurements::{Condition, Instrument, MeasurementSet, StatedError};
use nalgebra::DVector;
use runner::beds::STOPPED;

use crate::forward::observable::{Layout, Observable};
use crate::observed::curves;

/// Error that a reading of a position is credited with where the set states none (m).
pub(crate) const UNSTATED: f64 = 1e-4;

/// Least error that a stated one counts as (m): below, predictions are no better, since derivatives of impacts that
/// are integrated to some 1e-9 m are differences. A note says where a set states less.
pub(crate) const LEAST: f64 = 1e-6;

/// Root mean square error of one reading of a position (m) by `instrument`.
pub(crate) fn position_error(instrument: &Instrument) -> f64 {
    instrument.position_sigma.map_or(UNSTATED, counted)
}

/// What a stated error of a reading counts as (m).
pub(crate) fn counted(stated: f64) -> f64 {
    stated.max(LEAST)
}

/// Least error of readings that repeats may show (m): what a set states better is not doubted, what it states worse
/// may be as good as where nothing is stated.
pub(crate) fn least_position_error(instrument: &Instrument) -> f64 {
    position_error(instrument).min(UNSTATED)
}

/// Standard deviation of one reading of each number of `layout`, where frames and readings of a curve may state their
/// own; empty where none does.
pub(crate) fn reading(
    set: &MeasurementSet,
    layout: &Layout,
    condition: &Condition,
    [frames, places]: [&[Option<f64>]; 2],
) -> DVector<f64> {
    let of_curve = set.kind.curve().map_or(0.0, |curve| curves::reading_error(set, curve));
    let position = position_error(&set.instrument);
    // A stop is seen to a frame; without a rate, to the time in which the intruder, at the speed that
    // counts as stopped, moves by the error of a reading.
    let own_speed = (set.bed_of(condition).gravity * condition.diameter).sqrt();
    let time =
        set.instrument.rate.map_or(position / (STOPPED * condition.speed.max(own_speed)), |rate| {
            1.0 / (rate * 12.0_f64.sqrt())
        });
    let own = |all: &[Option<f64>], at: usize| all.get(at).copied().flatten();
    let frame = |at: usize| own(frames, at).map_or(position, counted);
    let n = layout.times.len();
    let kinds = layout.kinds();
    let tracks = n * (1 + usize::from(layout.along_x));
    DVector::from_iterator(
        kinds.len(),
        kinds.iter().enumerate().map(|(at, kind)| match kind {
            Observable::Depth | Observable::Range => frame(at % n),
            Observable::Force
            | Observable::Acceleration
            | Observable::Velocity
            | Observable::Spin => own(places, at - tracks).unwrap_or(of_curve),
            Observable::StopTime => time,
            Observable::FinalDepth
            | Observable::FinalRange
            | Observable::CraterDepth
            | Observable::RimDiameter => position,
        }),
    )
}

/// Stated relative error of a number.
pub(crate) fn stated(stated: &StatedError, kind: Observable) -> Option<f64> {
    match kind {
        Observable::StopTime => stated.stop_time,
        Observable::Depth | Observable::FinalDepth => stated.final_z,
        Observable::Range | Observable::FinalRange => stated.final_x,
        _ => None,
    }
}
