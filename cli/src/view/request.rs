//! What a client asks for, read within bounds.

use std::io::{self, Read as _};
use std::net::TcpStream;
use std::time::{Duration, Instant};

use httparse::{Error, Header, Status};

/// Most bytes of the line and the headers of a request; browsers send a tenth of it.
const MOST_BYTES: usize = 8 << 10;

/// Most headers.
const MOST_HEADERS: usize = 64;

/// How long a client may take to ask.
const TIME_TO_ASK: Duration = Duration::from_secs(5);

/// Names of this machine for itself. A page that calls it by another name has had that name resolved to it,
/// which is how pages from elsewhere get at servers that only listen here.
const THIS_MACHINE: [&str; 3] = ["127.0.0.1", "localhost", "[::1]"];

/// A request that can be answered.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Request {
    pub(super) method: Method,
    /// With the slash before it, and without what stands behind a question mark.
    pub(super) path: String,
    /// The header `Range`.
    pub(super) range: Option<String>,
    /// Whether to go on as a WebSocket (RFC 6455).
    pub(super) upgrade: Option<Upgrade>,
}

/// What a client says that wants a WebSocket.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Upgrade {
    /// The header `Sec-WebSocket-Key`.
    pub(super) key: String,
    /// The header `Sec-WebSocket-Protocol`: names with commas between them.
    pub(super) protocols: String,
}

/// What is to be done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Method {
    Get,
    Head,
    Options,
}

/// Why a request has no other answer than a status.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Refusal {
    /// The status.
    Status(u16),
    /// The client has gone, or does not ask.
    Silence,
}

/// Reads a request from `stream`; of what comes behind its headers nothing is read.
pub(super) fn read(stream: &TcpStream) -> Result<Request, Refusal> {
    let deadline = Instant::now() + TIME_TO_ASK;
    let mut bytes = Vec::with_capacity(1 << 10);
    loop {
        if let Some(request) = parse(&bytes)? {
            return Ok(request);
        }
        if bytes.len() >= MOST_BYTES {
            return Err(Refusal::Status(431));
        }
        let mut part = [0; 1 << 10];
        let room = part.len().min(MOST_BYTES - bytes.len());
        match read_until(stream, deadline, &mut part[..room]) {
            Ok(0) | Err(_) => return Err(Refusal::Silence),
            Ok(n) => bytes.extend_from_slice(&part[..n]),
        }
    }
}

/// Reads what is there, or waits for it until `deadline`.
fn read_until(mut stream: &TcpStream, deadline: Instant, part: &mut [u8]) -> io::Result<usize> {
    let left = deadline.saturating_duration_since(Instant::now());
    if left.is_zero() {
        return Err(io::ErrorKind::TimedOut.into());
    }
    stream.set_read_timeout(Some(left))?;
    stream.read(part)
}

/// The request that `bytes` begin with; none if they end before it does.
fn parse(bytes: &[u8]) -> Result<Option<Request>, Refusal> {
    let mut headers = [httparse::EMPTY_HEADER; MOST_HEADERS];
    let mut head = httparse::Request::new(&mut headers);
    match head.parse(bytes) {
        Ok(Status::Partial) => return Ok(None),
        Ok(Status::Complete(_)) => {}
        Err(Error::TooManyHeaders) => return Err(Refusal::Status(431)),
        Err(_) => return Err(Refusal::Status(400)),
    }
    let method = match head.method {
        Some("GET") => Method::Get,
        Some("HEAD") => Method::Head,
        Some("OPTIONS") => Method::Options,
        _ => return Err(Refusal::Status(405)),
    };
    match value(head.headers, "Host") {
        Some(host) if is_this_machine(host) => {}
        Some(_) => return Err(Refusal::Status(421)),
        None => return Err(Refusal::Status(400)),
    }
    let length = value(head.headers, "Content-Length").unwrap_or("0");
    if length != "0" || value(head.headers, "Transfer-Encoding").is_some() {
        return Err(Refusal::Status(413));
    }
    let path = head.path.unwrap_or_default().split('?').next().unwrap_or_default();
    let range = value(head.headers, "Range").map(str::to_owned);
    let upgrade = upgrade(head.headers).filter(|_| method == Method::Get);
    Ok(Some(Request { method, path: path.to_owned(), range, upgrade }))
}

/// What `headers` say of a WebSocket; nothing if they do not ask for one of the version that there is.
fn upgrade(headers: &[Header<'_>]) -> Option<Upgrade> {
    let says = |name: &str, wanted: &str| {
        let mut words = value(headers, name).unwrap_or_default().split(',').map(str::trim);
        words.any(|word| word.eq_ignore_ascii_case(wanted))
    };
    if !says("Upgrade", "websocket") || !says("Connection", "upgrade") {
        return None;
    }
    let text = |name: &str| value(headers, name).map(str::to_owned);
    let key = text("Sec-WebSocket-Key").filter(|_| says("Sec-WebSocket-Version", "13"))?;
    Some(Upgrade { key, protocols: text("Sec-WebSocket-Protocol").unwrap_or_default() })
}

/// The value of the only header called `name`; one that is not text has none.
fn value<'a>(headers: &[Header<'a>], name: &str) -> Option<&'a str> {
    let mut named = headers.iter().filter(|header| header.name.eq_ignore_ascii_case(name));
    match (named.next(), named.next()) {
        (Some(header), None) => str::from_utf8(header.value).ok().map(str::trim),
        // Which of several is meant nobody can say: it is taken for something that fits nothing.
        (Some(_), Some(_)) => Some("several"),
        (None, _) => None,
    }
}

/// Whether `host`, with a port or without, names this machine.
fn is_this_machine(host: &str) -> bool {
    let name = match host.rsplit_once(':') {
        Some((name, port)) if port.bytes().all(|byte| byte.is_ascii_digit()) => name,
        _ => host,
    };
    THIS_MACHINE.iter().any(|one| one.eq_ignore_ascii_case(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn status(request: &str) -> u16 {
        match parse(request.as_bytes()) {
            Err(Refusal::Status(status)) => status,
            other => panic!("{request:?}: {other:?}"),
        }
    }

    #[test]
    fn a_request_is_read_whole_and_what_follows_it_is_not() {
        let text = "GET /run.mcap?t=1 HTTP/1.1\r\nhost: LocalHost:8791\r\nrange: bytes=0-9\r\n\r\n";
        for end in 0..text.len() {
            assert_eq!(parse(&text.as_bytes()[..end]), Ok(None), "{end}");
        }
        let request = Request {
            method: Method::Get,
            path: "/run.mcap".to_owned(),
            range: Some("bytes=0-9".to_owned()),
            upgrade: None,
        };
        assert_eq!(parse(format!("{text}GET").as_bytes()), Ok(Some(request)));
    }

    #[test]
    fn a_websocket_is_asked_for_by_all_of_its_headers() {
        let headers = [
            "Upgrade: WebSocket",
            "Connection: keep-alive, Upgrade",
            "Sec-WebSocket-Version: 13",
            "Sec-WebSocket-Key: a2V5",
        ];
        let upgrade = |headers: &[&str]| {
            let headers = headers.join("\r\n");
            let text = format!("GET / HTTP/1.1\r\nHost: [::1]:1\r\n{headers}\r\n\r\n");
            parse(text.as_bytes()).expect("a request").expect("a whole one").upgrade
        };
        let wanted = Upgrade { key: "a2V5".to_owned(), protocols: String::new() };
        assert_eq!(upgrade(&headers), Some(wanted));
        for missing in 0..headers.len() {
            let others: Vec<_> = headers.into_iter().filter(|h| *h != headers[missing]).collect();
            assert_eq!(upgrade(&others), None, "{missing}");
        }
    }

    #[test]
    fn what_has_a_body_or_calls_this_machine_by_another_name_is_refused() {
        let with = |header: &str| format!("GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n{header}\r\n\r\n");
        assert_eq!(status(&with("Content-Length: 99999999999")), 413);
        assert_eq!(status(&with("Transfer-Encoding: chunked")), 413);
        assert_eq!(status(&with("Content-Length: 0\r\nContent-Length: 0")), 413);
        assert_eq!(status(&with("Host: evil.example")), 421);
        assert_eq!(status("GET / HTTP/1.1\r\nHost: evil.example:8791\r\n\r\n"), 421);
        assert_eq!(status("GET / HTTP/1.1\r\nHost: 127.0.0.1.evil.example\r\n\r\n"), 421);
        assert_eq!(status("GET / HTTP/1.1\r\n\r\n"), 400);
        assert_eq!(status("POST / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"), 405);
        assert_eq!(status(&with(&"X: y\r\n".repeat(MOST_HEADERS))), 431);
        assert_eq!(status("\0\0\0\0"), 400);
    }
}
