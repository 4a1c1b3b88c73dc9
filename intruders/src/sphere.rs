//! The sphere, and the disc that is its mid-plane.

use std::f64::consts::PI;
use std::sync::Arc;

use engine::grains::Space;
use engine::math::Vec3;
use engine::params::{ParamSpec, ParamTable};
use resistive::{Compact, Silhouette};

use crate::body::{Body, Drawing};
use crate::measured::{Measured, TipForm, of_sphere, spherical};
use crate::parry_surface::BallSurface;
use crate::registry::{AssemblyRequest, Launchable, ShapeEntry};
use crate::specs::{DIAMETER, section};

const PARAMS: &[ParamSpec] = &[DIAMETER];

/// The registry's line for the disc.
pub(crate) const DISC: ShapeEntry = ShapeEntry {
    name: "disc",
    summary: "A disc, in a planar bed.",
    planar: true,
    spatial: false,
    planar_in_resistance: true,
    slender: false,
    params: PARAMS,
    build: disc,
    links: None,
    under_shaft: None,
    volume: |params, _| planar_area(params),
    contact_area,
    measured: Measured {
        words: &["disk", "scheibe", "disque", "disco"],
        keys: &[],
        tip: Some(TipForm {
            departure: 2.5,
            is_round: true,
            soft_entry: 0.0,
            section: |depth, _| of_sphere(depth).sqrt(),
            entering: |depth, _| spherical(depth).max(0.0).sqrt(),
        }),
        centre: |diameter, _| Some(0.5 * diameter),
    },
    assembly: |request| compact(request, disc),
};

/// The registry's line for the sphere; in a planar bed it is a disc with a sphere's moment of inertia.
pub(crate) const SPHERE: ShapeEntry = ShapeEntry {
    name: "sphere",
    summary: "A sphere; in a planar bed, its mid-plane.",
    planar: true,
    spatial: true,
    planar_in_resistance: true,
    slender: false,
    params: PARAMS,
    build: sphere,
    links: None,
    under_shaft: None,
    volume,
    contact_area,
    measured: Measured {
        words: &["ball", "kugel", "sphère", "bille", "esfera", "spherical", "bead"],
        keys: &[],
        tip: Some(TipForm {
            departure: 3.0,
            is_round: true,
            soft_entry: 0.0,
            section: |depth, _| of_sphere(depth),
            entering: |depth, _| spherical(depth).max(0.0),
        }),
        centre: |diameter, _| Some(0.5 * diameter),
    },
    assembly: |request| compact(request, sphere),
};

fn disc(params: &ParamTable, _: Space) -> Body {
    let radius = 0.5 * params.get("diameter");
    let across = 0.25 * radius * radius;
    Body {
        surface: surface(radius),
        inertia_per_mass: Vec3::new(across, 2.0 * across, across),
        drawing: Drawing::Ball(radius),
    }
}

fn sphere(params: &ParamTable, _: Space) -> Body {
    let radius = 0.5 * params.get("diameter");
    Body {
        surface: surface(radius),
        inertia_per_mass: Vec3::repeat(0.4 * radius * radius),
        drawing: Drawing::Ball(radius),
    }
}

fn planar_area(params: &ParamTable) -> f64 {
    let radius = 0.5 * params.get("diameter");
    PI * radius * radius
}

fn volume(params: &ParamTable, space: Space) -> f64 {
    match space {
        Space::Planar => planar_area(params),
        Space::Spatial => 4.0 / 3.0 * PI * (0.5 * params.get("diameter")).powi(3),
    }
}

fn contact_area(params: &ParamTable, space: Space, depth: f64) -> f64 {
    Cap { radius: 0.5 * params.get("diameter"), space }.contact_area(depth)
}

/// The body for a resistive medium; `body` has its moment of inertia.
fn compact(request: &AssemblyRequest, body: fn(&ParamTable, Space) -> Body) -> Launchable {
    let radius = 0.5 * request.params.get("diameter");
    let inertia = request.mass * body(request.params, request.space).inertia_per_mass.y;
    let silhouette = Arc::new(Cap { radius, space: request.space });
    Launchable {
        assembly: Box::new(Compact::new(silhouette, radius, request.mass, inertia)),
        start: Compact::at_surface(request.velocity, request.spin),
    }
}

/// A sphere or a disc, by how much of it is below the surface.
pub(crate) struct Cap {
    pub(crate) radius: f64,
    pub(crate) space: Space,
}

impl Cap {
    /// Half the width of the section at the surface (m).
    fn half_chord(&self, depth: f64) -> f64 {
        let depth = depth.min(2.0 * self.radius);
        (depth * (2.0 * self.radius - depth)).sqrt()
    }
}

impl Silhouette for Cap {
    fn diameter(&self) -> f64 {
        2.0 * self.radius
    }

    fn height(&self) -> f64 {
        2.0 * self.radius
    }

    fn frontal_area(&self) -> f64 {
        section(self.radius, self.space)
    }

    fn immersed_area(&self, depth: f64) -> f64 {
        if depth >= self.radius { self.frontal_area() } else { self.section(depth) }
    }

    fn section(&self, depth: f64) -> f64 {
        section(self.half_chord(depth), self.space)
    }

    fn volume(&self, depth: f64) -> f64 {
        let (r, z) = (self.radius, depth.min(2.0 * self.radius));
        match self.space {
            Space::Planar => r * r * libm::acos(1.0 - z / r) - (r - z) * self.half_chord(z),
            Space::Spatial => PI * z * z * (r - z / 3.0),
        }
    }

    fn contact_area(&self, depth: f64) -> f64 {
        let (r, z) = (self.radius, depth.min(self.radius));
        match self.space {
            Space::Planar => 2.0 * r * libm::acos(1.0 - z / r),
            Space::Spatial => 2.0 * PI * r * z,
        }
    }
}

fn surface(radius: f64) -> Arc<BallSurface> {
    Arc::new(BallSurface::new(radius))
}
