//! The keys of `summary.json`, and that its energies add up.

use serde_json::Value;

use crate::common::{Call, folder};

/// What a documented key holds.
#[derive(Clone, Copy, Debug)]
enum Kind {
    Text,
    Number,
    /// A number, or null where it was not reached.
    Reached,
    Count,
    Truth,
}

use Kind::{Count, Number, Reached, Text, Truth};

const KEYS: [(&str, Kind); 42] = [
    ("/name", Text),
    ("/version", Text),
    ("/model_hash", Text),
    ("/medium", Text),
    ("/impact/speed_m_per_s", Number),
    ("/impact/angle_deg", Number),
    ("/impact/x_m", Number),
    ("/impact/position_index", Count),
    ("/stop/stopped", Truth),
    ("/stop/stopping_time_s", Reached),
    ("/stop/stopping_time_z_s", Reached),
    ("/stop/stopping_time_x_s", Reached),
    ("/stop/rest_time_s", Reached),
    ("/stop/depth_m", Number),
    ("/stop/range_m", Number),
    ("/energy/initial_J", Number),
    ("/energy/final/intruder_J", Number),
    ("/energy/final/grains_J", Number),
    ("/energy/final/elastic_J", Number),
    ("/energy/dissipated_J/normal_damping", Number),
    ("/energy/dissipated_J/tangential_damping", Number),
    ("/energy/dissipated_J/sliding", Number),
    ("/energy/dissipated_J/walls", Number),
    ("/energy/released_J", Number),
    ("/energy/unaccounted_J", Number),
    ("/energy/closure", Number),
    ("/bed/grains", Count),
    ("/bed/packing_fraction", Number),
    ("/bed/packing_fraction_inside", Reached),
    ("/bed/height_m", Number),
    ("/bed/coordination", Number),
    ("/bed/cache", Text),
    ("/bed/required_depth_m", Number),
    ("/bed/activity/largest_moving_share", Number),
    ("/bed/activity/largest_kinetic_energy_J", Number),
    ("/bed/activity/peak_time_s", Number),
    ("/bed/activity/dissipation_time_s", Reached),
    ("/cost/steps", Count),
    ("/cost/dt_s", Number),
    ("/cost/threads", Count),
    ("/cost/wall_s", Number),
    ("/cost/grain_steps_per_s", Number),
];

fn holds(kind: Kind, value: &Value) -> bool {
    match kind {
        Text => value.as_str().is_some_and(|text| !text.is_empty()),
        Number => value.is_number(),
        Reached => value.is_number() || value.is_null(),
        Count => value.is_u64(),
        Truth => value.is_boolean(),
    }
}

fn leaves(value: &Value, path: &str, found: &mut Vec<String>) {
    match value.as_object() {
        Some(object) => {
            object.iter().for_each(|(key, value)| leaves(value, &format!("{path}/{key}"), found));
        }
        None => found.push(path.to_owned()),
    }
}

#[test]
fn every_key_is_there_with_its_type_and_no_other() {
    let out = folder();
    let summary = Call::run(out.path()).set(&["run.duration=1 s"]).done().json();
    for (key, kind) in &KEYS {
        let value = summary.pointer(key).unwrap_or_else(|| panic!("{key} is missing"));
        assert!(holds(*kind, value), "{key} is {value}, not {kind:?}");
    }
    let mut found = Vec::new();
    leaves(&summary, "", &mut found);
    for key in found {
        assert!(KEYS.iter().any(|(known, _)| *known == key), "{key} is not documented");
    }
    let number =
        |key| summary.pointer(key).and_then(Value::as_f64).unwrap_or_else(|| panic!("{key}"));
    assert_eq!(summary["stop"]["stopped"], true);
    assert_eq!(number("/stop/stopping_time_x_s").to_bits(), 0.0_f64.to_bits());
    assert_eq!(
        number("/stop/stopping_time_s").to_bits(),
        number("/stop/stopping_time_z_s").to_bits()
    );
    // ½ m v² of 6.5 g at 1 m/s; a centimetre or more deep in a bed of seven.
    assert!((number("/energy/initial_J") - 3.25e-3).abs() < 1e-17);
    assert!((0.01..0.07).contains(&number("/stop/depth_m")));
    assert!(number("/cost/steps") * number("/cost/dt_s") < 1.0, "it ends at rest");
}

#[test]
fn initial_energy_is_final_and_dissipated_less_unaccounted_to_round_off() {
    for settings in [&["impact.speed=2 m/s"][..], &["impact.angle=45 deg", "impact.spin=20 rad/s"]]
    {
        let out = folder();
        let summary =
            Call::run(out.path()).set(settings).set(&["run.duration=20 ms"]).done().json();
        let energy = &summary["energy"];
        let values = |value: &Value| -> Vec<f64> {
            let object = value.as_object().expect("an object");
            object.values().map(|value| value.as_f64().expect("a number")).collect()
        };
        let (held, lost) = (values(&energy["final"]), values(&energy["dissipated_J"]));
        let [initial, unaccounted, closure] = ["initial_J", "unaccounted_J", "closure"]
            .map(|key| energy[key].as_f64().expect("a number"));
        let sum = held.iter().chain(&lost).sum::<f64>() - unaccounted;
        // The ledger's sums go over potential energies, which count from the bottom: their size is
        // that of the bed, 17 g at 4 cm, not of the impact. Twenty terms, twice.
        let bound = 40.0 * f64::EPSILON * (0.017 * 9.81 * 0.04 + initial);
        assert!((sum - initial).abs() <= bound, "{sum} is not {initial} by {}", sum - initial);
        assert!(lost.iter().all(|value| *value >= 0.0), "{energy}");
        // What is missing at the end may be the most that ever was: a quotient times its divisor.
        let most = closure * initial * (1.0 + 2.0 * f64::EPSILON);
        assert!(unaccounted.abs() <= most && closure < 1e-2, "{energy}");
    }
}

#[test]
fn an_angle_comes_out_as_it_was_written() {
    for angle in ["30 deg", "45 deg", "60.7 deg", "90 deg"] {
        let out = folder();
        let call = Call::run(out.path()).set(&[&format!("impact.angle={angle}")]);
        let summary = call.set(&["run.duration=100 us"]).done().json();
        assert_eq!(format!("{} deg", summary["impact"]["angle_deg"]).replace(".0 ", " "), angle);
    }
}

#[test]
fn the_text_names_everything_and_aligns_it() {
    let out = folder();
    let call =
        Call::new(["run", "--out"]).arg(out.path()).arg("--cache").arg(crate::common::cache());
    let text = call.arg(crate::common::small_model()).done().stdout;
    for name in ["stopping time", "depth", "range", "bed", "energy", "normal-damping", "closure"] {
        assert!(text.lines().any(|line| line.trim_start().starts_with(name)), "{name}: {text}");
    }
    // Where energy is in the end stands below what was supplied.
    let shares = || {
        text.lines()
            .filter(|line| line.starts_with("    "))
            .filter_map(|line| line.split_once(" %"))
    };
    let ends: Vec<usize> = shares().map(|(before, _)| before.len()).collect();
    assert!(ends.len() >= 6 && ends.iter().all(|end| *end == ends[0]), "{text}");
    let percent =
        |before: &str| before.split_whitespace().last().and_then(|word| word.parse().ok());
    let sum: f64 = shares().map(|(before, _)| percent(before).unwrap_or(f64::NAN)).sum();
    // Each is rounded to a hundredth.
    assert!((sum - 100.0).abs() <= 0.005 * ends.len() as f64, "{sum} % in all: {text}");
}
