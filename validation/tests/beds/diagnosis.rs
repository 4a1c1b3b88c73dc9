//! The diagnosis of a bed, with impacts that take no time.

use diagnosis::beds::{BedModel, Plan, Variation, Wish, diagnose_bed};
use diagnosis::missing_force::Reading;
use diagnosis::observed::Observed;
use engine::bed::random;
use measurements::{Condition, Crater, Instrument, Kind, MeasurementSet, Role, Run, Sample};
use serde_json::json;
use validation::benchmark::beds::{Case, Hidden, Outcome, Prepared, campaign, measure};

use crate::imitation::{Imitation, crater, pushed};
use crate::world;
use validation::benchmark::chance::normal;

/// On beds that scatter by 5 %, and runs on one bed by `runs`.
fn outcome(hidden: Hidden, runs: f64) -> Outcome {
    let impacts = Imitation { beds: 0.05, runs, fades: false };
    // Of a bed that is not weighed, another packing could explain much of what rolling resistance does.
    let case = Case { is_weighed: true, ..Case::alike(hidden, 0) };
    case.run(&impacts, &Wish::default(), None).unwrap()
}

#[test]
fn where_nothing_is_hidden_nothing_is_named() {
    let one = outcome(Hidden::Nothing, 0.02);
    assert_eq!((one.verdict.as_str(), one.named.len()), ("nothing-detected", 0), "{one:?}");
}

#[test]
fn what_is_hidden_is_named_and_the_error_falls_on_fresh_beds() {
    // Runs on one bed that have much in common are screened alone, others by a design.
    for runs in [0.01, 0.05] {
        let one = outcome(Hidden::BedCandidate("rolling-resistance", 0.2), runs);
        assert!(one.first && one.right && !one.wrong, "{one:?}");
        let [before, after, floor] = one.held_out.unwrap();
        assert!(before > 2.0 * after && after < 2.0 * floor, "{one:?}");
    }
}

#[test]
fn what_has_impacts_on_fresh_beds_miss_by_more_than_without_it_is_not_named() {
    let impacts = Imitation { beds: 0.05, runs: 0.02, fades: true };
    let hidden = Hidden::BedCandidate("rolling-resistance", 0.2);
    let case = Case { is_weighed: true, ..Case::alike(hidden, 0) };
    let one = case.run(&impacts, &Wish::default(), None).unwrap();
    assert!(one.first, "{one:?}");
    assert_eq!((one.verdict.as_str(), one.named.len()), ("none-of-the-candidates", 0), "{one:?}");
}

#[test]
fn a_budget_that_pays_for_nothing_is_said_to_be_too_small() {
    let impacts = Imitation { beds: 0.05, runs: 0.02, fades: false };
    let wish = Wish { budget: Some(1e-3), ..Wish::default() };
    let case = Case::alike(Hidden::Nothing, 0);
    let one = case.run(&impacts, &wish, None).unwrap();
    assert_eq!((one.verdict.as_str(), one.impacts), ("cannot-tell", 0));
}

#[test]
fn another_preparation_is_named_as_one_and_no_physics_is() {
    let impacts = Imitation { beds: 0.05, runs: 0.02, fades: false };
    // Friction of 0.66 or 0.09 instead of 0.3 makes beds of the imitation looser by 0.024, or denser by 0.014.
    for (prepared, expected) in [(Prepared::Rough, -0.024), (Prepared::Smooth, 0.014)] {
        let case = Case { prepared, is_weighed: true, ..Case::alike(Hidden::Nothing, 0) };
        let one = case.run(&impacts, &Wish::default(), None).unwrap();
        assert_eq!(
            (one.verdict.as_str(), one.named.len()),
            ("explained-by-preparation", 0),
            "{one:?}"
        );
        let (by, se, is_named) = one.packing.expect("it is a parameter");
        assert!(is_named && (by - expected).abs() < 3.0 * se, "{one:?}");
        let case = Case { is_weighed: false, ..case };
        let one = case.run(&impacts, &Wish::default(), None).unwrap();
        assert!(one.named.is_empty(), "{one:?}");
    }
}

#[test]
fn a_bed_that_is_weighed_is_said_to_be_heavier_and_nothing_else() {
    let impacts = Imitation { beds: 0.05, runs: 0.02, fades: false };
    let heavier = Hidden::BedCandidate("grain-density", 0.4);
    let case = Case { is_weighed: true, ..Case::alike(heavier, 0) };
    let one = case.run(&impacts, &Wish::default(), None).unwrap();
    assert_eq!((one.verdict.as_str(), one.named.len()), ("explained-by-preparation", 0), "{one:?}");
    assert!(one.hint.contains("heavier than that of the model by"), "{one:?}");
}

#[test]
fn where_nothing_is_hidden_model_and_measurements_have_one_force_law_within_its_errors() {
    let impacts = Imitation { beds: 0.05, runs: 0.02, fades: false };
    let (mut scores, mut scatter) = (Vec::<f64>::new(), Vec::<f64>::new());
    for seed in 0..4 {
        let model = Case::alike(Hidden::Nothing, seed).model().unwrap();
        let empty = campaign(&model);
        let world = BedModel::new(&model, &empty).unwrap();
        let set = measure(&world, &Variation::default(), (10, seed), &impacts).unwrap();
        let bed_model = BedModel::new(&model, &set).unwrap();
        let observed = Observed::of(&set);
        let plan = Plan::new(&bed_model, &observed, &impacts, &Wish::default()).unwrap();
        let found = diagnose_bed(&bed_model, &observed, &impacts, plan, seed).unwrap();
        let object = found.to_json(&bed_model).unwrap();
        let changes = object["bed"]["force_law"]["relative_change"].as_object().unwrap();
        scores.extend(changes.values().map(|one| {
            let [by, se] = ["value", "se"].map(|key| one[key].as_f64().unwrap());
            by / se
        }));
        scatter.push(object["noise"]["run_sd_rel"].as_f64().unwrap());
    }
    // Coefficients scatter by 5 %; depths and times follow their roots, in part against each other.
    assert!(scatter.iter().all(|sd| (0.01..0.04).contains(sd)), "{scatter:?}");
    // Standard normal numbers, a few of which hang together.
    let square = scores.iter().map(|score| score * score).sum::<f64>() / scores.len() as f64;
    assert!(square < 2.5 && scores.iter().all(|score| score.abs() < 4.0), "{scores:?}");
}

#[test]
fn the_force_of_a_named_effect_is_what_the_depths_with_and_without_it_say() {
    let impacts = Imitation { beds: 0.05, runs: 0.02, fades: false };
    let measured = |hidden: Hidden| {
        let case = Case { is_weighed: true, ..Case::alike(hidden, 0) };
        case.measured(&impacts, None).unwrap()
    };
    let (_, plain) = measured(Hidden::Nothing);
    let (model, set) = measured(Hidden::BedCandidate("rolling-resistance", 0.2));
    let (bed_model, observed) = (BedModel::new(&model, &set).unwrap(), Observed::of(&set));
    let plan = Plan::new(&bed_model, &observed, &impacts, &Wish::default()).unwrap();
    let found = diagnose_bed(&bed_model, &observed, &impacts, plan, 1).unwrap();
    let force = &found.to_json(&bed_model).unwrap()["amplitudes"][0]["force"];
    let number = |key: &str| force[key].as_f64().unwrap();
    let at = set.conditions.iter().position(|one| force["condition"] == one.id).unwrap();
    let body = &set.conditions[at];
    let fall = body.speed * libm::sin(body.angle_deg.to_radians());
    let depth = |set: &MeasurementSet| {
        let depths = set.runs.iter().filter(|run| run.condition == at);
        let deepest: Vec<f64> = depths.map(deepest).collect();
        deepest.iter().sum::<f64>() / deepest.len() as f64
    };
    // What stops a fall over another way: the weight is the same.
    let more = 0.5 * body.mass * fall * fall * (1.0 / depth(&set) - 1.0 / depth(&plain));
    assert!(more > 0.0 && (number("mean") / more - 1.0).abs() < 0.25, "{more} {force}");
    assert!((number("depth") / depth(&set) - 1.0).abs() < 0.1, "{force}");
}

#[test]
fn the_missing_force_of_a_bed_is_that_of_what_is_hidden() {
    let impacts = Imitation { beds: 0.02, runs: 0.02, fades: false };
    let strength = 0.2;
    let sought = |hidden: Hidden| {
        let case = Case { is_weighed: true, ..Case::alike(hidden, 0) };
        let (model, set) = case.measured(&impacts, None).unwrap();
        let (bed_model, observed) = (BedModel::new(&model, &set).unwrap(), Observed::of(&set));
        let plan = Plan::new(&bed_model, &observed, &impacts, &Wish::default()).unwrap();
        let mut found = diagnose_bed(&bed_model, &observed, &impacts, plan, 1).unwrap();
        found.seek_missing_force(&set).unwrap();
        found.diagnosis.missing_force.expect("a force")
    };
    // What rolling resistance adds to the force law of the imitation.
    let added = |one: &Reading| strength * (0.12 * one.speed * one.speed + 4.0 * 4.0 * one.depth);
    let force = sought(Hidden::BedCandidate("rolling-resistance", strength));
    assert!(force.formula.is_none() && !force.formula_sought);
    let covered =
        force.readings.iter().filter(|one| (one.force - added(one)).abs() < 1.96 * one.se).count();
    let share = covered as f64 / force.readings.len() as f64;
    let sum = |of: &dyn Fn(&Reading) -> f64| force.readings.iter().map(of).sum::<f64>();
    let ratio = sum(&|one| one.force) / sum(&added);
    assert!(share > 0.85, "{share} of the band");
    assert!((ratio - 1.0).abs() < 0.1, "{ratio}");
    let nothing = sought(Hidden::Nothing);
    let clear = nothing.readings.iter().filter(|one| one.force.abs() > 1.96 * one.se).count();
    assert!(10 * clear <= nothing.readings.len(), "{}: {clear}", nothing.words);
}

#[test]
fn craters_beside_depths_name_what_is_hidden_and_alone_they_name_what_might_be() {
    let impacts = Imitation { beds: 0.05, runs: 0.02, fades: false };
    let hidden = Hidden::BedCandidate("rolling-resistance", 0.2);
    let case = Case { is_weighed: true, ..Case::alike(hidden, 0) };
    let (model, mut set) = case.measured(&impacts, None).unwrap();
    for run in &mut set.runs {
        let [depth, rim_diameter] = crater(deepest(run)).map(Some);
        run.crater = Crater { depth, rim_diameter };
    }
    let diagnosed = |set: &MeasurementSet| {
        let (bed_model, observed) = (BedModel::new(&model, set).unwrap(), Observed::of(set));
        assert!(observed.conditions.iter().all(|one| one.layout.craters() == 2));
        let plan = Plan::new(&bed_model, &observed, &impacts, &Wish::default()).unwrap();
        let found = diagnose_bed(&bed_model, &observed, &impacts, plan, 1).unwrap();
        found.to_json(&bed_model).unwrap()
    };
    let both = diagnosed(&set);
    assert_eq!(both["verdict"], "supported", "{}", both["ranking"]);
    assert_eq!(both["effects"][0], "rolling-resistance", "{}", both["ranking"]);

    set.kind = Kind::Scalar;
    for run in &mut set.runs {
        run.frames.clear();
        (run.final_z, run.final_x, run.stop_time) = (None, None, None);
    }
    // Craters of the imitation follow from the depth alone, which friction of grains changes alike.
    let alone = diagnosed(&set);
    assert_eq!(alone["verdict"], "not-separable", "{}", alone["ranking"]);
    let p = alone["p_lof"].as_f64().unwrap();
    assert!(p < 0.05, "craters are no noise: lack of fit p {p}");
    let might_be = alone["not_separable"].to_string();
    assert!(might_be.contains("rolling-resistance"), "{might_be}");
    let ranking = alone["ranking"].as_array().unwrap();
    let rail = ranking.iter().find(|one| one["id"] == "rail-friction").unwrap();
    assert_eq!(rail["status"], "not-testable", "{rail}");
}

/// Pushes to 2 cm of discs of two diameters, against grains of this rolling friction, eight times each.
fn pushes(rolling: f64) -> MeasurementSet {
    let conditions = [0.02, 0.015].map(|diameter| Condition {
        id: format!("{diameter} m"),
        diameter,
        ..world::condition(0.2, Role::Fit)
    });
    let mut random = random(1, "pushes");
    let mut read = |name: usize, condition: usize| {
        let friction = 4.0 * (1.0 + 4.0 * rolling) * libm::exp(0.03 * normal(&mut random));
        let sample = |at: u32| {
            let at = 1e-3 * f64::from(at);
            let value = pushed(friction, rolling, at) + 2e-4 * normal(&mut random);
            Sample { at, value, sigma: None }
        };
        let samples = (1..=20).map(sample).collect();
        Run { samples, ..Run::new(name.to_string(), condition) }
    };
    let runs = (0..16).map(|name| read(name, name % 2)).collect();
    let set = world::empty_set(conditions.into());
    let instrument = Instrument { force_sigma: Some(2e-4), ..set.instrument };
    MeasurementSet { kind: Kind::ForceDepth, runs, instrument, ..set }
}

#[test]
fn pushes_into_a_bed_name_what_is_hidden_and_nothing_where_nothing_is() {
    let impacts = Imitation { beds: 0.05, runs: 0.02, fades: false };
    let model = world::pushed();
    for (rolling, effects) in [(0.0, vec![]), (0.2, vec!["rolling-resistance"])] {
        let set = pushes(rolling);
        let (bed_model, observed) = (BedModel::new(&model, &set).unwrap(), Observed::of(&set));
        let plan = Plan::new(&bed_model, &observed, &impacts, &Wish::default()).unwrap();
        let found = diagnose_bed(&bed_model, &observed, &impacts, plan, 1).unwrap();
        let object = found.to_json(&bed_model).unwrap();
        assert_eq!(
            object["effects"],
            json!(effects),
            "{} {}",
            object["verdict"],
            object["ranking"]
        );
        if let [_] = effects[..] {
            let left_out = &object["holdout"];
            let [before, after] = ["before", "after"].map(|key| left_out[key].as_f64().unwrap());
            assert!(after < 0.1 * before && left_out["unit"] == "N", "{left_out}");
        }
    }
}

/// The depth to which a run came (m).
fn deepest(run: &Run) -> f64 {
    run.frames.iter().map(|frame| frame.z).chain(run.final_z).fold(0.0, f64::max)
}
