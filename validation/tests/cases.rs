//! Every case, as `cargo xtask validate` runs them.

use engine::parallel::with_threads;
use validation::{CASES, Outcome};

#[test]
fn every_row_of_every_case_holds() {
    let failures: Vec<(&str, Outcome)> = with_threads(1, || {
        let rows =
            CASES.iter().flat_map(|case| (case.run)().into_iter().map(|row| (case.name, row)));
        rows.filter(|(_, row)| !row.holds()).collect()
    })
    .expect("one thread");
    assert!(failures.is_empty(), "{failures:#?}");
}

#[test]
fn every_case_has_a_name_of_its_own_a_claim_and_reasons() {
    for (k, case) in CASES.iter().enumerate() {
        assert!(case.name.chars().all(|c| c.is_ascii_lowercase() || c == '-'), "{}", case.name);
        assert!(CASES[..k].iter().all(|other| other.name != case.name), "{}", case.name);
        assert!(case.claim.ends_with('.'), "{}", case.name);
    }
}
