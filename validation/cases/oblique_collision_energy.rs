//! The energy ledger over one oblique collision of unequal, spinning grains.
//!
//! Channels that dissipate may not give back, with one exception that lies in the linear law: where
//! its tangential dashpot and spring together exceed the limit of friction, the spring is set to the
//! limit at once, and what it then holds beyond what was done on it is booked against `sliding`. So
//! that channel is judged without dashpots here; summed over a bed it gives back less than a
//! thousandth with them too.

use std::f64::consts::PI;

use engine::contact::ContactStage;
use engine::ledger::{ChannelKind, Ledger, TermKind};
use engine::math::Vec3;

use crate::case::{Case, Outcome};
use crate::encounter::{Encounter, Target};
use crate::rig::{LARGE, Linear, S1, SMALL, phase, rolling, run};

pub(crate) const CASE: Case = Case {
    name: "oblique-collision-energy",
    claim: "The ledger closes over a single oblique collision to second order in the step, and \
            what dissipates does not come back.",
    run: collisions,
};

const STEPS_PER_CONTACT: f64 = 100.0;
const SPEED: f64 = 1.0;
const SPIN: f64 = 100.0;

/// At how many places within a step a contact begins.
const PHASES: usize = 20;

/// Laws, each with damping for one restitution.
type Laws = fn(f64) -> Vec<Box<dyn ContactStage>>;

fn collisions() -> Vec<Outcome> {
    let laws: [(&str, Laws); 2] = [
        ("linear", |e| vec![linear(e).0.stage()]),
        ("linear + rolling", |e| {
            vec![linear(e).0.stage(), rolling(0.1, if e < 1.0 { 0.3 } else { 0.0 })]
        }),
    ];
    let mut rows = Vec::new();
    for (name, stages) in laws {
        let mut returned = 0.0_f64;
        for e in [1.0, 0.9, 0.5, 0.1] {
            let coarse = Survey::of(stages, e, STEPS_PER_CONTACT);
            let fine = Survey::of(stages, e, 2.0 * STEPS_PER_CONTACT);
            returned = returned.max(coarse.returned);
            let kink = (0.5 * PI / STEPS_PER_CONTACT).powi(2);
            let (limit, why) = if e < 1.0 {
                (5e-4, "3e-4 to 4e-4 in an independent study: the dashpot jumps at touch")
            } else {
                (
                    kink,
                    "(ω₀ dt/2)²: a spring touched or left in mid-step moves by half a step under \
                        the mean of no force and its first, at most k (v dt)²/8 too much",
                )
            };
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

/// Energy unaccounted for after a collision, over the energy of its start, at three angles and all
/// phases.
struct Survey {
    worst: f64,
    mean: f64,
    /// Decreases of a dissipated channel over what it holds in the end.
    returned: f64,
}

impl Survey {
    fn of(stages: Laws, e: f64, steps_per_contact: f64) -> Self {
        let duration = linear(e).1;
        let mut survey = Self { worst: 0.0, mean: 0.0, returned: 0.0 };
        for degrees in [0.0, 30.0, 60.0] {
            for k in 0..PHASES {
                // The end of a contact is not to fall where its beginning did: their errors would cancel.
                let dt = duration / (steps_per_contact + phase(7 * k + 3));
                let collision = collide(stages(e), degrees * PI / 180.0, phase(k), dt);
                let residual = collision.unaccounted / collision.energy;
                let returned = collision.returned(e < 1.0);
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
    fn returned(&self, with_dashpots: bool) -> f64 {
        self.channels
            .iter()
            .filter(|(name, ..)| !(with_dashpots && name == "sliding"))
            // A channel that holds next to nothing has no share to lose.
            .map(|(_, held, lost)| lost / held.max(1e-3 * self.energy))
            .fold(0.0, f64::max)
    }
}

fn collide(stages: Vec<Box<dyn ContactStage>>, angle: f64, phase: f64, dt: f64) -> Collision {
    let (sin, cos) = libm::sincos(angle);
    let gap = SPEED * cos * dt * (1.0 + phase);
    let motion = (Vec3::new(cos, 0.0, sin) * SPEED, Vec3::y() * SPIN);
    let pair = (SMALL, Target::Grain(LARGE));
    let mut encounter = Encounter::new(pair, gap, motion, stages, dt);
    let mut channels: Vec<(String, f64, f64)> = dissipated(encounter.world.ledger())
        .map(|(name, held)| (name.to_owned(), held, 0.0))
        .collect();
    let mut touched = false;
    while !touched || encounter.overlap() > -2.0 * SPEED * dt {
        run(&mut encounter.world, 1);
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
