//! Commands within another program say what the program says, take models that are in no file, and can be stopped.

use std::ffi::OsString;
use std::path::Path;
use std::process::{Command, Output};
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

use plunge::{Failure, Host, bed, call, run_many};
use serde_json::Value;

fn words(words: &[&str]) -> Vec<OsString> {
    words.iter().map(OsString::from).collect()
}

fn within(host: Host, line: &[&str]) -> Result<String, Failure> {
    call(&Arc::new(host), &words(line))
}

fn program(line: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_plunge")).args(line).output().expect("the program starts")
}

/// What of a summary follows from the model.
fn results(printed: &[u8]) -> Value {
    let mut summary: Value = serde_json::from_slice(printed).expect("JSON");
    let cost = summary.as_object_mut().and_then(|summary| summary.remove("cost"));
    assert!(cost.is_some_and(|cost| cost["wall_s"].is_number()));
    summary
}

fn shown(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

#[test]
fn a_run_has_the_same_files_and_prints_the_same_as_the_program() {
    let folder = tempfile::tempdir().expect("a folder");
    let [here, there] = ["here", "there"].map(|name| folder.path().join(name));
    let line =
        |out| ["run", "two-term-vector", "--set", "impact.speed=\"2 m/s\"", "--json", "--out", out];
    let printed = within(Host::default(), &line(shown(&here))).expect("a run");
    let ended = program(&line(shown(&there)));
    assert!(ended.status.success());
    assert_eq!(results(printed.as_bytes()), results(&ended.stdout));
    for name in ["run.mcap", "model.toml"] {
        let [a, b] = [&here, &there].map(|run| std::fs::read(run.join(name)).expect("a file"));
        assert!(a == b, "{name}");
    }
}

#[test]
fn errors_have_the_words_and_the_status_of_the_program() {
    let long = "9".repeat(400);
    for line in [
        vec!["run", "two-term-vector", "--set", "impact.sped=3"],
        vec!["run", "vertikal-2d"],
        vec!["run", "two-term-vector", "--threads", "1000"],
        vec!["compare", "two-term-vector"],
        vec!["bed", "two-term-vector"],
        vec!["recover", &long, "x"],
        vec!["fly"],
    ] {
        let Failure { status, message } = within(Host::default(), &line).expect_err("a refusal");
        let ended = program(&line);
        assert_eq!(ended.status.code(), Some(i32::from(status)), "{line:?}");
        assert_eq!(message, String::from_utf8_lossy(&ended.stderr), "{line:?}");
        assert!(!message.is_empty() && ended.stdout.is_empty(), "{line:?}");
    }
}

#[test]
fn a_model_of_the_host_is_read_by_its_name_and_refused_at_its_lines() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = configs::find_shipped("two-term-vector").expect("it ships").text;
    let with = |text: &str| Host::new(vec![("<mine>".to_owned(), text.to_owned())]);
    let out = folder.path().join("run");
    let printed = within(with(text), &["run", "<mine>", "--json", "--out", shown(&out)]);
    let other = folder.path().join("other");
    let ended = program(&["run", "two-term-vector", "--json", "--out", shown(&other)]);
    assert_eq!(results(printed.expect("a run").as_bytes()), results(&ended.stdout));
    let wrong = text.replace("[impact]\n", "[impact]\nsped = 3\n");
    let failure = within(with(&wrong), &["run", "<mine>"]).expect_err("a wrong key");
    assert_eq!(failure.status, 2);
    let line = wrong.lines().position(|line| line == "sped = 3").expect("the line") + 1;
    assert!(failure.message.contains(&format!("<mine>:{line}:1")), "{}", failure.message);
}

#[test]
fn progress_goes_to_the_host_and_it_can_stop() {
    let folder = tempfile::tempdir().expect("a folder");
    let host = Arc::new(Host::default());
    let line = words(&["bed", "vertical-2d", "--cache", shown(folder.path()), "--threads", "1"]);
    let (ended, after) = thread::scope(|scope| {
        let calling = scope.spawn(|| call(&host, &line));
        let start = Instant::now();
        while host.progress().is_none() {
            assert!(start.elapsed() < Duration::from_secs(60), "it never says how far it is");
            thread::sleep(Duration::from_millis(5));
        }
        host.stop();
        let asked = Instant::now();
        (calling.join().expect("no panic"), asked.elapsed())
    });
    let failure = ended.expect_err("it was stopped");
    assert!(failure.message.contains("stopped"), "{failure}");
    assert!(after < Duration::from_secs(6), "{after:?}");
    let progress = host.progress().expect("progress");
    assert!(progress.words.starts_with("bed settling, ") && progress.share.is_none());
}

#[test]
fn many_side_by_side_are_as_each_alone_and_none_begins_where_one_is_wrong() {
    let folder = tempfile::tempdir().expect("a folder");
    let small =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../configs/schema/tests/good/small-2d.toml");
    let [many, cache] = ["many", "cache"].map(|name| folder.path().join(name));
    let line = |out: &Path| words(&[shown(&small), "--cache", shown(&cache), "--out", shown(out)]);
    let speed = |speed: f64| vec![format!("impact.speed=\"{speed} m/s\"")];
    let speeds = [0.5, 0.75, 1.0];
    let run = |variants: &[Vec<String>]| {
        let line = [line(&many), words(&["--threads", "2"])].concat();
        run_many(&Arc::new(Host::default()), &line, variants)
    };
    let wrong = run(&[speed(0.5), vec!["impact.sped=1".to_owned()]]).expect_err("a wrong key");
    assert!(wrong.status == 2 && wrong.message.contains("impact.sped"), "{wrong}");
    assert!(!many.exists());
    let (printed, grains) =
        bed(&Arc::default(), &words(&[shown(&small), "--json", "--cache", shown(&cache)]))
            .expect("a bed");
    let printed: Value = serde_json::from_str(&printed).expect("JSON");
    assert_eq!(printed["grains"].as_u64(), Some(grains.len() as u64));
    let summaries = run(&speeds.map(speed)).expect("three runs");
    assert_eq!(summaries.len(), 3);
    for (at, (summary, speed)) in summaries.iter().zip(speeds).enumerate() {
        let alone = folder.path().join(format!("alone-{at}"));
        let set = format!("impact.speed=\"{speed} m/s\"");
        let rest = words(&["--threads", "1", "--json", "--set", &set]);
        let line = [words(&["run"]), line(&alone), rest].concat();
        let printed = call(&Arc::new(Host::default()), &line).expect("a run");
        assert_eq!(results(summary.to_string().as_bytes()), results(printed.as_bytes()));
        let logs = [many.join(format!("00{}", at + 1)), alone];
        let [a, b] = logs.map(|run| std::fs::read(run.join("run.mcap")).expect("a log"));
        assert!(a == b, "{speed} m/s");
    }
}
