//! Effects so strong that a fit without them makes up for them by wrong masses, scales and speeds.

use diagnosis::bench::{Bench, DEFAULT_SEED};
use diagnosis::diagnose::diagnose;
use diagnosis::observed::Observed;
use diagnosis::resistive::ResistiveForward;
use diagnosis::verdict::{Diagnosis, Verdict};
use measurements::MeasurementSet;
use validation::benchmark::trial::baseline;

use crate::laboratory::Laboratory;
use crate::world::{Effect, Setting};

/// Four bodies at four speeds and three angles.
fn laboratory(effect: Effect, amplitude: f64) -> Laboratory {
    let bodies = [(0.0667, 0.0254), (0.0220, 0.0254), (0.0327, 0.0200), (0.1300, 0.0400)];
    let speeds = [0.6, 1.4, 2.4, 3.6];
    let settings = speeds.iter().enumerate().flat_map(|(row, &speed)| {
        let angles = [90.0, 60.0, 35.0].into_iter().enumerate();
        angles.map(move |(column, angle)| {
            let (mass, diameter) = bodies[(row + column) % bodies.len()];
            Setting { speed, angle, mass, diameter }
        })
    });
    Laboratory { settings: settings.collect(), ..Laboratory::quiet(effect, amplitude) }
}

fn diagnosis(set: &MeasurementSet) -> Diagnosis {
    let model = baseline().expect("the shipped model loads");
    let observed = Observed::of(set);
    let forward = ResistiveForward::new(&model, set, &observed.layouts()).expect("it has spheres");
    let bench = Bench { set, observed: &observed, forward: &forward };
    diagnose(&bench, DEFAULT_SEED).expect("spheres stop")
}

#[test]
fn a_strong_effect_is_not_taken_for_wrong_masses_scales_and_speeds() {
    for (effect, q) in [(Effect::DepthExponent, 1.0), (Effect::Viscous, 4.0)] {
        let mut set = laboratory(effect, q).measure(1);
        let stated = set.conditions[0].mass;
        let one_body = |mass: f64| mass.total_cmp(&stated).is_eq();
        for condition in set.conditions.iter_mut().filter(|one| one_body(one.mass)) {
            condition.mass *= 1.05;
        }
        let found = diagnosis(&set);
        assert_eq!(found.verdict, Verdict::Supported, "{effect:?}");
        assert_eq!(found.leaders, [effect.id()]);
        let strength = found.ranking[0].q.expect("it was fitted");
        assert!((strength / q - 1.0).abs() < 0.1, "{effect:?}: {strength}");
    }
}
