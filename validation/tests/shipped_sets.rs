//! The sets in `validation/data`: all load, and their numbers are those of their sources.

use std::fs;
use std::path::{Path, PathBuf};

use configs::Color;
use measurements::{Loaded, MeasurementSet, Role, Run};

/// Tables are rounded to a millionth of a metre or second; half of that, and the last bits.
const ROUNDING: f64 = 0.5e-6 + 1e-12;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data")
}

fn load(name: &str) -> Loaded {
    MeasurementSet::load(&folder().join(name)).unwrap_or_else(|error| panic!("{error}"))
}

fn names() -> Vec<String> {
    let entries = fs::read_dir(folder()).expect("the folder is part of the repository");
    let mut names: Vec<String> = entries
        .map(|entry| entry.expect("a readable folder").file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

#[track_caller]
fn assert_near(found: Option<f64>, wanted: Option<f64>, tolerance: f64, what: &str) {
    let is_near = match (found, wanted) {
        (Some(found), Some(wanted)) => (found - wanted).abs() <= tolerance,
        (found, wanted) => found == wanted,
    };
    assert!(is_near, "{what}: {found:?} in the table, {wanted:?} by the law");
}

#[test]
fn every_set_loads_without_a_warning_and_says_its_source_and_its_errors() {
    let real = [
        "real-balls",
        "real-penetrometer",
        "real-plates-silt",
        "real-plates-simulant",
        "real-water-cones",
        "real-water-cones-acceleration",
    ];
    let printed = ["free-link", "katsuragi-durian", "s1-tables", "s1-tables-vertical"];
    let mut all = [&real[..], &printed[..]].concat();
    all.sort_unstable();
    assert_eq!(names(), all);
    for name in names() {
        let Loaded { set, warnings, sources, .. } = load(&name);
        let told: String = warnings.iter().map(|one| one.render(&sources, Color::Off)).collect();
        assert_eq!(told, "", "{name}");
        assert_eq!(set.id, name);
        assert!(set.source.is_some(), "{name}");
        assert!(set.baseline.is_some(), "{name}");
        if real.contains(&&*name) {
            // Drops that were repeated: their scatter tells the errors, and none was held out.
            assert!(set.runs.len() > set.conditions.len(), "{name}");
            continue;
        }
        let measured =
            |value: fn(&Run) -> Option<f64>| set.runs.iter().any(|run| value(run).is_some());
        let stated = &set.stated;
        assert_eq!(measured(|run| run.stop_time), stated.stop_time.is_some(), "{name}");
        assert_eq!(measured(|run| run.final_z), stated.final_z.is_some(), "{name}");
        // The vertical impacts state the error of the range that the oblique ones have.
        assert!(!measured(|run| run.final_x) || stated.final_x.is_some(), "{name}");
        assert!(set.conditions.iter().any(|condition| condition.role == Role::Holdout), "{name}");
    }
}

/// Slope (s) and intercept (m) of a way over the impact speed.
type Line = (f64, f64);

/// Angle (deg), range and depth: Wang, Ye and Zheng 2012, Table 1.
const PENETRATION: [(f64, Option<Line>, Line); 7] = [
    (5.0, Some((0.13553, -0.01677)), (0.0064, 0.08188)),
    (15.0, Some((0.09257, 0.00876)), (0.01193, 0.07595)),
    (30.0, Some((0.05877, 0.01848)), (0.01802, 0.07257)),
    (45.0, Some((0.04042, 0.01734)), (0.02309, 0.07007)),
    (60.0, Some((0.02581, 0.01289)), (0.02892, 0.06528)),
    (75.0, Some((0.01339, 0.00486)), (0.03112, 0.06472)),
    (90.0, None, (0.03079, 0.06613)),
];

/// The stopping time (s) at `angle` (deg) and `speed` (m/s): Table 2, which leaves 30 deg out.
fn stopping_time(angle: f64, speed: f64) -> Option<f64> {
    let (eta1, eta2, eta3) = match angle as u32 {
        5 => return Some(0.06193 * speed + 0.31617),
        15 => return Some(0.0217 * speed + 0.27803),
        45 => (0.17352, 1.16011, 0.19274),
        60 => (0.17091, 1.17882, 0.1865),
        75 => (0.17046, 1.18021, 0.17066),
        90 => (0.16083, 1.42537, 0.1591),
        _ => return None,
    };
    Some(eta1 * libm::exp(-eta2 * speed) + eta3)
}

#[test]
fn s1_tables_hold_the_published_laws() {
    let set = load("s1-tables").set;
    assert_eq!(set.runs.len(), 7 * 8);
    for run in &set.runs {
        let condition = &set.conditions[run.condition];
        let (angle, v) = (condition.angle_deg, condition.speed);
        let row = PENETRATION.iter().find(|row| (row.0 - angle).abs() < 1e-9);
        let (_, x, z) = row.expect("an angle of the table");
        let line = |(slope, intercept): Line| slope * v + intercept;
        assert_near(run.final_z, Some(line(*z)), ROUNDING, &condition.id);
        assert_near(run.final_x, x.map(line), ROUNDING, &condition.id);
        assert_near(run.stop_time, stopping_time(angle, v), ROUNDING, &condition.id);
        let held_out = [1.5, 3.5].iter().any(|speed| (speed - v).abs() < 1e-9);
        assert_eq!(condition.role == Role::Holdout, held_out, "{}", condition.id);
    }
}

#[test]
fn the_areal_density_of_s1_is_its_area_fraction_times_that_of_its_grains() {
    let grains = [(12_600.0, 4.9e-5, 0.00456_f64), (2_400.0, 9.7e-5, 0.00635)];
    let mass: f64 = grains.iter().map(|(n, mass, _)| n * mass).sum();
    let disc = |diameter: f64| std::f64::consts::FRAC_PI_4 * diameter * diameter;
    let area: f64 = grains.iter().map(|(n, _, diameter)| n * disc(*diameter)).sum();
    // Four decimals are written.
    assert_near(load("s1-tables").set.bed.bulk_density, Some(0.804 * mass / area), 0.5e-4, "bed");
}

#[test]
fn s1_tables_vertical_are_the_vertical_rows_of_s1_tables() {
    let (all, vertical) = (load("s1-tables").set, load("s1-tables-vertical").set);
    let (conditions, runs): (Vec<_>, Vec<_>) = all
        .runs
        .iter()
        .map(|run| (all.conditions[run.condition].clone(), run.clone()))
        .filter(|(condition, _)| condition.angle_deg > 89.0)
        .unzip();
    assert_eq!(vertical.conditions, conditions);
    let places = vertical.runs.iter().enumerate();
    let renumbered: Vec<Run> =
        places.zip(runs).map(|((condition, _), run)| Run { condition, ..run }).collect();
    assert_eq!(vertical.runs, renumbered);
    assert_eq!((vertical.bed, vertical.stated), (all.bed, all.stated));
    assert_eq!((vertical.stop, vertical.last), (all.stop, all.last));
}

#[test]
fn free_link_holds_the_nine_measured_times() {
    let set = load("free-link").set;
    let rows: Vec<(f64, f64, f64)> = set
        .runs
        .iter()
        .map(|run| {
            let condition = &set.conditions[run.condition];
            let angle = condition.link_angle_deg.expect("the inclination of the link");
            (angle, condition.speed, run.stop_time.expect("a measured time"))
        })
        .collect();
    // Marghitu and Lee 2013, Table 1: inclination (deg), speed (m/s), stopping time (s).
    let published = [
        (0.0, 1.53, 0.033),
        (0.0, 2.06, 0.029),
        (0.0, 2.47, 0.027),
        (32.0, 1.26, 0.027),
        (32.0, 1.87, 0.022),
        (32.0, 2.33, 0.020),
        (55.0, 1.45, 0.017),
        (55.0, 1.98, 0.015),
        (55.0, 2.43, 0.013),
    ];
    assert_eq!(rows, published);
    let link = &set.conditions[0];
    let (length, diameter) = (link.length.expect("a length"), link.diameter);
    let steel = 7800.0 * std::f64::consts::FRAC_PI_4 * diameter * diameter * length;
    // Four decimals are written.
    assert_near(Some(link.mass), Some(steel), 0.5e-4, "the assumed mass");
    // The last digit over the shortest time, to three decimals.
    assert_near(set.stated.stop_time, Some(0.001 / 0.013), 0.5e-3, "the stated error");
}

/// Depth (m) and stopping time (s) by dv/dt = g − (k/m) z − v²/d1.
fn two_term_law(speed: f64, d1: f64, k_over_m: f64) -> (f64, f64) {
    let acceleration = |z: f64, v: f64| 9.81 - k_over_m * z - v * v / d1;
    // Classical Runge-Kutta; its error at this step is far below the rounding of the tables.
    let h = 1e-5;
    let (mut z, mut v, mut t) = (0.0, speed, 0.0);
    loop {
        let (z1, v1) = (v, acceleration(z, v));
        let (z2, v2) = (v + 0.5 * h * v1, acceleration(z + 0.5 * h * z1, v + 0.5 * h * v1));
        let (z3, v3) = (v + 0.5 * h * v2, acceleration(z + 0.5 * h * z2, v + 0.5 * h * v2));
        let (z4, v4) = (v + h * v3, acceleration(z + h * z3, v + h * v3));
        let next = v + h / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4);
        if next <= 0.0 {
            // The deceleration is nearly constant within one step.
            let last = v / (v - next) * h;
            return (z + 0.5 * v * last, t + last);
        }
        z += h / 6.0 * (z1 + 2.0 * z2 + 2.0 * z3 + z4);
        v = next;
        t += h;
    }
}

#[test]
fn katsuragi_durian_holds_the_law_and_its_propagated_errors() {
    let set = load("katsuragi-durian").set;
    let (mut depth_error, mut time_error) = (0.0_f64, 0.0_f64);
    for run in &set.runs {
        let condition = &set.conditions[run.condition];
        let law = |d1, k_over_m| two_term_law(condition.speed, d1, k_over_m);
        let (depth, time) = law(0.087, 1040.0);
        assert_near(run.final_z, Some(depth), ROUNDING, &condition.id);
        assert_near(run.stop_time, Some(time), ROUNDING, &condition.id);
        let half = |a: (f64, f64), b: (f64, f64)| ((a.0 - b.0) / 2.0, (a.1 - b.1) / 2.0);
        let by_d1 = half(law(0.094, 1040.0), law(0.080, 1040.0));
        let by_k = half(law(0.087, 1050.0), law(0.087, 1030.0));
        depth_error = depth_error.max(libm::hypot(by_d1.0, by_k.0) / depth);
        time_error = time_error.max(libm::hypot(by_d1.1, by_k.1) / time);
    }
    // Rounded up to three decimals.
    assert_near(set.stated.final_z, Some(depth_error + 0.5e-3), 0.5e-3, "the error of the depth");
    assert_near(set.stated.stop_time, Some(time_error + 0.5e-3), 0.5e-3, "the error of the time");
}
