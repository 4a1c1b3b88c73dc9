//! Many tasks side by side: each on one thread, as many at a time as there are workers.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use engine::parallel::with_threads;

use crate::error::CampaignError;
use crate::run::{self, Control};

/// How far a campaign has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// What is being done.
    pub what: Stage,
    /// Done, those that were kept counted.
    pub done: usize,
    /// Of how many.
    pub of: usize,
    /// Time that is left at the pace so far; `None` before there is a pace.
    pub left: Option<Duration>,
}

/// The time left at the pace of `spent`, in which a `share` of the work was done; `None` before there is a pace.
pub(crate) fn left(spent: Duration, share: f64) -> Option<Duration> {
    // A share that is a sum of parts may round to more than one.
    let rest = (1.0 - share).max(0.0) / share;
    Duration::try_from_secs_f64(spent.as_secs_f64() * rest).ok()
}

/// What a campaign is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Beds settle.
    Beds,
    /// Impacts run.
    Impacts,
}

/// Whoever watches a campaign, from several threads at once.
pub trait Watch: Sync {
    /// Called as often as something ends.
    fn progress(&self, progress: &Progress);
    /// Something that the user should know.
    fn warn(&self, message: &str);
    /// Whether to end; what is in flight is lost.
    fn wants_to_stop(&self) -> bool;
}

/// Nobody watches.
#[derive(Clone, Copy, Debug)]
pub struct Unattended;

impl Watch for Unattended {
    fn progress(&self, _: &Progress) {}
    fn warn(&self, _: &str) {}
    fn wants_to_stop(&self) -> bool {
        false
    }
}

/// What a worker listens to and tells.
pub struct WorkerSignals<'a> {
    /// Whether to stop.
    pub stop: &'a (dyn Fn() -> bool + Sync),
    /// Takes what the user should know.
    pub warn: &'a (dyn Fn(&str) + Sync),
}

impl Control for WorkerSignals<'_> {
    fn progress(&mut self, _: &run::Progress) {}

    fn warn(&mut self, message: &str) {
        (self.warn)(message);
    }

    fn wants_to_stop(&self) -> bool {
        (self.stop)()
    }
}

impl WorkerSignals<'static> {
    /// Nothing stops it, and what the user should know goes to stderr.
    pub fn unattended() -> Self {
        Self { stop: &|| false, warn: &|message| eprintln!("warning: {message}") }
    }
}

/// Who does tasks.
#[derive(Clone, Copy)]
pub struct Workers<'a> {
    /// Tasks at a time.
    pub number: usize,
    /// Whoever watches.
    pub watch: &'a dyn Watch,
}

impl Workers<'_> {
    /// Does `tasks` side by side, each on one thread; `before` of the stage have been done before, and
    /// `work` of a task (in any unit) is what the time left is estimated by. The longest are not sorted
    /// first, so that results come in the order in which they are asked for.
    ///
    /// # Errors
    /// The first of any task in their order, which keeps others from being begun;
    /// [`CampaignError::Interrupted`] if it was stopped.
    pub fn side_by_side<R: Send>(
        &self,
        what: Stage,
        tasks: &[usize],
        (work, before): (&(dyn Fn(&usize) -> f64 + Sync), usize),
        task: impl Fn(usize, &mut dyn Control) -> Result<R, CampaignError> + Sync,
    ) -> Result<Vec<R>, CampaignError> {
        let (next, start) = (AtomicUsize::new(0), Instant::now());
        let all: f64 = tasks.iter().map(work).sum();
        let done = Mutex::new((0_usize, 0.0));
        let slots: Vec<Mutex<Option<Result<R, CampaignError>>>> =
            tasks.iter().map(|_| Mutex::new(None)).collect();
        let failed = AtomicUsize::new(0);
        let stop = || self.watch.wants_to_stop() || failed.load(Ordering::Relaxed) > 0;
        let report = |done: usize, share: f64| {
            self.watch.progress(&Progress {
                what,
                done: before + done,
                of: before + tasks.len(),
                left: left(start.elapsed(), share),
            });
        };
        report(0, 0.0);
        std::thread::scope(|scope| {
            for _ in 0..self.number.min(tasks.len()) {
                scope.spawn(|| {
                    loop {
                        let place = next.fetch_add(1, Ordering::Relaxed);
                        let Some(&at) = tasks.get(place) else { break };
                        let warn = |message: &str| self.watch.warn(message);
                        let mut signals = WorkerSignals { stop: &stop, warn: &warn };
                        let result = match stop() {
                            true => Err(CampaignError::Interrupted),
                            false => with_threads(1, || task(at, &mut signals))
                                .map_err(CampaignError::from)
                                .flatten(),
                        };
                        if result.is_err() {
                            failed.fetch_add(1, Ordering::Relaxed);
                        }
                        *slots[place].lock().unwrap_or_else(PoisonError::into_inner) = Some(result);
                        let mut done = done.lock().unwrap_or_else(PoisonError::into_inner);
                        *done = (done.0 + 1, done.1 + work(&at));
                        report(done.0, done.1 / all);
                    }
                });
            }
        });
        let mut results = Vec::with_capacity(tasks.len());
        let mut interrupted = false;
        for slot in slots {
            match slot.into_inner().unwrap_or_else(PoisonError::into_inner) {
                Some(Ok(result)) => results.push(result),
                // One that failed stops the others, and they are not to blame.
                Some(Err(CampaignError::Interrupted)) | None => interrupted = true,
                Some(Err(error)) => return Err(error),
            }
        }
        if interrupted { Err(CampaignError::Interrupted) } else { Ok(results) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_left_is_at_the_pace_so_far_and_never_below_zero() {
        let spent = Duration::from_secs(30);
        assert_eq!(left(spent, 0.75), Some(Duration::from_secs(10)));
        // The last of many parts may round to more than all of them.
        assert_eq!(left(spent, 1.0 + f64::EPSILON), Some(Duration::ZERO));
        assert_eq!(left(spent, 0.0), None);
        assert_eq!(left(spent, f64::NAN), None);
    }
}
