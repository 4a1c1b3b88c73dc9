//! Accelerometers in spheres that fall into a medium of a known law: their readings have closed forms, and name what
//! is hidden.

use measurements::{Instrument, Kind, MeasurementSet};
use resistive::{Accelerometer, Impact};

use super::rig::{BED, MASS, law, sphere};
use super::sets::{self, Reader, Wrong};

#[test]
fn a_constant_resistance_is_read_as_its_deceleration_and_rest_as_gravity() {
    let resistance = 3.0;
    let laws = || vec![law("poncelet", &[("inertial", 0.0), ("resistance", resistance)])];
    let impact = sphere(laws(), 1.0, 90.0);
    let stop = 1.0 / (resistance / MASS - BED.gravity);
    let times = [0.2 * stop, 0.7 * stop, 0.99 * stop, 1.5 * stop];
    let mut seen = Accelerometer::at(&times, BED.gravity);
    impact.run(10.0, &mut seen).expect("it stops");
    let expected = [resistance / MASS, resistance / MASS, resistance / MASS, BED.gravity];
    for (found, expected) in seen.into_readings().iter().zip(expected) {
        // Round-off of a sum of numbers near 50.
        assert!((found - expected).abs() < 1e-12 * expected, "{found} {expected}");
    }
    let falling = impact.felt_in_flight(&[-1e-3, -0.02]).expect("a fall");
    assert!(falling.iter().all(|felt| felt.abs() < 1e-13), "{falling:?}");
}

#[test]
fn what_is_read_adds_up_to_the_speed_that_is_lost() {
    let laws = vec![law("two-term-vector", &[("drag", 1.2), ("friction", 18.0)])];
    let impact = sphere(laws, 2.0, 90.0);
    let n = 40_000;
    let times: Vec<f64> = (0..=n).map(|k| 0.2 * f64::from(k) / f64::from(n)).collect();
    let mut seen = Accelerometer::at(&times, BED.gravity);
    let ending = impact.run(10.0, &mut seen).expect("it stops");
    assert!(ending.time < 0.2);
    let readings = seen.into_readings();
    let lost: f64 = readings
        .windows(2)
        .zip(times.windows(2))
        .map(|(felt, time)| (time[1] - time[0]) * (0.5 * (felt[0] + felt[1]) - BED.gravity))
        .sum();
    // The trapezoidal rule over a jump of 100 m/s² at the stop is off by half a step of it.
    assert!((lost - 2.0).abs() < 1e-3, "{lost} m/s");
}

/// What an accelerometer of an error of 0.2 m/s² reads of `impact` at rising times (s).
fn felt(impact: &Impact, times: &[f64]) -> Vec<f64> {
    let (before, after) = times.split_at(times.partition_point(|&time| time < 0.0));
    let backward: Vec<f64> = before.iter().rev().copied().collect();
    let mut readings = impact.felt_in_flight(&backward).expect("a fall");
    readings.reverse();
    let mut seen = Accelerometer::at(after, BED.gravity);
    impact.run(10.0, &mut seen).expect("it stops");
    readings.extend(seen.into_readings());
    readings
}

fn measured(hidden: Option<(&str, f64)>, seed: u64) -> MeasurementSet {
    let reader = Reader { kind: Kind::Acceleration, error: 0.2, read: felt };
    let instrument = Instrument { acceleration_sigma: Some(reader.error), ..sets::INSTRUMENT };
    sets::read_over_time("accelerometers", (&reader, instrument), hidden, (seed, 11))
}

#[test]
fn a_hidden_effect_is_named_by_accelerations_with_its_amplitude() {
    sets::assert_hidden_effects_are_named(measured);
}

#[test]
fn accelerations_of_the_model_itself_show_nothing() {
    sets::assert_the_model_shows_nothing(measured);
}

#[test]
fn a_set_of_accelerations_that_is_written_is_read_back() {
    let set = measured(None, 3);
    assert_eq!(sets::read_back(&set), Ok(set));
}

#[test]
fn wrong_signs_zeros_and_units_of_accelerations_are_refused() {
    let cases: &[Wrong] = &[
        (|one| one.value = -one.value, "the acceleration is negative where it is largest"),
        (|one| one.value -= BED.gravity, "those of a body in free fall are 0"),
        (|one| one.value *= 9.8, "times the speed at contact away"),
        (|one| one.value /= BED.gravity, "at rest the readings are 1 m/s^2"),
        (|one| one.value = one.value.min(2.0 * BED.gravity), "have a flat top"),
        (|one| one.at = -one.at, "the time does not go on"),
        (|one| one.at += 0.3, "t = 0 is not first contact"),
    ];
    sets::assert_refused(measured, cases);
}
