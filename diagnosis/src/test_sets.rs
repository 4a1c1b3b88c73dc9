//! Small measurement sets for the tests of this crate.

use measurements::{
    Bed, Condition, Frame, Geometry, Instrument, Kind, MeasurementSet, Run, StopDefinition,
};

/// A sphere of an inch at `speed` (m/s) and `angle_deg` (deg), to be fitted to.
pub(crate) fn condition(speed: f64, angle_deg: f64) -> Condition {
    Condition {
        angle_deg,
        ..Condition::straight_down(
            format!("{speed} m/s at {angle_deg}"),
            ("sphere", 0.0254, 0.0667),
            speed,
        )
    }
}

/// A run with a stopping time (s), final depth (m) and final range (m).
pub(crate) fn scalar_run(condition: usize, [stop_time, final_z, final_x]: [Option<f64>; 3]) -> Run {
    let name = format!("run {condition}");
    let frames = Vec::new();
    Run { stop_time, final_z, final_x, frames, ..Run::new(name, condition) }
}

/// A run at 500 Hz from 0.05 s before first contact to 0.5 s after it.
pub(crate) fn trajectory_run(condition: usize, path: impl Fn(f64) -> (f64, f64)) -> Run {
    let frame = |k: i32| {
        let t = f64::from(k) / 500.0;
        let (z, x) = path(t);
        Frame { t, z, x, sigma: None }
    };
    Run { frames: (-25..250).map(frame).collect(), ..scalar_run(condition, [None; 3]) }
}

/// A set of these, with a camera of 0.1 mm.
pub(crate) fn set(kind: Kind, conditions: Vec<Condition>, runs: Vec<Run>) -> MeasurementSet {
    MeasurementSet {
        instrument: Instrument {
            rate: Some(500.0),
            position_sigma: Some(1e-4),
            speed_sigma_rel: Some(0.01),
            level_sigma: Some(2e-4),
            ..Instrument::default()
        },
        stop: StopDefinition::SpeedFivePercent,
        runs,
        ..MeasurementSet::new(
            "test",
            kind,
            Bed { grain_diameter: Some(8e-4), ..Bed::new(Geometry::Spatial, Some(1480.0), 9.81) },
            conditions,
        )
    }
}
