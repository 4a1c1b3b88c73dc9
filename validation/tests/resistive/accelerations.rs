//! Accelerometers in spheres that fall into a medium of a known law: their readings have closed forms, and name what
//! is hidden.

use diagnosis::verdict::Verdict;
use measurements::{Condition, Instrument, Kind, MeasurementSet, Run, Sample, StopDefinition};
use rand_pcg::Pcg64;
use resistive::Accelerometer;

use super::rig::{BED, MASS, law, sphere};
use super::sets::{condition, diagnosed, normal, of_spheres};

/// Readings per second.
const RATE: f64 = 2000.0;

const REPEATS: usize = 4;

/// Error of a reading (m/s²), and scatter of the coefficients from run to run, relative.
const READING: f64 = 0.2;
const COEFFICIENTS: f64 = 0.02;

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

/// What an accelerometer reads of a fall into drag, friction and the effect `hidden`.
fn fall(speed: f64, hidden: Option<(&str, f64)>, random: &mut Pcg64) -> Vec<Sample> {
    let [drag, friction] = [1.2, 18.0].map(|of| of * (1.0 + COEFFICIENTS * normal(random)));
    let mut laws = vec![law("two-term-vector", &[("drag", drag), ("friction", friction)])];
    laws.extend(hidden.map(|(name, q)| law(name, &[("q", q)])));
    let impact = sphere(laws, speed, 90.0);
    let times: Vec<f64> = (0..200).map(|k| f64::from(k) / RATE).collect();
    let mut seen = Accelerometer::at(&times, BED.gravity);
    impact.run(10.0, &mut seen).expect("it stops");
    let before = (1..10).rev().map(|k| (-f64::from(k) / RATE, 0.0));
    let all = before.chain(times.iter().copied().zip(seen.into_readings()));
    all.map(|(at, felt)| Sample { at, value: felt + READING * normal(random), sigma: None })
        .collect()
}

fn measured(hidden: Option<(&str, f64)>, seed: u64) -> MeasurementSet {
    let mut random = Pcg64::new(u128::from(seed), 11);
    let conditions: Vec<Condition> = [0.7, 1.2, 2.0, 3.2, 4.5].map(condition).into();
    let places = (0..conditions.len()).flat_map(|at| (0..REPEATS).map(move |repeat| (at, repeat)));
    let runs = places.map(|(at, repeat)| Run {
        name: format!("{at}-{repeat}"),
        condition: at,
        repeat: Some(repeat as i64),
        order: None,
        session: None,
        stop_time: None,
        final_z: None,
        final_x: None,
        frames: Vec::new(),
        samples: fall(conditions[at].speed, hidden, &mut random),
    });
    let runs = runs.collect();
    let instrument = Instrument {
        rate: Some(RATE),
        acceleration_sigma: Some(READING),
        speed_sigma_rel: Some(1e-3),
        speed_bias_sigma_rel: Some(2e-3),
        scale_sigma_rel: Some(2e-3),
        mass_sigma_rel: Some(1e-3),
        ..Instrument::default()
    };
    MeasurementSet {
        stop: StopDefinition::SpeedFivePercent,
        runs,
        ..of_spheres("accelerometers", (Kind::Acceleration, instrument), conditions)
    }
}

#[test]
fn a_hidden_effect_is_named_by_accelerations_with_its_amplitude() {
    for (name, hidden) in [("viscous-drag", 3.0), ("yield-stress", 3.0)] {
        let found = diagnosed(&measured(Some((name, hidden)), 1));
        assert_eq!(found.verdict, Verdict::Supported, "{name}: {:?}", found.unexplained);
        assert_eq!(found.effects, [name]);
        let effect = found.ranking.iter().find(|one| one.id == name).expect("it is ranked");
        let (q, se) = (effect.q.expect("an amplitude"), effect.se.expect("an error"));
        // Four standard errors: chance takes one in fifteen thousand.
        assert!((q - hidden).abs() < 4.0 * se, "{name}: {q} ± {se}");
    }
}

#[test]
fn accelerations_of_the_model_itself_show_nothing() {
    let named = (0..4)
        .filter(|seed| diagnosed(&measured(None, 20 + seed)).verdict != Verdict::NothingDetected)
        .count();
    // Each set is rejected with a probability of 2 % at most: two of four happen once in four hundred.
    assert!(named <= 1, "{named} of 4");
}

#[test]
fn a_set_of_accelerations_that_is_written_is_read_back() {
    let set = measured(None, 3);
    let folder = tempfile::tempdir().expect("a folder");
    set.write(folder.path()).expect("files");
    let loaded = MeasurementSet::load(folder.path()).expect("a set");
    assert!(loaded.contradictions.is_empty(), "{:?}", loaded.contradictions);
    assert_eq!(MeasurementSet { notes: Vec::new(), ..loaded.set }, set);
}

#[test]
fn wrong_signs_zeros_and_units_of_accelerations_are_refused() {
    type Change = fn(&mut Sample);
    let cases: [(Change, &str); 4] = [
        (|one| one.value = -one.value, "the acceleration is negative where it is largest"),
        (|one| one.value -= BED.gravity, "those of a body in free fall are 0"),
        (|one| one.value *= 9.8, "times the speed at contact away"),
        (|one| one.at = -one.at, "the time does not go on"),
    ];
    for (change, message) in cases {
        let mut set = measured(None, 5);
        set.runs.iter_mut().flat_map(|run| &mut run.samples).for_each(change);
        let folder = tempfile::tempdir().expect("a folder");
        set.write(folder.path()).expect("files");
        let told = match MeasurementSet::load(folder.path()) {
            Ok(loaded) => loaded
                .render_contradictions(&measurements::ContradictionKind::ALL, configs::Color::Off),
            Err(error) => error.to_string(),
        };
        assert!(told.contains(message), "{message}: {told}");
    }
}
