//! Writing the recovered log.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use engine::record::chunk::{CHUNK_LIMIT, RECORD_PREFIX};
use mcap::records::{Channel, Header, Record, op};
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::{Attachment, Compression, McapError, WriteOptions, Writer};

use super::error::RecoverError;
use super::scan::{self, Input};

/// Schemas and channels kept aside, by their numbers.
#[derive(Default)]
pub(super) struct Definitions {
    schemas: BTreeMap<u16, (String, String, Vec<u8>)>,
    channels: BTreeMap<u16, Channel>,
}

impl Definitions {
    /// Those that a finished log repeats at its end; they serve when their first chunk is lost.
    /// None if the checksum of that section is wrong: a damaged topic would pass as another one.
    pub(super) fn of_summary(input: &mut Input<'_>) -> Result<Self, RecoverError> {
        /// An end of the data, which the reader wants to see before a summary.
        const DATA_END: [u8; RECORD_PREFIX + 4] =
            [op::DATA_END, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];
        let mut found = Self::default();
        let Some(mut at) = input.summary_start()? else {
            return Ok(found);
        };
        let mut reader = LinearReader::new_with_options(
            LinearReaderOptions::default()
                .with_skip_start_magic(true)
                .with_validate_summary_section_crc(true)
                .with_record_length_limit(CHUNK_LIMIT as usize),
        );
        reader.insert(DATA_END.len()).copy_from_slice(&DATA_END);
        reader.notify_read(DATA_END.len());
        while let Some(event) = reader.next_event() {
            match event {
                Ok(LinearReadEvent::ReadRequest(wanted)) => {
                    let bytes = input.bytes(at, wanted as u64)?;
                    reader.insert(bytes.len()).copy_from_slice(&bytes);
                    reader.notify_read(bytes.len());
                    at += bytes.len() as u64;
                }
                Ok(LinearReadEvent::Record { opcode, data }) => found.keep(opcode, data),
                Err(_) => return Ok(Self::default()),
            }
        }
        Ok(found)
    }

    fn keep(&mut self, opcode: u8, body: &[u8]) {
        match scan::parse(opcode, body) {
            Some(Record::Schema { header, data }) => {
                let schema = (header.name, header.encoding, data.into_owned());
                self.schemas.insert(header.id, schema);
            }
            Some(Record::Channel(channel)) => {
                self.channels.insert(channel.id, channel);
            }
            _ => {}
        }
    }
}

/// The new log.
pub(super) struct Output {
    path: PathBuf,
    writer: Writer<BufWriter<File>>,
    spare: Definitions,
    schemas: BTreeSet<u16>,
    channels: BTreeSet<u16>,
    messages: u64,
}

impl Output {
    pub(super) fn create(
        path: &Path,
        header: Header,
        spare: Definitions,
    ) -> Result<Self, RecoverError> {
        let file = File::create(path).map_err(|e| RecoverError::io(path, "create", e))?;
        let writer = WriteOptions::new()
            .compression(Some(Compression::Zstd))
            .compression_threads(0)
            // chunks end where they ended in the input
            .chunk_size(None)
            .profile(header.profile)
            .library(header.library)
            .create(BufWriter::new(file))
            .map_err(|e| failed(path, e))?;
        Ok(Self {
            path: path.to_owned(),
            writer,
            spare,
            schemas: BTreeSet::new(),
            channels: BTreeSet::new(),
            messages: 0,
        })
    }

    pub(super) fn messages(&self) -> u64 {
        self.messages
    }

    /// Takes over a record; `false` if it contradicts an earlier one or its channel is unknown.
    pub(super) fn record(
        &mut self,
        record: &Record<'_>,
        body: &[u8],
    ) -> Result<bool, RecoverError> {
        let done = match record {
            Record::Schema { header, data } => {
                self.schema(header.id, &header.name, &header.encoding, data)
            }
            Record::Channel(channel) => self.channel(channel),
            Record::Message { header, data } => {
                let id = header.channel_id;
                if !self.channels.contains(&id) && !self.spare_channel(id)? {
                    return Ok(false);
                }
                self.messages += 1;
                self.writer.write_to_known_channel(header, data)
            }
            Record::Attachment { header, data, .. } => self.writer.attach(&Attachment {
                log_time: header.log_time,
                create_time: header.create_time,
                name: header.name.clone(),
                media_type: header.media_type.clone(),
                data: data.as_ref().into(),
            }),
            Record::Metadata(metadata) => self.writer.write_metadata(metadata),
            Record::Unknown { opcode, .. } => {
                self.writer.write_private_record(*opcode, body, Default::default())
            }
            // indexes and statistics are made anew
            _ => Ok(()),
        };
        self.settle(done)
    }

    /// Ends the chunk being written.
    pub(super) fn end_chunk(&mut self) -> Result<(), RecoverError> {
        self.writer.flush().map_err(|e| failed(&self.path, e))
    }

    pub(super) fn finish(mut self) -> Result<(), RecoverError> {
        self.writer.finish().map_err(|e| failed(&self.path, e))?;
        let file = self.writer.into_inner().into_inner();
        file.map(drop).map_err(|e| RecoverError::io(&self.path, "write", e.into_error()))
    }

    fn schema(
        &mut self,
        id: u16,
        name: &str,
        encoding: &str,
        data: &[u8],
    ) -> Result<(), McapError> {
        self.writer.add_schema_with_id(id, name, encoding, data)?;
        self.schemas.insert(id);
        Ok(())
    }

    fn channel(&mut self, channel: &Channel) -> Result<(), McapError> {
        let Channel { id, schema_id, topic, message_encoding, metadata } = channel;
        if !self.schemas.contains(schema_id)
            && let Some((name, encoding, data)) = self.spare.schemas.remove(schema_id)
        {
            self.schema(*schema_id, &name, &encoding, &data)?;
        }
        self.writer.add_channel_with_id(*id, *schema_id, topic, message_encoding, metadata)?;
        self.channels.insert(*id);
        Ok(())
    }

    /// Defines a channel from the end of the log, where its definition in the data is lost.
    fn spare_channel(&mut self, id: u16) -> Result<bool, RecoverError> {
        let Some(channel) = self.spare.channels.remove(&id) else {
            return Ok(false);
        };
        let done = self.channel(&channel);
        self.settle(done)
    }

    /// Separates what is wrong with the input from what is wrong with the disk.
    fn settle(&self, done: Result<(), McapError>) -> Result<bool, RecoverError> {
        match done {
            Ok(()) => Ok(true),
            Err(
                McapError::ConflictingChannels(_)
                | McapError::ConflictingSchemas(_)
                | McapError::InvalidSchemaId
                | McapError::UnknownSchema(..)
                | McapError::UnknownChannel(..)
                | McapError::PrivateRecordOpcodeIsReserved { .. },
            ) => Ok(false),
            Err(error) => Err(failed(&self.path, error)),
        }
    }
}

fn failed(path: &Path, error: McapError) -> RecoverError {
    match error {
        McapError::Io(source) => RecoverError::io(path, "write", source),
        source => RecoverError::Write { path: path.to_owned(), source },
    }
}
