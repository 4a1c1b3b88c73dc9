//! Files over HTTP on this machine, in parts, for pages from anywhere.
//!
//! A viewer reads the end of a log first and then the parts that it shows, so it wants ranges; and it
//! comes from another place than the log, so that a browser wants to be told that it may.
//!
//! A connection has a thread of its own and takes one request; one for a WebSocket goes on as a stream
//! (`stream/mod.rs`). All that it can hold is bounded: the size of a
//! request (`request.rs`), the time to ask, the time that an answer waits for a client that does not read, and the
//! number of connections.

use std::fs::File;
use std::io::{self, Read as _, Seek as _, SeekFrom, Write as _};
use std::net::{Ipv4Addr, Shutdown, SocketAddr, TcpListener, TcpStream};
use std::path::PathBuf;
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

use exchange::run_files::RunFiles;
use http_range_header::parse_range_header;

use super::live::{EVERY, LivePage, PAGE, Page};
use super::request::{self, Method, Refusal, Request};
use super::stream;
use crate::new::LAYOUTS;

/// Connections at a time: a browser asks for up to six.
const MOST_CONNECTIONS: usize = 64;

/// How long an answer waits for a client to read on.
const TIME_TO_READ: Duration = Duration::from_secs(20);

/// How long, and how many bytes, is listened to a client behind its request: closed earlier, the connection
/// would take the answer with it.
const TIME_TO_LEAVE: Duration = Duration::from_secs(1);
const MOST_BEHIND: u64 = 64 << 10;

/// Headers of every answer.
const ALWAYS: [(&str, &str); 4] = [
    ("Access-Control-Allow-Origin", "*"),
    ("Access-Control-Expose-Headers", "Accept-Ranges, Content-Length, Content-Range"),
    ("Accept-Ranges", "bytes"),
    ("Connection", "close"),
];

/// What a browser is told that asks whether it may ask.
const ALLOWED: [(&str, &str); 3] = [
    ("Access-Control-Allow-Methods", "GET, HEAD, OPTIONS"),
    ("Access-Control-Allow-Headers", "Range"),
    ("Access-Control-Allow-Private-Network", "true"),
];

/// Where the layout is; viewers call it by this name.
pub(super) const LAYOUT: &str = "/plunge.json";

/// A file, and the name under which it is served.
#[derive(Clone, Debug)]
pub(super) struct Served {
    /// With the slash before it.
    pub(super) name: &'static str,
    pub(super) path: PathBuf,
}

/// What is served: files, and the page of a run.
#[derive(Debug)]
pub(super) struct Content {
    pub(super) files: Vec<Served>,
    /// The folder or log of the run.
    pub(super) run: PathBuf,
    pub(super) page: LivePage,
}

impl Content {
    /// The layout for viewers of the run; logs of resistive forces hold no grains.
    fn layout(&self) -> &'static str {
        let [(_, of_grains), (_, of_resistance)] = LAYOUTS;
        if RunFiles::so_far(&self.run).grains.is_file() { of_grains } else { of_resistance }
    }
}

/// A server of files and a page.
pub(super) struct Server {
    listener: TcpListener,
    address: SocketAddr,
    content: Arc<Content>,
}

/// An answer: its status, its headers beyond those of every answer, and its body with its length.
struct Answer {
    status: u16,
    headers: Vec<(&'static str, String)>,
    body: Option<Body>,
    length: u64,
}

enum Body {
    Part(io::Take<File>),
    Text(&'static str),
    Page(Page),
}

impl Server {
    /// Listens on `port` of the loopback address, or on a free one if that is 0.
    pub(super) fn start(port: u16, content: Arc<Content>) -> io::Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
        let address = listener.local_addr()?;
        Ok(Self { listener, address, content })
    }

    pub(super) fn address(&self) -> SocketAddr {
        self.address
    }

    pub(super) fn content(&self) -> Arc<Content> {
        Arc::clone(&self.content)
    }

    /// Answers for ever: a signal ends the program.
    pub(super) fn serve(&self) -> ! {
        let open = Arc::new(());
        loop {
            // A client that has gone before it was let in needs no answer. Where the system has no room for one
            // more connection it may have some later.
            let Ok((stream, _)) = self.listener.accept() else {
                thread::sleep(Duration::from_millis(10));
                continue;
            };
            if Arc::strong_count(&open) > MOST_CONNECTIONS {
                let _ = send(&stream, Answer::empty(503), Method::Get);
                continue;
            }
            let (content, place) = (Arc::clone(&self.content), Arc::clone(&open));
            let talk = move || {
                // Whoever has gone away needs no answer.
                let _ = talk(&stream, &content);
                drop(place);
            };
            // Without room for a thread the connection is closed.
            drop(thread::Builder::new().name("view".to_owned()).spawn(talk));
        }
    }
}

/// Reads the request of `stream`, and answers it with what is in `content`.
fn talk(stream: &TcpStream, content: &Content) -> io::Result<()> {
    stream.set_write_timeout(Some(TIME_TO_READ))?;
    let request = request::read(stream);
    if let Ok(Request { upgrade: Some(asked), .. }) = &request {
        return match stream::in_common(asked) {
            Some(protocol) => stream::talk(stream, asked, protocol, &content.page),
            None => send(stream, Answer::empty(400), Method::Get),
        };
    }
    let (answer, method) = match request {
        Ok(request) => (answer(&request, content), request.method),
        Err(Refusal::Status(status)) => (Answer::empty(status), Method::Get),
        Err(Refusal::Silence) => return Ok(()),
    };
    let is_last = method == Method::Get
        && matches!(answer.body, Some(Body::Page(Page { is_last: true, .. })));
    send(stream, answer, method)?;
    stream.shutdown(Shutdown::Write)?;
    let heard = hear_out(stream);
    if is_last {
        content.page.hand_over();
    }
    heard
}

/// Reads what a client still sends, within bounds.
fn hear_out(mut stream: &TcpStream) -> io::Result<()> {
    stream.set_read_timeout(Some(TIME_TO_LEAVE))?;
    let (start, mut heard, mut part) = (Instant::now(), 0, [0; 4096]);
    while start.elapsed() < TIME_TO_LEAVE && heard < MOST_BEHIND {
        match stream.read(&mut part)? {
            0 => break,
            n => heard += n as u64,
        }
    }
    Ok(())
}

fn answer(request: &Request, content: &Content) -> Answer {
    if request.method == Method::Options {
        let headers = ALLOWED.map(|(name, value)| (name, value.to_owned()));
        return Answer { headers: headers.into(), ..Answer::empty(204) };
    }
    if request.path == PAGE {
        return page(&content.page);
    }
    if request.path == LAYOUT {
        let headers = vec![("Content-Type", "application/json".to_owned())];
        let layout = content.layout();
        let body = Some(Body::Text(layout));
        return Answer { status: 200, headers, body, length: layout.len() as u64 };
    }
    match content.files.iter().find(|file| file.name == request.path) {
        Some(file) => {
            part_of(file, request.range.as_deref()).unwrap_or_else(|error| match error.kind() {
                // That of a run that has not ended.
                io::ErrorKind::NotFound => Answer::empty(404),
                _ => Answer::empty(500),
            })
        }
        None => Answer::empty(404),
    }
}

fn page(page: &LivePage) -> Answer {
    let page = page.now();
    let mut headers = vec![
        ("Content-Type", "text/html; charset=utf-8".to_owned()),
        ("Cache-Control", "no-store".to_owned()),
    ];
    if !page.is_last {
        headers.push(("Refresh", EVERY.as_secs().to_string()));
    }
    Answer { status: 200, headers, length: page.html.len() as u64, body: Some(Body::Page(page)) }
}

/// The part of `file` that `range` asks for; all of it without one, and for several at once.
fn part_of(file: &Served, range: Option<&str>) -> io::Result<Answer> {
    let mut opened = File::open(&file.path)?;
    let whole = opened.metadata()?.len();
    let asked = range.and_then(|range| parse_range_header(range).ok());
    let (status, part) = match asked.map(|ranges| ranges.validate(whole)) {
        Some(Ok(ranges)) if ranges.len() == 1 => (206, Some(ranges[0].clone())),
        Some(Err(_)) => {
            let headers = vec![("Content-Range", format!("bytes */{whole}"))];
            return Ok(Answer { headers, ..Answer::empty(416) });
        }
        _ => (200, None),
    };
    let mut headers = vec![("Content-Type", "application/octet-stream".to_owned())];
    let (mut start, mut length) = (0, whole);
    if let Some(part) = part {
        let (first, last) = (*part.start(), *part.end());
        (start, length) = (first, last - first + 1);
        headers.push(("Content-Range", format!("bytes {first}-{last}/{whole}")));
    }
    opened.seek(SeekFrom::Start(start))?;
    Ok(Answer { status, headers, body: Some(Body::Part(opened.take(length))), length })
}

/// Sends `answer`; to a client that asks for the head alone, that alone.
fn send(mut stream: &TcpStream, answer: Answer, method: Method) -> io::Result<()> {
    let Answer { status, headers, body, length } = answer;
    let mut head = format!("HTTP/1.1 {status} {}\r\nContent-Length: {length}\r\n", reason(status));
    let always = ALWAYS.iter().map(|&(name, value)| (name, value));
    let headers = headers.iter().map(|(name, value)| (*name, value.as_str()));
    for (name, value) in always.chain(headers) {
        head.push_str(&format!("{name}: {value}\r\n"));
    }
    head.push_str("\r\n");
    stream.write_all(head.as_bytes())?;
    match body.filter(|_| method == Method::Get) {
        Some(Body::Part(mut part)) => io::copy(&mut part, &mut stream).map(drop),
        Some(Body::Text(text)) => stream.write_all(text.as_bytes()),
        Some(Body::Page(page)) => stream.write_all(page.html.as_bytes()),
        None => Ok(()),
    }
}

/// What a status means, as RFC 9110 and RFC 6585 have it.
fn reason(status: u16) -> &'static str {
    match status {
        200 => "OK",
        204 => "No Content",
        206 => "Partial Content",
        400 => "Bad Request",
        404 => "Not Found",
        405 => "Method Not Allowed",
        413 => "Content Too Large",
        416 => "Range Not Satisfiable",
        421 => "Misdirected Request",
        431 => "Request Header Fields Too Large",
        503 => "Service Unavailable",
        _ => "Internal Server Error",
    }
}

impl Answer {
    fn empty(status: u16) -> Self {
        Self { status, headers: Vec::new(), body: None, length: 0 }
    }
}
