//! Whether the formulas of a model's user-defined effects are forces in the states that its impacts pass.

use engine::math::Vec3;
use engine::units::{Dimension, format_si, significant};
use resistive::{Approach, Effect, Motion, OwnEffect, State};

use super::Common;
use crate::diagnostics::Diagnostic;
use crate::limits;
use crate::model::{Condition, ResistiveModel};

/// Depths in diameters, and shares of the impact speed, that stand for what an impact passes.
const DEPTHS: [f64; 3] = [0.0, 1.0, 10.0];
const SPEEDS: [f64; 3] = [1.0, 0.5, 0.0];

/// Reports every user-defined effect whose force is not what it is said to be.
pub(super) fn check(resistive: &ResistiveModel<'_>, common: &Common<'_>) {
    let medium = resistive.medium;
    let own = medium.effects.iter().filter_map(|choice| match &choice.effect {
        Effect::Own(own) => Some(own),
        Effect::Listed(..) => None,
    });
    for effect in own.chain(&medium.candidates) {
        let conditions = resistive.model.conditions();
        let mut tried = conditions.iter().take(limits::DIAGNOSTICS);
        if let Some(fault) = tried.find_map(|one| fault(resistive, effect, one)) {
            let places = &common.places.own_forces;
            let place = places.iter().find(|(id, _)| id == effect.id());
            common.reader.report(
                Diagnostic::error(format!("this is not a force that `{}` can be", effect.id()))
                    .at(place.and_then(|(_, span)| *span), fault)
                    .help(
                        "a drag vanishes at rest, a friction (kind = \"friction\") is never negative, \
                         and every effect vanishes with q",
                    ),
            );
        }
    }
}

/// What is wrong with the force on the first part of an impact.
fn fault(
    resistive: &ResistiveModel<'_>,
    effect: &OwnEffect,
    condition: &Condition,
) -> Option<String> {
    let impact = resistive.impact(condition);
    let start = impact.start();
    let diameter = impact.assembly().part(0, start).immersion.diameter;
    let states = DEPTHS.iter().flat_map(|depth| SPEEDS.map(|share| (depth * diameter, share)));
    for (depth, share) in states {
        let mut state = State { rate: start.rate.map(|rate| share * rate), ..*start };
        state.position[1] -= depth;
        let part = impact.assembly().part(0, &state);
        let speed = part.velocity.norm();
        let motion = Motion {
            velocity: part.velocity,
            speed,
            direction: if speed > 0.0 { part.velocity / speed } else { Vec3::zeros() },
            sense: [part.velocity.x, part.velocity.z]
                .map(|v| if v == 0.0 { 0.0 } else { v.signum() }),
            spin: part.spin,
            time: 0.0,
        };
        let approach = Approach { speed: condition.speed, angle: condition.angle_rad };
        if let Err(error) = effect.check(&part.immersion, &motion, impact.bed(), approach) {
            let depth = format_si(significant(depth, 6), Dimension::LENGTH);
            let speed = format_si(significant(speed, 6), Dimension::SPEED);
            return Some(format!("at a depth of {depth} and a speed of {speed} it {error}"));
        }
    }
    None
}
