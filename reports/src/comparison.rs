//! The report of a comparison: how wrong each revision of a model is, and where.

use diagnosis::observed::error_columns::{Column, columns};
use serde_json::Value;

use crate::figure::figure;
use crate::numbers::{fixed, list, probability, text};
use crate::page::{Number, Page, Part, Section};
use crate::{ReportError, Texts, object, tables};

/// The file whose presence means a comparison.
pub(crate) const RESULT: &str = "comparison.json";

/// Views of a comparison or diagnosis, each with its heading and what it shows.
const VIEWS: [(&str, &str, &str); 7] = [
    (
        "revisions.svg",
        "Error by revision",
        "Root mean square error, revision after revision; the dashed lines are what the noise of the \
         means alone would give.",
    ),
    (
        "trajectories.svg",
        "Measured along the path",
        "Measured positions or forces under the predictions, and their changes: velocities and slopes are differences \
         between readings.",
    ),
    (
        "signatures.svg",
        "Signatures",
        "What the model leaves over, and what the two best effects would add. Where both follow it \
         alike, no verdict can choose between them.",
    ),
    (
        "map-speed-angle.svg",
        "Where the force is wrong: speed and angle",
        "By how much the measured force is larger than in the model, over the whole path of each \
         condition.",
    ),
    (
        "map-depth.svg",
        "Where the force is wrong: depth",
        "The same around six depths of each condition.",
    ),
    (
        "covariates.svg",
        "Where the force is wrong: everything that was varied",
        "The same over each covariate, with its trend.",
    ),
    (
        "residuals.svg",
        "What is left along the path",
        "Measured less predicted; the band holds 95 % of the means, if the model were right.",
    ),
];

pub(crate) fn page(texts: &Texts) -> Result<String, ReportError> {
    let comparison = object(texts, RESULT)?;
    let models = list(&comparison["models"]);
    if models.is_empty() {
        return crate::run::pair_page(texts, &comparison);
    }
    let mut sections = vec![Section::new("Errors", vec![Part::Table(tables::errors(models))])];
    if let Some(svg) = texts.get("comparison.svg") {
        let caption = "Measured numbers with their errors, under what each revision predicts.";
        sections.push(Section::new("Measured and predicted", vec![figure(svg, caption)]));
    }
    let refitted = tables::parameters(models);
    let refitted = (!refitted.is_empty()).then_some(Part::Table(refitted));
    sections.push(Section::new("Parameters, refitted", refitted.into_iter().collect()));
    sections.extend(views(texts, &[]).into_iter().map(Some));
    sections.push(Section::new("Errors by kind of number", by_kind(texts)));
    let failures = match tables::failures(models) {
        none if none.is_empty() => {
            Part::Text("Nowhere, at a false-discovery rate of 5 %.".to_owned())
        }
        table => Part::Table(table),
    };
    sections.push(Section::new("Where the force is wrong, in numbers", vec![failures]));
    let names: Vec<String> = models.iter().map(|model| text(&model["model"])).collect();
    let page = Page {
        title: text(&comparison["set"]),
        kind: "comparison",
        lead: format!("{} against the measurements.", names.join(", ")),
        headline: headline(models),
        sections: sections.into_iter().flatten().collect(),
        origin: vec![("plunge", env!("CARGO_PKG_VERSION").to_owned())],
    };
    page.html()
}

/// A section for each of [`VIEWS`] that there is, `but` some.
pub(crate) fn views(texts: &Texts, but: &[&str]) -> Vec<Section> {
    let view = |&(name, heading, caption): &(&str, &str, &str)| {
        Section::new(heading, vec![figure(texts.get(name)?, caption)])
    };
    VIEWS.iter().filter(|(name, ..)| !but.contains(name)).filter_map(view).collect()
}

/// The figure of errors by kind of number.
pub(crate) fn by_kind(texts: &Texts) -> Vec<Part> {
    let caption = "Root mean square errors where the model was fitted and where it was not.";
    texts.get("errors.svg").map(|svg| figure(svg, caption)).into_iter().collect()
}

fn headline(models: &[Value]) -> Vec<Number> {
    let of = |model: &Value, role: &str| {
        let (column, error) = main_error(&model["rms"][role])?;
        Some((format!("{:.3}", column.scale * error), column.heading))
    };
    let (first, last) = (&models[0], &models[models.len() - 1]);
    let mut numbers = Vec::new();
    for (role, name) in [("fit", "error where fitted"), ("holdout", "error held out")] {
        let Some((after, heading)) = of(last, role) else { continue };
        let value = match of(first, role).filter(|_| models.len() > 1) {
            Some((before, _)) => format!("{before} \u{2192} {after}"),
            None => after,
        };
        numbers.push(Number::new(name, value, heading));
    }
    let fit = last["chi2_per_n"].as_f64();
    numbers.push(Number::new(
        "\u{3c7}\u{b2} per datum",
        fixed(fit, 2),
        "about 1 if the model is right",
    ));
    numbers.push(Number::new(
        "lack of fit",
        format!("p {}", probability(last["p_lof"].as_f64())),
        text(&last["model"]),
    ));
    numbers
}

/// The error that a headline shows, with its column.
fn main_error(errors: &Value) -> Option<(Column, f64)> {
    let find = |column: Column| errors[column.key].as_f64().map(|error| (column, error));
    // Along the path where there is one, else relative.
    let first = columns().into_iter().take(1);
    first.chain(columns().into_iter().rev()).find_map(find)
}
