//! Whatever ends a run on the way, `--resume` ends at the same bytes.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::thread::sleep;
use std::time::{Duration, Instant};

use tempfile::TempDir;

use crate::common::{
    Call, Ended, assert_same_run, ended_on_the_way, folder, names, signal, small_model, wait_for,
};
use crate::ignored::is_ignored;

/// A run that flushes and checkpoints all the time.
const BUSY: [&str; 3] = ["run.duration=60 ms", "run.checkpoint_every=200", "log.flush_every=100"];

const RANDOM_KILLS: u32 = 10;

fn busy(out: &Path) -> Call {
    Call::run(out).set(&BUSY)
}

/// The busy run that nothing disturbed, and how long it took.
fn undisturbed() -> (&'static Path, Duration) {
    static RUN: OnceLock<(TempDir, Duration)> = OnceLock::new();
    let (out, took) = RUN.get_or_init(|| {
        let out = folder();
        crate::common::cache();
        let start = Instant::now();
        busy(out.path()).done();
        (out, start.elapsed())
    });
    (out.path(), *took)
}

/// Leaves in `out` a busy run ended by SIGTERM after its first checkpoints.
fn interrupted(out: &Path) {
    let ended = ended_on_the_way(|| busy(out), &out.join("checkpoint.prev"), &["TERM"]);
    assert_eq!(ended.code, Some(143));
}

/// Resumes and compares with the undisturbed run; gives what was said on the way.
fn resumes_to_the_same_bytes(out: &Path) -> String {
    let ended = busy(out).arg("--resume").done();
    assert_same_run(out, undisturbed().0);
    assert_eq!(names(out), names(undisturbed().0), "nothing of the unfinished run is left");
    ended.stderr
}

#[test]
fn killed_at_random_times_and_resumed_a_run_ends_at_the_same_bytes() {
    let (reference, took) = undisturbed();
    let mut state = 20_u64;
    let mut share = move || {
        // Knuth's MMIX generator; its high bits are random enough to pick moments.
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        f64::from((state >> 40) as u32) / f64::from(1 << 24)
    };
    let parent = folder();
    let (mut out, mut folders) = (parent.path().join("0"), 1);
    for _ in 0..RANDOM_KILLS {
        let mut child = busy(&out).arg("--resume").start();
        sleep(took.mul_f64(0.6 * share()));
        child.kill().expect("it can be killed");
        if Ended::of(child).code == Some(0) {
            assert_same_run(&out, reference);
            out = parent.path().join(folders.to_string());
            folders += 1;
        }
    }
    resumes_to_the_same_bytes(&out);
}

#[test]
fn sigterm_ends_with_143_within_2_s_and_sigint_with_130() {
    for (name, number) in [("TERM", 15), ("INT", 2), ("HUP", 1)] {
        if is_ignored(number) {
            continue; // under nohup, say: then a run ignores it too
        }
        let code = 128 + number;
        let out = folder();
        let checkpoint = out.path().join("checkpoint");
        let ended = ended_on_the_way(|| busy(out.path()), &checkpoint, &[name]);
        assert_eq!(ended.code, Some(code));
        assert_eq!(ended.stdout, "");
        assert!(ended.stderr.contains("--resume"), "{}", ended.stderr);
        resumes_to_the_same_bytes(out.path());
    }
}

#[test]
fn a_second_signal_ends_the_program_at_once_and_it_can_be_resumed() {
    let out = folder();
    let checkpoint = out.path().join("checkpoint");
    let ended = ended_on_the_way(|| busy(out.path()), &checkpoint, &["TERM", "TERM"]);
    assert_eq!(ended.code, Some(143));
    resumes_to_the_same_bytes(out.path());
}

#[cfg(target_os = "linux")]
#[test]
fn under_nohup_a_run_outlives_its_terminal() {
    let out = folder();
    let child = busy(out.path()).after("trap '' HUP").start();
    wait_for(&out.path().join("checkpoint"));
    signal(&child, "HUP");
    assert_eq!(Ended::of(child).code, Some(0));
    assert_same_run(out.path(), undisturbed().0);
}

#[cfg(target_os = "linux")]
#[test]
fn a_file_that_cannot_grow_ends_the_run_with_a_message_and_it_can_be_resumed() {
    let out = folder();
    // In 512 bytes, or in some shells in 1024: the log gets a part of its two megabytes.
    let message = busy(out.path()).after("trap '' XFSZ; ulimit -f 600").fails(1);
    assert!(message.contains("run.mcap.partial") && message.contains("too large"), "{message}");
    resumes_to_the_same_bytes(out.path());
}

#[test]
fn a_checkpoint_of_1_thread_goes_on_with_8() {
    let out = folder();
    let one = || busy(out.path()).arg("--threads").arg("1");
    let ended = ended_on_the_way(one, &out.path().join("checkpoint"), &["TERM"]);
    assert_eq!(ended.code, Some(143));
    busy(out.path()).arg("--resume").arg("--threads").arg("8").done();
    assert_same_run(out.path(), undisturbed().0);
}

#[test]
fn a_kill_while_the_bed_settles_leaves_nothing_in_the_way() {
    let (parent, cache) = (folder(), folder());
    let out = parent.path().join("out");
    let run = || {
        let call = Call::new(["run", "--quiet", "--json", "--out"]).arg(&out);
        call.arg("--cache").arg(cache.path()).arg(small_model()).set(&["run.duration=1 ms"])
    };
    let mut child = run().start();
    wait_for(&out.join(".lock"));
    sleep(Duration::from_millis(100));
    child.kill().expect("it can be killed");
    assert_eq!(Ended::of(child).code, None);
    // Once it holds its folder, it listens for signals.
    fs::remove_file(out.join(".lock")).expect("the lock");
    let child = run().start();
    wait_for(&out.join(".lock"));
    signal(&child, "TERM");
    assert_eq!(Ended::of(child).code, Some(143));
    assert_eq!(run().arg("--resume").done().json()["bed"]["cache"], "miss");
}

/// Damage to a file, by its bytes.
type Damage = fn(&mut Vec<u8>);

const FLIPPED: Damage = |bytes| {
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
};
/// So densely that something is hit that matters: half of a log is indices, which nobody needs.
const SPOTTED: Damage = |bytes| bytes.iter_mut().step_by(500).skip(1).for_each(|byte| *byte ^= 1);
const CUT: Damage = |bytes| bytes.truncate(bytes.len() / 3);
const EMPTIED: Damage = Vec::clear;

fn damage(path: &Path, damage: Damage) {
    let mut bytes = fs::read(path).expect("the file");
    damage(&mut bytes);
    fs::write(path, bytes).expect("the file");
}

#[test]
fn a_damaged_checkpoint_gives_way_to_the_one_before_with_a_warning() {
    for how in [FLIPPED, CUT, EMPTIED] {
        let out = folder();
        interrupted(out.path());
        damage(&out.path().join("checkpoint"), how);
        let said = resumes_to_the_same_bytes(out.path());
        assert!(said.contains("damaged") && said.contains("checkpoint before"), "{said}");
    }
}

#[test]
fn without_a_sound_checkpoint_a_run_starts_again_with_a_warning() {
    let out = folder();
    interrupted(out.path());
    damage(&out.path().join("checkpoint"), FLIPPED);
    damage(&out.path().join("checkpoint.prev"), CUT);
    let said = resumes_to_the_same_bytes(out.path());
    assert!(said.contains("damaged") && said.contains("starting again"), "{said}");
}

#[test]
fn a_damaged_or_missing_log_starts_again_with_a_warning() {
    for how in [SPOTTED, CUT, EMPTIED] {
        let out = folder();
        interrupted(out.path());
        damage(&out.path().join("run.mcap.partial"), how);
        let said = resumes_to_the_same_bytes(out.path());
        assert!(said.contains("run.mcap.partial") && said.contains("starting again"), "{said}");
    }
    let out = folder();
    interrupted(out.path());
    fs::remove_file(out.path().join("grains.mcap.partial")).expect("the log");
    let said = resumes_to_the_same_bytes(out.path());
    assert!(said.contains("grains.mcap.partial") && said.contains("starting again"), "{said}");
}

#[test]
fn the_checkpoint_of_another_run_is_not_taken() {
    let (out, other) = (folder(), folder());
    interrupted(out.path());
    let child = busy(other.path()).set(&["impact.speed=2 m/s"]).start();
    wait_for(&other.path().join("checkpoint"));
    signal(&child, "TERM");
    Ended::of(child);
    fs::remove_file(out.path().join("checkpoint.prev")).expect("the checkpoint before");
    let taken = out.path().join("checkpoint");
    fs::copy(other.path().join("checkpoint"), taken).expect("the checkpoint");
    let said = resumes_to_the_same_bytes(out.path());
    assert!(said.contains("belongs to other inputs") && said.contains("starting again"), "{said}");
}

/// What a kill between two system calls leaves, made by hand from an interrupted run.
type Moment = (&'static str, fn(&Path, &Path));

const MOMENTS: [Moment; 6] = [
    ("between the two renames of a checkpoint", |out, _| {
        fs::rename(out.join("checkpoint"), out.join("checkpoint.partial")).expect("a rename");
    }),
    ("while a resumed log is copied", |out, _| {
        fs::write(out.join("run.mcap.partial.new"), b"\x89MCAP0\r\n and so on").expect("a log");
        fs::write(out.join("grains.mcap.partial.new"), b"").expect("a log");
    }),
    ("when grains.mcap has its final name", |out, finished| {
        fs::remove_file(out.join("grains.mcap.partial")).expect("the log");
        fs::copy(finished.join("grains.mcap"), out.join("grains.mcap")).expect("a log");
        fs::copy(finished.join("run.mcap"), out.join("run.mcap.partial")).expect("a log");
    }),
    ("before the summary", |out, finished| {
        for name in ["grains.mcap", "run.mcap"] {
            fs::remove_file(out.join(format!("{name}.partial"))).expect("the log");
            fs::copy(finished.join(name), out.join(name)).expect("a log");
        }
    }),
    ("while the summary is written", |out, _| {
        fs::write(out.join("summary.json.partial"), b"{ \"name\"").expect("a summary");
    }),
    ("while the model is written", |out, _| {
        for name in names(out).iter().filter(|name| *name != ".lock") {
            fs::remove_file(out.join(name)).expect("a file");
        }
        fs::write(out.join("model.toml.partial"), b"[run]").expect("a model");
    }),
];

#[test]
fn a_kill_between_any_two_renames_is_taken_up_again() {
    for (when, make) in MOMENTS {
        let out = folder();
        interrupted(out.path());
        make(out.path(), undisturbed().0);
        eprintln!("killed {when}: {}", resumes_to_the_same_bytes(out.path()));
    }
}

#[test]
fn a_kill_after_the_summary_leaves_a_finished_run() {
    let (parent, finished) = (folder(), undisturbed().0);
    let out: PathBuf = parent.path().join("out");
    interrupted(&out);
    for name in ["grains.mcap", "run.mcap", "summary.json"] {
        fs::copy(finished.join(name), out.join(name)).expect("a file");
    }
    for name in ["grains.mcap.partial", "run.mcap.partial"] {
        fs::remove_file(out.join(name)).expect("a log");
    }
    busy(&out).done();
    assert_same_run(&out, finished);
    assert_eq!(names(&out), names(finished), "the checkpoints are gone");
}
