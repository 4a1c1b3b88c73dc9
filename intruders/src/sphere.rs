//! The sphere, and the disc that is its mid-plane.

use engine::params::{Default, ParamSpec, Range};
use engine::units::Dimension;

use crate::registry::ShapeEntry;

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
};

/// The registry's line for the sphere; in a planar bed it is a disc with a sphere's moment of inertia.
pub(crate) const SPHERE: ShapeEntry = ShapeEntry {
    name: "sphere",
    summary: "A sphere; in a planar bed, its mid-plane.",
    planar: true,
    spatial: true,
    params: PARAMS,
};
