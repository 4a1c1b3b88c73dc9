//! `--on` of commands that run impacts on beds: the same numbers, found by tasks of a scheduler.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;
use tempfile::TempDir;

use crate::common::{Call, Ended, folder, names, program, small_model};

/// A scheduler of one machine, which does each task at once and says its number first. Of one that is to
/// break, the last task is lost.
const SCHEDULER: &str = "\
#!/bin/sh
echo \"$*\" >> \"$RECORD\"
[ -z \"$REFUSES\" ] || { echo 'no partition is free' >&2; exit 1; }
for word; do
    case $word in --array=*) tasks=${word#--array=} ;; esac
    script=$word
done
echo 'Submitted batch job 1'
for task in $(seq \"${tasks%-*}\" \"${tasks#*-}\"); do
    [ -z \"$BREAKS\" ] || [ \"$task\" != \"${tasks#*-}\" ] || exit 1
    PLUNGE_OFFSET=0 SLURM_ARRAY_TASK_ID=$task sh \"$script\" 2>> \"$RECORD\" || exit 1
done
";

/// Two impacts of the disc of the small model.
const SET: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/runs/two-impacts");

/// A bed of few grains: who runs an impact is in question, not what it does.
const FEW_GRAINS: [&str; 2] = ["bed.grains.0.count=40", "bed.grains.1.count=8"];

/// A folder with a scheduler called `name`.
fn here(name: &str) -> TempDir {
    let here = folder();
    program(&here.path().join("bin").join(name), SCHEDULER);
    here
}

/// A comparison of the small model with the set, with its own cache.
fn compare(here: &Path, cache: &str, on: &str) -> Call {
    Call::new(["compare", "--json", "--quiet", "--model"])
        .arg(small_model())
        .set(&FEW_GRAINS)
        .arg("--cache")
        .arg(here.join(cache))
        .arg("--out")
        .arg(here.join(format!("out-{cache}")))
        .args(["--on", on])
        .arg(SET)
}

/// The same by the scheduler of [`here`], in an environment with `more`.
fn by_scheduler(here: &Path, cache: &str, on: &str, more: &str) -> Call {
    let bin = here.join("bin");
    let record = record(here);
    let before =
        format!("export PATH='{}':$PATH RECORD='{}' {more}", bin.display(), record.display());
    compare(here, cache, on).after(&before)
}

fn record(here: &Path) -> PathBuf {
    here.join("record")
}

/// Impacts that `cache` keeps.
fn impacts(cache: &Path) -> Vec<String> {
    let all = names(&cache.join("impacts")).into_iter();
    all.filter(|name| name.ends_with(".impact")).collect()
}

/// What of a comparison does not depend on when and where it was made.
fn numbers(mut told: Value) -> Value {
    told.as_object_mut().expect("an object").remove("cost");
    told
}

#[test]
fn tasks_of_a_scheduler_find_the_numbers_that_this_process_finds() {
    for (name, on) in [("sbatch", "slurm"), ("hq", "hyperqueue")] {
        let here = here(name);
        let alone = numbers(compare(here.path(), "alone", "local").done().json());
        let told = by_scheduler(here.path(), "shared", on, "").done().json();
        assert_eq!(numbers(told), alone);
        let [one, other] = ["alone", "shared"].map(|cache| impacts(&here.path().join(cache)));
        assert!(!one.is_empty() && one == other, "{one:?} {other:?}");
        let calls = fs::read_to_string(record(here.path())).expect("a record");
        let arrays: Vec<&str> = calls.lines().filter(|line| line.contains("--wait")).collect();
        // Beds, then impacts.
        assert_eq!(arrays.len(), 2, "{calls}");
        assert!(arrays[1].contains(&format!("--array=1-{} ", one.len())), "{calls}");
        by_scheduler(here.path(), "shared", on, "").done();
        let again = fs::read_to_string(record(here.path())).expect("a record");
        assert_eq!(again, calls, "what is kept is not handed over again");
    }
}

#[test]
fn comparisons_at_the_same_time_on_one_cold_cache_all_end_and_run_each_impact_once() {
    let here = folder();
    let start = |name: &str| {
        let call = Call::new(["compare", "--json", "--quiet", "--threads", "1", "--model"]);
        let call = call.arg(small_model()).set(&FEW_GRAINS);
        let call = call.arg("--cache").arg(here.path().join("shared"));
        call.arg("--out").arg(here.path().join(name)).arg(SET).start()
    };
    let children = ["a", "b", "c", "d"].map(start);
    let told = children.map(|child| {
        let ended = Ended::of(child);
        assert_eq!(ended.code, Some(0), "{}", ended.stderr);
        numbers(ended.json())
    });
    assert!(told.iter().all(|one| *one == told[0]), "{told:?}");
    let impacts = names(&here.path().join("shared/impacts"));
    assert!(impacts.iter().all(|name| name.ends_with(".impact")), "{impacts:?}");
}

/// What of results stays the same wherever and however often they are made; `cost` says what they took here.
#[test]
fn diagnoses_on_beds_differ_in_their_cost_alone() {
    let here = folder();
    let diagnosed = |name: &str, threads: &str| {
        let call = Call::new(["diagnose", "--quiet", "--threads", threads]);
        let call = call.set(&FEW_GRAINS);
        let call = call.args(["--candidate", "rolling-resistance", "--model"]).arg(small_model());
        let call = call.arg("--cache").arg(here.path().join(name));
        let out = here.path().join(format!("out-{name}"));
        call.arg("--out").arg(&out).arg(SET).done();
        let mut files = names(&out);
        files.retain(|name| name != "diagnosis.json");
        let texts = files.iter().map(|name| fs::read_to_string(out.join(name)).expect("a file"));
        let texts: Vec<String> = texts.collect();
        let json = fs::read_to_string(out.join("diagnosis.json")).expect("a diagnosis");
        (files, texts, numbers(serde_json::from_str(&json).expect("JSON")))
    };
    assert!(diagnosed("one", "1") == diagnosed("two", "2"), "more than the cost differs");
}

#[test]
fn what_tasks_have_left_undone_is_told_and_handed_over_by_the_same_command() {
    let here = here("sbatch");
    let broken = by_scheduler(here.path(), "shared", "slurm", "BREAKS=yes").fails(1);
    assert!(broken.contains("tasks have left nothing") && broken.contains("tasks"), "{broken}");
    by_scheduler(here.path(), "shared", "slurm", "").done();
    let refused = by_scheduler(here.path(), "other", "slurm", "REFUSES=yes").fails(1);
    assert!(refused.contains("`sbatch` refuses: no partition is free"), "{refused}");
    let absent = compare(here.path(), "other", "slurm").after("PATH=/nonexistent").fails(2);
    assert!(absent.contains("cannot start `sbatch`"), "{absent}");
}

#[test]
fn a_task_of_another_program_or_of_no_list_is_refused() {
    let here = here("sbatch");
    by_scheduler(here.path(), "shared", "slurm", "").done();
    let tasks = here.path().join("shared/tasks");
    let lists = names(&tasks).into_iter().filter(|name| name.ends_with(".json"));
    let is_of_impacts =
        |path: &PathBuf| fs::read_to_string(path).expect("a list").contains("\"impact\"");
    let list = lists.map(|name| tasks.join(name)).find(is_of_impacts).expect("a list of impacts");
    let task = |number: &str| {
        let call = Call::new(["task"]).arg(&list).arg(here.path().join("shared"));
        call.arg(number)
    };
    task("1").done();
    assert!(task("1000").fails(1).contains("not 1000"));
    let text = fs::read_to_string(&list).expect("a list");
    let (before, after) = text.split_once("\"key\": \"").expect("a key");
    fs::write(&list, format!("{before}\"key\": \"00{}", &after[2..])).expect("a list");
    assert!(task("1").fails(1).contains("another version"));
}
