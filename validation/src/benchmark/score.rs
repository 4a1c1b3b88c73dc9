//! A row of a table: what was measured beside what is asked for.

use super::interval::{Share, interval_of_median, quantile};

/// A row of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Score {
    /// What is measured.
    pub metric: String,
    /// What came out.
    pub measured: Measured,
    /// What it is held against.
    pub target: Target,
}

/// What came out.
#[derive(Clone, Debug, PartialEq)]
pub enum Measured {
    /// How many of how many.
    Share(Share),
    /// Of many numbers.
    Spread {
        /// First quartile, median, third quartile; none of none.
        quartiles: Option<[f64; 3]>,
        /// 95 % interval of the median; none of too few.
        median: Option<[f64; 2]>,
        /// How many.
        n: usize,
    },
}

/// What a number is held against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// At least.
    AtLeast(f64),
    /// At most.
    AtMost(f64),
    /// From, to.
    Within(f64, f64),
    /// Only shown.
    None,
}

/// What became of a target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reached {
    /// It is met.
    Met,
    /// The estimate reaches it, from too few trials to show it.
    NotShown,
    /// The estimate misses it.
    Missed,
}

/// From so many trials on the estimate decides; with fewer the end of the interval that is nearer to missing.
const ENOUGH: usize = 60;

impl Target {
    /// What became of it; `None` where nothing is asked or nothing was measured.
    #[must_use]
    pub fn reached(self, measured: &Measured) -> Option<Reached> {
        let (estimate, interval, n) = match measured {
            Measured::Share(share) => (share.value()?, Some(share.interval()), share.n),
            Measured::Spread { quartiles, median, n } => ((*quartiles)?[1], *median, *n),
        };
        let holds = |value: f64| match self {
            Self::AtLeast(least) => value >= least,
            Self::AtMost(most) => value <= most,
            Self::Within(from, to) => (from..=to).contains(&value),
            Self::None => false,
        };
        let shown = n >= ENOUGH || interval.is_some_and(|ends| ends.into_iter().all(holds));
        match (self, holds(estimate), shown) {
            (Self::None, ..) => None,
            (_, true, true) => Some(Reached::Met),
            (_, true, false) => Some(Reached::NotShown),
            (_, false, _) => Some(Reached::Missed),
        }
    }
}

/// A row of many numbers.
pub(super) fn spread(metric: String, values: &[f64], target: Target) -> Score {
    let at = |share| quantile(values, share);
    let quartiles = at(0.25).zip(at(0.5)).zip(at(0.75)).map(|((a, b), c)| [a, b, c]);
    let median = interval_of_median(values);
    Score { metric, measured: Measured::Spread { quartiles, median, n: values.len() }, target }
}
