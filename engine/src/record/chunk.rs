//! Reading the records of a log, chunk by chunk, without trusting a length.

use mcap::McapError;
use mcap::records::{Record, op};
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};

/// The most a chunk may hold, compressed or not (bytes); a log's own chunks are 64 times smaller.
pub const CHUNK_LIMIT: u64 = 256 << 20;

/// Bytes before the body of a record: its opcode and its length.
pub const RECORD_PREFIX: usize = 9;

/// What the header of a chunk record says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChunkHead {
    /// Size of the records when unpacked (bytes); all ones in a chunk that was never ended.
    pub uncompressed_size: u64,
    /// Checksum of the unpacked records; 0 if there is none.
    pub crc: u32,
    /// `zstd`, or empty.
    pub compression: String,
    /// Size of the packed records (bytes); all ones in a chunk that was never ended.
    pub compressed_size: u64,
    /// Where the packed records start in the body of the record (bytes).
    pub data_start: usize,
}

impl ChunkHead {
    /// Longest header in a body: the fixed fields and the name of a compression we can read.
    pub const MAX: usize = 44;

    /// Reads the start of a chunk record's body; `None` if it cannot be one.
    pub fn parse(body: &[u8]) -> Option<Self> {
        let long = |at: usize| Some(u64::from_le_bytes(body.get(at..at + 8)?.try_into().ok()?));
        let short = |at: usize| Some(u32::from_le_bytes(body.get(at..at + 4)?.try_into().ok()?));
        let name_length = short(28)? as usize;
        if name_length > Self::MAX - 40 {
            return None;
        }
        let compression = std::str::from_utf8(body.get(32..32 + name_length)?).ok()?;
        matches!(compression, "" | "zstd").then(|| {
            Some(Self {
                uncompressed_size: long(16)?,
                crc: short(24)?,
                compression: compression.to_owned(),
                compressed_size: long(32 + name_length)?,
                data_start: 40 + name_length,
            })
        })?
    }
}

/// Appends to `records` the unpacked records of a chunk, given its packed bytes.
///
/// With a checksum in the head, nothing is appended before the whole chunk has been checked.
/// Without one (`crc` 0), everything up to the first error is appended: as far as a cut chunk
/// unpacks.
///
/// # Errors
/// Whatever ended the reading early: a bad checksum, bad compression, a bad length, an early end.
/// Sizes above [`CHUNK_LIMIT`] are refused before memory is taken for them.
pub fn unpack(head: &ChunkHead, packed: &[u8], records: &mut Vec<u8>) -> Result<(), McapError> {
    if head.uncompressed_size > CHUNK_LIMIT {
        return Err(McapError::ChunkTooLarge(head.uncompressed_size));
    }
    // the reader takes a file's records, so the chunk is presented as a file of one
    let mut prefix = Vec::with_capacity(RECORD_PREFIX + ChunkHead::MAX);
    let length = (head.data_start + packed.len()) as u64;
    prefix.push(op::CHUNK);
    prefix.extend_from_slice(&length.to_le_bytes());
    prefix.extend_from_slice(&[0; 16]);
    prefix.extend_from_slice(&head.uncompressed_size.to_le_bytes());
    prefix.extend_from_slice(&head.crc.to_le_bytes());
    prefix.extend_from_slice(&(head.compression.len() as u32).to_le_bytes());
    prefix.extend_from_slice(head.compression.as_bytes());
    prefix.extend_from_slice(&(packed.len() as u64).to_le_bytes());

    let mut reader = LinearReader::new_with_options(
        LinearReaderOptions::default()
            .with_skip_start_magic(true)
            .with_skip_end_magic(true)
            .with_validate_chunk_crcs(true)
            .with_prevalidate_chunk_crcs(true)
            .with_record_length_limit(CHUNK_LIMIT as usize),
    );
    let mut sources = [prefix.as_slice(), packed];
    while let Some(event) = reader.next_event() {
        match event? {
            LinearReadEvent::ReadRequest(wanted) => {
                let [first, rest] = &mut sources;
                let source = if first.is_empty() { rest } else { first };
                let (now, later) = source.split_at(wanted.min(source.len()));
                reader.insert(now.len()).copy_from_slice(now);
                reader.notify_read(now.len());
                *source = later;
            }
            LinearReadEvent::Record { opcode, data } => {
                // a head without a checksum may say less than there is
                if (records.len() + data.len()) as u64 > CHUNK_LIMIT {
                    return Err(McapError::ChunkTooLarge(head.uncompressed_size));
                }
                records.push(opcode);
                records.extend_from_slice(&(data.len() as u64).to_le_bytes());
                records.extend_from_slice(data);
            }
        }
    }
    Ok(())
}

/// Parses a record as [`mcap::parse_record`] does, and takes no memory for a text that is longer than the record:
/// a length of a few bytes can say four gigabytes.
///
/// # Errors
/// If the record is cut or damaged.
pub fn parse_record(opcode: u8, body: &[u8]) -> Result<Record<'_>, McapError> {
    match texts_fit(opcode, body) {
        Some(()) => mcap::parse_record(opcode, body),
        None => Err(McapError::UnexpectedEof),
    }
}

/// Whether every text of a record lies in its body.
fn texts_fit(opcode: u8, body: &[u8]) -> Option<()> {
    // Bytes before the texts, how many texts, and whether a map of texts follows them.
    let (start, texts, map) = match opcode {
        op::HEADER => (0, 2, false),
        op::SCHEMA => (2, 2, false),
        op::CHANNEL => (4, 2, true),
        op::CHUNK => (28, 1, false),
        op::CHUNK_INDEX => (length_at(body, 32)?.checked_add(44)?, 1, false),
        op::ATTACHMENT => (16, 2, false),
        op::ATTACHMENT_INDEX => (40, 2, false),
        op::METADATA => (0, 1, true),
        op::METADATA_INDEX => (16, 1, false),
        _ => return Some(()),
    };
    let mut at = start;
    for _ in 0..texts {
        at = text_end(body, at)?;
    }
    if map {
        let end = text_end(body, at)?;
        at += 4;
        while at < end {
            at = text_end(body, at)?;
        }
    }
    Some(())
}

/// The length (bytes) that stands at `at`.
fn length_at(body: &[u8], at: usize) -> Option<usize> {
    let bytes = body.get(at..at.checked_add(4)?)?;
    Some(u32::from_le_bytes(bytes.try_into().ok()?) as usize)
}

/// Where the text ends whose length stands at `at`; none if that is behind the body.
fn text_end(body: &[u8], at: usize) -> Option<usize> {
    let end = at.checked_add(4)?.checked_add(length_at(body, at)?)?;
    (end <= body.len()).then_some(end)
}

/// Iterates over records laid end to end, ending at the first incomplete one.
#[derive(Clone, Debug)]
pub struct Records<'a>(&'a [u8]);

impl<'a> Records<'a> {
    /// Over the records in `bytes`, as [`unpack`] leaves them.
    pub fn new(bytes: &'a [u8]) -> Self {
        Self(bytes)
    }
}

impl<'a> Iterator for Records<'a> {
    type Item = (u8, &'a [u8]);

    fn next(&mut self) -> Option<Self::Item> {
        let (prefix, rest) = self.0.split_at_checked(RECORD_PREFIX)?;
        let length = u64::from_le_bytes(prefix[1..].try_into().ok()?);
        let (body, rest) = rest.split_at_checked(usize::try_from(length).ok()?)?;
        self.0 = rest;
        Some((prefix[0], body))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A body of `before` zeros, then the length `length` and nothing behind it.
    fn cut(before: usize, length: u32) -> Vec<u8> {
        [&vec![0; before][..], &length.to_le_bytes()].concat()
    }

    #[test]
    fn a_text_longer_than_its_record_is_refused_before_it_takes_memory() {
        // Of each kind: where a length stands of which nothing follows.
        let places = [
            (op::HEADER, 0),
            (op::HEADER, 4),
            (op::SCHEMA, 2),
            (op::SCHEMA, 6),
            (op::CHANNEL, 4),
            (op::CHANNEL, 8),
            (op::CHANNEL, 12),
            (op::CHUNK, 28),
            (op::CHUNK_INDEX, 44),
            (op::ATTACHMENT, 16),
            (op::ATTACHMENT, 20),
            (op::ATTACHMENT_INDEX, 40),
            (op::METADATA, 0),
            (op::METADATA_INDEX, 16),
        ];
        for (opcode, before) in places {
            for length in [1, 1 << 20, u32::MAX] {
                let body = cut(before, length);
                let found = parse_record(opcode, &body);
                assert!(matches!(found, Err(McapError::UnexpectedEof)), "{opcode} {before}");
            }
        }
        // In a map of eight bytes, a key that is longer.
        let map = [&cut(0, 0)[..], &8_u32.to_le_bytes(), &u32::MAX.to_le_bytes(), &[0; 4]].concat();
        assert!(matches!(parse_record(op::METADATA, &map), Err(McapError::UnexpectedEof)));
        assert!(parse_record(op::METADATA, &[0; 8]).is_ok(), "an empty one is whole");
    }

    #[test]
    fn a_chunk_that_says_more_than_any_may_hold_is_not_unpacked() {
        for crc in [0, 1] {
            let head = ChunkHead {
                uncompressed_size: CHUNK_LIMIT + 1,
                crc,
                compression: "zstd".to_owned(),
                compressed_size: 3,
                data_start: 44,
            };
            let mut records = Vec::new();
            let found = unpack(&head, &[1, 2, 3], &mut records);
            assert!(matches!(found, Err(McapError::ChunkTooLarge(_))), "{found:?}");
            assert!(records.is_empty());
        }
    }
}
