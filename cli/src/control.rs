//! Progress on a terminal or for a host, warnings, and whether to go on.

use std::io::{self, IsTerminal};
use std::sync::Arc;
use std::time::Duration;

use configs::printable;
use indicatif::{HumanDuration, ProgressBar, ProgressStyle};
use runner::Watch;
use runner::run::{Control, Progress};

use crate::host::{self, Host};
use crate::output::{self, CommandError};
use crate::signals;

/// What the terminal shows, and signals say, while a model runs; or the host in place of both.
pub(crate) struct Terminal {
    host: Option<Arc<Host>>,
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
    /// A bar of progress, unless nobody would see it.
    pub(crate) fn new(quiet: bool) -> Self {
        let host = host::current();
        let shown = !quiet && host.is_none() && io::stderr().is_terminal();
        let bar = if shown { ProgressBar::no_length() } else { ProgressBar::hidden() };
        Self { host, bar, bar_of: None, quiet }
    }

    /// What a command that was asked to stop ends with.
    pub(crate) fn interrupted(&self, consequence: &str) -> CommandError {
        self.clear();
        stopped(consequence)
    }

    /// Takes the bar away.
    pub(crate) fn clear(&self) {
        self.bar.finish_and_clear();
    }

    fn say(&self, message: &str) {
        if !self.quiet {
            let text = format!("warning: {}\n", printable(message));
            match &self.host {
                Some(host) => host.tell(&text),
                None => self.bar.suspend(|| output::to_stderr(&text)),
            }
        }
    }

    fn is_asked_to_stop(&self) -> bool {
        self.host.as_ref().map_or_else(signals::is_asked_to_stop, |host| host.is_stopped())
    }

    /// Tells the host; on a terminal, the bar has it.
    fn tell_progress(&self, words: impl FnOnce() -> String, share: Option<f64>) {
        if let Some(host) = &self.host {
            host.is_at(host::Progress { words: words(), share });
        }
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

/// What a command ends with that a signal has stopped.
pub(crate) fn stopped(consequence: &str) -> CommandError {
    CommandError::Partly { code: signals::exit_status(), message: signals::words(consequence) }
}

/// Impacts side by side.
impl Watch for Terminal {
    fn progress(&self, progress: &runner::Progress) {
        let what = match progress.what {
            runner::Stage::Beds => "beds",
            runner::Stage::Impacts => "impacts",
        };
        if self.bar.length() != Some(progress.of as u64) {
            self.bar.set_length(progress.of as u64);
            self.bar.set_style(style("{msg}{bar:24} {pos}/{len}, {prefix}"));
            self.bar.enable_steady_tick(Duration::from_millis(200));
        }
        self.bar.set_message(format!("{what} "));
        let share = progress.done as f64 / progress.of.max(1) as f64;
        self.tell_progress(|| format!("{} of {} {what}", progress.done, progress.of), Some(share));
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
                let words = format!("{time:.3} s, {restlessness:.1e} of rest");
                self.tell_progress(|| format!("bed settling, {words}"), None);
                self.bar.set_message(words);
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
                let words = format!("{time:.3} s, {:.1} mm deep, {speed:.2} m/s", 1e3 * depth);
                let share = (index as f64 + step as f64 / last_step.max(1) as f64) / of as f64;
                self.tell_progress(|| words.clone(), Some(share));
                self.bar.set_message(words);
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
