//! Beds come to rest as beds do, and to the packing that is asked for.

use engine::bed::{BedReport, GrainKind, Settling, fill};
use engine::boundary::Container;
use engine::grains::{Grain, Space};
use engine::math::Vec3;
use engine::parallel::with_threads;
use validation::rig::Linear;

/// Soft enough for a long step, stiff enough that a grain sinks in by less than a hundredth of its
/// diameter under ten others.
const SOFT: Linear = Linear {
    normal_stiffness: 300.0,
    tangential_stiffness: 300.0,
    normal_damping_rate: 2e3,
    tangential_damping_rate: 1e3,
    friction: 0.3,
};

/// Spheres of glass, 3 mm and 4 mm wide.
const KINDS: [GrainKind; 2] = [
    GrainKind { count: 500, radius: 1.5e-3, mass: 3.5e-5 },
    GrainKind { count: 150, radius: 2e-3, mass: 8.4e-5 },
];

#[test]
fn spheres_settle_to_the_packing_and_the_contacts_of_a_bed_with_friction() {
    let container = Container::walled_box(0.03, 0.03);
    let gravity = Vec3::new(0.0, 0.0, -9.81);
    with_threads(2, || {
        let grains = fill(&KINDS, (Space::Spatial, &container), 1);
        // A thirtieth of the collision of two of the lighter grains, 759 µs.
        let room = (Space::Spatial, container);
        let mut settling = Settling::new(&grains, room, gravity, vec![SOFT.stage()], 2.5e-5);
        while !settling.is_at_rest() {
            settling.advance().expect("a sound step");
            // Ten times as long as the fall from the top of the filled column.
            assert!(settling.clock().time() < 1.5, "no rest: {}", settling.restlessness());
        }
        let report = BedReport::of(settling.bed());
        // Loose and dense random packings of spheres fill 0.55 to 0.64; walls 10 diameters apart
        // take a little, the smaller kind in the gaps of the larger gives a little.
        assert!((0.55..0.66).contains(&report.packing_fraction), "{report:?}");
        // From the 4 of rigid spheres with much friction to the 6 of those without, walls counted.
        assert!((4.0..6.5).contains(&report.coordination), "{report:?}");
        assert!(settling.bed().grains.positions().all(|x| {
            let inside = |at: f64| at > 1.4e-3 && at < 0.03 - 1.4e-3;
            inside(x.x) && inside(x.y) && x.z > 1.4e-3
        }));
        // At rest nothing calms it any more, and for two further falls of a grain it needs nothing.
        let mean_height = |settling: &Settling| {
            settling.bed().grains.positions().map(|centre| centre.z).sum::<f64>() / 650.0
        };
        let before = mean_height(&settling);
        let until = settling.clock().time() + 2.0 * (3.2e-3_f64 / 9.81).sqrt();
        while settling.clock().time() < until {
            settling.advance().expect("a sound step");
            // Grains that roll into the last hollows shake others a little.
            assert!(settling.restlessness() < 10.0, "{}", settling.restlessness());
        }
        // A hundredth of the grains may still roll down by a radius each.
        let sunk = before - mean_height(&settling);
        assert!(sunk.abs() < 0.01 * 1.6e-3, "{sunk}");
    })
    .expect("two threads");
}

/// A loose bed of rough discs, by `seed`, that is tapped to `target`.
fn tapped(target: f64, seed: u64) -> Settling {
    let container = Container::walled_box(0.05, 0.0);
    let kinds = [GrainKind { count: 120, ..KINDS[0] }, GrainKind { count: 30, ..KINDS[1] }];
    let grains = fill(&kinds, (Space::Planar, &container), seed);
    let rough = Linear { friction: 0.9, ..SOFT };
    let gravity = Vec3::new(0.0, 0.0, -9.81);
    // Sixteen steps per collision are enough for the fall.
    Settling::new(&grains, (Space::Planar, container), gravity, vec![rough.stage()], 2.5e-5)
        .falling_by(5e-5)
        .tapped_to(target)
}

#[test]
fn beds_that_settle_as_in_a_viscous_fluid_are_looser() {
    let fraction = |seed: u64, rate: f64| {
        let mut settling = tapped(0.1, seed).dragged_by(rate);
        settle(&mut settling);
        BedReport::of(settling.bed()).packing_fraction
    };
    let seeds = 1..=4;
    let looser: f64 =
        seeds.map(|seed| fraction(seed, 0.0) - fraction(seed, 50.0)).sum::<f64>() / 4.0;
    assert!(looser > 0.005, "{looser}");
}

#[test]
fn a_column_that_nothing_dampens_breathes_and_comes_to_rest() {
    let (n, radius, mass) = (20, 1.5e-3, 3.5e-5);
    let column: Vec<Grain> = (0..n)
        .map(|id| Grain {
            position: Vec3::new(radius, 0.0, radius * f64::from(2 * id + 1)),
            velocity: Vec3::zeros(),
            spin: Vec3::zeros(),
            radius,
            mass,
            id,
        })
        .collect();
    let gravity = Vec3::new(0.0, 0.0, -9.81);
    // The weight of a grain compresses a contact by four thousandths of its diameter.
    let stiffness = mass * 9.81 / (4e-3 * 2.0 * radius);
    let elastic = Linear {
        normal_stiffness: stiffness,
        tangential_stiffness: stiffness,
        normal_damping_rate: 0.0,
        tangential_damping_rate: 0.0,
        friction: 0.0,
    };
    let room = (Space::Planar, Container::walled_box(2.0 * radius, 0.0));
    let mut settling = Settling::new(&column, room, gravity, vec![elastic.stage()], 1e-4);
    settle(&mut settling);
    // The static compression of a chain: (n − k + 1) m g / stiffness in contact k from the bottom.
    let sag = mass * 9.81 / stiffness * f64::from(n * (n + 1) / 2);
    let top = settling.bed().grains.positions().map(|centre| centre.z).fold(0.0, f64::max);
    let expected = radius * f64::from(2 * n - 1) - sag;
    // A bed at rest may still move with 10⁻⁶ m g d, √(10⁻⁶ / 0.3) of what the fall through the sag gave.
    assert!((top - expected).abs() < 4e-3 * sag, "{top} {expected}");
}

fn settle(settling: &mut Settling) {
    while !settling.is_at_rest() {
        settling.advance().expect("a sound step");
        assert!(settling.time_since_tap() < 3.0, "no rest: {}", settling.restlessness());
    }
}

#[test]
fn taps_make_a_loose_bed_denser_and_a_restart_between_them_changes_no_bit() {
    let fraction = |settling: &Settling| BedReport::of(settling.bed()).packing_fraction;
    let mut gains = Vec::new();
    // A bed may give way to none of its taps, so one proves little.
    for seed in 1..=3 {
        let mut loose = tapped(0.1, seed);
        settle(&mut loose);
        // Denser than the target, it is left alone.
        assert_eq!(loose.taps(), 0);
        let mut dense = tapped(0.9, seed);
        settle(&mut dense);
        // One tap that brings nothing is not yet the last.
        assert!(dense.taps() >= 4);
        gains.push(fraction(&dense) - fraction(&loose));
    }
    let mean = gains.iter().sum::<f64>() / gains.len() as f64;
    assert!(mean > 0.003, "{gains:?}");

    // While it falls by long steps, and in the air after a tap, by short ones.
    let (mut dense, mut saved) = (tapped(0.9, 2), Vec::new());
    while dense.taps() < 2 {
        dense.advance().expect("a sound step");
        assert!(dense.time_since_tap() < 3.0, "no rest: {}", dense.restlessness());
        let is_next = match saved.len() {
            0 => dense.clock().step == 500,
            1 => dense.taps() == 1,
            _ => false,
        };
        if is_next {
            saved.push(dense.save());
        }
    }
    assert_eq!(saved.len(), 2);
    for saved in saved {
        let mut resumed = tapped(0.9, 2);
        assert!(resumed.restore(saved));
        while resumed.taps() < 2 {
            resumed.advance().expect("a sound step");
            assert!(resumed.time_since_tap() < 3.0, "no rest: {}", resumed.restlessness());
        }
        assert_eq!(resumed.bed().resting(), dense.bed().resting());
    }
}
