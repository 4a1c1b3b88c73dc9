//! Every candidate of a bed of grains: the effects of the registries that are candidates, then what every bed has.

use std::sync::LazyLock;

use contact_laws::{Candidacy, GRAIN_FORCES, LAWS};
use resistive::{RESISTANCE_LAWS, Role};

use super::bed_candidate::BedCandidate;
use super::changes::CHANGES;

/// The candidates of the simulation, in the order of the docs.
pub static BED_CANDIDATES: LazyLock<Vec<BedCandidate>> = LazyLock::new(|| {
    let laws = LAWS.iter().map(|law| (law.name, law.candidacy));
    let forces = GRAIN_FORCES.iter().map(|force| (force.name, force.candidacy));
    let effects = laws.chain(forces).filter_map(|(name, candidacy)| match candidacy {
        Candidacy::Candidate(candidate) => Some(BedCandidate::of_effect(name, candidate)),
        Candidacy::None(_) => None,
    });
    effects.chain(CHANGES.iter().copied()).collect()
});

/// The effects of force laws that act on an intruder in a bed of grains as well, or on how it is seen; the others
/// are what grains do.
pub(super) static OF_THE_APPARATUS: LazyLock<Vec<&'static str>> = LazyLock::new(|| {
    let is_one =
        |role| matches!(role, Role::Effect(facts) if facts.kind.absent_from_beds().is_none());
    RESISTANCE_LAWS.iter().filter(|law| is_one(law.role)).map(|law| law.name).collect()
});

/// Whether the candidates `one` and `other` differ before first contact alone.
pub(super) fn are_alike_below(one: &str, other: &str) -> bool {
    let says = |id: &str, of: &str| {
        BED_CANDIDATES.iter().any(|own| own.id == id && own.is_alike_below(of))
    };
    says(one, other) || says(other, one)
}

#[cfg(test)]
mod tests {
    use contact_laws::ActsOn;

    use super::*;

    /// The reason why the diagnosis of a bed does not look for the effect called `name`; `None` for a candidate.
    fn reason(name: &str) -> Option<&'static str> {
        let laws = LAWS.iter().map(|law| (law.name, law.candidacy));
        let forces = GRAIN_FORCES.iter().map(|force| (force.name, force.candidacy));
        let contacts = laws.chain(forces).map(|(name, candidacy)| match candidacy {
            Candidacy::Candidate(_) => (name, None),
            Candidacy::None(why) => (name, Some(why)),
        });
        let of_laws = RESISTANCE_LAWS.iter().filter_map(|law| match law.role {
            Role::Effect(facts) => Some((law.name, facts.kind.absent_from_beds())),
            Role::Baseline => None,
        });
        contacts.chain(of_laws).find(|(own, _)| *own == name).and_then(|(_, why)| why)
    }

    fn is_candidate(name: &str) -> bool {
        BED_CANDIDATES.iter().any(|bed_candidate| bed_candidate.id == name)
            || OF_THE_APPARATUS.contains(&name)
    }

    #[test]
    fn every_effect_is_a_candidate_of_a_bed_or_says_why_not() {
        let of_base = LAWS.first().and_then(|law| reason(law.name));
        for law in LAWS.iter().filter(|law| law.acts_on == ActsOn::ContactEffect) {
            let why = reason(law.name);
            assert_eq!(is_candidate(law.name), why.is_none(), "{}", law.name);
            assert!(why.is_none_or(|why| !why.is_empty() && of_base != Some(why)), "{}", law.name);
        }
        for force in GRAIN_FORCES {
            assert_eq!(is_candidate(force.name), reason(force.name).is_none(), "{}", force.name);
        }
        for law in RESISTANCE_LAWS.iter().filter(|law| matches!(law.role, Role::Effect(_))) {
            // The preparation of a bed and that of a medium without grains have one name.
            let is_candidate = is_candidate(law.name) && law.name != "packing";
            assert_eq!(is_candidate, reason(law.name).is_none(), "{}", law.name);
        }
    }

    #[test]
    fn candidates_that_look_alike_are_candidates_and_each_pair_says_so_once() {
        for bed_candidate in BED_CANDIDATES.iter() {
            assert!(!are_alike_below(bed_candidate.id, bed_candidate.id));
            for other in
                BED_CANDIDATES.iter().filter(|other| bed_candidate.is_alike_below(other.id))
            {
                assert!(
                    !other.is_alike_below(bed_candidate.id),
                    "{} and {}",
                    bed_candidate.id,
                    other.id
                );
            }
        }
        for (one, other) in
            [("rail-friction", "cohesion-dmt"), ("capillary-bridge", "cohesion-dmt")]
        {
            assert!(
                is_candidate(one) && are_alike_below(one, other) && are_alike_below(other, one)
            );
        }
    }

    #[test]
    fn the_screened_amplitude_is_searched_and_every_candidate_stands_in_the_docs() {
        let docs = include_str!("../../../docs/grain-diagnosis.md");
        for bed_candidate in BED_CANDIDATES.iter() {
            let (least, most) = bed_candidate.range;
            assert!(
                least <= 0.0 && 0.0 < bed_candidate.screen && bed_candidate.screen <= most,
                "{}",
                bed_candidate.id
            );
            assert!(docs.contains(&format!("`{}`", bed_candidate.id)), "{}", bed_candidate.id);
        }
        for id in OF_THE_APPARATUS.iter() {
            assert!(docs.contains(&format!("`{id}`")), "{id}");
        }
    }
}
