//! Why a model cannot be compared with a set.

use thiserror::Error;

/// Why a model cannot be compared with a set.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ForwardError {
    /// A grain bed.
    #[error("`{model}` is a bed of grains, not a force law")]
    Grains {
        /// Name of the model.
        model: String,
    },
    /// A crater, of which the surface is no part.
    #[error(
        "`{model}` is a force law, which says nothing of craters; `MeasurementSet::without_craters` leaves them out"
    )]
    Craters {
        /// Name of the model.
        model: String,
    },
    /// The set asks for a shape that is not there.
    #[error("condition {condition}: there is no shape `{shape}`; known: {}", known.join(", "))]
    UnknownShape {
        /// Id of the condition.
        condition: String,
        /// What the set says.
        shape: String,
        /// What there is.
        known: Vec<&'static str>,
    },
    /// A body that no drive pushes.
    #[error("condition {condition}: a {shape} cannot be pushed: a drive moves a body of one part")]
    NotPushed {
        /// Id of the condition.
        condition: String,
        /// Name of the shape.
        shape: &'static str,
    },
    /// A body whose spin no force law changes.
    #[error(
        "condition {condition}: a force law keeps the spin of a {shape}; of links alone it says how they turn"
    )]
    KeepsSpin {
        /// Id of the condition.
        condition: String,
        /// Name of the shape.
        shape: &'static str,
    },
    /// A body whose drag in a fluid is not modelled.
    #[error("condition {condition}: no {shape} is modelled in a fluid; leave the fluid out")]
    InFluid {
        /// Id of the condition.
        condition: String,
        /// Name of the shape.
        shape: &'static str,
    },
    /// A size of a shape is not given.
    #[error(
        "condition `{condition}`: a {shape} needs `{key}`: state it in this condition of the set"
    )]
    MissingSize {
        /// Id of the condition.
        condition: String,
        /// Name of the shape.
        shape: &'static str,
        /// What is missing.
        key: &'static str,
    },
    /// A shape that the set's geometry does not have.
    #[error("condition {condition}: a {shape} cannot be the intruder of a {space} bed")]
    WrongSpace {
        /// Id of the condition.
        condition: String,
        /// Name of the shape.
        shape: &'static str,
        /// `2d` or `3d`.
        space: &'static str,
    },
    /// A prior in the unit of another quantity.
    #[error(
        "the prior of `{name}` is in {found}; expected {}",
        if expected.is_empty() { "a number without a unit" } else { expected }
    )]
    PriorUnit {
        /// Name of the coefficient.
        name: String,
        /// SI unit of what the set says.
        found: String,
        /// SI unit of the coefficient; empty for a pure number.
        expected: String,
    },
    /// A size outside of what the shape can have.
    #[error("condition {condition}: `{key}` of a {shape} cannot be {value}")]
    BadSize {
        /// Id of the condition.
        condition: String,
        /// Name of the shape.
        shape: &'static str,
        /// Which size.
        key: &'static str,
        /// (SI).
        value: f64,
    },
}
