//! The records of a log from its start to its last whole chunk.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek as _, SeekFrom};
use std::path::{Path, PathBuf};

use engine::record::chunk::{self, CHUNK_LIMIT, ChunkHead, RECORD_PREFIX};
use mcap::records::op;

use super::error::ReadError;

/// A log that is read chunk by chunk.
pub(crate) struct Records {
    path: PathBuf,
    file: BufReader<File>,
    length: u64,
    offset: u64,
    /// The chunk as it stands in the file.
    packed: Vec<u8>,
    /// The records of the present chunk, or the present record beside the chunks.
    present: Vec<u8>,
    complete: bool,
}

impl Records {
    pub(crate) fn open(path: &Path) -> Result<Self, ReadError> {
        let io = |doing| move |source| ReadError::Io { path: path.to_owned(), doing, source };
        let file = File::open(path).map_err(io("open"))?;
        let length = file.metadata().map_err(io("read"))?.len();
        let mut records = Self {
            path: path.to_owned(),
            file: BufReader::new(file),
            length,
            offset: 0,
            packed: Vec::new(),
            present: Vec::new(),
            complete: false,
        };
        let mut magic = [0; mcap::MAGIC.len()];
        if length < magic.len() as u64 {
            return Err(ReadError::NotMcap { path: path.to_owned() });
        }
        records.read(&mut magic)?;
        if magic != mcap::MAGIC {
            return Err(ReadError::NotMcap { path: path.to_owned() });
        }
        records.offset = magic.len() as u64;
        Ok(records)
    }

    /// Goes on to the next chunk or record of interest, and says where it stands (bytes); `None`
    /// where the data ends, or where it stops being whole.
    pub(crate) fn advance(&mut self) -> Result<Option<u64>, ReadError> {
        loop {
            let offset = self.offset;
            let left = self.length.saturating_sub(offset);
            if left < RECORD_PREFIX as u64 {
                return Ok(None);
            }
            let mut prefix = [0; RECORD_PREFIX];
            self.read(&mut prefix)?;
            let [opcode, size @ ..] = prefix;
            let size = u64::from_le_bytes(size);
            if opcode == op::DATA_END {
                self.complete = true;
                return Ok(None);
            }
            // A chunk that was never ended says 2^64 - 1.
            if size > left - RECORD_PREFIX as u64 {
                return Ok(None);
            }
            self.offset += RECORD_PREFIX as u64 + size;
            match opcode {
                op::CHUNK => self.unpack(offset, size)?,
                op::SCHEMA | op::CHANNEL | op::MESSAGE | op::METADATA => {
                    self.hold(offset, &prefix, size)?;
                }
                _ => {
                    self.file.seek_relative(size as i64).map_err(|source| self.io(source))?;
                    continue;
                }
            }
            return Ok(Some(offset));
        }
    }

    /// Lets [`advance`](Self::advance) go on behind what has been read, as far as the file has grown.
    pub(crate) fn grow(&mut self) -> Result<(), ReadError> {
        self.length = self.file.get_ref().metadata().map_err(|source| self.io(source))?.len();
        // The start of a record that was not whole may have been read.
        self.file.seek(SeekFrom::Start(self.offset)).map_err(|source| self.io(source))?;
        Ok(())
    }

    /// The records that [`advance`](Self::advance) came to.
    pub(crate) fn present(&self) -> chunk::Records<'_> {
        chunk::Records::new(&self.present)
    }

    /// Whether the end of the data was reached: only a finished log has one.
    pub(crate) fn complete(&self) -> bool {
        self.complete
    }

    fn unpack(&mut self, offset: u64, size: u64) -> Result<(), ReadError> {
        self.refuse_too_large(offset, size)?;
        let mut packed = std::mem::take(&mut self.packed);
        packed.resize(size as usize, 0);
        self.read(&mut packed)?;
        self.present.clear();
        let head = ChunkHead::parse(&packed)
            .ok_or_else(|| self.damaged(offset, "a chunk header that is none".to_owned()))?;
        chunk::unpack(&head, &packed[head.data_start..], &mut self.present)
            .map_err(|error| self.damaged(offset, error.to_string()))?;
        self.packed = packed;
        Ok(())
    }

    /// Holds one record that stands beside the chunks.
    fn hold(&mut self, offset: u64, prefix: &[u8], size: u64) -> Result<(), ReadError> {
        self.refuse_too_large(offset, size)?;
        let mut present = std::mem::take(&mut self.present);
        present.clear();
        present.extend_from_slice(prefix);
        present.resize(RECORD_PREFIX + size as usize, 0);
        self.read(&mut present[RECORD_PREFIX..])?;
        self.present = present;
        Ok(())
    }

    fn refuse_too_large(&self, offset: u64, size: u64) -> Result<(), ReadError> {
        match size > CHUNK_LIMIT {
            true => Err(self.damaged(offset, format!("a record of {size} bytes"))),
            false => Ok(()),
        }
    }

    fn read(&mut self, bytes: &mut [u8]) -> Result<(), ReadError> {
        self.file.read_exact(bytes).map_err(|source| self.io(source))
    }

    fn io(&self, source: io::Error) -> ReadError {
        ReadError::Io { path: self.path.clone(), doing: "read", source }
    }

    fn damaged(&self, offset: u64, why: String) -> ReadError {
        ReadError::Damaged { path: self.path.clone(), offset, why }
    }
}
