//! What to try where no listed effect explains the data: a formula that grows where the force is too
//! small. A guess from the shape of the residual, and nothing that was tested.

use measurements::MeasurementSet;

use crate::force_error::{ForceError, ForceErrors};

/// A candidate of one's own, as a table for the model file, for what `errors` of `set` depend on most
/// clearly; none where no force of the state of a body would do.
#[must_use]
pub fn suggestion(set: &MeasurementSet, errors: &ForceErrors) -> Option<String> {
    let over = *errors.depends_on().first()?;
    let parts = errors.groups.iter().map(|group| &group.error).filter(|error| error.over == over);
    let clarity = |error: &ForceError| error.force_error / error.se;
    let largest = parts.clone().max_by(|a, b| clarity(a).total_cmp(&clarity(b)))?;
    let upper = parts.clone().all(|part| part.to <= largest.to);
    let (kind, force) = formula(over, largest, upper, diameter(set))?;
    Some(format!(
        "[[candidate]]\nname = \"expression\"\nid = \"suggested\"\nkind = \"{kind}\"\nforce = \
         \"{force}\"\nparameters.q = {{ unit = \"1\", range = [0, 1000] }}\n"
    ))
}

/// Kind and force of an effect that acts where the error over `over` is largest; `upper` says that this
/// is at the greatest values.
fn formula(
    over: &str,
    largest: &ForceError,
    upper: bool,
    diameter: f64,
) -> Option<(&'static str, String)> {
    let friction = |force: &str| Some(("friction", force.to_owned()));
    match (over, upper) {
        ("z", _) => {
            let centre = 0.5 * (largest.from + largest.to) / diameter;
            let width = 0.5 * (largest.to - largest.from) / diameter;
            let bump = format!("exp(0 - ((z / D - {centre:.2}) / {width:.2})^2)");
            Some(("friction", format!("q * rho * g * A * z * {bump}")))
        }
        ("speed", true) => Some(("drag", "q * rho * A * v^2 * v / V_s".to_owned())),
        ("speed", false) => friction("q * rho * g * A * D / (1 + (v / V_s)^2)"),
        ("angle_deg", true) => friction("q * rho * g * A * z * sin(theta)"),
        ("angle_deg", false) => friction("q * rho * g * A * z * cos(theta)"),
        ("diameter", _) => friction("q * rho * g * A * D"),
        ("mass", _) => friction("q * m * g"),
        ("spin", _) => Some(("drag", "q * rho * A * D * abs(omega) * v".to_owned())),
        ("packing", _) => friction("q * rho * g * A * z * phi"),
        ("bed_depth", _) => friction("q * rho * g * A * D * exp((z - H) / D)"),
        _ => None,
    }
}

/// Mean diameter of what was dropped (m).
fn diameter(set: &MeasurementSet) -> f64 {
    let total: f64 = set.conditions.iter().map(|condition| condition.diameter).sum();
    total / set.conditions.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use configs::{LoadOptions, Model, ModelSource, find_shipped};

    use super::*;

    #[test]
    fn every_suggestion_is_a_candidate_that_a_model_can_have() {
        let covariates =
            ["z", "speed", "angle_deg", "diameter", "mass", "spin", "packing", "bed_depth"];
        for over in covariates {
            for upper in [false, true] {
                let part = ForceError { over, from: 0.01, to: 0.03, force_error: 0.2, se: 0.02 };
                let (kind, force) = formula(over, &part, upper, 0.025).expect("a formula");
                let text = format!(
                    "{}\n[[candidate]]\nname = \"expression\"\nid = \"suggested\"\nkind = \
                     \"{kind}\"\nforce = \"{force}\"\nparameters.q = {{ unit = \"1\", range = \
                     [0, 1000] }}\n",
                    find_shipped("two-term-vector").expect("it ships").text
                );
                let source =
                    ModelSource::Text { name: "model".to_owned(), text, folder: ".".into() };
                let loaded = Model::load(source, &LoadOptions::default());
                assert!(loaded.is_ok(), "{over}: {force}: {:?}", loaded.err());
            }
        }
        let part = ForceError { over: "order", from: 1.0, to: 9.0, force_error: 0.2, se: 0.02 };
        assert!(formula("order", &part, true, 0.025).is_none());
    }
}
