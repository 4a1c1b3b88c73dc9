//! `plunge recover`: what is readable of a damaged log, and an exit code that says how much.

use std::fs;
use std::path::PathBuf;

use tempfile::TempDir;

use crate::common::{Call, Ended, folder, names};
use crate::log::Log;

/// A folder with a short finished log, and its path.
fn finished() -> (TempDir, PathBuf) {
    let out = folder();
    Call::run(out.path()).set(&["run.duration=5 ms", "log.flush_every=50"]).done();
    let log = out.path().join("run.mcap");
    (out, log)
}

fn recover(from: &PathBuf, to: &PathBuf) -> Ended {
    Call::new(["recover", "--json"]).arg(from).arg(to).end()
}

#[test]
fn a_log_cut_in_half_is_saved_with_exit_code_3() {
    let (out, log) = finished();
    let whole = fs::read(&log).expect("the log");
    let (cut, saved) = (out.path().join("cut.mcap"), out.path().join("saved.mcap"));
    fs::write(&cut, &whole[..whole.len() / 2]).expect("a log");
    let ended = recover(&cut, &saved);
    assert_eq!(ended.code, Some(3), "{}", ended.stderr);
    assert!(ended.stderr.contains("lost"), "{}", ended.stderr);
    let (json, saved, before) = (ended.json(), Log::read(&saved), Log::read(&log));
    assert_eq!(json["complete"], false);
    assert_eq!(json["messages"], saved.messages.len());
    let n = saved.messages.len();
    assert!(n > before.messages.len() / 4 && saved.messages[..] == before.messages[..n]);
    assert_eq!(saved.metadata, before.metadata);
    assert_eq!(saved.attachments, before.attachments);
}

#[test]
fn a_finished_log_is_saved_whole_with_exit_code_0() {
    let (out, log) = finished();
    let saved = out.path().join("saved.mcap");
    let ended = recover(&log, &saved);
    assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""));
    assert_eq!(ended.json()["complete"], true);
    assert_eq!(ended.json()["lost"], serde_json::json!([]));
    assert!(Log::read(&saved).messages == Log::read(&log).messages);
}

#[test]
fn what_is_no_log_and_what_exists_already_are_bad_input() {
    let (out, log) = finished();
    let (text, saved) = (out.path().join("notes.txt"), out.path().join("saved.mcap"));
    fs::write(&text, "no log at all, but long enough to be one").expect("a file");
    let call = |from: &PathBuf, to: &PathBuf| Call::new(["recover", "--json"]).arg(from).arg(to);
    let files = names(out.path());
    for from in [&text, &out.path().join("none.mcap"), &out.path().to_path_buf()] {
        call(from, &saved).fails(2);
    }
    let before = fs::read(&log).expect("the log");
    assert!(call(&log, &log).fails(2).contains("exists"));
    call(&log, &text).fails(2);
    assert!(fs::read(&log).expect("the log") == before);
    assert_eq!(names(out.path()), files, "nothing is left behind");
}
