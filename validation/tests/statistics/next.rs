//! The next experiment.

use diagnosis::diagnose::diagnose;
use diagnosis::fit::problem::{DEFAULT_SEED, FitProblem};
use diagnosis::next::{FollowUp, Next, Recommendation, follow_up, recommend};
use diagnosis::observed::Observed;
use diagnosis::resistive::ResistiveForward;
use diagnosis::verdict::{Diagnosis, Verdict};
use measurements::{Condition, Feasible, MeasurementSet};
use validation::benchmark::trial::baseline;

use crate::laboratory::Laboratory;
use crate::world::{Effect, Setting};

/// Amplitudes, of which some are seen and not told from their confounders.
const STRENGTHS: [f64; 6] = [4.0, 3.0, 2.0, 1.5, 1.2, 0.9];

/// One sphere straight down at six speeds, and what is hidden.
fn vertical(effect: Effect, amplitude: f64) -> Laboratory {
    let setting = |speed| Setting { speed, angle: 90.0, mass: 0.0667, diameter: 0.0254 };
    Laboratory {
        settings: [0.6, 1.2, 1.8, 2.4, 3.0, 3.6].map(setting).to_vec(),
        holdout: 0,
        ..Laboratory::hiding(effect, amplitude)
    }
}

/// The diagnosis of `set`, and what could be measured next.
fn next(set: &MeasurementSet) -> (Diagnosis, Option<Next>) {
    let model = baseline().expect("the shipped model loads");
    let observed = Observed::of(set);
    let forward = ResistiveForward::new(&model, set, &observed.layouts()).expect("it has spheres");
    let problem = FitProblem { set, observed: &observed, forward: &forward };
    let mut diagnosis = diagnose(&problem, DEFAULT_SEED).expect("spheres stop");
    let next = recommend(&problem, &model, &mut diagnosis);
    (diagnosis, next)
}

/// A set, changed, in which `effect` is strong enough to be seen and too weak to be told from its confounders.
fn left_open(
    effect: Effect,
    changed: impl Fn(&MeasurementSet) -> MeasurementSet,
) -> MeasurementSet {
    let sets = STRENGTHS.map(|q| changed(&vertical(effect, q).measure(1)));
    let verdicts = sets.each_ref().map(|set| next(set).0);
    let is_open = |found: &Diagnosis| {
        let is_seen = matches!(found.verdict, Verdict::NotSeparable | Verdict::BelowNoise);
        is_seen && found.leaders.len() > 1
    };
    let open = verdicts.iter().position(is_open);
    let said = || verdicts.each_ref().map(|found| (found.verdict, &found.unexplained.hint));
    let open = open.unwrap_or_else(|| {
        panic!("one drop at one angle tells all confounders apart: {:?}", said())
    });
    sets[open].clone()
}

#[test]
fn what_one_sphere_straight_down_does_not_separate_another_mass_or_angle_does() {
    for effect in [Effect::Buoyancy, Effect::Yield] {
        let set = left_open(effect, MeasurementSet::clone);
        let (diagnosis, next) = next(&set);
        let next = next.expect("it is open");
        assert!(next.feasible.len() > 20, "{}", next.feasible.len());
        let best = &next.best[0].condition;
        let measured = &set.conditions[0];
        let other_mass = (best.mass - measured.mass).abs() > 0.0;
        assert!(other_mass || best.angle_deg < 90.0, "{best:?}");
        let told: Vec<f64> = next.best.iter().map(|one| one.expected_bits).collect();
        assert!(told.windows(2).all(|two| two[1] > two[0]), "each adds to the others: {told:?}");
        assert!(told.iter().all(|bits| *bits <= next.open_bits), "{told:?} of {}", next.open_bits);
        // The first is the best alone.
        let alone = next.feasible.iter().map(|one| one.expected_bits);
        assert!(alone.fold(0.0, f64::max) <= told[0]);
        // One more drop straight down with the same body tells less.
        let like_before = |one: &&Recommendation| {
            let Condition { angle_deg, mass, .. } = one.condition;
            angle_deg >= 90.0 && (mass - measured.mass).abs() == 0.0
        };
        let same = next.feasible.iter().filter(like_before).map(|one| one.expected_bits);
        let same = same.fold(0.0, f64::max);
        assert!(same < 0.8 * told[0], "{same} {}", told[0]);
        for one in &next.best[0].separates {
            assert!(diagnosis.ranking.iter().any(|effect| effect.id == *one), "{one}");
        }
        let json = &diagnosis.next;
        assert_eq!(json.len(), next.best.len());
        assert_eq!(json[0]["mass_kg"], best.mass);
        assert!(json[0]["open_bits"].as_f64() >= json[0]["expected_bits"].as_f64());
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
    let next = first.1.expect("it is open");
    assert!(!next.feasible.is_empty());
    for one in &next.feasible {
        assert_eq!((one.condition.angle_deg, one.condition.mass), (75.0, 0.05));
    }
}

#[test]
fn where_only_what_was_measured_is_feasible_nothing_is_recommended_that_tells_nothing() {
    let feasible = Feasible {
        angle_deg: vec![90.0],
        mass: vec![0.0667],
        speed: Some([2.0, 2.1]),
        ..Feasible::default()
    };
    let set = left_open(Effect::Buoyancy, |set| MeasurementSet {
        feasible: feasible.clone(),
        ..set.clone()
    });
    let next = next(&set).1.expect("it is open");
    let told = next.best.last().map_or(0.0, |one| one.expected_bits);
    assert!(told < 0.3 * next.open_bits, "{told} of {}", next.open_bits);
}

/// What the first six conditions of `set` expect of the others.
fn expected_of_the_rest(set: &MeasurementSet) -> FollowUp {
    let part = |is_early: bool| {
        let mut part = set.clone();
        part.runs.retain(|run| (run.condition < 6) == is_early);
        part
    };
    let (early, late) = (part(true), part(false));
    let model = baseline().expect("the shipped model loads");
    let [observed, new] = [&early, &late].map(Observed::of);
    let forward = |set, observed: &Observed| {
        ResistiveForward::new(&model, set, &observed.layouts()).expect("it has spheres")
    };
    let (before, after) = (forward(&early, &observed), forward(&late, &new));
    let problem = FitProblem { set: &early, observed: &observed, forward: &before };
    let diagnosis = diagnose(&problem, DEFAULT_SEED).expect("spheres stop");
    follow_up(&problem, &diagnosis, (&new, &after)).expect("spheres stop").expect("it predicts")
}

#[test]
fn new_runs_come_as_what_is_there_expects_and_it_stays_the_likeliest() {
    let effect = Effect::Buoyancy;
    let set = left_open(effect, MeasurementSet::clone);
    let amplitude = |q: &f64| vertical(effect, *q).measure(1) == set;
    let q = STRENGTHS.into_iter().find(amplitude).expect("it is one of these");
    let mut laboratory = vertical(effect, q);
    let like = laboratory.settings[0];
    let best = next(&set).1.expect("it is open").best;
    laboratory.settings.extend(best.iter().map(|one| {
        let Condition { speed, angle_deg: angle, mass, .. } = one.condition;
        Setting { speed, angle, mass, ..like }
    }));
    let n = set.conditions.len();
    let sequels: Vec<FollowUp> = (1..=5)
        .map(|seed| {
            let mut all = laboratory.measure(1);
            all.runs.retain(|run| run.condition < n);
            all.runs
                .extend(laboratory.measure(seed).runs.into_iter().filter(|run| run.condition >= n));
            expected_of_the_rest(&all)
        })
        .collect();
    let mut offs = Vec::new();
    for follow_up in &sequels {
        let truth =
            follow_up.hypotheses.iter().find(|one| one.id == effect.id()).expect("it is open");
        assert!(truth.chi2_per_number < 2.0, "{follow_up:?}");
        assert_eq!(follow_up.came.len(), best.len());
        offs.extend(follow_up.came.iter().map(|came| {
            let of_truth =
                came.expected.iter().find(|one| one.id == effect.id()).expect("it is there");
            (came.measured - of_truth.value) / of_truth.se
        }));
    }
    // One in a hundred is unexpected by chance, and one in five may be outweighed by a confounder.
    let most =
        |follow_up: &FollowUp| follow_up.hypotheses.iter().map(|one| one.after).fold(0.0, f64::max);
    let leads = |follow_up: &&FollowUp| {
        let truth = follow_up.hypotheses.iter().find(|one| one.id == effect.id());
        truth.is_some_and(|truth| truth.after >= most(follow_up))
    };
    assert!(sequels.iter().filter(leads).count() >= 4, "{sequels:?}");
    assert!(sequels.iter().filter(|follow_up| follow_up.is_unexpected).count() <= 1, "{sequels:?}");
    let mean_square = offs.iter().map(|off| off * off).sum::<f64>() / offs.len() as f64;
    // The 99.9 % point of χ² over its degrees of freedom, for five.
    assert!(mean_square < 4.1, "{offs:?}");
}

#[test]
fn new_runs_that_nothing_expected_are_told_by_their_chi2() {
    let mut laboratory = Laboratory { hidden: Vec::new(), ..vertical(Effect::Buoyancy, 0.0) };
    let like = laboratory.settings[0];
    laboratory.settings.push(Setting { speed: 2.0, angle: 60.0, ..like });
    let mut set = laboratory.measure(1);
    let as_expected = expected_of_the_rest(&set);
    let [alone] = as_expected.hypotheses.as_slice() else { panic!("{as_expected:?}") };
    assert_eq!(alone.id, "no effect");
    assert!(alone.chi2_per_number < 2.0 && !as_expected.is_unexpected, "{alone:?}");
    // Another body than is stated.
    set.conditions[6].mass *= 2.0;
    let other = expected_of_the_rest(&set);
    assert!(other.hypotheses[0].chi2_per_number > 5.0, "{other:?}");
    assert!(other.is_unexpected, "{other:?}");
}
