//! What an effect is, as its registry says.

use contact_laws::{self, find_grain_force};
use diagnosis::beds::BED_CANDIDATES;
use resistive::find_resistance;

/// An effect of no registry.
const OWN: &str = "A formula of your own.";

/// An effect in words.
pub(crate) struct About {
    /// What it does, a sentence.
    pub(crate) summary: String,
    /// What its amplitude q is; none of a formula of the user's own.
    pub(crate) amplitude: Option<&'static str>,
    /// Its law, as a formula.
    pub(crate) law: Option<&'static str>,
    /// Where the law is from.
    pub(crate) source: Option<&'static str>,
}

impl About {
    /// The effect `id`. Of a bed of grains, what the simulation has under this name comes before what a force law has.
    pub(crate) fn of(id: &str, is_of_a_bed: bool) -> Self {
        let switch = BED_CANDIDATES.iter().find(|switch| is_of_a_bed && switch.id == id);
        let listed = |summary: &str, law, source| Self {
            summary: summary.to_owned(),
            amplitude: switch.map(|switch| switch.amplitude),
            law: Some(law),
            source: Some(source),
        };
        match (switch, contact_laws::find(id), find_grain_force(id)) {
            (Some(switch), ..) if switch.is_change() => Self {
                summary: "A change of the bed.".to_owned(),
                amplitude: Some(switch.amplitude),
                law: None,
                source: None,
            },
            (Some(_), Some(law), _) => listed(law.summary, law.formula, law.source),
            (Some(_), _, Some(force)) => listed(force.summary, force.formula, force.source),
            _ => match find_resistance(id) {
                Some(law) => Self {
                    amplitude: law.params.iter().find(|one| one.key == "q").map(|one| one.meaning),
                    ..listed(law.summary, law.formula, law.source)
                },
                None => Self { summary: OWN.to_owned(), amplitude: None, law: None, source: None },
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_bed_may_lack_is_described_by_its_registry() {
        for switch in BED_CANDIDATES.iter() {
            let about = About::of(switch.id, true);
            assert_eq!(about.amplitude, Some(switch.amplitude), "{}", switch.id);
            assert_eq!(about.law.is_none(), switch.is_change(), "{}", switch.id);
        }
        assert!(About::of("packing", true).law.is_none(), "a bed is prepared again");
        assert!(About::of("packing", false).law.is_some(), "a force law has a term");
        assert_eq!(About::of("stickiness", true).summary, OWN);
    }
}
