//! Beds of spheres come to rest as beds of spheres do.

use engine::bed::{BedReport, GrainKind, Settling, fill};
use engine::boundary::Container;
use engine::grains::Space;
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
        assert!(settling.bed().grains.position.iter().all(|x| {
            let inside = |at: f64| at > 1.4e-3 && at < 0.03 - 1.4e-3;
            inside(x.x) && inside(x.y) && x.z > 1.4e-3
        }));
    })
    .expect("two threads");
}
