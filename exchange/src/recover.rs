//! Saving what is readable of a damaged or unfinished log.
//!
//! A log that was killed, cut or damaged has lost its index, and most readers stop at the first
//! bad chunk. Here a damaged chunk is skipped and reading goes on with the next record that can
//! be one, found by searching if a length was damaged. A chunk cut short at the end of the file
//! counts as far as it unpacks. The result is a complete, indexed log; attachments, metadata and
//! chunk boundaries are kept, so that an undamaged log comes out as it went in.

mod error;
mod output;
mod scan;
#[cfg(test)]
mod tests;

use std::fs::{self, OpenOptions};
use std::path::{Path, PathBuf};

use engine::record::chunk::{self, CHUNK_LIMIT, ChunkHead, RECORD_PREFIX, Records};
use mcap::records::{Header, Record, op};

use crate::Stop;
pub use error::RecoverError;
use output::{Definitions, Output};
use scan::Input;

/// What became of a log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recovered {
    /// Messages in the new log.
    pub messages: u64,
    /// Chunks they were read from.
    pub chunks: u64,
    /// What could not be read, in order, adjoining places joined.
    pub lost: Vec<Lost>,
    /// Whether the input was a finished log: one that ends as it should.
    pub complete: bool,
}

/// A part of the input that did not make it, or not wholly.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Lost {
    /// Where it starts (bytes).
    pub offset: u64,
    /// Its length (bytes).
    pub bytes: u64,
    /// What is wrong with it.
    pub why: String,
}

/// Writes everything readable of the log `input` to a new log `output`.
///
/// The output appears under its name when it is complete. Memory stays below a few times
/// [`CHUNK_LIMIT`], whatever lengths the input declares.
///
/// # Errors
/// `output` exists, `input` is no MCAP file at all, the file system's refusal, or `stop` said so between two
/// reads. Damage is not an error: it is in [`Recovered::lost`].
pub fn recover(input: &Path, output: &Path, stop: Stop<'_>) -> Result<Recovered, RecoverError> {
    if output.symlink_metadata().is_ok() {
        return Err(RecoverError::OutputExists { path: output.to_owned() });
    }
    let mut name = output.as_os_str().to_owned();
    name.push(".recovering");
    let working = PathBuf::from(name);
    let result = copy(input, &working, stop).and_then(|recovered| {
        let file = OpenOptions::new().write(true).open(&working);
        file.and_then(|file| file.sync_all()).map_err(|e| RecoverError::io(&working, "sync", e))?;
        fs::rename(&working, output).map_err(|e| RecoverError::io(output, "rename to", e))?;
        Ok(recovered)
    });
    if result.is_err() {
        // best effort: the error to report is the first one
        drop(fs::remove_file(&working));
    }
    result
}

/// Writes everything readable of `input` to `working`.
fn copy(input: &Path, working: &Path, stop: Stop<'_>) -> Result<Recovered, RecoverError> {
    let mut input = Input::open(input, stop)?;
    let mut recovery = Recovery::new(&mut input, working)?;
    recovery.run()?;
    recovery.finish()
}

struct Recovery<'a, 's> {
    input: &'a mut Input<'s>,
    output: Output,
    marked: bool,
    chunks: u64,
    lost: Vec<Lost>,
    complete: bool,
    /// The unpacked records of the present chunk.
    records: Vec<u8>,
}

impl<'a, 's> Recovery<'a, 's> {
    fn new(input: &'a mut Input<'s>, working: &Path) -> Result<Self, RecoverError> {
        let marked = input.bytes(0, mcap::MAGIC.len() as u64)? == mcap::MAGIC;
        let start = if marked { mcap::MAGIC.len() as u64 } else { 0 };
        // before anything is created for a file that is something else
        if !marked && input.next_record(start)?.is_none() {
            return Err(RecoverError::NotMcap { path: input.path().to_owned() });
        }
        let header = match input.record(mcap::MAGIC.len() as u64)? {
            Some((opcode, body)) => match scan::parse(opcode, &body) {
                Some(Record::Header(header)) => Some(header),
                _ => None,
            },
            None => None,
        };
        let header = header
            .unwrap_or_else(|| Header { profile: String::new(), library: "plunge".to_owned() });
        let spare = Definitions::of_summary(input)?;
        let complete = input.ends_as_finished()?;
        let output = Output::create(working, header, spare)?;
        Ok(Self {
            input,
            output,
            marked,
            chunks: 0,
            lost: Vec::new(),
            complete,
            records: Vec::new(),
        })
    }

    fn run(&mut self) -> Result<(), RecoverError> {
        let mut at = if self.marked { mcap::MAGIC.len() as u64 } else { 0 };
        if !self.marked {
            let next = self.input.next_record(0)?.unwrap_or(0);
            self.lose(0, next, "no mark of an MCAP file".to_owned());
            at = next;
        }
        while at < self.input.length() {
            let next = match self.input.head(at)? {
                Some((op::DATA_END, 4)) => return Ok(()),
                Some((_, length)) => {
                    let end = at + RECORD_PREFIX as u64 + length;
                    if self.take(at, length)? { Some(end) } else { None }
                }
                None => None,
            };
            at = match next {
                Some(next) => next,
                None => self.skip_damage(at)?,
            };
        }
        Ok(())
    }

    /// Takes over a record that fits into the file; `false` if it is damaged.
    fn take(&mut self, at: u64, length: u64) -> Result<bool, RecoverError> {
        let start = self.input.bytes(at, RECORD_PREFIX as u64 + ChunkHead::MAX as u64)?;
        let opcode = start[0];
        if let Some(head) = ChunkHead::parse(&start[RECORD_PREFIX..])
            && head.compressed_size.checked_add(head.data_start as u64) == Some(length)
        {
            // whatever its opcode: nothing else looks like this
            return self.chunk(at, &head);
        }
        if length > CHUNK_LIMIT {
            return Ok(false);
        }
        let Some((_, body)) = self.input.record(at)? else {
            return Ok(false);
        };
        match scan::parse(opcode, &body) {
            // Logs are written in chunks or without: this is an index with a damaged opcode.
            Some(Record::Message { .. } | Record::Channel(_) | Record::Schema { .. })
                if self.chunks > 0 =>
            {
                Ok(false)
            }
            Some(record) => {
                self.output.record(&record, &body)?;
                Ok(true)
            }
            None => Ok(false),
        }
    }

    /// Takes over a whole chunk; `false` if it does not unpack to what its checksum says.
    fn chunk(&mut self, at: u64, head: &ChunkHead) -> Result<bool, RecoverError> {
        if head.compressed_size > CHUNK_LIMIT || head.uncompressed_size > CHUNK_LIMIT {
            return Ok(false);
        }
        let from = at + (RECORD_PREFIX + head.data_start) as u64;
        let packed = self.input.bytes(from, head.compressed_size)?;
        self.records.clear();
        if packed.len() as u64 != head.compressed_size
            || chunk::unpack(head, &packed, &mut self.records).is_err()
        {
            return Ok(false);
        }
        self.emit(at, from - at + head.compressed_size)?;
        Ok(true)
    }

    /// Deals with damage at `at` and returns where reading can go on.
    fn skip_damage(&mut self, at: u64) -> Result<u64, RecoverError> {
        let next = self.input.next_record(at + 1)?;
        let end = next.unwrap_or(self.input.length());
        let start = self.input.bytes(at, (RECORD_PREFIX + ChunkHead::MAX) as u64)?;
        let head =
            start.get(RECORD_PREFIX..).filter(|_| start[0] == op::CHUNK).and_then(ChunkHead::parse);
        let Some(head) = head else {
            self.lose(at, end - at, "damaged record".to_owned());
            return Ok(end);
        };
        let from = at + (RECORD_PREFIX + head.data_start) as u64;
        let room = end.saturating_sub(from);
        // a damaged length of the record, or of its content, beside a chunk that is whole
        for compressed_size in [head.compressed_size, room] {
            if compressed_size <= room && head.crc != 0 {
                let head = ChunkHead { compressed_size, ..head.clone() };
                if self.chunk(at, &head)? {
                    let after = from + compressed_size;
                    if after < end {
                        self.lose(after, end - after, "damaged record".to_owned());
                    }
                    return Ok(end);
                }
            }
        }
        // Only a chunk that claims to go on behind the end of the file was cut; its checksum is that of
        // the whole, so what unpacks of it cannot be checked. One that is all there and does not
        // match its checksum is damaged, and nothing of it can be trusted.
        let is_cut = next.is_none() && head.compressed_size > room;
        if !is_cut {
            self.lose(at, end - at, "damaged chunk".to_owned());
        } else {
            let packed = self.input.bytes(from, room.min(CHUNK_LIMIT))?;
            let open = ChunkHead { crc: 0, uncompressed_size: CHUNK_LIMIT, ..head };
            self.records.clear();
            // the error only says where the readable part ends
            drop(chunk::unpack(&open, &packed, &mut self.records));
            let before = self.output.messages();
            self.emit(at, end - at)?;
            let saved = self.output.messages() - before;
            self.lose(at, end - at, format!("chunk cut short, {saved} of its messages saved"));
        }
        Ok(end)
    }

    /// Writes the unpacked records and ends the chunk where it ended in the input.
    fn emit(&mut self, at: u64, bytes: u64) -> Result<(), RecoverError> {
        let mut orphans = 0_u64;
        for (opcode, body) in Records::new(&self.records) {
            let taken = match scan::parse(opcode, body) {
                Some(record) => self.output.record(&record, body)?,
                None => false,
            };
            orphans += u64::from(!taken);
        }
        self.output.end_chunk()?;
        self.chunks += 1;
        if orphans > 0 {
            let why = format!("{orphans} records whose channel or schema is lost or contradictory");
            self.lose(at, bytes, why);
        }
        Ok(())
    }

    fn lose(&mut self, offset: u64, bytes: u64, why: String) {
        match self.lost.last_mut() {
            Some(last) if last.offset + last.bytes == offset && last.why == why => {
                last.bytes += bytes;
            }
            _ => self.lost.push(Lost { offset, bytes, why }),
        }
    }

    fn finish(self) -> Result<Recovered, RecoverError> {
        let messages = self.output.messages();
        self.output.finish()?;
        Ok(Recovered { messages, chunks: self.chunks, lost: self.lost, complete: self.complete })
    }
}
