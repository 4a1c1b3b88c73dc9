//! One level of the surface for several runs, from how their paths depart from free fall.
//!
//! A path alone does not say well in which form it departs, and so where. Runs into one bed share level
//! and form: the level that fits all of them is known much better than by each.

use super::departure::{Departure, Trial};
use super::reading::Reading;

/// Levels that are tried at a time, and how often the best are looked at more closely.
const LEVELS: usize = 201;
const LOOKS: usize = 4;

/// Chi-squared of a level that is out of reach of a path.
const OUT_OF_REACH: f64 = 1e4;

/// Chi-squared above the least that a look goes on with.
const NEAR: f64 = 25.0;

/// Chi-squared above that of the best form up to which another is as good, and what each run adds to it.
const AS_GOOD: (f64, f64) = (9.0, 1.0);

/// A level (m) that all of `runs` may have: the depth of free fall at contact, on their common scale. `None` where
/// the runs differ by more than their errors, or there are none.
#[must_use]
pub fn common_level(runs: &[&Departure]) -> Option<Reading> {
    let mut forms: Vec<usize> = runs.first()?.trials.iter().map(|trial| trial.form).collect();
    forms.sort_unstable();
    forms.dedup();
    let curves: Vec<Vec<Curve>> =
        forms.iter().map(|form| runs.iter().map(|run| Curve::of(run, *form)).collect()).collect();
    let depths = || runs.iter().map(|run| run.contact.depth);
    let mut low = depths().map(|depth| depth.value - 8.0 * depth.se).fold(f64::INFINITY, f64::min);
    let mut high =
        depths().map(|depth| depth.value + 8.0 * depth.se).fold(f64::NEG_INFINITY, f64::max);
    let mut tried = Vec::new();
    for _ in 0..LOOKS {
        let step = (high - low) / (LEVELS - 1) as f64;
        let levels = (0..LEVELS).map(|k| low + step * k as f64);
        let at = |level: f64| {
            let sum = move |own: &Vec<Curve>| own.iter().map(|one| one.at(level)).sum::<f64>();
            curves.iter().enumerate().map(move |(form, own)| (form, level, sum(own)))
        };
        tried = levels.flat_map(at).collect::<Vec<(usize, f64, f64)>>();
        let best = least(tried.iter().map(|one| one.2));
        let near = || tried.iter().filter(|one| one.2 <= best + NEAR).map(|one| one.1);
        let ends = (least(near()) - step, near().fold(f64::NEG_INFINITY, f64::max) + step);
        if ends.1 - ends.0 > 0.5 * (high - low) {
            break;
        }
        (low, high) = ends;
    }
    let best = least(tried.iter().map(|one| one.2));
    let own = |curve: &Curve| least(curve.0.iter().map(|one| one.1));
    let apart = least(curves.iter().map(|curves| curves.iter().map(own).sum()));
    let freedom = (runs.len() - 1) as f64;
    // Levels differ a little from drop to drop: what is refused is far beyond the errors.
    if best - apart > freedom + 6.0 * (2.0 * freedom).sqrt() {
        return None;
    }
    let of_form = |form: usize| {
        let own = || tried.iter().filter(|one| one.0 == form);
        let best = least(own().map(|one| one.2));
        let weight = |misfit: f64| libm::exp(-0.5 * (misfit - best));
        let sum = |power: i32| own().map(|one| weight(one.2) * (one.1 - low).powi(power)).sum();
        let [all, first, second]: [f64; 3] = [0, 1, 2].map(sum);
        (best, first / all, second / all - (first / all).powi(2))
    };
    // No bed follows a form exactly, so a form that fits nearly as well as the best counts as much.
    let as_good = AS_GOOD.0 + AS_GOOD.1 * runs.len() as f64;
    let forms = (0..curves.len()).map(of_form).filter(|one| one.0 - best <= as_good);
    let (means, variances): (Vec<f64>, Vec<f64>) = forms.map(|one| (one.1, one.2)).unzip();
    let mean = |of: &[f64]| of.iter().sum::<f64>() / of.len() as f64;
    let range =
        means.iter().copied().fold(f64::NEG_INFINITY, f64::max) - least(means.iter().copied());
    // A bed may differ from the forms as much as they differ from each other: levels within that distance of the mean are
    // equally likely.
    let se = (mean(&variances).max(0.0) + range * range / 3.0).sqrt();
    Some(Reading { value: low + mean(&means), se })
}

fn least(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::INFINITY, f64::min)
}

/// Chi-squared of one run over the level, for one form.
struct Curve(Vec<(f64, f64)>);

impl Curve {
    fn of(run: &Departure, form: usize) -> Self {
        let own = run.trials.iter().filter(|trial| trial.form == form);
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
