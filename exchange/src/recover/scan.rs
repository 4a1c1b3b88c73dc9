//! Reading a file that may lie about its lengths.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use engine::record::chunk::{self, CHUNK_LIMIT, ChunkHead, RECORD_PREFIX};
use mcap::records::{Record, op};

use super::error::RecoverError;
use crate::Stop;

/// Bytes searched at a time for the next record.
const WINDOW: u64 = 1 << 20;

/// The damaged log.
pub(super) struct Input<'s> {
    path: PathBuf,
    file: File,
    length: u64,
    stop: Stop<'s>,
}

impl<'s> Input<'s> {
    pub(super) fn open(path: &Path, stop: Stop<'s>) -> Result<Self, RecoverError> {
        let file = File::open(path).map_err(|e| RecoverError::io(path, "open", e))?;
        let length = file.metadata().map_err(|e| RecoverError::io(path, "read", e))?.len();
        Ok(Self { path: path.to_owned(), file, length, stop })
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    pub(super) fn length(&self) -> u64 {
        self.length
    }

    /// `count` bytes from `at`, fewer at the end of the file. All reading goes through here, so that here is
    /// the place to ask whether to stop.
    pub(super) fn bytes(&mut self, at: u64, count: u64) -> Result<Vec<u8>, RecoverError> {
        if (self.stop)() {
            return Err(RecoverError::Stopped);
        }
        let mut bytes = Vec::new();
        let count = count.min(self.length.saturating_sub(at));
        self.file
            .seek(SeekFrom::Start(at))
            .and_then(|_| (&self.file).take(count).read_to_end(&mut bytes))
            .map_err(|e| RecoverError::io(&self.path, "read", e))?;
        Ok(bytes)
    }

    /// Opcode and length of the record at `at`, if it fits into the file.
    pub(super) fn head(&mut self, at: u64) -> Result<Option<(u8, u64)>, RecoverError> {
        let bytes = self.bytes(at, RECORD_PREFIX as u64)?;
        Ok(fitting(&bytes, self.length.saturating_sub(at)))
    }

    /// Opcode and body of the record at `at`, if it fits into the file and into memory.
    pub(super) fn record(&mut self, at: u64) -> Result<Option<(u8, Vec<u8>)>, RecoverError> {
        match self.head(at)? {
            Some((opcode, length)) if length <= CHUNK_LIMIT => {
                Ok(Some((opcode, self.bytes(at + RECORD_PREFIX as u64, length)?)))
            }
            _ => Ok(None),
        }
    }

    /// The first place from `at` on where a record stands that cannot be mistaken.
    ///
    /// Only records whose lengths agree with each other count: chunks, message indexes,
    /// attachments, metadata and the end of the data. A chance agreement in compressed bytes
    /// takes more than eight bytes in a row to be right.
    pub(super) fn next_record(&mut self, at: u64) -> Result<Option<u64>, RecoverError> {
        const OVERLAP: u64 = (RECORD_PREFIX + ChunkHead::MAX) as u64;
        let mut start = at;
        while start < self.length {
            let window = self.bytes(start, WINDOW + OVERLAP)?;
            for i in 0..window.len().min(WINDOW as usize) {
                let place = start + i as u64;
                let Some((opcode, length)) = fitting(&window[i..], self.length - place) else {
                    continue;
                };
                let body = &window[(i + RECORD_PREFIX).min(window.len())..];
                if self.is_certain(opcode, length, body, place)? {
                    return Ok(Some(place));
                }
            }
            start += WINDOW;
        }
        Ok(None)
    }

    fn is_certain(
        &mut self,
        opcode: u8,
        length: u64,
        body: &[u8],
        at: u64,
    ) -> Result<bool, RecoverError> {
        Ok(match opcode {
            op::CHUNK => ChunkHead::parse(body).is_some_and(|head| {
                head.compressed_size.checked_add(head.data_start as u64) == Some(length)
            }),
            op::DATA_END => length == 4,
            op::MESSAGE_INDEX | op::ATTACHMENT | op::METADATA if length <= CHUNK_LIMIT => {
                match self.record(at)? {
                    Some((opcode, body)) => parse(opcode, &body).is_some(),
                    None => false,
                }
            }
            _ => false,
        })
    }

    /// Where the summary section starts, if the end of the file says so.
    pub(super) fn summary_start(&mut self) -> Result<Option<u64>, RecoverError> {
        const FOOTER: u64 = RECORD_PREFIX as u64 + 20;
        let end = FOOTER + mcap::MAGIC.len() as u64;
        let Some(at) = self.length.checked_sub(end) else {
            return Ok(None);
        };
        Ok(match self.record(at)? {
            Some((op::FOOTER, body)) => match parse(op::FOOTER, &body) {
                Some(Record::Footer(footer)) if footer.summary_start != 0 => {
                    Some(footer.summary_start)
                }
                _ => None,
            },
            _ => None,
        })
    }

    /// Whether the file ends with a footer and the mark.
    pub(super) fn ends_as_finished(&mut self) -> Result<bool, RecoverError> {
        let mark = mcap::MAGIC.len() as u64;
        let end = self.bytes(self.length.saturating_sub(mark), mark)?;
        Ok(end == mcap::MAGIC && self.summary_start()?.is_some())
    }
}

fn fitting(bytes: &[u8], left: u64) -> Option<(u8, u64)> {
    let (&opcode, length) = bytes.get(..RECORD_PREFIX)?.split_first()?;
    let length = u64::from_le_bytes(length.try_into().ok()?);
    let known = matches!(opcode, op::HEADER..=op::DATA_END | 0x80..);
    (known && length <= left - RECORD_PREFIX as u64).then_some((opcode, length))
}

/// Parses a record whose inner lengths fill its body exactly; `None` for a damaged one.
pub(super) fn parse(opcode: u8, body: &[u8]) -> Option<Record<'_>> {
    // the parser relies on an attachment's checksum being there
    if opcode == op::ATTACHMENT && attachment_length(body) != Some(body.len() as u64) {
        return None;
    }
    let record = chunk::parse_record(opcode, body).ok()?;
    let length = match &record {
        Record::Header(header) => 8 + header.profile.len() + header.library.len(),
        Record::Footer(_) => 20,
        Record::Schema { header, data } => {
            14 + header.name.len() + header.encoding.len() + data.len()
        }
        Record::Channel(channel) => {
            16 + channel.topic.len() + channel.message_encoding.len() + map(&channel.metadata)
        }
        Record::MessageIndex(index) => 6 + 16 * index.records.len(),
        Record::Metadata(record) => 8 + record.name.len() + map(&record.metadata),
        Record::DataEnd(_) => 4,
        Record::Chunk { .. } => return None,
        _ => body.len(),
    };
    (length == body.len()).then_some(record)
}

fn map(entries: &std::collections::BTreeMap<String, String>) -> usize {
    entries.iter().map(|(key, value)| 8 + key.len() + value.len()).sum()
}

/// The length of an attachment by its inner lengths (bytes).
fn attachment_length(body: &[u8]) -> Option<u64> {
    let text = |at: usize| {
        let length = u32::from_le_bytes(body.get(at..at.checked_add(4)?)?.try_into().ok()?);
        at.checked_add(4)?.checked_add(length as usize)
    };
    let data = text(text(16)?)?;
    let length = u64::from_le_bytes(body.get(data..data.checked_add(8)?)?.try_into().ok()?);
    (data as u64 + 8).checked_add(length)?.checked_add(4)
}
