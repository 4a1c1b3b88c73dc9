//! Records of impacts for tests.

use runner::beds::Record;

use super::matrix::{Cell, GRAVITY, MASS, READINGS};
use super::tables::published;

/// An impact along `range` and `depth` (m), sampled every `interval` (s), that stops with its last sample.
pub(crate) fn record(interval: f64, range: Vec<f64>, depth: Vec<f64>) -> Record {
    let end = interval * (depth.len() as f64 - 1.0);
    Record {
        interval,
        contact_height: 0.0,
        stopping_time: Some(end),
        slow_time: Some(end),
        deepest: depth.iter().copied().fold(0.0, f64::max),
        reached: range.last().copied().unwrap_or(0.0),
        range,
        force: Vec::new(),
        depth,
        end,
        crater: None,
        impact_energy: 0.0,
        closure: 0.0,
        ledger: Vec::new(),
        grains: 0,
        steps: 0,
        wall: 0.0,
    }
}

/// An impact straight down from `speed` (m/s) against a `force` (N) of depth (m) and velocity (m/s), integrated finely
/// until it stops, or for a second.
pub(crate) fn straight_down(speed: f64, force: impl Fn(f64, f64) -> f64) -> Record {
    let (mut depth, mut velocity, dt) = (0.0, speed, 1e-6);
    let (mut path, mut time) = (vec![0.0], 0.0);
    for step in 1..1_000_000 {
        let at = |y: f64, v: f64| GRAVITY - force(y, v) / MASS;
        let half = velocity + 0.5 * dt * at(depth, velocity);
        depth += dt * half;
        velocity = half + 0.5 * dt * at(depth, half);
        time = f64::from(step) * dt;
        if step % 500 == 0 {
            path.push(depth);
        }
        if velocity <= 0.0 {
            break;
        }
    }
    let stopped = record(5e-4, vec![0.0; path.len()], path);
    Record { deepest: depth, stopping_time: Some(time), end: time, ..stopped }
}

/// Cells as printed at `angle_deg` (deg), one of the tables, with a record of each of these speeds (m/s).
pub(crate) fn cells(angle_deg: f64, speeds: &[f64], of: impl Fn(f64) -> Record) -> Vec<Cell> {
    let published = published(angle_deg).expect("an angle of the tables");
    let cell =
        |&speed: &f64| Cell { reading: &READINGS[0], published, speed, records: vec![of(speed)] };
    speeds.iter().map(cell).collect()
}
