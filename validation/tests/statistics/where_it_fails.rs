//! Where a model fails: the files, and whether what was planted shows in them.

use std::collections::BTreeMap;

use diagnosis::compare::{Comparison, Revision, compare};
use diagnosis::diagnose::diagnose;
use diagnosis::fit::problem::{DEFAULT_SEED, FitProblem};
use diagnosis::misfit::force_error::{ForceCell, ForceErrors, Trend};
use diagnosis::observed::Observed;
use diagnosis::where_it_fails::{FILES, WhereItFails};
use measurements::{Kind, MeasurementSet};
use serde_json::Value;

use crate::laboratory::Laboratory;
use crate::world::{Effect, TwoTerm};

/// The two-term law before `set`.
fn compared(laboratory: &Laboratory, set: &MeasurementSet, observed: &Observed) -> Comparison {
    let forward = TwoTerm::new(&laboratory.settings, observed.layouts(), &[]);
    let revision = Revision { name: "two-term", forward: &forward };
    compare(set, observed, &[revision], DEFAULT_SEED).expect("spheres stop")
}

fn force_errors(laboratory: &Laboratory, set: &MeasurementSet) -> ForceErrors {
    let comparison = compared(laboratory, set, &Observed::of(set));
    comparison.models[0].failing.force_errors.clone()
}

fn trend<'a>(errors: &'a ForceErrors, over: &str) -> Option<&'a Trend> {
    errors.trends.iter().find(|trend| trend.over == over)
}

/// Files by their names.
fn written(found: &WhereItFails<'_>) -> BTreeMap<String, String> {
    found.files().expect("they can be written").into_iter().collect()
}

/// The header of a table, and its rows.
fn table(text: &str) -> (Vec<String>, Vec<csv::StringRecord>) {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers().expect("a header").iter().map(str::to_owned).collect();
    (header, reader.records().collect::<Result<_, _>>().expect("rows of one length"))
}

/// Runs in the order of their repeats: the first of every condition, then the second, ….
fn numbered(laboratory: &Laboratory, mut set: MeasurementSet) -> MeasurementSet {
    let conditions = laboratory.settings.len() as i64;
    for run in &mut set.runs {
        run.order = run.repeat.map(|repeat| repeat * conditions + run.condition as i64);
    }
    set
}

#[test]
fn tables_have_a_row_per_cell_and_number_and_the_same_input_gives_the_same_bytes() {
    let laboratory = Laboratory::hiding(Effect::Layer, 1.0);
    let set = laboratory.measure(1);
    let observed = Observed::of(&set);
    let comparison = compared(&laboratory, &set, &observed);
    let files = written(&comparison.where_it_fails(&set, &observed));
    let of_one_model =
        |name: &&&str| !["signatures", "revisions"].iter().any(|one| name.starts_with(one));
    let without_signatures = FILES.iter().filter(of_one_model);
    assert!(files.keys().map(String::as_str).eq({
        let mut names: Vec<&str> = without_signatures.copied().collect();
        names.sort_unstable();
        names
    }));

    let (header, rows) = table(&files["force_errors.csv"]);
    assert_eq!(
        header.join(","),
        "condition,speed_m_per_s,angle_deg,shape,diameter_m,from_z_m,to_z_m,force_error,se,\
         significant,model"
    );
    // Six depths of each condition that is not held out.
    assert_eq!(rows.len(), 6 * observed.fit.len());
    let (header, rows) = table(&files["residuals.csv"]);
    assert_eq!(
        header.join(","),
        "condition,observable,time_s,measured,predicted,standard_error,model"
    );
    assert_eq!(rows.len(), observed.conditions.iter().map(|c| c.mean.len()).sum::<usize>());
    assert!(rows.iter().all(|row| row[3].parse::<f64>().is_ok()));
    let scalars = rows.iter().filter(|row| row[2].is_empty()).count();
    let stops =
        rows.iter().filter(|row| ["stop_time_s", "final_z_m", "final_x_m"].contains(&&row[1]));
    assert_eq!(scalars, stops.count());

    let json: Value = serde_json::from_str(&files["where_it_fails.json"]).expect("JSON");
    let model = &json["models"][0];
    let keys = |value: &Value| value.as_object().map(|map| map.keys().cloned().collect::<Vec<_>>());
    let keys = |value: &Value| keys(value).expect("an object").join(",");
    assert_eq!(keys(model), "model,cells,conditions,groups,trends,depends_on");
    assert_eq!(keys(&model["groups"][0]), "over,unit,from,to,force_error,se,significant");
    let of_trend = "over,unit,n,centre,force_error,slope,se,p,significant";
    assert_eq!(keys(&model["trends"][0]), of_trend);
    let groups = model["groups"].as_array().expect("groups");
    assert!(groups.len() > comparison.models[0].fails.len(), "all groups, not only the marked");

    let pictures = files.iter().filter(|(name, _)| name.ends_with(".svg"));
    for (name, text) in pictures {
        assert!(text.starts_with("<svg") && text.trim_end().ends_with("</svg>"), "{name}");
        assert!(!text.contains("NaN") && !text.contains("inf"), "{name}");
    }
    let again = compared(&laboratory, &set, &observed);
    assert_eq!(files, written(&again.where_it_fails(&set, &observed)));
}

#[test]
fn a_layer_shows_in_the_cells_around_it_as_too_small_a_force() {
    let laboratory = Laboratory::hiding(Effect::Layer, 1.0);
    let errors = force_errors(&laboratory, &laboratory.measure(1));
    // The layer lies around 12 mm, and 4 mm to either side.
    let touches = |from: f64, to: f64| from < 0.014 && to > 0.010;
    let marked = || errors.cells.iter().filter(|cell| cell.significant);
    let inside = marked().filter(|cell| touches(cell.from, cell.to));
    assert!(inside.clone().count() >= 4, "{:?}", marked().collect::<Vec<_>>());
    assert!(inside.clone().all(|cell| cell.force_error > 0.0), "{:?}", inside.collect::<Vec<_>>());
    // Neighbours in depth of one condition are estimated against each other, so that single ones have
    // either sign; on average the force is too small in the layer and not below it.
    let mean = |cells: Vec<&ForceCell>| {
        cells.iter().map(|cell| cell.force_error / cell.se).sum::<f64>() / cells.len() as f64
    };
    let within = mean(errors.cells.iter().filter(|c| touches(c.from, c.to)).collect());
    let below = mean(errors.cells.iter().filter(|c| c.from > 0.016).collect());
    // Two standard errors between single cells are many between means of ten and more.
    assert!(within > 0.0 && within > below + 2.0, "{within} {below}");
}

#[test]
fn a_trend_over_speed_is_found_with_its_sign() {
    // Beside drag and friction refitted, a viscous force is missing most in slow impacts.
    let laboratory = Laboratory::hiding(Effect::Viscous, 1.5);
    let errors = force_errors(&laboratory, &laboratory.measure(1));
    let speed = trend(&errors, "speed").expect("the speed was varied");
    assert!(speed.significant && speed.slope < 0.0 && speed.p < 1e-3, "{speed:?}");
    assert_eq!((speed.unit, speed.n), ("m/s", 10));
}

#[test]
fn without_anything_hidden_there_is_no_trend_and_no_drift() {
    let laboratory = Laboratory::default();
    let sets = 6;
    let mut marked = 0;
    for seed in 0..sets {
        let set = numbered(&laboratory, laboratory.measure(300 + seed));
        let errors = force_errors(&laboratory, &set);
        assert!(trend(&errors, "order").is_some() && trend(&errors, "previous_run").is_some());
        let found = errors.trends.iter().any(|trend| trend.significant);
        marked += usize::from(found || !errors.drifts().is_empty());
    }
    // One in twenty each at most: two in six happen once in thirty.
    assert!(marked <= 1, "{marked} of {sets}");
}

#[test]
fn a_drift_over_the_order_of_runs_is_reported_and_hangs_on_the_order_alone() {
    let laboratory = Laboratory::default();
    let mut set = numbered(&laboratory, laboratory.measure(1));
    assert!(trend(&force_errors(&laboratory, &laboratory.measure(1)), "order").is_none());
    // Each run is shallower than the one before it by 0.3 %: the bed compacts.
    let shrunk = |order: i64| 1.0 - 0.003 * (order as f64 - 30.0);
    for run in &mut set.runs {
        let by = shrunk(run.order.expect("runs are numbered"));
        run.final_z = run.final_z.map(|z| by * z);
        run.frames.iter_mut().filter(|frame| frame.t > 0.0).for_each(|frame| frame.z *= by);
    }
    let errors = force_errors(&laboratory, &set);
    let order = trend(&errors, "order").expect("the order is known");
    assert!(order.slope > 0.0 && order.significant, "{order:?}");
    assert_eq!(errors.drifts(), ["order"]);

    let observed = Observed::of(&set);
    let forward = TwoTerm::new(&laboratory.settings, observed.layouts(), &[Effect::Lift]);
    let problem = FitProblem { set: &set, observed: &observed, forward: &forward };
    let found = diagnose(&problem, DEFAULT_SEED).expect("spheres stop");
    assert!(found.unexplained.depends_on.contains(&"order"), "{:?}", found.unexplained);
    // The rows of the table in another order are the same measurements.
    set.runs.reverse();
    assert_eq!(force_errors(&laboratory, &set), errors);
}

#[test]
fn the_signature_of_the_hidden_effect_takes_the_residual_away() {
    let laboratory = Laboratory::hiding(Effect::Lift, 0.2);
    let set = laboratory.measure(1);
    let observed = Observed::of(&set);
    let forward = TwoTerm::new(&laboratory.settings, observed.layouts(), &Effect::LISTED);
    let problem = FitProblem { set: &set, observed: &observed, forward: &forward };
    let diagnosis = diagnose(&problem, DEFAULT_SEED).expect("spheres stop");
    let found = WhereItFails::of_diagnosis(&problem, "two-term", &diagnosis, DEFAULT_SEED);
    let files = written(&found.expect("spheres stop"));
    assert!(FILES.iter().all(|name| files.contains_key(*name)), "{:?}", files.keys());
    let (header, rows) = table(&files["signatures.csv"]);
    assert_eq!(
        header.join(","),
        "condition,observable,time_s,residual,standard_error,effect,signature"
    );
    let numbers = observed.conditions.iter().map(|c| c.mean.len()).sum::<usize>();
    assert_eq!(rows.len(), 2 * numbers);
    let of_lift = rows
        .iter()
        .filter(|row| &row[5] == "lift")
        .map(|row| [3, 4, 6].map(|column| row[column].parse::<f64>().expect("a number")));
    let (mut before, mut after) = (0.0, 0.0);
    for [residual, error, signature] in of_lift {
        before += (residual / error).powi(2);
        after += ((residual - signature) / error).powi(2);
    }
    // Neighbours in time scatter together, so that even the truth does not come down to one each.
    assert!(after < 0.5 * before, "{before} {after}");
    let (_, cells) = table(&files["force_errors.csv"]);
    let models: Vec<&str> = cells.iter().map(|row| &row[10]).collect();
    assert_eq!((models[0], models[models.len() - 1]), ("two-term", "two-term + lift"));
}

#[test]
fn scalars_have_no_map_of_depths_and_no_trajectories() {
    let laboratory = Laboratory { kind: Kind::Scalar, ..Laboratory::hiding(Effect::Lift, 0.2) };
    let set = laboratory.measure(1);
    let observed = Observed::of(&set);
    let comparison = compared(&laboratory, &set, &observed);
    let files = written(&comparison.where_it_fails(&set, &observed));
    for absent in ["map-depth.svg", "residuals.svg", "signatures.svg", "signatures.csv"] {
        assert!(!files.contains_key(absent), "{absent}");
    }
    for present in ["map-speed-angle.svg", "covariates.svg", "errors.svg", "residuals.csv"] {
        assert!(files.contains_key(present), "{present}");
    }
    let (_, rows) = table(&files["force_errors.csv"]);
    assert_eq!(rows.len(), observed.fit.len());
}
