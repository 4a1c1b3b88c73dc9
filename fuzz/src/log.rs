//! Logs.

use std::fs;
use std::path::Path;

use engine::record::chunk::{ChunkHead, RECORD_PREFIX, Records, unpack};
use exchange::export::{Format, export};
use exchange::read::{Keep, read_run};
use exchange::recover::recover;

/// An input that begins so is the records of one chunk; any other is a whole file.
///
/// Behind compression and checksum hardly a change of a file reaches a record; this way each does.
pub const RECORDS: u8 = b'R';

const MAGIC: &[u8] = b"\x89MCAP0\r\n";
const HEADER: u8 = 0x01;
const CHUNK: u8 = 0x06;

/// What comes of the log `bytes`: readers read or refuse it, and what is recovered of it is a finished log
/// that comes out of recovery as it went in.
///
/// # Panics
/// Where that does not hold.
pub fn outcome(bytes: &[u8]) -> String {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let here = folder.path().display().to_string();
    let path = folder.path().join("run.mcap");
    let file = match bytes.split_first() {
        Some((&RECORDS, records)) => in_a_chunk(records),
        _ => bytes.to_vec(),
    };
    fs::write(&path, file).expect("a temporary file");
    let mut said = match read_run(&path, Keep::StatesAndEnergy) {
        Ok(run) => format!("{} bodies\n", run.bodies.len()),
        Err(error) => format!("{error}\n"),
    };
    for format in Format::ALL {
        match export(&path, format, &folder.path().join(format.name()), &|| false) {
            Ok(exported) => said.push_str(&format!("{} files\n", exported.files.len())),
            Err(error) => said.push_str(&format!("{error}\n")),
        }
    }
    let [first, second] = ["first", "second"].map(|name| folder.path().join(name));
    match recover(&path, &first, &|| false) {
        Ok(recovered) => {
            said.extend(recovered.lost.iter().map(|lost| format!("{}\n", lost.why)));
            let again = recover(&first, &second, &|| false).expect("what was recovered is a log");
            assert!(again.complete && again.lost.is_empty(), "{again:?}");
            let read = |path: &Path| fs::read(path).expect("a file");
            assert!(read(&first) == read(&second), "recovered twice, it is another");
        }
        Err(error) => said.push_str(&error.to_string()),
    }
    said.replace(&here, "")
}

/// A file of one chunk of these records, uncompressed and without a checksum, that then breaks off.
fn in_a_chunk(records: &[u8]) -> Vec<u8> {
    let length = records.len() as u64;
    let mut chunk = vec![0; 16];
    chunk.extend_from_slice(&length.to_le_bytes());
    chunk.extend_from_slice(&[0; 8]);
    chunk.extend_from_slice(&length.to_le_bytes());
    chunk.extend_from_slice(records);
    let mut file = MAGIC.to_vec();
    // A header without profile and library comes first.
    push(&mut file, HEADER, &[0; 8]);
    push(&mut file, CHUNK, &chunk);
    file
}

fn push(records: &mut Vec<u8>, opcode: u8, body: &[u8]) {
    records.push(opcode);
    records.extend_from_slice(&(body.len() as u64).to_le_bytes());
    records.extend_from_slice(body);
}

/// The first records in the chunks of the log `file`, of at most `most` bytes together.
///
/// # Panics
/// If it is no sound log.
pub fn records_of(file: &[u8], most: usize) -> Vec<u8> {
    let mut found = Vec::new();
    for (_, body) in Records::new(&file[MAGIC.len()..]).filter(|(opcode, _)| *opcode == CHUNK) {
        let head = ChunkHead::parse(&body[..body.len().min(ChunkHead::MAX)]).expect("a chunk");
        let mut records = Vec::new();
        unpack(&head, &body[head.data_start..], &mut records).expect("a sound chunk");
        for (opcode, body) in Records::new(&records) {
            if found.len() + body.len() + RECORD_PREFIX > most {
                return found;
            }
            push(&mut found, opcode, body);
        }
    }
    found
}
