//! Two equal links on a joint without friction at their tops.

use engine::params::{ParamDefault, ParamSpec, Range};
use resistive::State;

use crate::chain::{Chain, angles, deeper};
use crate::hinged_links::HingedLinks;
use crate::measured::{Measured, no_centre};
use crate::registry::{AssemblyRequest, Launchable, ShapeEntry};
use crate::rod::{Rod, link_angle};
use crate::specs::{DIAMETER, length};

/// The registry's line.
pub(crate) const TWO_LINK_CHAIN: ShapeEntry = ShapeEntry {
    name: "two-link-chain",
    summary: "Two equal round links that enter with their tips, on a joint at their tops.",
    planar: true,
    spatial: true,
    planar_in_resistance: false,
    slender: true,
    params: PARAMS,
    build: |params, space| Chain::new(params, 1.0).links[0].body(space),
    links: Some(HingedLinks::new),
    under_shaft: None,
    volume: |params, space| 2.0 * Rod::volume(params.get("length"), params.get("diameter"), space),
    contact_area: Rod::contact_area,
    measured: Measured {
        words: &[],
        keys: &["length", "link_angle_deg"],
        tip: None,
        centre: no_centre,
    },
    assembly,
};

const PARAMS: &[ParamSpec] = &[
    length("length", Range::closed(1e-2, 1.0), "length of each link"),
    DIAMETER,
    link_angle(
        "link_angle_1",
        ParamDefault::Required,
        "angle of the first link to the vertical at the start; the top leans towards +x",
    ),
    link_angle("link_angle_2", ParamDefault::Required, "the same of the second link"),
];

/// The links start at rest relative to each other. The deeper tip is at the surface, the first of two
/// that are equally deep; the other meets it later.
fn assembly(request: &AssemblyRequest) -> Launchable {
    let chain = Chain::new(request.params, request.mass);
    let AssemblyRequest { velocity, spin, .. } = *request;
    let angles = angles(request.params);
    let (sin, cos) = libm::sincos(deeper(angles));
    let arm = chain.links[0].length;
    let start = State {
        position: [arm * sin, arm * cos, angles[0], angles[1]],
        rate: chain.rates_at_start(angles, velocity, spin),
        ..State::default()
    };
    Launchable { assembly: Box::new(chain), start }
}
