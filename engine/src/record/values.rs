//! What bodies come to in messages: encoded, and refused where it is not finite.

use super::scene::Scene;
use super::schema::Fields;
use super::{BodySample, RecordError, Stamp};
use crate::math::Vec3;

/// Encodes the state of a body into an emptied buffer.
pub(super) fn encode_state(at: Stamp, sample: &BodySample, scene: &Scene, buffer: &mut Vec<u8>) {
    let BodySample { position, velocity, spin, depth_m } = sample;
    let mut fields = Fields::begin(buffer, at.step, at.time_s);
    fields.number(*depth_m);
    fields.number(velocity.norm());
    fields.vector(&scene.to_log(position));
    fields.vector(velocity);
    fields.vector(spin);
}

/// Encodes a force and a torque per origin behind `fields`.
pub(super) fn encode_loads<'a>(
    at: Stamp,
    name: &str,
    fields: &mut Fields<'_>,
    loads: impl Iterator<Item = (&'a Vec3, &'a Vec3)>,
) -> Result<(), RecordError> {
    for (force, torque) in loads {
        finite(at, || format!("force on {name}"), force.as_slice())?;
        finite(at, || format!("torque on {name}"), torque.as_slice())?;
        fields.vector(force);
        fields.vector(torque);
    }
    Ok(())
}

/// Refuses a state that is not finite.
pub(super) fn finite_state(at: Stamp, name: &str, sample: &BodySample) -> Result<(), RecordError> {
    let BodySample { position, velocity, spin, depth_m } = sample;
    finite(at, || format!("depth_m of {name}"), &[*depth_m])?;
    finite(at, || format!("position of {name}"), position.as_slice())?;
    finite(at, || format!("velocity of {name}"), velocity.as_slice())?;
    finite(at, || format!("spin of {name}"), spin.as_slice())
}

/// Refuses `values` of `what` that are not finite.
pub(super) fn finite(
    at: Stamp,
    what: impl Fn() -> String,
    values: &[f64],
) -> Result<(), RecordError> {
    match values.iter().all(|value| value.is_finite()) {
        true => Ok(()),
        false => Err(RecordError::NonFinite { step: at.step, what: what() }),
    }
}
