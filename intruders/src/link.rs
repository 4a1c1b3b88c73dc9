//! One free link: a round rod that enters at an angle.

use engine::math::Vec3;
use engine::params::{ParamDefault, ParamSpec, ParamTable, Range};
use resistive::assembly::{COORDINATES, PARTS};
use resistive::{Assembly, Part, PartLoad, State};

use crate::equations::Equations;
use crate::measured::{Measured, no_centre};
use crate::registry::{AssemblyRequest, Launchable, ShapeEntry};
use crate::rod::{Pose, Rod, link_angle};
use crate::specs::{DIAMETER, length};

/// The registry's line.
pub(crate) const LINK: ShapeEntry = ShapeEntry {
    name: "link",
    summary: "A straight round link that enters at an angle and turns freely.",
    planar: true,
    spatial: true,
    planar_in_resistance: false,
    slender: true,
    params: PARAMS,
    build: |params, space| Link::new(params, 1.0).0.body(space),
    links: None,
    under_shaft: None,
    volume: |params, space| Rod::volume(params.get("length"), params.get("diameter"), space),
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
    length("length", Range::closed(1e-2, 1.0), "length of the link"),
    DIAMETER,
    link_angle(
        "link_angle",
        ParamDefault::Value(0.0),
        "angle of its axis to the vertical at the start; the top leans towards +x",
    ),
];

fn assembly(request: &AssemblyRequest) -> Launchable {
    let link = Link::new(request.params, request.mass);
    let AssemblyRequest { velocity, spin, .. } = *request;
    let angle = request.params.get("link_angle");
    // From the tip, at the origin, to the centre, which is what the coordinates say.
    let at_tip = Pose { reference: Vec3::zeros(), velocity, angle, spin };
    let arm = 0.5 * link.0.length;
    let (sin, cos) = libm::sincos(angle);
    let centre = at_tip.axis() * arm;
    let start = State {
        position: [centre.x, centre.z, angle, 0.0],
        rate: [velocity.x + spin * arm * cos, velocity.z - spin * arm * sin, spin, 0.0],
        ..State::default()
    };
    Launchable { assembly: Box::new(link), start }
}

/// Coordinates: x and z of its centre and its angle to the vertical.
struct Link(Rod);

impl Link {
    fn new(params: &ParamTable, mass: f64) -> Self {
        let (length, diameter) = (params.get("length"), params.get("diameter"));
        Self(Rod { length, diameter, mass, to_reference: 0.5 * length, coordinate: 2 })
    }
}

fn pose(state: &State) -> Pose {
    let ([x, z, angle, _], [vx, vz, spin, _]) = (state.position, state.rate);
    let (reference, velocity) = (Vec3::new(x, 0.0, z), Vec3::new(vx, 0.0, vz));
    Pose { reference, velocity, angle, spin }
}

impl Assembly for Link {
    fn n_parts(&self) -> usize {
        1
    }

    fn part(&self, _: usize, state: &State) -> Part {
        self.0.part(&pose(state))
    }

    fn accelerate(
        &self,
        state: &State,
        loads: &[PartLoad; PARTS],
        gravity: f64,
    ) -> [f64; COORDINATES] {
        let mut equations = Equations::new(3);
        self.0.contribute(&mut equations, &pose(state), &loads[0], gravity);
        equations.solve()
    }

    fn kinetic_energy(&self, _: usize, state: &State) -> [f64; 2] {
        self.0.kinetic_energy(&pose(state))
    }

    fn weight_at(&self, _: usize, state: &State) -> (f64, f64) {
        (state.position[1], self.0.mass)
    }

    fn placement(&self, _: usize, state: &State) -> (Vec3, f64) {
        let pose = pose(state);
        (pose.reference, pose.angle)
    }

    fn ends_with_its_tips(&self) -> bool {
        true
    }
}
