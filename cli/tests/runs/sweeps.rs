//! `plunge sweep`: a plan that never changes, every point once, and results at any time.

use std::fs;
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::{Duration, SystemTime};

use serde_json::Value;
use tempfile::TempDir;

#[cfg(unix)]
use crate::common::program;
use crate::common::{Call, cache, folder, names, small_model};

/// Impacts on a law: milliseconds each.
const LAW: &str = "\
[campaign]
name = \"speeds\"
models = [\"two-term-vector\", \"poncelet\"]
seeds = [1, 2]

[product]
impact.speed = [\"1 m/s\", \"2 m/s\", \"3 m/s\"]
";

/// Impacts on grains: two speeds and two limits of the closure, of which one is never kept.
const GRAINS: &str = "\
[campaign]
name = \"limits\"
models = [\"small-2d.toml\"]

[set]
run.duration = \"60 ms\"
run.checkpoint_every = 200

[product]
impact.speed = [\"0.5 m/s\", \"1 m/s\", \"1.5 m/s\"]
energy.abort_above = [1e-9, 0.05]
";

/// A folder with a campaign, and the small model beside it.
fn campaign(text: &str) -> (TempDir, PathBuf) {
    let here = folder();
    let file = here.path().join("campaign.toml");
    fs::write(&file, text).expect("a file");
    fs::copy(small_model(), here.path().join("small-2d.toml")).expect("a model");
    (here, file)
}

fn sweep(file: &Path, out: &Path) -> Call {
    Call::new(["sweep", "--json", "--cache"]).arg(cache()).arg("--out").arg(out).arg(file)
}

fn json(path: &Path) -> Value {
    let text = fs::read_to_string(path).unwrap_or_else(|error| panic!("{path:?}: {error}"));
    serde_json::from_str(&text).expect("JSON")
}

/// When every point was done, by its hash.
fn ends(out: &Path) -> Vec<(String, SystemTime)> {
    let points = out.join("points");
    let end = |name: String| {
        let written = fs::metadata(points.join(&name).join("done.json")).ok()?.modified();
        Some((name, written.expect("a time")))
    };
    if points.exists() { names(&points).into_iter().filter_map(end).collect() } else { Vec::new() }
}

/// What came of every point, without what it cost.
fn outcomes(out: &Path) -> Vec<Value> {
    let points = names(&out.join("points")).into_iter();
    points
        .map(|name| {
            let mut done = json(&out.join("points").join(name).join("done.json"));
            done.as_object_mut().expect("an object").remove("cost");
            done
        })
        .collect()
}

#[test]
fn a_campaign_ends_in_a_table_and_a_report_and_does_nothing_twice() {
    let (here, file) = campaign(LAW);
    let out = here.path().join("out");
    let told = sweep(&file, &out).done().json();
    assert_eq!([&told["points"], &told["done"], &told["failed"]], [12, 12, 0]);
    let plan = json(&out.join("points.json"));
    assert_eq!(plan["points"].as_array().expect("points").len(), 12);
    assert_eq!(
        plan["points"][3]["set"],
        serde_json::json!(["impact.speed=\"1 m/s\"", "run.seed=2"])
    );
    let first = ends(&out);
    assert_eq!(first.len(), 12, "a seed is part of a model, also of one without chance");
    let files = |name: &str| fs::read(out.join(name)).expect("a file");
    let kept = ["points.json", "results.parquet", "report.html"].map(files);
    assert!(!out.join("points").join(&first[0].0).join("run.mcap").exists(), "no logs are kept");
    assert_eq!(sweep(&file, &out).done().json(), told);
    assert_eq!(ends(&out), first, "nothing is run again");
    let again = ["points.json", "results.parquet", "report.html"].map(files);
    assert!(kept == again, "the same bytes");
    let page = String::from_utf8(kept[2].clone()).expect("UTF-8");
    assert!(page.contains("12 points, all of them done") && page.contains("impact.speed (m/s)"));
}

#[test]
fn the_numbers_of_a_point_are_those_of_the_same_run_alone() {
    let (here, file) = campaign(GRAINS);
    let out = here.path().join("out");
    let told = sweep(&file, &out).arg("--threads").arg("2").done().json();
    assert_eq!([&told["points"], &told["done"], &told["failed"]], [6, 3, 3]);
    let why = told["failures"][0]["error"].as_str().expect("a reason");
    assert!(why.contains("unaccounted for"), "{why}");
    let plan = json(&out.join("points.json"));
    let point = &plan["points"][1];
    let set: Vec<&str> =
        point["set"].as_array().expect("settings").iter().filter_map(Value::as_str).collect();
    let alone = here.path().join("alone");
    let summary = Call::run(&alone).set(&set).done().json();
    let hash = point["hash"].as_str().expect("a hash");
    let done = json(&out.join("points").join(hash).join("done.json"));
    for key in ["depth_m", "range_m", "stopping_time_s"] {
        assert_eq!(done["headline"][key], summary["stop"][key], "{key}");
    }
    assert_eq!(done["headline"]["dissipated_J"], summary["energy"]["dissipated_J"]);
}

#[test]
fn killed_again_and_again_a_campaign_does_every_point_exactly_once() {
    let (here, file) = campaign(GRAINS);
    let (whole, cut) = (here.path().join("whole"), here.path().join("cut"));
    sweep(&file, &whole).done();
    let (mut kills, mut seen) = (0, Vec::new());
    for pause in [120, 90, 200, 60, 250, 150] {
        let mut child = sweep(&file, &cut).start();
        sleep(Duration::from_millis(pause));
        child.kill().expect("it can be killed");
        kills += usize::from(!child.wait().expect("it has ended").success());
        let now = ends(&cut);
        assert!(seen.iter().all(|end| now.contains(end)), "a point that was done is done again");
        seen = now;
    }
    assert!(kills > 0, "it was killed on the way");
    sweep(&file, &cut).done();
    let last = ends(&cut);
    assert!(seen.iter().all(|end| last.contains(end)), "a point that was done is done again");
    assert_eq!(outcomes(&cut), outcomes(&whole));
    for name in ["points.json", "results.parquet", "report.html"] {
        let [a, b] = [&whole, &cut].map(|out| fs::read(out.join(name)).expect("a file"));
        assert!(a == b, "{name} differs");
    }
}

#[test]
fn a_campaign_that_is_half_done_is_reported_and_goes_on() {
    let (here, file) = campaign(LAW);
    let out = here.path().join("out");
    sweep(&file, &out).done();
    let all = ends(&out);
    for (hash, _) in &all[..5] {
        fs::remove_dir_all(out.join("points").join(hash)).expect("a point");
    }
    fs::remove_file(out.join("points").join(&all[5].0).join("done.json")).expect("a point");
    let status = sweep(&file, &out).arg("--status").done().json();
    assert_eq!([&status["done"], &status["begun"], &status["waiting"]], [6, 1, 5]);
    Call::new(["report"]).arg(&out).done();
    let page = fs::read_to_string(out.join("report.html")).expect("a page");
    assert!(page.contains("6 of 12 points so far"));
    assert_eq!(sweep(&file, &out).done().json()["done"], 12);
    let now = ends(&out);
    assert!(all[6..].iter().all(|end| now.contains(end)), "what was done is not done again");
}

#[test]
fn a_plan_is_said_without_running_and_never_changed() {
    let (here, file) = campaign(LAW);
    let out = here.path().join("out");
    let plan = sweep(&file, &out).arg("--plan").done().json();
    assert_eq!([&plan["points"], &plan["to_run"], &plan["beds"]], [12, 12, 0]);
    assert!(!out.exists(), "nothing is written");
    sweep(&file, &out).done();
    let kept = fs::read(out.join("points.json")).expect("a plan");
    fs::write(&file, LAW.replace("3 m/s", "4 m/s")).expect("a file");
    let message = sweep(&file, &out).fails(2);
    assert!(message.contains("the plan of another campaign"), "{message}");
    // A task does its point as the plan has it, whatever has become of the others.
    sweep(&file, &out).arg("--point").arg("3").done();
    fs::write(&file, LAW.replace("\"two-term-vector\", ", "")).expect("a file");
    let message = sweep(&file, &out).arg("--point").arg("3").fails(2);
    assert!(message.contains("the plan of another campaign"), "{message}");
    fs::write(&file, LAW).expect("a file");
    let message = sweep(&file, &out).arg("--point").arg("13").fails(2);
    assert!(message.contains("the points 1 to 12, not 13"), "{message}");
    assert_eq!(fs::read(out.join("points.json")).expect("a plan"), kept);
    assert!(sweep(&file, here.path()).fails(2).contains("choose another --out"));
}

#[test]
fn a_budget_that_is_spent_leaves_a_campaign_to_go_on_with() {
    let (here, file) = campaign(GRAINS);
    let out = here.path().join("out");
    let told =
        sweep(&file, &out).arg("--budget").arg("1 ms").arg("--threads").arg("1").done().json();
    assert!(told["waiting"].as_u64() > Some(0), "{told}");
    assert!(out.join("report.html").exists() && out.join("results.parquet").exists());
    // This budget overflows the clock.
    let told = sweep(&file, &out).arg("--budget").arg("1e300 s").done().json();
    assert_eq!(told["waiting"], 0);
}

#[test]
fn what_is_wrong_with_a_campaign_is_said_at_its_place() {
    let refused = |text: &str| {
        let (here, file) = campaign(text);
        let message = sweep(&file, &here.path().join("out")).fails(2);
        assert!(!here.path().join("out").exists(), "nothing is written");
        message
    };
    for (change, place, said) in [
        (
            ("models = [\"two-term-vector\", \"poncelet\"]", "models = [\"two-term-vectr\"]"),
            ":3:11",
            "did you mean `two-term-vector`?",
        ),
        (("seeds = [1, 2]", "seds = [1, 2]"), ":4:1", "did you mean `seeds`?"),
        (("impact.speed", "impact.sped"), ":7:16", "did you mean `speed`?"),
        (("\"2 m/s\"", "\"2 kg\""), ":7:26", "is not a setting that two-term-vector takes"),
        (("[\"1 m/s\", \"2 m/s\", \"3 m/s\"]", "\"1 m/s\""), ":7:16", "expected a list of values"),
        (
            ("[product]", "[set]\nimpact.speed = \"1 m/s\"\n[product]"),
            ":9:17",
            "is set in two ways",
        ),
        (
            ("[product]", "[sample]\nmethod = \"sobol\"\ncount = 70000\n[product]"),
            ":8:9",
            "allowed: 1 to 65536",
        ),
    ] {
        let message = refused(&LAW.replace(change.0, change.1));
        let shown = format!("campaign.toml{place}");
        assert!(message.contains(&shown) && message.contains(said), "{change:?}: {message}");
    }
    let lists = format!(
        "{}\n[conditions]\nspeed = [\"1 m/s\"]\n",
        fs::read_to_string(small_model()).expect("a model")
    );
    let (here, file) = campaign("[campaign]\nname = \"lists\"\nmodels = [\"small-2d.toml\"]\n");
    fs::write(here.path().join("small-2d.toml"), lists).expect("a model");
    let message = sweep(&file, &here.path().join("out")).fails(2);
    assert!(message.contains(":3:11") && message.contains("a point is one impact"), "{message}");
}

#[test]
fn ten_thousand_points_are_planned_and_each_is_its_own() {
    let sample = "\n[sample]\nmethod = \"latin-hypercube\"\ncount = 1667\n[sample.ranges]\n\
                  intruder.mass = [\"10 g\", \"100 g\"]\n\
                  impact.angle = { from = \"20 deg\", to = \"90 deg\", scale = \"logarithmic\" }\n";
    let text = LAW.replace("seeds = [1, 2]\n", "") + sample;
    let (here, file) = campaign(&text);
    let plan = sweep(&file, &here.path().join("out")).arg("--plan").done().json();
    assert_eq!([&plan["points"], &plan["distinct"]], [10_002, 10_002]);
}

/// Leaves a scheduler called `name` in `here` that writes down how it was called; gives its record.
#[cfg(unix)]
fn scheduler(here: &Path, name: &str) -> PathBuf {
    let record = here.join("calls");
    let text = format!("#!/bin/sh\nprintf '%s\\n' \"$*\" >> '{}'\n", record.display());
    program(&here.join("bin").join(name), &text);
    record
}

#[cfg(unix)]
#[test]
fn tasks_of_a_scheduler_do_every_point_once_also_when_they_are_submitted_again() {
    for (on, name, call) in [
        ("slurm", "sbatch", "--job-name=speeds --array=1-12 --export=ALL,PLUNGE_OFFSET=0"),
        ("hyperqueue", "hq", "submit --name=speeds --array=1-12 --cpus=1 --crash-limit=10"),
    ] {
        let (here, file) = campaign(LAW);
        let out = here.path().join("out");
        let record = scheduler(here.path(), name);
        let path = format!("PATH={}:$PATH", here.path().join("bin").display());
        let submit = || sweep(&file, &out).arg("--on").arg(on).after(&path).done().json();
        assert_eq!(submit()["submitted"], 12);
        let calls = fs::read_to_string(&record).expect("a record");
        assert!(calls.contains(call) && calls.contains("point.sh"), "{calls}");
        let task = |n: usize| {
            let script = format!("SLURM_ARRAY_TASK_ID={n} sh '{}/point.sh'", out.display());
            let ended = std::process::Command::new("sh").args(["-c", &script]).output();
            let ended = ended.expect("a shell");
            assert!(ended.status.success(), "{}", String::from_utf8_lossy(&ended.stderr));
        };
        for n in [3, 5, 3] {
            task(n);
        }
        let first = ends(&out);
        assert_eq!(first.len(), 2);
        assert_eq!(submit()["submitted"], 10);
        let calls = fs::read_to_string(&record).expect("a record");
        assert!(calls.contains("--array=1-2,4,6-12 "), "{calls}");
        (1..=12).for_each(task);
        let all = ends(&out);
        assert!(all.len() == 12 && first.iter().all(|end| all.contains(end)));
        assert_eq!(sweep(&file, &out).done().json()["done"], 12);
        assert_eq!(ends(&out), all, "what tasks have done is collected, not done again");
    }
}

#[cfg(unix)]
#[test]
fn a_scheduler_that_is_not_there_is_told_in_a_line() {
    let (here, file) = campaign(LAW);
    let call = sweep(&file, &here.path().join("out")).arg("--on").arg("hyperqueue");
    let ended = call.after("PATH=/nonexistent").end();
    assert_eq!(ended.code, Some(2), "{ended:?}");
    assert!(ended.stderr.contains("cannot start `hq`") && ended.stderr.contains("on PATH"));
}

#[test]
fn logs_that_a_kill_has_left_of_a_point_that_is_done_go_with_the_next_call() {
    let (here, file) = campaign(LAW);
    let out = here.path().join("out");
    sweep(&file, &out).done();
    let points = out.join("points");
    let done = ends(&out);
    for (hash, _) in &done[..2] {
        fs::write(points.join(hash).join("run.mcap"), "a log").expect("a file");
        fs::write(points.join(hash).join("checkpoint.prev"), "a state").expect("a file");
    }
    sweep(&file, &out).done();
    for (hash, _) in &done {
        let left = names(&points.join(hash));
        assert_eq!(left, [".lock", "done.json", "model.toml", "summary.json"], "{hash}");
    }
    assert_eq!(ends(&out), done, "no point is run again");
}
