//! Disks that are full, surroundings that differ, and files that mean harm.

use std::fs;
use std::path::{Path, PathBuf};

use crate::common::{Call, assert_same_run, folder, names, small_model};

/// Before a call: no file may grow beyond a few kilobytes, and who tries gets an error.
#[cfg(target_os = "linux")]
const FULL: &str = "trap '' XFSZ; ulimit -f 4";

fn measured() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../validation/data/s1-tables-vertical")
}

#[cfg(target_os = "linux")]
#[test]
fn a_bed_that_cannot_be_written_is_an_error_and_prepared_by_the_next_call() {
    let cache = folder();
    let call = || Call::new(["bed", "--json", "--cache"]).arg(cache.path()).arg(small_model());
    let message = call().after(FULL).fails(1);
    assert!(message.contains("cannot write") && message.contains("too large"), "{message}");
    assert_eq!(call().done().json()["cache"], "miss");
    assert_eq!(call().done().json()["cache"], "hit");
}

#[cfg(target_os = "linux")]
#[test]
fn an_export_that_cannot_be_written_leaves_nothing_and_is_written_by_the_next_call() {
    let out = folder();
    Call::run(out.path()).done();
    for format in ["csv", "parquet", "vtp", "lammps-dump", "extxyz"] {
        let call = || Call::new(["export", "--json", "--to", format]).arg(out.path());
        let message = call().after(FULL).fails(1);
        assert!(message.contains("cannot write") && message.contains("too large"), "{message}");
        assert!(!out.path().join(format).exists(), "{format}: tables that were small enough too");
        call().done();
    }
}

#[cfg(target_os = "linux")]
#[test]
fn results_that_cannot_be_written_are_written_by_the_same_command_again() {
    for command in ["compare", "diagnose"] {
        let parent = folder();
        let out = parent.path().join("out");
        let call = || Call::new([command, "--json", "--out"]).arg(&out).arg(measured());
        let message = call().after(FULL).fails(1);
        assert!(message.contains("cannot write"), "{message}");
        assert!(names(&out).is_empty(), "{:?}", names(&out));
        call().done();
        assert!(names(&out).contains(&"report.html".to_owned()), "{:?}", names(&out));
    }
}

#[cfg(unix)]
#[test]
fn neither_language_nor_time_zone_nor_home_changes_a_byte() {
    let parent = folder();
    let [here, elsewhere] = ["here", "elsewhere"].map(|name| parent.path().join(name));
    let short = |out: &Path| Call::run(out).set(&["run.duration=5 ms"]);
    short(&here).done();
    let abroad =
        "export LC_ALL=de_DE.UTF-8 LANG=tr_TR TZ=Asia/Kathmandu HOME=/nonexistent; umask 077";
    short(&elsewhere).after(abroad).done();
    assert_same_run(&here, &elsewhere);
}

#[test]
fn an_escape_in_a_file_does_not_reach_the_terminal() {
    let here = folder();
    let model = fs::read_to_string(small_model()).expect("a model");
    let hostile = model.replace("name = \"small-2d\"", "name = \"\\u001b]0;owned\\u0007\"");
    let path = here.path().join("model.toml");
    fs::write(&path, hostile).expect("a model");
    let message = Call::new(["check"]).arg(&path).fails(2);
    assert!(!message.contains(['\u{1b}', '\u{7}']), "{message:?}");

    Call::new(["new", "measurements"]).inside(here.path()).done();
    let set = here.path().join("measurements/measurement.toml");
    let text = fs::read_to_string(&set).expect("a set");
    let source = text.lines().find(|line| line.starts_with("source = ")).expect("a source");
    let hostile = text.replace(source, "source = \"\\u001b[2Jgone\"");
    fs::write(&set, hostile).expect("a set");
    let report = here.path().join("seen");
    let said = Call::new(["check", "--out"]).arg(&report).arg(&set).done();
    assert!(said.stdout.contains("gone") && !said.stdout.contains('\u{1b}'), "{:?}", said.stdout);
    let page = fs::read_to_string(report.join("report.html")).expect("a page");
    assert!(page.contains("gone") && !page.contains('\u{1b}'));
}

#[cfg(target_os = "linux")]
#[test]
fn results_that_find_no_room_leave_those_that_are_there() {
    let here = folder();
    let out = here.path().join("out");
    let compare = |settings: &[&str]| {
        let call = Call::new(["compare", "--quiet", "--force", "--out"]).arg(&out).arg(measured());
        call.set(settings)
    };
    compare(&[]).done();
    let read = || -> Vec<(String, Vec<u8>)> {
        let content = |name: String| {
            let bytes = fs::read(out.join(&name)).expect("a file");
            (name, bytes)
        };
        names(&out).into_iter().map(content).collect()
    };
    let before = read();
    // The page takes more than these 8 kB, in some shells 16; the first of the files take less.
    let message = compare(&["fit.free=[]"]).after("trap '' XFSZ; ulimit -f 16").fails(1);
    assert!(message.contains("cannot write"), "{message}");
    assert!(read() == before, "{:?}", names(&out));
    compare(&["fit.free=[]"]).done();
    assert!(read() != before);
}

#[test]
fn results_that_go_to_no_folder_are_bad_input() {
    let here = folder();
    let file = here.path().join("file");
    fs::write(&file, "mine").expect("a file");
    let long = here.path().join("x".repeat(300));
    for out in [&file, &file.join("below"), &long] {
        let message = Call::new(["compare", "--out"]).arg(out).arg(measured()).fails(2);
        assert!(message.contains("no folder") && !message.contains("blake3"), "{message}");
    }
    assert_eq!(fs::read_to_string(&file).expect("the file"), "mine");
}
