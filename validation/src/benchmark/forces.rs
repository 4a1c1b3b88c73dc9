//! Forces on a sphere in the world.

use std::f64::consts::{FRAC_PI_4, PI};

use super::field::Field;
use super::hidden::{Amplitudes, Hidden};

/// Bulk density of the bed (kg/m³).
pub const DENSITY: f64 = 1480.0;

/// Magnitude of gravity (m/s²).
pub const GRAVITY: f64 = 9.81;

/// Of air (kg/m³).
const AIR_DENSITY: f64 = 1.2;

/// Packing fraction to which friction is referred.
const PACKING: f64 = 0.59;

/// Speed (m/s) below which a direction is that of rest.
const STILL: f64 = 1e-9;

/// What a condition sets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// Speed at first contact (m/s).
    pub speed: f64,
    /// Angle of the velocity below the horizontal (deg).
    pub angle_deg: f64,
    /// (kg)
    pub mass: f64,
    /// (m)
    pub diameter: f64,
    /// Angular velocity (rad/s), positive when it rolls forward.
    pub spin: f64,
    /// Packing fraction.
    pub packing: f64,
    /// Depth of the bed (m).
    pub bed_depth: f64,
}

/// Place and velocity: x along the motion, z down (m), and their rates (m/s).
pub(super) type State = [f64; 4];

/// A sphere in one bed.
#[derive(Clone, Debug)]
pub(super) struct Sphere<'a> {
    pub(super) setting: Setting,
    /// Speed at contact, which may miss the set one (m/s).
    pub(super) speed: f64,
    /// Coefficients of drag and of friction in this bed.
    pub(super) drag: f64,
    pub(super) friction: f64,
    pub(super) amplitudes: &'a Amplitudes,
    /// Multiplier of the resistance less one, and force out of the bed in units of it, over depth.
    pub(super) along: Field,
    pub(super) sideways: Field,
    /// Share of the campaign that is over.
    pub(super) progress: f64,
}

/// The state of a sphere in the terms of its forces.
struct Motion {
    time: f64,
    depth: f64,
    /// How far it has come along the surface (m).
    way: f64,
    velocity: [f64; 2],
    speed: f64,
    /// Unit vector of the velocity; zero at rest.
    ahead: [f64; 2],
}

impl Sphere<'_> {
    /// Acceleration (m/s²) at `time` (s) after contact.
    pub(super) fn acceleration(&self, time: f64, [x, z, vx, vz]: State) -> [f64; 2] {
        let speed = libm::hypot(vx, vz);
        let ahead = [vx, vz].map(|v| v / speed.max(STILL));
        let motion =
            Motion { time, depth: z.max(0.0), way: x.max(0.0), velocity: [vx, vz], speed, ahead };
        let Setting { mass, diameter, .. } = self.setting;
        let area = FRAC_PI_4 * diameter * diameter;

        let lean = self.amplitude(Hidden::Tilt);
        let guide = self.amplitude(Hidden::RailFriction)
            + 0.5 * AIR_DENSITY * self.amplitude(Hidden::AirDrag) * area * speed * speed;
        let mut force = [
            mass * GRAVITY * libm::sin(lean) - guide * ahead[0],
            mass * GRAVITY * libm::cos(lean) - guide * ahead[1],
        ];
        if time < 0.0 || z < 0.0 {
            return force.map(|f| f / mass);
        }
        let resistance = self.resistance(&motion, area) * (1.0 + self.along.at(motion.depth));
        let across = resistance * self.sideways.at(motion.depth) + self.lift(&motion, area);
        let turning = self.turning(&motion, area);
        // Out of the bed is to the left of the motion: (v_z, −v_x).
        force[0] += (across + turning) * ahead[1] - resistance * ahead[0];
        force[1] -= (across + turning) * ahead[0] + resistance * ahead[1];
        force[0] -= self.extra_sideways(&motion, area);
        force[1] -=
            self.amplitude(Hidden::Buoyancy) * DENSITY * GRAVITY * cap(diameter, motion.depth);

        let (added, growth) = self.added_mass(motion.depth);
        let recruited = growth * vz;
        [0, 1].map(|axis| (force[axis] - recruited * motion.velocity[axis]) / (mass + added))
    }

    fn amplitude(&self, hidden: Hidden) -> f64 {
        self.amplitudes[hidden as usize]
    }

    /// All that is against the motion (N).
    fn resistance(&self, motion: &Motion, area: f64) -> f64 {
        let Motion { time, depth, way, speed, .. } = *motion;
        let diameter = self.setting.diameter;
        let (own_speed, weight) = ((GRAVITY * diameter).sqrt(), DENSITY * GRAVITY * area);
        let ratio = depth / diameter;

        let hole = self.amplitude(Hidden::Immersion);
        let loaded =
            if hole == 0.0 { 1.0 } else { 1.0 - hole * libm::exp(-libm::pow(2.5 * ratio, 1.5)) };
        let deeper = self.amplitude(Hidden::DepthDrag) * -libm::expm1(-ratio);
        let drag = self.drag * (1.0 + deeper) * DENSITY * area * loaded * speed * speed;
        let friction = self.friction
            * weight
            * loaded
            * self.effective_depth(depth)
            * self.friction_factor(time, depth, speed);

        let mut force = drag + friction + self.amplitude(Hidden::YieldStress) * weight * diameter;
        let viscous = self.amplitude(Hidden::ViscousDrag);
        if viscous != 0.0 {
            force += viscous * DENSITY * area * libm::pow(own_speed, 1.1) * libm::pow(speed, 0.9);
        }
        force += self.amplitude(Hidden::CubicDrag) * DENSITY * area * speed.powi(3) / own_speed;
        let floor = (self.setting.bed_depth - depth).max(0.05 * diameter);
        force +=
            self.amplitude(Hidden::BottomWall) * weight * diameter * (diameter / floor).powi(2);
        if speed < 0.3 * self.speed {
            force += self.amplitude(Hidden::LateForce) * weight * diameter;
        }
        force +=
            self.amplitude(Hidden::SaturatingDrag) * weight * diameter * libm::tanh(speed / 0.4);
        force += self.amplitude(Hidden::Furrow) * weight * way;
        force += self.amplitude(Hidden::Memory) * DENSITY * area * own_speed * self.speed;
        let pressure = self.amplitude(Hidden::DecayingPressure);
        if pressure != 0.0 {
            force *= 1.0 + pressure * libm::exp(-time / 0.02);
        }
        force
    }

    /// Force (N) against the motion at `depth` (m) and `speed` (m/s), `time` (s) after contact and `way` (m) along the
    /// surface.
    pub(super) fn against(&self, time: f64, [way, depth, speed]: [f64; 3]) -> f64 {
        let motion = Motion { time, depth, way, velocity: [0.0; 2], speed, ahead: [0.0; 2] };
        let diameter = self.setting.diameter;
        self.resistance(&motion, FRAC_PI_4 * diameter * diameter)
    }

    /// Depth that friction grows with (m).
    fn effective_depth(&self, depth: f64) -> f64 {
        let diameter = self.setting.diameter;
        let saturated = depth / (1.0 + self.amplitude(Hidden::Janssen) * depth / diameter);
        match self.amplitude(Hidden::DepthExponent) {
            0.0 => saturated,
            power => diameter * libm::pow(saturated / diameter, 1.0 + power),
        }
    }

    fn friction_factor(&self, time: f64, depth: f64, speed: f64) -> f64 {
        let mut factor = 1.0 + self.amplitude(Hidden::Drift) * self.progress;
        factor *= 1.0 + self.amplitude(Hidden::Ageing) * time / 0.05;
        let angle = libm::sin(2.0 * self.setting.angle_deg.to_radians());
        factor *= 1.0 + self.amplitude(Hidden::AngleFriction) * angle * angle;
        if depth > 0.8 * self.setting.diameter {
            factor *= 1.0 + self.amplitude(Hidden::Step);
        }
        let rate = self.amplitude(Hidden::RateFriction);
        if rate != 0.0 {
            factor *= 1.0 + rate * libm::log1p(speed / 0.3);
        }
        let packing = self.amplitude(Hidden::Packing);
        if packing != 0.0 {
            factor *= libm::exp(packing * (self.setting.packing - PACKING));
        }
        let layer = self.amplitude(Hidden::Layer);
        if layer != 0.0 {
            factor *= 1.0 + layer * libm::exp(-((depth - 0.02) / 0.006).powi(2));
        }
        let wave = self.amplitude(Hidden::Periodic);
        if wave != 0.0 {
            factor *= 1.0 + wave * libm::sin(PI * depth / 0.012).powi(2);
        }
        factor
    }

    /// Force out of the bed (N).
    fn lift(&self, motion: &Motion, area: f64) -> f64 {
        let lift = self.amplitude(Hidden::Lift);
        if lift == 0.0 {
            return 0.0;
        }
        let grown = motion.depth / (motion.depth + 0.25 * self.setting.diameter);
        let oblique = libm::tanh(5.0 * motion.ahead[0]);
        lift * DENSITY * area * motion.speed.powi(2) * grown * oblique
    }

    /// Force of the spin (N) along (v_z, −v_x)/v: with ω = ω ŷ and z down, ω×v = −ω (v_z, −v_x).
    fn turning(&self, motion: &Motion, area: f64) -> f64 {
        let Setting { diameter, spin, .. } = self.setting;
        let surface_speed = 0.5 * diameter * spin;
        let drag = self.amplitude(Hidden::Magnus) * DENSITY * area * motion.speed;
        let friction =
            self.amplitude(Hidden::SpinFriction) * DENSITY * GRAVITY * area * motion.depth
                / (GRAVITY * diameter).sqrt();
        (friction - drag) * surface_speed
    }

    /// What the horizontal motion meets beyond the vertical one (N).
    fn extra_sideways(&self, motion: &Motion, area: f64) -> f64 {
        let drag = self.amplitude(Hidden::AnisotropicDrag) * self.drag * motion.speed.powi(2);
        let friction =
            self.amplitude(Hidden::AnisotropicFriction) * self.friction * GRAVITY * motion.depth;
        (drag + friction) * DENSITY * area * motion.ahead[0]
    }

    /// Mass of grains that move along (kg), and its growth with depth (kg/m).
    fn added_mass(&self, depth: f64) -> (f64, f64) {
        let amount = self.amplitude(Hidden::AddedMass);
        if amount == 0.0 {
            return (0.0, 0.0);
        }
        let diameter = self.setting.diameter;
        let full = 1.5 * amount * DENSITY * PI / 6.0 * diameter.powi(3);
        let square = (depth / diameter).powi(2);
        (
            full * square / (1.0 + square),
            full * 2.0 * (depth / diameter) / diameter / (1.0 + square).powi(2),
        )
    }
}

/// Volume (m³) of a sphere below the surface when its lowest point is at `depth` (m).
fn cap(diameter: f64, depth: f64) -> f64 {
    let immersed = depth.min(diameter);
    PI * immersed * immersed * (0.5 * diameter - immersed / 3.0)
}
