//! One level of the surface for several runs, from how their paths depart from free fall.
//!
//! A path alone does not say well with which power of time it departs, and so where. Runs into one bed share level
//! and power: the level that fits all of them is known much better than by each.

use super::contact::{Departure, Trial};
use super::reading::Reading;

/// Levels that are tried at a time, and how often the best are looked at more closely.
const LEVELS: usize = 201;
const LOOKS: usize = 4;

/// Chi-squared of a level that is out of reach of a path.
const OUT_OF_REACH: f64 = 1e4;

/// Chi-squared above the least that a look goes on with.
const NEAR: f64 = 25.0;

/// A level (m) that all of `runs` may have: the depth of free fall at contact, on their common scale. `None` where
/// the runs differ by more than their errors, or there are none.
#[must_use]
pub fn common_level(runs: &[&Departure]) -> Option<Reading> {
    let mut powers: Vec<f64> = runs.first()?.trials.iter().map(|trial| trial.power).collect();
    powers.sort_by(f64::total_cmp);
    powers.dedup();
    let curves: Vec<Vec<Curve>> = powers
        .iter()
        .map(|power| runs.iter().map(|run| Curve::of(run, *power)).collect())
        .collect();
    let depths = || runs.iter().map(|run| run.contact.depth);
    let mut low = depths().map(|depth| depth.value - 8.0 * depth.se).fold(f64::INFINITY, f64::min);
    let mut high =
        depths().map(|depth| depth.value + 8.0 * depth.se).fold(f64::NEG_INFINITY, f64::max);
    let mut tried = Vec::new();
    for _ in 0..LOOKS {
        let step = (high - low) / (LEVELS - 1) as f64;
        let levels = (0..LEVELS).map(|k| low + step * k as f64);
        let at = |level: f64| {
            curves.iter().map(move |own| (level, own.iter().map(|one| one.at(level)).sum::<f64>()))
        };
        tried = levels.flat_map(at).collect::<Vec<(f64, f64)>>();
        let best = least(tried.iter().map(|one| one.1));
        let near = || tried.iter().filter(|one| one.1 <= best + NEAR).map(|one| one.0);
        let ends = (least(near()) - step, near().fold(f64::NEG_INFINITY, f64::max) + step);
        if ends.1 - ends.0 > 0.5 * (high - low) {
            break;
        }
        (low, high) = ends;
    }
    let best = least(tried.iter().map(|one| one.1));
    let own = |curve: &Curve| least(curve.0.iter().map(|one| one.1));
    let apart = least(curves.iter().map(|curves| curves.iter().map(own).sum()));
    let freedom = (runs.len() - 1) as f64;
    // Levels differ a little from drop to drop: what is refused is far beyond the errors.
    if best - apart > freedom + 6.0 * (2.0 * freedom).sqrt() {
        return None;
    }
    let (mut sum, mut first, mut second) = (0.0, 0.0, 0.0);
    for (level, misfit) in tried {
        let weight = libm::exp(-0.5 * (misfit - best));
        let off = level - low;
        sum += weight;
        first += weight * off;
        second += weight * off * off;
    }
    let mean = first / sum;
    Some(Reading { value: low + mean, se: (second / sum - mean * mean).max(0.0).sqrt() })
}

fn least(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::INFINITY, f64::min)
}

/// Chi-squared of one run over the level, for one power.
struct Curve(Vec<(f64, f64)>);

impl Curve {
    fn of(run: &Departure, power: f64) -> Self {
        let own = run.trials.iter().filter(|trial| trial.power.total_cmp(&power).is_eq());
        let mut points: Vec<(f64, f64)> =
            own.map(|&Trial { depth, misfit, .. }| (depth, misfit)).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        Self(points)
    }

    fn at(&self, level: f64) -> f64 {
        let behind = self.0.partition_point(|point| point.0 < level);
        match (behind.checked_sub(1).and_then(|before| self.0.get(before)), self.0.get(behind)) {
            (Some(a), Some(b)) => {
                let share = if b.0 > a.0 { (level - a.0) / (b.0 - a.0) } else { 0.0 };
                a.1 + share * (b.1 - a.1)
            }
            (Some(end), None) | (None, Some(end)) => end.1 + OUT_OF_REACH,
            (None, None) => OUT_OF_REACH,
        }
    }
}
