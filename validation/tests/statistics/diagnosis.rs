//! The verdicts.

use diagnosis::diagnose::diagnose;
use diagnosis::fit::problem::{DEFAULT_SEED, FitProblem};
use diagnosis::misfit::held_out::LeftOut;
use diagnosis::observed::Observed;
use diagnosis::resistive::ResistiveForward;
use diagnosis::verdict::{Diagnosis, RankedEffect, Status, Strength, StrengthReason, Verdict};
use measurements::{Kind, MeasurementSet, StatedError};

use validation::benchmark::trial::baseline;

use crate::laboratory::Laboratory;
use crate::world::{Effect, Setting, TwoTerm};

fn diagnosis(laboratory: &Laboratory, set: &MeasurementSet) -> Diagnosis {
    diagnosis_among(laboratory, set, &Effect::LISTED)
}

fn diagnosis_among(laboratory: &Laboratory, set: &MeasurementSet, effects: &[Effect]) -> Diagnosis {
    let observed = Observed::of(set);
    let forward = TwoTerm::new(&laboratory.settings, observed.layouts(), effects);
    diagnose(&FitProblem { set, observed: &observed, forward: &forward }, DEFAULT_SEED)
        .expect("spheres stop")
}

fn ranked(diagnosis: &Diagnosis, effect: Effect) -> &RankedEffect {
    let entry = diagnosis.ranking.iter().find(|entry| entry.id == effect.id());
    entry.expect("every candidate is listed")
}

#[test]
fn where_nothing_is_hidden_nothing_is_found() {
    let laboratory = Laboratory::default();
    let sets = 12;
    let named = (0..sets)
        .filter(|seed| {
            let diagnosis = diagnosis(&laboratory, &laboratory.measure(100 + seed));
            assert!(!diagnosis.ranking.is_empty());
            diagnosis.verdict != Verdict::NothingDetected
        })
        .count();
    // Each set is rejected with a probability of 2 % at most (1 % for an effect, 1 % for a lack of
    // fit), so two in twelve happen once in forty.
    assert!(named <= 1, "{named} of {sets}");
}

#[test]
fn a_hidden_effect_is_named_or_stands_in_the_set_that_is_named() {
    for (effect, amplitude, seed) in [
        (Effect::Viscous, 4.0, 1),
        (Effect::Yield, 1.8, 2),
        (Effect::DepthExponent, 0.3, 3),
        (Effect::Buoyancy, 3.0, 4),
        (Effect::DepthDrag, 1.0, 5),
        (Effect::Lift, 0.1, 6),
    ] {
        let laboratory = Laboratory::quiet(effect, amplitude);
        let found = diagnosis(&laboratory, &laboratory.measure(seed));
        let told = match found.verdict {
            Verdict::Supported => &found.effects,
            Verdict::NotSeparable => &found.not_separable,
            other => panic!("{}: {other:?} {:?}", effect.id(), found.unexplained),
        };
        assert!(told.iter().any(|id| id == effect.id()), "{}: {told:?}", effect.id());
        let RankedEffect { q: Some(q), se: Some(se), .. } = ranked(&found, effect) else {
            panic!("{} was not ranked", effect.id());
        };
        // Four standard errors: chance takes one in fifteen thousand.
        assert!((q - amplitude).abs() < 4.0 * se, "{}: {q} ± {se}", effect.id());
    }
}

#[test]
fn exact_twins_are_never_told_apart() {
    let mut laboratory = Laboratory::quiet(Effect::MoreMass, 0.25);
    // With one mass, mass added and weight taken away rescale the same equation.
    laboratory.settings.iter_mut().for_each(|setting| setting.mass = 0.0667);
    let effects = [Effect::Lift, Effect::LessWeight, Effect::MoreMass];
    let found = diagnosis_among(&laboratory, &laboratory.measure(1), &effects);
    assert_eq!(found.verdict, Verdict::NotSeparable, "{:?}", found.unexplained);
    let mut set = found.not_separable.clone();
    set.sort();
    assert_eq!(set, ["less-weight", "more-mass"]);
    assert_eq!(found.effects, found.not_separable[..1]);
}

#[test]
fn an_effect_outside_the_list_is_refused() {
    let laboratory = Laboratory::hiding(Effect::Layer, 1.0);
    let found = diagnosis(&laboratory, &laboratory.measure(1));
    assert_eq!(found.verdict, Verdict::NoneOfTheCandidates);
    assert!(found.effects.is_empty() && found.not_separable.is_empty());
    assert!(found.unexplained.depends_on.contains(&"z"), "{:?}", found.unexplained);
}

#[test]
fn the_nearest_effect_is_refused_where_conditions_still_differ_by_a_force() {
    let setting = |speed| Setting { speed, angle: 90.0, mass: 0.0667, diameter: 0.0254 };
    let laboratory = Laboratory {
        settings: [0.8, 1.2, 1.6, 2.2, 2.8, 3.6].map(setting).into(),
        holdout: 0,
        repeats: 4,
        tau_coefficient: 0.02,
        tau_path: 0.0,
        ..Laboratory::hiding(Effect::Saturation, 2.2)
    };
    let mut set = laboratory.measure(3);
    set.instrument.session_sigma_rel = None;
    let model = baseline().expect("the shipped model loads");
    let observed = Observed::of(&set);
    let forward = ResistiveForward::new(&model, &set, &observed.layouts()).expect("it fits");
    let problem = FitProblem { set: &set, observed: &observed, forward: &forward };
    let found = diagnose(&problem, DEFAULT_SEED).expect("spheres stop");
    // Viscous drag explains most of it, and leaves a force that depends on speed.
    assert_eq!(found.ranking[0].id, "viscous-drag");
    assert_eq!(found.verdict, Verdict::NoneOfTheCandidates, "{:?}", found.strength_reasons);
    assert!(found.unexplained.hint.contains("conditions still differ"), "{:?}", found.unexplained);
}

#[test]
fn two_hidden_effects_are_found_as_a_pair() {
    let hidden = vec![(Effect::Buoyancy, 4.0), (Effect::Lift, 0.15)];
    let laboratory = Laboratory { hidden, ..Laboratory::default() };
    let found = diagnosis(&laboratory, &laboratory.measure(1));
    assert_eq!(found.verdict, Verdict::Pair, "{:?}", found.unexplained);
    let mut pair = found.effects.clone();
    pair.sort();
    assert_eq!(pair, ["buoyancy", "lift"]);
    assert!(found.unexplained.hint.contains("or one effect outside the list"));
}

#[test]
fn held_out_conditions_do_not_reach_the_ranking() {
    let laboratory = Laboratory::hiding(Effect::Buoyancy, 3.0);
    let set = laboratory.measure(1);
    let mut corrupt = set.clone();
    let first = laboratory.settings.len() - laboratory.holdout;
    for run in corrupt.runs.iter_mut().filter(|run| run.condition >= first) {
        run.final_z = run.final_z.map(|z| 1.3 * z);
        run.frames.iter_mut().for_each(|frame| frame.z *= 1.3);
    }
    let (before, after) = (diagnosis(&laboratory, &set), diagnosis(&laboratory, &corrupt));
    assert_eq!(before.ranking, after.ranking);
    assert_ne!(before.holdout, after.holdout);
}

#[test]
fn without_held_out_conditions_each_is_left_out_in_turn() {
    let laboratory = Laboratory { holdout: 0, ..Laboratory::hiding(Effect::Lift, 0.1) };
    let found = diagnosis(&laboratory, &laboratory.measure(1));
    assert_eq!((found.verdict, found.strength), (Verdict::Supported, Strength::Confirmed));
    let held_out = found.holdout.expect("something was fitted");
    assert_eq!(held_out.conditions, LeftOut::OneAtATime);
    assert!(held_out.after < held_out.before, "{held_out:?}");
    // Means of five with the right model miss by their noise, and by what the fit adds to it.
    let [after, floor] = [held_out.after, held_out.noise_floor].map(|error| error.expect("judged"));
    assert!(after < 1.5 * floor, "{held_out:?}");
}

#[test]
fn names_and_order_of_runs_change_nothing_but_the_names() {
    let laboratory = Laboratory::hiding(Effect::Buoyancy, 3.0);
    let set = laboratory.measure(1);
    let mut other = set.clone();
    other.runs.reverse();
    for (at, run) in other.runs.iter_mut().enumerate() {
        run.name = format!("take {at}");
    }
    let said = |set| {
        let mut said = diagnosis(&laboratory, set).to_json().expect("it has JSON");
        let runs = said["measured"].take();
        (said.to_string(), runs)
    };
    let ((bytes, runs), (other, others)) = (said(&set), said(&other));
    assert_eq!(bytes, other);
    assert_ne!(runs, others, "both name their runs");
}

#[test]
fn an_effect_that_the_data_cannot_show_is_listed_and_not_ranked() {
    let laboratory = Laboratory::hiding(Effect::Buoyancy, 3.0);
    let set = laboratory.measure(1);
    let observed = Observed::of(&set);
    let mut forward = TwoTerm::new(&laboratory.settings, observed.layouts(), &Effect::LISTED);
    forward.forbid(3);
    let problem = FitProblem { set: &set, observed: &observed, forward: &forward };
    let found = diagnose(&problem, DEFAULT_SEED).expect("spheres stop");
    let last = found.ranking.last().expect("there are effects");
    assert_eq!((last.id.as_str(), last.testable), ("buoyancy", false));
    assert_eq!(last.status, Status::NotTestable);
    assert_eq!((last.q, last.delta, last.note.as_str()), (None, None, "only vertical runs"));
    assert!(found.ranking.iter().rev().skip(1).all(|entry| entry.testable));
    assert!(!found.effects.contains(&"buoyancy".to_owned()));
}

#[test]
fn scalars_with_repeats_name_a_strong_effect() {
    let hidden = vec![(Effect::Lift, 0.2)];
    let laboratory = Laboratory { kind: Kind::Scalar, hidden, ..Laboratory::default() };
    let found = diagnosis(&laboratory, &laboratory.measure(1));
    assert_eq!((found.verdict, found.strength), (Verdict::Supported, Strength::Confirmed));
    assert_eq!(found.effects, ["lift"]);
}

#[test]
fn stated_errors_suggest_and_nothing_stated_cannot_tell() {
    let laboratory = Laboratory {
        kind: Kind::Scalar,
        repeats: 1,
        holdout: 0,
        tau_coefficient: 0.02,
        tau_path: 0.03,
        hidden: vec![(Effect::Lift, 0.3)],
        ..Laboratory::default()
    };
    let mut set = laboratory.measure(1);
    let found = diagnosis(&laboratory, &set);
    assert_eq!((found.verdict, found.p1), (Verdict::CannotTell, None));
    assert!(found.ranking.iter().all(|entry| !entry.testable));

    let error = Some(0.03);
    set.stated = StatedError { stop_time: error, final_z: error, final_x: error };
    let found = diagnosis(&laboratory, &set);
    assert_eq!((found.verdict, found.strength), (Verdict::Supported, Strength::Suggested));
    assert_eq!(found.strength_reasons[0], StrengthReason::StatedErrors);
    assert_eq!(found.effects, ["lift"]);
}

#[test]
fn trajectories_without_repeats_suggest_under_an_assumed_scatter() {
    let laboratory = Laboratory { repeats: 1, ..Laboratory::hiding(Effect::Lift, 0.4) };
    let found = diagnosis(&laboratory, &laboratory.measure(1));
    assert_eq!(found.strength, Strength::Suggested);
    assert_eq!(found.strength_reasons[0], StrengthReason::AssumedScatter);
    assert_eq!(found.noise["source"], "assumed");
    assert_eq!((found.verdict, found.effects), (Verdict::Supported, vec!["lift".to_owned()]));
}

#[test]
fn an_effect_that_uses_up_all_that_was_measured_is_not_named() {
    // Stopping time, depth and range of one impact, for two parameters and an effect.
    let mut laboratory = Laboratory {
        kind: Kind::Scalar,
        repeats: 1,
        holdout: 0,
        ..Laboratory::hiding(Effect::Lift, 0.4)
    };
    laboratory.settings.truncate(2);
    laboratory.settings.remove(0);
    let mut set = laboratory.measure(1);
    let error = Some(0.005);
    set.stated = StatedError { stop_time: error, final_z: error, final_x: error };
    let found = diagnosis(&laboratory, &set);
    assert_eq!((found.verdict, found.effects.len()), (Verdict::CannotTell, 0));
    let hint = &found.unexplained.hint;
    assert!(hint.contains("as much is free as was measured"), "{hint}");
}

#[test]
fn the_keys_of_the_json_are_those_that_users_rely_on() {
    let laboratory = Laboratory::quiet(Effect::Buoyancy, 3.0);
    let json = diagnosis(&laboratory, &laboratory.measure(1)).to_json().expect("it has JSON");
    assert!(json["strength_reasons"].as_array().is_some_and(Vec::is_empty), "{json}");
    for key in ["verdict", "strength", "effects", "not_separable", "ranking", "p1", "p_lof"] {
        assert!(!json[key].is_null(), "{key}");
    }
    assert_eq!(json["ranking"][0]["status"], "ranked");
    for key in ["id", "q", "se", "unit", "delta", "predicted_top1", "testable", "detection_limit"] {
        assert!(!json["ranking"][0][key].is_null(), "{key}");
    }
    assert!(
        json["holdout"]["conditions_judged"].is_u64()
            && json["holdout"]["not_predicted"].is_array()
    );
    for key in ["before", "after", "noise_floor"] {
        assert!(json["holdout"][key].is_f64(), "{key}");
    }
    assert_eq!(json["verdict"], "supported");
    assert_eq!(json["strength"], "confirmed");
    assert!(json["noise"]["path_force_sd"].is_f64());
    assert!(json["unexplained"]["depends_on"].is_array());
    assert_eq!(json["next"], serde_json::json!([]));
}
