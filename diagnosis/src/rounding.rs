//! Numbers as reports write them.

use serde::{Serialize, Serializer};
use serde_json::Value;

/// To six digits, which is more than any statistic is worth; what is not finite is null.
pub(crate) fn rounded(value: f64) -> Value {
    Some(plots::rounded(value, 6))
        .filter(|value| value.is_finite())
        .map_or(Value::Null, Value::from)
}

/// The same, for fields.
pub(crate) fn six_digits<S: Serializer>(value: &f64, to: S) -> Result<S::Ok, S::Error> {
    rounded(*value).serialize(to)
}

/// The same, for fields that may be absent.
pub(crate) fn six_digits_or_null<S: Serializer>(
    value: &Option<f64>,
    to: S,
) -> Result<S::Ok, S::Error> {
    value.map_or(Value::Null, rounded).serialize(to)
}
