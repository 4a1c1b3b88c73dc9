//! What LAMMPS cannot express.

use configs::{BottomKind, Condition, ContainerShape, GrainModel, SidesKind};

use super::LammpsError;
use super::law::Contacts;

/// The contact forces of `model` in the words of LAMMPS, if it can express all of the model.
pub(super) fn checked(
    model: GrainModel<'_>,
    conditions: &[Condition],
) -> Result<Contacts, LammpsError> {
    let GrainModel { model: whole, medium } = model;
    let (container, intruder) = (&medium.container, &whole.intruder);
    let mut refused = Vec::new();
    if conditions.len() != 1 {
        refused.push(format!("a list of {} impacts in one input", conditions.len()));
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
    if !["disc", "sphere"].contains(&intruder.shape.name) {
        refused
            .push(format!("an intruder that is a {} and no sphere or disc", intruder.shape.name));
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
    match Contacts::of(&medium.contact_law) {
        Ok(contacts) if refused.is_empty() => return Ok(contacts),
        Ok(_) => {}
        Err(why) => refused.push(why),
    }
    Err(LammpsError::Inexpressible(refused))
}
