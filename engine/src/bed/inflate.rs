//! Grains grown in place: a bed made by inflation falls but a little, where one made by rain falls from twice its
//! height.

use super::fill::{FreeSpace, GrainKind, fill, fill_fraction, fill_height, large_first};
use crate::boundary::{Container, Period};
use crate::grains::Grain;
use crate::math::Vec3;
use crate::space::Space;

/// Radii grow by this share of what they are at a time.
const GROWTH: f64 = 0.005;

/// Grains are pushed so far apart that their radii could be larger by this share …
const CLEARANCE: f64 = 1e-3;

/// … and stay where they are once all are apart by this much of it.
const ENOUGH: f64 = 0.3;

/// Pairs are listed with a gap of up to this share of the largest diameter.
const MARGIN: f64 = 0.1;

/// Sweeps over all pairs in which grains of one size have to come apart; else they get more room.
const SWEEPS: usize = 2_000;

/// By how much the room grows then.
const MORE_ROOM: f64 = 1.01;

/// Packing fractions to which grains can be grown in `space`: from what grains at random places fill to a
/// little below where they jam (0.84 for discs of two sizes, 0.64 for spheres).
pub fn inflation_range(space: Space) -> (f64, f64) {
    match space {
        Space::Planar => (fill_fraction(space), 0.82),
        Space::Spatial => (fill_fraction(space), 0.62),
    }
}

/// Grains of all kinds in `container`, none touching another or a wall, as [`fill`] has them: placed at
/// random while they are small, they grow all at one rate and push each other away until they fill `fraction`
/// of the space below a lid. Nothing is slowed, held by friction or weighs anything in the meantime:
/// overlaps are taken back pair by pair, sweep by sweep.
///
/// Where they jam before, as they may between close walls, the room becomes higher by a hundredth at a time.
/// `fraction` is one of [`inflation_range`].
pub fn inflate(
    kinds: &[GrainKind],
    (space, container): (Space, &Container),
    fraction: f64,
    seed: u64,
) -> Vec<Grain> {
    let share = fill_fraction(space) / fraction;
    let start = match space {
        Space::Planar => share.sqrt(),
        Space::Spatial => libm::cbrt(share),
    };
    let kinds = large_first(kinds);
    let small: Vec<GrainKind> =
        kinds.iter().map(|kind| GrainKind { radius: start * kind.radius, ..*kind }).collect();
    let full: Vec<f64> =
        kinds.iter().flat_map(|kind| std::iter::repeat_n(kind.radius, kind.count)).collect();
    let mut grains = fill(&small, (space, container), seed);
    let mut room = Room {
        space,
        container,
        height: fill_height(&small, space, container),
        widest: 2.0 * (1.0 + CLEARANCE) * full.iter().fold(0.0, |most: f64, one| most.max(*one)),
        period: container.period(space),
    };
    let highest = grains.iter().fold(0.0, |top: f64, grain| top.max(grain.position.z));
    let lower = ((room.height - 0.5 * start * room.widest) / highest).min(1.0);
    grains.iter_mut().for_each(|grain| grain.position.z *= lower);
    let mut scale = start;
    while scale < 1.0 {
        scale = (scale * (1.0 + GROWTH)).min(1.0);
        for (grain, full) in grains.iter_mut().zip(&full) {
            grain.radius = scale * full;
            grain.position = room.inside(grain.position, grain);
        }
        while !room.part(&mut grains) {
            room.height *= MORE_ROOM;
            grains.iter_mut().for_each(|grain| grain.position.z *= MORE_ROOM);
        }
    }
    grains
}

/// Pairs of grains that are near each other.
#[derive(Default)]
struct Near {
    pairs: Vec<(usize, usize)>,
    /// Where grains were when they were listed.
    listed: Vec<Vec3>,
}

impl Near {
    /// Whether two grains that are in no pair may have come across `margin` (m) since they were listed, or none
    /// were.
    fn is_stale(&self, grains: &[Grain], margin: f64) -> bool {
        let far = |(grain, listed): (&Grain, &Vec3)| {
            (grain.position - listed).norm_squared() > 0.25 * margin * margin
        };
        self.listed.is_empty() || grains.iter().zip(&self.listed).any(far)
    }
}

/// The space in which grains grow.
struct Room<'a> {
    space: Space,
    container: &'a Container,
    /// Up to its lid (m).
    height: f64,
    /// Diameter of the largest grain once it has grown (m).
    widest: f64,
    period: Period,
}

impl Room<'_> {
    /// Pushes grains apart until none overlaps another; `false` if they do not come apart.
    fn part(&self, grains: &mut [Grain]) -> bool {
        let mut near = Near::default();
        (0..SWEEPS).any(|_| {
            if near.is_stale(grains, MARGIN * self.widest) {
                self.list(grains, &mut near);
            }
            self.sweep(&near.pairs, grains) >= ENOUGH * CLEARANCE
        })
    }

    /// Lists the pairs that are nearer than the margin.
    fn list(&self, grains: &[Grain], near: &mut Near) {
        let reach = (1.0 + MARGIN) * self.widest;
        let mut cells = FreeSpace::new(self.space, self.container, self.height, reach);
        near.pairs.clear();
        near.listed = grains.iter().map(|grain| grain.position).collect();
        for (at, grain) in grains.iter().enumerate() {
            let others = cells.near(grain.position).filter(|&other| {
                let sum = grain.radius + grains[other].radius + MARGIN * self.widest;
                let apart = self.period.shortest(grain.position - grains[other].position);
                apart.norm_squared() < sum * sum
            });
            near.pairs.extend(others.map(|other| (at, other)));
            cells.take(grain.position, at);
        }
    }

    /// Pushes every pair apart that is too near, and grains off the walls; the least gap that a pair had, in
    /// the sum of its radii, where any was too near.
    fn sweep(&self, pairs: &[(usize, usize)], grains: &mut [Grain]) -> f64 {
        let mut least = CLEARANCE;
        for &(a, b) in pairs {
            let sum = grains[a].radius + grains[b].radius;
            let apart = self.period.shortest(grains[a].position - grains[b].position);
            let distance = apart.norm();
            let gap = distance / sum - 1.0;
            if gap < CLEARANCE {
                least = least.min(gap);
                let along = if distance > 0.0 { apart / distance } else { Vec3::z() };
                let push = along * (0.5 * (CLEARANCE - gap) * sum);
                for (grain, push) in [(a, push), (b, -push)] {
                    let place = grains[grain].position + push;
                    grains[grain].position = self.inside(place, &grains[grain]);
                }
            }
        }
        least
    }

    /// The nearest place to `place` at which `grain` is in the room, a little off its walls.
    fn inside(&self, place: Vec3, grain: &Grain) -> Vec3 {
        let radius = (1.0 + CLEARANCE) * grain.radius;
        let mut inside = self.container.nearest_within(self.space, place, radius);
        inside.z = place.z.min(self.height - radius).max(radius);
        inside
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::boundary::{Base, Bottom, Sides};

    const KINDS: [GrainKind; 2] = [
        GrainKind { count: 700, radius: 2.28e-3, mass: 4.9e-5 },
        GrainKind { count: 140, radius: 3.175e-3, mass: 9.7e-5 },
    ];

    fn fraction_of(grains: &[Grain], space: Space, container: &Container) -> f64 {
        let top =
            grains.iter().fold(0.0, |top: f64, grain| top.max(grain.position.z + grain.radius));
        let content: f64 = grains.iter().map(|grain| space.grain_content(2.0 * grain.radius)).sum();
        content / (top * container.base_area(space))
    }

    #[test]
    fn grains_that_have_grown_fill_what_was_asked_for_and_touch_neither_each_other_nor_a_wall() {
        let round = Container {
            base: Base::Circle { diameter: 0.05 },
            sides: Sides::Wall,
            bottom: Bottom::Wall,
        };
        let periodic = Container { sides: Sides::Periodic, ..Container::walled_box(0.1, 0.03) };
        let cases = [
            (Space::Planar, Container::walled_box(0.15, 0.0), 0.80),
            (Space::Planar, periodic, 0.80),
            (Space::Spatial, Container::walled_box(0.05, 0.05), 0.50),
            (Space::Spatial, periodic, 0.58),
            (Space::Spatial, round, 0.50),
        ];
        for (space, container, wanted) in cases {
            let grains = inflate(&KINDS, (space, &container), wanted, 7);
            assert_eq!(grains.len(), 840);
            let found = fraction_of(&grains, space, &container);
            assert!((found / wanted - 1.0).abs() < 0.01, "{space:?}: {found}, not {wanted}");
            let period = container.period(space);
            for (i, a) in grains.iter().enumerate() {
                assert!(container.holds(space, (a.position.x, a.position.y), a.radius));
                assert!(a.position.z >= a.radius);
                for b in &grains[..i] {
                    let apart = period.shortest(a.position - b.position).norm();
                    assert!(apart > a.radius + b.radius, "{space:?}: {apart}");
                }
            }
            assert_eq!(grains, inflate(&KINDS, (space, &container), wanted, 7));
        }
    }

    #[test]
    fn grains_that_find_no_room_between_close_walls_get_a_higher_one() {
        let narrow = Container::walled_box(0.011, 0.0);
        let kinds = [GrainKind { count: 40, ..KINDS[0] }];
        let grains = inflate(&kinds, (Space::Planar, &narrow), 0.82, 3);
        assert!(grains.iter().all(|grain| grain.radius.to_bits() == KINDS[0].radius.to_bits()));
        assert!(fraction_of(&grains, Space::Planar, &narrow) < 0.82);
    }
}
