//! Calls of the program on a model small enough for every test.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;
use std::thread::sleep;
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process};
use serde_json::Value;
use tempfile::TempDir;

/// Longest wait for something that takes far less than a second.
const PATIENCE: Duration = Duration::from_secs(60);

/// Runs begun at most to end one of them on its way.
const RUNS_TO_CATCH: usize = 20;

/// A model of 300 grains that runs in a fraction of a second.
pub(crate) fn small_model() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../configs/schema/tests/good/small-2d.toml")
}

/// An empty folder that goes away with its test.
pub(crate) fn folder() -> TempDir {
    tempfile::tempdir().expect("a folder")
}

/// The folder of prepared beds that the tests share, the bed of the small model in it.
pub(crate) fn cache() -> &'static Path {
    static CACHE: OnceLock<PathBuf> = OnceLock::new();
    CACHE.get_or_init(|| {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("beds");
        // Beds of an earlier build may be of an earlier engine.
        let _ = fs::remove_dir_all(&path);
        let bed = ["bed", "--cache"].map(OsStr::new);
        Call::new(bed).arg(&path).arg(small_model()).done();
        path
    })
}

/// Leaves a program of the text `script` at `path`.
#[cfg(unix)]
pub(crate) fn program(path: &Path, script: &str) {
    use std::os::unix::fs::PermissionsExt as _;
    fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
    fs::write(path, script).expect("a program");
    fs::set_permissions(path, fs::Permissions::from_mode(0o755)).expect("a program");
}

/// A call of the program, not yet made.
pub(crate) struct Call(Command);

/// What a call came to.
#[derive(Debug)]
pub(crate) struct Ended {
    /// Exit code; none if a signal ended it.
    pub(crate) code: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Call {
    pub(crate) fn new<S: AsRef<OsStr>>(arguments: impl IntoIterator<Item = S>) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_plunge"));
        command.args(arguments).env_remove("PLUNGE_CACHE").env_remove("NO_COLOR");
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        Self(command)
    }

    /// `plunge run` of the small model into `out`, with JSON on stdout.
    pub(crate) fn run(out: &Path) -> Self {
        Self::run_model(&small_model(), out)
    }

    /// `plunge run` of `model` into `out`, with JSON on stdout.
    pub(crate) fn run_model(model: &Path, out: &Path) -> Self {
        Self::new(["run", "--json", "--out"]).arg(out).arg("--cache").arg(cache()).arg(model)
    }

    pub(crate) fn arg(mut self, argument: impl AsRef<OsStr>) -> Self {
        self.0.arg(argument);
        self
    }

    pub(crate) fn args<S: AsRef<OsStr>>(mut self, arguments: impl IntoIterator<Item = S>) -> Self {
        self.0.args(arguments);
        self
    }

    /// The same call by a shell that first does `before`.
    pub(crate) fn after(self, before: &str) -> Self {
        let mut shell = Command::new("sh");
        shell.arg("-c").arg(format!("{before}; exec \"$0\" \"$@\""));
        shell.arg(self.0.get_program()).args(self.0.get_args()).env_remove("PLUNGE_CACHE");
        shell.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        Self(shell)
    }

    /// In the folder `here`.
    pub(crate) fn inside(mut self, here: &Path) -> Self {
        self.0.current_dir(here);
        self
    }

    /// Adds `--set` for each of `settings`.
    pub(crate) fn set(mut self, settings: &[&str]) -> Self {
        for setting in settings {
            self.0.args(["--set", setting]);
        }
        self
    }

    pub(crate) fn start(mut self) -> Child {
        self.0.spawn().expect("the program starts")
    }

    pub(crate) fn end(self) -> Ended {
        Ended::of(self.start())
    }

    /// Ends with exit code 0.
    pub(crate) fn done(self) -> Ended {
        let ended = self.end();
        assert_eq!(ended.code, Some(0), "{}", ended.stderr);
        ended
    }

    /// Ends with `code`, nothing on stdout, and a message without a trace of a panic.
    pub(crate) fn fails(self, code: i32) -> String {
        let ended = self.end();
        assert_eq!(ended.code, Some(code), "{ended:?}");
        assert_eq!(ended.stdout, "");
        assert!(!ended.stderr.is_empty() && !ended.stderr.contains("panicked"), "{ended:?}");
        ended.stderr
    }
}

impl Ended {
    pub(crate) fn of(child: Child) -> Self {
        let output = child.wait_with_output().expect("the program ends");
        let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
        let (stdout, stderr) = (text(output.stdout), text(output.stderr));
        Self { code: output.status.code(), stdout, stderr }
    }

    /// The one object on stdout.
    pub(crate) fn json(&self) -> Value {
        let value: Value = serde_json::from_str(&self.stdout).expect("one JSON value");
        assert!(value.is_object(), "{value}");
        value
    }

    /// The one object on stdout without what depends on the machine.
    pub(crate) fn result(&self) -> Value {
        without_cost(self.json())
    }
}

/// A summary without what depends on the machine.
pub(crate) fn without_cost(mut summary: Value) -> Value {
    summary.as_object_mut().expect("an object").remove("cost");
    for run in summary.get_mut("runs").and_then(Value::as_array_mut).into_iter().flatten() {
        run.as_object_mut().expect("an object").remove("cost");
    }
    summary
}

/// `summary.json` in `out`.
pub(crate) fn summary(out: &Path) -> Value {
    let text = fs::read_to_string(out.join("summary.json")).expect("summary.json");
    serde_json::from_str(&text).expect("JSON")
}

/// The names in `folder`, in order.
pub(crate) fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the folder");
    let name = |entry: std::io::Result<fs::DirEntry>| entry.expect("an entry").file_name();
    let mut names: Vec<String> =
        entries.map(|entry| name(entry).into_string().expect("UTF-8")).collect();
    names.sort();
    names
}

/// Asserts that the finished runs in `a` and `b` have the same bytes.
pub(crate) fn assert_same_run(a: &Path, b: &Path) {
    for name in ["run.mcap", "grains.mcap", "model.toml"] {
        let read = |folder: &Path| {
            fs::read(folder.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
        };
        // Without a list of a million differing bytes.
        assert!(read(a) == read(b), "{name} differs");
    }
    assert_eq!(without_cost(summary(a)), without_cost(summary(b)));
}

/// Sends the signal of that name to a program.
pub(crate) fn signal(child: &Child, name: &str) {
    let signal = match name {
        "TERM" => Signal::TERM,
        "INT" => Signal::INT,
        "HUP" => Signal::HUP,
        "KILL" => Signal::KILL,
        other => panic!("no test sends {other}"),
    };
    kill_process(Pid::from_child(child), signal).expect("it takes signals");
}

/// Ends `run` by `signals` once `file` is there, and asserts that it obeys within 2 s. On a busy
/// machine a run may be done before the signals come: then it is begun anew.
pub(crate) fn ended_on_the_way(run: impl Fn() -> Call, file: &Path, signals: &[&str]) -> Ended {
    for _ in 0..RUNS_TO_CATCH {
        let mut child = run().arg("--force").start();
        wait_for_unless(file, || child.try_wait().expect("its state").is_some());
        let sent = Instant::now();
        // Until it is waited for, its number is its own, whether it has ended or not.
        signals.iter().for_each(|name| signal(&child, name));
        let ended = Ended::of(child);
        assert!(sent.elapsed() < Duration::from_secs(2));
        if ended.code != Some(0) {
            return ended;
        }
    }
    panic!("{RUNS_TO_CATCH} runs were done before a signal came");
}

/// Waits until `path` is there.
pub(crate) fn wait_for(path: &Path) {
    wait_for_unless(path, || false);
}

/// Waits until `path` is there, or `is_over`.
fn wait_for_unless(path: &Path, mut is_over: impl FnMut() -> bool) {
    let start = Instant::now();
    while !path.exists() && !is_over() {
        assert!(start.elapsed() < PATIENCE, "{} never comes", path.display());
        sleep(Duration::from_millis(1));
    }
}
