//! `plunge check` of measurement sets.

use std::fs;
use std::path::{Path, PathBuf};

use crate::common::{Call, folder};

fn shipped(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../validation/data").join(name)
}

#[test]
fn a_shipped_set_is_described_by_its_folder_and_by_its_file() {
    let set = shipped("katsuragi-durian");
    let text = Call::new(["check"]).arg(&set).done().stdout;
    assert!(text.starts_with("katsuragi-durian: ") && text.contains("speed (m/s)"), "{text}");
    assert_eq!(Call::new(["check"]).arg(set.join("measurement.toml")).done().stdout, text);
    let object = Call::new(["check", "--json"]).arg(&set).done().json();
    let keys: Vec<&String> = object.as_object().expect("an object").keys().collect();
    let known = [
        "set",
        "valid",
        "conditions",
        "runs",
        "fit",
        "holdout",
        "notes",
        "warnings",
        "zeros",
        "scalars",
        "contradictions",
    ];
    assert_eq!(keys, known);
    assert_eq!(object["set"], "katsuragi-durian");
    assert_eq!(object["valid"], true);
    let [all, fit, holdout] = ["conditions", "fit", "holdout"].map(|key| object[key].as_u64());
    assert_eq!(all, fit.zip(holdout).map(|(fit, holdout)| fit + holdout));
    let head = format!("{} conditions", object["conditions"]);
    assert!(text.contains(&head), "{head}: {text}");
}

#[test]
fn a_set_by_another_name_is_known_by_its_table() {
    let here = folder();
    let set = shipped("katsuragi-durian");
    fs::copy(set.join("runs.csv"), here.path().join("runs.csv")).expect("a table");
    let path = here.path().join("mine.toml");
    fs::copy(set.join("measurement.toml"), &path).expect("a set");
    let object = Call::new(["check", "--json"]).arg(&path).done().json();
    assert_eq!(object["set"], "katsuragi-durian");
    assert!(Call::new(["check"]).arg(&path).set(&["id=2"]).fails(2).contains("--set"));
}

#[test]
fn a_new_set_is_drawn_compared_and_not_written_over() {
    let here = folder();
    let call = |arguments: &[&str]| Call::new(arguments).inside(here.path());
    let written = call(&["new", "measurements", "--json"]).done().json();
    assert_eq!(written["files"][0], "measurement.toml");
    assert!(call(&["new", "measurements"]).fails(2).contains("exists already"));
    let text = call(&["check", "measurements", "--out", "seen"]).done().stdout;
    // Twelve runs with their paths, which end at the height of a full block.
    assert_eq!(
        text.lines().filter(|line| line.contains('█') && line.contains(" mm in ")).count(),
        12
    );
    let page = fs::read_to_string(here.path().join("seen/report.html")).expect("a page");
    assert!(page.matches("</title></").count() > 150, "every reading says its value");
    assert!(call(&["check", "measurements", "--out", "seen"]).fails(2).contains("--force"));
    let found = call(&["compare", "measurements", "--json"]).done().json();
    // Coefficients were drawn to 5 % around those of another sphere, readings to 0.1 mm.
    let error = found["models"][0]["rms"]["fit"]["z_m"].as_f64().expect("an error");
    assert!(error < 1e-3, "{found}");
    let report = here.path().join("runs/my-drops-compare/report.html");
    let report = fs::read_to_string(report).expect("a report");
    assert!(report.contains("Measured along the path"), "trajectories are drawn");
}

#[test]
fn a_bad_set_is_bad_input_with_the_place() {
    let here = folder();
    let text = fs::read_to_string(shipped("katsuragi-durian").join("measurement.toml"));
    let text = text.expect("a set").replace("speed", "sped");
    fs::write(here.path().join("measurement.toml"), text).expect("a set");
    let message = Call::new(["check"]).arg(here.path()).fails(2);
    assert!(message.contains("measurement.toml:") && message.contains("sped"), "{message}");
    assert_eq!(Call::new(["check", "--json"]).arg(here.path()).fails(2), message);
    fs::write(here.path().join("measurement.toml"), "[measurement\n").expect("a file");
    Call::new(["check"]).arg(here.path()).fails(2);
}
