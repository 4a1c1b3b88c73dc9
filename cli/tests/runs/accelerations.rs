//! Sets of accelerations: checked, compared and drawn in m/s² over time, and refused with exit code 2 where a unit or
//! sign is wrong.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use crate::common::{Call, folder};

/// Spheres that a bed stops with a constant force, in g and ms with `columns` to say so.
fn write_set(folder: &Path, columns: &str) {
    let mut toml = format!(
        "schema = 1\n[measurement]\nid = \"felt\"\nkind = \"acceleration\"\n\
         [instrument]\nrate_hz = 2000\nacceleration_sigma_m_s2 = 0.3\n[bed]\nbulk_density = 1500\n\
         [model]\nbaseline = \"poncelet\"\n\
         [files]\nruns = \"runs.csv\"\naccelerations = \"felt.csv\"\n[columns]\n{columns}\n"
    );
    let mut runs = String::from("run,condition\n");
    let mut rows = String::from("run,t,acceleration\n");
    for speed in [1, 2, 3] {
        let _ = write!(
            toml,
            "[[condition]]\nid = \"v{speed}\"\nspeed = {speed}\nangle_deg = 90\nshape = \"sphere\"\n\
             diameter = \"25 mm\"\nmass = \"60 g\"\n"
        );
        for repeat in 0..4 {
            let _ = writeln!(runs, "v{speed}-{repeat},v{speed}");
            let felt = 50.0 * (1.0 + 0.01 * (f64::from(repeat) - 1.5));
            let stop = f64::from(speed) / (felt - 9.81);
            for reading in -8..=120 {
                let t = 0.5e-3 * f64::from(reading);
                let read = match t {
                    t if t <= 0.0 => 0.0,
                    t if t < stop => felt,
                    _ => 9.81,
                };
                // Multiples of the golden section spread evenly between 0 and 1.
                let spread =
                    (0.618_034 * f64::from(reading + 150 * repeat + 40 * speed)).rem_euclid(1.0);
                let g = (read + (spread - 0.5)) / 9.806_65;
                let _ = writeln!(rows, "v{speed}-{repeat},{:.2},{g:.5}", 1e3 * t);
            }
        }
    }
    for (name, text) in [("measurement.toml", toml), ("runs.csv", runs), ("felt.csv", rows)] {
        fs::write(folder.join(name), text).expect("a file");
    }
}

const UNITS: &str =
    "t = { name = \"t\", unit = \"ms\" }\nacceleration = { name = \"acceleration\", unit = \"g\" }";

#[test]
fn accelerations_in_g_are_checked_compared_and_drawn_in_si_over_time() {
    let here = folder();
    write_set(here.path(), UNITS);
    let ended = Call::new(["check", ".", "--out", "seen"]).inside(here.path()).done();
    for shown in ["felt: accelerations over time, 3 conditions", "a(t)", "acceleration over time"] {
        assert!(ended.stdout.contains(shown), "{shown}: {}", ended.stdout);
    }
    let page = fs::read_to_string(here.path().join("seen/report.html")).expect("a page");
    assert!(page.contains("acceleration (m/s²)") && page.contains("time (ms)"));

    Call::new(["compare", ".", "--out", "compared"]).inside(here.path()).done();
    let file =
        |name: &str| fs::read_to_string(here.path().join("compared").join(name)).expect("a file");
    let comparison: serde_json::Value =
        serde_json::from_str(&file("comparison.json")).expect("JSON");
    let model = &comparison["models"][0];
    let rms = model["rms"]["fit"]["acceleration_m_s2"].as_f64().expect("an error in m/s^2");
    // Readings off by up to 0.5 m/s², four of them in a mean.
    assert!(rms < 0.5, "{rms}");
    // 60 g at 50 m/s².
    let resistance = model["parameters"]["resistance.resistance"]["value"].as_f64();
    assert!((resistance.expect("a number") / 3.0 - 1.0).abs() < 0.02, "{resistance:?}");
    let residuals = file("residuals.csv");
    let head = "condition,observable,time_s,measured,predicted,standard_error,model";
    assert_eq!(residuals.lines().next(), Some(head));
    assert!(residuals.lines().skip(1).all(|line| line.contains(",acceleration_m_s2,")));
    for (name, label) in [
        ("trajectories.svg", "acceleration (m/s²)"),
        ("residuals.svg", "(m/s²)"),
        ("errors.svg", "acceleration over time (m/s²)"),
    ] {
        let drawn = file(name);
        assert!(drawn.contains(label), "{name} lacks {label}");
        assert!(!drawn.contains("mm)") && !drawn.contains("(N)"), "{name}");
    }
}

#[test]
fn a_wrong_sign_unit_or_zero_of_accelerations_is_refused_with_what_would_be_right() {
    let length = UNITS.replace("unit = \"g\"", "unit = \"mm\"");
    let turned = UNITS.replace("unit = \"g\"", "unit = \"g\", sign = -1");
    let shifted = UNITS.replace("unit = \"g\"", "unit = \"g\", zero = \"9.81 m/s^2\"");
    for (columns, messages) in [
        (length, ["an acceleration", "write unit = \"m/s^2\""]),
        (
            turned,
            [
                "the acceleration is negative where it is largest in 12 of 12 runs",
                "unit = \"g\", sign = 1 }",
            ],
        ),
        (shifted, ["those of a body in free fall are 0", "`zero` below [columns]"]),
    ] {
        let here = folder();
        write_set(here.path(), &columns);
        for command in ["check", "compare", "diagnose"] {
            let ended = Call::new([command, "."]).inside(here.path()).end();
            assert_eq!(ended.code, Some(2), "{command}: {ended:?}");
            for message in messages {
                assert!(ended.stderr.contains(message), "{command}, {message}: {}", ended.stderr);
            }
            assert!(!here.path().join("runs").exists(), "{command} wrote something");
        }
    }
}
