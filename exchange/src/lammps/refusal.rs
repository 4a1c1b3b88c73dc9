//! What LAMMPS cannot express.

use configs::{BottomKind, Condition, ContainerShape, GrainModel, SidesKind};

use super::LammpsError;
use super::law::Law;

/// The contact law of `model` as LAMMPS knows it, if it can express all of the model.
pub(super) fn checked<'a>(
    model: GrainModel<'a>,
    conditions: &[Condition],
) -> Result<Law<'a>, LammpsError> {
    let GrainModel { model: whole, medium } = model;
    let (container, intruder) = (&medium.container, &whole.intruder);
    let mut refused = Vec::new();
    if conditions.len() != 1 {
        refused.push(format!("a list of {} impacts in one input", conditions.len()));
    }
    let inertia = medium.inertia_coefficient();
    if inertia.to_bits() != medium.space.inertia_coefficient().to_bits() {
        refused.push(format!(
            "grains with a moment of inertia of {inertia} m r² (medium.grain_inertia)"
        ));
    }
    if container.shape == ContainerShape::Cylinder {
        refused.push("a cylindrical container: its wall would be flat to the grains".to_owned());
    }
    if container.sides == SidesKind::Absorbing {
        refused.push("absorbing sides (container.sides)".to_owned());
    }
    if container.bottom == BottomKind::Absorbing {
        refused.push("an absorbing bottom (container.bottom)".to_owned());
    }
    if intruder.shape.links.is_some() {
        refused.push(format!("bodies on a joint: an intruder that is a {}", intruder.shape.name));
    }
    if model.model.impact.pushed_to.is_some() {
        refused.push("a push at a set speed ([intrusion])".to_owned());
    }
    if intruder.recessive_wall {
        refused.push("a recessive wall (intruder.recessive_wall)".to_owned());
    }
    for effect in &medium.effects {
        refused.push(format!("the effect {} as plunge has it", effect.entry.name));
    }
    for force in &medium.grain_forces {
        refused.push(format!("the effect {} as plunge has it", force.entry.name));
    }
    match Law::of(&medium.contact_law) {
        Ok(law) if refused.is_empty() => return Ok(law),
        Ok(_) => {}
        Err(why) => refused.push(why),
    }
    Err(LammpsError::Inexpressible(refused))
}
