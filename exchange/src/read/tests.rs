//! Claims about reading, on a small log of ours.

use std::fs;
use std::path::PathBuf;

use engine::math::Vec3;
use engine::record::{
    BodyLoad, BodySample, LogSetup, LoggedBody, LoggedShape, RUN_LOG, RunLog, Stamp,
};
use tempfile::TempDir;

use super::*;

/// A chunk is flushed at every multiple of this (steps).
const FLUSH_EVERY: u64 = 10;

/// The state that the log has of body `index` at `step`.
fn state(step: u64, index: usize) -> BodyState {
    let x = step as f64 + 0.1 * index as f64;
    BodyState {
        time: step as f64 * 1e-5,
        depth: libm::sin(x),
        position: Vec3::new(x, 0.0, -x),
        velocity: Vec3::new(libm::cos(x), 0.0, -1.0),
    }
}

/// The force of the ground that the log has on body `index` at `step`, and the weight of any.
fn load(step: u64, index: usize) -> Vec3 {
    Vec3::new(index as f64, 0.0, step as f64)
}

const WEIGHT: Vec3 = Vec3::new(0.0, 0.0, -7.0);

/// Starts a log whose surface lies at 0.5 m and writes it up to the step `last`.
fn written(folder: &TempDir, last: u64) -> RunLog {
    let body = |name: &str| LoggedBody {
        name: name.to_owned(),
        shape: LoggedShape::Sphere { radius: 0.01 },
    };
    let setup = LogSetup {
        flush_every: FLUSH_EVERY,
        checkpoint_every: 1000,
        grains: false,
        bed: None,
        surface_z_m: 0.5,
        bodies: vec![body("ball"), body("disc")],
        container: None,
        energy_terms: vec!["kinetic_intruder_J".to_owned(), "dissipated_x_J".to_owned()],
        force_origins: vec!["contact".to_owned(), "gravity".to_owned()],
        arrow_m_per_newton: 1.0,
        metadata: [("name".to_owned(), "small".to_owned())].into(),
        attachments: Vec::new(),
    };
    let mut log = RunLog::create(folder.path(), &setup).unwrap();
    for step in 0..=last {
        let at = Stamp { step, time_s: step as f64 * 1e-5 };
        log.energy(at, &[step as f64, 2.0], -1.0, 3.0).unwrap();
        for index in 0..2 {
            let BodyState { depth, position, velocity, .. } = state(step, index);
            let position = position + Vec3::new(0.0, 0.0, 0.5);
            let sample = BodySample { position, velocity, spin: Vec3::zeros(), depth_m: depth };
            log.body_state(at, index, &sample).unwrap();
            let (forces, torques) = ([load(step, index), WEIGHT], [Vec3::zeros(); 2]);
            let load = BodyLoad { forces: &forces, torques: &torques, contacts: 1, area: 0.0 };
            log.body_load(at, index, &load).unwrap();
        }
    }
    log
}

fn finished() -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    written(&folder, 25).finish().unwrap();
    let path = folder.path().join(RUN_LOG);
    (folder, path)
}

#[test]
fn the_force_of_the_ground_is_all_but_the_weight() {
    let (_folder, path) = finished();
    let run = read_run(&path, Keep::All).unwrap();
    for (index, loads) in run.loads.iter().enumerate() {
        assert_eq!(loads.name, run.bodies[index].name);
        assert_eq!(loads.time.len(), 26);
        assert_eq!(loads.force, (0..26).map(|step| load(step, index)).collect::<Vec<_>>());
    }
    assert_eq!(run.loads.len(), 2);
    assert!(read_run(&path, Keep::StatesAndEnergy).unwrap().loads.is_empty());
}

#[test]
fn a_finished_log_gives_back_what_was_written() {
    let (_folder, path) = finished();
    let run = read_run(&path, Keep::StatesAndEnergy).unwrap();
    assert!(run.complete);
    assert_eq!(run.metadata["name"], "small");
    let names: Vec<&str> = run.bodies.iter().map(|body| body.name.as_str()).collect();
    assert_eq!(names, ["ball", "disc"]);
    for (index, body) in run.bodies.iter().enumerate() {
        assert_eq!(body.states.len(), 26);
        for (step, found) in (0..).zip(&body.states) {
            let mut expected = state(step, index);
            // The log counts from its surface: the same two roundings.
            expected.position.z = (expected.position.z + 0.5) - 0.5;
            assert_eq!(*found, expected);
        }
    }
    let energy = run.energy.unwrap();
    assert_eq!(energy.terms, ["kinetic_intruder_J", "dissipated_x_J"]);
    assert_eq!(energy.term("kinetic_intruder_J").unwrap()[25].to_bits(), 25.0_f64.to_bits());
    assert_eq!(energy.term("dissipated_x_J").unwrap(), [2.0; 26]);
    assert_eq!(energy.term("input_x_J"), None);
    let closing = Closing { unaccounted: vec![-1.0; 26], closure: vec![3.0; 26] };
    assert_eq!(energy.closing, Some(closing));
    assert_eq!(energy.time.len(), 26);
}

#[test]
fn energies_that_are_not_wanted_are_not_kept() {
    let (_folder, path) = finished();
    let run = read_run(&path, Keep::States).unwrap();
    assert_eq!((run.energy, run.bodies.len()), (None, 2));
}

#[test]
fn a_log_whose_run_was_killed_reads_up_to_its_last_whole_chunk() {
    let folder = tempfile::tempdir().unwrap();
    let log = written(&folder, 25);
    // Neither finished nor dropped, which would end the open chunk: the bytes of a kill.
    let path = folder.path().join(format!("{RUN_LOG}.partial"));
    let bytes = fs::read(&path).unwrap();
    drop(log);
    fs::write(&path, bytes).unwrap();
    let run = read_run(&path, Keep::States).unwrap();
    assert!(!run.complete);
    assert_eq!(run.bodies[0].states.len() as u64, 2 * FLUSH_EVERY + 1);
}

#[test]
fn cut_anywhere_it_reads_to_a_chunk_or_says_why_not() {
    let (folder, path) = finished();
    let bytes = fs::read(&path).unwrap();
    let whole = read_run(&path, Keep::States).unwrap().bodies[0].states.clone();
    let cut = folder.path().join("cut.mcap");
    let mut longest = 0;
    for length in (0..bytes.len()).step_by(61) {
        fs::write(&cut, &bytes[..length]).unwrap();
        match read_run(&cut, Keep::States) {
            Ok(run) => {
                let states = &run.bodies[0].states;
                assert_eq!(states[..], whole[..states.len()]);
                assert!(states.len() >= longest, "less of a longer log");
                longest = states.len();
            }
            Err(ReadError::NotMcap { .. }) => assert!(length < mcap::MAGIC.len()),
            Err(ReadError::NoBodies { .. }) => assert_eq!(longest, 0),
            Err(error) => panic!("{length} bytes: {error}"),
        }
    }
    assert_eq!(longest, whole.len());
}

#[test]
fn a_damaged_chunk_is_an_error_that_names_the_way_out() {
    let (folder, path) = finished();
    let mut bytes = fs::read(&path).unwrap();
    let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
    let chunk = &summary.chunk_indexes[1];
    let middle = chunk.chunk_start_offset + chunk.chunk_length / 2;
    bytes[middle as usize] ^= 0x10;
    let damaged = folder.path().join("damaged.mcap");
    fs::write(&damaged, bytes).unwrap();
    let error = read_run(&damaged, Keep::States).unwrap_err();
    assert!(
        matches!(error, ReadError::Damaged { offset, .. } if offset == chunk.chunk_start_offset),
        "{error}"
    );
    assert!(error.to_string().contains("plunge recover"));
}

#[test]
fn what_is_no_log_of_a_run_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("other");
    fs::write(&path, "some text that is no log").unwrap();
    assert!(matches!(read_run(&path, Keep::States), Err(ReadError::NotMcap { .. })));
    let mut empty = mcap::Writer::new(fs::File::create(&path).unwrap()).unwrap();
    empty.finish().unwrap();
    assert!(matches!(read_run(&path, Keep::States), Err(ReadError::NoBodies { .. })));
    let nowhere = folder.path().join("nowhere");
    assert!(matches!(read_run(&nowhere, Keep::States), Err(ReadError::Io { doing: "open", .. })));
}

#[test]
fn a_descriptor_without_a_field_of_ours_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("foreign.mcap");
    let mut log = mcap::Writer::new(fs::File::create(&path).unwrap()).unwrap();
    // An empty descriptor set: it describes nothing.
    let schema = log.add_schema("plunge.IntruderState", "protobuf", &[]).unwrap();
    let topic = "/intruder/ball/state";
    let channel = log.add_channel(schema, topic, "protobuf", &BTreeMap::new()).unwrap();
    let header = mcap::records::MessageHeader {
        channel_id: channel,
        sequence: 0,
        log_time: 0,
        publish_time: 0,
    };
    log.write_to_known_channel(&header, &[]).unwrap();
    log.finish().unwrap();
    let error = read_run(&path, Keep::States).unwrap_err();
    assert!(matches!(error, ReadError::Fields { .. }), "{error}");
    assert!(
        error.to_string().contains(topic) && error.to_string().contains("plunge.IntruderState")
    );
}
