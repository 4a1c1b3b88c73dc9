//! What is learned from repeats.

use diagnosis::fit::problem::FitProblem;
use diagnosis::forward::sensitivity::{Point, Spread};
use diagnosis::noise::Noise;
use diagnosis::observed::Observed;

use crate::laboratory::Laboratory;
use crate::world::{Effect, TRUTH, TwoTerm};

#[test]
fn scatter_of_coefficients_and_path_is_recovered() {
    // Settings twice over: 24 conditions with 5 repeats are 96 independent deviations.
    let mut settings = Laboratory::default().settings;
    settings.extend_from_within(..);
    for (tau_coefficient, tau_path) in [(0.05, 0.12), (0.08, 0.04), (0.05, 0.05)] {
        let laboratory = Laboratory {
            settings: settings.clone(),
            holdout: 0,
            tau_coefficient,
            tau_path,
            spacing: None,
            ..Laboratory::default()
        };
        let set = laboratory.measure(1);
        let observed = Observed::of(&set);
        let forward = TwoTerm::new(&laboratory.settings, observed.layouts(), &[]);
        let problem = FitProblem { set: &set, observed: &observed, forward: &forward };
        let noise = problem.fit(&Point::start(&forward)).expect("spheres stop").noise;
        let Spread { coefficient, path, .. } = noise.spread;
        // A standard deviation from 96 numbers per input is known to 7 %; coefficients and path move a
        // trajectory alike, which doubles that. Between two and three of those.
        let within = |found: f64, truth: f64| {
            assert!(found < 1.35 * truth && truth < 1.35 * found, "{found} for {truth}");
        };
        within(coefficient, tau_coefficient);
        within(path, tau_path);
        // Readings are not credited with less than the floor of 0.1 mm, which is the truth here.
        assert!((1.0..1.2).contains(&noise.reading), "{}", noise.reading);
    }
}

#[test]
fn the_right_model_fits_to_its_noise_and_its_parameters_come_back() {
    let laboratory = Laboratory::default();
    let sets = 8;
    let mut chi2_per_n = 0.0;
    let mut mean = [0.0; 2];
    for seed in 0..sets {
        let set = laboratory.measure(seed);
        let observed = Observed::of(&set);
        let forward = TwoTerm::new(&laboratory.settings, observed.layouts(), &Effect::LISTED);
        let problem = FitProblem { set: &set, observed: &observed, forward: &forward };
        let fit = problem.fit(&Point::start(&forward)).expect("spheres stop").fit;
        chi2_per_n += fit.chi2 / fit.residual.len() as f64 / sets as f64;
        for (at, (value, truth)) in fit.point.parameters.iter().zip(TRUTH).enumerate() {
            let se = fit.standard_error(at).expect("no bound is near");
            // Four standard errors: chance takes one in fifteen thousand.
            assert!((value - truth).abs() < 4.0 * se, "{value} ± {se} for {truth}");
            mean[at] += value / truth / sets as f64;
        }
    }
    // 8 times 560 numbers scatter by 2 %; the grain-scale force is not the noise model's six nodes,
    // which is worth some ten percent either way.
    assert!((0.8..1.2).contains(&chi2_per_n), "{chi2_per_n}");
    // One set knows them to 2 %, the mean of eight to 0.7 %; without the shift of the mean run the
    // coefficients come out up to 4 % off.
    assert!(mean.iter().all(|ratio| (ratio - 1.0).abs() < 0.02), "{mean:?}");
}

#[test]
fn a_camera_alone_would_have_been_overconfident() {
    let laboratory = Laboratory::default();
    let set = laboratory.measure(1);
    let observed = Observed::of(&set);
    let forward = TwoTerm::new(&laboratory.settings, observed.layouts(), &Effect::LISTED);
    let problem = FitProblem { set: &set, observed: &observed, forward: &forward };
    let start = Point::start(&forward);
    let honest = problem.fit(&start).expect("spheres stop");
    // Readings of 0.1 mm and beds that are all the same.
    let camera = Noise { spread: Noise::stated().spread, ..honest.noise };
    let weights = problem.weights(&honest.fit.point, &camera, &observed.fit).expect("spheres stop");
    let fit = problem.data(&weights).fit(&start).expect("spheres stop");
    // The right model would be refused: beds make means of five differ by millimetres.
    assert!(fit.chi2 / fit.residual.len() as f64 > 5.0, "{}", fit.chi2);
    let [naive, honest] = [&fit, &honest.fit].map(|fit| fit.standard_error(0).expect("it is free"));
    assert!(naive < 0.3 * honest);
}

#[test]
fn an_amplitude_beyond_its_range_is_held_at_the_bound() {
    // Bodies that are heavier in the bed: no buoyancy does that.
    let laboratory = Laboratory::hiding(Effect::Buoyancy, -3.0);
    let set = laboratory.measure(1);
    let observed = Observed::of(&set);
    let forward = TwoTerm::new(&laboratory.settings, observed.layouts(), &[Effect::Buoyancy]);
    let problem = FitProblem { set: &set, observed: &observed, forward: &forward };
    let without = problem.fit(&Point::start(&forward)).expect("spheres stop");
    let mut start = without.fit.point.clone();
    start.effects.push((0, 1.0));
    let with = problem.data(&without.weights).fit(&start).expect("spheres stop");
    assert_eq!(with.point.effects, [(0, 0.0)]);
    assert!(with.standard_error(2).is_none() && with.n_free() == 2);
    // The rest is fitted as if it were absent, to the tolerance of the search.
    assert!((with.chi2 - without.fit.chi2).abs() < 1e-3 * without.fit.chi2);
}
