//! Why a model cannot be compared with a set.

use thiserror::Error;

/// Why a model cannot be compared with a set.
#[derive(Clone, Debug, Error, PartialEq)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum ForwardError {
    #[error("`{model}` is a bed of grains, not a force law")]
    Grains { model: String },
    #[error(
        "`{model}` is a force law, which says nothing of craters; `MeasurementSet::without_craters` leaves them out"
    )]
    Craters { model: String },
    #[error("condition {condition}: there is no shape `{shape}`; known: {}", known.join(", "))]
    UnknownShape { condition: String, shape: String, known: Vec<&'static str> },
    #[error("condition {condition}: a {shape} cannot be pushed: a drive moves a body of one part")]
    NotPushed { condition: String, shape: &'static str },
    #[error(
        "condition {condition}: a force law keeps the spin of a {shape}; of links alone it says how they turn"
    )]
    KeepsSpin { condition: String, shape: &'static str },
    #[error("condition {condition}: no {shape} is modelled in a fluid; leave the fluid out")]
    InFluid { condition: String, shape: &'static str },
    #[error(
        "condition `{condition}`: a {shape} needs `{key}`: state it in this condition of the set"
    )]
    MissingSize { condition: String, shape: &'static str, key: &'static str },
    #[error("condition {condition}: a {shape} cannot be the intruder of a {space} bed")]
    WrongSpace { condition: String, shape: &'static str, space: &'static str },
    #[error(
        "the prior of `{name}` is in {found}; expected {}",
        if expected.is_empty() { "a number without a unit" } else { expected }
    )]
    PriorUnit {
        name: String,
        /// SI unit of what the set says.
        found: String,
        /// SI unit of the coefficient; empty for a pure number.
        expected: String,
    },
    #[error("condition {condition}: `{key}` of a {shape} cannot be {value}")]
    BadSize {
        condition: String,
        shape: &'static str,
        key: &'static str,
        /// (SI).
        value: f64,
    },
}
