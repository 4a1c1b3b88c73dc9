//! Layers before a wall that take the energy out of waves, so that less of it comes back.
//!
//! In a layer of thickness L a grain at the distance d from the wall feels the drag −m γ v with
//! γ = γ_0 (1 − d/L). Along a chain of wave speed c, an amplitude decays as exp(−∫γ dx/(2c)) one way,
//! so of the energy of a short wave that goes in and comes back exp(−γ_0 L/c) is left; with
//! γ_0 = 6 c/L, that is e⁻⁶ (0.25 %). A larger γ_0 makes the layer itself a mirror, and a wave that is
//! long against L feels the wall behind it: `docs/beds.md` has the measured shares. The linear
//! profile returns less than a quadratic one of the same integral.

use super::{Base, Bottom, Container, Sides};
use crate::math::Vec3;
use crate::space::Space;

/// γ_0 L/c of [`Layer::for_waves`].
const STRENGTH: f64 = 6.0;

/// A layer that absorbs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    /// L (m), above zero.
    pub thickness: f64,
    /// γ_0, the rate at the wall (1/s).
    pub rate: f64,
}

impl Layer {
    /// The layer of `thickness` (m) for waves of the speed `wave_speed` (m/s).
    pub fn for_waves(thickness: f64, wave_speed: f64) -> Self {
        Self { thickness, rate: STRENGTH * wave_speed / thickness }
    }

    /// γ (1/s) at `distance` (m) from the wall.
    fn at(&self, distance: f64) -> f64 {
        self.rate * (1.0 - distance / self.thickness).clamp(0.0, 1.0)
    }
}

/// The layers of a container; where two overlap, their rates add.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Absorber {
    sides: Option<Layer>,
    bottom: Option<Layer>,
    base: Base,
    space: Space,
}

impl Absorber {
    pub(super) fn new(container: &Container, space: Space) -> Option<Self> {
        let sides = match container.sides {
            Sides::Absorbing(layer) => Some(layer),
            Sides::Wall | Sides::Periodic => None,
        };
        let bottom = match container.bottom {
            Bottom::Absorbing(layer) => Some(layer),
            Bottom::Wall => None,
        };
        let has_layer = sides.is_some() || bottom.is_some();
        has_layer.then_some(Self { sides, bottom, base: container.base, space })
    }

    /// γ (1/s) of a grain at `position`.
    pub fn rate(&self, position: Vec3) -> f64 {
        let bottom = self.bottom.map_or(0.0, |layer| layer.at(position.z));
        bottom + self.sides.map_or(0.0, |layer| self.rate_of_sides(&layer, position))
    }

    fn rate_of_sides(&self, layer: &Layer, position: Vec3) -> f64 {
        let (x, y) = (position.x, position.y);
        let between = |at: f64, length: f64| layer.at(at) + layer.at(length - at);
        match (self.base, self.space) {
            (Base::Rectangle { width, .. }, Space::Planar) => between(x, width),
            (Base::Rectangle { width, depth }, Space::Spatial) => {
                between(x, width) + between(y, depth)
            }
            (Base::Circle { diameter }, Space::Planar) => between(x, diameter),
            (Base::Circle { diameter }, Space::Spatial) => {
                let axis = 0.5 * diameter;
                layer.at(axis - Vec3::new(x - axis, y - axis, 0.0).norm())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_fall_to_nothing_at_the_edge_of_a_layer_and_add_in_a_corner() {
        let layer = Layer { thickness: 0.1, rate: 50.0 };
        let container = Container {
            sides: Sides::Absorbing(layer),
            bottom: Bottom::Absorbing(Layer { rate: 10.0, ..layer }),
            ..Container::walled_box(1.0, 1.0)
        };
        let absorber = container.absorber(Space::Spatial).expect("it absorbs");
        // Exact but for a rounding or two.
        let close = |position, rate: f64| (absorber.rate(position) - rate).abs() < 1e-13;
        assert!(close(Vec3::new(0.05, 0.5, 0.5), 25.0));
        assert!(close(Vec3::new(0.5, 0.9, 0.5), 0.0));
        assert!(close(Vec3::new(0.05, 0.95, 0.0), 60.0));
        assert!(container.absorber(Space::Planar).is_some());
        assert!(Container::walled_box(1.0, 1.0).absorber(Space::Planar).is_none());
    }
}
