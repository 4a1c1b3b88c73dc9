//! Whether the force drifts from run to run, or a run remembers the one before it.
//!
//! Runs are compared with the mean of their own condition, so that no error of the model enters.

use rand::RngExt;
use rand_pcg::Pcg64;

use super::groups::GROUPS;
use super::normal::Normal;
use super::part::ForceError;
use super::trend::Trend;
use crate::fit::problem::{FitProblem, Fitted};
use crate::misfit::covariate::{Covariate, ORDER, PREVIOUS_RUN};
use crate::random::{Purpose, stream};

/// Orders of the runs that are drawn.
const DRAWS: usize = 9_999;

/// Fewest deviations of runs from the mean of their condition that show a drift.
const ENOUGH: usize = 6;

/// Probability of error at which a set counts as drifting, over both tests.
const ALPHA: f64 = 0.01;

/// What hangs on the order of runs.
#[derive(Default)]
pub(super) struct Chronology {
    /// Over the order, and over the previous run of the same condition.
    pub(super) trends: Vec<Trend>,
    /// Deviations from the means of conditions, by order.
    pub(super) groups: Vec<ForceError>,
}

impl Chronology {
    /// Of the runs of those conditions whose order is known; empty if they are too few.
    pub(super) fn of(
        problem: &FitProblem<'_>,
        fitted: &Fitted,
        normals: &[Normal],
        seed: u64,
    ) -> Self {
        let series: Vec<Series> = normals
            .iter()
            .zip(&fitted.weights)
            .filter_map(|(normal, weight)| {
                let observed = &problem.observed.conditions[normal.condition];
                let force = |run| {
                    let white = weight.whiten(&observed.deviation(run));
                    normal.whole.dot(&white) / normal.whole.norm_squared()
                };
                let weight = normal.whole.norm_squared() / observed.runs.len() as f64;
                Series::new(&observed.order, force, weight)
            })
            .collect();
        let runs: usize = series.iter().map(|series| series.force.len()).sum();
        if runs < series.len() + ENOUGH {
            return Self::default();
        }
        let found = Statistics::of(&series);
        let mut random = stream(seed, Purpose::Order, 0);
        let mut shuffled = series.clone();
        let drawn: Vec<Statistics> = (0..DRAWS)
            .map(|_| {
                shuffled.iter_mut().for_each(|series| shuffle(&mut series.force, &mut random));
                Statistics::of(&shuffled)
            })
            .collect();
        let trend = |over: Covariate, n, centre, of: fn(&Statistics) -> f64| {
            let by_chance: Vec<f64> = drawn.iter().map(of).collect();
            let mean = by_chance.iter().sum::<f64>() / DRAWS as f64;
            let variance = by_chance.iter().map(|s| (s - mean).powi(2)).sum::<f64>() / DRAWS as f64;
            // In any order a run lies on the other side of its mean than the rest: that is no memory.
            let slope = of(&found) - mean;
            let as_far = by_chance.iter().filter(|s| (*s - mean).abs() >= slope.abs()).count();
            Trend {
                over: over.name,
                unit: over.unit,
                n,
                centre,
                force_error: 0.0,
                slope,
                se: variance.sqrt(),
                p: (1 + as_far) as f64 / (1 + DRAWS) as f64,
                significant: false,
            }
        };
        let orders = || series.iter().flat_map(|series| &series.order).copied();
        let ends = (orders().fold(f64::INFINITY, f64::min), orders().fold(0.0, f64::max));
        let trends = vec![
            trend(ORDER, runs, 0.5 * (ends.0 + ends.1), |found| found.drift),
            trend(PREVIOUS_RUN, runs - series.len(), 0.0, |found| found.memory),
        ];
        Self { trends, groups: groups(&series) }
    }
}

/// Those of `trends` over the order of runs that hold at 1 % together (Holm 1979, Scand. J. Stat. 6,
/// 65).
pub(super) fn beyond_chance(trends: &[Trend]) -> Vec<&'static str> {
    let over = |trend: &&Trend| [ORDER.name, PREVIOUS_RUN.name].contains(&trend.over);
    let mut tests: Vec<&Trend> = trends.iter().filter(over).collect();
    tests.sort_by(|a, b| a.p.total_cmp(&b.p));
    let n = tests.len();
    let holds = |(at, trend): &(usize, &Trend)| trend.p <= ALPHA / (n - at) as f64;
    tests.into_iter().enumerate().take_while(holds).map(|(_, trend)| trend.over).collect()
}

/// Runs of one condition in their order.
#[derive(Clone)]
struct Series {
    /// Place among all runs.
    order: Vec<f64>,
    /// The same less its mean.
    centred: Vec<f64>,
    /// By how much the force was larger than in the mean of the runs.
    force: Vec<f64>,
    /// Information of one run on its force.
    weight: f64,
}

impl Series {
    /// `None` where an order is missing, or nothing follows on anything.
    fn new(order: &[Option<i64>], force: impl Fn(usize) -> f64, weight: f64) -> Option<Self> {
        let order: Vec<i64> = order.iter().copied().collect::<Option<_>>()?;
        let mut places: Vec<usize> = (0..order.len()).collect();
        places.sort_by_key(|&run| (order[run], run));
        let force: Vec<f64> = places.iter().map(|&run| force(run)).collect();
        let order: Vec<f64> = places.iter().map(|&run| order[run] as f64).collect();
        let mean = order.iter().sum::<f64>() / order.len() as f64;
        let centred: Vec<f64> = order.iter().map(|place| place - mean).collect();
        let usable = order.len() > 1 && weight > 0.0 && force.iter().all(|f| f.is_finite());
        usable.then_some(Self { order, centred, force, weight })
    }
}

/// What an order of runs shows.
struct Statistics {
    /// Change of the force error per run.
    drift: f64,
    /// Share of the force error of a run that the next run of its condition has too, drift aside.
    memory: f64,
}

impl Statistics {
    fn of(all: &[Series]) -> Self {
        let (mut along, mut length) = (0.0, 0.0);
        for series in all {
            for (order, force) in series.centred.iter().zip(&series.force) {
                along += series.weight * order * force;
                length += series.weight * order * order;
            }
        }
        let drift = if length > 0.0 { along / length } else { 0.0 };
        let (mut shared, mut size) = (0.0, 0.0);
        for series in all {
            let rest = |run: usize| series.force[run] - drift * series.centred[run];
            for run in 1..series.force.len() {
                shared += series.weight * rest(run) * rest(run - 1);
                size += series.weight * rest(run - 1).powi(2);
            }
        }
        Self { drift, memory: if size > 0.0 { shared / size } else { 0.0 } }
    }
}

/// Fifths of all runs in their order.
fn groups(all: &[Series]) -> Vec<ForceError> {
    let mut runs: Vec<(f64, f64, f64)> = Vec::new();
    for series in all {
        let each = series.order.iter().zip(&series.force);
        runs.extend(each.map(|(order, force)| (*order, *force, series.weight)));
    }
    runs.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let freedom = (runs.len() - all.len()) as f64;
    let variance = runs.iter().map(|(_, force, weight)| weight * force * force).sum::<f64>();
    let size = runs.len().div_ceil(GROUPS);
    let group = |runs: &[(f64, f64, f64)]| {
        let weight: f64 = runs.iter().map(|run| run.2).sum();
        ForceError {
            over: ORDER.name,
            from: runs[0].0,
            to: runs[runs.len() - 1].0,
            force_error: runs.iter().map(|run| run.1 * run.2).sum::<f64>() / weight,
            se: (variance / freedom / weight).sqrt(),
        }
    };
    runs.chunks(size).map(group).collect()
}

/// Any order with equal probability (Fisher & Yates).
fn shuffle(values: &mut [f64], random: &mut Pcg64) {
    for last in (1..values.len()).rev() {
        values.swap(last, random.random_range(0..=last));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trend(over: Covariate, p: f64) -> Trend {
        let Covariate { name, unit, .. } = over;
        let (n, centre, force_error, slope, se) = (10, 0.0, 0.0, 1.0, 0.1);
        Trend { over: name, unit, n, centre, force_error, slope, se, p, significant: false }
    }

    #[test]
    fn of_two_tests_the_second_may_be_as_likely_as_one_alone() {
        let both = |a, b| beyond_chance(&[trend(ORDER, a), trend(PREVIOUS_RUN, b)]);
        assert_eq!(both(0.009, 0.004), ["previous_run", "order"]);
        assert!(both(0.009, 0.006).is_empty());
        assert_eq!(both(0.001, 0.5), ["order"]);
    }

    #[test]
    fn a_drift_is_no_memory() {
        let force = |run: usize| 0.01 * (run as f64 - 4.5);
        let order: Vec<Option<i64>> = (0..10).map(Some).collect();
        let series = Series::new(&order, force, 1.0).expect("ten runs");
        let found = Statistics::of(&[series]);
        // The slope is exact up to rounding, and nothing is left over.
        assert!((found.drift - 0.01).abs() < 1e-15, "{}", found.drift);
        assert!(Series::new(&[Some(1), None], |_| 0.0, 1.0).is_none());
    }
}
