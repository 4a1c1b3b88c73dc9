//! Sets of several beds: what differs between them is a term of each but the first, and no physics.

use diagnosis::diagnose::diagnose;
use diagnosis::fit::problem::{DEFAULT_SEED, FitProblem};
use diagnosis::observed::Observed;
use diagnosis::resistive::ResistiveForward;
use diagnosis::verdict::{Diagnosis, Verdict};
use measurements::{Bed, MeasurementSet, NamedBed};
use validation::benchmark::trial::baseline;

use crate::laboratory::Laboratory;
use crate::world::Effect;

/// The second bed resists so many times as much as the density that is stated of it says.
const STRONGER: f64 = 1.2;

/// Every other condition is of the second bed, which `densities` (kg/m³) state.
fn in_two_beds(laboratory: &Laboratory, densities: [f64; 2]) -> MeasurementSet {
    let mut set = laboratory.measure(3);
    set.beds = [("sand", densities[0]), ("beads", densities[1])]
        .map(|(name, density)| NamedBed {
            name: name.to_owned(),
            bed: Bed { bulk_density: Some(density), ..set.bed },
        })
        .into();
    set.bed = set.beds[0].bed;
    for (at, condition) in set.conditions.iter_mut().enumerate() {
        condition.bed = Some(at % 2);
    }
    set
}

fn diagnosis(set: &MeasurementSet) -> Diagnosis {
    let model = baseline().expect("the shipped model loads");
    let observed = Observed::of(set);
    let forward = ResistiveForward::new(&model, set, &observed.layouts()).expect("it has spheres");
    diagnose(&FitProblem { set, observed: &observed, forward: &forward }, DEFAULT_SEED)
        .expect("spheres stop")
}

/// How much more the beads resist than the sand does, beside what densities say, by `coefficient`.
fn difference(found: &Diagnosis, coefficient: &str) -> f64 {
    let whose = format!("beads, {coefficient}");
    let one = found.apparatus.iter().find(|one| one.of.as_deref() == Some(&whose));
    one.unwrap_or_else(|| panic!("{whose}: {:?}", found.apparatus)).value
}

#[test]
fn a_bed_that_resists_more_than_its_density_says_is_no_physics() {
    let laboratory = Laboratory { tau_coefficient: 0.01, tau_path: 0.025, ..Laboratory::default() };
    let stated = in_two_beds(&laboratory, [1480.0, 1480.0]);
    let found = diagnosis(&stated);
    assert!(found.effects.is_empty(), "{:?}", found.effects);
    let light = in_two_beds(&laboratory, [1480.0, 1480.0 / STRONGER]);
    let also = diagnosis(&light);
    assert!(also.effects.is_empty(), "{:?}", also.effects);
    for coefficient in ["drag", "friction"] {
        assert!(difference(&found, coefficient).abs() < 0.03, "{coefficient}");
        let more = difference(&also, coefficient);
        assert!((more - libm::log(STRONGER)).abs() < 0.04, "{coefficient}: {more}");
    }
}

#[test]
fn an_effect_is_named_across_two_beds() {
    let laboratory = Laboratory::quiet(Effect::DepthExponent, 0.5);
    let found = diagnosis(&in_two_beds(&laboratory, [1480.0, 1480.0 / STRONGER]));
    assert_eq!(found.verdict, Verdict::Supported);
    assert_eq!(found.leaders, [Effect::DepthExponent.id()]);
    let strength = found.ranking[0].q.expect("it was fitted");
    assert!((strength / 0.5 - 1.0).abs() < 0.2, "{strength}");
}
