use std::collections::BTreeSet;
use std::sync::Arc;

use super::*;
use crate::bed::{GrainKind, fill};
use crate::body::{NoIntruder, RigidBody};
use crate::math::Quat;
use crate::surface::{Surface, SurfacePoint};

const RADIUS: f64 = 1e-3;

/// A ball about its origin.
struct Ball(f64);

impl Surface for Ball {
    fn closest(&self, point: Vec3) -> SurfacePoint {
        let distance = point.norm();
        SurfacePoint {
            normal: point / distance,
            gap: distance - self.0,
            curvature: 1.0 / self.0,
            felt: true,
        }
    }

    fn support(&self, _: Vec3) -> f64 {
        self.0
    }

    fn bounding_radius(&self) -> f64 {
        self.0
    }
}

/// Cells of the grid, and how many pairs of grains are listed, beside a ball of so many grain radii.
fn grid_beside(ratio: f64) -> ([usize; 3], usize) {
    let container = Container::walled_box(0.03, 0.03);
    let kinds = [GrainKind { count: 500, radius: RADIUS, mass: 1e-5 }];
    let grains = fill(&kinds, (Space::Spatial, &container), 1);
    let resting = RestingBed::without_history(Space::Spatial, grains);
    let mut bed = GrainBed::new(&resting, container, Vec3::zeros(), Vec::new(), 1);
    let size = ratio * RADIUS;
    let mut ball = RigidBody::new("ball", Arc::new(Ball(size)), 1.0, Vec3::repeat(1.0));
    let start = Vec3::new(0.015, 0.015, size);
    ball.launch(start, Quat::identity(), Vec3::zeros(), Vec3::zeros());
    bed.pair_lists = BlockFreshness::stale(bed.pair_lists.margin(), 1);
    bed.refresh_neighbours(&ball, 0.0);
    (bed.grid.cells(), bed.contacts.listed_pairs().count())
}

#[test]
fn a_large_intruder_makes_neither_cells_nor_pairs_of_grains_larger() {
    let [small, twenty, hundred] = [1.0, 20.0, 100.0].map(grid_beside);
    assert!(small.0.iter().product::<usize>() > 300 && small.1 > 100, "{small:?}");
    assert_eq!(small, twenty);
    assert_eq!(small, hundred);
}

#[test]
fn no_two_grains_meet_unseen_where_some_fly_and_most_lie_still() {
    let container = Container::walled_box(0.4, 0.4);
    let kinds = [GrainKind { count: 2500, radius: RADIUS, mass: 1e-5 }];
    let mut grains = fill(&kinds, (Space::Planar, &container), 2);
    let corner = grains.iter_mut().filter(|grain| grain.position.x < 0.05);
    for (k, grain) in corner.enumerate().filter(|(k, _)| k % 5 == 0) {
        let turn = k as f64;
        grain.velocity = Vec3::new(libm::cos(turn), 0.0, libm::sin(turn)) * (0.1 + 0.1 * turn);
    }
    let resting = RestingBed::without_history(Space::Planar, grains);
    let mut bed = GrainBed::new(&resting, container, Vec3::zeros(), Vec::new(), 0);
    let dt = 1e-5;
    let stride = Stride { before: 0.0, after: 0.0, drift: dt };
    let (mut met, mut spared) = (0, 0);
    for _ in 0..200 {
        bed.refresh_neighbours(&NoIntruder, dt);
        spared += bed.marks.iter().filter(|mark| !**mark).count();
        bed.evaluate_contacts(&NoIntruder, dt);
        let seen = BTreeSet::from_iter(bed.touching_pairs());
        let n = bed.grains.len();
        for i in 0..n {
            for j in i + 1..n {
                let reach = bed.grains.radius(i) + bed.grains.radius(j);
                if bed.grains.apart(i, j).norm_squared() < reach * reach {
                    met += 1;
                    assert!(seen.contains(&[i, j]));
                }
            }
        }
        bed.kick_drift(&stride);
    }
    assert!(met > 0 && spared > 0, "{met} {spared}");
}
