//! The two-link chain in a bed of grains.
//!
//! Its coordinates are x and z of the joint and the angles of both links, so that the joint cannot
//! open and its force does no work; it moves in the x–z plane, and in space a guide that does no work
//! either takes what would push it out of that. Between the kicks of grains and gravity, which change
//! the momenta of the coordinates, it moves freely by the implicit midpoint rule, iterated to
//! round-off: second order, symmetric in time, and it keeps momentum and angular momentum to round-off,
//! since they are bilinear in coordinates and momenta.
//!
//! The links pass side by side and do not touch each other.

use engine::body::Followed;
use engine::body::{Mechanism, Part, RigidBody};
use engine::contact::Partner;
use engine::grains::Space;
use engine::math::{Vec3, Vec4, turned_about_y};
use engine::params::ParamTable;
use engine::surface::{Placement, Wrench};
use resistive::State;

use crate::chain::{Chain, angles, pose};
use crate::equations::Equations;
use crate::rod::{Pose, Rod};

/// Rounds at the most; each makes the error of the midpoint less by the angle of a step.
const ROUNDS: usize = 30;

/// Names of the links in the log.
const NAMES: [&str; 2] = ["front", "rear"];

/// Two links on a joint without friction, among grains.
pub struct HingedLinks {
    chain: Chain,
    /// Of the plane in which they move (m).
    y: f64,
    coordinates: Vec4,
    rates: Vec4,
    momenta: Vec4,
    bodies: [RigidBody; 2],
    parts: [Part; 2],
}

/// A step of the free chain.
struct Drift {
    /// Coordinates and rates in the middle of it.
    middle: (Vec4, Vec4),
    /// Coordinates and momenta at its end.
    end: (Vec4, Vec4),
}

impl HingedLinks {
    /// At rest with the joint at the origin and its links as `params` say.
    pub(crate) fn new(params: &ParamTable, space: Space, mass: f64) -> Self {
        let chain = Chain::new(params, mass);
        let link = |index: usize| {
            let rod = chain.links[index];
            let body = rod.body(space);
            let inertia = body.inertia_per_mass * rod.mass;
            RigidBody::new(NAMES[index], body.surface, rod.mass, inertia)
        };
        let bodies = [link(0), link(1)];
        let parts = [0, 1].map(|index: usize| Part {
            surface: bodies[index].parts()[0].surface.clone(),
            placement: Placement::fixed(),
            partner: Partner::Intruder,
        });
        let [first, second] = angles(params);
        let coordinates = Vec4::new(0.0, 0.0, first, second);
        let (rates, momenta) = (Vec4::zeros(), Vec4::zeros());
        let mut links = Self { chain, y: 0.0, coordinates, rates, momenta, bodies, parts };
        links.stand();
        links
    }

    /// Turns it by `attitude` (rad) about y as it is.
    pub fn lean(&mut self, attitude: f64) {
        self.coordinates += Vec4::new(0.0, 0.0, attitude, attitude);
        self.stand();
    }

    /// Puts the joint at `joint` (m). The deeper tip, the first of two that are equally deep, has this
    /// `velocity` (m/s), and both links turn with `spin` about y (rad/s).
    pub fn launch(&mut self, joint: Vec3, velocity: Vec3, spin: f64) {
        self.y = joint.y;
        (self.coordinates[0], self.coordinates[1]) = (joint.x, joint.z);
        let angles = [self.coordinates[2], self.coordinates[3]];
        self.rates = self.chain.rates_at_start(angles, velocity, spin).into();
        self.momenta = self.chain.inertia(&self.coordinates).momenta(&self.rates);
        self.stand();
    }

    fn pose(&self, index: usize) -> Pose {
        pose_of(index, &self.coordinates, &self.rates)
    }

    fn rod(&self, index: usize) -> &Rod {
        &self.chain.links[index]
    }

    fn in_plane(&self, point: Vec3) -> Vec3 {
        Vec3::new(point.x, self.y, point.z)
    }

    /// The load of bed and gravity on the coordinates, with the links at `coordinates`.
    fn load_at(&self, coordinates: &Vec4) -> Vec4 {
        let mut equations = Equations::new(4);
        for (index, body) in self.bodies.iter().enumerate() {
            let rod = self.rod(index);
            let centre = rod.centre_point(&pose_of(index, coordinates, &self.rates));
            equations.add_force(&centre, body.contact.force + body.weight);
            equations.add_couple(rod.coordinate, body.contact.torque.y);
        }
        equations.load()
    }

    /// Moves freely for `dt` (s) from the present coordinates and these momenta.
    fn drift(&self, momenta: &Vec4, dt: f64) -> Drift {
        let half = 0.5 * dt;
        let middle = |rates: &Vec4| self.coordinates + rates * half;
        let mut rates = self.chain.inertia(&self.coordinates).rates(momenta);
        let mut change = f64::INFINITY;
        for _ in 0..ROUNDS {
            let at = middle(&rates);
            let turning = self.chain.turning(&at, &rates);
            let next = self.chain.inertia(&at).rates(&(momenta + turning * half));
            let before = std::mem::replace(&mut change, (next - rates).norm());
            rates = next;
            // Round-off is what no longer becomes less.
            if change >= 0.5 * before {
                break;
            }
        }
        let at = middle(&rates);
        let turning = self.chain.turning(&at, &rates);
        Drift { middle: (at, rates), end: (self.coordinates + rates * dt, momenta + turning * dt) }
    }

    /// Makes bodies say where the links are and how they move.
    fn follow(&mut self) {
        for index in 0..self.bodies.len() {
            let (pose, rod) = (self.pose(index), *self.rod(index));
            let position = self.in_plane(rod.centre(&pose));
            let body = &mut self.bodies[index];
            body.position = position;
            body.orientation = turned_about_y(pose.angle);
            body.velocity = rod.centre_velocity(&pose);
            body.angular_momentum = Vec3::new(0.0, rod.inertia() * pose.spin, 0.0);
        }
    }

    /// Makes bodies and parts stand as between steps.
    fn stand(&mut self) {
        self.follow();
        for (part, body) in self.parts.iter_mut().zip(&self.bodies) {
            let (spin, still) = (body.spin(), body.parts()[0].placement);
            part.placement = Placement {
                position: body.position,
                position_half: body.position,
                orientation: body.orientation,
                orientation_half: body.orientation,
                velocity: body.velocity,
                spin,
                velocity_now: body.velocity,
                spin_now: spin,
                ..still
            };
        }
    }
}

fn pose_of(index: usize, coordinates: &Vec4, rates: &Vec4) -> Pose {
    let (position, rate) = ((*coordinates).into(), (*rates).into());
    pose(index, &State { position, rate, time: 0.0 })
}

impl Mechanism for HingedLinks {
    fn kick_drift(&mut self, dt: f64) {
        let half = 0.5 * dt;
        let kicked = self.momenta + self.load_at(&self.coordinates) * half;
        let Drift { middle: (middle, rates), end: (coordinates, momenta) } =
            self.drift(&kicked, dt);
        let momenta_now = momenta + self.load_at(&coordinates) * half;
        let rates_now = self.chain.inertia(&coordinates).rates(&momenta_now);
        (self.coordinates, self.momenta, self.rates) = (coordinates, momenta, rates_now);
        self.follow();
        for index in 0..self.parts.len() {
            let (rod, halfway) = (*self.rod(index), pose_of(index, &middle, &rates));
            let position_half = self.in_plane(rod.centre(&halfway));
            let (body, part) = (&self.bodies[index], &mut self.parts[index]);
            part.placement = Placement {
                position: body.position,
                position_half,
                orientation: body.orientation,
                orientation_half: turned_about_y(halfway.angle),
                velocity: rod.centre_velocity(&halfway),
                spin: Vec3::new(0.0, halfway.spin, 0.0),
                velocity_now: body.velocity,
                spin_now: body.spin(),
                ..part.placement
            };
        }
    }

    fn kick(&mut self, dt: f64) {
        self.momenta += self.load_at(&self.coordinates) * (0.5 * dt);
        self.rates = self.chain.inertia(&self.coordinates).rates(&self.momenta);
        self.follow();
    }

    fn parts(&self) -> &[Part] {
        &self.parts
    }

    fn load(&mut self, wrenches: &[Wrench], gravity: Vec3) {
        for (body, wrench) in self.bodies.iter_mut().zip(wrenches) {
            body.contact = *wrench;
            body.weight = gravity * body.mass;
        }
    }

    fn bodies(&self) -> &[RigidBody] {
        &self.bodies
    }

    fn followed(&self, index: usize) -> Followed {
        let (pose, rod) = (self.pose(index), self.rod(index));
        Followed {
            position: self.in_plane(rod.position(&pose, 0.0)),
            velocity: rod.velocity(&pose, 0.0),
            reach: 0.0,
        }
    }

    fn stops_with_its_tips(&self) -> bool {
        true
    }

    fn save(&self) -> Vec<f64> {
        let mut state: Vec<f64> = vec![self.y];
        for four in [&self.coordinates, &self.rates, &self.momenta] {
            state.extend(four.iter());
        }
        for body in &self.bodies {
            for vector in [&body.contact.force, &body.contact.torque, &body.weight] {
                state.extend(vector.iter());
            }
            state.push(f64::from(body.contact.contacts));
        }
        state
    }

    fn restore(&mut self, state: &[f64]) -> bool {
        let Some((&y, rest)) = state.split_first() else { return false };
        let Some((motion, loads)) = rest.split_at_checked(12) else { return false };
        let (loads, []) = loads.as_chunks::<10>() else { return false };
        let &[front, rear] = loads else { return false };
        let four = |from: usize| Vec4::from_column_slice(&motion[from..from + 4]);
        self.y = y;
        (self.coordinates, self.rates, self.momenta) = (four(0), four(4), four(8));
        for (body, load) in self.bodies.iter_mut().zip([front, rear]) {
            let [fx, fy, fz, tx, ty, tz, wx, wy, wz, contacts] = load;
            let (force, torque) = (Vec3::new(fx, fy, fz), Vec3::new(tx, ty, tz));
            body.contact = Wrench { force, torque, contacts: contacts as u32 };
            body.weight = Vec3::new(wx, wy, wz);
        }
        self.stand();
        true
    }
}
