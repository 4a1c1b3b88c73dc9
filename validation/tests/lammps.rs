//! Worlds of LAMMPS under the program that they are for: `PLUNGE_LAMMPS=lmp cargo test --workspace --test lammps`.

use std::path::Path;

use measurements::MeasurementSet;
use runner::Unattended;
use runner::beds::Place;
use validation::benchmark::beds::{Case, Hidden};
use validation::speed::lammps::Lammps;

/// Mean and its standard error of the final depths (m) under condition `at`.
fn depth(set: &MeasurementSet, at: usize) -> [f64; 2] {
    let depths: Vec<f64> =
        set.runs.iter().filter(|run| run.condition == at).filter_map(|run| run.final_z).collect();
    let n = depths.len() as f64;
    let mean = depths.iter().sum::<f64>() / n;
    let squares = depths.iter().map(|depth| (depth - mean).powi(2)).sum::<f64>();
    [mean, (squares / (n * (n - 1.0))).sqrt()]
}

#[test]
fn a_bed_that_lammps_rains_and_hits_is_as_deep_as_one_of_plunge_and_rolling_makes_it_shallower() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let place = Place { cache: folder.path(), workers: None, watch: &Unattended, elsewhere: None };
    let lammps = Lammps::find_or_install(Path::new("unused")).expect("PLUNGE_LAMMPS names an lmp");
    let worlds = folder.path().join("worlds");
    let measured = |hidden, is_by_lammps| {
        let case = Case { is_weighed: true, is_by_lammps, ..Case::small(hidden, 1) };
        case.measured(&place, Some((&lammps, &worlds))).expect("impacts").1
    };
    let [own, other] = [false, true].map(|by_lammps| measured(Hidden::Nothing, by_lammps));
    let rolling = measured(Hidden::BedCandidate("rolling-resistance", 0.25), true);
    let packing = |set: &MeasurementSet| set.bed.stated.packing_fraction.expect("it was weighed");
    // Two weighings of three beds each: 0.003 of either, and as much again between three beds and the next three.
    assert!(
        (packing(&own) - packing(&other)).abs() < 0.012,
        "{} {}",
        packing(&own),
        packing(&other)
    );
    for at in 0..own.conditions.len() {
        let [[here, e], [there, f], [less, g]] = [&own, &other, &rolling].map(|set| depth(set, at));
        let apart = (here - there).abs() / libm::hypot(e, f);
        assert!(apart < 4.0, "condition {at}: {here} {there}, {apart} standard errors");
        let shallower = (there - less) / libm::hypot(f, g);
        assert!(shallower > 3.0, "condition {at}: {there} {less}, {shallower} standard errors");
    }
}
