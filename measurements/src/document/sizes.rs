//! Sizes of the body of a condition, by the parameters of its shape.

use engine::params::{ParamDefault, ParamTable};
use intruders::ShapeEntry;

use crate::Condition;

/// A size of a body that is missing or that its shape cannot have.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum SizeError {
    #[error("`{0}` is not stated")]
    Missing(&'static str),
    #[error("`{0}` cannot be {1}")]
    Bad(&'static str, f64),
}

impl Condition {
    /// The shape of the body, if it is registered.
    pub fn shape_entry(&self) -> Option<&'static ShapeEntry> {
        intruders::find(&self.shape)
    }

    /// SI values that fill the parameters of `shape`. The angle of a cone may follow from its height.
    ///
    /// # Errors
    /// If a size is missing or out of range.
    pub fn sizes(&self, shape: &ShapeEntry) -> Result<ParamTable, SizeError> {
        let link = self.link_angle_deg.map(f64::to_radians);
        let apex = || Some(2.0 * libm::atan2(0.5 * self.diameter, self.height?));
        let mut table = ParamTable::new();
        for spec in shape.params {
            let given = match spec.key {
                "diameter" => Some(self.diameter),
                "length" => self.length,
                "height" => self.height,
                "shaft_diameter" => self.shaft_diameter,
                "apex_angle" => self.apex_deg.map(f64::to_radians).or_else(apex),
                "link_angle" | "link_angle_1" => link,
                "link_angle_2" => link.map(|angle| -angle),
                _ => None,
            };
            let value = match (given, spec.default) {
                (Some(value), _) | (None, ParamDefault::Value(value)) => value,
                (None, ParamDefault::SameAs(other)) => table.get(other),
                (None, ParamDefault::Required | ParamDefault::FromBase(_)) => {
                    return Err(SizeError::Missing(in_sets(spec.key)));
                }
            };
            if !spec.allowed.contains(value) {
                return Err(SizeError::Bad(in_sets(spec.key), value));
            }
            table.set(spec.key, value);
        }
        Ok(table)
    }
}

/// The key of a condition that states the parameter `key` of a shape.
fn in_sets(key: &'static str) -> &'static str {
    match key {
        "apex_angle" => "apex_deg",
        "link_angle" | "link_angle_1" | "link_angle_2" => "link_angle_deg",
        other => other,
    }
}
