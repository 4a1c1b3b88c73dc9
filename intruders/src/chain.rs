//! The equations of two equal links on a joint without friction at their tops.

use engine::math::{Vec3, Vec4};
use engine::params::ParamTable;
use resistive::assembly::{COORDINATES, PARTS};
use resistive::{Assembly, Part, PartLoad, State};

use crate::equations::Equations;
use crate::rod::{Pose, Rod};

/// Of both links to the vertical at the start (rad).
pub(crate) fn angles(params: &ParamTable) -> [f64; PARTS] {
    ["link_angle_1", "link_angle_2"].map(|key| params.get(key))
}

/// The angle of the link with the deeper tip, the first of two that are equally deep.
pub(crate) fn deeper([first, second]: [f64; PARTS]) -> f64 {
    if second.abs() < first.abs() { second } else { first }
}

/// Coordinates: x and z of the joint and the angles of both links to the vertical.
pub(crate) struct Chain {
    pub(crate) links: [Rod; PARTS],
}

impl Chain {
    pub(crate) fn new(params: &ParamTable, mass: f64) -> Self {
        let (length, diameter) = (params.get("length"), params.get("diameter"));
        let link = |coordinate| Rod {
            length,
            diameter,
            mass: 0.5 * mass,
            to_reference: length,
            coordinate,
        };
        Self { links: [link(2), link(3)] }
    }

    /// Rates of the coordinates (m/s, rad/s) at which the deeper tip has this `velocity` (m/s) and both
    /// links turn with `spin` (rad/s).
    pub(crate) fn rates_at_start(
        &self,
        angles: [f64; PARTS],
        velocity: Vec3,
        spin: f64,
    ) -> [f64; COORDINATES] {
        let (sin, cos) = libm::sincos(deeper(angles));
        let arm = self.links[0].length;
        [velocity.x + spin * arm * cos, velocity.z - spin * arm * sin, spin, spin]
    }

    /// The inertia of both links at these `coordinates`.
    pub(crate) fn inertia(&self, coordinates: &Vec4) -> Equations {
        let mut equations = Equations::new(COORDINATES);
        let state = State { position: (*coordinates).into(), ..State::default() };
        for (index, link) in self.links.iter().enumerate() {
            link.add_inertia_to(&mut equations, &pose(index, &state));
        }
        equations
    }

    /// Change of the kinetic energy with the coordinates while the rates stay (N or J/rad).
    pub(crate) fn turning(&self, coordinates: &Vec4, rates: &Vec4) -> Vec4 {
        let (position, rate) = ((*coordinates).into(), (*rates).into());
        let state = State { position, rate, time: 0.0 };
        let [first, second] = [0, 1].map(|index| self.links[index].turning(&pose(index, &state)));
        Vec4::new(0.0, 0.0, first, second)
    }
}

pub(crate) fn pose(index: usize, state: &State) -> Pose {
    let ([x, z, ..], [vx, vz, ..]) = (state.position, state.rate);
    Pose {
        reference: Vec3::new(x, 0.0, z),
        velocity: Vec3::new(vx, 0.0, vz),
        angle: state.position[2 + index],
        spin: state.rate[2 + index],
    }
}

impl Assembly for Chain {
    fn n_parts(&self) -> usize {
        PARTS
    }

    fn part(&self, index: usize, state: &State) -> Part {
        self.links[index].part(&pose(index, state))
    }

    fn accelerate(
        &self,
        state: &State,
        loads: &[PartLoad; PARTS],
        gravity: f64,
    ) -> [f64; COORDINATES] {
        let mut equations = Equations::new(COORDINATES);
        for (index, link) in self.links.iter().enumerate() {
            link.contribute(&mut equations, &pose(index, state), &loads[index], gravity);
        }
        equations.solve()
    }

    fn kinetic_energy(&self, index: usize, state: &State) -> [f64; 2] {
        self.links[index].kinetic_energy(&pose(index, state))
    }

    fn weight_at(&self, index: usize, state: &State) -> (f64, f64) {
        let link = &self.links[index];
        (link.centre(&pose(index, state)).z, link.mass)
    }

    fn placement(&self, index: usize, state: &State) -> (Vec3, f64) {
        let pose = pose(index, state);
        (self.links[index].centre(&pose), pose.angle)
    }

    fn ends_with_its_tips(&self) -> bool {
        true
    }
}
