//! The hemisphere that enters dome first, and the half disc that is its mid-plane.

use std::f64::consts::PI;
use std::sync::Arc;

use engine::grains::Space;
use engine::math::Vec3;
use engine::params::{ParamSpec, ParamTable};
use resistive::{Compact, Silhouette};

use crate::body::Body;
use crate::measured::{Measured, TipForm, no_centre, of_sphere, spherical};
use crate::outline::{Draft, Revolved};
use crate::registry::{AssemblyRequest, Launchable, ShapeEntry};
use crate::shaft::{SHAFT, WithShaft};
use crate::specs::{DIAMETER, section};
use crate::sphere::Cap;

/// The registry's line.
pub(crate) const HEMISPHERE: ShapeEntry = ShapeEntry {
    name: "hemisphere",
    summary: "A hemisphere, dome first; in a planar bed, its mid-plane.",
    planar: true,
    spatial: true,
    planar_in_resistance: true,
    slender: false,
    params: PARAMS,
    build: |params, space| {
        let shape = Dome::new(params, space);
        Body::revolved(shape.surface(None), shape.inertia_per_mass())
    },
    links: None,
    under_shaft: Some(|params, space, length| {
        Arc::new(Dome::new(params, space).surface(Some(length)))
    }),
    volume: |params, space| Dome::new(params, space).volume(f64::INFINITY),
    contact_area: |params, space, depth| Dome::new(params, space).contact_area(depth),
    measured: Measured {
        words: &["halbkugel", "hémisphère"],
        keys: &[],
        tip: Some(TipForm {
            departure: 3.0,
            is_round: false,
            soft_entry: 0.0,
            section: |depth, _| of_sphere(depth),
            entering: |depth, _| if depth < 0.5 { spherical(depth) } else { 0.0 },
        }),
        centre: no_centre,
    },
    assembly,
};

const PARAMS: &[ParamSpec] = &[DIAMETER, SHAFT];

fn assembly(request: &AssemblyRequest) -> Launchable {
    let shape = Dome::new(request.params, request.space);
    let (reach, inertia) =
        (shape.whole.radius - shape.below(), request.mass * shape.inertia_per_mass().y);
    let shape = WithShaft::new(shape, request.params, request.space);
    Launchable {
        assembly: Box::new(Compact::new(Arc::new(shape), reach, request.mass, inertia)),
        start: Compact::at_surface(request.velocity, request.spin),
    }
}

/// A hemisphere or a half disc, by how much of it is below the surface: the lower half of a ball.
struct Dome {
    whole: Cap,
}

impl Dome {
    fn new(params: &ParamTable, space: Space) -> Self {
        Self { whole: Cap { radius: 0.5 * params.get("diameter"), space } }
    }

    /// How far the centre of mass lies below the flat face (m).
    fn below(&self) -> f64 {
        match self.whole.space {
            Space::Planar => 4.0 * self.whole.radius / (3.0 * PI),
            Space::Spatial => 0.375 * self.whole.radius,
        }
    }

    fn surface(&self, shaft: Option<f64>) -> Revolved {
        let Cap { radius, space } = self.whole;
        Draft::at(self.below() - radius).dome(radius).close(shaft).revolve(space)
    }

    /// Principal moments of inertia of one kilogram (m²): those of the whole about the centre of the
    /// sphere, moved to the centre of mass by Steiner's theorem.
    fn inertia_per_mass(&self) -> Vec3 {
        let (square, moved) = (self.whole.radius * self.whole.radius, self.below() * self.below());
        match self.whole.space {
            Space::Planar => Vec3::new(0.25 * square - moved, 0.5 * square - moved, 0.25 * square),
            Space::Spatial => {
                let across = 0.4 * square - moved;
                Vec3::new(across, across, 0.4 * square)
            }
        }
    }
}

impl Silhouette for Dome {
    fn diameter(&self) -> f64 {
        2.0 * self.whole.radius
    }

    fn height(&self) -> f64 {
        self.whole.radius
    }

    fn frontal_area(&self) -> f64 {
        section(self.whole.radius, self.whole.space)
    }

    fn immersed_area(&self, depth: f64) -> f64 {
        self.whole.immersed_area(depth)
    }

    fn section(&self, depth: f64) -> f64 {
        if depth < self.whole.radius { self.whole.section(depth) } else { 0.0 }
    }

    fn volume(&self, depth: f64) -> f64 {
        self.whole.volume(depth.min(self.whole.radius))
    }

    fn contact_area(&self, depth: f64) -> f64 {
        self.whole.contact_area(depth)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_dome_touches_with_its_cap_and_not_with_its_flat_face() {
        let shape = Dome { whole: Cap { radius: 0.02, space: Space::Spatial } };
        // One product in another order: round-off only.
        assert!((shape.contact_area(0.015) / (2.0 * PI * 0.02 * 0.015) - 1.0).abs() < 1e-14);
        assert!((shape.contact_area(0.5) / (2.0 * PI * 0.02 * 0.02) - 1.0).abs() < 1e-14);
    }
}
