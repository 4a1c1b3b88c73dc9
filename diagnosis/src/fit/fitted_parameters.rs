//! The free parameters of a model as a fit has them.

use serde_json::{Map, Value, json};

use crate::fit::Fit;
use crate::forward::{Forward, ParameterKind};
use crate::rounding::rounded;

/// Value, standard error and unit of every free parameter of the model; no error of one that is held at the end of its
/// range.
pub fn parameters(forward: &dyn Forward, fit: &Fit) -> Map<String, Value> {
    let values = forward.parameters().iter().zip(&fit.point.parameters).enumerate();
    values
        .filter(|(_, (parameter, _))| parameter.kind == ParameterKind::Model)
        .map(|(at, (parameter, value))| {
            let se = fit.standard_error(at).map_or(Value::Null, rounded);
            let at_bound = parameter.bound_at(*value);
            let entry = json!({
                "value": rounded(parameter.told(*value)),
                "se": se,
                "unit": parameter.unit,
                "at_bound": at_bound,
            });
            (parameter.name.clone(), entry)
        })
        .collect()
}
