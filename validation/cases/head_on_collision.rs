//! Head-on collisions under the linear law: a damped oscillator, in closed form.
//!
//! d²δ/dt² + γ dδ/dt + ω₀² δ = 0 with ω₀² = k/m_r, which the contact leaves when δ returns to zero,
//! after π/ω with ω² = ω₀² − γ²/4, at e = exp(−γπ/2ω) of its speed. The law attracts towards the end.

use std::f64::consts::PI;

use engine::math::Vec3;

use crate::case::{Case, Outcome};
use crate::encounter::{Encounter, Target};
use crate::rig::{DISC, LARGE, S1, SMALL, Size, phase, run};

pub(crate) const CASE: Case = Case {
    name: "head-on-collision",
    claim: "A head-on collision under the linear law follows the damped oscillator, second order \
            in the step but for when it begins and ends.",
    run: collisions,
};

const DT: f64 = 1e-5;
const SPEED: f64 = 0.1;

/// At how many places within a step a contact begins: enough to average over.
const PHASES: usize = 200;

/// The exact solution.
struct Oscillator {
    /// γ/2 (1/s).
    decay: f64,
    /// ω₀² (1/s²).
    stiffness: f64,
    /// ω (rad/s).
    frequency: f64,
}

impl Oscillator {
    fn of(grain: Size, target: Size) -> Self {
        let decay = 0.5 * S1.normal_damping_rate;
        let stiffness = S1.normal_stiffness * (1.0 / grain.mass + 1.0 / target.mass);
        Self { decay, stiffness, frequency: (stiffness - decay * decay).sqrt() }
    }

    fn overlap(&self, start: f64, t: f64) -> f64 {
        let (sin, cos) = libm::sincos(self.frequency * t);
        let swing = (SPEED + self.decay * start) / self.frequency;
        libm::exp(-self.decay * t) * (start * cos + swing * sin)
    }

    fn duration(&self) -> f64 {
        PI / self.frequency
    }

    fn restitution(&self) -> f64 {
        libm::exp(-self.decay * self.duration())
    }

    /// (ω₀² + γ²) dt², times the e-foldings of the collision where there are more than one: the
    /// size of a second-order error.
    fn second_order(&self, dt: f64) -> f64 {
        let foldings = (self.decay * self.duration()).max(1.0);
        (self.stiffness + 4.0 * self.decay * self.decay) * dt * dt * foldings
    }
}

fn collisions() -> Vec<Outcome> {
    let mut rows = inside_a_contact();
    for (name, grain, target) in [
        ("two small grains", SMALL, Target::Grain(SMALL)),
        ("small grain on the intruder", SMALL, Target::Intruder(DISC)),
        ("large grain on the intruder", LARGE, Target::Intruder(DISC)),
    ] {
        rows.extend(through_a_contact(name, grain, target));
    }
    rows
}

/// From a start in touch to a fixed time inside the contact.
fn inside_a_contact() -> Vec<Outcome> {
    // In touch by so little that it adds nothing, but enough for the damping to act from the start.
    let start = 1e-12;
    let time = 15.0 * DT;
    let exact = Oscillator::of(SMALL, SMALL);
    let error = |halvings: u32| {
        let dt = DT / f64::from(1_u32 << halvings);
        let motion = (Vec3::x() * SPEED, Vec3::zeros());
        let pair = (SMALL, Target::Grain(SMALL));
        let mut encounter = Encounter::new(pair, -start, motion, vec![S1.stage()], dt);
        run(&mut encounter.world, 15 << halvings);
        (encounter.overlap() / exact.overlap(start, time) - 1.0).abs()
    };
    let errors = [error(0), error(1), error(2)];
    let order = "a second-order method divides its error by 4; 3.5 leaves room for higher orders";
    vec![
        Outcome::at_most(
            "overlap at 0.15 ms, relative error at 10 µs (–)",
            errors[0],
            exact.second_order(DT),
            "(ω₀² + γ²) dt² per e-folding, the size of a second-order error",
        ),
        Outcome::at_least(
            "its ratio to that at half the step (–)",
            errors[0] / errors[1],
            3.5,
            order,
        ),
        Outcome::at_least("and at half of that (–)", errors[1] / errors[2], 3.5, order),
    ]
}

/// Restitution and duration (s), each averaged over where in a step the contact begins, and the
/// largest deviation of a restitution from its mean.
fn averaged(grain: Size, target: Target, dt: f64) -> (f64, f64, f64) {
    let collide = |k: usize| {
        let gap = SPEED * dt * (1.0 + phase(k));
        let motion = (Vec3::x() * SPEED, Vec3::zeros());
        let mut encounter = Encounter::new((grain, target), gap, motion, vec![S1.stage()], dt);
        let touched = encounter.until_parted();
        (-encounter.relative().1.x / SPEED, touched as f64 * dt)
    };
    let each: Vec<(f64, f64)> = (0..PHASES).map(collide).collect();
    let mean = |of: fn(&(f64, f64)) -> f64| each.iter().map(of).sum::<f64>() / PHASES as f64;
    let (restitution, duration) = (mean(|one| one.0), mean(|one| one.1));
    let scatter = each.iter().fold(0.0_f64, |worst, one| worst.max((one.0 - restitution).abs()));
    (restitution, duration, scatter)
}

fn through_a_contact(name: &str, grain: Size, target: Target) -> Vec<Outcome> {
    let exact = Oscillator::of(grain, target.size());
    let (e, t) = (exact.restitution(), exact.duration());
    let (restitution, duration, scatter) = averaged(grain, target, DT);
    let (finer, ..) = averaged(grain, target, 0.5 * DT);
    vec![
        Outcome::near(
            format!("{name}: restitution at 10 µs, mean over phase (–)"),
            restitution,
            (e, e * exact.second_order(DT)),
            "(ω₀² + γ²) dt² per e-folding, the size of a second-order error",
        ),
        Outcome::at_least(
            format!("{name}: its error over that at half the step (–)"),
            (restitution - e) / (finer - e),
            3.5,
            "a second-order method divides its error by 4; 3.5 leaves room for higher orders and \
             for a mean over 200 phases",
        ),
        Outcome::at_most(
            format!("{name}: scatter of the restitution with phase (–)"),
            scatter / restitution,
            S1.normal_damping_rate * DT,
            "the damping jumps to γv at touch and from it at release, each up to half a step early \
             or late: γ dt in all, first order as with any fixed step",
        ),
        Outcome::near(
            format!("{name}: duration, mean over phase (s)"),
            duration,
            (t, t * exact.second_order(DT)),
            "(ω₀² + γ²) dt² per e-folding, the size of a second-order error",
        ),
    ]
}
