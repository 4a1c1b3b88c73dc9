//! What a shape says of itself, and how it is built by name.

use engine::params::ParamSpec;

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
}
