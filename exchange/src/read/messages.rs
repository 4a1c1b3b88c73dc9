//! The messages of a log, one after another, with the descriptors that they carry.

use std::collections::BTreeMap;
use std::path::Path;

use engine::record::chunk;
use mcap::records::Record;
use prost_reflect::prost::Message as _;
use prost_reflect::prost_types::{FileDescriptorProto, FileDescriptorSet};
use prost_reflect::{DescriptorPool, MessageDescriptor};

use super::error::ReadError;
use super::records::Records;

/// What a reader of messages wants.
pub(crate) trait Receiver {
    /// What it keeps of a channel that it wants the messages of.
    type Channel;

    /// A channel and what describes its messages; `None` to pass its messages over.
    ///
    /// # Errors
    /// A channel that it cannot do without, in a sentence.
    fn introduce(
        &mut self,
        topic: &str,
        message: &MessageDescriptor,
    ) -> Result<Option<Self::Channel>, String>;

    /// A message of a channel.
    ///
    /// # Errors
    /// Why it cannot be taken.
    fn receive(&mut self, channel: &mut Self::Channel, data: &[u8]) -> Result<(), Refusal>;
}

/// Why a message cannot be taken.
#[derive(Debug)]
pub(crate) enum Refusal {
    /// It is not what its descriptor says, in a sentence.
    Damaged(String),
    /// Reading has no use any more; why is known to the receiver.
    Stop,
}

/// Hands the messages of the log at `path`, finished or not, to `receiver`, and says whether the log is
/// finished.
///
/// # Errors
/// The file system's refusal, a file that is no log, damage before its end, or a channel that the
/// receiver cannot do without.
pub(crate) fn each_message<R: Receiver>(path: &Path, receiver: &mut R) -> Result<bool, ReadError> {
    let mut records = Records::open(path)?;
    let mut schemas: BTreeMap<u16, (String, Vec<u8>)> = BTreeMap::new();
    let mut channels: BTreeMap<u16, Option<R::Channel>> = BTreeMap::new();
    while let Some(offset) = records.advance()? {
        for (opcode, body) in records.present() {
            let damaged = |why: String| ReadError::Damaged { path: path.to_owned(), offset, why };
            let record =
                chunk::parse_record(opcode, body).map_err(|error| damaged(error.to_string()))?;
            match record {
                Record::Schema { header, data } => {
                    schemas.entry(header.id).or_insert((header.name, data.into_owned()));
                }
                Record::Channel(channel) if !channels.contains_key(&channel.id) => {
                    let refusal = |why: String| ReadError::Fields {
                        path: path.to_owned(),
                        topic: channel.topic.clone(),
                        why,
                    };
                    let message = schemas
                        .get(&channel.schema_id)
                        .ok_or_else(|| "its messages come without a descriptor".to_owned())
                        .and_then(|(name, set)| described(name, set))
                        .map_err(refusal)?;
                    let known = receiver.introduce(&channel.topic, &message).map_err(refusal)?;
                    channels.insert(channel.id, known);
                }
                Record::Message { header, data } => {
                    if let Some(Some(channel)) = channels.get_mut(&header.channel_id) {
                        match receiver.receive(channel, &data) {
                            Ok(()) => {}
                            Err(Refusal::Damaged(why)) => return Err(damaged(why)),
                            Err(Refusal::Stop) => return Ok(false),
                        }
                    }
                }
                _ => {}
            }
        }
    }
    Ok(records.complete())
}

/// The message `name` of a serialized set of descriptors.
pub(crate) fn described(name: &str, set: &[u8]) -> Result<MessageDescriptor, String> {
    let set = FileDescriptorSet::decode(set).map_err(|error| error.to_string())?;
    // `prost-reflect` 0.16 panics where it should refuse an unknown syntax.
    let known = |file: &&FileDescriptorProto| ["", "proto2", "proto3"].contains(&file.syntax());
    if let Some(file) = set.file.iter().find(|file| !known(file)) {
        return Err(format!("its descriptor is written in an unknown syntax, `{}`", file.syntax()));
    }
    DescriptorPool::from_file_descriptor_set(set)
        .map_err(|error| error.to_string())?
        .get_message_by_name(name)
        .ok_or_else(|| format!("its descriptor does not describe {name}"))
}
