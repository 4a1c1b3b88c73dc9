//! What a shape says of itself, and how it is built by name.

use std::sync::Arc;

use engine::grains::Space;
use engine::math::Vec3;
use engine::params::{ParamSpec, ParamTable};
use engine::resistance::{Assembly, State};
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
    /// Makes it for a bed of grains from SI values that fill `params`; `None` where only a resistive
    /// medium knows it.
    pub build: Option<fn(&ParamTable, Space) -> Body>,
    /// Volume (m³), or area (m²) in a planar medium, from SI values that fill `params`.
    pub volume: fn(&ParamTable, Space) -> f64,
    /// Makes it for a resistive medium.
    pub assembly: fn(&Casting) -> Launchable,
}

/// What an intruder for a resistive medium is made from.
#[derive(Clone, Copy, Debug)]
pub struct Casting<'a> {
    /// SI values that fill the entry's `params`.
    pub params: &'a ParamTable,
    /// Planar or spatial.
    pub space: Space,
    /// Mass of the whole intruder (kg).
    pub mass: f64,
    /// Velocity of the lowest point at first contact (m/s), in the x–z plane.
    pub velocity: Vec3,
    /// Angular velocity about y (rad/s), positive when it rolls towards +x.
    pub spin: f64,
}

/// An intruder for a resistive medium, and its state with the lowest point just at the surface, at
/// x = 0.
pub struct Launchable {
    /// The bodies.
    pub assembly: Box<dyn Assembly>,
    /// At first contact.
    pub start: State,
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
