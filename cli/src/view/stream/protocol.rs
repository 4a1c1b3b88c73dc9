//! What is said in Foxglove's WebSocket protocol.
//!
//! Source: Foxglove, "Foxglove WebSocket protocol v1", docs/spec.md of github.com/foxglove/ws-protocol, as far as a
//! server speaks it that publishes channels and their time.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use exchange::follow::Channel;
use serde::{Deserialize, Serialize};

/// The protocol by its names, of which a client offers at least one: that of the specification, which Lichtblick
/// asks for, and that of Foxglove since 2025.
const NAMES: [&str; 2] = ["foxglove.websocket.v1", "foxglove.sdk.v1"];

/// Opcodes of binary messages.
const MESSAGE_DATA: u8 = 1;
const TIME: u8 = 2;

/// Says in a `Status` that something has failed.
const ERROR: u8 = 2;

/// The name by which a client that offers `names` (separated by commas) is answered.
pub(super) fn chosen(names: &str) -> Option<&'static str> {
    let offered = || names.split(',').map(str::trim);
    NAMES.into_iter().find(|name| offered().any(|one| one == *name))
}

/// What a server says as text.
#[derive(Debug, Serialize)]
#[serde(tag = "op", rename_all = "camelCase")]
pub(super) enum Told<'a> {
    #[serde(rename_all = "camelCase")]
    ServerInfo {
        name: &'a str,
        capabilities: [&'a str; 1],
        session_id: &'a str,
    },
    Advertise {
        channels: Vec<Advertised<'a>>,
    },
    Status {
        level: u8,
        message: &'a str,
    },
}

/// A channel that can be subscribed to.
#[derive(Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Advertised<'a> {
    id: u32,
    topic: &'a str,
    encoding: &'a str,
    schema_name: &'a str,
    schema_encoding: &'a str,
    schema: String,
}

/// What a client says as text.
#[derive(Debug, PartialEq, Eq, Deserialize)]
#[serde(tag = "op", rename_all = "camelCase")]
pub(super) enum Asked {
    Subscribe {
        subscriptions: Vec<Subscription>,
    },
    #[serde(rename_all = "camelCase")]
    Unsubscribe {
        subscription_ids: Vec<u32>,
    },
    /// What this server does not offer.
    #[serde(other)]
    Other,
}

/// Wants the messages of a channel, under a number that the client has chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Subscription {
    pub(super) id: u32,
    pub(super) channel_id: u32,
}

impl<'a> Told<'a> {
    /// The first words: whose channels these are, and that their time is published.
    pub(super) fn greeting(run: &'a str) -> Self {
        Self::ServerInfo { name: "plunge", capabilities: ["time"], session_id: run }
    }

    pub(super) fn failure(message: &'a str) -> Self {
        Self::Status { level: ERROR, message }
    }
}

impl<'a> Advertised<'a> {
    /// `channel` under the number `id`.
    pub(super) fn of(id: u32, channel: &'a Channel) -> Self {
        // A description that is not text goes as base64.
        let schema = match channel.schema_encoding.as_str() {
            "protobuf" => STANDARD.encode(&channel.schema),
            _ => String::from_utf8_lossy(&channel.schema).into_owned(),
        };
        Self {
            id,
            topic: &channel.topic,
            encoding: &channel.encoding,
            schema_name: &channel.schema_name,
            schema_encoding: &channel.schema_encoding,
            schema,
        }
    }
}

/// A message for a subscription, from the time `time_ns` of the run.
pub(super) fn message(subscription: u32, time_ns: u64, data: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(13 + data.len());
    bytes.push(MESSAGE_DATA);
    bytes.extend_from_slice(&subscription.to_le_bytes());
    bytes.extend_from_slice(&time_ns.to_le_bytes());
    bytes.extend_from_slice(data);
    bytes
}

/// The time of the messages that follow.
pub(super) fn time(time_ns: u64) -> Vec<u8> {
    let mut bytes = vec![TIME];
    bytes.extend_from_slice(&time_ns.to_le_bytes());
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_client_is_answered_by_a_name_it_offers() {
        assert_eq!(chosen("foxglove.websocket.v1"), Some("foxglove.websocket.v1"));
        assert_eq!(chosen("mqtt, foxglove.sdk.v1"), Some("foxglove.sdk.v1"));
        assert_eq!(chosen("foxglove.sdk.v2"), None);
    }

    #[test]
    fn the_words_are_those_of_the_specification() -> Result<(), serde_json::Error> {
        let greeting = serde_json::to_value(Told::greeting("runs/a"))?;
        let wanted = serde_json::json!({
            "op": "serverInfo", "name": "plunge", "capabilities": ["time"], "sessionId": "runs/a"
        });
        assert_eq!(greeting, wanted);
        let channel = Channel {
            id: 3,
            topic: "/tf".to_owned(),
            encoding: "protobuf".to_owned(),
            schema_name: "foxglove.FrameTransforms".to_owned(),
            schema_encoding: "protobuf".to_owned(),
            schema: vec![0, 255],
        };
        let told = Told::Advertise { channels: vec![Advertised::of(7, &channel)] };
        let wanted = serde_json::json!({ "op": "advertise", "channels": [{
            "id": 7, "topic": "/tf", "encoding": "protobuf", "schemaName": "foxglove.FrameTransforms",
            "schemaEncoding": "protobuf", "schema": "AP8="
        }]});
        assert_eq!(serde_json::to_value(told)?, wanted);
        let asked = r#"{"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 7}]}"#;
        let subscriptions = vec![Subscription { id: 1, channel_id: 7 }];
        assert_eq!(serde_json::from_str::<Asked>(asked)?, Asked::Subscribe { subscriptions });
        let asked = r#"{"op": "unsubscribe", "subscriptionIds": [1]}"#;
        let subscription_ids = vec![1];
        assert_eq!(serde_json::from_str::<Asked>(asked)?, Asked::Unsubscribe { subscription_ids });
        let asked = r#"{"op": "subscribeConnectionGraph"}"#;
        assert_eq!(serde_json::from_str::<Asked>(asked)?, Asked::Other);
        assert_eq!(message(258, 3, b"xy"), [1, 2, 1, 0, 0, 3, 0, 0, 0, 0, 0, 0, 0, b'x', b'y']);
        assert_eq!(time(256), [2, 0, 1, 0, 0, 0, 0, 0, 0]);
        Ok(())
    }
}
