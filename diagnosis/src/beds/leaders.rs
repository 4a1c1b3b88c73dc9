//! Which effects get impacts of their own, and which of those that explain the same are confirmed on fresh beds.

use super::emulator::BedForward;
use super::plan::{LEADERS, SEARCHES};
use crate::forward::Forward;
use crate::misfit::held_out::HeldOut;
use crate::verdict::{Diagnosis, Verdict};

/// Whether one effect is ahead of all others.
pub(super) fn is_settled(diagnosis: &Diagnosis) -> bool {
    diagnosis.verdict.names_effects() && diagnosis.leaders.len() == 1
}

/// The candidates to search next, each with its guess: those of the first few effects of the ranking, apparatus
/// counted among the few, and those of every leader. A screening varies all effects at once, so an effect may rank low only
/// because it was not searched. None where nothing is named.
pub(super) fn leaders(
    diagnosis: &Diagnosis,
    forward: &BedForward,
    searched: &[usize],
) -> Vec<(usize, f64)> {
    if matches!(diagnosis.verdict, Verdict::NothingDetected | Verdict::CannotTell) {
        return Vec::new();
    }
    let candidates = Forward::candidates(forward);
    let bed_candidates = diagnosis.ranking.iter().filter_map(|effect| {
        let index = candidates.iter().position(|one| one.id == effect.id)?;
        Some((forward.bed_candidate(index)?, effect.q?, diagnosis.leaders.contains(&effect.id)))
    });
    bed_candidates
        .enumerate()
        .filter(|(rank, (at, _, leads))| {
            (*rank < SEARCHES * LEADERS || *leads) && !searched.contains(at)
        })
        .map(|(_, (at, guess, _))| (at, guess))
        .take(LEADERS)
        .collect()
}

/// Whether an effect that is lost in the scatter may explain what is left: no effect is named, or the named one leaves more
/// than noise on the fresh beds that it is `confirmed` on.
pub(super) fn leaves_room(diagnosis: &Diagnosis, confirmed: Option<&HeldOut>) -> bool {
    match diagnosis.verdict {
        Verdict::NoneOfTheCandidates | Verdict::CannotTell => true,
        named if named.names_effects() => {
            confirmed.is_some_and(|one| one.leaves_more_than_noise() == Some(true))
        }
        _ => false,
    }
}

/// Whether fresh beds tell `rival` from `leader`, which explains as much of what was fitted to: with it, held-out
/// conditions are missed by what would call for a name, or hardly less than without it, and with the leader they are not.
pub(super) fn is_beaten(rival: &HeldOut, leader: &HeldOut) -> bool {
    let holds = |one: &HeldOut| {
        one.leaves_more_than_noise() == Some(false) && one.is_nearer() == Some(true)
    };
    let fails = rival.leaves_more_than_noise() == Some(true) || rival.is_nearer() == Some(false);
    holds(leader) && fails
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with(after: f64) -> HeldOut {
        HeldOut { log_density_gain: 1.0, ..HeldOut::of_errors(2.9, after, 1.0) }
    }

    #[test]
    fn a_rival_is_beaten_by_a_leader_within_the_noise_that_it_is_not_within() {
        assert!(is_beaten(&with(1.6), &with(1.0)));
        assert!(!is_beaten(&with(1.4), &with(0.8)), "both are within the noise");
        assert!(!is_beaten(&with(2.5), &with(1.6)), "the leader misses too");
        assert!(!is_beaten(&HeldOut { after: None, ..with(1.0) }, &with(1.0)), "nothing is known");
    }

    #[test]
    fn there_is_room_where_what_is_named_leaves_more_than_noise_and_where_nothing_can_be_named() {
        let mut diagnosis = Diagnosis::cannot_tell(Vec::new(), String::new());
        let mut room = |verdict, confirmed: Option<&HeldOut>| {
            diagnosis.verdict = verdict;
            leaves_room(&diagnosis, confirmed)
        };
        assert!(room(Verdict::NoneOfTheCandidates, None));
        assert!(room(Verdict::CannotTell, None));
        assert!(!room(Verdict::NothingDetected, None));
        assert!(room(Verdict::Supported, Some(&with(1.6))));
        assert!(!room(Verdict::Supported, Some(&with(1.1))), "it explains all that exceeds noise");
        assert!(!room(Verdict::BelowNoise, Some(&with(1.6))), "too small to be named");
    }
}
