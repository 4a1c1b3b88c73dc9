//! Claims about recovery, on a small log damaged in every way.

use std::collections::BTreeSet;
use std::ops::Range;

use engine::math::Vec3;
use engine::record::{
    BodyLoad, BodySample, LogAttachment, LogSetup, LoggedBody, LoggedShape, RunLog, Stamp,
};
use tempfile::TempDir;

use super::*;

/// Topic, step and bytes of a message.
type Message = (String, u32, Vec<u8>);

/// A small finished log and its anatomy.
struct Sample {
    bytes: Vec<u8>,
    /// Place of each chunk and what is in it.
    chunks: Vec<(Range<usize>, BTreeSet<Message>)>,
}

/// An empty folder, removed when dropped.
struct Scratch(TempDir);

impl Scratch {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self) -> &Path {
        self.0.path()
    }

    /// Recovers `damaged` and returns what happened and the new log.
    fn recover(&self, damaged: &[u8]) -> Result<(Recovered, Vec<u8>), RecoverError> {
        let [input, output] = ["in.mcap", "out.mcap"].map(|name| self.path().join(name));
        fs::write(&input, damaged).unwrap();
        drop(fs::remove_file(&output));
        let recovered = recover(&input, &output, &|| false)?;
        assert_eq!(fs::read_dir(self.path()).unwrap().count(), 2, "no temporary file is left");
        Ok((recovered, fs::read(output).unwrap()))
    }
}

/// A log with a chunk every ten steps.
fn sample(last: u64) -> Sample {
    let scratch = Scratch::new();
    let mut log = RunLog::create(scratch.path(), &setup()).unwrap();
    for step in 0..=last {
        let at = Stamp { step, time_s: step as f64 * 1e-5 };
        let x = libm::sin(step as f64);
        log.energy(at, &[x, x * x], 0.0, 0.0).unwrap();
        let (position, velocity, spin) =
            (Vec3::repeat(x), Vec3::repeat(libm::cos(x)), Vec3::zeros());
        let state = BodySample { position, velocity, spin, depth_m: libm::tan(x) };
        log.body_state(at, 0, &state).unwrap();
        let (forces, torques) = ([Vec3::repeat(x * 0.7)], [Vec3::zeros()]);
        log.body_load(
            at,
            0,
            &BodyLoad { forces: &forces, torques: &torques, contacts: 1, area: 0.0 },
        )
        .unwrap();
    }
    log.finish().unwrap();
    let bytes = fs::read(scratch.path().join("run.mcap")).unwrap();
    let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
    let chunks = summary.chunk_indexes.iter().map(|index| {
        let start = index.chunk_start_offset as usize;
        let messages = summary.stream_chunk(&bytes, index).unwrap();
        (
            start..start + index.chunk_length as usize,
            messages.map(|m| message(m.unwrap())).collect(),
        )
    });
    let chunks = chunks.collect();
    Sample { bytes, chunks }
}

fn setup() -> LogSetup {
    LogSetup {
        flush_every: 10,
        checkpoint_every: 1000,
        grains: false,
        bed: None,
        surface_z_m: 0.0,
        bodies: vec![LoggedBody {
            name: "ball".to_owned(),
            shape: LoggedShape::Sphere { radius: 0.01 },
        }],
        container: None,
        energy_terms: vec!["kinetic_intruder_J".to_owned(), "elastic_x_J".to_owned()],
        force_origins: vec!["contact".to_owned()],
        arrow_m_per_newton: 1.0,
        metadata: [("seed".to_owned(), "7".to_owned())].into(),
        attachments: vec![LogAttachment {
            name: "model.toml".to_owned(),
            media_type: "application/toml".to_owned(),
            data: b"name = \"sample\"\n".to_vec(),
        }],
    }
}

fn message(message: mcap::Message<'_>) -> Message {
    (message.channel.topic.clone(), message.sequence, message.data.into_owned())
}

/// All messages of a finished log, read from start to end.
fn in_order(log: &[u8]) -> Vec<Message> {
    mcap::MessageStream::new(log).unwrap().map(|m| message(m.unwrap())).collect()
}

/// All messages of a log, read by its index.
fn messages(log: &[u8]) -> BTreeSet<Message> {
    let summary = mcap::Summary::read(log).unwrap().expect("a recovered log has an index");
    let indexes = summary.chunk_indexes.iter();
    indexes
        .flat_map(|index| summary.stream_chunk(log, index).unwrap())
        .map(|m| message(m.unwrap()))
        .collect()
}

impl Sample {
    /// Messages of the chunks that satisfy `intact`.
    fn expected(&self, intact: impl Fn(&Range<usize>) -> bool) -> BTreeSet<Message> {
        let chunks = self.chunks.iter().filter(|(place, _)| intact(place));
        chunks.flat_map(|(_, messages)| messages.clone()).collect()
    }

    /// The log cut at each of `places` keeps its first messages, at least those in whole chunks.
    fn assert_cuts_are_recovered(&self, places: impl Iterator<Item = usize>) {
        let scratch = Scratch::new();
        let [input, output] = ["in.mcap", "out.mcap"].map(|name| scratch.path().join(name));
        let all = in_order(&self.bytes);
        for cut in places {
            fs::write(&input, &self.bytes[..cut]).unwrap();
            // without the sync to disk, which takes longer than all the rest
            let recovered = copy(&input, &output, &|| false).unwrap();
            let found = in_order(&fs::read(&output).unwrap());
            let whole = self.chunks.iter().filter(|(place, _)| place.end <= cut);
            let whole: usize = whole.map(|(_, messages)| messages.len()).sum();
            assert!(found.len() >= whole && all.starts_with(&found), "cut at {cut}");
            assert_eq!(recovered.messages, found.len() as u64, "cut at {cut}");
            assert!(!recovered.complete, "cut at {cut}");
        }
    }
}

#[test]
fn an_undamaged_log_comes_out_as_it_went_in() {
    let sample = sample(200);
    let (recovered, log) = Scratch::new().recover(&sample.bytes).unwrap();
    assert!(log == sample.bytes);
    assert_eq!(recovered.lost, []);
    assert!(recovered.complete);
    assert_eq!(recovered.chunks, sample.chunks.len() as u64);
    assert_eq!(recovered.messages, 3 * 201);
}

#[test]
fn a_log_cut_at_every_byte_of_its_last_20_kb_keeps_every_whole_chunk() {
    let sample = sample(120);
    let length = sample.bytes.len();
    assert!(length > 20_000);
    sample.assert_cuts_are_recovered(length - 20_000..length);
}

#[test]
fn a_log_cut_at_200_random_places_keeps_every_whole_chunk() {
    let sample = sample(1000);
    let mark = mcap::MAGIC.len();
    let mut random = random(1);
    let places = (0..200).map(|_| mark + random(sample.bytes.len() - mark));
    sample.assert_cuts_are_recovered(places);
}

#[test]
fn a_cut_chunk_counts_as_far_as_it_unpacks() {
    let mut setup = setup();
    setup.flush_every = 100_000;
    let scratch = Scratch::new();
    let mut log = RunLog::create(scratch.path(), &setup).unwrap();
    for step in 0..=9000 {
        // incompressible enough for several blocks per chunk
        let x = libm::exp(libm::sin(step as f64 * 0.37));
        log.energy(Stamp { step, time_s: x }, &[x, 1.0 / x], 0.0, 0.0).unwrap();
    }
    // killed with the chunk open: its lengths are all ones
    let killed = fs::read(scratch.path().join("run.mcap.partial")).unwrap();
    drop(log);
    let (recovered, log) = Scratch::new().recover(&killed).unwrap();
    assert!(recovered.messages > 1000, "{recovered:?}");
    assert_eq!(messages(&log).len() as u64, recovered.messages);
    assert!(recovered.lost[0].why.contains("of its messages saved"), "{recovered:?}");
}

#[test]
fn flipped_bits_cost_no_more_than_the_chunks_they_are_in() {
    let sample = sample(300);
    let data_end = sample.chunks.last().unwrap().0.end;
    let scratch = Scratch::new();
    let mut random = random(2);
    for n_flips in [1, 8, 64] {
        for _ in 0..200 {
            let mut damaged = sample.bytes.clone();
            let places: Vec<_> = (0..n_flips).map(|_| random(damaged.len())).collect();
            for &place in &places {
                damaged[place] ^= 1 << random(8);
            }
            let (_, log) = scratch.recover(&damaged).unwrap();
            let found = messages(&log);
            let hit = |range: &Range<usize>| places.iter().any(|place| range.contains(place));
            // channels are defined in the first chunk and again at the end
            if !(hit(&sample.chunks[0].0) && hit(&(data_end..damaged.len()))) {
                let intact = sample.expected(|chunk| !hit(chunk));
                assert!(found.is_superset(&intact), "flips at {places:?}");
            }
            assert!(found.is_subset(&sample.expected(|_| true)), "flips at {places:?}");
        }
    }
}

#[test]
fn a_damaged_length_costs_nothing_when_the_chunk_is_whole() {
    let sample = sample(100);
    let start = sample.chunks[4].0.start;
    // the length of the record, and the length of what is packed in it
    for place in [start + 1, start + 8, start + 9 + 36, start + 9 + 43] {
        let mut damaged = sample.bytes.clone();
        damaged[place] ^= 0x55;
        let (recovered, log) = Scratch::new().recover(&damaged).unwrap();
        assert_eq!(recovered.lost, [], "{place}");
        assert!(log == sample.bytes, "{place}");
    }
}

#[test]
fn a_chunk_that_claims_to_be_huge_is_refused_without_memory_for_it() {
    let sample = sample(100);
    let start = sample.chunks[4].0.start;
    let mut damaged = sample.bytes.clone();
    damaged[start + 9 + 16 + 5] = 0xff;
    let (recovered, _) = Scratch::new().recover(&damaged).unwrap();
    assert_eq!(recovered.messages, 3 * 91);
    assert_eq!(recovered.lost.len(), 1);
    assert_eq!(recovered.lost[0].offset, start as u64);
}

#[test]
fn attachments_and_metadata_survive_the_loss_of_the_index() {
    let sample = sample(50);
    let (_, log) = Scratch::new().recover(&sample.bytes[..sample.chunks[1].0.end]).unwrap();
    let summary = mcap::Summary::read(&log).unwrap().unwrap();
    let attachment = mcap::read::attachment(&log, &summary.attachment_indexes[0]).unwrap();
    assert_eq!(*attachment.data, *b"name = \"sample\"\n");
    let metadata = mcap::read::metadata(&log, &summary.metadata_indexes[0]).unwrap();
    assert_eq!(metadata.metadata["seed"], "7");
}

#[test]
fn other_files_and_existing_outputs_are_refused() {
    let scratch = Scratch::new();
    for other in [&b""[..], b"depth,force\n0,1\n", &[0; 5000]] {
        let result = scratch.recover(other);
        assert!(matches!(result, Err(RecoverError::NotMcap { .. })), "{result:?}");
    }
    let input = scratch.path().join("in.mcap");
    let result = recover(&input, &input, &|| false);
    assert!(matches!(result, Err(RecoverError::OutputExists { .. })), "{result:?}");
    assert_eq!(fs::read_dir(scratch.path()).unwrap().count(), 1);
}

/// Numbers below the argument, the same in every run of the test.
fn random(seed: u64) -> impl FnMut(usize) -> usize {
    let mut state = seed;
    move |below| {
        // Knuth's MMIX generator; the high bits are the good ones
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    }
}
