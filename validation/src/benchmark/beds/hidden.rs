//! What is hidden in a bed.

use configs::Change;
use diagnosis::beds::{BED_CANDIDATES, BedModel, Variation};
use diagnosis::verdict::Verdict;

/// Factor on gravity: an effect that no candidate has.
pub(super) const LIGHTER: f64 = 0.7;

/// What the name of an effect that is not listed begins with.
pub(super) const UNLISTED: &str = "less gravity";

/// What is hidden.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hidden {
    /// Nothing.
    Nothing,
    /// A candidate at an amplitude.
    BedCandidate(&'static str, f64),
    /// Less gravity than the set states, which no candidate is.
    Unlisted,
}

impl Hidden {
    /// What it is called.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Self::Nothing => "nothing".to_owned(),
            Self::BedCandidate(id, q) => format!("{id} {q}"),
            Self::Unlisted => format!("{UNLISTED}, {LIGHTER} of what is stated"),
        }
    }

    /// Whether a verdict that names these effects is right, and whether what it names is wrong. Neither is an answer that
    /// names nothing where something listed is hidden.
    pub(super) fn scored(self, verdict: Verdict, named: &[String]) -> [bool; 2] {
        let is_in = match self {
            Self::BedCandidate(id, _) => {
                named.iter().any(|one| one == id) && verdict != Verdict::Pair
            }
            Self::Nothing | Self::Unlisted => false,
        };
        let right = match self {
            Self::BedCandidate(..) => is_in && named.len() <= 3,
            Self::Nothing => matches!(
                verdict,
                Verdict::NothingDetected
                    | Verdict::ExplainedByApparatus
                    | Verdict::ExplainedByPreparation
                    | Verdict::BelowNoise
            ),
            Self::Unlisted => named.is_empty() && verdict != Verdict::CannotTell,
        };
        [right, !named.is_empty() && !is_in]
    }

    pub(super) fn variation(self, bed_model: &BedModel<'_>) -> Variation {
        match self {
            Self::Nothing => Variation::default(),
            Self::BedCandidate(id, q) => {
                let bed_candidate =
                    BED_CANDIDATES.iter().find(|bed_candidate| bed_candidate.id == id);
                bed_candidate
                    .map_or_else(Variation::default, |one| one.change(bed_model.grains(), q))
            }
            Self::Unlisted => {
                let gravity = bed_model.grains().medium.gravity;
                Variation::before(Change::Gravity(LIGHTER * gravity))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrong_pairs_and_sets_are_wrong_and_the_unlisted_is_blamed_on_nothing() {
        let scored = |hidden: Hidden, verdict, named: &[&str]| {
            let named: Vec<String> = named.iter().map(|&id| id.to_owned()).collect();
            hidden.scored(verdict, &named)
        };
        let (right, neither, wrong) = ([true, false], [false, false], [false, true]);
        let packing = Hidden::BedCandidate("packing", 1.0);
        assert_eq!(scored(packing, Verdict::Supported, &["packing"]), right);
        assert_eq!(scored(packing, Verdict::NotSeparable, &["side-wall", "packing"]), right);
        assert_eq!(scored(packing, Verdict::NotSeparable, &["a", "b", "c", "packing"]), neither);
        assert_eq!(scored(packing, Verdict::NotSeparable, &["side-wall", "pore-air"]), wrong);
        assert_eq!(scored(packing, Verdict::Pair, &["side-wall", "packing"]), wrong);
        assert_eq!(scored(packing, Verdict::Supported, &["side-wall"]), wrong);
        assert_eq!(scored(packing, Verdict::NoneOfTheCandidates, &[]), neither);
        assert_eq!(scored(Hidden::Nothing, Verdict::NothingDetected, &[]), right);
        assert_eq!(scored(Hidden::Nothing, Verdict::CannotTell, &[]), neither);
        assert_eq!(scored(Hidden::Nothing, Verdict::NotSeparable, &["a", "b"]), wrong);
        assert_eq!(scored(Hidden::Unlisted, Verdict::NoneOfTheCandidates, &[]), right);
        assert_eq!(scored(Hidden::Unlisted, Verdict::Pair, &["a", "b"]), wrong);
        assert_eq!(scored(Hidden::Unlisted, Verdict::NotSeparable, &["a", "b"]), wrong);
    }
}
