//! What a shape says of itself, and how it is built by name.

use std::sync::Arc;

use engine::grains::Space;
use engine::math::Vec3;
use engine::params::{ParamSpec, ParamTable};
use engine::surface::Surface;

/// One shape of intruder.
pub struct ShapeEntry {
    /// The name in TOML, kebab-case.
    pub name: &'static str,
    /// What it is, in one sentence.
    pub summary: &'static str,
    /// Whether it is a shape of a planar (2D) medium.
    pub planar: bool,
    /// Whether it is a shape of a spatial (3D) medium.
    pub spatial: bool,
    /// The parameters it takes, besides the mass or density that every intruder has.
    pub params: &'static [ParamSpec],
    /// Makes it from SI values that fill `params`.
    pub build: fn(&ParamTable, Space) -> Body,
}

/// A shape with its distribution of mass.
pub struct Body {
    /// Surface about the centre of mass, along the principal axes.
    pub surface: Arc<dyn Surface>,
    /// Principal moments of inertia of one kilogram of it (m²).
    pub inertia_per_mass: Vec3,
    /// Volume (m³), or area (m²) of a planar shape.
    pub volume: f64,
}
