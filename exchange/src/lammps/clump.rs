//! A body that is no ball, as the rigid clump of balls by which LAMMPS knows it.
//!
//! Balls lie inside the body and touch its surface from there, as large ones as have room: the
//! larger, the smoother for as far as they let a grain come. What counts is a mean grain: its
//! centre lies on the surface that is parallel to that of the body, one grain radius outside, and
//! every point there is held by a ball to within [`TOLERANCE`] of that radius. A finer tolerance is
//! no better one: of balls that are so dense a grain touches some 2.5 δ/tolerance at the overlap δ,
//! each with the force of a whole contact.

use std::f64::consts::TAU;

use engine::grains::Space;
use engine::math::Vec3;
use engine::surface::Surface;

/// How much nearer a mean grain may come than the body lets it, in radii of that grain.
const TOLERANCE: f64 = 0.02;

/// Balls at most: a larger body has a wider tolerance.
const MOST: usize = 20_000;

/// Places at most, which take 64 MB.
const MOST_PLACES: usize = 2_000_000;

/// By how much the tolerance grows where that is not enough.
const WIDER: f64 = 1.5;

/// Radius of the largest balls, in that of a mean grain.
const LARGEST: f64 = 4.0;

/// How often it is halved for thin parts, edges and tips.
const HALVINGS: i32 = 8;

/// Places that are looked at along the distance at which one ball leaves off.
const LOOKS: f64 = 2.5;

/// How far a ball may stand out of the body, in its radius.
const OUTSIDE: f64 = 1e-6;

/// Ways inward that are tried to fit a ball.
const TRIES: usize = 200;

/// A ball of a clump.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ball {
    /// From the centre of mass, body frame (m).
    pub(super) centre: Vec3,
    /// (m).
    pub(super) radius: f64,
    /// Curvature (1/m) of the body where the ball touches its surface, as a contact law takes it.
    pub(super) curvature: f64,
}

/// Balls for a body.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Clump {
    pub(super) balls: Vec<Ball>,
    /// Radius of a mean grain (m).
    pub(super) grain: f64,
    /// How much nearer than the body a mean grain can come, at worst (m).
    pub(super) departure: f64,
}

impl Clump {
    /// Of the body of revolution, or planar body, with this `surface`, for grains of the mean
    /// radius `grain` (m).
    pub(super) fn of(surface: &dyn Surface, space: Space, grain: f64) -> Self {
        let mut tolerance = TOLERANCE * grain;
        let (balls, mut places) = loop {
            // Judged at places of another spacing than those that were covered.
            let others = spacing(grain, tolerance) / 1.6;
            let balls = cover(surface, space, grain, tolerance);
            let places = || Places::around(surface, space, grain, others);
            match balls.and_then(|balls| Some((balls, places()?))) {
                Some(found) => break found,
                None => tolerance *= WIDER,
            }
        };
        for ball in &balls {
            places.see(ball, tolerance);
        }
        let departure = places.largest_gap(&balls);
        Self { balls, grain, departure }
    }

    /// Least and largest radius of its balls (m).
    pub(super) fn radii(&self) -> [f64; 2] {
        let radii = self.balls.iter().map(|ball| ball.radius);
        [radii.clone().fold(f64::INFINITY, f64::min), radii.fold(0.0, f64::max)]
    }
}

/// Distance between places that are looked at (m).
fn spacing(grain: f64, tolerance: f64) -> f64 {
    // Where a ball as large as a grain leaves off: at d²/(2 (grain + grain)) = tolerance on a
    // plane.
    (4.0 * grain * tolerance).sqrt() / LOOKS
}

/// Balls that hold a grain everywhere to within `tolerance` (m), the largest first; none if they,
/// or the places that they are asked at, would be too many.
fn cover(surface: &dyn Surface, space: Space, grain: f64, tolerance: f64) -> Option<Vec<Ball>> {
    let mut places = Places::around(surface, space, grain, spacing(grain, tolerance))?;
    let mut balls = Vec::new();
    for halvings in 0..=HALVINGS {
        let radius = LARGEST * grain * 0.5_f64.powi(halvings);
        for index in 0..places.all.len() {
            let Place { at, gap } = places.all[index];
            if gap <= tolerance {
                continue;
            }
            let Some(ball) = fitted(surface, at, grain, radius) else { continue };
            // Smaller balls come nearer to an edge.
            if ball.gap(at, grain) > tolerance && halvings < HALVINGS {
                continue;
            }
            if balls.len() == MOST {
                return None;
            }
            places.see(&ball, tolerance);
            balls.push(ball);
        }
    }
    Some(balls)
}

/// A ball of `radius` (m) inside the body, as near as may be to a grain at `at`; none if there is
/// no room.
fn fitted(surface: &dyn Surface, at: Vec3, grain: f64, radius: f64) -> Option<Ball> {
    let touched = surface.closest(at);
    let mut centre = at - touched.normal * (grain + radius);
    for _ in 0..TRIES {
        let nearest = surface.closest(centre);
        let lacks = radius + nearest.gap;
        if lacks <= OUTSIDE * radius {
            return Some(Ball { centre, radius, curvature: touched.curvature });
        }
        centre -= nearest.normal * lacks;
    }
    None
}

impl Ball {
    /// How much nearer a grain of radius `grain` (m) at `at` could come to it (m).
    fn gap(&self, at: Vec3, grain: f64) -> f64 {
        (at - self.centre).norm() - self.radius - grain
    }
}

/// Where the centre of a mean grain may be that touches the body.
struct Place {
    at: Vec3,
    /// To the nearest ball seen so far (m).
    gap: f64,
}

/// Places around the axis of the body, at one height and distance from it.
struct Ring {
    /// (m).
    from_axis: f64,
    /// (m).
    height: f64,
    /// Where its places begin.
    first: usize,
}

/// Places all over a body, ring by ring from the lowest point of its axis to the highest.
struct Places {
    grain: f64,
    rings: Vec<Ring>,
    all: Vec<Place>,
}

impl Places {
    /// One about every `spacing` (m); none if they would be too many.
    fn around(surface: &dyn Surface, space: Space, grain: f64, spacing: f64) -> Option<Self> {
        let mut places = Self { grain, rings: Vec::new(), all: Vec::new() };
        let lowest = -(surface.support(-Vec3::z()) + grain);
        let highest = surface.support(Vec3::z()) + grain;
        places.add_ring(space, spacing, 0.0, lowest)?;
        let mut at = Vec3::new(0.0, 0.0, lowest);
        loop {
            // Along the outline of the parallel surface, which is smooth, and back onto it.
            let normal = surface.closest(at).normal;
            let ahead = at + Vec3::new(-normal.z, 0.0, normal.x) * spacing;
            if ahead.x <= 0.0 {
                break;
            }
            let nearest = surface.closest(ahead);
            at = ahead + nearest.normal * (grain - nearest.gap);
            places.add_ring(space, spacing, at.x, at.z)?;
        }
        places.add_ring(space, spacing, 0.0, highest)?;
        Some(places)
    }

    /// None if there would be too many places.
    fn add_ring(&mut self, space: Space, spacing: f64, from_axis: f64, height: f64) -> Option<()> {
        let around = match space {
            _ if from_axis == 0.0 => 1,
            Space::Planar => 2,
            Space::Spatial => (TAU * from_axis / spacing).ceil() as usize,
        };
        // A ring has a place at least: this bounds the rings too.
        if self.all.len() + around > MOST_PLACES {
            return None;
        }
        // Every other ring is turned by half a place; in a plane both sides are alike.
        let turned = match space {
            Space::Planar => 0.0,
            Space::Spatial => 0.5 * (self.rings.len() % 2) as f64,
        };
        self.rings.push(Ring { from_axis, height, first: self.all.len() });
        self.all.extend((0..around).map(|place| {
            let (sin, cos) = match (space, place) {
                (Space::Planar, 0) => (0.0, 1.0),
                (Space::Planar, _) => (0.0, -1.0),
                (Space::Spatial, _) => libm::sincos(TAU * (place as f64 + turned) / around as f64),
            };
            let at = Vec3::new(from_axis * cos, from_axis * sin, height);
            Place { at, gap: f64::INFINITY }
        }));
        Some(())
    }

    /// Takes note of `ball` where it leaves a gap of no more than about `most` (m).
    fn see(&mut self, ball: &Ball, most: f64) {
        let [x, y, z] = ball.centre.into();
        let from_axis = libm::hypot(x, y);
        let reach = ball.radius + self.grain + 2.0 * most;
        for (index, ring) in self.rings.iter().enumerate() {
            // No place of a ring is nearer than where it passes the half-plane of the ball.
            if libm::hypot(ring.from_axis - from_axis, ring.height - z) > reach {
                continue;
            }
            let end = self.rings.get(index + 1).map_or(self.all.len(), |next| next.first);
            for place in &mut self.all[ring.first..end] {
                place.gap = place.gap.min(ball.gap(place.at, self.grain));
            }
        }
    }

    /// The largest gap to the nearest of `balls` (m).
    fn largest_gap(&self, balls: &[Ball]) -> f64 {
        let gaps = self.all.iter().map(|place| match place.gap.is_finite() {
            true => place.gap,
            false => {
                let gaps = balls.iter().map(|ball| ball.gap(place.at, self.grain));
                gaps.fold(f64::INFINITY, f64::min)
            }
        });
        gaps.fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use engine::params::ParamTable;
    use intruders::find;

    use super::*;

    /// (m).
    const GRAIN: f64 = 0.002;

    fn surface(shape: &str, space: Space, params: &[(&'static str, f64)]) -> Arc<dyn Surface> {
        let table: ParamTable = params.iter().map(|(key, value)| (*key, *value)).collect();
        (find(shape).expect("a shape").build)(&table, space).surface
    }

    fn bodies(space: Space) -> [Arc<dyn Surface>; 4] {
        [
            surface("hemisphere", space, &[("diameter", 0.02)]),
            surface("cylinder", space, &[("diameter", 0.02), ("height", 0.015)]),
            surface("cone", space, &[("diameter", 0.02), ("apex_angle", 1.0)]),
            surface("link", space, &[("diameter", 0.006), ("length", 0.03), ("link_angle", 0.0)]),
        ]
    }

    /// Directions evenly over a sphere, by the golden angle; in a plane around a circle.
    fn directions(space: Space) -> impl Iterator<Item = Vec3> {
        const N: usize = 5000;
        (0..N).map(move |i| {
            let share = (i as f64 + 0.5) / N as f64;
            let (sin, cos) = libm::sincos(TAU * (0.618_033_988_749_894_9 * i as f64).fract());
            let (z, r) = (1.0 - 2.0 * share, 2.0 * (share * (1.0 - share)).sqrt());
            match space {
                Space::Planar => Vec3::new(cos, 0.0, sin),
                Space::Spatial => Vec3::new(r * cos, r * sin, z),
            }
        })
    }

    #[test]
    fn balls_lie_inside_the_body_and_hold_a_mean_grain_within_what_is_said() {
        for space in [Space::Planar, Space::Spatial] {
            for surface in bodies(space) {
                let clump = Clump::of(&*surface, space, GRAIN);
                for ball in &clump.balls {
                    let room = -surface.closest(ball.centre).gap;
                    assert!(room > (1.0 - 2.0 * OUTSIDE) * ball.radius, "{ball:?}");
                }
                // Between the places that were covered a little more than the tolerance.
                let share = clump.departure / GRAIN;
                assert!(share < 1.5 * TOLERANCE, "{share} of a grain, {} balls", clump.balls.len());
                for direction in directions(space) {
                    let mut at = direction * (surface.bounding_radius() + 2.0 * GRAIN);
                    let nearest = surface.closest(at);
                    at += nearest.normal * (GRAIN - nearest.gap);
                    let gaps = clump.balls.iter().map(|ball| ball.gap(at, GRAIN));
                    let gap = gaps.fold(f64::INFINITY, f64::min);
                    // Never farther than the body holds it, but for what a ball may stand out.
                    assert!(gap > -2.0 * OUTSIDE * GRAIN, "{gap:e} at {at:?}");
                    // The departure was found at places a share of the smallest balls apart.
                    assert!(gap < 1.3 * clump.departure, "{gap:e} at {at:?}");
                }
            }
        }
    }

    #[test]
    fn a_grain_on_a_dome_or_a_face_meets_the_curvature_of_the_body() {
        let [dome, ..] = bodies(Space::Spatial);
        let clump = Clump::of(&*dome, Space::Spatial, GRAIN);
        let of_curvature = |curvature: f64| {
            let of = |ball: &&Ball| (ball.curvature - curvature).abs() < 1e-9 * curvature.max(1.0);
            clump.balls.iter().filter(of).count()
        };
        // 1/R of the dome, none of the flat top and its edge.
        let [round, flat] = [of_curvature(100.0), of_curvature(0.0)];
        assert!(round > 100 && flat > 100 && round + flat == clump.balls.len(), "{round} {flat}");
    }

    #[test]
    fn a_body_that_is_large_for_its_grains_has_a_wider_tolerance_and_no_more_balls_than_that() {
        let large = surface("hemisphere", Space::Spatial, &[("diameter", 0.07)]);
        let clump = Clump::of(&*large, Space::Spatial, GRAIN);
        assert!(clump.balls.len() <= MOST && clump.balls.len() > MOST / 3, "{}", clump.balls.len());
        let share = clump.departure / GRAIN;
        assert!((TOLERANCE..5.0 * TOLERANCE).contains(&share), "{share}");
    }
}
