//! Finding the fields of our messages in the descriptors of a log.

use engine::math::Vec3;
use prost_reflect::prost::DecodeError;
use prost_reflect::{DynamicMessage, FieldDescriptor, Kind, MessageDescriptor, Value};

use super::series::{BodyState, Closing, EnergyBudgets};

/// Where a state message has what we read of it.
pub(super) struct StateFields {
    message: MessageDescriptor,
    time: FieldDescriptor,
    depth: FieldDescriptor,
    position: VectorField,
    velocity: VectorField,
}

impl StateFields {
    /// Finds the fields in `message`, or says which one is not there.
    pub(super) fn of(message: MessageDescriptor) -> Result<Self, String> {
        Ok(Self {
            time: number(&message, "time_s")?,
            depth: number(&message, "depth_m")?,
            position: VectorField::of(&message, "position")?,
            velocity: VectorField::of(&message, "velocity")?,
            message,
        })
    }

    pub(super) fn read(&self, data: &[u8]) -> Result<BodyState, DecodeError> {
        let message = DynamicMessage::decode(self.message.clone(), data)?;
        Ok(BodyState {
            time: value(&message, &self.time),
            depth: value(&message, &self.depth),
            position: self.position.value(&message),
            velocity: self.velocity.value(&message),
        })
    }
}

/// Where a load message has the forces of the ground.
pub(super) struct LoadFields {
    message: MessageDescriptor,
    time: FieldDescriptor,
    forces: Vec<VectorField>,
}

impl LoadFields {
    /// Finds the fields in `message`: every vector that is neither a torque nor the weight is a force of the
    /// ground.
    pub(super) fn of(message: MessageDescriptor) -> Result<Self, String> {
        let is_force = |field: &FieldDescriptor| {
            let is_vector = matches!(field.kind(), Kind::Message(_));
            is_vector && field.name() != "gravity" && !field.name().ends_with("_torque")
        };
        let forces = message.fields().filter(is_force);
        let forces = forces.map(|field| VectorField::of(&message, field.name()));
        let forces = forces.collect::<Result<_, _>>()?;
        Ok(Self { time: number(&message, "time_s")?, forces, message })
    }

    /// The time (s) and the force (N).
    pub(super) fn read(&self, data: &[u8]) -> Result<(f64, Vec3), DecodeError> {
        let message = DynamicMessage::decode(self.message.clone(), data)?;
        let force = self.forces.iter().fold(Vec3::zeros(), |sum, one| sum + one.value(&message));
        Ok((value(&message, &self.time), force))
    }
}

/// Where an energy message has what we read of it.
pub(super) struct EnergyFields {
    message: MessageDescriptor,
    time: FieldDescriptor,
    /// What is unaccounted for and the closure, where the terms are all there are.
    closing: Option<[FieldDescriptor; 2]>,
    terms: Vec<FieldDescriptor>,
}

impl EnergyFields {
    /// Finds the fields in `message`: every number beside the named ones is a term.
    pub(super) fn of(message: MessageDescriptor) -> Result<Self, String> {
        let time = number(&message, "time_s")?;
        let closing = match message.get_field_by_name("closure") {
            Some(_) => Some([number(&message, "unaccounted_J")?, number(&message, "closure")?]),
            None => None,
        };
        let named = std::iter::once(&time).chain(closing.iter().flatten());
        let named: Vec<u32> = named.map(FieldDescriptor::number).collect();
        let terms = message
            .fields()
            .filter(|field| is_number(field) && !named.contains(&field.number()))
            .collect();
        Ok(Self { message, time, closing, terms })
    }

    /// A budget of these terms at no time yet.
    pub(super) fn empty(&self) -> EnergyBudgets {
        EnergyBudgets {
            terms: self.terms.iter().map(|term| term.name().to_owned()).collect(),
            time: Vec::new(),
            values: vec![Vec::new(); self.terms.len()],
            closing: self.closing.as_ref().map(|_| Closing::default()),
        }
    }

    pub(super) fn read(&self, data: &[u8], into: &mut EnergyBudgets) -> Result<(), DecodeError> {
        let message = DynamicMessage::decode(self.message.clone(), data)?;
        into.time.push(value(&message, &self.time));
        if let (Some([unaccounted, closure]), Some(closing)) = (&self.closing, &mut into.closing) {
            closing.unaccounted.push(value(&message, unaccounted));
            closing.closure.push(value(&message, closure));
        }
        for (series, term) in into.values.iter_mut().zip(&self.terms) {
            series.push(value(&message, term));
        }
        Ok(())
    }
}

/// A field that is a vector, and its components.
struct VectorField {
    field: FieldDescriptor,
    components: [FieldDescriptor; 3],
}

impl VectorField {
    fn of(message: &MessageDescriptor, name: &str) -> Result<Self, String> {
        let field = field(message, name)?;
        let Kind::Message(vector) = field.kind() else {
            return Err(format!("its `{name}` is no vector"));
        };
        if field.is_list() {
            return Err(format!("its `{name}` is a list"));
        }
        let components = [number(&vector, "x")?, number(&vector, "y")?, number(&vector, "z")?];
        Ok(Self { field, components })
    }

    fn value(&self, message: &DynamicMessage) -> Vec3 {
        match message.get_field(&self.field).as_ref() {
            Value::Message(vector) => {
                let [x, y, z] = &self.components;
                Vec3::new(value(vector, x), value(vector, y), value(vector, z))
            }
            _ => Vec3::zeros(),
        }
    }
}

fn field(message: &MessageDescriptor, name: &str) -> Result<FieldDescriptor, String> {
    let found = message.get_field_by_name(name);
    found.ok_or_else(|| format!("{} has no field `{name}`", message.full_name()))
}

fn number(message: &MessageDescriptor, name: &str) -> Result<FieldDescriptor, String> {
    let found = field(message, name)?;
    match is_number(&found) {
        true => Ok(found),
        false => Err(format!("its `{name}` is no double")),
    }
}

fn is_number(field: &FieldDescriptor) -> bool {
    field.kind() == Kind::Double && !field.is_list()
}

/// The value of a field that [`number`] has found; 0 where the message leaves it out, as in proto3.
fn value(message: &DynamicMessage, field: &FieldDescriptor) -> f64 {
    message.get_field(field).as_f64().unwrap_or(0.0)
}
