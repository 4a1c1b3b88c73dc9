//! A sphere that falls through a fluid into a bed under it.

use std::f64::consts::PI;

use diagnosis::verdict::Verdict;
use engine::fluid::Fluid;
use engine::math::Vec3;
use measurements::{Frame, Instrument, Kind, MeasurementSet, Run};
use rand_pcg::Pcg64;
use resistive::{Impact, Recorder, ResistanceLaw, Surroundings, Trajectory};

use super::rig::{BED, DIAMETER, MASS, launched, law};
use super::sets::{condition, diagnosed, of_spheres};
use validation::benchmark::chance::normal;

const WATER: Fluid = Fluid { density: 998.0, viscosity: 1.0e-3 };

/// At Reynolds numbers without end the drag coefficient is 0.63².
const THIN: Fluid = Fluid { density: 998.0, viscosity: 1e-18 };

const VOLUME: f64 = PI / 6.0 * DIAMETER * DIAMETER * DIAMETER;
const AREA: f64 = PI / 4.0 * DIAMETER * DIAMETER;

const DRAG: f64 = 1.2;
const FRICTION: f64 = 18.0;

/// Frames per second, and the error of a reading (m).
const RATE: f64 = 1000.0;
const READING: f64 = 1e-4;

/// Scatter of the coefficients from run to run, relative.
const COEFFICIENTS: f64 = 0.01;

/// A sphere that falls straight down at `speed` (m/s), under `fluid`.
fn sphere_in(fluid: Fluid, laws: Vec<Box<dyn ResistanceLaw>>, speed: f64) -> Impact {
    let bed = Surroundings { fluid: Some(fluid), ..BED };
    launched(bed, laws, Vec3::new(0.0, 0.0, -speed), 0.0)
}

#[test]
fn a_fall_has_the_closed_form_of_weight_buoyancy_added_mass_and_drag_before_contact_and_after() {
    let displaced = THIN.density * VOLUME;
    let weight = (MASS - displaced) * BED.gravity;
    let drag = 0.5 * THIN.density * 0.63 * 0.63 * AREA;
    let mass = MASS + 0.5 * displaced;
    let terminal = (weight / drag).sqrt();
    let rate = (weight * drag).sqrt() / mass;
    for speed in [0.2, 1.0] {
        let velocity = |t: f64| {
            let tanh = libm::tanh(rate * t);
            terminal * (speed + terminal * tanh) / (terminal + speed * tanh)
        };
        let depth = |t: f64| {
            let (sinh, cosh) = (libm::sinh(rate * t), libm::cosh(rate * t));
            mass / drag * libm::log(cosh + speed / terminal * sinh)
        };
        let times: Vec<f64> = (1..=30).map(|k| 0.01 * f64::from(k)).collect();
        let impact = sphere_in(THIN, Vec::new(), speed);
        let mut seen = Trajectory::at(&times);
        impact.run(0.31, &mut seen).expect("it sinks");
        let before = [-0.005, -0.01, -0.015];
        let flight = impact.flight(&before).expect("it has fallen");
        let all = times.iter().zip(seen.states()).chain(before.iter().zip(&flight));
        for (&t, state) in all {
            assert!((state.rate[1] + velocity(t)).abs() < 1e-8, "{speed} {t}: {}", state.rate[1]);
            assert!((state.position[1] + depth(t)).abs() < 1e-9, "{speed} {t}");
        }
    }
}

#[test]
fn the_ledger_closes_with_the_fluid_in_accounts_of_its_own() {
    let laws = vec![law("two-term-vector", &[("drag", DRAG), ("friction", FRICTION)])];
    let impact = sphere_in(WATER, laws, 2.0);
    let mut recorder = Recorder::new(&impact, 1e-3, |_| {});
    let ending = impact.run(10.0, &mut recorder).expect("an impact");
    assert!(ending.stopped);
    let ledger = recorder.ledger();
    let balance = ledger.balance();
    // The root of the speed in the drag costs digits where the body comes to rest.
    assert!(balance.worst / balance.initial.abs() < 1e-7, "{balance:?}");
    let value = |key: &str| ledger.value(key).unwrap_or_else(|| panic!("{key}"));
    let held = value("elastic_fluid_buoyancy_J");
    let expected = WATER.density * VOLUME * BED.gravity * ending.parts[0].depth;
    assert!((held / expected - 1.0).abs() < 1e-6, "{held} {expected}");
    assert!(value("elastic_fluid_added_mass_J").abs() < 1e-12);
    assert!(value("dissipated_fluid_drag_J") > 0.0);
}

/// Depths (m) at frames from 20 ms before contact until the sphere rests, by equations of motion and a step of 2 µs.
fn frames(speed: f64, random: &mut Pcg64) -> Vec<Frame> {
    let [drag, friction] = [DRAG, FRICTION].map(|of| of * (1.0 + COEFFICIENTS * normal(random)));
    let displaced = WATER.density * VOLUME;
    let acceleration = |z: f64, v: f64| {
        let reynolds = WATER.density * DIAMETER * v / WATER.viscosity;
        let coefficient = (0.63 + 4.8 / reynolds.sqrt()) * (0.63 + 4.8 / reynolds.sqrt());
        let of_fluid = 0.5 * WATER.density * coefficient * AREA * v * v;
        let of_bed = match z > 0.0 {
            true => BED.bulk_density * AREA * (drag * v * v + friction * BED.gravity * z),
            false => 0.0,
        };
        let weight = (MASS - displaced) * BED.gravity;
        (weight - of_fluid - of_bed) / (MASS + 0.5 * displaced)
    };
    let step: f64 = 2e-6;
    let every = (1.0 / (RATE * step)).round() as usize;
    let way = |step: f64, n: usize| {
        let (mut z, mut v, mut all) = (0.0, speed, vec![0.0]);
        for _ in 0..n {
            for _ in 0..every {
                let middle = v + 0.5 * step * acceleration(z, v);
                let at = z + 0.5 * step * v;
                if middle <= 0.0 {
                    break; // at rest to within a step
                }
                v = (v + step * acceleration(at, middle)).max(1e-9);
                z += step * middle;
            }
            all.push(z);
        }
        all
    };
    let (before, after) = (way(-step, 20), way(step, 150));
    let of = |k: f64, z: f64| (k / RATE, z);
    let before = before.iter().enumerate().skip(1).rev().map(|(k, &z)| of(-(k as f64), z));
    let after = after.iter().enumerate().map(|(k, &z)| of(k as f64, z));
    before
        .chain(after)
        .map(|(t, z)| Frame { t, z: z + READING * normal(random), x: 0.0, sigma: None })
        .collect()
}

fn measured(stated: Option<Fluid>) -> MeasurementSet {
    let mut random = Pcg64::new(7, 11);
    let speeds = [0.4, 0.7, 1.1, 1.6, 2.2];
    let places = (0..speeds.len()).flat_map(|at| (0..4).map(move |repeat| (at, repeat)));
    let runs = places.map(|(at, repeat)| Run {
        repeat: Some(repeat),
        frames: frames(speeds[at], &mut random),
        ..Run::new(format!("{at}-{repeat}"), at)
    });
    let instrument =
        Instrument { rate: Some(RATE), position_sigma: Some(READING), ..Instrument::default() };
    let mut set = MeasurementSet {
        runs: runs.collect(),
        ..of_spheres("under-water", (Kind::Trajectory, instrument), speeds.map(condition).into())
    };
    set.bed.stated.fluid = stated;
    set
}

#[test]
fn a_fluid_that_is_stated_is_no_missing_effect_and_the_coefficients_are_those_of_the_bed() {
    let found = diagnosed(&measured(Some(WATER)));
    assert_eq!(found.verdict, Verdict::NothingDetected, "{:?}", found.ranking.first());
    for (key, value) in [("drag", DRAG), ("friction", FRICTION)] {
        let of = &found.parameters[&format!("resistance.{key}")];
        let [fitted, se] = ["value", "se"].map(|part| of[part].as_f64().expect("a number"));
        // Four standard errors: chance takes one in fifteen thousand.
        assert!((fitted - value).abs() < 4.0 * se, "{key}: {fitted} ± {se}");
    }
}

#[test]
fn a_fluid_that_is_not_stated_is_missed() {
    let found = diagnosed(&measured(None));
    assert_ne!(found.verdict, Verdict::NothingDetected);
}

#[test]
fn a_fluid_in_a_set_is_written_and_read_back_and_the_zeros_are_found_in_it() {
    let set = measured(Some(WATER));
    let folder = tempfile::tempdir().expect("a folder");
    set.write(folder.path()).expect("files");
    let loaded = MeasurementSet::load(folder.path()).expect("a set");
    assert!(loaded.contradictions.is_empty(), "{:?}", loaded.contradictions);
    assert_eq!(MeasurementSet { notes: Vec::new(), ..loaded.set.clone() }, set);
    assert_eq!(loaded.agreement.zeros.offset, None);
}
