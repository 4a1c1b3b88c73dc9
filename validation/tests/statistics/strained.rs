//! Effects so strong that a fit without them makes up for them by wrong masses, scales and speeds.

use diagnosis::diagnose::diagnose;
use diagnosis::fit::problem::{DEFAULT_SEED, FitProblem};
use diagnosis::observed::Observed;
use diagnosis::resistive::ResistiveForward;
use diagnosis::verdict::{Diagnosis, Verdict};
use measurements::{Condition, Frame, Instrument, MeasurementSet, Role, Run};
use rand_pcg::Pcg64;
use validation::benchmark::trial::baseline;

use crate::laboratory::Laboratory;
use crate::world::{Effect, GRAVITY, Setting};
use validation::benchmark::chance::normal;

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
    let problem = FitProblem { set, observed: &observed, forward: &forward };
    diagnose(&problem, DEFAULT_SEED).expect("spheres stop")
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

/// Diameter (m), mass (kg) and tangent of half the apex angle of a cone.
const CONE: [f64; 3] = [0.03, 0.08, 0.577_350_269_189_625_8];

/// Times (s) and depths (m) of its tip in a bed that resists the section in it alone, with coefficients of drag and friction.
fn cone(speed: f64, [drag, friction]: [f64; 2]) -> Vec<[f64; 2]> {
    const STEP: f64 = 1e-5;
    let [diameter, mass, tangent] = CONE;
    let force = |z: f64, v: f64| {
        let radius = (z * tangent).min(0.5 * diameter);
        let load = 1500.0 * std::f64::consts::PI * radius * radius;
        load * (drag * v * v + friction * GRAVITY * z)
    };
    let (mut path, mut z, mut v) = (vec![[0.0, 0.0]], 0.0, speed);
    while v > 0.0 {
        let half = v + 0.5 * STEP * (GRAVITY - force(z, v) / mass);
        z += STEP * half;
        v += STEP * (GRAVITY - force(z, half) / mass);
        path.push([STEP * path.len() as f64, z]);
    }
    path
}

/// Four drops of it from each of four heights, with depths that count from 3 mm below the surface.
fn cones(seed: u64) -> MeasurementSet {
    const TOO_DEEP: f64 = 3e-3;
    let (mut random, spare) = (Pcg64::new(seed.into(), 1), laboratory(Effect::Viscous, 0.0));
    let mut set = spare.measure(seed);
    let template =
        Condition { shape: "cone".into(), apex_deg: Some(60.0), ..set.conditions[0].clone() };
    (set.conditions, set.runs) = (Vec::new(), Vec::new());
    for height in [0.05_f64, 0.1, 0.2, 0.4] {
        let [diameter, mass, _] = CONE;
        let seen = (2.0 * GRAVITY * (height + TOO_DEEP)).sqrt();
        let own = Condition {
            id: format!("{height} m"),
            role: Role::Fit,
            angle_deg: 90.0,
            ..template.clone()
        };
        set.conditions.push(Condition { speed: seen, diameter, mass, ..own });
        for repeat in 0..4 {
            let factors = [0.6, 12.0].map(|mean| mean * libm::exp(0.02 * normal(&mut random)));
            let path = cone((2.0 * GRAVITY * height).sqrt(), factors);
            let contact = path.iter().find(|one| one[1] >= TOO_DEEP).map_or(0.0, |one| one[0]);
            let mut run = Run::new(format!("{height} {repeat}"), set.conditions.len() - 1);
            let from = path.iter().filter(|one| one[0] >= contact).step_by(100);
            run.frames = from
                .map(|[t, z]| {
                    let z = z - TOO_DEEP + 5e-5 * normal(&mut random);
                    Frame { t: t - contact, z, x: 0.0, sigma: None }
                })
                .collect();
            set.runs.push(run);
        }
    }
    set.instrument = Instrument {
        rate: Some(1000.0),
        position_sigma: Some(5e-5),
        speed_sigma_rel: Some(0.01),
        level_sigma: Some(1e-4),
        surface_sigma: Some(3e-3),
        ..Instrument::default()
    };
    set
}

#[test]
fn what_meets_the_section_of_a_cone_is_not_taken_for_a_deeper_surface() {
    for seed in 1..5 {
        let found = diagnosis(&cones(seed));
        assert_eq!(found.verdict, Verdict::Supported, "{seed}: {:?}", found.leaders);
        assert_eq!(found.leaders, ["immersion"], "{seed}");
    }
}
