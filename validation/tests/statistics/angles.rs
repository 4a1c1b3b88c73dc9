//! Impact angles that are not what a set states, and ways forward that are not zero at contact.

use diagnosis::diagnose::diagnose;
use diagnosis::fit::problem::{DEFAULT_SEED, FitProblem, Fitted};
use diagnosis::forward::sensitivity::Point;
use diagnosis::observed::Observed;
use diagnosis::resistive::ResistiveForward;
use diagnosis::verdict::{Diagnosis, Verdict};
use measurements::MeasurementSet;
use validation::benchmark::trial::baseline;

use crate::laboratory::Laboratory;
use crate::world::Effect;

/// How far the angles of the twelve conditions are from what is stated (deg): vertical launchers lean too.
const OFF: [f64; 12] = [-0.5, 0.7, -0.6, -0.3, -0.8, -0.4, 0.5, -0.7, 0.3, 0.6, -0.5, 0.8];

/// A quiet bed, in which `hidden` acts.
fn quiet(hidden: Vec<(Effect, f64)>) -> Laboratory {
    Laboratory { hidden, tau_coefficient: 0.01, tau_path: 0.025, ..Laboratory::default() }
}

/// Measured at angles that are `off` (deg) from those that the set states.
fn measured(mut laboratory: Laboratory, off: impl Fn(usize) -> f64) -> MeasurementSet {
    let stated: Vec<f64> = laboratory.settings.iter().map(|one| one.angle).collect();
    for (at, setting) in laboratory.settings.iter_mut().enumerate() {
        setting.angle += off(at);
    }
    let mut set = laboratory.measure(3);
    for (condition, angle) in set.conditions.iter_mut().zip(stated) {
        condition.angle_deg = angle;
    }
    set
}

fn with_bench<T>(set: &MeasurementSet, ask: impl FnOnce(&FitProblem<'_>) -> T) -> T {
    let model = baseline().expect("the shipped model loads");
    let observed = Observed::of(set);
    let forward = ResistiveForward::new(&model, set, &observed.layouts()).expect("it has spheres");
    ask(&FitProblem { set, observed: &observed, forward: &forward })
}

fn diagnosis(set: &MeasurementSet) -> Diagnosis {
    with_bench(set, |problem| diagnose(problem, DEFAULT_SEED).expect("spheres stop"))
}

fn baseline_of(set: &MeasurementSet) -> Fitted {
    with_bench(set, |problem| problem.fit(&Point::start(problem.forward)).expect("spheres stop"))
}

/// The value of an error of the apparatus, and its standard error.
fn error(found: &Diagnosis, id: &str) -> (f64, f64) {
    let one = found.apparatus.iter().find(|one| one.id == id).expect("it is a parameter");
    (one.value, one.se.expect("it is no bound"))
}

#[test]
fn angles_that_are_each_a_little_off_are_no_effect() {
    let set = measured(quiet(Vec::new()), |at| OFF[at]);
    let found = diagnosis(&set);
    assert!(found.effects.is_empty(), "{:?} {:?}", found.verdict, found.effects);
    assert_ne!(found.verdict, Verdict::NoneOfTheCandidates);
    // The root mean square of those that are fitted, about their mean; half is two errors of a scatter of ten numbers.
    let fitted = &OFF[..10];
    let mean = fitted.iter().sum::<f64>() / 10.0;
    let expected = (fitted.iter().map(|off| (off - mean).powi(2)).sum::<f64>() / 9.0).sqrt();
    let sd = baseline_of(&set).noise.angles.sd.to_degrees();
    assert!((sd / expected - 1.0).abs() < 0.5, "{sd} {expected}");
}

#[test]
fn an_effect_is_found_beside_angles_that_are_off() {
    for (effect, q) in [(Effect::Lift, 0.3), (Effect::Viscous, 2.0)] {
        let found = diagnosis(&measured(quiet(vec![(effect, q)]), |at| OFF[at]));
        assert_eq!(found.verdict, Verdict::Supported, "{effect:?} {:?}", found.unexplained);
        assert_eq!(found.leaders, [effect.id()]);
        let [low, high] = found.amplitudes[0].interval_95;
        let holds = low.is_none_or(|low| low < q) && high.is_none_or(|high| q < high);
        assert!(holds, "{effect:?} {low:?} {high:?}");
    }
}

#[test]
fn a_launcher_that_is_off_by_the_same_everywhere_is_an_error_of_the_apparatus() {
    let found = diagnosis(&measured(quiet(Vec::new()), |_| -0.8));
    assert!(found.effects.is_empty(), "{:?}", found.effects);
    let (value, se) = error(&found, "launch-angle");
    assert!((value.to_degrees() + 0.8).abs() < 4.0 * se.to_degrees(), "{value} {se}");
}

#[test]
fn ways_that_are_zero_after_contact_are_an_error_of_the_apparatus() {
    /// Of a frame.
    const LATE: f64 = 0.6;
    let mut set = measured(quiet(Vec::new()), |_| 0.0);
    let late = LATE / set.instrument.rate.expect("it is a camera");
    for run in &mut set.runs {
        let condition = &set.conditions[run.condition];
        let ahead = late * condition.speed * libm::cos(condition.angle_deg.to_radians());
        run.frames.iter_mut().for_each(|frame| frame.x -= ahead);
        run.final_x = run.final_x.map(|x| x - ahead);
    }
    let found = diagnosis(&set);
    assert!(found.effects.is_empty(), "{:?}", found.effects);
    let (value, se) = error(&found, "range-zero");
    assert!((value - late).abs() < 4.0 * se && se < 0.3 * late, "{value} {se} {late}");
}

#[test]
fn exact_angles_scatter_nothing() {
    let fitted = baseline_of(&measured(quiet(Vec::new()), |_| 0.0));
    let sd = fitted.noise.angles.sd.to_degrees();
    assert!(sd < 0.1, "{sd}");
    let of_runs = fitted.noise.spread.angle.to_degrees();
    assert!(of_runs < 0.1, "{of_runs}");
}
