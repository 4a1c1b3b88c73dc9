//! The page of a measurement set as it was understood.

use diagnosis::picture;
use measurements::{Kind, Loaded, Role};

use crate::ReportError;
use crate::figure::figure;
use crate::page::{Number, Page, Part, Section};

/// The page of `loaded`, before anything is fitted to it.
///
/// # Errors
/// If the figure cannot be drawn.
pub fn of_set(loaded: &Loaded) -> Result<String, ReportError> {
    let set = &loaded.set;
    let caption = match set.kind {
        Kind::Trajectory => {
            "Every reading of every run, in SI and counted downward. A run that does not start along \
             the dashed line has another sign, unit or zero than the set says."
        }
        Kind::Scalar => "Every number of every run over the stated impact speed.",
        _ => "Every reading of every run, in SI, as it is counted.",
    };
    let held_out = set.conditions.iter().filter(|one| one.role == Role::Holdout).count();
    let readings: usize = set.runs.iter().map(|run| run.frames.len() + run.samples.len()).sum();
    let notes: Vec<Part> = set.notes.iter().cloned().map(Part::Text).collect();
    let contradictions = loaded
        .contradictions
        .iter()
        .map(|one| match &one.diagnostic.help {
            Some(help) => format!("{}; {help}", one.diagnostic.message),
            None => one.diagnostic.message.clone(),
        })
        .map(Part::Text);
    let agreement = Some(loaded.agreement.describe(set)).filter(|text| !text.is_empty());
    let held = contradictions.chain(agreement.map(Part::Listing)).collect();
    let held_out = format!("{held_out} held out");
    let mut headline = vec![
        Number::new("conditions", set.conditions.len().to_string(), held_out),
        Number::new("runs", set.runs.len().to_string(), ""),
    ];
    if readings > 0 {
        headline.push(Number::new("readings", readings.to_string(), ""));
    }
    let page = Page {
        title: set.id.clone(),
        kind: "measurement set",
        lead: set.source.clone().unwrap_or_else(|| "What was understood of the files.".to_owned()),
        headline,
        sections: [
            Section::new("What was read", vec![figure(&picture::measured(set)?, caption)]),
            Section::new("Held against its own frames", held),
            Section::new("Notes", notes),
            Section::new("In words", vec![Part::Listing(loaded.describe())]),
        ]
        .into_iter()
        .flatten()
        .collect(),
        origin: vec![("plunge", env!("CARGO_PKG_VERSION").to_owned())],
    };
    page.html()
}
