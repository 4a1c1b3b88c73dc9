//! The forms that a missing force is looked for among: powers, layers, steps and decays in depth; powers, saturations and
//! decays in speed; the impact speed and what is left of it; angle; and products of two.

use super::term::{Factor, Length, State, Term};

/// Places at which layers and steps are tried, over the greatest depth.
const PLACES: usize = 10;

/// All of them, for what `states` go through.
pub(super) fn library(states: &[State]) -> Vec<Term> {
    let most = |of: &dyn Fn(&State) -> f64| states.iter().map(of).fold(f64::MIN_POSITIVE, f64::max);
    let differs = |of: &dyn Fn(&State) -> f64| {
        let least = states.iter().map(of).fold(f64::INFINITY, f64::min);
        most(of) > least * (1.0 + 1e-6)
    };
    let mut depths: Vec<Factor> = [0.5, 1.0, 1.5, 2.0, 3.0].map(Factor::DepthPower).into();
    // Before bodies of one size a length of the bed and one of the body are the same.
    let units = match differs(&|one| one.diameter) {
        true => &[Length::Millimetres, Length::Diameters][..],
        false => &[Length::Millimetres][..],
    };
    for &unit in units {
        depths.extend(of_depth(unit, most(&|one| one.depth / unit.size(one.diameter))));
    }
    let speeds = of_speed(most(&|one| one.speed / one.own_speed()));
    let angles = match differs(&|one| one.angle) {
        true => vec![Factor::Sine, Factor::Cosine, Factor::SineOfTwice],
        false => Vec::new(),
    };
    let impacts = match differs(&|one| one.impact_speed) {
        true => of_impact(),
        false => Vec::new(),
    };
    let singles =
        depths.iter().chain(&speeds).chain(&angles).chain(&impacts).map(|&one| Term(vec![one]));
    let products = |a: &[Factor], b: &[Factor]| -> Vec<Term> {
        a.iter().flat_map(|&one| b.iter().map(move |&two| Term(vec![one, two]))).collect()
    };
    let mut all: Vec<Term> = singles.collect();
    all.extend(products(&depths, &speeds));
    all.extend(products(&depths, &angles));
    all.extend(products(&speeds, &angles));
    let power = depths.iter().copied().filter(|one| matches!(one, Factor::DepthPower(_)));
    let power: Vec<Factor> = power.collect();
    let local = depths.iter().copied().filter(|one| !matches!(one, Factor::DepthPower(_)));
    all.extend(products(&power, &local.collect::<Vec<_>>()));
    for others in [&power, &speeds, &angles] {
        all.extend(products(others, &impacts));
    }
    all
}

fn of_depth(unit: Length, reach: f64) -> Vec<Factor> {
    let mut all: Vec<Factor> =
        [0.1, 0.3].map(|share| Factor::Fading { unit, over: share * reach }).into();
    for place in 0..PLACES {
        let centre = (place as f64 + 0.5) / PLACES as f64 * reach;
        let width = 0.05 * reach;
        let layer = |share| Factor::Layer { unit, centre, width: share * reach };
        all.extend([0.06, 0.15].map(layer));
        all.push(Factor::Below { unit, depth: centre, width });
        all.push(Factor::Above { unit, depth: centre, width });
    }
    all
}

fn of_speed(most: f64) -> Vec<Factor> {
    let mut all: Vec<Factor> = [0.5, 1.0, 1.5, 2.0, 2.5, 3.0].map(Factor::SpeedPower).into();
    all.extend([0.05, 0.15, 0.4].map(|share| Factor::Saturating { at: share * most }));
    all.extend([0.1, 0.25, 0.5].map(|share| Factor::Slow { below: share * most }));
    all
}

fn of_impact() -> Vec<Factor> {
    let mut all: Vec<Factor> = [0.5, 1.0, 2.0].map(Factor::ImpactSpeedPower).into();
    all.extend([0.5, 1.0, 2.0].map(Factor::LeftPower));
    all.extend([0.2, 0.4, 0.6, 0.8].map(|to| Factor::Slowed { to, width: 0.05 }));
    all
}
