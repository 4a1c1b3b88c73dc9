//! One file of the log: its writer, its flush points and its names.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};

use mcap::records::MessageHeader;
use mcap::{Compression, WriteOptions, Writer};

use super::error::RecordError;

/// Where a message stands in the run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stamp {
    /// Step, counted from 0.
    pub step: u64,
    /// Simulated time since the start of the run (s).
    pub time_s: f64,
}

impl Stamp {
    /// The step as the 32-bit sequence number and the time in whole nanoseconds.
    pub(super) fn encode(self) -> Result<(u32, u64), RecordError> {
        let Self { step, time_s } = self;
        // viewers keep seconds in 32 bits
        match u32::try_from(step) {
            Ok(sequence) if (0.0..4_294_967_295.0).contains(&time_s) => {
                Ok((sequence, (time_s * 1e9).round() as u64))
            }
            _ => Err(RecordError::OutOfRange { step, time_s }),
        }
    }
}

/// A channel to define: topic, schema name, descriptor.
pub(super) struct Definition {
    pub(super) topic: String,
    pub(super) schema: String,
    pub(super) descriptor: Vec<u8>,
}

/// How a file is cut into chunks.
pub(super) struct Cut {
    /// A chunk ends after the last message of every multiple of these steps.
    pub(super) every: Vec<u64>,
    /// A chunk ends when its messages exceed this (bytes).
    pub(super) chunk_bytes: u64,
}

/// A log file being written.
///
/// The bytes are a function of the definitions, the messages and `Cut` alone. Chunk boundaries
/// are part of the bytes, hence the rule for flushing: when a message of a later step arrives,
/// see whether a multiple of `every` lies in between. A copy of the messages then cuts itself at
/// the same places.
pub(super) struct LogFile {
    /// Gone after an error, so that nothing more is written to a broken file, not even on drop.
    writer: Option<Writer<BufWriter<Disk>>>,
    sync: File,
    cut: Cut,
    last_step: Option<u64>,
    messages: u64,
    /// Messages after the last flush.
    unflushed: bool,
    /// The name the bytes go to now: `partial`, or a name beside it until a resumed log holds
    /// durably what the old one did.
    working: PathBuf,
    partial: PathBuf,
    finished: PathBuf,
    pub(super) definitions: Vec<Definition>,
}

impl LogFile {
    /// Names for `name` in `dir`: finished, partial, and partial of a resumed run.
    pub(super) fn names(dir: &Path, name: &str) -> [PathBuf; 3] {
        ["", ".partial", ".partial.new"].map(|suffix| dir.join(format!("{name}{suffix}")))
    }

    /// Opens `working` for the log `name` in `dir`, empty.
    pub(super) fn create(
        dir: &Path,
        name: &str,
        working: &Path,
        cut: Cut,
    ) -> Result<Self, RecordError> {
        let [finished, partial, _] = Self::names(dir, name);
        let file = File::create(working).map_err(|e| RecordError::io(working, "create", e))?;
        let sync = file.try_clone().map_err(|e| RecordError::io(working, "open", e))?;
        let writer = WriteOptions::new()
            .compression(Some(Compression::Zstd))
            // the pool of the compressor would compete with the solver's
            .compression_threads(0)
            .chunk_size(Some(cut.chunk_bytes))
            .library("plunge")
            .create(BufWriter::new(Disk(file)))
            .map_err(|e| RecordError::mcap(working, e))?;
        Ok(Self {
            writer: Some(writer),
            sync,
            cut,
            last_step: None,
            messages: 0,
            unflushed: false,
            working: working.to_owned(),
            partial,
            finished,
            definitions: Vec::new(),
        })
    }

    /// Adds a channel; its identifiers are its place in the order of definition.
    pub(super) fn define(&mut self, definition: Definition) -> Result<u16, RecordError> {
        let id = self.with(|writer| {
            let schema =
                writer.add_schema(&definition.schema, "protobuf", &definition.descriptor)?;
            writer.add_channel(schema, &definition.topic, "protobuf", &BTreeMap::new())
        })?;
        self.definitions.push(definition);
        Ok(id)
    }

    /// Writes through the container's writer and closes the file if that fails.
    pub(super) fn with<T>(
        &mut self,
        write: impl FnOnce(&mut Writer<BufWriter<Disk>>) -> mcap::McapResult<T>,
    ) -> Result<T, RecordError> {
        let Some(writer) = &mut self.writer else {
            return Err(RecordError::Closed { path: self.working.clone() });
        };
        write(writer).map_err(|error| {
            self.abandon();
            RecordError::mcap(&self.working, error)
        })
    }

    /// Writes one message.
    pub(super) fn write(
        &mut self,
        channel_id: u16,
        (sequence, log_time): (u32, u64),
        data: &[u8],
    ) -> Result<(), RecordError> {
        let step = u64::from(sequence);
        if let Some(last) = self.last_step {
            if step < last {
                return Err(RecordError::StepOrder { path: self.working.clone(), step, last });
            }
            if self.cut.every.iter().any(|&every| passes_multiple(every, last, step)) {
                self.flush()?;
            }
        }
        let header = MessageHeader { channel_id, sequence, log_time, publish_time: log_time };
        self.with(|writer| writer.write_to_known_channel(&header, data))?;
        self.last_step = Some(step);
        self.messages += 1;
        self.unflushed = true;
        Ok(())
    }

    pub(super) fn last_step(&self) -> Option<u64> {
        self.last_step
    }

    pub(super) fn messages(&self) -> u64 {
        self.messages
    }

    /// Ends the chunk and brings everything written so far to the disk.
    pub(super) fn flush(&mut self) -> Result<(), RecordError> {
        if self.unflushed {
            self.with(|writer| writer.flush())?;
            self.sync.sync_data().map_err(|e| RecordError::io(&self.working, "sync", e))?;
            self.unflushed = false;
        }
        // only now does a resumed log hold durably what the old one does
        if self.working != self.partial && self.writer.is_some() {
            rename(&self.working, &self.partial)?;
            self.working.clone_from(&self.partial);
        }
        Ok(())
    }

    /// Writes the summary section and brings the file to the disk, under its working name.
    pub(super) fn close(&mut self) -> Result<(), RecordError> {
        self.with(|writer| writer.finish().map(drop))?;
        self.abandon();
        self.sync.sync_all().map_err(|e| RecordError::io(&self.working, "sync", e))
    }

    /// Gives a closed file its final name.
    pub(super) fn publish(&mut self) -> Result<(), RecordError> {
        rename(&self.working, &self.finished)?;
        if self.working != self.partial && self.partial.exists() {
            fs::remove_file(&self.partial)
                .map_err(|e| RecordError::io(&self.partial, "remove", e))?;
        }
        Ok(())
    }

    /// Lets go of the writer without its writing anything more.
    fn abandon(&mut self) {
        drop(self.writer.take().map(Writer::into_inner));
    }
}

/// The file on the disk. Tests let the disk be full from some byte on.
pub(super) struct Disk(File);

impl io::Write for Disk {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        #[cfg(test)]
        let bytes = tests::with_room(bytes)?;
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

impl io::Seek for Disk {
    fn seek(&mut self, to: io::SeekFrom) -> io::Result<u64> {
        self.0.seek(to)
    }
}

/// Whether a positive multiple of `every` lies in `last..step`.
fn passes_multiple(every: u64, last: u64, step: u64) -> bool {
    step > last && {
        let multiple = (step - 1) / every * every;
        multiple > 0 && multiple >= last
    }
}

fn rename(from: &Path, to: &Path) -> Result<(), RecordError> {
    fs::rename(from, to).map_err(|e| RecordError::io(from, "rename", e))
}

#[cfg(test)]
pub(super) mod tests {
    use std::cell::Cell;
    use std::io;

    use super::passes_multiple;

    thread_local! {
        /// Bytes for which the disk of this thread has room.
        pub(in super::super) static ROOM: Cell<u64> = const { Cell::new(u64::MAX) };
    }

    /// What of `bytes` the disk still takes.
    pub(super) fn with_room(bytes: &[u8]) -> io::Result<&[u8]> {
        let room = ROOM.get();
        let taken = bytes.len().min(usize::try_from(room).unwrap_or(usize::MAX));
        ROOM.set(room - taken as u64);
        match taken {
            0 if !bytes.is_empty() => Err(io::ErrorKind::StorageFull.into()),
            _ => Ok(&bytes[..taken]),
        }
    }

    #[test]
    fn a_chunk_ends_after_the_last_message_of_each_multiple_and_never_after_step_zero() {
        assert!(!passes_multiple(10, 0, 1));
        assert!(!passes_multiple(10, 0, 10));
        assert!(passes_multiple(10, 0, 11));
        assert!(passes_multiple(10, 10, 11));
        assert!(!passes_multiple(10, 10, 10));
        assert!(!passes_multiple(10, 11, 20));
        assert!(passes_multiple(10, 11, 45), "thinned logs may jump over several multiples");
    }
}
