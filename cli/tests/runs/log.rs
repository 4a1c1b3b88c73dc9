//! The content of a log, read without our own reader.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use mcap::read::{LinearReader, MessageStream};
use mcap::records::Record;

/// What a log says, apart from how it is packed.
#[derive(Debug, Default)]
pub(crate) struct Log {
    /// Topic, sequence number, time and data.
    pub(crate) messages: Vec<(String, u32, u64, Vec<u8>)>,
    pub(crate) metadata: Vec<BTreeMap<String, String>>,
    pub(crate) attachments: BTreeMap<String, Vec<u8>>,
}

impl Log {
    /// Reads a finished log whole.
    pub(crate) fn read(path: &Path) -> Self {
        let bytes = fs::read(path).expect("a log");
        let mut log = Self::default();
        for message in MessageStream::new(&bytes).expect("a log") {
            let message = message.expect("a message");
            log.messages.push((
                message.channel.topic.clone(),
                message.sequence,
                message.log_time,
                message.data.into_owned(),
            ));
        }
        for record in LinearReader::new(&bytes).expect("a log") {
            match record.expect("a record") {
                Record::Metadata(metadata) => log.metadata.push(metadata.metadata),
                Record::Attachment { header, data, .. } => {
                    log.attachments.insert(header.name, data.into_owned());
                }
                _ => {}
            }
        }
        log
    }

    /// How many messages a topic has.
    pub(crate) fn count(&self, topic: &str) -> usize {
        self.messages.iter().filter(|message| message.0 == topic).count()
    }

    /// Whether a message of `topic` holds `text`.
    pub(crate) fn says(&self, topic: &str, text: &str) -> bool {
        let holds = |data: &[u8]| data.windows(text.len()).any(|part| part == text.as_bytes());
        self.messages.iter().any(|message| message.0 == topic && holds(&message.3))
    }
}
