//! `plunge compare` of two runs: the numbers follow from the runs, and nothing else passes for one.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;
use tempfile::TempDir;

use crate::common::{Call, folder, names, summary};

/// A run of two-term-vector with `settings`, in the folder `name` of `here`.
fn run(here: &TempDir, name: &str, settings: &[&str]) -> PathBuf {
    let out = here.path().join(name);
    Call::new(["run", "--json", "--out"]).arg(&out).arg("two-term-vector").set(settings).done();
    out
}

fn compare(first: &Path, second: &Path) -> Call {
    Call::new(["compare", "--json"]).arg(first).arg(second)
}

fn number(value: &Value, key: &str) -> f64 {
    value.pointer(key).and_then(Value::as_f64).unwrap_or_else(|| panic!("{key} in {value}"))
}

#[test]
fn runs_at_two_speeds_differ_by_what_their_summaries_say() {
    let here = folder();
    let (slow, fast) =
        (run(&here, "slow", &["impact.speed=1 m/s"]), run(&here, "fast", &["impact.speed=2 m/s"]));
    let found = compare(&slow, &fast).inside(here.path()).done().json();
    assert_eq!(found["runs"], serde_json::json!([slow, fast]));
    let stops = [&slow, &fast].map(|folder| summary(folder)["stop"].clone());
    for key in ["stopping_time_s", "depth_m", "range_m", "rest_time_s"] {
        let [first, second] = stops.each_ref().map(|stop| &stop[key]);
        let change = &found["stop"][key];
        assert_eq!([&change["values"][0], &change["values"][1]], [first, second], "{key}");
        if let (Some(first), Some(second)) = (first.as_f64(), second.as_f64()) {
            let apart = second - first;
            assert_eq!(number(change, "/difference").to_bits(), apart.to_bits(), "{key}");
            match first {
                0.0 => assert!(change["relative"].is_null()),
                _ => assert_eq!(number(change, "/relative").to_bits(), (apart / first).to_bits()),
            }
        }
    }
    // Drag takes more from the faster one, so that they are never as far apart again as at first.
    assert!((number(&found, "/largest/speed_m_per_s") - 1.0).abs() < 1e-12, "{found}");
    assert!(number(&found, "/largest/at_s/speed_m_per_s").abs() < 1e-12);
    assert!(number(&found, "/rms/speed_m_per_s") < 1.0);
    // Both are vertical, and the faster one gets ahead as long as it is the faster one.
    assert!(number(&found, "/largest/x_m").abs() < 1e-12);
    let ahead = number(&found, "/largest/z_m");
    assert!(ahead > 0.0 && ahead < number(&stops[1], "/depth_m"));
    assert!((0.2 * ahead..ahead).contains(&number(&found, "/rms/z_m")), "{found}");
    let ends = stops.map(|stop| number(&stop, "/stopping_time_s"));
    // The last sample is that of the stop.
    assert!((number(&found, "/common/to_s") - ends[0].min(ends[1])).abs() < 1e-9);
    for (index, folder) in [&slow, &fast].into_iter().enumerate() {
        let (energy, summary) = (&found["energy"], summary(folder));
        for (channel, lost) in summary["energy"]["dissipated_J"].as_object().expect("channels") {
            assert_eq!(energy["dissipated_J"][channel][index], *lost, "{channel}");
        }
        assert_eq!(energy["closure"][index], summary["energy"]["closure"]);
    }
    assert_eq!(names(here.path()), ["fast", "slow"], "nothing is written without --out");
}

#[test]
fn a_run_is_at_no_distance_from_itself() {
    let here = folder();
    let out = run(&here, "one", &[]);
    let found = compare(&out, &out).done().json();
    for part in ["rms", "largest"] {
        for key in ["z_m", "x_m", "speed_m_per_s"] {
            assert_eq!(number(&found[part], &format!("/{key}")).to_bits(), 0, "{part} {key}");
        }
    }
    assert_eq!(number(&found, "/stop/depth_m/difference").to_bits(), 0);
}

#[test]
fn how_often_a_run_was_logged_does_not_count() {
    let here = folder();
    let fine = run(&here, "fine", &["log.interval=0.1 ms"]);
    let coarse = run(&here, "coarse", &["log.interval=0.7 ms"]);
    for (first, second) in [(&fine, &coarse), (&coarse, &fine)] {
        let found = compare(first, second).done().json();
        // An eighth of what drag and friction brake, less than 100 m/s², over 0.1 ms.
        assert!(number(&found, "/largest/z_m").abs() < 1.3e-7, "{found}");
    }
}

#[test]
fn with_out_the_same_object_is_written_and_not_over_another() {
    let here = folder();
    let (one, other) = (run(&here, "one", &[]), run(&here, "other", &["impact.speed=1 m/s"]));
    let out = here.path().join("out");
    let printed = compare(&one, &other).arg("--out").arg(&out).done().stdout;
    assert_eq!(fs::read_to_string(out.join("comparison.json")).expect("a file"), printed);
    compare(&one, &other).arg("--out").arg(&out).done();
    assert!(compare(&other, &one).arg("--out").arg(&out).fails(2).contains("other inputs"));
    let text = Call::new(["compare"]).arg(&one).arg(&other).done().stdout;
    for part in ["two-term-vector", "z (mm)", "stopping time", "closure", "nothing was written"] {
        assert!(text.contains(part), "{part}: {text}");
    }
}

#[test]
fn a_list_of_conditions_is_refused_with_the_folders_that_can_be_given() {
    let here = folder();
    let one = run(&here, "one", &[]);
    let list = run(&here, "list", &[r#"conditions.speed=["1 m/s", "2 m/s"]"#]);
    for (first, second) in [(&list, &one), (&one, &list)] {
        let message = compare(first, second).fails(2);
        for name in ["001", "002"] {
            let run = list.join(name).display().to_string();
            assert!(message.contains(&run), "{message}");
        }
    }
    compare(&list.join("001"), &one).done();
}

#[test]
fn what_does_not_go_together_is_bad_input() {
    let here = folder();
    let one = run(&here, "one", &[]);
    let set = Path::new(env!("CARGO_MANIFEST_DIR")).join("../validation/data/katsuragi-durian");
    let compare = || Call::new(["compare"]);
    assert!(compare().arg(&one).fails(2).contains("RUN_B"));
    assert!(compare().arg(&set).arg(&one).fails(2).contains("no run"));
    assert!(compare().arg(&one).arg(&set).fails(2).contains("no folder of a run"));
    let with_model = || compare().arg(&one).arg(&one).arg("--model").arg("poncelet");
    assert!(with_model().fails(2).contains("--model"));
    assert!(compare().arg(&one).arg(&one).set(&["impact.speed=1 m/s"]).fails(2).contains("--set"));
    assert!(compare().arg(one.join("grains.mcap")).arg(&one).fails(2).contains("grains.mcap"));
    fs::remove_file(one.join("summary.json")).expect("a summary");
    assert!(compare().arg(&one).arg(&one).fails(2).contains("not finished"));
}

#[test]
fn what_is_no_log_beside_a_summary_is_bad_input() {
    let here = folder();
    let (one, bad) = (run(&here, "one", &[]), run(&here, "bad", &[]));
    fs::write(bad.join("run.mcap"), "no log at all").expect("a file");
    assert!(compare(&one, &bad).fails(2).contains("not an MCAP file"));
}

#[test]
fn a_log_that_was_cut_is_compared_as_far_as_it_goes_with_a_note() {
    let here = folder();
    // Enough samples for several chunks of a megabyte.
    let (one, cut) = (run(&here, "one", &[]), run(&here, "cut", &["log.interval=2 us"]));
    let log = cut.join("run.mcap");
    let bytes = fs::read(&log).expect("a log");
    fs::write(&log, &bytes[..bytes.len() / 2]).expect("a log");
    let ended = compare(&one, &cut).done();
    assert!(ended.stderr.contains("is cut"), "{}", ended.stderr);
    let (found, stop) = (ended.json(), number(&summary(&one), "/stop/stopping_time_s"));
    assert!((0.1 * stop..0.6 * stop).contains(&number(&found, "/common/to_s")), "{found}");
    // As for logs of different intervals.
    assert!(number(&found, "/largest/z_m").abs() < 1.3e-7, "{found}");
}
