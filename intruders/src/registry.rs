//! What a shape says of itself, and how it is built by name.

use std::sync::Arc;

use engine::grains::Space;
use engine::math::Vec3;
use engine::params::{ParamSpec, ParamTable};
use engine::surface::Surface;
use resistive::{Assembly, State};

use crate::body::Body;
use crate::hinged_links::HingedLinks;
use crate::measured::Measured;

/// Makes a surface with a shaft of this length (m) on it.
pub type UnderShaft = fn(&ParamTable, Space, f64) -> Arc<dyn Surface>;

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
    /// Whether a planar resistive medium knows it too; a spatial one knows every spatial shape.
    pub planar_in_resistance: bool,
    /// Whether it is of slender links, whose drag and added mass in a fluid are not those of a compact body.
    pub slender: bool,
    /// The parameters it takes, besides the mass or density that every intruder has.
    pub params: &'static [ParamSpec],
    /// Makes a body of it from SI values that fill `params`; of a chain, one of its equal links.
    pub build: fn(&ParamTable, Space) -> Body,
    /// Makes linked bodies of it, of this mass in all (kg), for a bed of grains; `None` for a shape
    /// that is one body.
    pub links: Option<fn(&ParamTable, Space, f64) -> HingedLinks>,
    /// Its surface with a shaft of its top cross-section, of this length (m), upward from its top
    /// plane, which keeps grains off its top and is not felt; `None` for a shape without top plane.
    pub under_shaft: Option<UnderShaft>,
    /// Volume (m³), or area (m²) in a planar medium, from SI values that fill `params`.
    pub volume: fn(&ParamTable, Space) -> f64,
    /// Area (m²), or length (m) in a planar medium, that a body standing upright has below the surface
    /// when its lowest point is so deep (m); of a chain, one of its links. The three-shape manuscript, eqs
    /// 13–16: with the side of a cylinder and without flat tops.
    pub contact_area: fn(&ParamTable, Space, f64) -> f64,
    /// What measurements need to know of it.
    pub measured: Measured,
    /// Makes it for a resistive medium.
    pub assembly: fn(&AssemblyRequest) -> Launchable,
}

impl ShapeEntry {
    /// Whether it is a shape of this space.
    pub fn is_of(&self, space: Space) -> bool {
        match space {
            Space::Planar => self.planar,
            Space::Spatial => self.spatial,
        }
    }

    /// Whether a resistive medium of this space knows it.
    pub fn is_of_resistance(&self, space: Space) -> bool {
        self.is_of(space) && (space == Space::Spatial || self.planar_in_resistance)
    }
}

/// What an intruder for a resistive medium is made from.
#[derive(Clone, Copy, Debug)]
pub struct AssemblyRequest<'a> {
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
