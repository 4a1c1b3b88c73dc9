//! The messages of a run over a WebSocket, asked as Foxglove and Lichtblick ask.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::net::TcpStream;
use std::path::Path;
use std::time::Duration;

use mcap::read::MessageStream;
use serde_json::{Value, json};
use tungstenite::client::IntoClientRequest as _;
use tungstenite::http::HeaderValue;
use tungstenite::{Message, WebSocket};

use crate::common::{Call, folder};
use crate::view::{View, go_on};

/// A message: its topic, its time (ns), what it says.
type Told = (String, u64, Vec<u8>);

struct Viewer {
    socket: WebSocket<TcpStream>,
    /// The topics of channels by their numbers.
    topics: BTreeMap<u64, String>,
    /// The channels that are subscribed to, by the numbers of their subscriptions.
    subscriptions: BTreeMap<u32, u64>,
}

impl Viewer {
    fn of(view: &View, protocol: &'static str) -> Result<Self, tungstenite::Error> {
        let url = format!("ws://127.0.0.1:{}", view.port);
        let mut request = url.as_str().into_client_request()?;
        let protocol = HeaderValue::from_static(protocol);
        request.headers_mut().insert("Sec-WebSocket-Protocol", protocol);
        let stream = TcpStream::connect(("127.0.0.1", view.port))?;
        stream.set_read_timeout(Some(Duration::from_secs(2)))?;
        let shaken = tungstenite::client(request, stream);
        let (mut socket, answer) = shaken.map_err(|failure| match failure {
            tungstenite::HandshakeError::Failure(why) => why,
            other => panic!("{other}"),
        })?;
        assert!(answer.headers().contains_key("Sec-WebSocket-Protocol"));
        let told = socket.read()?.into_text()?;
        let told: Value = serde_json::from_str(&told).expect("an object");
        assert_eq!((&told["op"], &told["name"]), (&json!("serverInfo"), &json!("plunge")));
        Ok(Self { socket, topics: BTreeMap::new(), subscriptions: BTreeMap::new() })
    }

    /// Reads until the server has had nothing to say for two seconds, or has closed.
    fn hear(&mut self) -> Vec<Told> {
        self.hear_until(|_| false)
    }

    /// Likewise, or until channels are known of which `is_enough` says so.
    fn hear_until(&mut self, is_enough: impl Fn(&BTreeMap<u64, String>) -> bool) -> Vec<Told> {
        let (mut told, mut time) = (Vec::new(), None);
        loop {
            match self.socket.read() {
                Ok(Message::Text(text)) => {
                    let text: Value = serde_json::from_str(&text).expect("an object");
                    assert_eq!(text["op"], "advertise", "{text}");
                    for channel in text["channels"].as_array().expect("channels") {
                        let topic = channel["topic"].as_str().expect("a topic").to_owned();
                        let id = channel["id"].as_u64().expect("a number");
                        assert!(channel["schema"].as_str().is_some_and(|s| s.len() > 10));
                        assert!(!self.topics.values().any(|one| *one == topic), "{topic} twice");
                        self.topics.insert(id, topic);
                    }
                    if is_enough(&self.topics) {
                        return told;
                    }
                }
                Ok(Message::Binary(bytes)) => {
                    let long = |at: usize| {
                        u64::from_le_bytes(bytes[at..at + 8].try_into().expect("eight bytes"))
                    };
                    if bytes[0] == 2 {
                        time = Some(long(1));
                        continue;
                    }
                    assert_eq!((bytes[0], time), (1, Some(long(5))));
                    let id = u32::from_le_bytes(bytes[1..5].try_into().expect("four bytes"));
                    let topic = self.topics[&self.subscriptions[&id]].clone();
                    told.push((topic, long(5), bytes[13..].to_vec()));
                }
                Ok(other) => panic!("{other}"),
                Err(_) => return told,
            }
        }
    }

    fn subscribe(&mut self, topics: &BTreeSet<&str>) {
        for (channel, topic) in &self.topics {
            if !topics.contains(topic.as_str()) {
                continue;
            }
            let id = 100 + self.subscriptions.len() as u32;
            self.subscriptions.insert(id, *channel);
            let asked = json!({
                "op": "subscribe", "subscriptions": [{ "id": id, "channelId": channel }]
            });
            self.socket.send(Message::text(asked.to_string())).expect("it listens");
        }
    }
}

/// The messages of the logs in `folder`, by their times; of topics in both, those of one.
fn logged(folder: &Path) -> Vec<Told> {
    let mut all = Vec::new();
    let mut topics = BTreeSet::new();
    for name in ["run.mcap", "grains.mcap"] {
        let bytes = fs::read(folder.join(name)).expect("a log");
        let of_log: Vec<Told> = MessageStream::new(&bytes)
            .expect("a log")
            .map(|message| {
                let message = message.expect("a message");
                (message.channel.topic.clone(), message.log_time, message.data.to_vec())
            })
            .filter(|(topic, ..)| !topics.contains(topic))
            .collect();
        topics.extend(of_log.iter().map(|(topic, ..)| topic.clone()));
        all.extend(of_log);
    }
    all.sort_by_key(|(_, time, _)| *time);
    all
}

/// Compares without a word of what is in messages.
#[track_caller]
fn assert_same(told: &[Told], wanted: &[Told]) {
    let short = |all: &[Told]| -> Vec<(String, u64, usize)> {
        all.iter().map(|(topic, time, data)| (topic.clone(), *time, data.len())).collect()
    };
    assert_eq!(short(told), short(wanted));
    assert!(told == wanted, "the same messages with other contents");
}

fn of_topics(all: &[Told], topics: &BTreeSet<&str>) -> Vec<Told> {
    all.iter().filter(|(topic, ..)| topics.contains(topic.as_str())).cloned().collect()
}

#[test]
fn a_viewer_has_every_message_of_what_it_subscribes_to_and_all_again_with_more()
-> Result<(), tungstenite::Error> {
    let here = folder();
    Call::run(here.path()).args(["--force"]).done();
    let logged = logged(here.path());
    let view = View::of(here.path());
    for protocol in ["foxglove.websocket.v1", "foxglove.sdk.v1, foxglove.websocket.v1"] {
        let mut viewer = Viewer::of(&view, protocol)?;
        assert_same(&viewer.hear(), &[]);
        let topics: BTreeSet<_> = viewer.topics.values().map(String::as_str).collect();
        let wanted: BTreeSet<_> = logged.iter().map(|(topic, ..)| topic.as_str()).collect();
        assert!(wanted.is_subset(&topics), "{topics:?}");
        let scene = BTreeSet::from(["/scene"]);
        viewer.subscribe(&scene);
        assert_same(&viewer.hear(), &of_topics(&logged, &scene));
        let more = BTreeSet::from(["/grains", "/tf"]);
        viewer.subscribe(&more);
        let both = &scene | &more;
        assert_same(&viewer.hear(), &of_topics(&logged, &both));
    }
    assert!(Viewer::of(&view, "mqtt").is_err());
    Ok(())
}

#[test]
fn a_viewer_of_a_run_that_goes_on_has_what_comes_when_it_comes() -> Result<(), tungstenite::Error> {
    let here = folder();
    Call::run(here.path()).args(["--force"]).done();
    let all = logged(here.path());
    go_on(here.path());
    let paths = ["run.mcap", "grains.mcap"].map(|name| here.path().join(format!("{name}.partial")));
    let whole = paths.each_ref().map(|path| fs::read(path).expect("a log"));
    for (path, bytes) in paths.iter().zip(&whole) {
        fs::write(path, &bytes[..bytes.len() / 2]).expect("a log");
    }
    let view = View::of(here.path());
    let mut viewer = Viewer::of(&view, "foxglove.websocket.v1")?;
    assert_same(&viewer.hear(), &[]);
    let topics = BTreeSet::from(["/scene", "/tf"]);
    viewer.subscribe(&topics);
    let mut told = viewer.hear();
    let wanted = of_topics(&all, &topics);
    assert!(!told.is_empty() && told.len() < wanted.len(), "{}", told.len());
    for (path, bytes) in paths.iter().zip(&whole) {
        fs::write(path, bytes).expect("a log");
    }
    told.extend(viewer.hear());
    assert_same(&told, &wanted);
    // The log of grains had no whole chunk at first.
    viewer.subscribe(&BTreeSet::from(["/grains"]));
    let topics = BTreeSet::from(["/grains", "/scene", "/tf"]);
    assert_same(&viewer.hear(), &of_topics(&all, &topics));
    Ok(())
}

#[test]
fn a_live_run_tells_a_viewer_its_last_message_before_it_ends() -> Result<(), tungstenite::Error> {
    let here = folder();
    let call = Call::run(here.path()).args(["--force", "--live=0"]);
    let view = View::of_live(call.set(&["bed.grains.0.count=1000", "run.seed=6"]).start());
    let mut viewer = Viewer::of(&view, "foxglove.websocket.v1")?;
    let topics = BTreeSet::from(["/grains", "/tf"]);
    let are_known = |known: &BTreeMap<u64, String>| {
        topics.iter().all(|topic| known.values().any(|one| one == topic))
    };
    while !are_known(&viewer.topics) {
        assert_same(&viewer.hear_until(are_known), &[]);
    }
    viewer.subscribe(&topics);
    let mut told = Vec::new();
    loop {
        let more = viewer.hear();
        if more.is_empty() && here.path().join("summary.json").is_file() {
            break;
        }
        told.extend(more);
    }
    assert_same(&told, &of_topics(&logged(here.path()), &topics));
    assert!(view.ended().success());
    Ok(())
}
