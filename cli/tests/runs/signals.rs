//! The first signal ends any command within 2 s, in whatever it is at, and says how to go on; what it leaves is in
//! nobody's way.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Child;
use std::thread::sleep;
use std::time::{Duration, Instant};

use tempfile::TempDir;

use crate::common::{Call, Ended, folder, names, signal, small_model};
use crate::ignored::is_ignored;

/// Longest time from a signal to the end: two seconds are promised on a machine that does nothing else, and other tests
/// write long logs meanwhile.
const ALLOWED: Duration = Duration::from_secs(6);

/// What every command has in common that keeps nothing.
const AGAIN: &str = "the same command begins again";

/// What one has in common that keeps something.
const GOES_ON: &str = "the same command goes on";

/// Waits until `child` has its handler of SIGTERM: before, a signal ends any program, and says nothing.
fn wait_until_it_listens(child: &mut Child) {
    const SIGTERM: u32 = 15;
    let status = format!("/proc/{}/status", child.id());
    let start = Instant::now();
    loop {
        let text = fs::read_to_string(&status).unwrap_or_default();
        let mask = text.lines().find_map(|line| line.strip_prefix("SigCgt:"));
        let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0);
        if mask >> (SIGTERM - 1) & 1 == 1 {
            return;
        }
        assert!(child.try_wait().expect("its state").is_none(), "it has ended");
        assert!(start.elapsed() < Duration::from_secs(60), "it never listens");
        std::thread::yield_now(); // a sleep would miss the moment at which it begins to listen
    }
}

/// Ends `call`, which takes far longer, `after` it began to listen; gives what it said.
fn ended_by(name: &str, call: Call, after: Duration) -> String {
    let mut child = call.start();
    wait_until_it_listens(&mut child);
    sleep(after);
    assert!(child.try_wait().expect("its state").is_none(), "it was done before a signal came");
    let sent = Instant::now();
    signal(&child, name);
    let Ended { code, stdout, stderr } = Ended::of(child);
    assert!(sent.elapsed() < ALLOWED, "it took {:?}", sent.elapsed());
    assert_eq!(code, Some(if name == "INT" { 130 } else { 143 }), "{stderr}");
    assert_eq!(stdout, "");
    assert!(stderr.contains("stopped by a signal"), "{stderr}");
    stderr
}

/// Ends the call that `make` makes at two moments, by two signals.
fn ends_at_once(make: impl Fn() -> Call, says: &str) {
    for (name, after) in [("TERM", 0), ("INT", 250)] {
        if name == "INT" && is_ignored(2) {
            continue; // then commands ignore it too
        }
        let said = ended_by(name, make(), Duration::from_millis(after));
        assert!(said.contains(says), "{said}");
    }
}

/// A folder with a run whose logs hold what they hold so many times over, as if nobody had ended them.
fn long_run(times: usize) -> TempDir {
    let out = folder();
    Call::run(out.path()).done();
    for name in ["run.mcap", "grains.mcap"] {
        let path = out.path().join(name);
        let whole = fs::read(&path).expect("a log");
        let data = data_of(&whole);
        let mut text = whole[..8].to_vec();
        (0..times).for_each(|_| text.extend_from_slice(data));
        fs::write(&path, text).expect("a log");
    }
    out
}

/// The records of a log behind its mark, up to the end of the data.
fn data_of(log: &[u8]) -> &[u8] {
    const DATA_END: u8 = 0x0f;
    let mut at = 8;
    while log[at] != DATA_END {
        let length = log[at + 1..at + 9].try_into().expect("eight bytes");
        at += 9 + usize::try_from(u64::from_le_bytes(length)).expect("a length");
    }
    &log[8..at]
}

/// A bed that takes minutes to settle.
fn large_bed(call: Call) -> Call {
    call.arg(small_model()).set(&["bed.grains.0.count=20000", "container.width=1 m"])
}

fn shipped(set: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../validation/data").join(set)
}

#[test]
fn a_stopped_export_leaves_nothing_and_the_same_command_writes_it() {
    let run = long_run(600);
    for format in ["csv", "vtp", "extxyz"] {
        let out = run.path().join(format);
        let export = || Call::new(["export", "--to", format, "--quiet"]).arg(run.path());
        ends_at_once(export, AGAIN);
        assert!(!out.exists(), "{format}: {:?}", names(&out));
    }
    // What a kill leaves is in nobody's way either.
    let short = folder();
    Call::run(short.path()).done();
    let out = short.path().join("csv");
    fs::create_dir_all(out.join(".partial")).expect("a folder");
    fs::write(out.join(".partial/energy_budget.csv.partial"), "cut").expect("a file");
    Call::new(["export", "--to", "csv"]).arg(short.path()).done();
    assert!(names(&out).iter().all(|name| !name.contains("partial")), "{:?}", names(&out));
}

#[test]
fn a_stopped_recovery_leaves_nothing() {
    let run = long_run(300);
    let saved = run.path().join("saved.mcap");
    let before = names(run.path());
    ends_at_once(|| Call::new(["recover"]).arg(run.path().join("run.mcap")).arg(&saved), AGAIN);
    assert_eq!(names(run.path()), before);
}

#[test]
fn reports_and_comparisons_of_runs_end_at_once() {
    let run = long_run(300);
    let before = names(run.path());
    ends_at_once(|| Call::new(["report"]).arg(run.path()), AGAIN);
    let out = run.path().join("both");
    let compare = || Call::new(["compare"]).arg(run.path()).arg(run.path()).arg("--out").arg(&out);
    ends_at_once(compare, GOES_ON);
    // A report that was there was made again whole or not at all.
    assert_eq!(names(run.path()), before);
}

#[test]
fn beds_and_measurements_of_their_pace_end_at_once() {
    let cache = folder();
    let with = |command: &str| Call::new([command, "--quiet", "--cache"]).arg(cache.path());
    ends_at_once(|| large_bed(with("bed")), GOES_ON);
    ends_at_once(|| large_bed(with("check").arg("--measure")), AGAIN);
    let out = cache.path().join("run");
    ends_at_once(|| large_bed(with("run").arg("--force").arg("--out").arg(&out)), "--resume");
}

#[test]
fn comparisons_and_diagnoses_on_beds_end_at_once() {
    let here = folder();
    let set = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/runs/two-impacts");
    for command in ["compare", "diagnose"] {
        let call = || {
            let call = Call::new([command, "--quiet", "--model"]).arg(small_model());
            let call = call.arg("--cache").arg(here.path().join(command)).arg("--out");
            call.arg(here.path().join("out")).set(&["bed.grains.0.count=3000"]).arg(&set)
        };
        ends_at_once(call, GOES_ON);
        assert!(!here.path().join("out").exists());
    }
}

#[test]
fn comparisons_and_diagnoses_of_resistive_models_end_at_once_and_write_nothing() {
    let here = folder();
    let out = here.path().join("out");
    for command in ["compare", "diagnose"] {
        let call = || Call::new([command, "--quiet", "--out"]).arg(&out).arg(shipped("s1-tables"));
        ends_at_once(call, GOES_ON);
        assert!(!out.exists());
    }
}

#[test]
fn campaigns_end_at_once_while_their_beds_settle() {
    let here = folder();
    let file = here.path().join("campaign.toml");
    let text = "\
[campaign]
name = \"large-beds\"
models = [\"small-2d.toml\"]

[set]
bed.grains.0.count = 20000
container.width = \"1 m\"

[product]
impact.speed = [\"1 m/s\", \"2 m/s\"]
";
    fs::write(&file, text).expect("a campaign");
    fs::copy(small_model(), here.path().join("small-2d.toml")).expect("a model");
    let out = here.path().join("out");
    let sweep = || Call::new(["sweep", "--quiet", "--out"]).arg(&out).arg(&file);
    ends_at_once(sweep, GOES_ON);
}
