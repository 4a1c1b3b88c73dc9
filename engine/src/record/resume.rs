//! Copying the messages of an interrupted log into a new one, up to a checkpoint.

use std::fs::File;
use std::io::{BufReader, Read};
use std::path::{Path, PathBuf};

use mcap::records::{Record, op};

use super::chunk::{self, CHUNK_LIMIT, ChunkHead, RECORD_PREFIX, Records};
use super::error::RecordError;
use super::file::LogFile;

/// Copies the first `needed` messages of the log at `source`; they must lie at or before `step`.
///
/// The old log may end anywhere, and may be a finished one. It is read one chunk at a time.
pub(super) fn copy_messages(
    source: &Path,
    to: &mut LogFile,
    needed: u64,
    step: u64,
) -> Result<(), RecordError> {
    let missing = |to: &LogFile| RecordError::Missing {
        path: source.to_owned(),
        step,
        needed,
        found: to.messages(),
    };
    let mut chunks = Chunks::open(source)?;
    while to.messages() < needed {
        let Some(offset) = chunks.next()? else {
            return Err(missing(to));
        };
        let damaged = |why: String| RecordError::Damaged { path: source.to_owned(), offset, why };
        for (opcode, body) in Records::new(&chunks.records) {
            if to.messages() == needed {
                break;
            }
            match chunk::parse_record(opcode, body).map_err(|e| damaged(e.to_string()))? {
                Record::Channel(channel) => {
                    let same = usize::from(channel.id)
                        .checked_sub(1)
                        .and_then(|i| to.definitions.get(i))
                        .is_some_and(|own| own.topic == channel.topic);
                    if !same {
                        return Err(other_run(source, format!("topic {}", channel.topic)));
                    }
                }
                Record::Schema { header, data } => {
                    let same = to
                        .definitions
                        .iter()
                        .any(|own| own.schema == header.name && own.descriptor == *data);
                    if !same {
                        return Err(other_run(source, format!("schema {}", header.name)));
                    }
                }
                Record::Message { header, data } if u64::from(header.sequence) <= step => {
                    to.write(header.channel_id, (header.sequence, header.log_time), &data)?;
                }
                Record::Message { .. } => return Err(missing(to)),
                _ => {}
            }
        }
    }
    Ok(())
}

fn other_run(path: &Path, what: String) -> RecordError {
    RecordError::OtherRun { path: path.to_owned(), what }
}

/// The whole chunks of a log, in order.
struct Chunks {
    path: PathBuf,
    file: BufReader<File>,
    length: u64,
    offset: u64,
    body: Vec<u8>,
    /// The unpacked records of the present chunk.
    records: Vec<u8>,
}

impl Chunks {
    fn open(path: &Path) -> Result<Self, RecordError> {
        let file = File::open(path).map_err(|e| RecordError::io(path, "open", e))?;
        let length = file.metadata().map_err(|e| RecordError::io(path, "read", e))?.len();
        let mut chunks = Self {
            path: path.to_owned(),
            file: BufReader::new(file),
            length,
            offset: 0,
            body: Vec::new(),
            records: Vec::new(),
        };
        let mut magic = [0; mcap::MAGIC.len()];
        if length >= magic.len() as u64 {
            chunks.read(&mut magic)?;
            if magic != mcap::MAGIC {
                return Err(chunks.damaged("not an MCAP file".to_owned()));
            }
        }
        chunks.offset = magic.len() as u64;
        Ok(chunks)
    }

    /// Unpacks the next whole chunk and returns its offset; `None` where the whole ones end.
    fn next(&mut self) -> Result<Option<u64>, RecordError> {
        loop {
            let left = self.length.saturating_sub(self.offset);
            if left < RECORD_PREFIX as u64 {
                return Ok(None);
            }
            let mut prefix = [0; RECORD_PREFIX];
            self.read(&mut prefix)?;
            let [opcode, size @ ..] = prefix;
            let size = u64::from_le_bytes(size);
            // a chunk that was never ended says 2^64 - 1
            if size > left - RECORD_PREFIX as u64 || opcode == op::DATA_END {
                return Ok(None);
            }
            let offset = self.offset;
            if opcode != op::CHUNK {
                self.file
                    .seek_relative(size as i64)
                    .map_err(|e| RecordError::io(&self.path, "read", e))?;
                self.offset += RECORD_PREFIX as u64 + size;
                continue;
            }
            if size > CHUNK_LIMIT {
                return Err(self.damaged(format!("a chunk of {size} bytes")));
            }
            let mut body = std::mem::take(&mut self.body);
            body.resize(size as usize, 0);
            self.read(&mut body)?;
            self.records.clear();
            let unpacked = ChunkHead::parse(&body)
                .ok_or_else(|| "a chunk header that is none".to_owned())
                .and_then(|head| {
                    chunk::unpack(&head, &body[head.data_start..], &mut self.records)
                        .map_err(|e| e.to_string())
                });
            self.body = body;
            unpacked.map_err(|why| self.damaged(why))?;
            self.offset += RECORD_PREFIX as u64 + size;
            return Ok(Some(offset));
        }
    }

    fn read(&mut self, bytes: &mut [u8]) -> Result<(), RecordError> {
        self.file.read_exact(bytes).map_err(|e| RecordError::io(&self.path, "read", e))
    }

    fn damaged(&self, why: String) -> RecordError {
        RecordError::Damaged { path: self.path.clone(), offset: self.offset, why }
    }
}

/// The newest readable form of a log: its partial file, or the finished one.
///
/// Both exist, or only the finished one, when a run was killed between the renames of its files.
pub(super) fn source(names: &[PathBuf; 3]) -> &Path {
    let [finished, partial, _] = names;
    if !partial.exists() && finished.exists() { finished } else { partial }
}
