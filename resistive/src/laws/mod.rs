//! The force laws of a resistive medium and the effects that can be added to them, each in a file of
//! its own and one line of [`RESISTANCE_LAWS`].

mod added_mass;
mod air_drag;
mod anisotropic_drag;
mod anisotropic_friction;
mod approach;
mod bekker;
mod bottom_wall;
mod buoyancy;
mod camera_scale;
mod coefficients;
mod depth_drag;
mod depth_exponent;
mod depth_zero;
mod effect;
mod expression;
mod facts;
mod immersion;
mod janssen;
mod lift;
mod link;
mod magnus;
mod packing;
mod poncelet;
mod rail_friction;
mod rate_friction;
mod registry;
mod spin_friction;
#[cfg(test)]
mod testing;
mod tilt;
mod two_term_components;
mod two_term_vector;
mod viscous_drag;
mod yield_stress;

pub use approach::Approach;
pub use coefficients::{Coefficients, Expression};
pub use effect::Effect;
pub use expression::{
    Acts, Direction, Draft, ForceError, OwnEffect, OwnEffectError, OwnParameter, STATE_VARIABLES,
    StateVariable,
};
pub use facts::{Confounder, Facts, Kind, Needs};
pub use registry::{OtherForm, ResistanceEntry, Role};

/// Every baseline and every effect, in the order of the docs, of the sum and of a diagnosis.
pub static RESISTANCE_LAWS: &[&ResistanceEntry] = &[
    &two_term_vector::ENTRY,
    &two_term_components::ENTRY,
    &poncelet::ENTRY,
    &bekker::ENTRY,
    &link::ENTRY,
    &viscous_drag::ENTRY,
    &yield_stress::ENTRY,
    &janssen::ENTRY,
    &depth_exponent::ENTRY,
    &bottom_wall::ENTRY,
    &added_mass::ENTRY,
    &buoyancy::ENTRY,
    &magnus::ENTRY,
    &anisotropic_drag::ENTRY,
    &anisotropic_friction::ENTRY,
    &rate_friction::ENTRY,
    &rail_friction::ENTRY,
    &air_drag::ENTRY,
    &packing::ENTRY,
    &spin_friction::ENTRY,
    &lift::ENTRY,
    &immersion::ENTRY,
    &depth_drag::ENTRY,
    &tilt::ENTRY,
    &camera_scale::ENTRY,
    &depth_zero::ENTRY,
];

/// The baseline or effect called `name`.
pub fn find_resistance(name: &str) -> Option<&'static ResistanceEntry> {
    RESISTANCE_LAWS.iter().find(|entry| entry.name == name).copied()
}

/// The effects that look like the effect called `name`, whichever of the two says so.
pub fn confounders(name: &str) -> impl Iterator<Item = Confounder> {
    RESISTANCE_LAWS.iter().filter_map(move |entry| {
        let listed = |name: &str, effect: &str| {
            let Role::Effect(facts) = find_resistance(name)?.role else { return None };
            facts.separable_from.iter().find(|confounder| confounder.effect == effect)
        };
        let confounder = listed(name, entry.name).or_else(|| listed(entry.name, name))?;
        Some(Confounder { effect: entry.name, any_of: confounder.any_of })
    })
}
