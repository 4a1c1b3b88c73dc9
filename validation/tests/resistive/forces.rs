//! Plates that are pushed into a medium of a known law: the force over depth names what is hidden, and nothing else.

use std::f64::consts::FRAC_PI_4;

use configs::{LoadOptions, Model, ModelSource, find_shipped};
use diagnosis::diagnose::diagnose;
use diagnosis::fit::problem::{DEFAULT_SEED, FitProblem};
use diagnosis::forward::Forward;
use diagnosis::observed::Observed;
use diagnosis::resistive::ResistiveForward;
use diagnosis::verdict::added_force::Size;
use diagnosis::verdict::{Diagnosis, Status, Verdict};
use engine::grains::Space;
use engine::math::Vec3;
use engine::params::ParamTable;
use intruders::AssemblyRequest;
use measurements::{Bed, Condition, Geometry, Instrument, Kind, MeasurementSet, Run, Sample};
use rand_pcg::Pcg64;
use resistive::{Driven, Impact, Recorder};

use super::rig::{BED, law};
use validation::benchmark::chance::normal;

/// Sizes (m) and speeds (m/s) of the plates.
const DIAMETERS: [f64; 3] = [0.03, 0.045, 0.06];
const SPEEDS: [f64; 2] = [0.005, 0.02];

/// How deep they are pushed (m), and readings on the way.
const DEPTH: f64 = 0.05;
const READINGS: f64 = 100.0;

const REPEATS: usize = 5;

/// Error of a reading (N), scatter of the coefficients from run to run and of the force along the way, relative.
const READING: f64 = 0.02;
const COEFFICIENTS: f64 = 0.02;
const WAY: f64 = 0.03;

/// Nodes of the scatter along the way.
const NODES: usize = 6;

fn condition(diameter: f64, speed: f64) -> Condition {
    Condition {
        height: Some(0.01),
        shaft_diameter: Some(0.01),
        ..Condition::straight_down(
            format!("d{}-v{}", 1e3 * diameter, 1e3 * speed),
            ("cylinder", diameter, 0.0),
            speed,
        )
    }
}

/// What the solver's driven motion reads of a push against drag, friction and the effect `hidden`.
fn push(condition: &Condition, hidden: Option<(&str, f64)>, random: &mut Pcg64) -> Vec<Sample> {
    let mut params = ParamTable::new();
    for (key, value) in
        [("diameter", condition.diameter), ("height", 0.01), ("shaft_diameter", 0.01)]
    {
        params.set(key, value);
    }
    let velocity = Vec3::new(0.0, 0.0, -condition.speed);
    let casting =
        AssemblyRequest { params: &params, space: Space::Spatial, mass: 0.1, velocity, spin: 0.0 };
    let made = (intruders::find("cylinder").expect("a shape").assembly)(&casting);
    let friction = 18.0 * (1.0 + COEFFICIENTS * normal(random));
    let mut laws = vec![law("two-term-vector", &[("drag", 1.2), ("friction", friction)])];
    laws.extend(hidden.map(|(name, q)| law(name, &[("q", q)])));
    let impact = Impact::new(Box::new(Driven::new(made.assembly)), laws, BED, made.start);
    let way: Vec<f64> = (0..NODES).map(|_| 1.0 + WAY * normal(random)).collect();
    let mut samples = Vec::new();
    let duration = DEPTH / condition.speed;
    let mut recorder = Recorder::new(&impact, duration / READINGS, |sample| {
        let (part, force) = (&sample.parts[0], sample.parts[0].dynamic + sample.parts[0].friction);
        samples.push((part.part.immersion.depth, force.z));
    });
    impact.run(duration, &mut recorder).expect("a push");
    drop(recorder);
    let read = |(at, force): (f64, f64)| {
        let place = (at / DEPTH).clamp(0.0, 1.0) * (NODES - 1) as f64;
        let (below, share) = ((place as usize).min(NODES - 2), place.fract());
        let share = if place as usize > below { 1.0 } else { share };
        let factor = (1.0 - share) * way[below] + share * way[below + 1];
        Sample { at, value: force * factor + READING * normal(random), sigma: None }
    };
    samples.into_iter().map(read).collect()
}

fn measured(hidden: Option<(&str, f64)>, seed: u64) -> MeasurementSet {
    let mut random = Pcg64::new(u128::from(seed), 7);
    let conditions: Vec<Condition> = DIAMETERS
        .into_iter()
        .flat_map(|diameter| SPEEDS.map(|speed| condition(diameter, speed)))
        .collect();
    let places = (0..conditions.len()).flat_map(|at| (0..REPEATS).map(move |repeat| (at, repeat)));
    let runs = places.map(|(at, repeat)| Run {
        repeat: Some(repeat as i64),
        samples: push(&conditions[at], hidden, &mut random),
        ..Run::new(format!("{at}-{repeat}"), at)
    });
    let runs = runs.collect();
    MeasurementSet {
        instrument: Instrument {
            force_sigma: Some(READING),
            level_sigma: Some(1e-4),
            zero_sigma: Some(2e-4),
            ..Instrument::default()
        },
        runs,
        ..MeasurementSet::new(
            "plates",
            Kind::ForceDepth,
            Bed::new(Geometry::Spatial, Some(BED.bulk_density), BED.gravity),
            conditions,
        )
    }
}

fn before(set: &MeasurementSet, observed: &Observed, name: &str) -> ResistiveForward {
    let shipped = find_shipped(name).expect("a shipped model");
    let source = ModelSource::Text {
        name: format!("{name}.toml"),
        text: shipped.text.to_owned(),
        folder: ".".into(),
    };
    let model = Model::load(source, &LoadOptions::default()).expect("a model").model;
    ResistiveForward::new(&model, set, &observed.layouts()).expect("a model for plates")
}

fn diagnosed(set: &MeasurementSet) -> Diagnosis {
    diagnosed_by("two-term-vector", set)
}

fn diagnosed_by(model: &str, set: &MeasurementSet) -> Diagnosis {
    let observed = Observed::of(set);
    let forward = before(set, &observed, model);
    diagnose(&FitProblem { set, observed: &observed, forward: &forward }, DEFAULT_SEED)
        .expect("forces are finite")
}

#[test]
fn a_hidden_cohesion_is_named_by_forces_with_its_amplitude() {
    let hidden = 1.5;
    let found = diagnosed(&measured(Some(("yield-stress", hidden)), 1));
    assert_eq!(found.verdict, Verdict::Supported, "{:?}", found.unexplained);
    assert_eq!(found.effects, ["yield-stress"]);
    let effect = found.ranking.iter().find(|one| one.id == "yield-stress").expect("it is ranked");
    let (q, se) = (effect.q.expect("an amplitude"), effect.se.expect("an error"));
    // Four standard errors: chance takes one in fifteen thousand.
    assert!((q - hidden).abs() < 4.0 * se && se < 0.3 * hidden, "{q} ± {se}");
    // The data ask for no other form than that of the list: what is claimed is what is ranked.
    let claimed = &found.amplitudes[0];
    assert!(
        (claimed.q - q).abs() < se && claimed.se.is_some_and(|own| own < 1.5 * se),
        "{claimed:?}"
    );
    // A constant q ρ g A D, greatest on the widest plate.
    let added = found.amplitudes[0].force.as_ref().expect("cohesion is a force");
    let widest = DIAMETERS.into_iter().fold(0.0, f64::max);
    let constant = q * BED.bulk_density * BED.gravity * FRAC_PI_4 * widest.powi(3);
    let Size::AtAMoment { greatest, share_of_work } = added.size else {
        panic!("{added:?} is of a force law")
    };
    assert!((greatest / constant - 1.0).abs() < 0.1, "{added:?} {constant}");
    assert!(added.condition.starts_with("d60"), "{added:?}");
    assert!(added.of > greatest && (0.01..0.9).contains(&share_of_work), "{added:?}");
}

#[test]
fn a_hidden_power_of_depth_is_named_by_forces() {
    let found = diagnosed(&measured(Some(("depth-exponent", 0.3)), 2));
    assert_eq!(found.verdict, Verdict::Supported, "{:?}", found.unexplained);
    assert_eq!(found.effects, ["depth-exponent"]);
}

#[test]
fn depths_that_count_from_3_mm_too_high_are_told_as_such_and_name_no_effect() {
    for (off, seed) in [(0.003, 11), (-0.003, 12), (0.005, 13)] {
        let mut set = measured(None, seed);
        set.instrument = Instrument { force_sigma: Some(READING), ..Instrument::default() };
        set.runs.iter_mut().flat_map(|run| &mut run.samples).for_each(|one| one.at += off);
        let found = diagnosed_by("bekker", &set);
        assert!(found.effects.is_empty() && found.not_separable.is_empty(), "{off}: {found:?}");
        let zero = found.apparatus.iter().find(|error| error.id == "depth-zero").expect("a zero");
        assert!((zero.value.abs() - off.abs()).abs() < 5e-4, "{off}: {zero:?}");
    }
}

#[test]
fn forces_of_the_model_itself_show_nothing() {
    let named = (0..6)
        .filter(|seed| {
            let found = diagnosed(&measured(None, 10 + seed));
            assert!(found.ranking.iter().any(|one| one.status == Status::Ranked));
            found.verdict != Verdict::NothingDetected
        })
        .count();
    // Each set is rejected with a probability of 2 % at most: two of six happen once in two hundred.
    assert!(named <= 1, "{named} of 6");
}

#[test]
fn what_a_slow_push_cannot_show_is_not_tested() {
    let set = measured(None, 1);
    let observed = Observed::of(&set);
    let forward = before(&set, &observed, "two-term-vector");
    // Of 20 mm/s the drag is a hundred-thousandth of the force.
    assert_eq!(forward.idle(), ["resistance.drag"]);
    let candidates = forward.candidates();
    let is_tested = |id: &str| {
        let candidate = candidates.iter().find(|one| one.id == id).expect("it is listed");
        candidate.not_testable.is_none()
    };
    for (id, expected) in [("yield-stress", true), ("depth-exponent", true), ("added-mass", false)]
    {
        assert_eq!(is_tested(id), expected, "{id}");
    }
}

#[test]
fn a_set_of_forces_that_is_written_is_read_back() {
    let set = measured(None, 3);
    let folder = tempfile::tempdir().expect("a folder");
    set.write(folder.path()).expect("files");
    let loaded = MeasurementSet::load(folder.path()).expect("a set");
    assert!(loaded.contradictions.is_empty(), "{:?}", loaded.contradictions);
    assert_eq!(MeasurementSet { notes: Vec::new(), ..loaded.set }, set);
}
