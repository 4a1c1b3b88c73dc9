//! Several revisions of a model side by side.

use diagnosis::compare::{Comparison, Revision, compare};
use diagnosis::fit::problem::DEFAULT_SEED;
use diagnosis::observed::Observed;
use measurements::Kind;
use serde_json::Value;

use crate::laboratory::Laboratory;
use crate::world::{Effect, TwoTerm};

/// The two-term law beside the law that has the hidden effect.
fn comparison(laboratory: &Laboratory) -> Comparison {
    let set = laboratory.measure(1);
    let observed = Observed::of(&set);
    let plain = TwoTerm::new(&laboratory.settings, observed.layouts(), &[]);
    let mut right = TwoTerm::new(&laboratory.settings, observed.layouts(), &[]);
    right.adopt(&laboratory.hidden);
    let revisions = [
        Revision { name: "two-term", forward: &plain },
        Revision { name: "two-term+effect", forward: &right },
    ];
    compare(&set, &observed, &revisions, DEFAULT_SEED).expect("spheres stop")
}

#[test]
fn the_right_revision_has_the_smaller_errors_and_fails_nowhere() {
    let found = comparison(&Laboratory::hiding(Effect::Lift, 0.2));
    let [wrong, right] = &found.models[..] else { panic!("two were asked for") };
    assert!(right.chi2_per_n < wrong.chi2_per_n && right.chi2_per_n < 1.2, "{}", right.chi2_per_n);
    assert!(right.p_lof.is_some_and(|p| p > 0.01), "{:?}", right.p_lof);
    for part in [|model: &Value| model["fit"].clone(), |model: &Value| model["holdout"].clone()] {
        let of = |at: usize| {
            let rms = serde_json::to_value(&found.models[at].rms).expect("it has JSON");
            part(&rms)["z_m"].as_f64().expect("depths were measured")
        };
        assert!(of(1) < of(0), "{} {}", of(1), of(0));
    }
    // At a rate of 5 % false marks a right model has one now and then.
    assert!(right.fails.len() <= 1, "{:?}", right.fails);
}

#[test]
fn a_force_that_is_wrong_at_one_depth_is_found_there() {
    let found = comparison(&Laboratory::hiding(Effect::Layer, 0.5));
    let [wrong, right] = &found.models[..] else { panic!("two were asked for") };
    let fails = &wrong.fails;
    let deep = fails
        .iter()
        .filter(|fail| fail.over == "z")
        .max_by(|a, b| (a.force_error / a.se).total_cmp(&(b.force_error / b.se)));
    let deep = deep.expect("the depth matters");
    // The layer lies around 12 mm.
    assert!((deep.from..deep.to).contains(&0.012), "{fails:?}");
    assert!(deep.force_error > 0.0);
    // At a rate of 5 % false marks a right model has one now and then.
    assert!(right.fails.len() <= 1, "{:?}", right.fails);
}

#[test]
fn the_json_has_the_keys_that_users_rely_on_and_no_others() {
    let json = serde_json::to_value(comparison(&Laboratory::hiding(Effect::Layer, 0.6)));
    let json = json.expect("it has JSON");
    let keys = |value: &Value| {
        let object = value.as_object().expect("an object");
        object.keys().cloned().collect::<Vec<_>>()
    };
    assert_eq!(keys(&json), ["set", "models", "noise", "conditions_judged", "not_predicted"]);
    let model = &json["models"][0];
    assert_eq!(keys(model), ["model", "parameters", "chi2_per_n", "p_lof", "rms", "fails"]);
    assert_eq!(keys(&model["parameters"]["drag"]), ["value", "se", "unit", "at_bound"]);
    assert_eq!(
        keys(&model["rms"]["fit"]),
        ["z_m", "x_m", "stop_time_s", "final_z_m", "final_x_m", "rms_relative"]
    );
    assert_eq!(keys(&model["fails"][0]), ["over", "from", "to", "force_error", "se"]);
}

#[test]
fn without_any_error_the_errors_are_compared_and_nothing_is_tested() {
    let laboratory = Laboratory {
        kind: Kind::Scalar,
        repeats: 1,
        holdout: 0,
        ..Laboratory::hiding(Effect::Lift, 0.2)
    };
    let found = comparison(&laboratory);
    assert!(found.models.iter().all(|model| model.p_lof.is_none()));
    assert!(found.models.iter().all(|model| model.rms.holdout.is_null()));
    assert_eq!(found.noise["source"], "assumed");
    assert_eq!(found.notes.len(), 2, "{:?}", found.notes);
    let relative = |at: usize| found.models[at].rms.fit["rms_relative"].as_f64().expect("scalars");
    assert!(relative(1) < relative(0));
}
