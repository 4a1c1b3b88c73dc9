//! A candidate of a model file in a diagnosis.

use configs::{LoadOptions, Model, ModelSource};
use diagnosis::diagnose::diagnose;
use diagnosis::fit::problem::{DEFAULT_SEED, FitProblem};
use diagnosis::forward::{Forward, Request, Scatter};
use diagnosis::observed::Observed;
use diagnosis::resistive::ResistiveForward;
use diagnosis::verdict::Verdict;
use measurements::{
    Bed, Condition, FinalDefinition, Geometry, Instrument, Kind, MeasurementSet, Run,
};
use rand_pcg::Pcg64;
use validation::benchmark::chance::normal;

use super::late_drag;

const HIDDEN: f64 = 0.6;
const REPEATS: usize = 5;

/// The model of the docs with its effect as a candidate.
fn model() -> Model {
    let text = late_drag::MODEL.replace("[[effect]]", "[[candidate]]").replace("value = 0.2, ", "");
    let source = ModelSource::Text { name: "candidate.toml".to_owned(), text, folder: ".".into() };
    Model::load(source, &LoadOptions::default()).expect("a model").model
}

fn condition(index: usize, speed: f64, angle: f64, mass: f64) -> Condition {
    Condition {
        angle_deg: angle,
        ..Condition::straight_down(format!("c{index:02}"), ("sphere", 0.0254, mass), speed)
    }
}

/// A set whose numbers are still to be measured.
fn empty_set() -> MeasurementSet {
    let conditions: Vec<Condition> = [0.6, 1.2, 2.4, 4.0]
        .into_iter()
        .flat_map(|speed| [(speed, 90.0, 0.0692), (speed, 90.0, 0.2), (speed, 45.0, 0.0692)])
        .enumerate()
        .map(|(index, (speed, angle, mass))| condition(index, speed, angle, mass))
        .collect();
    let run = |index: usize| {
        let condition = index / REPEATS;
        Run {
            repeat: Some((index % REPEATS) as i64),
            stop_time: Some(0.1),
            final_z: Some(0.1),
            final_x: (conditions[condition].angle_deg < 90.0).then_some(0.1),
            ..Run::new(format!("{condition}-{}", index % REPEATS), condition)
        }
    };
    MeasurementSet {
        instrument: Instrument {
            rate: None,
            position_sigma: Some(1e-4),
            speed_sigma_rel: Some(0.005),
            level_sigma: Some(1e-4),
            ..Instrument::default()
        },
        last: FinalDefinition::Deepest,
        runs: (0..conditions.len() * REPEATS).map(run).collect(),
        feasible: Default::default(),
        ..MeasurementSet::new(
            "own",
            Kind::Scalar,
            Bed::new(Geometry::Spatial, Some(1520.0), 9.81),
            conditions,
        )
    }
}

/// What the model with the hidden effect gives, in beds that differ by 2 %.
fn measured(model: &Model) -> MeasurementSet {
    let mut set = empty_set();
    let layouts = Observed::of(&set).layouts();
    let forward = ResistiveForward::new(model, &set, &layouts).expect("a resistive model");
    let index = forward.candidates().iter().position(|one| one.id == "late-drag").expect("listed");
    let start: Vec<f64> = forward.parameters().iter().map(|one| one.start).collect();
    let mut random = Pcg64::new(1, 2);
    for run in &mut set.runs {
        let scatter = Scatter {
            coefficients: (0..2).map(|_| 0.02 * normal(&mut random)).collect(),
            speed: 0.005 * normal(&mut random),
            level: 1e-4 * normal(&mut random),
            ..Scatter::default()
        };
        let effects = [(index, HIDDEN)];
        let at = Request { parameters: &start, effects: &effects, scatter: &scatter };
        let numbers = forward.predict(run.condition, &at).expect("an impact");
        run.stop_time = Some(numbers[0]);
        run.final_z = Some(numbers[1] + 1e-4 * normal(&mut random));
        run.final_x = run.final_x.map(|_| numbers[2] + 1e-4 * normal(&mut random));
    }
    set
}

#[test]
fn a_candidate_of_the_model_is_named_where_it_is_hidden_in_the_data() {
    let model = model();
    let set = measured(&model);
    let observed = Observed::of(&set);
    let forward = ResistiveForward::new(&model, &set, &observed.layouts()).expect("a model");
    let own = forward.candidates().last().expect("the candidate of the model is the last");
    assert_eq!((own.id.as_str(), own.unit.as_str(), own.max), ("late-drag", "1", 5.0));
    let problem = FitProblem { set: &set, observed: &observed, forward: &forward };
    let found = diagnose(&problem, DEFAULT_SEED).expect("spheres stop");
    let told = match found.verdict {
        Verdict::Supported => &found.effects,
        Verdict::NotSeparable => &found.not_separable,
        other => panic!("{other:?}: {:?}", found.unexplained),
    };
    assert!(told.iter().any(|id| id == "late-drag"), "{told:?}");
    let ranked = found.ranking.iter().find(|effect| effect.id == "late-drag").expect("ranked");
    let (q, se) = (ranked.q.expect("fitted"), ranked.se.expect("fitted"));
    // Four standard errors: chance takes one in fifteen thousand.
    assert!((q - HIDDEN).abs() < 4.0 * se, "{q} ± {se}");
}
