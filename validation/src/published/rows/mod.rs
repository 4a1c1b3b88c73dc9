//! The table of rows.

use super::row::Row;

mod e01_stopping_time;
mod e02_depth_and_range;
mod e03_force_law;
mod e04_law_integrated;
mod e05_regimes;
mod e06_shapes;
mod e07_intruder_friction;
mod e08_energy;
mod e09_links;
mod e10_contacts_and_others;
mod e10_trends;
mod e11_course;
mod e12_vertical_force;
mod e13_hemisphere;
mod e14_chain_forces;

/// Every row, in the order of its number.
pub static ROWS: &[&Row] = &[
    &e01_stopping_time::ROW,
    &e02_depth_and_range::ROW,
    &e03_force_law::ROW,
    &e04_law_integrated::ROW,
    &e05_regimes::ROW,
    &e06_shapes::ROW,
    &e07_intruder_friction::ROW,
    &e08_energy::ROW,
    &e09_links::ROW,
    &e10_contacts_and_others::ROW,
    &e11_course::ROW,
    &e12_vertical_force::ROW,
    &e13_hemisphere::ROW,
    &e14_chain_forces::ROW,
];

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::beds::{Place, Unattended};
    use crate::published::{Check, Effort, Laboratory, Missing, Verdict};
    use crate::three_shapes::Places;

    #[test]
    fn every_row_has_an_id_of_its_own_a_source_and_says_how_it_is_run() {
        for (at, row) in ROWS.iter().enumerate() {
            assert!(ROWS[..at].iter().all(|other| other.id != row.id), "{}", row.id);
            for text in [row.title, row.source, row.how[0], row.how[1]] {
                assert!(!text.is_empty(), "{}", row.id);
            }
        }
    }

    #[test]
    fn what_needs_no_bed_is_judged_and_does_not_fail() {
        let folder = tempfile::tempdir().expect("a folder");
        let laboratory = Laboratory {
            effort: Effort::Quick,
            missing: Missing::Run,
            place: Place { cache: folder.path(), workers: None, watch: &Unattended },
            shapes: Places { out: folder.path().into(), cache: folder.path().into() },
            sets: Path::new(env!("CARGO_MANIFEST_DIR")).join("data"),
        };
        let e10 = e10_contacts_and_others::without_beds();
        let judged =
            [e09_links::ROW.judge, e14_chain_forces::ROW.judge].map(|judge| judge(&laboratory));
        for findings in judged.into_iter().chain([e10]) {
            let findings = findings.unwrap_or_else(|error| panic!("{error}"));
            let failing = findings.checks.iter().filter(|check| check.verdict == Verdict::Fail);
            assert_eq!(failing.collect::<Vec<_>>(), Vec::<&Check>::new());
        }
    }
}
