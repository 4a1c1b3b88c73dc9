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
mod e15_intrusion;

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
    &e15_intrusion::ROW,
];

#[cfg(test)]
mod tests {
    use std::num::NonZero;
    use std::path::Path;

    use super::*;
    use crate::published::check::{Band, Estimate};
    use crate::published::planar::{self, Bed, Fall};
    use crate::published::row::{Findings, PublishedError};
    use crate::published::{
        Check, Effort, Judged, Laboratory, Missing, Verdict, markdown, to_json,
    };
    use crate::three_shapes::Places;
    use runner::Unattended;
    use runner::beds::Place;

    /// Two impacts on a bed of a thousand grains.
    static SHALLOW: Row = Row {
        id: "E0",
        title: "A shallow bed",
        source: "nobody",
        how: ["at once", "at once"],
        judge: shallow,
    };

    fn shallow(laboratory: &Laboratory<'_>) -> Result<Findings, PublishedError> {
        let [left, middle, _] = Fall::everywhere(Bed::Shallow, 0.5);
        let records = planar::impacts(laboratory, &[left, middle])?;
        let band = Band { half: 0.1, reason: "more than the bed is deep" };
        let check = |record: &runner::beds::Record| {
            let error = record.stopping_time.unwrap_or(0.0);
            Check::at_most("depth (m)", "", Estimate::new(record.deepest, error), band)
        };
        let checks = records.iter().flatten().map(check).collect();
        Ok(Findings { checks, ..Findings::default() })
    }

    /// Where everything is run anew in `folder`, so many impacts at a time.
    fn laboratory(folder: &Path, workers: usize) -> Laboratory<'_> {
        Laboratory {
            effort: Effort::Quick,
            missing: Missing::Run,
            place: Place {
                cache: folder,
                workers: NonZero::new(workers),
                watch: &Unattended,
                elsewhere: None,
            },
            shapes: Places { out: folder.into(), cache: folder.into() },
            sets: Path::new(env!("CARGO_MANIFEST_DIR")).join("data"),
        }
    }

    #[test]
    fn judged_from_an_empty_cache_on_one_thread_and_on_two_the_bytes_are_the_same() {
        let texts = [1, 2].map(|workers| {
            let folder = tempfile::tempdir().expect("a folder");
            let laboratory = laboratory(folder.path(), workers);
            let rows = [&SHALLOW, &e09_links::ROW, &e14_chain_forces::ROW];
            let judged = rows.map(|row| Judged::by(row, &laboratory));
            assert_eq!(judged[0].count(Verdict::Pass), 2);
            [to_json(&judged, Effort::Quick).to_string(), markdown(&judged, Effort::Quick)]
        });
        assert_eq!(texts[0], texts[1]);
    }

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
    fn what_needs_no_bed_is_judged_and_fails_where_it_is_known_to() {
        let folder = tempfile::tempdir().expect("a folder");
        let laboratory = laboratory(folder.path(), 1);
        let e10 = e10_contacts_and_others::without_beds();
        let judged =
            [e09_links::ROW.judge, e14_chain_forces::ROW.judge].map(|judge| judge(&laboratory));
        let checks = judged.into_iter().chain([e10]).flat_map(|findings| {
            findings.unwrap_or_else(|error| panic!("{error}")).checks.into_iter()
        });
        let failing = checks.filter(|check: &Check| check.verdict > Verdict::Pass);
        let failing: Vec<String> = failing.map(|check| check.what).collect();
        // The two-link manuscript says that the static force overtakes later at higher speed.
        let overtakes = |angles| format!("{angles}: static force overtakes (ms after contact)");
        assert_eq!(failing, ["30° and -30°", "20° and -40°"].map(overtakes));
    }

    #[test]
    fn rows_whose_impacts_are_still_to_be_run_are_not_judged_and_do_not_fail() {
        let folder = tempfile::tempdir().expect("a folder");
        let laboratory = Laboratory {
            effort: Effort::Full,
            missing: Missing::LeaveOut,
            ..laboratory(folder.path(), 1)
        };
        let judged = ROWS.iter().map(|row| Judged::by(row, &laboratory));
        // The others need impacts on beds.
        for one in judged.filter(|one| !["E9", "E10", "E14"].contains(&one.row.id)) {
            assert_eq!(one.verdict(), Verdict::NotRun, "{}: {:?}", one.row.id, one.findings);
        }
        let trends = e10_trends::checks(&laboratory).expect("models");
        assert!(trends.iter().all(|check| check.verdict == Verdict::NotRun), "{trends:?}");
    }
}
