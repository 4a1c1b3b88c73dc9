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
    let known = ["set", "valid", "conditions", "runs", "fit", "holdout", "notes", "warnings"];
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
