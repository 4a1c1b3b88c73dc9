//! Rigid bodies, and the mechanisms that move them.

use std::sync::Arc;

use crate::contact::Partner;
use crate::math::{Quat, Vec3, cayley, quat_from_parts, quat_parts};
use crate::surface::{Placement, Surface, Wrench};

/// One convex part of a wall or an intruder: what a grain can touch.
#[derive(Clone)]
pub struct Part {
    /// Its surface, in the frame of its body.
    pub surface: Arc<dyn Surface>,
    /// Where it is and how it moves.
    pub placement: Placement,
    /// Which parameters of a law apply.
    pub partner: Partner,
}

/// What is followed of an intruder to tell when it has stopped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Followed {
    /// A point of it: the centre of mass, or the tip of a link (m).
    pub position: Vec3,
    /// Velocity there (m/s).
    pub velocity: Vec3,
    /// How far its lowest point lies below that point (m).
    pub reach: f64,
}

impl Followed {
    /// A body as a whole.
    pub fn of(body: &RigidBody) -> Self {
        // A rotation of many steps has lost its norm by some 1e-13, which is not a depth.
        let down = body.orientation.inverse_transform_vector(&-Vec3::z()).normalize();
        let reach = body.surface().support(down);
        Self { position: body.position, velocity: body.velocity, reach }
    }
}

/// Something that moves under the forces of the bed: a rigid body, or bodies that are linked.
pub trait Mechanism: Send + Sync {
    /// Half a kick and the drift; `dt` (s).
    fn kick_drift(&mut self, dt: f64);
    /// The second half of the kick, under the load set in between.
    fn kick(&mut self, dt: f64);
    /// Its parts, placed as [`Mechanism::kick_drift`] left them.
    fn parts(&self) -> &[Part];
    /// Sets the load of the bed on each part, and gravity (m/s²).
    fn load(&mut self, wrenches: &[Wrench], gravity: Vec3);
    /// Its bodies, for the log and the energy.
    fn bodies(&self) -> &[RigidBody];
    /// What is followed of body `index` to tell when it has stopped.
    fn followed(&self, index: usize) -> Followed {
        Followed::of(&self.bodies()[index])
    }
    /// Whether each body stops for itself, when its tip no longer sinks, counted from its own first
    /// contact with the bed.
    fn stops_with_its_tips(&self) -> bool {
        false
    }
    /// Work (J) in the last step of a drive that makes it move as it does; `None` where nothing drives it.
    fn drive_work(&self) -> Option<f64> {
        None
    }
    /// Everything that changes during a run.
    fn save(&self) -> Vec<f64>;
    /// Takes back what [`Mechanism::save`] gave; `false` if it does not fit.
    fn restore(&mut self, state: &[f64]) -> bool;
}

/// Nothing: a bed on its own.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoIntruder;

impl Mechanism for NoIntruder {
    fn kick_drift(&mut self, _: f64) {}

    fn kick(&mut self, _: f64) {}

    fn parts(&self) -> &[Part] {
        &[]
    }

    fn load(&mut self, _: &[Wrench], _: Vec3) {}

    fn bodies(&self) -> &[RigidBody] {
        &[]
    }

    fn save(&self) -> Vec<f64> {
        Vec::new()
    }

    fn restore(&mut self, state: &[f64]) -> bool {
        state.is_empty()
    }
}

/// A rigid body with one convex surface.
#[derive(Clone)]
pub struct RigidBody {
    /// Its name in the log.
    pub name: String,
    /// (kg).
    pub mass: f64,
    /// Volume (m³), by which a fluid acts on it; 0 for a disc and for a link, on which none acts.
    pub volume: f64,
    /// Mass of a fluid that moves with it (kg).
    pub added_mass: f64,
    /// Principal moments of inertia, along the axes of the body frame (kg m²).
    pub inertia: Vec3,
    /// Centre of mass (m).
    pub position: Vec3,
    /// Body frame to world.
    pub orientation: Quat,
    /// (m/s).
    pub velocity: Vec3,
    /// About the centre of mass (kg m²/s).
    pub angular_momentum: Vec3,
    /// Load of the bed, and how many contacts make it.
    pub contact: Wrench,
    /// Weight (N).
    pub weight: Vec3,
    part: [Part; 1],
}

impl RigidBody {
    /// A body at rest at the origin; `mass` (kg), `inertia` (kg m²) about its principal axes.
    pub fn new(name: &str, surface: Arc<dyn Surface>, mass: f64, inertia: Vec3) -> Self {
        let part = Part { surface, placement: Placement::fixed(), partner: Partner::Intruder };
        let mut body = Self {
            name: name.to_owned(),
            mass,
            volume: 0.0,
            added_mass: 0.0,
            inertia,
            position: Vec3::zeros(),
            orientation: Quat::identity(),
            velocity: Vec3::zeros(),
            angular_momentum: Vec3::zeros(),
            contact: Wrench::default(),
            weight: Vec3::zeros(),
            part: [part],
        };
        body.place();
        body
    }

    /// Puts the body at `position` (m), turned by `orientation`, with `velocity` (m/s) and `spin`
    /// (rad/s).
    pub fn launch(&mut self, position: Vec3, orientation: Quat, velocity: Vec3, spin: Vec3) {
        self.position = position;
        self.orientation = orientation;
        self.velocity = velocity;
        self.angular_momentum = self.angular_momentum_of(spin);
        self.place();
    }

    /// Spin (rad/s).
    pub fn spin(&self) -> Vec3 {
        spin_of(self.orientation, self.inertia, self.angular_momentum)
    }

    /// Kinetic energy of translation, that of the fluid that moves with it included, and of rotation (J).
    pub fn kinetic_energy(&self) -> [f64; 2] {
        [
            0.5 * self.moving_mass() * self.velocity.norm_squared(),
            0.5 * self.angular_momentum.dot(&self.spin()),
        ]
    }

    /// Height of its lowest point (m).
    pub fn lowest(&self) -> f64 {
        self.position.z - self.reach_down()
    }

    /// How far its lowest point lies below its centre of mass (m).
    pub(crate) fn reach_down(&self) -> f64 {
        self.part[0].surface.support(self.orientation.inverse_transform_vector(&-Vec3::z()))
    }

    /// Its surface, in the body frame.
    pub fn surface(&self) -> &dyn Surface {
        &*self.part[0].surface
    }

    /// Moves on for `dt` (s) with the velocity that it has, on a drive that no contact moves.
    pub(crate) fn glide(&mut self, dt: f64) {
        let half_way = self.velocity * (0.5 * dt);
        let position_half = self.position + half_way;
        self.position += self.velocity * dt;
        self.hold_on();
        self.part[0].placement.position_half = position_half;
    }

    /// Stands where it is, on a drive: contacts with it are those with a wall that moves.
    pub(crate) fn hold_on(&mut self) {
        self.place();
        let placement = &mut self.part[0].placement;
        (placement.inverse_mass, placement.inertia) = (0.0, f64::INFINITY);
    }

    /// Its mass and that of the fluid that moves with it (kg).
    fn moving_mass(&self) -> f64 {
        self.mass + self.added_mass
    }

    fn angular_momentum_of(&self, spin: Vec3) -> Vec3 {
        let body = self.orientation.inverse_transform_vector(&spin);
        self.orientation * self.inertia.component_mul(&body)
    }

    /// Makes the part stand where the body is, as between steps.
    fn place(&mut self) {
        let spin = self.spin();
        self.part[0].placement = Placement {
            position: self.position,
            position_half: self.position,
            orientation: self.orientation,
            orientation_half: self.orientation,
            velocity: self.velocity,
            spin,
            velocity_now: self.velocity,
            spin_now: spin,
            inverse_mass: 1.0 / self.mass,
            inertia: self.inertia.min(),
        };
    }
}

impl Mechanism for RigidBody {
    fn kick_drift(&mut self, dt: f64) {
        let half = 0.5 * dt;
        let dv = (self.contact.force + self.weight) * (half / self.moving_mass());
        let dl = self.contact.torque * half;
        self.velocity += dv;
        self.angular_momentum += dl;

        let position_half = self.position + self.velocity * half;
        self.position += self.velocity * dt;
        let (orientation_half, orientation) =
            turn(self.orientation, self.inertia, self.angular_momentum, dt);
        self.orientation = orientation;

        let placement = &mut self.part[0].placement;
        placement.position = self.position;
        placement.position_half = position_half;
        placement.orientation = orientation;
        placement.orientation_half = orientation_half;
        placement.velocity = self.velocity;
        placement.spin = spin_of(orientation_half, self.inertia, self.angular_momentum);
        placement.velocity_now = self.velocity + dv;
        placement.spin_now = spin_of(orientation, self.inertia, self.angular_momentum + dl);
    }

    fn kick(&mut self, dt: f64) {
        let half = 0.5 * dt;
        self.velocity += (self.contact.force + self.weight) * (half / self.moving_mass());
        self.angular_momentum += self.contact.torque * half;
    }

    fn parts(&self) -> &[Part] {
        &self.part
    }

    fn load(&mut self, wrenches: &[Wrench], gravity: Vec3) {
        self.contact = wrenches[0];
        self.weight = gravity * self.mass;
    }

    fn bodies(&self) -> &[RigidBody] {
        std::slice::from_ref(self)
    }

    fn save(&self) -> Vec<f64> {
        let vectors = [
            self.position,
            self.velocity,
            self.angular_momentum,
            self.contact.force,
            self.contact.torque,
            self.weight,
        ];
        let mut state: Vec<f64> = vectors.iter().flat_map(|v| [v.x, v.y, v.z]).collect();
        state.extend(quat_parts(self.orientation));
        state.push(f64::from(self.contact.contacts));
        state
    }

    fn restore(&mut self, state: &[f64]) -> bool {
        let [v @ .., w, x, y, z, contacts] = state else { return false };
        let (vectors, []) = v.as_chunks::<3>() else { return false };
        let [position, velocity, angular_momentum, force, torque, weight] = vectors else {
            return false;
        };
        let vector = |v: &[f64; 3]| Vec3::new(v[0], v[1], v[2]);
        self.position = vector(position);
        self.velocity = vector(velocity);
        self.angular_momentum = vector(angular_momentum);
        self.contact =
            Wrench { force: vector(force), torque: vector(torque), contacts: *contacts as u32 };
        self.weight = vector(weight);
        self.orientation = quat_from_parts([*w, *x, *y, *z]);
        self.place();
        true
    }
}

fn spin_of(orientation: Quat, inertia: Vec3, angular_momentum: Vec3) -> Vec3 {
    let body = orientation.inverse_transform_vector(&angular_momentum);
    orientation * body.component_div(&inertia)
}

/// Orientation after half the step and after all of it, under constant angular momentum: the
/// implicit midpoint rule with the Cayley map, second order, symmetric in time, and free of
/// functions whose bits depend on the system.
fn turn(from: Quat, inertia: Vec3, angular_momentum: Vec3, dt: f64) -> (Quat, Quat) {
    let mut half = from;
    for _ in 0..4 {
        let spin = spin_of(half, inertia, angular_momentum);
        half = cayley(spin * (0.5 * dt)) * from;
    }
    let spin = spin_of(half, inertia, angular_momentum);
    (half, cayley(spin * dt) * from)
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::surface::SurfacePoint;

    /// A surface that touches nothing.
    pub(crate) struct Nothing;
    impl Surface for Nothing {
        fn closest(&self, _: Vec3) -> SurfacePoint {
            SurfacePoint { normal: Vec3::z(), gap: 1.0, curvature: 0.0, felt: true }
        }
        fn support(&self, _: Vec3) -> f64 {
            0.0
        }
        fn bounding_radius(&self) -> f64 {
            0.0
        }
    }

    /// Energy drift of a free tumbling body over 10 s at a step `dt`.
    fn tumbling_energy_error(dt: f64) -> f64 {
        let mut body = RigidBody::new("body", Arc::new(Nothing), 1.0, Vec3::new(1.0, 2.0, 3.0));
        let spin = Vec3::new(0.3, 2.0, -0.1);
        body.launch(Vec3::zeros(), Quat::identity(), Vec3::zeros(), spin);
        let before = body.kinetic_energy()[1];
        let mut worst = 0.0_f64;
        for _ in 0..(10.0 / dt) as usize {
            body.kick_drift(dt);
            body.kick(dt);
            worst = worst.max((body.kinetic_energy()[1] / before - 1.0).abs());
        }
        worst
    }

    #[test]
    fn a_free_body_tumbles_with_constant_energy_to_second_order() {
        let (coarse, fine) = (tumbling_energy_error(2e-3), tumbling_energy_error(1e-3));
        assert!(fine < 1e-6, "{fine:e}");
        assert!(coarse / fine > 3.5, "{coarse:e} against {fine:e}");
    }

    #[test]
    fn a_saved_body_is_restored_to_the_bit() {
        let mut body = RigidBody::new("body", Arc::new(Nothing), 1.0, Vec3::new(1.0, 2.0, 3.0));
        body.launch(Vec3::x(), Quat::identity(), Vec3::y(), Vec3::new(0.3, 2.0, -0.1));
        body.kick_drift(1e-3);
        let mut other = RigidBody::new("body", Arc::new(Nothing), 1.0, Vec3::new(1.0, 2.0, 3.0));
        assert!(other.restore(&body.save()));
        assert_eq!(other.save(), body.save());
        assert!(!other.restore(&[1.0, 2.0]));
    }
}
