//! Sets of a sphere that falls into the bed of the rig, and their diagnosis.

use configs::{LoadOptions, Model, ModelSource, find_shipped};
use diagnosis::diagnose::diagnose;
use diagnosis::fit::problem::{DEFAULT_SEED, FitProblem};
use diagnosis::observed::Observed;
use diagnosis::resistive::{ForwardError, ResistiveForward};
use diagnosis::verdict::{Diagnosis, Verdict};
use measurements::{
    Bed, Condition, ContradictionKind, Geometry, Instrument, Kind, MeasurementSet, Run, Sample,
    StopDefinition,
};
use rand_pcg::Pcg64;
use resistive::Impact;
use validation::benchmark::chance::normal;

use super::rig::{BED, DIAMETER, MASS, law, sphere};

/// Readings per second, falls per condition, and scatter of the coefficients from run to run, relative.
const RATE: f64 = 2000.0;
const REPEATS: usize = 4;
const COEFFICIENTS: f64 = 0.02;

/// How well all else is known where readings lie over time.
pub(crate) const INSTRUMENT: Instrument = Instrument {
    rate: Some(RATE),
    position_sigma: None,
    force_sigma: None,
    acceleration_sigma: None,
    velocity_sigma: None,
    spin_sigma: None,
    acceleration_range: None,
    speed_sigma_rel: Some(1e-3),
    level_sigma: None,
    time_sigma: None,
    zero_sigma: None,
    surface_sigma: None,
    speed_bias_sigma_rel: Some(2e-3),
    scale_sigma_rel: Some(2e-3),
    mass_sigma_rel: Some(1e-3),
    angle_sigma_deg: None,
    angle_bias_sigma_deg: None,
    tilt_sigma_deg: None,
    session_sigma_rel: None,
};

/// What reads along the time.
pub(crate) struct Reader {
    pub(crate) kind: Kind,
    /// Standard deviation of a reading (SI).
    pub(crate) error: f64,
    /// The readings without error, at rising times (s) before and after contact.
    pub(crate) read: fn(&Impact, &[f64]) -> Vec<f64>,
}

/// Straight down at `speed` (m/s).
pub(crate) fn condition(speed: f64) -> Condition {
    Condition::straight_down(format!("v{speed}"), ("sphere", DIAMETER, MASS), speed)
}

/// A set without runs.
pub(crate) fn of_spheres(
    id: &str,
    (kind, instrument): (Kind, Instrument),
    conditions: Vec<Condition>,
) -> MeasurementSet {
    MeasurementSet {
        instrument,
        ..MeasurementSet::new(
            id,
            kind,
            Bed::new(Geometry::Spatial, Some(BED.bulk_density), BED.gravity),
            conditions,
        )
    }
}

/// What is said of `set` from the two-term law.
pub(crate) fn diagnosed(set: &MeasurementSet) -> Diagnosis {
    diagnosed_from("two-term-vector", set)
}

/// What is said of `set` from a shipped model.
pub(crate) fn diagnosed_from(model: &str, set: &MeasurementSet) -> Diagnosis {
    let observed = Observed::of(set);
    let forward = forward_of(model, set, &observed).expect("a model for spheres");
    diagnose(&FitProblem { set, observed: &observed, forward: &forward }, DEFAULT_SEED)
        .expect("spheres stop")
}

/// The shipped model `model` for what was `observed` of `set`.
pub(crate) fn forward_of(
    model: &str,
    set: &MeasurementSet,
    observed: &Observed,
) -> Result<ResistiveForward, ForwardError> {
    let source = ModelSource::Shipped(find_shipped(model).expect("a shipped model"));
    let model = Model::load(source, &LoadOptions::default()).expect("a model").model;
    ResistiveForward::new(&model, set, &observed.layouts())
}

/// Falls into drag, friction and the effect `hidden` at five speeds, as `reader` reads them.
pub(crate) fn read_over_time(
    id: &str,
    (reader, instrument): (&Reader, Instrument),
    hidden: Option<(&str, f64)>,
    (seed, stream): (u64, u128),
) -> MeasurementSet {
    let mut random = Pcg64::new(u128::from(seed), stream);
    let conditions: Vec<Condition> = [0.7, 1.2, 2.0, 3.2, 4.5].map(condition).into();
    let times: Vec<f64> = (-9..200).map(|k| f64::from(k) / RATE).collect();
    let mut fall = |speed: f64| -> Vec<Sample> {
        let [drag, friction] =
            [1.2, 18.0].map(|of| of * (1.0 + COEFFICIENTS * normal(&mut random)));
        let mut laws = vec![law("two-term-vector", &[("drag", drag), ("friction", friction)])];
        laws.extend(hidden.map(|(name, q)| law(name, &[("q", q)])));
        let read = (reader.read)(&sphere(laws, speed, 90.0), &times);
        let noisy = |value: f64| value + reader.error * normal(&mut random);
        let values: Vec<f64> = read.into_iter().map(noisy).collect();
        times.iter().zip(values).map(|(&at, value)| Sample { at, value, sigma: None }).collect()
    };
    let places = (0..conditions.len()).flat_map(|at| (0..REPEATS).map(move |repeat| (at, repeat)));
    let runs = places.map(|(at, repeat)| Run {
        repeat: Some(repeat as i64),
        samples: fall(conditions[at].speed),
        ..Run::new(format!("{at}-{repeat}"), at)
    });
    let runs = runs.collect();
    MeasurementSet {
        stop: StopDefinition::SpeedFivePercent,
        runs,
        ..of_spheres(id, (reader.kind, instrument), conditions)
    }
}

/// `set` as it is read after it was written, without what is noted of it.
///
/// # Errors
/// What is told of its faults and contradictions.
pub(crate) fn read_back(set: &MeasurementSet) -> Result<MeasurementSet, String> {
    let folder = tempfile::tempdir().expect("a folder");
    set.write(folder.path()).expect("files");
    let loaded = MeasurementSet::load(folder.path()).map_err(|error| error.to_string())?;
    match loaded.contradictions.is_empty() {
        true => Ok(MeasurementSet { notes: Vec::new(), ..loaded.set }),
        false => Err(loaded.render_contradictions(&ContradictionKind::ALL, configs::Color::Off)),
    }
}

/// What is told of a `set` that is refused.
pub(crate) fn refusal(set: &MeasurementSet) -> String {
    match read_back(set) {
        Ok(_) => panic!("nothing was refused"),
        Err(told) => told,
    }
}

/// Draws a set with an effect hidden in it, or with none, from a seed.
type Measured = fn(Option<(&str, f64)>, u64) -> MeasurementSet;

/// Two hidden effects are named, each with its amplitude.
pub(crate) fn assert_hidden_effects_are_named(measured: Measured) {
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

/// Sets of the model itself show nothing.
pub(crate) fn assert_the_model_shows_nothing(measured: Measured) {
    let named = (0..4)
        .filter(|seed| diagnosed(&measured(None, 20 + seed)).verdict != Verdict::NothingDetected)
        .count();
    // Each set is rejected with a probability of 2 % at most: two of four happen once in four hundred.
    assert!(named <= 1, "{named} of 4");
}

/// A change of every reading, and what is told of it.
pub(crate) type Wrong = (fn(&mut Sample), &'static str);

/// Every change of a set without hidden effects is refused with its message.
pub(crate) fn assert_refused(measured: Measured, cases: &[Wrong]) {
    for (change, message) in cases {
        let mut set = measured(None, 5);
        set.runs.iter_mut().flat_map(|run| &mut run.samples).for_each(change);
        let told = refusal(&set);
        assert!(told.contains(message), "{message}: {told}");
    }
}
