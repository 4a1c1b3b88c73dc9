//! The cone that enters tip first, and the triangle that is its mid-plane.

use std::f64::consts::PI;
use std::sync::Arc;

use engine::grains::Space;
use engine::math::Vec3;
use engine::params::{ParamDefault, ParamSpec, ParamTable, Range};
use engine::units::Dimension;
use resistive::{Compact, Silhouette};

use crate::body::Body;
use crate::measured::{Measured, TipForm, no_centre};
use crate::outline::{Draft, Revolved};
use crate::registry::{AssemblyRequest, Launchable, ShapeEntry};
use crate::shaft::{SHAFT, WithShaft};
use crate::specs::{DIAMETER, section};

/// The registry's line.
pub(crate) const CONE: ShapeEntry = ShapeEntry {
    name: "cone",
    summary: "A cone, tip first; in a planar bed, its mid-plane.",
    planar: true,
    spatial: true,
    planar_in_resistance: true,
    slender: false,
    params: PARAMS,
    build: |params, space| {
        let shape = Wedge::new(params, space);
        Body::revolved(shape.surface(None), shape.inertia_per_mass())
    },
    links: None,
    under_shaft: Some(|params, space, length| {
        Arc::new(Wedge::new(params, space).surface(Some(length)))
    }),
    volume: |params, space| Wedge::new(params, space).volume(f64::INFINITY),
    contact_area: |params, space, depth| Wedge::new(params, space).contact_area(depth),
    measured: Measured {
        words: &["kegel", "cône", "cono"],
        keys: &["height", "apex_deg"],
        tip: Some(TipForm {
            departure: 4.0,
            is_round: false,
            soft_entry: 0.25,
            section: |depth, apex| of_cone(depth, apex).min(1.0),
            entering: |depth, apex| {
                let section = of_cone(depth, apex);
                if section < 1.0 { section } else { 0.0 }
            },
        }),
        centre: no_centre,
    },
    assembly,
};

/// Cross-section of an infinite cone at `depth` diameters above its tip, relative to that of the diameter; full apex angle in
/// rad.
fn of_cone(depth: f64, apex: f64) -> f64 {
    (2.0 * depth * libm::tan(0.5 * apex)).powi(2)
}

const PARAMS: &[ParamSpec] = &[
    DIAMETER,
    ParamSpec {
        key: "apex_angle",
        dimension: Dimension::ANGLE,
        default: ParamDefault::Required,
        // 179°: flatter, it is a plate.
        allowed: Range { min: 0.0, max: PI * 179.0 / 180.0, includes_min: false },
        plausible: Range::closed(PI / 18.0, PI * 150.0 / 180.0),
        meaning: "full angle at the tip; with the diameter of the base it gives the height",
    },
    SHAFT,
];

fn assembly(request: &AssemblyRequest) -> Launchable {
    let shape = Wedge::new(request.params, request.space);
    let (reach, inertia) = (shape.reach(), request.mass * shape.inertia_per_mass().y);
    let shape = WithShaft::new(shape, request.params, request.space);
    let body = Compact::new(Arc::new(shape), reach, request.mass, inertia);
    Launchable {
        assembly: Box::new(body),
        start: Compact::at_surface(request.velocity, request.spin),
    }
}

/// A cone or a triangle, by how much of it is below the surface.
struct Wedge {
    radius: f64,
    height: f64,
    /// Tangent of half the apex angle.
    slope: f64,
    space: Space,
}

impl Wedge {
    fn new(params: &ParamTable, space: Space) -> Self {
        let radius = 0.5 * params.get("diameter");
        let slope = libm::tan(0.5 * params.get("apex_angle"));
        Self { radius, height: radius / slope, slope, space }
    }

    /// From the tip to the centre of mass (m).
    fn reach(&self) -> f64 {
        match self.space {
            Space::Planar => self.height / 1.5,
            Space::Spatial => 0.75 * self.height,
        }
    }

    fn surface(&self, shaft: Option<f64>) -> Revolved {
        let tip = -self.reach();
        Draft::at(tip).line_to(self.radius, tip + self.height).close(shaft).revolve(self.space)
    }

    /// Principal moments of inertia of one kilogram (m²).
    fn inertia_per_mass(&self) -> Vec3 {
        let (r, h) = (self.radius, self.height);
        match self.space {
            Space::Planar => {
                let (along, width) = (h * h / 18.0, r * r / 6.0);
                Vec3::new(along, along + width, width)
            }
            Space::Spatial => {
                let across = 3.0 / 80.0 * h * h + 3.0 / 20.0 * r * r;
                Vec3::new(across, across, 0.3 * r * r)
            }
        }
    }

    /// Half the width of the body at the surface, or at its base if that is lower (m).
    fn half_width(&self, depth: f64) -> f64 {
        if depth < self.height { self.slope * depth } else { self.radius }
    }
}

impl Silhouette for Wedge {
    fn diameter(&self) -> f64 {
        2.0 * self.radius
    }

    fn height(&self) -> f64 {
        self.height
    }

    fn frontal_area(&self) -> f64 {
        section(self.radius, self.space)
    }

    fn immersed_area(&self, depth: f64) -> f64 {
        section(self.half_width(depth), self.space)
    }

    fn section(&self, depth: f64) -> f64 {
        if depth < self.height { self.immersed_area(depth) } else { 0.0 }
    }

    fn volume(&self, depth: f64) -> f64 {
        let base = self.immersed_area(depth) * depth.min(self.height);
        match self.space {
            Space::Planar => 0.5 * base,
            Space::Spatial => base / 3.0,
        }
    }

    fn contact_area(&self, depth: f64) -> f64 {
        let half = self.half_width(depth);
        // Along a generator: z/cos a with tan a = slope.
        let slant = depth.min(self.height) * (1.0 + self.slope * self.slope).sqrt();
        match self.space {
            Space::Planar => 2.0 * slant,
            Space::Spatial => PI * half * slant,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cone(apex_angle: f64) -> Wedge {
        let params = ParamTable::from_iter([("diameter", 0.04), ("apex_angle", apex_angle)]);
        Wedge::new(&params, Space::Spatial)
    }

    #[test]
    fn the_height_follows_from_the_apex_angle() {
        // A right angle at the tip: as high as the base is wide from its axis. Tangent of 45°, rounded.
        assert!((cone(PI / 2.0).height / 0.02 - 1.0).abs() < 1e-14);
    }

    #[test]
    fn the_lateral_area_is_the_printed_one_with_the_base_angle() {
        for apex_angle in [0.6, PI / 2.0, 2.2] {
            let shape = cone(apex_angle);
            let z = 0.7 * shape.height;
            // Printed with the angle between generator and base.
            let tan = libm::tan(0.5 * (PI - apex_angle));
            let printed = PI * z * z / tan * (1.0 + 1.0 / (tan * tan)).sqrt();
            // Two tangents and a root, each rounded once.
            assert!((shape.contact_area(z) / printed - 1.0).abs() < 1e-13);
        }
    }
}
