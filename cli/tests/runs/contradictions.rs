//! Sets that contradict their own frames: named as such, exit code 2, nothing is fitted.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use crate::common::{Call, folder};

/// A set of spheres that a bed stops at constant deceleration, at 1000 frames per second and with readings
/// good to 0.05 mm, whose tables read `clock` ms at first contact and `surface` mm at the surface; `more` stands in
/// `[measurement]`.
fn write_set(folder: &Path, (clock, surface): (f64, f64), more: &str) {
    let mut toml = format!(
        "schema = 1\n[measurement]\nid = \"drops\"\nkind = \"trajectory\"\n{more}\n[instrument]\n\
         rate_hz = 1000\nposition_sigma_m = 5e-5\nspeed_sigma_rel = 0.01\nlevel_sigma_m = 1e-4\n\
         [bed]\nbulk_density = 1480\n[model]\nbaseline = \"two-term-vector\"\n\
         [files]\nruns = \"runs.csv\"\ntrajectories = \"trajectories.csv\"\n\
         [columns]\nt = {{ name = \"ms\", unit = \"ms\" }}\nz = {{ name = \"mm\", unit = \"mm\" }}\n"
    );
    let mut runs = String::from("run,condition,stop_time,final_z\n");
    let mut rows = String::from("run,ms,mm,x\n");
    for (at, speed) in [0.8_f64, 1.4, 2.0, 2.6].into_iter().enumerate() {
        let role = if at == 3 { "holdout" } else { "fit" };
        let _ = write!(
            toml,
            "[[condition]]\nid = \"c{at}\"\nrole = \"{role}\"\nspeed = {speed}\nangle_deg = 90\n\
             shape = \"sphere\"\ndiameter = 0.0254\nmass = 0.0667\n"
        );
        for repeat in 0..3 {
            // It stops sooner or later by 4 %, as beds differ.
            let stop = 0.08 * (1.0 + 0.04 * f64::from(repeat - 1));
            let end = 0.5 * speed * stop;
            let _ = writeln!(runs, "c{at}-{repeat},c{at},{stop:.5},{end:.5}");
            for frame in -12..=110 {
                let t = f64::from(frame) * 1e-3;
                let z = match t {
                    t if t < 0.0 => speed * t + 0.5 * 9.81 * t * t,
                    t if t < stop => speed * t - 0.5 * speed / stop * t * t,
                    _ => end,
                };
                // Multiples of the golden section spread evenly between 0 and 1.
                let spread = (0.618_034 * f64::from(frame + 150 * repeat) + speed).fract();
                let noise = 0.05 * (2.0 * spread - 1.0);
                let (ms, mm) = (1e3 * t + clock, 1e3 * z + surface + noise);
                let _ = writeln!(rows, "c{at}-{repeat},{ms:.3},{mm:.3},0");
            }
        }
    }
    for (name, text) in [("measurement.toml", toml), ("runs.csv", runs), ("trajectories.csv", rows)]
    {
        fs::write(folder.join(name), text).expect("a file");
    }
}

const STATED: &str = "stop_definition = \"component-zero\"\nfinal = \"resting\"";

/// Messages of `check`, `compare` and `diagnose`, which all end with 2; the last two write nothing.
fn refused(here: &Path) -> [String; 3] {
    ["check", "compare", "diagnose"].map(|command| {
        let ended = Call::new([command, "."]).inside(here).end();
        assert_eq!(ended.code, Some(2), "{command}: {ended:?}");
        assert!(!ended.stderr.contains("panicked"), "{ended:?}");
        assert!(!here.join("runs").exists(), "{command} wrote something");
        assert_eq!(ended.stdout.is_empty(), command != "check", "{command}: {}", ended.stdout);
        ended.stderr
    })
}

#[test]
fn a_sound_set_is_checked_with_what_its_frames_say() {
    let here = folder();
    write_set(here.path(), (0.0, 0.0), STATED);
    let ended = Call::new(["check", "."]).inside(here.path()).done();
    assert_eq!(ended.stderr, "");
    for wanted in [
        "depth of free fall at t = 0: ",
        "stopping times against the trajectories (12 runs): they follow `component-zero`",
        "stated",
    ] {
        assert!(ended.stdout.contains(wanted), "{wanted}: {}", ended.stdout);
    }
    let object = Call::new(["check", ".", "--json"]).inside(here.path()).done().json();
    assert_eq!(object["valid"], true);
    assert!(object["zeros"]["offset"].is_null());
    assert_eq!(object["zeros"]["runs"].as_array().map(Vec::len), Some(12));
    assert_eq!(object["scalars"][0]["number"], "stop_time");
    assert_eq!(object["scalars"][0]["follows"], "component-zero");
    let misses = object["scalars"][0]["definitions"].as_array().expect("two definitions");
    // The last twentieth of a constant deceleration of 80 ms takes 4 ms.
    let other = misses[1]["off_by"].as_f64().expect("a miss");
    assert!((other - 0.004).abs() < 5e-4, "{object}");
}

#[test]
fn a_clip_that_counts_from_elsewhere_is_refused_with_the_lines_that_mend_it() {
    let here = folder();
    write_set(here.path(), (31.0, 120.0), STATED);
    let messages = refused(here.path());
    for message in &messages {
        assert!(
            message.contains("t = 0 is not first contact, and z = 0 not the surface"),
            "{message}"
        );
    }
    for message in &messages {
        assert!(message.contains("--trust-zeros goes on all the same"), "{message}");
    }
    // What the message says is written, is right, and is enough.
    let lines: Vec<String> = ["t", "z"]
        .map(|key| {
            let start = messages[0].rfind(&format!("{key} = {{ name")).expect("a line to write");
            let line = &messages[0][start..];
            line[..=line.find('}').expect("its end")].to_owned()
        })
        .into();
    let path = here.path().join("measurement.toml");
    let text = fs::read_to_string(&path).expect("the set");
    let (head, rest) = text.split_once("[columns]\n").expect("columns");
    let (_, conditions) = rest.split_once("[[condition]]").expect("conditions");
    let mended = format!("{head}[columns]\n{}\n[[condition]]{conditions}", lines.join("\n"));
    fs::write(&path, mended).expect("the set");
    let zero = |line: &str| {
        let text = line.split("zero = \"").nth(1).and_then(|rest| rest.split(' ').next());
        text.and_then(|number| number.parse::<f64>().ok()).expect("a zero")
    };
    assert!(
        (zero(&lines[0]) - 31.0).abs() < 0.5 && (zero(&lines[1]) - 120.0).abs() < 1.0,
        "{lines:?}"
    );
    let ended = Call::new(["check", "."]).inside(here.path()).done();
    assert_eq!(ended.stderr, "");
}

#[test]
fn a_zero_of_five_millimetres_is_named_and_can_be_overruled() {
    let here = folder();
    write_set(here.path(), (0.0, 5.0), STATED);
    for message in refused(here.path()) {
        assert!(message.starts_with("error: z = 0 is not the surface"), "{message}");
        assert!(message.contains("at z = 5.0") || message.contains("at z = 4.9"), "{message}");
        assert!(message.contains("z = { name = \"mm\", unit = \"mm\", zero = \""), "{message}");
    }
    let object = Call::new(["check", ".", "--json"]).inside(here.path()).end();
    assert_eq!(object.code, Some(2));
    assert_eq!(object.json()["zeros"]["offset"]["zero"], "depth");
    let ended = Call::new(["compare", ".", "--trust-zeros", "--json"]).inside(here.path()).done();
    assert!(ended.stderr.contains("z = 0 is not the surface"), "{}", ended.stderr);
    Call::new(["compare", ".", "--trust-scalars"]).inside(here.path()).fails(2);
}

#[test]
fn stopping_times_of_another_definition_are_named_with_the_key_to_write() {
    let here = folder();
    write_set(here.path(), (0.0, 0.0), "final = \"resting\"");
    for message in refused(here.path()) {
        for wanted in [
            "the stopping times follow `component-zero`, not `speed-5-percent`",
            "stop_definition is not stated; \"speed-5-percent\" is assumed",
            "write stop_definition = \"component-zero\" below [measurement]",
        ] {
            assert!(message.contains(wanted), "{wanted}: {message}");
        }
    }
    let ended = Call::new(["compare", ".", "--trust-scalars"]).inside(here.path()).done();
    assert!(ended.stderr.contains("not `speed-5-percent`"), "{}", ended.stderr);
    write_set(
        here.path(),
        (0.0, 0.0),
        "stop_definition = \"speed-5-percent\"\nfinal = \"resting\"",
    );
    let message = Call::new(["diagnose", "."]).inside(here.path()).fails(2);
    assert!(message.contains("stated here"), "{message}");
}

#[test]
fn a_wrong_sign_and_a_wrong_unit_are_named() {
    let here = folder();
    write_set(here.path(), (0.0, 0.0), STATED);
    let path = here.path().join("measurement.toml");
    let text = fs::read_to_string(&path).expect("the set");
    let unit = "z = { name = \"mm\", unit = \"mm\" }";
    for (changed, named) in [
        ("z = { name = \"mm\", unit = \"mm\", sign = -1 }", "is z counted upwards?"),
        ("z = { name = \"mm\", unit = \"cm\" }", "×10 (mm for cm)"),
        ("z = { name = \"mm\", unit = \"m\" }", "×1000 (mm for m)"),
        ("z = { name = \"mm\", unit = \"inch\" }", "×25.4 (mm for inches)"),
    ] {
        fs::write(&path, text.replace(unit, changed)).expect("the set");
        for command in ["check", "compare", "diagnose"] {
            let ended = Call::new([command, "."]).inside(here.path()).end();
            assert_eq!(ended.code, Some(2), "{command} {changed}: {ended:?}");
            assert!(ended.stderr.contains(named), "{command} {changed}: {}", ended.stderr);
        }
    }
    assert!(!here.path().join("runs").exists());
}

#[test]
fn runs_that_count_from_their_own_zeros_say_so_in_the_table_of_runs() {
    let here = folder();
    write_set(here.path(), (31.0, 120.0), STATED);
    let path = here.path().join("runs.csv");
    let text = fs::read_to_string(&path).expect("the runs");
    let shifted: String = text
        .lines()
        .map(|line| match line.starts_with("run,") {
            true => format!("{line},t_zero,z_zero\n"),
            // In the units of t and z.
            false => format!("{line},31.0,120.0\n"),
        })
        .collect();
    fs::write(&path, shifted).expect("the runs");
    let ended = Call::new(["check", "."]).inside(here.path()).done();
    assert_eq!(ended.stderr, "");
}

#[test]
fn the_template_agrees_with_itself() {
    let here = folder();
    Call::new(["new", "measurements"]).inside(here.path()).done();
    let ended = Call::new(["check", "measurements"]).inside(here.path()).done();
    assert_eq!(ended.stderr, "");
}
