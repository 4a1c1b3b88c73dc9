//! `plunge view`: a log over HTTP, asked as a browser asks.

use std::fs;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::common::{Call, folder};

/// A server that is told to end when this goes.
pub(crate) struct View {
    child: Child,
    pub(crate) port: u16,
}

/// An answer: status, headers in small letters, body.
struct Answer {
    status: u16,
    head: String,
    body: Vec<u8>,
}

impl View {
    pub(crate) fn of(run: &Path) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_plunge"));
        command.args(["view", "--json", "--port", "0"]).arg(run);
        let mut child = command.stdout(Stdio::piped()).spawn().expect("plunge starts");
        let stdout = child.stdout.take().expect("a pipe");
        // The object ends with the only line that begins with a closing brace.
        let mut text = String::new();
        for line in BufReader::new(stdout).lines() {
            text.push_str(&line.expect("text"));
            if text.ends_with('}') && serde_json::from_str::<Value>(&text).is_ok() {
                break;
            }
        }
        let told: Value = serde_json::from_str(&text).expect("an object");
        let port = told["port"].as_u64().and_then(|port| u16::try_from(port).ok()).expect("a port");
        assert_eq!(told["urls"][0], format!("http://127.0.0.1:{port}/run.mcap"));
        assert_eq!(told["page"], format!("http://127.0.0.1:{port}/"));
        assert_eq!(told["stream"], format!("ws://127.0.0.1:{port}"));
        assert_eq!(told["layout"], format!("http://127.0.0.1:{port}/plunge.json"));
        Self { child, port }
    }

    /// Of a run that goes on.
    pub(crate) fn of_live(mut child: Child) -> Self {
        let mut line = String::new();
        let stderr = child.stderr.take().expect("a pipe");
        BufReader::new(stderr).read_line(&mut line).expect("text");
        let port =
            line.trim().rsplit(':').next().and_then(|end| end.trim_end_matches('/').parse().ok());
        Self { child, port: port.expect(&line) }
    }

    /// Asks for the page, and gives its text and whether a browser is to ask again.
    fn page(&self) -> (String, bool) {
        let answer = self.ask("GET", "/", "");
        assert_eq!(answer.status, 200);
        let again = answer.head.lines().any(|line| line.starts_with("refresh: "));
        (String::from_utf8(answer.body).expect("text"), again)
    }

    fn ask(&self, method: &str, path: &str, headers: &str) -> Answer {
        self.ask_as("127.0.0.1", method, path, headers)
    }

    /// Sends a request, and reads nothing of the answer.
    fn sent(&self, method: &str, path: &str, headers: &str) -> TcpStream {
        self.sent_as("127.0.0.1", method, path, headers)
    }

    fn sent_as(&self, host: &str, method: &str, path: &str, headers: &str) -> TcpStream {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).expect("it listens");
        let origin = "Origin: https://viewer.example\r\nConnection: close\r\n";
        let text = format!("{method} {path} HTTP/1.1\r\nHost: {host}\r\n{origin}{headers}\r\n");
        // A server that has heard enough does not listen to the end.
        let _ = stream.write_all(text.as_bytes());
        stream
    }

    /// Asks, calling the server's machine `host`.
    fn ask_as(&self, host: &str, method: &str, path: &str, headers: &str) -> Answer {
        let mut stream = self.sent_as(host, method, path, headers);
        let mut whole = Vec::new();
        stream.read_to_end(&mut whole).expect("it answers");
        let end = whole.windows(4).position(|four| four == b"\r\n\r\n").expect("a head");
        let head = String::from_utf8_lossy(&whole[..end]).to_ascii_lowercase();
        let status = head.split(' ').nth(1).and_then(|word| word.parse().ok()).expect("a status");
        Answer { status, head, body: whole[end + 4..].to_vec() }
    }

    /// Waits for the end of a live run.
    pub(crate) fn ended(mut self) -> ExitStatus {
        self.child.wait().expect("it ends")
    }

    /// Ends it as a system does that shuts down; Ctrl-C may be ignored where tests run in the background.
    fn told_to_end(mut self) -> ExitStatus {
        let pid = self.child.id().to_string();
        let told = Command::new("kill").args(["-TERM", &pid]).status().expect("kill");
        assert!(told.success());
        self.child.wait().expect("it ends")
    }
}

impl Drop for View {
    fn drop(&mut self) {
        // Ended already where the test came so far.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A folder with something of the name of a log, and its bytes.
fn log() -> (tempfile::TempDir, Vec<u8>) {
    let here = folder();
    let bytes: Vec<u8> = (0..100_000_u32).map(|n| (n % 251) as u8).collect();
    fs::write(here.path().join("run.mcap"), &bytes).expect("a file");
    (here, bytes)
}

#[test]
fn a_log_is_served_whole_and_in_parts_to_pages_from_anywhere() {
    let (here, bytes) = log();
    let view = View::of(here.path());
    let whole = view.ask("GET", "/run.mcap?t=1", "");
    assert_eq!((whole.status, &whole.body), (200, &bytes));
    for (range, part, answered) in [
        ("bytes=0-9", &bytes[..10], "bytes 0-9/100000"),
        ("bytes=99990-", &bytes[99_990..], "bytes 99990-99999/100000"),
        ("bytes=-8", &bytes[99_992..], "bytes 99992-99999/100000"),
        ("bytes=50000-89999", &bytes[50_000..90_000], "bytes 50000-89999/100000"),
    ] {
        let answer = view.ask("GET", "/run.mcap", &format!("Range: {range}\r\n"));
        assert_eq!((answer.status, answer.body.as_slice()), (206, part), "{range}");
        for line in [
            format!("content-range: {answered}"),
            format!("content-length: {}", part.len()),
            "access-control-allow-origin: *".to_owned(),
            "accept-ranges: bytes".to_owned(),
        ] {
            assert!(answer.head.lines().any(|one| one == line), "no `{line}` in {}", answer.head);
        }
        let exposed = answer.head.lines().find(|line| line.contains("expose-headers"));
        assert!(exposed.is_some_and(|line| line.contains("content-range")), "{}", answer.head);
    }
}

#[test]
fn a_layout_for_viewers_is_that_of_what_was_logged() {
    let layouts = Path::new(env!("CARGO_MANIFEST_DIR")).join("../viewers");
    let (here, _) = log();
    let view = View::of(here.path());
    for logged in ["resistive", "grains"] {
        if logged == "grains" {
            fs::write(here.path().join("grains.mcap"), "grains").expect("a file");
        }
        let answer = view.ask("GET", "/plunge.json", "");
        let file = layouts.join(format!("foxglove_{logged}.json"));
        let expected = fs::read(&file).expect("a layout");
        assert_eq!((answer.status, answer.body), (200, expected), "{logged}");
        assert!(answer.head.contains("content-type: application/json"), "{}", answer.head);
    }
}

#[test]
fn what_is_not_there_is_refused_and_a_head_has_no_body() {
    let (here, _) = log();
    let view = View::of(&here.path().join("run.mcap"));
    let head = view.ask("HEAD", "/run.mcap", "");
    assert_eq!((head.status, head.body.len()), (200, 0));
    assert!(head.head.contains("content-length: 100000"), "{}", head.head);
    let beyond = view.ask("GET", "/run.mcap", "Range: bytes=100000-\r\n");
    assert_eq!((beyond.status, beyond.body.len()), (416, 0));
    assert!(beyond.head.contains("content-range: bytes */100000"), "{}", beyond.head);
    for path in ["/grains.mcap", "/report.html", "/../run.mcap", "/summary.json"] {
        assert_eq!(view.ask("GET", path, "").status, 404, "{path}");
    }
    assert_eq!(view.ask("POST", "/run.mcap", "Content-Length: 0\r\n").status, 405);
    let asked = "Access-Control-Request-Method: GET\r\nAccess-Control-Request-Headers: range\r\n";
    let may = view.ask("OPTIONS", "/run.mcap", asked);
    assert_eq!(may.status, 204);
    assert!(may.head.contains("access-control-allow-headers: range"), "{}", may.head);
}

/// Makes the run in `folder` one that goes on: its logs have no index and no end.
pub(crate) fn go_on(folder: &Path) {
    for name in ["run.mcap", "grains.mcap"] {
        let path = folder.join(name);
        let bytes = fs::read(&path).expect("a log");
        fs::write(folder.join(format!("{name}.partial")), &bytes[..bytes.len() - 64])
            .expect("a log");
        fs::remove_file(path).expect("a log");
    }
    fs::remove_file(folder.join("summary.json")).expect("a summary");
    fs::remove_file(folder.join("report.html")).expect("a report");
}

#[test]
fn a_run_that_goes_on_is_shown_reported_exported_and_filmed_as_far_as_it_has_come() {
    let here = folder();
    let run = here.path().join("run");
    Call::run(&run).done();
    let whole = View::of(&run);
    let (page, again) = whole.page();
    assert!(page.contains("stopping time") && !again, "{page}");

    go_on(&run);
    let view = View::of(&run);
    let (page, again) = view.page();
    assert!(page.contains("time so far") && page.contains("id=\"player\"") && again, "{page}");
    assert_eq!(view.ask("GET", "/run.mcap", "").status, 404);

    let call = |words: &[&str]| Call::new(words).arg(&run);
    call(&["report", "--quiet"]).done();
    assert!(run.join("report.partial.html").is_file() && !run.join("report.html").exists());
    let tables = here.path().join("tables");
    call(&["export", "--quiet", "--to", "csv"]).arg("--out").arg(&tables).done();
    assert!(fs::read_dir(&tables).expect("tables").count() > 1);
    let film = here.path().join("film.gif");
    call(&["movie", "--quiet"]).arg("--out").arg(&film).done();
    assert!(film.is_file());

    Call::run(&run).arg("--force").done();
    assert!(!run.join("report.partial.html").exists());
    let (page, again) = view.page();
    assert!(page.contains("stopping time") && !again, "{page}");
    for log in ["run.mcap", "grains.mcap"] {
        let length = fs::metadata(run.join(log)).expect("a log").len();
        let answer = view.ask("HEAD", &format!("/{log}"), "");
        assert!(answer.head.contains(&format!("content-length: {length}")), "{}", answer.head);
    }
}

#[test]
fn a_live_run_has_a_page_from_its_start_and_hands_over_its_last() {
    let here = folder();
    // A bed of its own takes a while to settle, so that it is asked before the end.
    let call = Call::run(here.path()).args(["--force", "--live=0"]);
    let view = View::of_live(call.set(&["bed.grains.0.count=1000", "run.seed=5"]).start());
    // It waits for who has asked once.
    let start = Instant::now();
    loop {
        let (page, again) = view.page();
        assert!(page.contains("<h1>"), "{page}");
        if !again {
            assert!(page.contains("stopping time"), "{page}");
            break;
        }
        assert!(start.elapsed() < Duration::from_secs(60), "no last page");
        std::thread::sleep(Duration::from_millis(20));
    }
    assert!(view.ended().success());
}

#[cfg(unix)]
#[test]
fn a_signal_ends_it_at_once_also_while_clients_ask_and_do_not_read() {
    let here = folder();
    // More than the buffers of a connection take.
    fs::write(here.path().join("run.mcap"), vec![0; 32 << 20]).expect("a file");
    let view = View::of(here.path());
    let idle: Vec<TcpStream> = (0..20).map(|_| view.sent("GET", "/run.mcap", "")).collect();
    assert_eq!(view.ask("HEAD", "/run.mcap", "").status, 200, "it answers others all the same");
    let told = Instant::now();
    assert_eq!(view.told_to_end().code(), Some(143));
    assert!(told.elapsed() < Duration::from_secs(2), "{:?}", told.elapsed());
    drop(idle);
}

#[test]
fn a_body_a_head_without_end_and_another_name_of_this_machine_are_refused_and_it_goes_on() {
    let (here, bytes) = log();
    let view = View::of(here.path());
    // A length that a server must not believe.
    for length in ["99999999999", "18446744073709551615", "1"] {
        let header = format!("Content-Length: {length}\r\n");
        assert_eq!(view.ask("GET", "/run.mcap", &header).status, 413, "{length}");
        assert_eq!(view.ask("POST", "/run.mcap", &header).status, 405, "{length}");
    }
    let endless = format!("X: {}\r\n", "y".repeat(1 << 20));
    assert_eq!(view.ask("GET", "/run.mcap", &endless).status, 431);
    for host in ["evil.example", "evil.example:8791", "127.0.0.1.evil.example"] {
        assert_eq!(view.ask_as(host, "GET", "/run.mcap", "").status, 421, "{host}");
    }
    for host in ["127.0.0.1", "127.0.0.1:8791", "localhost:1"] {
        assert_eq!(view.ask_as(host, "GET", "/run.mcap", "").body, bytes, "{host}");
    }
}

#[test]
fn clients_that_say_nothing_are_let_go_and_hold_up_nobody() {
    let (here, bytes) = log();
    let view = View::of(here.path());
    let mute: Vec<TcpStream> = (0..60)
        .map(|_| TcpStream::connect(("127.0.0.1", view.port)).expect("it listens"))
        .collect();
    assert_eq!(view.ask("GET", "/run.mcap", "").body, bytes);
    for mut one in mute {
        one.set_read_timeout(Some(Duration::from_secs(20))).expect("a time");
        assert_eq!(one.read(&mut [0]).expect("it closes within its five seconds"), 0);
    }
}
