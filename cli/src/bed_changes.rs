//! Changes of a bed that its diagnosis tries, as `plunge effects` shows them.

use diagnosis::beds::{BED_CANDIDATES, BedCandidate};
use resistive::Kind;
use serde_json::{Value, json};

/// Every one that is not an effect of a registry.
pub(crate) fn all() -> impl Iterator<Item = &'static BedCandidate> {
    BED_CANDIDATES.iter().filter(|bed_candidate| bed_candidate.is_change())
}

pub(crate) fn as_text(change: &BedCandidate) -> String {
    let (least, most) = change.range;
    format!(
        "{}  a change of the bed, in a medium of the kind \"grains\"\n\n\
         amplitude  {}\n\
         range      {least} to {most}, screened at {}\n\
         separable  {}\n\
         diagnosis  of beds: {}\n",
        change.id,
        change.amplitude,
        change.screen,
        change.separable_from,
        if change.of_measurements { "always" } else { "where `--candidate` names it" },
    )
}

pub(crate) fn as_json(change: &BedCandidate) -> Value {
    json!({
        "name": change.id,
        "medium": "grains",
        "acts_on": match change.kind {
            Kind::Preparation => "preparation",
            _ => "grains",
        },
        "diagnosis_of_beds": {
            "amplitude": change.amplitude,
            "screened_at": change.screen,
            "range": [change.range.0, change.range.1],
            "told_apart": change.separable_from,
            "only_if_named": !change.of_measurements,
        },
    })
}
