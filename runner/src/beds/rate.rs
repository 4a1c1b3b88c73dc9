//! How fast this machine runs impacts side by side: measured by every campaign, kept beside the cache.

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use configs::GrainModel;
use engine::checkpoint::write_whole;

use super::record::Record;
use crate::error::CampaignError;

/// Work of settling a bed, in that of an impact on it: three to six, by the height that grains fall
/// from and by how long the last of them roll.
pub const SETTLING: f64 = 4.0;

/// Share of the pace of grains in flight at which a bed at rest runs: it has contacts.
const AT_REST: f64 = 0.5;

/// For how long a machine is looked at that has never run anything.
const LOOK: Duration = Duration::from_millis(300);

/// The file beside the cache.
const FILE: &str = "grain-steps-per-second";

/// Work done by one thread, all of them busy.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Rate {
    /// Grain-steps.
    work: f64,
    /// Of one thread (s).
    time: f64,
}

impl Rate {
    /// Takes an impact into account.
    pub(super) fn learn(&mut self, record: &Record) {
        self.work += record.grains as f64 * record.steps as f64;
        self.time += record.wall;
    }

    /// Grain-steps per second of one thread, if anything was run.
    pub(super) fn per_second(&self) -> Option<f64> {
        (self.time > 0.0 && self.work > 0.0).then(|| self.work / self.time)
    }

    /// Writes it down in `cache`; without it the next plan is estimated anew, which is no error.
    pub(super) fn store(&self, cache: &Path) {
        if let Some(rate) = self.per_second() {
            let _ = write_whole(&cache.join(FILE), format!("{rate:.4e}\n").as_bytes());
        }
    }
}

/// Grain-steps per second of one thread: as the last campaign with this cache had it, else a look at how
/// fast grains of `model` fall.
pub(super) fn grain_steps_per_second(
    cache: &Path,
    model: GrainModel<'_>,
) -> Result<f64, CampaignError> {
    let kept = fs::read_to_string(cache.join(FILE)).ok();
    let kept = kept.and_then(|text| text.trim().parse::<f64>().ok());
    if let Some(rate) = kept.filter(|rate| rate.is_finite() && *rate > 0.0) {
        return Ok(rate);
    }
    let Some(mut settling) = model.settling()? else {
        return Ok(configs::estimate::RATE_PER_THREAD);
    };
    let (start, mut steps) = (Instant::now(), 0_u64);
    while start.elapsed() < LOOK {
        settling.advance()?;
        steps += 1;
    }
    let pace = (steps * model.n_grains()) as f64 / start.elapsed().as_secs_f64();
    Ok(AT_REST * pace)
}
