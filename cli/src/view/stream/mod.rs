//! A run sent message by message to a viewer, while it goes on and after its end, as Foxglove's WebSocket protocol
//! has it.
//!
//! A client sees the run from its start. One that subscribes to further channels sees it from the start again, for
//! what they have said may be all they will say: the shape of a body is told once.

mod logs;
mod protocol;

use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, ErrorKind, Write as _};
use std::net::TcpStream;
use std::path::Path;
use std::time::{Duration, Instant};

use exchange::follow::Channel;
use tungstenite::handshake::derive_accept_key;
use tungstenite::protocol::{Role, WebSocketConfig};
use tungstenite::{Error, Message, WebSocket};

use super::live::LivePage;
use super::request::Upgrade;
use logs::{Logs, Next};
use protocol::{Advertised, Asked, Told};

/// Most bytes of what a client says at once, and most channels that it subscribes to.
const MOST_BYTES: usize = 1 << 20;
const MOST_SUBSCRIPTIONS: usize = 4096;

/// How long a client is listened to where there is nothing to say, and where there is.
const PAUSE: Duration = Duration::from_millis(50);
const GLANCE: Duration = Duration::from_millis(1);

/// How long after the last change of its subscriptions a client is told. A viewer subscribes panel by panel while it
/// draws them, and a plot that is told from the start once more joins its end to its start.
const SETTLED: Duration = Duration::from_secs(1);

/// A client that has asked for the messages of a run.
struct Client<'a> {
    stream: &'a TcpStream,
    socket: WebSocket<&'a TcpStream>,
    advertised: BTreeSet<u32>,
    /// The numbers that the client knows its subscriptions by, by channels.
    subscriptions: BTreeMap<u32, u32>,
    /// When a subscription was added that has not been told of yet.
    changed: Option<Instant>,
    /// The time that was published last (ns).
    time_ns: Option<u64>,
}

/// The name of the protocol that `asked` and this server have in common.
pub(super) fn in_common(asked: &Upgrade) -> Option<&'static str> {
    protocol::chosen(&asked.protocols)
}

/// Shakes hands on `protocol`, and tells of the run of `page` until the client goes, or another run of a list goes
/// on.
pub(super) fn talk(
    mut stream: &TcpStream,
    asked: &Upgrade,
    protocol: &str,
    page: &LivePage,
) -> io::Result<()> {
    let key = derive_accept_key(asked.key.as_bytes());
    let head = format!(
        "HTTP/1.1 101 Switching Protocols\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n\
         Sec-WebSocket-Accept: {key}\r\nSec-WebSocket-Protocol: {protocol}\r\n\r\n"
    );
    stream.write_all(head.as_bytes())?;
    let run = page.run();
    let streaming = page.streams();
    match Client::of(stream).follow(&run, page, || streaming.finish()) {
        Ok(()) | Err(Error::ConnectionClosed | Error::AlreadyClosed) => Ok(()),
        Err(Error::Io(why)) => Err(why),
        Err(other) => Err(io::Error::other(other)),
    }
}

impl<'a> Client<'a> {
    fn of(stream: &'a TcpStream) -> Self {
        let limits = WebSocketConfig::default()
            .max_message_size(Some(MOST_BYTES))
            .max_frame_size(Some(MOST_BYTES));
        Self {
            stream,
            socket: WebSocket::from_raw_socket(stream, Role::Server, Some(limits)),
            advertised: BTreeSet::new(),
            subscriptions: BTreeMap::new(),
            changed: None,
            time_ns: None,
        }
    }

    fn follow(&mut self, run: &Path, page: &LivePage, all_is_told: impl Fn()) -> Result<(), Error> {
        self.tell(&Told::greeting(&run.display().to_string()))?;
        let mut logs = Logs::of(run);
        let mut wait = GLANCE;
        loop {
            self.listen(wait)?;
            if let Some(changed) = self.changed {
                if changed.elapsed() < SETTLED {
                    wait = PAUSE;
                    continue;
                }
                self.changed = None;
                logs = Logs::of(run);
            }
            let next = match logs.advance() {
                Ok(next) => next,
                Err(why) => {
                    self.tell(&Told::failure(&why.to_string()))?;
                    return self.socket.close(None);
                }
            };
            wait = if next.messages.is_empty() { PAUSE } else { GLANCE };
            self.pass_on(next)?;
            if logs.have_ended() && self.changed.is_none() {
                all_is_told();
                if page.run() != run {
                    return self.socket.close(None);
                }
            }
        }
    }

    /// Hears what the client says within `wait`.
    fn listen(&mut self, wait: Duration) -> Result<(), Error> {
        self.stream.set_read_timeout(Some(wait))?;
        loop {
            let text = match self.socket.read() {
                Ok(Message::Text(text)) => text,
                Ok(_) => continue,
                Err(Error::Io(why))
                    if matches!(why.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) =>
                {
                    return Ok(());
                }
                Err(why) => return Err(why),
            };
            match serde_json::from_str(&text) {
                Ok(Asked::Subscribe { subscriptions }) => {
                    for one in subscriptions {
                        if self.subscriptions.len() < MOST_SUBSCRIPTIONS {
                            self.subscriptions.insert(one.channel_id, one.id);
                        }
                    }
                    self.changed = Some(Instant::now());
                }
                Ok(Asked::Unsubscribe { subscription_ids }) => {
                    self.subscriptions.retain(|_, id| !subscription_ids.contains(id));
                }
                Ok(Asked::Other) => {}
                Err(why) => self.tell(&Told::failure(&format!("not understood: {why}")))?,
            }
        }
    }

    /// Advertises channels that are new, and sends those messages that are subscribed to.
    fn pass_on(&mut self, next: Next) -> Result<(), Error> {
        let is_new = |(id, _): &&(u32, Channel)| self.advertised.insert(*id);
        let new: Vec<_> = next.channels.iter().filter(is_new).collect();
        if !new.is_empty() {
            let channels = new.iter().map(|(id, channel)| Advertised::of(*id, channel)).collect();
            self.tell(&Told::Advertise { channels })?;
        }
        for (channel, message) in next.messages {
            let Some(&subscription) = self.subscriptions.get(&channel) else {
                continue;
            };
            if self.time_ns != Some(message.time_ns) {
                self.time_ns = Some(message.time_ns);
                self.socket.write(Message::binary(protocol::time(message.time_ns)))?;
            }
            let bytes = protocol::message(subscription, message.time_ns, &message.data);
            self.socket.write(Message::binary(bytes))?;
        }
        self.socket.flush()
    }

    fn tell(&mut self, told: &Told<'_>) -> Result<(), Error> {
        let text = serde_json::to_string(told).map_err(io::Error::other)?;
        self.socket.send(Message::text(text))
    }
}
