//! Tasks that are waited for.

use std::process::Child;

use super::{Scheduler, SchedulerError};

/// Calls of a scheduler that end when their tasks have. Dropped, it waits no more; the tasks stay where they
/// are.
#[derive(Debug)]
pub struct Waiting {
    scheduler: Scheduler,
    calls: Vec<Child>,
    all_well: bool,
}

impl Waiting {
    pub(super) fn new(scheduler: Scheduler) -> Self {
        Self { scheduler, calls: Vec::new(), all_well: true }
    }

    pub(super) fn push(&mut self, call: Child) {
        self.calls.push(call);
    }

    /// Whether all tasks have ended: nothing while some have not, then whether every one ended well.
    ///
    /// # Errors
    /// If the scheduler refused.
    pub fn ended(&mut self) -> Result<Option<bool>, SchedulerError> {
        let scheduler = self.scheduler;
        let lost = |source| scheduler.not_there(source);
        let mut at = 0;
        while at < self.calls.len() {
            if self.calls[at].try_wait().map_err(lost)?.is_none() {
                at += 1;
                continue;
            }
            let output = self.calls.swap_remove(at).wait_with_output().map_err(lost)?;
            // What was taken on is named on stdout, before it is waited for.
            if !output.status.success() && output.stdout.is_empty() {
                return Err(scheduler.refused(&output.stderr));
            }
            self.all_well &= output.status.success();
        }
        Ok(self.calls.is_empty().then_some(self.all_well))
    }
}

impl Drop for Waiting {
    fn drop(&mut self) {
        for call in &mut self.calls {
            // One that has just ended cannot be killed, and need not.
            drop(call.kill());
            drop(call.wait());
        }
    }
}
