//! Angular velocities of links, as a gyroscope reads them: what they tell without any position.

use diagnosis::observed::Observed;
use diagnosis::verdict::Verdict;
use engine::grains::Space;
use engine::math::Vec3;
use engine::params::ParamTable;
use intruders::AssemblyRequest;
use measurements::{Condition, Instrument, Kind, MeasurementSet, Run, Sample, StopDefinition};
use rand_pcg::Pcg64;
use resistive::{Impact, State, Trajectory};

use super::rig::{BED, law};
use super::sets::{self, diagnosed_from, of_spheres};
use validation::benchmark::chance::normal;

const LENGTH: f64 = 0.15;
const DIAMETER: f64 = 6.35e-3;
const MASS: f64 = 0.037;
const RATE: f64 = 1000.0;

/// Standard deviation of a reading (rad/s).
const READING: f64 = 0.05;

/// Coefficients of the law of the bed.
const COEFFICIENTS: [(&str, f64); 3] = [("drag", 3.6), ("horizontal", 6.0), ("plunging", 8.0)];

fn condition(speed: f64, link_angle: f64) -> Condition {
    Condition {
        id: format!("v{speed}-a{link_angle}"),
        shape: "link".into(),
        diameter: DIAMETER,
        mass: MASS,
        length: Some(LENGTH),
        link_angle_deg: Some(link_angle),
        ..sets::condition(speed)
    }
}

fn link(condition: &Condition, factor: f64) -> Impact {
    let mut params = ParamTable::new();
    let angle = condition.link_angle_deg.expect("an angle").to_radians();
    for (key, value) in [("length", LENGTH), ("diameter", DIAMETER), ("link_angle", angle)] {
        params.set(key, value);
    }
    let velocity = Vec3::new(0.0, 0.0, -condition.speed);
    let casting =
        AssemblyRequest { params: &params, space: Space::Spatial, mass: MASS, velocity, spin: 0.0 };
    let made = (intruders::find("link").expect("the link is registered").assembly)(&casting);
    let values = COEFFICIENTS.map(|(key, value)| (key, factor * value));
    Impact::new(made.assembly, vec![law("link", &values)], BED, made.start)
}

/// The angular velocities (rad/s) of a link at `times` (s) from contact on.
fn spins(impact: &Impact, times: &[f64]) -> Vec<f64> {
    let mut seen = Trajectory::at(times);
    impact.run(10.0, &mut seen).expect("it stops");
    let spin = |state: &State| impact.assembly().part(0, state).spin;
    seen.states().iter().map(spin).collect()
}

fn measured() -> MeasurementSet {
    let mut random = Pcg64::new(7, 13);
    let conditions: Vec<Condition> =
        [(1.0, 20.0), (2.0, 20.0), (3.0, 20.0), (1.0, 40.0), (2.0, 40.0), (3.0, 40.0)]
            .map(|(speed, angle)| condition(speed, angle))
            .into();
    let times: Vec<f64> = (0..120).map(|k| f64::from(k) / RATE).collect();
    let mut runs = Vec::new();
    for (at, condition) in conditions.iter().enumerate() {
        for repeat in 0..4 {
            let read = spins(&link(condition, 1.0 + 0.02 * normal(&mut random)), &times);
            let mut sample = |(&at, value): (&f64, f64)| Sample {
                at,
                value: value + READING * normal(&mut random),
                sigma: None,
            };
            runs.push(Run {
                repeat: Some(repeat),
                samples: times.iter().zip(read).map(&mut sample).collect(),
                ..Run::new(format!("{at}-{repeat}"), at)
            });
        }
    }
    let instrument = Instrument { rate: Some(RATE), spin_sigma: Some(READING), ..sets::INSTRUMENT };
    MeasurementSet {
        stop: StopDefinition::SpeedFivePercent,
        runs,
        ..of_spheres("gyroscopes", (Kind::Spin, instrument), conditions)
    }
}

#[test]
fn the_coefficients_of_a_link_are_found_from_its_angular_velocity_alone() {
    let set = measured();
    assert_eq!(sets::read_back(&set), Ok(set.clone()));
    let found = diagnosed_from("link", &set);
    assert_eq!(
        found.verdict,
        Verdict::NothingDetected,
        "{:?} {:?}",
        found.effects,
        found.unexplained
    );
    for (key, hidden) in COEFFICIENTS {
        let of = |part: &str| found.parameters[&format!("resistance.{key}")][part].as_f64();
        let (value, se) = (of("value").expect("a value"), of("se").expect("an error"));
        // Four standard errors: chance takes one in fifteen thousand.
        assert!((value - hidden).abs() < 4.0 * se, "{key}: {value} ± {se}, {hidden} hidden");
        assert!(se < 0.5 * hidden, "{key}: ± {se}");
    }
}

#[test]
fn spins_in_degrees_that_pass_for_radians_are_named() {
    let mut set = measured();
    let samples = set.runs.iter_mut().flat_map(|run| &mut run.samples);
    samples.for_each(|one| one.value = one.value.to_degrees());
    let told = sets::refusal(&set);
    assert!(told.contains("times as fast as its impact can make it"), "{told}");
}

#[test]
fn the_spin_of_a_body_that_a_force_law_does_not_turn_is_refused() {
    let mut set = measured();
    set.conditions.iter_mut().for_each(|condition| condition.shape = "sphere".into());
    let found = sets::forward_of("two-term-vector", &set, &Observed::of(&set));
    let told = found.map(|_| ()).expect_err("a sphere does not turn").to_string();
    assert!(told.contains("keeps the spin of a sphere"), "{told}");
}
