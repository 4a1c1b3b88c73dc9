//! The sphere, and the disc that is its mid-plane.

use std::f64::consts::PI;
use std::sync::Arc;

use engine::grains::Space;
use engine::math::Vec3;
use engine::params::{Default, ParamSpec, ParamTable, Range};
use engine::units::Dimension;
use parry3d_f64::shape::Ball;

use crate::parry_surface::BallSurface;
use crate::registry::{Body, ShapeEntry};

const PARAMS: &[ParamSpec] = &[ParamSpec {
    key: "diameter",
    dimension: Dimension::LENGTH,
    default: Default::Required,
    allowed: Range::POSITIVE,
    plausible: Range::closed(1e-3, 1.0),
    meaning: "diameter",
}];

/// The registry's line for the disc.
pub(crate) const DISC: ShapeEntry = ShapeEntry {
    name: "disc",
    summary: "A disc, in a planar bed.",
    planar: true,
    spatial: false,
    params: PARAMS,
    build: disc,
};

/// The registry's line for the sphere; in a planar bed it is a disc with a sphere's moment of inertia.
pub(crate) const SPHERE: ShapeEntry = ShapeEntry {
    name: "sphere",
    summary: "A sphere; in a planar bed, its mid-plane.",
    planar: true,
    spatial: true,
    params: PARAMS,
    build: sphere,
};

fn disc(params: &ParamTable, _: Space) -> Body {
    let radius = 0.5 * params.get("diameter");
    let across = 0.25 * radius * radius;
    Body {
        surface: surface(radius),
        inertia_per_mass: Vec3::new(across, 2.0 * across, across),
        volume: PI * radius * radius,
    }
}

fn sphere(params: &ParamTable, space: Space) -> Body {
    let radius = 0.5 * params.get("diameter");
    let volume = match space {
        Space::Planar => PI * radius * radius,
        Space::Spatial => 4.0 / 3.0 * PI * radius.powi(3),
    };
    Body { surface: surface(radius), inertia_per_mass: Vec3::repeat(0.4 * radius * radius), volume }
}

fn surface(radius: f64) -> Arc<BallSurface> {
    Arc::new(BallSurface(Ball::new(radius)))
}
