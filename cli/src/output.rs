//! The only place that writes to stdout and stderr, or to the host in their place, and that knows the exit codes.

use std::io::{self, ErrorKind, IsTerminal, Write};
use std::process::ExitCode;

use configs::{Color, ConfigError, Loaded, printable};
use runner::CampaignError;
use runner::run::RunError;

use crate::host;
use crate::text::fitted;

/// Why a command did not do what was asked.
#[derive(Debug)]
pub(crate) enum CommandError {
    /// The input is wrong (exit code 2): the message as shown, ending in a line break.
    BadInput(String),
    /// Something failed on the way (exit code 1).
    Failed(anyhow::Error),
    /// It ended early, or not whole: the exit code, and the message as shown.
    Partly {
        /// The exit code.
        code: u8,
        /// The message, ending in a line break.
        message: String,
    },
}

impl CommandError {
    /// Bad input that is no part of a file.
    pub(crate) fn bad_input(message: impl std::fmt::Display) -> Self {
        Self::BadInput(format!("error: {}\n", printable(&message.to_string())))
    }
}

impl From<ConfigError> for CommandError {
    fn from(error: ConfigError) -> Self {
        Self::BadInput(error.render(stderr_color()))
    }
}

impl From<RunError> for CommandError {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Config(error) => error.into(),
            error if error.is_bad_input() => Self::bad_input(error),
            error => Self::Failed(error.into()),
        }
    }
}

impl From<CampaignError> for CommandError {
    fn from(error: CampaignError) -> Self {
        match error {
            CampaignError::Config(error) => error.into(),
            CampaignError::Run(error) => error.into(),
            error => Self::Failed(error.into()),
        }
    }
}

impl From<anyhow::Error> for CommandError {
    fn from(error: anyhow::Error) -> Self {
        Self::Failed(error)
    }
}

/// What a command comes to.
pub(crate) type CommandResult = Result<(), CommandError>;

/// Why a command has failed, as the command line says it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct Failure {
    /// The exit status: 1 failed while running, 2 bad input.
    pub status: u8,
    /// What is written to stderr, ending in a line break.
    pub message: String,
}

impl Failure {
    pub(crate) fn usage(error: &clap::Error) -> Self {
        let status = u8::try_from(error.exit_code()).unwrap_or(2);
        Self { status, message: error.to_string() }
    }
}

impl From<CommandError> for Failure {
    fn from(error: CommandError) -> Self {
        let (status, message) = match error {
            CommandError::BadInput(message) => (2, message),
            CommandError::Partly { code, message } => (code, printable_lines(&message)),
            CommandError::Failed(error) => {
                (1, format!("error: {}\n", printable(&with_causes(&error))))
            }
        };
        Self { status, message }
    }
}

/// Shows an error, if there is one, and gives the exit code.
pub(crate) fn conclude(result: CommandResult) -> ExitCode {
    let Err(error) = result else { return ExitCode::SUCCESS };
    let Failure { status, message } = error.into();
    to_stderr(&message);
    ExitCode::from(status)
}

/// What went wrong and why, each thing once: some errors say the words of their cause themselves.
fn with_causes(error: &anyhow::Error) -> String {
    error.chain().fold(String::new(), |text, cause| match cause.to_string() {
        words if text.contains(&words) => text,
        words if text.is_empty() => words,
        words => format!("{text}: {words}"),
    })
}

fn printable_lines(text: &str) -> String {
    text.lines().map(|line| format!("{}\n", printable(line))).collect()
}

/// Writes the result of a command; a reader that has left is no error.
pub(crate) fn to_stdout(text: &str) -> CommandResult {
    whole_to_stdout(&fitted(text))
}

/// Writes a result whose lines stay as they are: another program reads it.
pub(crate) fn whole_to_stdout(text: &str) -> CommandResult {
    // Names and sources are of files from anywhere. Scripts for shells have tabulators.
    let text = text.split('\t').map(configs::printable).collect::<Vec<_>>().join("\t");
    if let Some(host) = host::current() {
        host.print(&text);
        return Ok(());
    }
    let mut stdout = io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            let error = anyhow::Error::new(error).context("cannot write the result to stdout");
            Err(CommandError::Failed(error))
        }
        _ => Ok(()),
    }
}

/// Writes the one JSON object of a command.
pub(crate) fn json_to_stdout(object: &serde_json::Value) -> CommandResult {
    whole_to_stdout(&format!("{object:#}\n"))
}

/// Writes progress or a diagnostic; when even that fails there is nothing left to do.
pub(crate) fn to_stderr(text: &str) {
    if let Some(host) = host::current() {
        return host.tell(text);
    }
    let _ = io::stderr().write_all(text.as_bytes());
}

/// Shows the warnings that came with a model.
pub(crate) fn show_warnings(loaded: &Loaded) {
    to_stderr(&loaded.render_warnings(stderr_color()));
}

/// Colours on a terminal, unless `NO_COLOR` is set; none for a host.
pub(crate) fn stderr_color() -> Color {
    let unwanted = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty())
        || std::env::var_os("TERM").is_some_and(|term| term == "dumb");
    match io::stderr().is_terminal() && !unwanted && host::current().is_none() {
        true => Color::On,
        false => Color::Off,
    }
}

/// A number of bytes with two or three digits.
pub(crate) fn bytes(count: u64) -> String {
    let count = count as f64;
    match count {
        n if n < 1e6 => format!("{:.0} kB", n / 1e3),
        n if n < 1e9 => format!("{:.0} MB", n / 1e6),
        n if n < 1e12 => format!("{:.1} GB", n / 1e9),
        n if n < 1e15 => format!("{:.1} TB", n / 1e12),
        n => format!("{:.1} PB", n / 1e15),
    }
}
