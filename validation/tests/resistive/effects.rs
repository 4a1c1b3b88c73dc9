//! Every effect as a diagnosis meets it: before a set that could show them all, and before one that
//! could not.

use configs::{LoadOptions, Model, ModelSource, find_shipped};
use diagnosis::forward::observable::Layout;
use diagnosis::forward::{Forward, Request, Scatter};
use diagnosis::resistive::ResistiveForward;
use measurements::{Bed, Condition, Frame, Geometry, Instrument, Kind, MeasurementSet, Run};

use super::rig::{BED, DIAMETER, MASS};

/// Amplitudes of this many steps are a hundredth of the largest that one would expect.
const SMALL: f64 = 10.0;

/// A hundred times what the integration is off by (m or s).
const SEEN: f64 = 1e-7;

/// Twice a hundredth of an effect is twice its half to a few hundredths, if it is smooth; a kink or a
/// jump of the prediction is of order one.
const CURVED: f64 = 0.06;

fn vertical(speed: f64) -> Condition {
    Condition {
        packing: Some(0.58),
        bed_depth: Some(0.1),
        ..Condition::straight_down(format!("v{speed}"), ("sphere", DIAMETER, MASS), speed)
    }
}

/// Two angles, sizes, masses, packings and depths of the bed, spin both ways, slow and fast.
fn all_round() -> MeasurementSet {
    let oblique = |angle_deg, spin| Condition { angle_deg, spin, ..vertical(2.0) };
    let small = Condition { diameter: 0.019, mass: 0.03, ..vertical(1.2) };
    let dense = Condition { packing: Some(0.62), bed_depth: Some(0.2), ..vertical(2.0) };
    set(vec![
        vertical(0.8),
        vertical(3.0),
        oblique(35.0, 0.0),
        oblique(60.0, 20.0),
        oblique(60.0, -20.0),
        small,
        dense,
    ])
}

/// One run of each condition: deep where it was fast, and seen before impact.
fn set(conditions: Vec<Condition>) -> MeasurementSet {
    let followed = |condition: usize, depth: f64| Run {
        final_z: Some(depth),
        frames: vec![Frame { t: -0.02, z: -0.03, x: 0.0, sigma: None }],
        ..Run::new(format!("r{condition}"), condition)
    };
    let depth = |one: &Condition| one.diameter * if one.speed > 2.5 { 3.0 } else { 1.0 };
    let runs = conditions.iter().enumerate().map(|(index, one)| followed(index, depth(one)));
    MeasurementSet {
        // Errors of an exact apparatus are candidates, to be looked for as effects are.
        instrument: Instrument::default().without_shared_errors(),
        runs: runs.collect(),
        ..MeasurementSet::new(
            "all-round",
            Kind::Trajectory,
            Bed::new(Geometry::Spatial, Some(BED.bulk_density), BED.gravity),
            conditions,
        )
    }
}

fn forward(set: &MeasurementSet) -> ResistiveForward {
    let source = ModelSource::Shipped(find_shipped("two-term-vector").expect("a shipped model"));
    let loaded = Model::load(source, &LoadOptions::default()).expect("a shipped model loads");
    let layout = Layout {
        times: vec![-0.04, -0.02, 0.0, 0.005, 0.01, 0.02, 0.03, 0.05, 0.08],
        along_x: true,
        curve: None,
        stop_time: true,
        final_z: true,
        final_x: true,
        ..Layout::default()
    };
    let layouts = vec![layout; set.conditions.len()];
    ResistiveForward::new(&loaded.model, set, &layouts).expect("a model for the set")
}

/// All observables of all conditions, with candidate `index` at `q`.
fn predicted(forward: &ResistiveForward, conditions: usize, index: usize, q: f64) -> Vec<f64> {
    let parameters: Vec<f64> = forward.parameters().iter().map(|one| one.start).collect();
    let (effects, scatter) = ([(index, q)], Scatter::default());
    let at = Request { parameters: &parameters, effects: &effects, scatter: &scatter };
    let id = &forward.candidates()[index].id;
    let of = |one| forward.predict(one, &at).unwrap_or_else(|error| panic!("{id} {q}: {error}"));
    (0..conditions).flat_map(of).collect()
}

fn norm(values: impl Iterator<Item = f64>) -> f64 {
    values.map(|value| value * value).sum::<f64>().sqrt()
}

#[test]
fn every_effect_acts_on_an_all_round_set_and_smoothly_so() {
    let set = all_round();
    let forward = forward(&set);
    for (index, candidate) in forward.candidates().iter().enumerate() {
        let id = &candidate.id;
        assert_eq!(candidate.not_testable, None, "{id}");
        let at = |q: f64| predicted(&forward, set.conditions.len(), index, q);
        let q = SMALL * candidate.step;
        let (none, once, twice) = (at(0.0), at(q), at(2.0 * q));
        let change = norm(twice.iter().zip(&none).map(|(b, a)| b - a));
        assert!(change > SEEN, "{id}: {change:e}");
        let second = |low: &[f64], middle: &[f64], high: &[f64]| {
            let each = low.iter().zip(middle).zip(high);
            norm(each.map(|((low, middle), high)| low - 2.0 * middle + high)) / change
        };
        let mut curvature = second(&none, &once, &twice);
        if candidate.min < 0.0 {
            curvature = curvature.max(second(&at(-q), &none, &once));
        }
        assert!(curvature < CURVED, "{id}: {curvature:.3}");
    }
}

#[test]
fn forms_of_an_effect_at_one_amplitude_are_predicted_each_as_it_is() {
    let set = all_round();
    let forward = forward(&set);
    let candidates = forward.candidates();
    let mut compared = 0;
    for (index, other) in candidates.iter().enumerate().filter(|(_, one)| !one.form.is_empty()) {
        let listed = candidates.iter().position(|one| one.id == other.id && one.form.is_empty());
        let listed = listed.expect("a form beside the listed one");
        // In turn, at equal amplitudes, as derivatives of both are taken.
        let q = SMALL * other.step.min(candidates[listed].step);
        let [one, another] =
            [listed, index].map(|which| predicted(&forward, set.conditions.len(), which, q));
        let apart = norm(one.iter().zip(&another).map(|(a, b)| a - b));
        assert!(apart > SEEN, "{} {:?}: {apart:e}", other.id, other.form);
        compared += 1;
    }
    assert!(compared > 3, "{compared} forms");
}

#[test]
fn an_all_round_set_leaves_no_twins_together() {
    let set = all_round();
    for candidate in forward(&set).candidates() {
        assert!(candidate.unresolved.is_empty(), "{}: {:?}", candidate.id, candidate.unresolved);
    }
}

#[test]
fn one_vertical_condition_shows_little_and_tells_few_apart() {
    let mut set = set(vec![vertical(1.0)]);
    set.runs[0].frames.clear();
    let forward = forward(&set);
    let of = |id: &str| {
        let mut all = forward.candidates().iter();
        all.find(|one| one.id == id).unwrap_or_else(|| panic!("{id} is no candidate"))
    };
    for id in ["magnus", "spin-friction", "lift", "anisotropic-drag", "packing", "air-drag"] {
        assert!(of(id).not_testable.is_some(), "{id}");
    }
    for (id, confounders) in [
        ("yield-stress", &["viscous-drag", "added-mass", "buoyancy", "rail-friction"][..]),
        ("janssen", &["depth-exponent"]),
        ("bottom-wall", &["depth-exponent"]),
        ("camera-scale", &["depth-zero"]),
        // It is shown by vertical impacts, and they tell it from its confounders.
        ("tilt", &[]),
    ] {
        assert_eq!(of(id).unresolved, confounders, "{id}");
    }
    for candidate in forward.candidates() {
        for confounder in &candidate.unresolved {
            assert!(
                of(confounder).unresolved.contains(&candidate.id),
                "{} and {confounder}",
                candidate.id
            );
        }
    }
}

#[test]
fn a_camera_that_is_wrong_changes_what_is_read_and_no_stopping_time() {
    let set = set(vec![vertical(2.0)]);
    let forward = forward(&set);
    let index = |id: &str| forward.candidates().iter().position(|one| one.id == id).unwrap();
    let at = |id: &str, q: f64| predicted(&forward, 1, index(id), q);
    let right = at("camera-scale", 0.0);
    let (scaled, shifted) = (at("camera-scale", 0.02), at("depth-zero", 1.5));
    // Nine depths, nine ranges, the stopping time, final depth and range.
    for (place, value) in right.iter().enumerate() {
        let (scale, zero) = match place {
            0..9 | 19 => (1.02, 1.5e-3),
            18 => (1.0, 0.0),
            _ => (1.02, 0.0),
        };
        assert!((scaled[place] - scale * value).abs() < 1e-15, "{place}");
        assert!((shifted[place] - zero - value).abs() < 1e-15, "{place}");
    }
}
