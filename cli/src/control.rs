//! Progress on a terminal, warnings, and the signals that stop a run.

use std::io::{self, IsTerminal};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Duration;

use anyhow::Context as _;
use configs::printable;
use configs::run::{Control, Progress};
use indicatif::{HumanDuration, ProgressBar, ProgressStyle};
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::flag;
use validation::beds::{self as campaign, Watch};

use crate::output::{self, CommandError};

/// What the terminal and the signals say while a model runs.
pub(crate) struct Terminal {
    /// The signal that asked to stop; 0 for none.
    signal: Arc<AtomicUsize>,
    bar: ProgressBar,
    bar_of: Option<BarOf>,
    quiet: bool,
}

/// What the bar shows at present.
#[derive(Clone, Copy, PartialEq)]
enum BarOf {
    Settling,
    Impact(usize),
}

impl Terminal {
    /// Listens for signals: the first asks the run to stop, a second ends the program at once. A signal
    /// that is ignored, as `nohup` has it, stays ignored.
    pub(crate) fn new(quiet: bool) -> anyhow::Result<Self> {
        let signal = Arc::new(AtomicUsize::new(0));
        let asked = Arc::new(AtomicBool::new(false));
        let ignored = ignored_signals();
        for number in [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|n| ignored >> (n - 1) & 1 == 0)
        {
            flag::register_conditional_shutdown(number, 128 + number, Arc::clone(&asked))
                .and_then(|_| flag::register(number, Arc::clone(&asked)))
                .and_then(|_| {
                    flag::register_usize(
                        number,
                        Arc::clone(&signal),
                        number.unsigned_abs() as usize,
                    )
                })
                .context("cannot listen for signals")?;
        }
        let shown = !quiet && io::stderr().is_terminal();
        let bar = if shown { ProgressBar::no_length() } else { ProgressBar::hidden() };
        Ok(Self { signal, bar, bar_of: None, quiet })
    }

    /// What a command that was asked to stop ends with.
    pub(crate) fn interrupted(&self, consequence: &str) -> CommandError {
        CommandError::Partly {
            code: 128 + self.signal.load(Ordering::Relaxed) as u8,
            message: format!("stopped by a signal; {consequence}\n"),
        }
    }

    /// Takes the bar away.
    pub(crate) fn clear(&self) {
        self.bar.finish_and_clear();
    }

    fn say(&self, message: &str) {
        if !self.quiet {
            let text = format!("warning: {}\n", printable(message));
            self.bar.suspend(|| output::to_stderr(&text));
        }
    }

    /// Whether a signal has asked to stop.
    pub(crate) fn is_asked_to_stop(&self) -> bool {
        self.signal.load(Ordering::Relaxed) != 0
    }

    fn show(&mut self, what: BarOf, template: &str) {
        if self.bar_of == Some(what) {
            return;
        }
        self.bar_of = Some(what);
        self.bar.reset();
        self.bar.set_style(style(template));
        self.bar.enable_steady_tick(Duration::from_millis(200));
    }
}

/// The signals that whoever started the program had it ignore, signal n as bit n − 1, where the system
/// says so.
fn ignored_signals() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

/// Impacts side by side.
impl Watch for Terminal {
    fn progress(&self, progress: &campaign::Progress) {
        let what = match progress.what {
            campaign::Stage::Beds => "beds",
            campaign::Stage::Impacts => "impacts",
        };
        if self.bar.length() != Some(progress.of as u64) {
            self.bar.set_length(progress.of as u64);
            self.bar.set_style(style("{msg}{bar:24} {pos}/{len}, {prefix}"));
            self.bar.enable_steady_tick(Duration::from_millis(200));
        }
        self.bar.set_message(format!("{what} "));
        let left = progress.left.map_or(String::new(), |left| {
            format!("about {} left", HumanDuration(Duration::from_secs_f64(left)))
        });
        self.bar.set_prefix(left);
        self.bar.set_position(progress.done as u64);
    }

    fn warn(&self, message: &str) {
        self.say(message);
    }

    fn wants_to_stop(&self) -> bool {
        self.is_asked_to_stop()
    }
}

/// A style of the bar.
fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template)
        .unwrap_or_else(|_| unreachable!("the templates are constants that indicatif accepts"))
        .progress_chars("━╸ ")
}

impl Control for Terminal {
    fn progress(&mut self, progress: &Progress) {
        match *progress {
            Progress::Settling { step, time, restlessness } => {
                self.show(BarOf::Settling, "{spinner} bed settling, {msg}, {per_sec}, {elapsed}");
                self.bar.set_message(format!("{time:.3} s, {restlessness:.1e} of rest"));
                self.bar.set_position(step);
            }
            Progress::Impact { index, of, step, last_step, time, depth, speed } => {
                self.show(
                    BarOf::Impact(index),
                    "{prefix}{bar:24} {msg}, {per_sec}, at most {eta} left",
                );
                if of > 1 {
                    self.bar.set_prefix(format!("{}/{of} ", index + 1));
                }
                self.bar.set_length(last_step);
                self.bar.set_position(step);
                self.bar.set_message(format!(
                    "{time:.3} s, {:.1} mm deep, {speed:.2} m/s",
                    1e3 * depth
                ));
            }
        }
    }

    fn warn(&mut self, message: &str) {
        self.say(message);
    }

    fn wants_to_stop(&self) -> bool {
        self.is_asked_to_stop()
    }
}
