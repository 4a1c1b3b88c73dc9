//! One level of the surface for several runs, from how their paths depart from free fall.
//!
//! A path alone does not say well in which form it departs, and so where. Runs into one bed share level
//! and form: the level that fits all of them is known much better than by each. Where levels differ, form and scatter are
//! shared, and each run has its own.

use crate::contact::departure::{Departure, Trial};
use crate::reading::Reading;

/// Levels that are tried at a time, and how often the best are looked at more closely.
const LEVELS: usize = 201;
const LOOKS: usize = 4;

/// Standard errors by which chi-squared of one level for all runs exceeds that of a level for each where levels differ.
const DIFFER: f64 = 1.5;

/// How often an interval of the scatter is halved.
const HALVINGS: usize = 60;

/// Least variance of a level (m²).
const LEAST: f64 = 1e-12;

/// The number of levels that are tried of one run.
const ALONE: usize = 4001;

/// Chi-squared of a level that is out of reach of a path.
const OUT_OF_REACH: f64 = 1e4;

/// Chi-squared above the least that a look goes on with.
const NEAR: f64 = 25.0;

/// Chi-squared above that of the best form up to which another is as good, and what each run adds to it.
const AS_GOOD: (f64, f64) = (9.0, 1.0);

/// Where the surface is for several runs.
#[derive(Clone, Debug, PartialEq)]
pub enum Levels {
    /// All have one level (m).
    One(Reading),
    /// Levels differ by more than their errors.
    Each {
        /// Level (m) of each run, with its error against the others.
        levels: Vec<Reading>,
        /// Error (m) that they share: the form in which the bed resists is not known.
        shared: f64,
    },
}

/// Levels (m) of `runs`: the depths of free fall at contact, on their common scale. `None` without runs.
pub fn levels(runs: &[&Departure]) -> Option<Levels> {
    let curves = curves(runs)?;
    let (together, least_misfit) = together(runs, &curves);
    let alone: Vec<Vec<Posterior>> =
        curves.iter().map(|own| own.iter().map(Curve::alone).collect()).collect();
    let misfit = |own: &Vec<Posterior>| own.iter().map(|one| one.misfit).sum::<f64>();
    let freedom = (runs.len() - 1) as f64;
    let excess = least_misfit - least(alone.iter().map(misfit));
    if runs.len() == 1 || excess <= freedom + DIFFER * (2.0 * freedom).sqrt() {
        let (level, shared) = mean_of_forms(&together, runs.len());
        return Some(Levels::One(Reading { se: libm::hypot(level.se, shared), ..level }));
    }
    let scattered: Vec<Vec<Posterior>> = alone.iter().map(|own| scattered(own)).collect();
    let of_run = |run: usize| {
        let own: Vec<Posterior> = scattered.iter().map(|own| own[run]).collect();
        mean_of_forms(&own, runs.len())
    };
    let (levels, shared): (Vec<Reading>, Vec<f64>) = (0..runs.len()).map(of_run).unzip();
    let shared = libm::sqrt(shared.iter().map(|one| one * one).sum::<f64>() / runs.len() as f64);
    Some(Levels::Each { levels, shared })
}

/// Least chi-squared of one level for all `runs`. `None` without runs.
pub fn misfit_of_one_level(runs: &[&Departure]) -> Option<f64> {
    Some(together(runs, &curves(runs)?).1)
}

/// By form, the curve of each run.
fn curves(runs: &[&Departure]) -> Option<Vec<Vec<Curve>>> {
    let mut forms: Vec<usize> = runs.first()?.trials.iter().map(|trial| trial.form).collect();
    forms.sort_unstable();
    forms.dedup();
    let of_form = |form: &usize| runs.iter().map(|run| Curve::of(run, *form)).collect();
    Some(forms.iter().map(of_form).collect())
}

/// Levels of runs for one form, if levels scatter between runs as much as `alone`, those of each run alone, say (Paule & Mandel
/// 1982, *Journal of Research of the National Bureau of Standards*, 87, 377). The misfit is of all runs.
fn scattered(alone: &[Posterior]) -> Vec<Posterior> {
    let mean = |scatter: f64| {
        let weight = |one: &Posterior| 1.0 / (one.variance + scatter);
        let sum = alone.iter().map(weight).sum::<f64>();
        alone.iter().map(|one| weight(one) * one.level).sum::<f64>() / sum
    };
    let distance = |scatter: f64| {
        let mean = mean(scatter);
        let of = |one: &Posterior| (one.level - mean).powi(2) / (one.variance + scatter);
        alone.iter().map(of).sum::<f64>()
    };
    let freedom = (alone.len() - 1) as f64;
    let center = mean(0.0);
    let mut most = alone.iter().map(|one| (one.level - center).powi(2)).sum::<f64>();
    let mut fewest = 0.0;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (fewest + most);
        if distance(middle) > freedom { fewest = middle } else { most = middle }
    }
    let (scatter, center) = (most, mean(most));
    let misfit = |one: &Posterior| one.misfit + libm::log(1.0 + scatter / one.variance);
    let misfit = alone.iter().map(misfit).sum::<f64>() + distance(scatter);
    let of = |one: &Posterior| {
        let own = scatter / (one.variance + scatter);
        Posterior {
            misfit,
            level: center + own * (one.level - center),
            variance: own * one.variance,
        }
    };
    alone.iter().map(of).collect()
}

/// The level of all runs, form by form, and the least misfit.
fn together(runs: &[&Departure], curves: &[Vec<Curve>]) -> (Vec<Posterior>, f64) {
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
    let of_form = |form: usize| {
        Posterior::of(tried.iter().filter(|one| one.0 == form).map(|one| (one.1, one.2)))
    };
    ((0..curves.len()).map(of_form).collect(), least(tried.iter().map(|one| one.2)))
}

/// The mean over forms, and the error (m) by which they differ.
fn mean_of_forms(forms: &[Posterior], runs: usize) -> (Reading, f64) {
    // No bed follows a form exactly, so a form that fits nearly as well as the best counts as much.
    let as_good = least(forms.iter().map(|one| one.misfit)) + AS_GOOD.0 + AS_GOOD.1 * runs as f64;
    let good: Vec<&Posterior> = forms.iter().filter(|one| one.misfit <= as_good).collect();
    let mean =
        |of: fn(&Posterior) -> f64| good.iter().map(|one| of(one)).sum::<f64>() / good.len() as f64;
    let [first, last] = [f64::min, f64::max]
        .map(|end| good.iter().map(|one| one.level).reduce(end).unwrap_or_default());
    // A bed may differ from the forms as much as they differ from each other: levels within that distance of the mean are
    // equally likely.
    let shared = (last - first) / libm::sqrt(3.0);
    let se = mean(|one| one.variance).sqrt();
    (Reading { value: mean(|one| one.level), se }, shared)
}

/// A level (m) for one form.
#[derive(Clone, Copy, Debug)]
struct Posterior {
    /// Least chi-squared.
    misfit: f64,
    level: f64,
    variance: f64,
}

impl Posterior {
    /// Of levels that are equally far apart, with their chi-squared.
    fn of(tried: impl Iterator<Item = (f64, f64)> + Clone) -> Self {
        let misfit = least(tried.clone().map(|one| one.1));
        let from = least(tried.clone().map(|one| one.0));
        let weight = |misfit_here: f64| libm::exp(-0.5 * (misfit_here - misfit));
        let sum =
            |power: i32| tried.clone().map(|one| weight(one.1) * (one.0 - from).powi(power)).sum();
        let [all, first, second]: [f64; 3] = [0, 1, 2].map(sum);
        let mean = first / all;
        Self { misfit, level: from + mean, variance: (second / all - mean * mean).max(LEAST) }
    }
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

    /// The level of this run alone.
    fn alone(&self) -> Posterior {
        let [first, last] = [self.0.first(), self.0.last()].map(|end| end.map_or(0.0, |end| end.0));
        let level = |k: usize| first + (last - first) * k as f64 / (ALONE - 1) as f64;
        Posterior::of((0..ALONE).map(level).map(|level| (level, self.at(level))))
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
