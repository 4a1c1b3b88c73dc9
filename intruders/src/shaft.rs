//! A shaft behind a body that enters a resistive medium: what follows the body into the bed.

use engine::grains::Space;
use engine::params::{ParamSpec, ParamTable, Range};
use engine::units::Dimension;
use resistive::Silhouette;

use crate::specs::section;

/// The diameter (m) of the shaft; 0 for a body without a shaft.
pub(crate) const SHAFT: ParamSpec = ParamSpec::required(
    "shaft_diameter",
    Dimension::LENGTH,
    "the diameter of a shaft behind the body, no wider than it, which follows it into a resistive medium",
)
.plausible(Range::closed(0.0, 1.0))
.or(0.0);

/// A body with a shaft on its top that never ends, by how much of both is below the surface.
///
/// The shaft displaces the bed and touches it with its side. It adds nothing to the area that is driven into the
/// bed.
pub(crate) struct WithShaft<S> {
    body: S,
    radius: f64,
    space: Space,
}

impl<S: Silhouette> WithShaft<S> {
    pub(crate) fn new(body: S, params: &ParamTable, space: Space) -> Self {
        Self { body, radius: 0.5 * params.get(SHAFT.key), space }
    }

    /// Length of the shaft below the surface (m).
    fn below(&self, depth: f64) -> f64 {
        (depth - self.body.height()).max(0.0)
    }
}

impl<S: Silhouette> Silhouette for WithShaft<S> {
    fn diameter(&self) -> f64 {
        self.body.diameter()
    }

    fn height(&self) -> f64 {
        self.body.height()
    }

    fn frontal_area(&self) -> f64 {
        self.body.frontal_area()
    }

    fn immersed_area(&self, depth: f64) -> f64 {
        self.body.immersed_area(depth)
    }

    fn section(&self, depth: f64) -> f64 {
        match depth < self.body.height() {
            true => self.body.section(depth),
            false => section(self.radius, self.space),
        }
    }

    fn volume(&self, depth: f64) -> f64 {
        self.body.volume(depth) + section(self.radius, self.space) * self.below(depth)
    }

    fn contact_area(&self, depth: f64) -> f64 {
        let round = match self.space {
            Space::Planar => 2.0,
            Space::Spatial => 2.0 * std::f64::consts::PI * self.radius,
        };
        let side = if self.radius > 0.0 { round * self.below(depth) } else { 0.0 };
        self.body.contact_area(depth) + side
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{AssemblyRequest, SHAPES};
    use engine::math::Vec3;
    use resistive::State;

    /// Immersed volume and its rate with depth of a shape with a shaft, by depth.
    fn immersed(name: &str, shaft: f64, space: Space, depth: f64) -> (f64, f64) {
        let entry = crate::find(name).expect("a shape");
        let mut params = ParamTable::new();
        for (key, value) in
            [("diameter", 0.04), ("height", 0.03), ("apex_angle", 1.2), (SHAFT.key, shaft)]
        {
            params.set(key, value);
        }
        let (velocity, spin) = (Vec3::new(0.0, 0.0, -1.0), 0.0);
        let made = (entry.assembly)(&AssemblyRequest {
            params: &params,
            space,
            mass: 0.1,
            velocity,
            spin,
        });
        let state = State { position: [0.0, -depth, 0.0, 0.0], ..made.start };
        let part = made.assembly.part(0, &state);
        (part.immersion.volume, part.immersion.section)
    }

    #[test]
    fn a_shaft_displaces_the_bed_behind_the_body_alone() {
        let shafted =
            SHAPES.iter().filter(|entry| entry.params.iter().any(|spec| spec.key == SHAFT.key));
        let names: Vec<&str> = shafted.map(|entry| entry.name).collect();
        assert_eq!(names, ["cylinder", "hemisphere", "cone"]);
        for name in names {
            for space in [Space::Planar, Space::Spatial] {
                // None of the bodies is higher than 40 mm.
                let (step, deep) = (1e-3, 0.05);
                let rate = |shaft: f64| {
                    let at = |depth| immersed(name, shaft, space, depth).0;
                    (at(deep + step) - at(deep)) / step
                };
                let wide = section(0.01, space);
                // Differences of volumes of 1e-5 m³ over a millimetre: ten digits are left.
                assert!((rate(0.02) / wide - 1.0).abs() < 1e-10, "{name}");
                assert!((immersed(name, 0.02, space, deep).1 / wide - 1.0).abs() < 1e-14);
                assert!(
                    rate(0.0).abs() < 1e-10 * wide && immersed(name, 0.0, space, deep).1 == 0.0
                );
                let shallow = |shaft| immersed(name, shaft, space, 0.01);
                assert_eq!(shallow(0.02), shallow(0.0), "{name}");
            }
        }
    }
}
