//! The observables that a set asks of an impact on a bed of grains.

use measurements::{Condition, FinalDefinition, MeasurementSet, StopDefinition, SurfaceDefinition};
use nalgebra::DVector;
use runner::beds::Record;

use crate::forward::observable::{Layout, Observable};

/// Depth and range (m) at `time` (s), as `set` counts depths: before contact those of the fall under `condition`, behind the
/// end the last ones.
pub fn at(record: &Record, time: f64, condition: &Condition, set: &MeasurementSet) -> (f64, f64) {
    let at_contact = depth_at_contact(record, set);
    if time < 0.0 {
        let (sine, cosine) = libm::sincos(condition.angle_deg.to_radians());
        let down = condition.speed * sine * time + 0.5 * set.fall_of(condition) * time * time;
        return (at_contact + down, condition.speed * cosine * time);
    }
    let (depth, range) = record.since_contact(time);
    (at_contact + depth, range)
}

/// Depth (m) at first contact, which is with grains above the mean surface.
pub fn depth_at_contact(record: &Record, set: &MeasurementSet) -> f64 {
    match set.surface {
        SurfaceDefinition::FirstContact => 0.0,
        SurfaceDefinition::Mean => -record.contact_height,
    }
}

/// The observables that `layout` asks for, as `set` defines them.
pub fn observables(
    record: &Record,
    layout: &Layout,
    condition: &Condition,
    set: &MeasurementSet,
) -> DVector<f64> {
    let at_contact = depth_at_contact(record, set);
    let frames: Vec<(f64, f64)> =
        layout.times.iter().map(|&time| at(record, time, condition, set)).collect();
    let mut numbers: Vec<f64> = frames.iter().map(|(depth, _)| *depth).collect();
    if layout.along_x {
        numbers.extend(frames.iter().map(|(_, range)| *range));
    }
    if let Some(curve) = &layout.curve {
        numbers.extend(curve.at.iter().map(|&depth| record.force_at(depth - at_contact)));
    }
    let stop = match set.stop {
        StopDefinition::ComponentZero => record.stopping_time,
        StopDefinition::SpeedFivePercent => record.slow_time,
    };
    let (depth, range) = match set.last {
        FinalDefinition::Deepest => (at_contact + record.deepest, record.reached),
        FinalDefinition::Resting => at(record, record.end, condition, set),
    };
    // A bed that is flat to its walls has a crater of no size.
    let [crater_depth, rim_diameter] = record.crater.unwrap_or_default();
    numbers.extend(layout.scalars().map(|kind| match kind {
        Observable::StopTime => stop.unwrap_or(record.end),
        Observable::FinalRange => range,
        Observable::CraterDepth => crater_depth,
        Observable::RimDiameter => rim_diameter,
        _ => depth,
    }));
    DVector::from_vec(numbers)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::forward::observable::Curve;
    use crate::test_sets::{condition, set};
    use measurements::Kind;

    fn record() -> Record {
        Record {
            interval: 0.01,
            contact_height: 0.002,
            depth: vec![0.0, 0.01, 0.018],
            range: vec![0.0, 0.005, 0.006],
            force: vec![0.0, 2.0, 3.0],
            stopping_time: Some(0.019),
            slow_time: Some(0.017),
            deepest: 0.0181,
            reached: 0.0061,
            end: 0.03,
            crater: None,
            impact_energy: 1.0,
            closure: 0.0,
            ledger: vec![("dissipated_sliding_J".into(), 0.4), ("elastic_spring_J".into(), 0.1)],
            grains: 1,
            steps: 1,
            wall: 0.0,
        }
    }

    // Sums and products of a few rounded decimals.
    fn is_close(found: (f64, f64), expected: (f64, f64)) -> bool {
        (found.0 - expected.0).abs() < 1e-15 && (found.1 - expected.1).abs() < 1e-15
    }

    #[test]
    fn a_path_is_linear_between_samples_free_before_contact_and_still_at_the_end() {
        let (record, condition) = (record(), condition(1.0, 90.0));
        let set = set(Kind::Trajectory, vec![condition.clone()], Vec::new());
        assert!(is_close(at(&record, 0.015, &condition, &set), (0.014, 0.0055)));
        assert!(is_close(at(&record, 1.0, &condition, &set), (0.018, 0.006)));
        let flight = at(&record, -0.1, &condition, &set);
        let fallen = 0.1 - 0.5 * set.fall_of(&condition) * 0.01;
        assert!((flight.0 + fallen).abs() < 1e-15 && flight.1.abs() < 1e-16, "{flight:?}");
    }

    #[test]
    fn a_set_may_count_depths_from_the_mean_surface_above_which_grains_are_met() {
        let (record, condition) = (record(), condition(1.0, 90.0));
        let mut set = set(Kind::Trajectory, vec![condition.clone()], Vec::new());
        set.surface = SurfaceDefinition::Mean;
        assert!(is_close(at(&record, 0.0, &condition, &set), (-0.002, 0.0)));
        assert!(is_close(at(&record, 0.015, &condition, &set), (0.012, 0.0055)));
        set.last = FinalDefinition::Deepest;
        let layout = Layout { final_z: true, ..Layout::default() };
        let found = observables(&record, &layout, &condition, &set);
        assert!((found[0] - 0.0161).abs() < 1e-15, "{found}");
    }

    #[test]
    fn forces_are_linear_between_depths_nothing_above_the_bed_and_the_last_below() {
        let curve = Curve { observable: Observable::Force, at: vec![-0.001, 0.005, 0.014, 0.1] };
        let layout = Layout { curve: Some(curve), ..Layout::default() };
        let set = set(Kind::ForceDepth, vec![condition(0.05, 90.0)], Vec::new());
        let found = observables(&record(), &layout, &set.conditions[0], &set);
        // Quotients of a few rounded decimals.
        let expected = DVector::from_vec(vec![0.0, 1.0, 2.5, 3.0]);
        assert!((&found - expected).amax() < 1e-14, "{found}");
    }

    #[test]
    fn scalars_follow_the_definitions_of_the_set() {
        let condition = condition(1.0, 45.0);
        let mut set = set(Kind::Scalar, vec![condition.clone()], Vec::new());
        let layout = Layout { stop_time: true, final_z: true, final_x: true, ..Layout::default() };
        let found = observables(&record(), &layout, &condition, &set);
        assert_eq!(found.as_slice(), [0.017, 0.018, 0.006]);
        set.stop = StopDefinition::ComponentZero;
        set.last = FinalDefinition::Deepest;
        let found = observables(&record(), &layout, &condition, &set);
        assert_eq!(found.as_slice(), [0.019, 0.0181, 0.0061]);
        assert_eq!(record().dissipated().collect::<Vec<_>>(), [("sliding", 0.4)]);
    }
}
