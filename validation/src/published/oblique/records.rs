//! Records of impacts for tests.

use crate::beds::Record;

/// An impact along `range` and `depth` (m), sampled every `interval` (s), that stops with its last sample.
pub(crate) fn record(interval: f64, range: Vec<f64>, depth: Vec<f64>) -> Record {
    let end = interval * (depth.len() as f64 - 1.0);
    Record {
        interval,
        stopping_time: Some(end),
        slow_time: Some(end),
        deepest: depth.iter().copied().fold(0.0, f64::max),
        reached: range.last().copied().unwrap_or(0.0),
        range,
        depth,
        end,
        impact_energy: 0.0,
        closure: 0.0,
        ledger: Vec::new(),
        grains: 0,
        steps: 0,
        wall: 0.0,
    }
}
