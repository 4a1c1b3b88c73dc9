//! The bytes of a log do not depend on how often its run was interrupted.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use super::*;
use crate::record::file::tests::ROOM;

const LAST: u64 = 300;

/// A run killed at some step after it wrote a checkpoint.
struct Killed {
    /// Both partial files as the kill left them, and their lengths at the checkpoint.
    files: [(Vec<u8>, usize); 2],
    position: LogPosition,
}

fn uninterrupted(setup: &LogSetup, n_grains: u32) -> [Vec<u8>; 2] {
    let scratch = empty_folder();
    write_rest(RunLog::create(scratch.path(), setup).unwrap(), 0, LAST, n_grains);
    files(&scratch)
}

fn partials(dir: &Path) -> [Vec<u8>; 2] {
    [RUN_LOG, GRAIN_LOG].map(|name| fs::read(dir.join(format!("{name}.partial"))).unwrap())
}

fn killed(setup: &LogSetup, checkpoint: u64, last: u64, n_grains: u32) -> Killed {
    let scratch = empty_folder();
    let mut log = RunLog::create(scratch.path(), setup).unwrap();
    for step in 0..=checkpoint {
        write_step(&mut log, step, n_grains).unwrap();
    }
    log.flush().unwrap();
    let position = log.position();
    let flushed = partials(scratch.path()).map(|file| file.len());
    for step in checkpoint + 1..=last {
        write_step(&mut log, step, n_grains).unwrap();
    }
    // read before the writer is dropped: what it still holds in memory dies with the process
    let [run, grains] = partials(scratch.path());
    Killed { files: [(run, flushed[0]), (grains, flushed[1])], position }
}

fn put(dir: &Path, files: [&[u8]; 2]) {
    for (name, bytes) in [RUN_LOG, GRAIN_LOG].into_iter().zip(files) {
        fs::write(dir.join(format!("{name}.partial")), bytes).unwrap();
    }
}

#[test]
fn the_same_calls_give_the_same_bytes() {
    assert!(uninterrupted(&setup(), 50) == uninterrupted(&setup(), 50));
}

#[test]
fn a_resumed_log_equals_an_uninterrupted_one_wherever_the_kill_cut_it() {
    let setup = setup();
    let whole = uninterrupted(&setup, 50);
    let mut rng = Pcg64::seed_from_u64(1);
    // multiples of checkpoint_every, and steps at which a signal made the run leave
    for (checkpoint, last) in [(60, 61), (120, 157), (240, LAST), (133, 134), (0, 19), (1, 130)] {
        let killed = killed(&setup, checkpoint, last, 50);
        for _ in 0..8 {
            let scratch = empty_folder();
            let [run, grains] = killed
                .files
                .each_ref()
                .map(|(bytes, flushed)| &bytes[..rng.random_range(*flushed..=bytes.len())]);
            put(scratch.path(), [run, grains]);
            let log = RunLog::resume(scratch.path(), &setup, &killed.position).unwrap();
            assert_eq!(log.position(), killed.position);
            write_rest(log, checkpoint + 1, LAST, 50);
            assert!(files(&scratch) == whole, "checkpoint {checkpoint}, killed at {last}");
            assert_eq!(fs::read_dir(scratch.path()).unwrap().count(), 2, "no partial file is left");
        }
    }
}

#[test]
fn chunks_that_end_by_size_end_there_again_after_a_restart() {
    let mut setup = setup();
    (setup.flush_every, setup.checkpoint_every) = (10_000, 10_000);
    let n_grains = 15_000;
    let whole = uninterrupted(&setup, n_grains);
    let summary = mcap::Summary::read(&whole[1]).unwrap().unwrap();
    assert!(summary.chunk_indexes.len() > 3);
    let killed = killed(&setup, 200, 201, n_grains);
    let scratch = empty_folder();
    put(scratch.path(), [&killed.files[0].0, &killed.files[1].0]);
    let log = RunLog::resume(scratch.path(), &setup, &killed.position).unwrap();
    write_rest(log, 201, LAST, n_grains);
    assert!(files(&scratch) == whole);
}

#[test]
fn a_log_killed_again_before_its_next_flush_can_be_resumed_again() {
    let setup = setup();
    let killed = killed(&setup, 60, 100, 50);
    let scratch = empty_folder();
    put(scratch.path(), [&killed.files[0].0, &killed.files[1].0]);
    for _ in 0..2 {
        let mut log = RunLog::resume(scratch.path(), &setup, &killed.position).unwrap();
        write_step(&mut log, 61, 50).unwrap();
        std::mem::forget(log);
    }
    let log = RunLog::resume(scratch.path(), &setup, &killed.position).unwrap();
    write_rest(log, 61, LAST, 50);
    assert!(files(&scratch) == uninterrupted(&setup, 50));
}

#[test]
fn a_kill_between_the_renames_of_finish_can_be_resumed() {
    let setup = setup();
    let whole = uninterrupted(&setup, 50);
    let killed = killed(&setup, 240, LAST, 50);
    let scratch = empty_folder();
    fs::write(scratch.path().join("run.mcap.partial"), &whole[0]).unwrap();
    fs::write(scratch.path().join(GRAIN_LOG), &whole[1]).unwrap();
    let log = RunLog::resume(scratch.path(), &setup, &killed.position).unwrap();
    write_rest(log, 241, LAST, 50);
    assert!(files(&scratch) == whole);
}

#[test]
fn a_log_cut_before_the_checkpoint_names_what_is_missing() {
    let setup = setup();
    let killed = killed(&setup, 60, 100, 50);
    for (cut, damaged) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        let mut files = killed.files.clone();
        let (bytes, flushed) = &mut files[damaged];
        bytes.truncate(if cut == 0 { 5 } else { *flushed / 2 });
        let scratch = empty_folder();
        put(scratch.path(), [&files[0].0, &files[1].0]);
        let Err(error) = RunLog::resume(scratch.path(), &setup, &killed.position) else {
            panic!("resumed from a log that lacks messages");
        };
        assert!(matches!(error, RecordError::Missing { step: 60, .. }), "{error}");
    }
}

#[test]
fn a_damaged_chunk_before_the_checkpoint_is_an_error_with_its_place() {
    let setup = setup();
    let mut killed = killed(&setup, 60, 100, 50);
    let middle = killed.files[0].1 / 2;
    killed.files[0].0[middle] ^= 1;
    let scratch = empty_folder();
    put(scratch.path(), [&killed.files[0].0, &killed.files[1].0]);
    let result = RunLog::resume(scratch.path(), &setup, &killed.position).map(drop);
    assert!(matches!(result, Err(RecordError::Damaged { .. })), "{result:?}");
}

#[test]
fn the_log_of_another_model_is_not_taken_up() {
    let killed = killed(&setup(), 60, 100, 50);
    let scratch = empty_folder();
    put(scratch.path(), [&killed.files[0].0, &killed.files[1].0]);
    let mut other = setup();
    other.energy_terms.push("dissipated_cohesion_J".to_owned());
    let result = RunLog::resume(scratch.path(), &other, &killed.position).map(drop);
    assert!(matches!(result, Err(RecordError::OtherRun { .. })), "{result:?}");
}

#[test]
fn a_full_disk_is_an_error_of_the_call_that_met_it() {
    let mut setup = setup();
    setup.grains = false;
    let written = |scratch: &TempDir| {
        let mut log = RunLog::create(scratch.path(), &setup)?;
        for step in 0..=LAST {
            write_step(&mut log, step, 0)?;
        }
        log.finish().map(drop)
    };
    let scratch = empty_folder();
    written(&scratch).unwrap();
    let whole = fs::read(scratch.path().join(RUN_LOG)).unwrap().len() as u64;
    // Full in its head, in each of its chunks, and in the summary that `finish` writes.
    let rooms = (0..50).map(|part| whole * part / 50).chain([whole - 200, whole - 20, whole - 1]);
    for room in rooms {
        let scratch = empty_folder();
        ROOM.set(room);
        let result = written(&scratch);
        ROOM.set(u64::MAX);
        let Err(RecordError::Io { path, source, .. }) = result else {
            panic!("room for {room} bytes: {result:?}");
        };
        assert_eq!(path, scratch.path().join("run.mcap.partial"), "room for {room} bytes");
        assert_eq!(source.kind(), std::io::ErrorKind::StorageFull, "room for {room} bytes");
        assert!(!scratch.path().join(RUN_LOG).exists(), "room for {room} bytes");
    }
}
