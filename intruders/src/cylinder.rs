//! The cylinder that enters with a flat face first, and the rectangle that is its mid-plane.

use std::f64::consts::PI;
use std::sync::Arc;

use engine::grains::Space;
use engine::math::Vec3;
use engine::params::{ParamSpec, ParamTable, Range};
use resistive::{Compact, Silhouette};

use crate::body::Body;
use crate::measured::{Measured, TipForm};
use crate::outline::{Draft, Revolved};
use crate::registry::{AssemblyRequest, Launchable, ShapeEntry};
use crate::shaft::{SHAFT, WithShaft};
use crate::specs::{DIAMETER, length, section};

/// The registry's line.
pub(crate) const CYLINDER: ShapeEntry = ShapeEntry {
    name: "cylinder",
    summary: "A cylinder, flat face first; in a planar bed, its mid-plane.",
    planar: true,
    spatial: true,
    planar_in_resistance: true,
    slender: false,
    params: PARAMS,
    build: |params, space| {
        let shape = Flat::new(params, space);
        Body::revolved(shape.surface(None), shape.inertia_per_mass())
    },
    links: None,
    under_shaft: Some(|params, space, length| {
        Arc::new(Flat::new(params, space).surface(Some(length)))
    }),
    volume: |params, space| Flat::new(params, space).volume(f64::INFINITY),
    contact_area: |params, space, depth| Flat::new(params, space).contact_area(depth),
    measured: Measured {
        words: &["zylinder", "cylindre", "cilindro"],
        keys: &["height"],
        tip: Some(TipForm {
            departure: 2.0,
            is_round: false,
            soft_entry: 0.0,
            section: |_, _| 1.0,
            entering: |_, _| 1.0,
        }),
        centre: |_, height| Some(0.5 * height?),
    },
    assembly,
};

const PARAMS: &[ParamSpec] =
    &[DIAMETER, length("height", Range::closed(1e-3, 1.0), "height along the axis"), SHAFT];

fn assembly(request: &AssemblyRequest) -> Launchable {
    let shape = Flat::new(request.params, request.space);
    let inertia = request.mass * shape.inertia_per_mass().y;
    let reach = 0.5 * shape.height;
    let shape = WithShaft::new(shape, request.params, request.space);
    Launchable {
        assembly: Box::new(Compact::new(Arc::new(shape), reach, request.mass, inertia)),
        start: Compact::at_surface(request.velocity, request.spin),
    }
}

/// A cylinder or a rectangle, by how much of it is below the surface.
struct Flat {
    radius: f64,
    height: f64,
    space: Space,
}

impl Flat {
    fn new(params: &ParamTable, space: Space) -> Self {
        Self { radius: 0.5 * params.get("diameter"), height: params.get("height"), space }
    }

    fn surface(&self, shaft: Option<f64>) -> Revolved {
        let half = 0.5 * self.height;
        let outline = Draft::at(-half).line_to(self.radius, -half).line_to(self.radius, half);
        outline.close(shaft).revolve(self.space)
    }

    /// Principal moments of inertia of one kilogram (m²).
    fn inertia_per_mass(&self) -> Vec3 {
        let (width, along) = (self.radius * self.radius, self.height * self.height / 12.0);
        match self.space {
            Space::Planar => Vec3::new(along, width / 3.0 + along, width / 3.0),
            Space::Spatial => {
                let across = width / 4.0 + along;
                Vec3::new(across, across, width / 2.0)
            }
        }
    }
}

impl Silhouette for Flat {
    fn diameter(&self) -> f64 {
        2.0 * self.radius
    }

    fn height(&self) -> f64 {
        self.height
    }

    fn frontal_area(&self) -> f64 {
        section(self.radius, self.space)
    }

    fn immersed_area(&self, _: f64) -> f64 {
        self.frontal_area()
    }

    fn section(&self, depth: f64) -> f64 {
        if depth < self.height { self.frontal_area() } else { 0.0 }
    }

    fn volume(&self, depth: f64) -> f64 {
        self.frontal_area() * depth.min(self.height)
    }

    fn contact_area(&self, depth: f64) -> f64 {
        let side = depth.min(self.height);
        match self.space {
            Space::Planar => self.frontal_area() + 2.0 * side,
            Space::Spatial => self.frontal_area() + 2.0 * PI * self.radius * side,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_face_and_the_immersed_side_touch_the_bed() {
        let shape = Flat { radius: 0.02, height: 0.05, space: Space::Spatial };
        // Same formula in another order of operations: round-off only.
        let printed = PI * (0.02 * 0.02 + 2.0 * 0.02 * 0.03);
        assert!((shape.contact_area(0.03) / printed - 1.0).abs() < 1e-14);
        let face = shape.frontal_area();
        assert!((shape.contact_area(0.0) - face).abs() < 1e-18);
    }
}
