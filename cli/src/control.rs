//! Progress on a terminal or for a host, warnings, and whether to go on.

use std::io::{self, IsTerminal};
use std::sync::Arc;
use std::time::{Duration, Instant};

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
    decay: Decay,
    quiet: bool,
}

/// How fast a bed comes to rest: what it is judged by falls about exponentially after its peak.
#[derive(Default)]
struct Decay {
    /// When, and how high.
    peak: Option<(Instant, f64)>,
}

impl Decay {
    /// The time left at the mean rate since the peak; `None` before it is clearly past. The rate becomes smaller on
    /// the way and a bed stays at rest for a while before it is used, so it takes at least this.
    fn left(&mut self, restlessness: f64, now: Instant) -> Option<Duration> {
        let (since, peak) = *self.peak.insert(match self.peak {
            Some((since, peak)) if restlessness <= peak => (since, peak),
            _ => (now, restlessness),
        });
        let fallen = libm::log(peak / restlessness);
        let to_fall = libm::log(restlessness).max(0.0);
        let left = now.duration_since(since).as_secs_f64() * to_fall / fallen;
        // Half of the peak: before, the rate is mostly noise.
        (fallen > std::f64::consts::LN_2).then(|| Duration::try_from_secs_f64(left).ok()).flatten()
    }
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
        Self { host, bar, bar_of: None, decay: Decay::default(), quiet }
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

    /// How fast steps are done.
    fn pace(&self) -> String {
        format!("{:.0} steps/s", self.bar.per_sec())
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
        // A bar of nothing would be a full one.
        if progress.of > 0 && self.bar.length() != Some(progress.of as u64) {
            self.bar.set_length(progress.of as u64);
            self.bar.set_style(style("{msg}{bar:24} {pos}/{len}, {prefix}"));
            self.bar.enable_steady_tick(Duration::from_millis(200));
        }
        self.bar.set_message(format!("{what} "));
        let share = progress.done as f64 / progress.of.max(1) as f64;
        self.tell_progress(|| format!("{} of {} {what}", progress.done, progress.of), Some(share));
        let left = progress
            .left
            .map_or(String::new(), |left| format!("about {} left", HumanDuration(left)));
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
                if self.bar_of != Some(BarOf::Settling) {
                    self.decay = Decay::default();
                }
                self.show(BarOf::Settling, "{spinner} settling, {msg}, {elapsed}");
                let left = self.decay.left(restlessness, Instant::now());
                let left = left.filter(|left| left.as_secs() > 0).map_or(String::new(), |left| {
                    format!(", at least {:#} left", HumanDuration(left))
                });
                let words = format!("{time:.3} s, motion {restlessness:.0e} (rest: 1){left}");
                self.tell_progress(|| format!("bed settling, {words}"), None);
                self.bar.set_message(format!("{words}, {}", self.pace()));
                self.bar.set_position(step);
            }
            Progress::Impact { index, of, step, last_step, time, depth, speed } => {
                self.show(BarOf::Impact(index), "{prefix}{bar:12} {msg}, at most {eta} left");
                if of > 1 {
                    self.bar.set_prefix(format!("{}/{of} ", index + 1));
                }
                self.bar.set_length(last_step);
                self.bar.set_position(step);
                let words = format!("{time:.3} s, {:.1} mm deep, {speed:.2} m/s", 1e3 * depth);
                let share = (index as f64 + step as f64 / last_step.max(1) as f64) / of as f64;
                self.tell_progress(|| words.clone(), Some(share));
                self.bar.set_message(format!("{words}, {}", self.pace()));
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bed_that_falls_exponentially_has_the_time_left_that_it_takes() {
        let (start, rate) = (Instant::now(), 0.5);
        let mut decay = Decay::default();
        let mut left_at = |seconds: u64, restlessness: f64| {
            decay.left(restlessness, start + Duration::from_secs(seconds))
        };
        assert_eq!(left_at(0, 10.0), None);
        assert_eq!(left_at(2, 1e6), None);
        assert_eq!(left_at(3, 0.9e6), None);
        for seconds in [6, 12, 25] {
            let now = 1e6 * libm::exp(-rate * (seconds as f64 - 2.0));
            let left = left_at(seconds, now).map(|left| left.as_secs_f64());
            let exact = libm::log(now) / rate;
            assert!(
                left.is_some_and(|left| (left - exact).abs() < 1e-6 * exact),
                "{left:?} {exact}"
            );
        }
        assert_eq!(left_at(60, 0.5), Some(Duration::ZERO));
        assert_eq!(left_at(61, 0.0), Some(Duration::ZERO));
    }
}
