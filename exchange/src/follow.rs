//! The messages of a log while it is written.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use engine::record::chunk;
use mcap::records::Record;

use crate::read::ReadError;
use crate::read::records::Records;

/// A log that is read as it grows.
pub struct Followed {
    path: PathBuf,
    records: Records,
    schemas: BTreeMap<u16, Schema>,
}

#[derive(Clone, Debug)]
struct Schema {
    name: String,
    encoding: String,
    data: Vec<u8>,
}

/// What a log says next.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Said {
    /// A channel; its messages come later. It may be said again.
    Channel(Channel),
    /// A message.
    Message(Message),
}

/// A channel of a log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Channel {
    /// Its number in this log.
    pub id: u16,
    /// What it is called.
    pub topic: String,
    /// How its messages are written, such as `protobuf`.
    pub encoding: String,
    /// The name of what describes its messages; empty without a description.
    pub schema_name: String,
    /// How the description is written.
    pub schema_encoding: String,
    /// The description.
    pub schema: Vec<u8>,
}

/// A message of a log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// The number of its channel.
    pub channel: u16,
    /// When it was written, in the time of the run (ns).
    pub time_ns: u64,
    /// What it says.
    pub data: Vec<u8>,
}

impl Followed {
    /// From the start of the log at `path`, finished or not.
    ///
    /// # Errors
    /// The file system's refusal, or a file that does not begin as a log does: one that has just been made may not
    /// do so yet.
    pub fn open(path: &Path) -> Result<Self, ReadError> {
        let records = Records::open(path)?;
        Ok(Self { path: path.to_owned(), records, schemas: BTreeMap::new() })
    }

    /// The next chunk of what has been written by now; nothing if no further chunk is whole.
    ///
    /// # Errors
    /// The file system's refusal, or damage before the end.
    pub fn advance(&mut self) -> Result<Vec<Said>, ReadError> {
        self.records.grow()?;
        while let Some(offset) = self.records.advance()? {
            let damaged = |why: String| ReadError::Damaged { path: self.path.clone(), offset, why };
            let mut said = Vec::new();
            for (opcode, body) in self.records.present() {
                let record = chunk::parse_record(opcode, body);
                match record.map_err(|error| damaged(error.to_string()))? {
                    Record::Schema { header, data } => {
                        let data = data.into_owned();
                        let schema = Schema { name: header.name, encoding: header.encoding, data };
                        self.schemas.insert(header.id, schema);
                    }
                    Record::Channel(channel) => {
                        let (name, encoding, data) = match self.schemas.get(&channel.schema_id) {
                            Some(one) => (one.name.clone(), one.encoding.clone(), one.data.clone()),
                            None => Default::default(),
                        };
                        said.push(Said::Channel(Channel {
                            id: channel.id,
                            topic: channel.topic,
                            encoding: channel.message_encoding,
                            schema_name: name,
                            schema_encoding: encoding,
                            schema: data,
                        }));
                    }
                    Record::Message { header, data } => said.push(Said::Message(Message {
                        channel: header.channel_id,
                        time_ns: header.log_time,
                        data: data.into_owned(),
                    })),
                    _ => {}
                }
            }
            if !said.is_empty() {
                return Ok(said);
            }
        }
        Ok(Vec::new())
    }

    /// Whether the end of the log has been read: it grows no more.
    pub fn has_ended(&self) -> bool {
        self.records.complete()
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    /// A log of two channels with a chunk for each message.
    fn log() -> Vec<u8> {
        let mut bytes = std::io::Cursor::new(Vec::new());
        let options = mcap::WriteOptions::new().chunk_size(Some(1));
        let mut writer = options.create(&mut bytes).expect("memory can be written");
        for step in 0..10_u64 {
            let topic = ["/a", "/b"][step as usize % 2];
            let schema = writer.add_schema(topic, "protobuf", topic.as_bytes()).expect("a schema");
            let map = BTreeMap::new();
            let channel = writer.add_channel(schema, topic, "protobuf", &map).expect("a channel");
            let header = mcap::records::MessageHeader {
                channel_id: channel,
                sequence: 0,
                log_time: step,
                publish_time: step,
            };
            writer.write_to_known_channel(&header, &[step as u8]).expect("a message");
        }
        writer.finish().expect("a log");
        drop(writer);
        bytes.into_inner()
    }

    #[test]
    fn a_log_is_read_once_and_in_order_wherever_its_writer_pauses() -> Result<(), ReadError> {
        let whole = log();
        let here = tempfile::tempdir().expect("a folder");
        let path = here.path().join("run.mcap");
        for pause in (8..whole.len()).step_by(7) {
            fs::write(&path, &whole[..pause]).expect("a file");
            let mut followed = Followed::open(&path)?;
            let mut said = Vec::new();
            for _ in 0..50 {
                said.extend(followed.advance()?);
            }
            fs::write(&path, &whole).expect("a file");
            while !followed.has_ended() {
                said.extend(followed.advance()?);
            }
            let messages = said.iter().filter_map(|said| match said {
                Said::Message(message) => Some((message.time_ns, message.data.clone())),
                Said::Channel(_) => None,
            });
            let wanted = (0..10).map(|step| (step, vec![step as u8]));
            assert!(messages.eq(wanted), "{pause}");
            let first = said.iter().find_map(|said| match said {
                Said::Channel(channel) => Some(channel),
                Said::Message(_) => None,
            });
            let first = first.expect("a channel");
            assert_eq!((first.topic.as_str(), first.schema_name.as_str()), ("/a", "/a"));
            assert_eq!(first.schema, b"/a");
        }
        Ok(())
    }
}
