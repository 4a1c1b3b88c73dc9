//! Velocities of spheres over time: what they tell without any position.

use measurements::{Instrument, Kind, MeasurementSet};
use resistive::{Impact, State, Trajectory};

use super::rig::{BED, MASS, law, sphere};
use super::sets::{self, Reader, Wrong};

/// Downward velocities (m/s) of `impact` at rising times (s).
fn velocities(impact: &Impact, times: &[f64]) -> Vec<f64> {
    let (before, after) = times.split_at(times.partition_point(|&time| time < 0.0));
    let falling = |state: &State| -impact.assembly().part(0, state).tip_velocity.z;
    let speed = falling(impact.start());
    let mut seen = Trajectory::at(after);
    impact.run(10.0, &mut seen).expect("it stops");
    let moving = seen.states().iter().map(falling);
    before.iter().map(|time| speed + BED.gravity * time).chain(moving).collect()
}

const VELOCIMETER: Reader = Reader { kind: Kind::Velocity, error: 2e-3, read: velocities };

fn measured(hidden: Option<(&str, f64)>, seed: u64) -> MeasurementSet {
    let instrument = Instrument { velocity_sigma: Some(VELOCIMETER.error), ..sets::INSTRUMENT };
    sets::read_over_time("velocimeters", (&VELOCIMETER, instrument), hidden, (seed, 12))
}

#[test]
fn a_hidden_effect_is_named_by_velocities_with_its_amplitude() {
    sets::assert_hidden_effects_are_named(measured);
}

#[test]
fn velocities_of_the_model_itself_show_nothing() {
    sets::assert_the_model_shows_nothing(measured);
}

#[test]
fn a_set_of_velocities_that_is_written_is_read_back() {
    let set = measured(None, 3);
    assert_eq!(sets::read_back(&set), Ok(set));
}

#[test]
fn speeds_that_a_set_leaves_out_are_read_from_the_velocities_before_contact() {
    let set = measured(None, 4);
    let folder = tempfile::tempdir().expect("a folder");
    set.write(folder.path()).expect("files");
    let path = folder.path().join("measurement.toml");
    let text = std::fs::read_to_string(&path).expect("a file");
    let without: Vec<&str> = text.lines().filter(|line| !line.starts_with("speed = ")).collect();
    assert_eq!(without.len() + set.conditions.len(), text.lines().count());
    std::fs::write(&path, without.join("\n")).expect("a file");
    let read = MeasurementSet::load(folder.path()).expect("a set").set;
    for (found, stated) in read.conditions.iter().zip(&set.conditions) {
        // Nine readings of four runs: four of their standard errors.
        let off = 4.0 * VELOCIMETER.error / 6.0;
        assert!((found.speed - stated.speed).abs() < off, "{} {}", found.speed, stated.speed);
    }
}

#[test]
fn wrong_signs_units_and_times_of_velocities_are_refused() {
    let cases: &[Wrong] = &[
        (|one| one.value = -one.value, "the velocity is negative where it is largest"),
        (|one| one.value *= 100.0, "times as fast as in a fall"),
        (|one| one.at *= 1000.0, "times as slowly as in a fall"),
        (
            |one| one.value *= if one.at < 0.0 { 1.0 } else { 100.0 },
            "times those of the stated speed",
        ),
        (|one| one.at = -one.at, "the time does not go on"),
        (|one| one.at += 0.02, "leave free fall at about t = 0.02"),
        (|one| one.at -= 0.02, "leave free fall at about t = -0.0"),
    ];
    sets::assert_refused(measured, cases);
}

#[test]
fn a_velocity_falls_by_what_a_constant_resistance_takes() {
    let resistance = 3.0;
    let laws = vec![law("poncelet", &[("inertial", 0.0), ("resistance", resistance)])];
    let read = velocities(&sphere(laws, 1.0, 90.0), &[-0.01, 0.0, 0.01]);
    let expected = [1.0 - 0.01 * BED.gravity, 1.0, 1.0 - 0.01 * (resistance / MASS - BED.gravity)];
    for (found, expected) in read.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    }
}
