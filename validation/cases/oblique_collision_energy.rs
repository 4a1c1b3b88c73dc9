//! The energy ledger over one oblique collision of unequal, spinning grains.
//!
//! Channels that dissipate may not give back, with one exception that lies in the linear law: where
//! its tangential dashpot and spring together exceed the limit of friction, the spring is set to the
//! limit at once, and what it then holds beyond what was done on it is booked against `sliding`. So
//! that channel is judged without dashpots here; summed over a bed it gives back less than a
//! thousandth with them too. What Mindlin's spring takes and gives as its stiffness changes has either
//! sign.

use std::f64::consts::PI;

use engine::ledger::{ChannelKind, Ledger, TermKind};
use engine::math::Vec3;
use engine::stage::ContactStage;

use crate::case::{Case, Outcome};
use crate::encounter::{Encounter, Target};
use crate::rig::{LARGE, Linear, S1, SMALL, phase, rolling, run, stage};
use crate::spheres::{Material, hertz_overlap, hertz_time};

pub(crate) const CASE: Case = Case {
    name: "oblique-collision-energy",
    claim: "The ledger closes over a single oblique collision to second order in the step, and \
            what dissipates does not come back.",
    run: collisions,
};

const STEPS_PER_CONTACT: f64 = 100.0;
const SPEED: f64 = 1.0;
/// Far more than any of these collisions takes.
const MOST_STEPS: usize = 1_000_000;
const SPIN: f64 = 100.0;

/// At how many places within a step a contact begins.
const PHASES: usize = 20;

type Stages = Vec<Box<dyn ContactStage>>;

/// Laws with damping for one restitution, and how long (s) a contact under them lasts.
struct Laws {
    name: &'static str,
    of: fn(f64) -> (Stages, f64),
    /// Energy that may be unaccounted for, without and with damping, and why.
    limits: [(f64, &'static str); 2],
    /// The widest gap (m) across which they still act.
    reach: f64,
    /// Dissipated channels that by their nature take either sign: springs whose stiffness changes, and
    /// attraction that jumps.
    signed: &'static [&'static str],
}

const LINEAR_LIMITS: [(f64, &str); 2] = [
    (
        2.467e-4,
        "(ω₀ dt/2)² = (π/200)²: a spring touched or left in mid-step moves by half a step under the mean \
         of no force and its first, at most k (v dt)²/8 too much",
    ),
    (5e-4, "3e-4 to 4e-4 in an independent study: the dashpot jumps at touch"),
];

const HERTZ_LIMITS: [(f64, &str); 2] = [
    (2e-5, "1.4e-5 in an independent study: the force begins without a kink"),
    (2e-4, "1.3e-4 in an independent study, at half the restitution"),
];

const COHESIVE_LIMITS: [(f64, &str); 2] = [
    (2.467e-4, "(ω₀ dt/2)² = (π/200)², as for any force that is touched or left in mid-step"),
    (5e-4, "that of a dashpot that jumps at touch"),
];

const LAWS: [Laws; 8] = [
    Laws {
        name: "linear",
        of: |e| {
            let (law, duration) = linear(e);
            (vec![law.stage()], duration)
        },
        limits: LINEAR_LIMITS,
        reach: 0.0,
        signed: &[],
    },
    Laws {
        name: "linear + rolling",
        of: |e| {
            let (law, duration) = linear(e);
            (vec![law.stage(), rolling(0.1, if e < 1.0 { 0.3 } else { 0.0 })], duration)
        },
        limits: LINEAR_LIMITS,
        reach: 0.0,
        signed: &[],
    },
    Laws {
        name: "Hertz–Mindlin",
        of: |e| (vec![SOFT.hertz_mindlin(e, S1.friction)], hertz_duration()),
        limits: HERTZ_LIMITS,
        reach: 0.0,
        signed: &["stiffness-change"],
    },
    Laws {
        name: "Hertz–Mindlin, viscous",
        of: |e| (vec![SOFT.hertz_mindlin_viscous(viscous_time(e), S1.friction)], hertz_duration()),
        limits: HERTZ_LIMITS,
        reach: 0.0,
        signed: &["stiffness-change"],
    },
    Laws {
        name: "Hertz–Mindlin + rolling + twisting",
        of: |e| {
            let base = SOFT.hertz_mindlin(e, S1.friction);
            let rolling = rolling(0.1, if e < 1.0 { 0.3 } else { 0.0 });
            let twisting = [("twisting_friction", 0.1), ("twisting_stiffness_ratio", 0.1)];
            (vec![base, rolling, stage("twisting-resistance", &twisting)], hertz_duration())
        },
        limits: HERTZ_LIMITS,
        reach: 0.0,
        signed: &["stiffness-change", "rolling-resistance", "twisting-resistance"],
    },
    Laws {
        name: "Hertz–Mindlin + JKR",
        of: |e| {
            let base = SOFT.hertz_mindlin(e, S1.friction);
            let cohesion = SOFT.effect("cohesion-jkr", ("work_of_adhesion", WORK_OF_ADHESION));
            (vec![base, cohesion], hertz_duration())
        },
        limits: COHESIVE_LIMITS,
        reach: 1e-5,
        signed: &["stiffness-change", "cohesion-jkr"],
    },
    Laws {
        name: "Hertz–Mindlin + DMT",
        of: |e| {
            let base = SOFT.hertz_mindlin(e, S1.friction);
            let work = [("work_of_adhesion", WORK_OF_ADHESION)];
            (vec![base, stage("cohesion-dmt", &work)], hertz_duration())
        },
        limits: COHESIVE_LIMITS,
        reach: 0.0,
        signed: &["stiffness-change", "cohesion-dmt"],
    },
    Laws {
        name: "linear + bridge",
        of: |e| {
            let (law, duration) = linear(e);
            let water = [
                ("surface_tension", 0.02),
                ("contact_angle", 0.3),
                ("liquid_volume", BRIDGE_VOLUME),
            ];
            (vec![law.stage(), stage("capillary-bridge", &water)], duration)
        },
        limits: LINEAR_LIMITS,
        reach: 2e-4,
        signed: &["capillary-bridge"],
    },
];

fn collisions() -> Vec<Outcome> {
    let mut rows = Vec::new();
    for laws in LAWS {
        let mut returned = 0.0_f64;
        let name = laws.name;
        for e in [1.0, 0.9, 0.5, 0.1] {
            let coarse = Survey::of(&laws, e, STEPS_PER_CONTACT);
            let fine = Survey::of(&laws, e, 2.0 * STEPS_PER_CONTACT);
            returned = returned.max(coarse.returned);
            let (limit, why) = laws.limits[usize::from(e < 1.0)];
            rows.push(Outcome::at_most(
                format!("{name}, e = {e}: energy unaccounted for, worst of 0°, 30°, 60° (–)"),
                coarse.worst,
                limit,
                why,
            ));
            rows.push(Outcome::at_least(
                format!("{name}, e = {e}: its mean over that at half the step (–)"),
                coarse.mean / fine.mean,
                3.5,
                "the booking is second order: 4, less what 20 phases leave of their scatter",
            ));
        }
        rows.push(Outcome::at_most(
            format!("{name}: largest part of a dissipated channel that came back (–)"),
            returned,
            1e-3,
            "a second-order booking may be negative in a step in which a rate changes sign; 3e-4 \
             of a channel in an independent study",
        ));
    }
    rows
}

/// The linear law with γ_n for restitution `e`, γ_t in S1's proportion; and how long (s) a contact of
/// a small and a large grain lasts.
fn linear(e: f64) -> (Linear, f64) {
    let stiffness = S1.normal_stiffness * (1.0 / SMALL.mass + 1.0 / LARGE.mass);
    let log = -libm::log(e);
    let decay = stiffness.sqrt() * log / (PI * PI + log * log).sqrt();
    let damping = 2.0 * decay;
    let law = Linear {
        normal_damping_rate: damping,
        tangential_damping_rate: damping * S1.tangential_damping_rate / S1.normal_damping_rate,
        ..S1
    };
    (law, PI / (stiffness - decay * decay).sqrt())
}

/// W (J/m²), little enough for grains to part that are damped to a tenth of their speed.
const WORK_OF_ADHESION: f64 = 0.2;

/// V (m³), likewise.
const BRIDGE_VOLUME: f64 = 5e-12;

/// Grains of a softened material.
const SOFT: Material =
    Material { name: "softened glass", young_modulus: 1e8, poisson_ratio: 0.25, density: 2500.0 };

/// How long (s) a head-on contact of a small and a large grain lasts under Hertz's law.
fn hertz_duration() -> f64 {
    hertz_time(pair_mass(), pair_radius(), SOFT.modulus_of_two(), SPEED)
}

/// A (s) with which a contact damps at its deepest as one does that rebounds with `e` at every speed.
fn viscous_time(e: f64) -> f64 {
    let loss = -libm::log(e);
    let ratio = loss / (PI * PI + loss * loss).sqrt();
    let deepest = hertz_overlap(pair_mass(), pair_radius(), SOFT.modulus_of_two(), SPEED);
    let stiffness = 2.0 * SOFT.modulus_of_two() * (pair_radius() * deepest).sqrt();
    2.0 * (5.0_f64 / 6.0).sqrt() * ratio * (pair_mass() / stiffness).sqrt()
}

fn pair_mass() -> f64 {
    1.0 / (1.0 / SMALL.mass + 1.0 / LARGE.mass)
}

fn pair_radius() -> f64 {
    1.0 / (1.0 / SMALL.radius + 1.0 / LARGE.radius)
}

/// Energy unaccounted for after a collision, over the energy of its start, at three angles and all
/// phases.
struct Survey {
    worst: f64,
    mean: f64,
    /// Decreases of a dissipated channel over what it holds in the end.
    returned: f64,
}

impl Survey {
    fn of(laws: &Laws, e: f64, steps_per_contact: f64) -> Self {
        let mut survey = Self { worst: 0.0, mean: 0.0, returned: 0.0 };
        for degrees in [0.0, 30.0, 60.0] {
            for k in 0..PHASES {
                // The end of a contact is not to fall where its beginning did: their errors would cancel.
                let (stages, duration) = (laws.of)(e);
                let dt = duration / (steps_per_contact + phase(7 * k + 3));
                let start = (degrees * PI / 180.0, phase(k));
                let collision = collide(stages, start, laws.reach, dt);
                let residual = collision.unaccounted / collision.energy;
                let returned = collision.returned(laws.signed, e < 1.0);
                survey.worst = survey.worst.max(residual);
                survey.mean += residual / (3 * PHASES) as f64;
                survey.returned = survey.returned.max(returned);
            }
        }
        survey
    }
}

/// What the ledger says after a collision.
struct Collision {
    /// Of the start (J).
    energy: f64,
    /// (J).
    unaccounted: f64,
    /// Per dissipated channel: its name, how much it holds and how much it has given back (J).
    channels: Vec<(String, f64, f64)>,
}

impl Collision {
    /// Largest part of a channel that came back.
    fn returned(&self, signed: &[&str], with_dashpots: bool) -> f64 {
        self.channels
            .iter()
            .filter(|(name, ..)| {
                !(signed.contains(&name.as_str()) || with_dashpots && name == "sliding")
            })
            // A channel that holds next to nothing has no share to lose.
            .map(|(_, held, lost)| lost / held.max(1e-3 * self.energy))
            .fold(0.0, f64::max)
    }
}

fn collide(
    stages: Vec<Box<dyn ContactStage>>,
    (angle, phase): (f64, f64),
    reach: f64,
    dt: f64,
) -> Collision {
    let (sin, cos) = libm::sincos(angle);
    let gap = SPEED * cos * dt * (1.0 + phase);
    let motion = (Vec3::new(cos, 0.0, sin) * SPEED, Vec3::y() * SPIN);
    let pair = (SMALL, Target::Grain(LARGE));
    let mut encounter = Encounter::new(pair, gap, motion, stages, dt);
    let mut channels: Vec<(String, f64, f64)> = dissipated(encounter.world.ledger())
        .map(|(name, held)| (name.to_owned(), held, 0.0))
        .collect();
    let mut touched = false;
    let mut steps = 0;
    while !touched || encounter.overlap() > -2.0 * SPEED * dt - reach {
        run(&mut encounter.world, 1);
        steps += 1;
        assert!(steps < MOST_STEPS, "the two do not part");
        touched |= encounter.overlap() > 0.0;
        for ((_, held, lost), (_, now)) in
            channels.iter_mut().zip(dissipated(encounter.world.ledger()))
        {
            *lost += (*held - now).max(0.0);
            *held = now;
        }
    }
    let balance = encounter.world.ledger().balance();
    Collision { energy: balance.initial, unaccounted: balance.unaccounted.abs(), channels }
}

fn dissipated(ledger: &Ledger) -> impl Iterator<Item = (&str, f64)> {
    let terms = ledger.terms().iter().zip(&ledger.balance().values);
    terms
        .filter(|(term, _)| term.kind == TermKind::Channel(ChannelKind::Dissipated))
        .map(|(term, &value)| (term.name.as_ref(), value))
}
