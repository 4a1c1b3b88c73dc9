//! The next experiment.

use diagnosis::bench::{Bench, DEFAULT_SEED};
use diagnosis::diagnose::diagnose;
use diagnosis::next::{Recommendation, judged, recommend};
use diagnosis::observed::Observed;
use diagnosis::resistive::ResistiveForward;
use diagnosis::verdict::{Diagnosis, Verdict};
use measurements::{Feasible, MeasurementSet};
use validation::benchmark::trial::baseline;

use crate::laboratory::Laboratory;
use crate::world::{Effect, Setting};

/// One sphere straight down at six speeds, and what is hidden.
fn vertical(effect: Effect, amplitude: f64) -> Laboratory {
    let setting = |speed| Setting { speed, angle: 90.0, mass: 0.0667, diameter: 0.0254 };
    Laboratory {
        settings: [0.6, 1.2, 1.8, 2.4, 3.0, 3.6].map(setting).to_vec(),
        holdout: 0,
        ..Laboratory::hiding(effect, amplitude)
    }
}

/// The diagnosis of `set` with recommendations, and the whole grid.
fn next(set: &MeasurementSet) -> (Diagnosis, Vec<Recommendation>) {
    let model = baseline().expect("the shipped model loads");
    let observed = Observed::of(set);
    let forward = ResistiveForward::new(&model, set, &observed.layouts()).expect("it has spheres");
    let bench = Bench { set, observed: &observed, forward: &forward };
    let mut diagnosis = diagnose(&bench, DEFAULT_SEED).expect("spheres stop");
    recommend(&bench, &model, &mut diagnosis);
    let grid = judged(&bench, &model, &diagnosis);
    (diagnosis, grid)
}

/// A set, changed, in which `effect` is strong enough to be seen and too weak to be told from its twins.
fn left_open(
    effect: Effect,
    changed: impl Fn(&MeasurementSet) -> MeasurementSet,
) -> MeasurementSet {
    let sets = [4.0, 3.0, 2.0, 1.5, 1.2, 0.9].map(|q| changed(&vertical(effect, q).measure(1)));
    let verdicts = sets.each_ref().map(|set| next(set).0);
    let is_open = |found: &Diagnosis| {
        let is_seen = matches!(found.verdict, Verdict::NotSeparable | Verdict::BelowNoise);
        is_seen && found.leaders.len() > 1
    };
    let open = verdicts.iter().position(is_open);
    let said = || verdicts.each_ref().map(|found| (found.verdict, &found.unexplained.hint));
    let open =
        open.unwrap_or_else(|| panic!("one drop at one angle tells all twins apart: {:?}", said()));
    sets[open].clone()
}

#[test]
fn what_one_sphere_straight_down_does_not_separate_another_mass_or_angle_does() {
    for effect in [Effect::Buoyancy, Effect::Yield] {
        let set = left_open(effect, MeasurementSet::clone);
        let (diagnosis, grid) = next(&set);
        assert!(grid.len() > 20, "{}", grid.len());
        let best = &grid[0].condition;
        let measured = &set.conditions[0];
        let other_mass = (best.mass - measured.mass).abs() > 0.0;
        assert!(other_mass || best.angle_deg < 90.0, "{best:?}");
        // Half of the grid lacks what the best has, by the claim above.
        let median = grid[grid.len() / 2].expected_delta;
        assert!(grid[0].expected_delta > median, "{} {median}", grid[0].expected_delta);
        for one in &grid[0].separates {
            assert!(diagnosis.ranking.iter().any(|effect| effect.id == *one), "{one}");
        }
        let json = &diagnosis.next;
        assert_eq!(json.len(), 3);
        assert_eq!(json[0]["mass_kg"], best.mass);
        let p = json[0]["probability_separated"].as_f64().expect("a probability");
        // Half a chance where as much is expected as is needed, whichever way it differs.
        assert_eq!(p > 0.5, grid[0].expected_delta > 9.2, "{p} {}", grid[0].expected_delta);
    }
}

#[test]
fn equal_input_gives_equal_bytes_within_the_limits_of_the_set() {
    let feasible = Feasible { angle_deg: vec![75.0], mass: vec![0.05], ..Feasible::default() };
    let set = left_open(Effect::Buoyancy, |set| MeasurementSet {
        feasible: feasible.clone(),
        ..set.clone()
    });
    let (first, second) = (next(&set), next(&set));
    assert_eq!(first.0.to_json().expect("JSON"), second.0.to_json().expect("JSON"));
    assert!(!first.1.is_empty());
    for one in &first.1 {
        assert_eq!((one.condition.angle_deg, one.condition.mass), (75.0, 0.05));
    }
}
