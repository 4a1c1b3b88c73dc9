//! What scripts rely on: exit codes, clean streams, nothing overwritten.

use std::path::Path;
use std::process::{Command, Output, Stdio};

fn plunge(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_plunge"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("the program starts")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("UTF-8")
}

#[test]
fn a_new_model_checks_and_is_never_overwritten() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    assert_eq!(plunge(folder, &["new", "my-sand", "--from", "rolling-2d"]).status.code(), Some(0));
    let written = std::fs::read_to_string(folder.join("my-sand.toml")).expect("the model");
    assert!(written.contains("name = \"my-sand\""));
    let again = plunge(folder, &["new", "my-sand"]);
    assert_eq!(again.status.code(), Some(2));
    assert!(text(&again.stderr).contains("exists already"));
    assert_eq!(std::fs::read_to_string(folder.join("my-sand.toml")).expect("the model"), written);
    assert_eq!(std::fs::read_dir(folder).expect("the folder").count(), 1, "no draft stays");
    let check = plunge(folder, &["check", "my-sand.toml"]);
    assert_eq!(check.status.code(), Some(0));
    assert_eq!(text(&check.stderr), "");
    for name in ["../x", "", "Sand", "a/b", "."] {
        assert_eq!(plunge(folder, &["new", name]).status.code(), Some(2), "{name}");
    }
}

#[test]
fn a_new_model_with_the_name_of_a_shipped_one_starts_from_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let new = plunge(folder.path(), &["new", "hemisphere-3d"]);
    assert!(text(&new.stdout).contains("from hemisphere-3d"), "{}", text(&new.stdout));
    let written = std::fs::read_to_string(folder.path().join("hemisphere-3d.toml"));
    assert!(written.expect("the model").contains("shape = \"hemisphere\""));
}

#[test]
fn bad_input_is_status_2_with_a_message_on_stderr_and_nothing_on_stdout() {
    let folder = tempfile::tempdir().expect("a folder");
    for arguments in [
        &["check", "vertical-2d", "--set", "impact.speed=3 kg"][..],
        &["check", "no-such-model", "--json"],
        &["check", "."],
        &["effects", "no-such-effect"],
        &["new", "x", "--from", "no-such-model"],
        &["no-such-command"],
        &[],
    ] {
        let output = plunge(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert_eq!(text(&output.stdout), "", "{arguments:?}");
        assert!(!output.stderr.is_empty(), "{arguments:?}");
        assert!(!text(&output.stderr).contains("panicked"), "{arguments:?}");
    }
}

#[test]
fn json_is_one_object() {
    let folder = tempfile::tempdir().expect("a folder");
    for arguments in [
        &["check", "vertical-2d", "--json", "--set", "impact.speed=150 m/s"][..],
        &["effects", "--json"],
        &["effects", "rolling-resistance", "--json"],
        &["effects", "grain-friction", "--json"],
        &["new", "--list", "--json"],
        &["new", "x", "--json"],
    ] {
        let output = plunge(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}");
        let value: serde_json::Value =
            serde_json::from_slice(&output.stdout).expect("one JSON value");
        assert!(value.is_object(), "{arguments:?}");
    }
}

#[test]
fn a_bed_that_no_machine_holds_is_refused_unless_forced() {
    let folder = tempfile::tempdir().expect("a folder");
    let sets = ["--set", "bed.grains.0.count=1000000000000", "--set", "container.width=\"1e8 m\""];
    let check = ["check", "vertical-2d", "--quiet"];
    let refused = plunge(folder.path(), &[&check[..], &sets].concat());
    if configs::estimate::available_memory_bytes().is_some() {
        assert_eq!(refused.status.code(), Some(2));
        assert!(text(&refused.stderr).contains("--force"));
    }
    let forced = plunge(folder.path(), &[&check[..], &["--force"], &sets].concat());
    assert_eq!(forced.status.code(), Some(0));
}

#[test]
fn a_reader_that_leaves_is_no_error() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_plunge"))
        .args(["check", "vertical-2d"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("the program ends");
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(text(&output.stderr), "");
}
