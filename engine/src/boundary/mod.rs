//! The container: its walls, or what stands in their place.

mod absorbing;
mod period;
mod walls;

use std::f64::consts::FRAC_PI_4;
use std::sync::Arc;

use crate::math::Vec3;
use crate::space::Space;
use crate::surface::Surface;

pub use absorbing::{Absorber, Layer};
pub use period::Period;
pub use walls::{HalfSpace, InwardCylinder};

/// A container with a floor at z = 0 and upright sides, open at the top.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Container {
    /// What it looks like from above.
    pub base: Base,
    /// What its sides are.
    pub sides: Sides,
    /// What its floor is.
    pub bottom: Bottom,
}

/// A container from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Base {
    /// 0 ≤ x ≤ `width`, and in space 0 ≤ y ≤ `depth`.
    Rectangle {
        /// (m).
        width: f64,
        /// (m); ignored in a planar bed.
        depth: f64,
    },
    /// A circle about x = y = half its diameter, in space.
    Circle {
        /// (m).
        diameter: f64,
    },
}

/// The sides of a container.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sides {
    /// Walls that grains touch.
    Wall,
    /// None: what leaves on one side comes in on the other. For a rectangle.
    Periodic,
    /// Walls with a layer before them that takes the energy out of waves.
    Absorbing(Layer),
}

/// The floor of a container.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bottom {
    /// A wall that grains touch.
    Wall,
    /// A wall with a layer above it that takes the energy out of waves.
    Absorbing(Layer),
}

impl Container {
    /// A box with walls, `width` (m) along x and `depth` (m) along y.
    pub const fn walled_box(width: f64, depth: f64) -> Self {
        Self { base: Base::Rectangle { width, depth }, sides: Sides::Wall, bottom: Bottom::Wall }
    }

    /// Its extents along x and y (m), from 0.
    pub fn extents(&self) -> [f64; 2] {
        match self.base {
            Base::Rectangle { width, depth } => [width, depth],
            Base::Circle { diameter } => [diameter, diameter],
        }
    }

    /// Area of the floor (m²), or its width (m) in a plane.
    pub fn base_area(&self, space: Space) -> f64 {
        match (self.base, space) {
            (Base::Rectangle { width, .. }, Space::Planar) => width,
            (Base::Rectangle { width, depth }, Space::Spatial) => width * depth,
            (Base::Circle { diameter }, Space::Planar) => diameter,
            (Base::Circle { diameter }, Space::Spatial) => FRAC_PI_4 * diameter * diameter,
        }
    }

    /// The smaller distance of two opposite sides (m).
    pub fn narrowest(&self, space: Space) -> f64 {
        let [width, depth] = self.extents();
        match space {
            Space::Planar => width,
            Space::Spatial => width.min(depth),
        }
    }

    /// Whether a circle (disc, sphere) of `radius` (m) about x, y lies between the sides; periodic ones
    /// ask for the centre alone.
    pub fn holds(&self, space: Space, (x, y): (f64, f64), radius: f64) -> bool {
        let radius = if self.sides == Sides::Periodic { 0.0 } else { radius };
        let within = |at: f64, length: f64| at >= radius && at <= length - radius;
        match (self.base, space) {
            (Base::Rectangle { width, .. }, Space::Planar) => within(x, width),
            (Base::Rectangle { width, depth }, Space::Spatial) => {
                within(x, width) && within(y, depth)
            }
            (Base::Circle { diameter }, Space::Planar) => within(x, diameter),
            (Base::Circle { diameter }, Space::Spatial) => {
                let axis = 0.5 * diameter;
                let from_axis = Vec3::new(x - axis, y - axis, 0.0).norm();
                from_axis <= axis - radius
            }
        }
    }

    /// The nearest place to `place` at which the sides hold a circle (disc, sphere) of `radius` (m), and its
    /// image inside of sides that repeat; as high as it was.
    pub(crate) fn nearest_within(&self, space: Space, place: Vec3, radius: f64) -> Vec3 {
        if self.sides == Sides::Periodic {
            return self.period(space).inside(place);
        }
        let within = |at: f64, length: f64| at.min(length - radius).max(radius);
        match (self.base, space) {
            (
                Base::Rectangle { width: length, .. } | Base::Circle { diameter: length },
                Space::Planar,
            ) => Vec3::new(within(place.x, length), place.y, place.z),
            (Base::Rectangle { width, depth }, Space::Spatial) => {
                Vec3::new(within(place.x, width), within(place.y, depth), place.z)
            }
            (Base::Circle { diameter }, Space::Spatial) => {
                let axis = Vec3::new(0.5 * diameter, 0.5 * diameter, place.z);
                let (from_axis, most) = (place - axis, 0.5 * diameter - radius);
                let distance = from_axis.norm();
                if distance > most { axis + from_axis * (most / distance) } else { place }
            }
        }
    }

    /// How the sides repeat.
    pub fn period(&self, space: Space) -> Period {
        match (self.sides, space) {
            (Sides::Periodic, Space::Planar) => Period::new(self.extents()[0], f64::INFINITY),
            (Sides::Periodic, Space::Spatial) => {
                let [width, depth] = self.extents();
                Period::new(width, depth)
            }
            _ => Period::NONE,
        }
    }

    /// What takes the energy out of waves; `None` where nothing does.
    pub(crate) fn absorber(&self, space: Space) -> Option<Absorber> {
        Absorber::new(self, space)
    }

    /// The floor, then the sides.
    pub fn walls(&self, space: Space) -> Vec<Arc<dyn Surface>> {
        let mut walls: Vec<Arc<dyn Surface>> =
            vec![Arc::new(HalfSpace { origin: Vec3::zeros(), normal: Vec3::z() })];
        if self.sides == Sides::Periodic {
            return walls;
        }
        match (self.base, space) {
            (Base::Circle { diameter }, Space::Spatial) => {
                walls.push(Arc::new(InwardCylinder { diameter }));
            }
            _ => walls.extend(
                self.flat_sides(space).into_iter().map(|side| Arc::new(side) as Arc<dyn Surface>),
            ),
        }
        walls
    }

    /// The sides of a rectangle: left and right, in space front and back.
    fn flat_sides(&self, space: Space) -> Vec<HalfSpace> {
        let [width, depth] = self.extents();
        let wall = |origin: Vec3, normal: Vec3| HalfSpace { origin, normal };
        let mut sides = vec![wall(Vec3::zeros(), Vec3::x()), wall(Vec3::x() * width, -Vec3::x())];
        if space == Space::Spatial {
            sides.push(wall(Vec3::zeros(), Vec3::y()));
            sides.push(wall(Vec3::y() * depth, -Vec3::y()));
        }
        sides
    }
}
