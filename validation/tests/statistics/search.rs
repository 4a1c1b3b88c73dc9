//! Where the search of a fit ends: not at zero, and not at a bound, unless the data are there.

use diagnosis::fit::problem::FitProblem;
use diagnosis::forward::sensitivity::Point;
use diagnosis::observed::Observed;

use crate::laboratory::Laboratory;
use crate::world::{Effect, TwoTerm};

#[test]
fn a_fit_from_nothing_or_from_the_end_of_a_range_finds_what_one_from_between_does() {
    let laboratory = Laboratory::hiding(Effect::Buoyancy, 3.0);
    let set = laboratory.measure(1);
    let observed = Observed::of(&set);
    let forward = TwoTerm::new(&laboratory.settings, observed.layouts(), &[Effect::Buoyancy]);
    let problem = FitProblem { set: &set, observed: &observed, forward: &forward };
    let between = Point { parameters: vec![1.0, 10.0], effects: vec![(0, 1.0)] };
    let fitted = problem.fit(&between).expect("spheres stop");
    let data = problem.data(&fitted.weights);
    // A logarithm has no derivative at zero, and comes to none from next to it.
    for (drag, friction, buoyancy) in [
        (0.0, 10.0, 1.0),
        (1e-18, 10.0, 1.0),
        (1.0, 100.0, 1.0),
        (1.0, 10.0, 0.0),
        (1.0, 10.0, 20.0),
    ] {
        let start = Point { parameters: vec![drag, friction], effects: vec![(0, buoyancy)] };
        let fit = data.fit(&start).expect("spheres stop");
        let more = fit.chi2 / fitted.fit.chi2 - 1.0;
        assert!(more < 1e-3, "{start:?}: {:?} with {} of χ² more", fit.point, more);
    }
}
