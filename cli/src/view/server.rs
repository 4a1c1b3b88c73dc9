//! Files over HTTP on this machine, in parts, for pages from anywhere.
//!
//! A viewer reads the end of a log first and then the parts that it shows, so it wants ranges; and it
//! comes from another place than the log, so that a browser wants to be told that it may.

use std::fs::File;
use std::io::{self, Read as _, Seek as _, SeekFrom};
use std::net::{Ipv4Addr, SocketAddr};
use std::ops::RangeInclusive;
use std::path::PathBuf;
use std::thread;
use std::time::Duration;

use http_range_header::parse_range_header;
use tiny_http::{Header, Method, Request, Response, StatusCode};

/// Requests that are answered side by side: a browser asks for up to six at a time.
const WORKERS: usize = 6;

/// How long a worker waits for a request before it looks whether to end.
const WAIT: Duration = Duration::from_millis(100);

/// Headers of every answer.
const ALWAYS: [(&str, &str); 3] = [
    ("Access-Control-Allow-Origin", "*"),
    ("Access-Control-Expose-Headers", "Accept-Ranges, Content-Length, Content-Range"),
    ("Accept-Ranges", "bytes"),
];

/// What a browser is told that asks whether it may ask.
const ALLOWED: [(&str, &str); 3] = [
    ("Access-Control-Allow-Methods", "GET, HEAD, OPTIONS"),
    ("Access-Control-Allow-Headers", "Range"),
    ("Access-Control-Allow-Private-Network", "true"),
];

/// A file, and what it is called to whoever asks.
#[derive(Clone, Debug)]
pub(super) struct Served {
    /// With the slash before it.
    pub(super) name: &'static str,
    pub(super) path: PathBuf,
}

/// A server of files.
pub(super) struct Server {
    http: tiny_http::Server,
    address: SocketAddr,
    files: Vec<Served>,
}

/// An answer with a part of a file, or nothing, as its body.
type Answer = Response<Box<dyn io::Read + Send>>;

impl Server {
    /// Listens on `port` of the loopback address, or on a free one if that is 0.
    pub(super) fn start(port: u16, files: Vec<Served>) -> io::Result<Self> {
        let http =
            tiny_http::Server::http((Ipv4Addr::LOCALHOST, port)).map_err(io::Error::other)?;
        let address = http.server_addr().to_ip().unwrap_or((Ipv4Addr::LOCALHOST, port).into());
        Ok(Self { http, address, files })
    }

    pub(super) fn address(&self) -> SocketAddr {
        self.address
    }

    /// Answers until `ends` says so.
    pub(super) fn serve(&self, ends: impl Fn() -> bool + Sync) {
        thread::scope(|scope| {
            for _ in 0..WORKERS {
                scope.spawn(|| {
                    while !ends() {
                        if let Ok(Some(request)) = self.http.recv_timeout(WAIT) {
                            let answer = self.answer(&request);
                            // Whoever has gone away needs no answer.
                            let _ = request.respond(answer);
                        }
                    }
                });
            }
        });
    }

    fn answer(&self, request: &Request) -> Answer {
        match request.method() {
            Method::Options => with_headers(empty(204), &ALLOWED),
            Method::Get | Method::Head => {
                let name = request.url().split('?').next().unwrap_or_default();
                match self.files.iter().find(|file| file.name == name) {
                    Some(file) => part_of(file, range(request)).unwrap_or_else(|_| empty(500)),
                    None => empty(404),
                }
            }
            _ => empty(405),
        }
    }
}

/// The header `Range` of `request`.
fn range(request: &Request) -> Option<&str> {
    let header = request.headers().iter().find(|header| header.field.equiv("Range"));
    header.map(|header| header.value.as_str())
}

/// The part of `file` that `range` asks for; all of it without one, and for several at once.
fn part_of(file: &Served, range: Option<&str>) -> io::Result<Answer> {
    let mut opened = File::open(&file.path)?;
    let length = opened.metadata()?.len();
    let asked = range.and_then(|range| parse_range_header(range).ok());
    let (status, part) = match asked.map(|ranges| ranges.validate(length)) {
        Some(Ok(ranges)) if ranges.len() == 1 => (206, Some(ranges[0].clone())),
        Some(Err(_)) => {
            let all = format!("bytes */{length}");
            return Ok(with_headers(empty(416), &[("Content-Range", all.as_str())]));
        }
        _ => (200, None),
    };
    let (start, count) =
        part.as_ref().map_or((0, length), |part| (*part.start(), part.end() - part.start() + 1));
    opened.seek(SeekFrom::Start(start))?;
    let body: Box<dyn io::Read + Send> = Box::new(opened.take(count));
    let answer = Response::new(
        StatusCode(status),
        headers(&ALWAYS),
        body,
        usize::try_from(count).ok(),
        None,
    )
    // A viewer wants to know the length beforehand.
    .with_chunked_threshold(usize::MAX);
    let answer = with_headers(answer, &[("Content-Type", "application/octet-stream")]);
    Ok(match part {
        Some(part) => {
            with_headers(answer, &[("Content-Range", content_range(&part, length).as_str())])
        }
        None => answer,
    })
}

fn content_range(part: &RangeInclusive<u64>, length: u64) -> String {
    format!("bytes {}-{}/{length}", part.start(), part.end())
}

fn empty(status: u16) -> Answer {
    let body: Box<dyn io::Read + Send> = Box::new(io::empty());
    Response::new(StatusCode(status), headers(&ALWAYS), body, Some(0), None)
}

fn with_headers(answer: Answer, more: &[(&str, &str)]) -> Answer {
    headers(more).into_iter().fold(answer, Response::with_header)
}

fn headers(pairs: &[(&str, &str)]) -> Vec<Header> {
    // Every one of them is plain ASCII, so none is left out.
    pairs.iter().filter_map(|(name, value)| Header::from_bytes(*name, *value).ok()).collect()
}
