//! What the laws of a contact make of a head-on collision.

use crate::contact::{Contact, Encounter, Partner, Response};
use crate::contacts::stage::ContactStage;
use crate::contacts::stage::{Batch, Histories};
use crate::lanes::MOST_LANES;
use crate::math::Vec3;
use crate::space::Space;

/// Steps per collision: the error of a rebound is a few times the square of its inverse.
const STEPS: f64 = 2000.0;

/// A collision that has not ended after so many of its own times never will.
const PATIENCE: f64 = 20.0;

/// The coefficient of restitution (–) of a head-on collision under `stages`, in the order of their slots,
/// without spin or gravity; 0 where the two stay together, `None` where no law says how long a collision
/// lasts.
pub fn restitution(
    stages: &[Box<dyn ContactStage>],
    partner: Partner,
    encounter: &Encounter,
) -> Option<f64> {
    let duration = stages
        .iter()
        .filter_map(|stage| stage.collision_time(partner, encounter))
        .fold(f64::INFINITY, f64::min);
    if !duration.is_finite() || encounter.speed <= 0.0 {
        return None;
    }
    let dt = duration / STEPS;
    let mut history: Vec<Vec<f64>> =
        stages.iter().map(|stage| vec![0.0; stage.history_len(Space::Spatial)]).collect();
    let mut energy: Vec<Vec<f64>> =
        stages.iter().map(|stage| vec![0.0; stage.channels().len()]).collect();
    let (mut overlap, mut rate, mut force) = (0.0, encounter.speed, 0.0);
    for _ in 0..(PATIENCE * STEPS) as usize {
        let kick = -0.5 * dt * force / encounter.mass_eff;
        let half = rate + kick;
        overlap += half * dt;
        let contact = Contact {
            normal: Vec3::z(),
            overlap,
            overlap_rate: half + kick,
            overlap_step: half * dt,
            slip_velocity: Vec3::zeros(),
            slip_step: Vec3::zeros(),
            relative_spin: Vec3::zeros(),
            relative_turn: Vec3::zeros(),
            inverse_radius_eff: 1.0 / encounter.radius_eff,
            inverse_radius_eff_before: 1.0 / encounter.radius_eff,
            inverse_mass_eff: 1.0 / encounter.mass_eff,
            rolling_mobility: 1.0 / (encounter.mass_eff * encounter.radius_eff.powi(2)),
        };
        let mut response = Response::default();
        for ((stage, history), energy) in stages.iter().zip(&mut history).zip(&mut energy) {
            let batch = Batch {
                partner,
                contacts: std::slice::from_ref(&contact),
                records: &[[0; MOST_LANES]],
                responses: std::slice::from_mut(&mut response),
            };
            stage.sweep(batch, dt, Histories { values: history, offset: 0 }, Some(energy));
        }
        force = response.normal_force;
        rate = half - 0.5 * dt * force / encounter.mass_eff;
        if overlap <= 0.0 && !response.holds {
            return Some((-half / encounter.speed).max(0.0));
        }
    }
    Some(0.0)
}
