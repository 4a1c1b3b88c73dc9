//! Effects that a model file defines, as `plunge effects` shows them.

use std::path::Path;
use std::sync::Arc;

use configs::{LoadOptions, Model, ModelSource, describe_range};
use engine::units::format_si;
use resistive::Space;
use resistive::formula::FUNCTIONS;
use resistive::{Effect, OwnEffect, STATE_VARIABLES};
use serde_json::{Value, json};

use crate::output::{self, CommandError, CommandResult};

/// An effect of a model, or a candidate in it.
pub(crate) struct OwnInModel {
    pub(crate) effect: Arc<OwnEffect>,
    /// Its amplitude (SI), where it is part of the model.
    q: Option<f64>,
}

/// The effects that the model at `path` defines.
pub(crate) fn of(path: &Path) -> Result<Vec<OwnInModel>, CommandError> {
    let loaded = Model::load(ModelSource::from_argument(path), &LoadOptions::default())?;
    let Some(resistive) = loaded.model.resistive() else { return Ok(Vec::new()) };
    let parts = resistive.medium.effects.iter().filter_map(|choice| match &choice.effect {
        Effect::Own(own) => Some(OwnInModel { effect: Arc::clone(own), q: Some(choice.q) }),
        Effect::Listed(..) => None,
    });
    let candidates = resistive.medium.candidates.iter();
    let candidates = candidates.map(|own| OwnInModel { effect: Arc::clone(own), q: None });
    Ok(parts.chain(candidates).collect())
}

impl OwnInModel {
    /// The table of the model file that it stands in.
    pub(crate) fn table(&self) -> &'static str {
        match self.q {
            Some(_) => "[[effect]]",
            None => "[[candidate]]",
        }
    }

    pub(crate) fn describe(&self, as_object: bool) -> CommandResult {
        if as_object {
            return output::json_to_stdout(&self.as_json());
        }
        let draft = self.effect.draft();
        let mut text = format!("{}  {}, defined by the model\n\n", draft.id, self.table());
        if !draft.summary.is_empty() {
            text.push_str(&format!("{}\n\n", configs::printable(&draft.summary)));
        }
        let mut line = |name: &str, value: &str| text.push_str(&format!("{name:<11}{value}\n"));
        line("law", &configs::printable(draft.force.trim()));
        line("energy", &format!("{} (dissipated)", draft.id));
        let needs = self.needs();
        if !needs.is_empty() {
            line("shows with", &needs.join(", "));
        }
        text.push_str("\nparameters\n");
        for parameter in &draft.parameters {
            let value = match (parameter.name.as_str(), self.q) {
                ("q", q) => q,
                _ => parameter.value,
            };
            let value = value
                .map_or("to be fitted".to_owned(), |value| format_si(value, parameter.dimension));
            let range = match parameter.range.max < f64::MAX {
                true => format!("; {}", describe_range(parameter.range, parameter.dimension)),
                false => String::new(),
            };
            text.push_str(&format!("  {}  {value}{range}\n", parameter.name));
        }
        output::to_stdout(&text)
    }

    pub(crate) fn as_json(&self) -> Value {
        let draft = self.effect.draft();
        let parameters = draft.parameters.iter().map(|parameter| {
            let bound = |value: f64| (value.abs() < f64::MAX).then_some(value);
            json!({
                "key": parameter.name,
                "unit": parameter.dimension.si_unit(),
                "value": if parameter.name == "q" { self.q } else { parameter.value },
                "min": bound(parameter.range.min),
                "max": bound(parameter.range.max),
            })
        });
        json!({
            "name": draft.id,
            "medium": "resistive-force",
            "acts_on": "resistance-effect",
            "table": self.table(),
            "summary": draft.summary,
            "law": draft.force,
            "parameters": parameters.collect::<Vec<_>>(),
            "energy": [{ "channel": draft.id, "kind": "dissipated" }],
            "shows_with": self.needs(),
        })
    }

    fn needs(&self) -> Vec<&'static str> {
        self.effect.visible().into_iter().map(|need| need.describe()).collect()
    }
}

/// What the formula of an effect may use.
pub(crate) fn describe_formulas(as_object: bool) -> CommandResult {
    let functions: Vec<&str> = FUNCTIONS.iter().map(|(name, _)| *name).collect();
    if as_object {
        let variables = STATE_VARIABLES.iter().map(|one| {
            json!({
                "name": one.name,
                "meaning": one.meaning,
                "unit": one.dimension(Space::Spatial).si_unit(),
                "planar_unit": one.dimension(Space::Planar).si_unit(),
            })
        });
        return output::json_to_stdout(&json!({
            "name": "expression",
            "medium": "resistive-force",
            "table": "[[effect]]",
            "variables": variables.collect::<Vec<_>>(),
            "functions": functions,
        }));
    }
    let mut text = String::from(
        "expression  [[effect]], in a medium of the kind \"resistive-force\"\n\n\
         A force of your own, as a formula in newtons; as [[candidate]], one that a diagnosis tries.\n\n\
         name = \"expression\"\n\
         id = \"late-drag\"\n\
         force = \"q * rho * A * v^2 * z / D\"\n\
         direction = \"against-motion\"   # or up, down, forward, backward, normal\n\
         kind = \"drag\"                  # or friction, which is there at rest\n\
         acts = \"in-bed\"                # or everywhere\n\
         parameters.q = { value = 0.2, unit = \"1\", range = [0, 5] }\n\nvariables\n",
    );
    for one in STATE_VARIABLES {
        text.push_str(&format!("  {:<7}{}\n", one.name, one.meaning));
    }
    text.push_str(&format!("\nfunctions  {}; and pi\n", functions.join(", ")));
    output::to_stdout(&text)
}
