//! What a response depends on: rank correlations with everything that was varied.
//!
//! Spearman's coefficient: 1 where the response always rises with a key, −1 where it always falls, near 0 where it
//! does not hang on it or both rises and falls. The interval is that of Fisher's transformation with the variance of
//! Fieller, Hartley & Pearson, Biometrika 1957: artanh ρ ± 1.96 (1.06 / (n − 3))^½.

use plots::sheet::{Anchor, INK, Layer, Mark, Sheet};
use statrs::statistics::{Data, OrderStatistics, RankTieBreaker, Statistics};

/// Fewest points of which a correlation says anything.
const FEWEST: usize = 8;

/// Standard deviations to either side that hold 95 % of a normal distribution.
const NORMAL_95: f64 = 1.96;

/// Of the transformed coefficient, times n − 3.
const VARIANCE: f64 = 1.06;

/// How a response goes with a key.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Dependence {
    /// What was varied.
    pub(super) key: String,
    /// Spearman's coefficient.
    pub(super) rank_correlation: f64,
    /// Where it lies, 95 %.
    pub(super) interval: [f64; 2],
}

impl Dependence {
    /// Of the pairs of numbers that are there; `None` of too few, and where either does not differ.
    pub(super) fn of(key: &str, x: &[Option<f64>], y: &[Option<f64>]) -> Option<Self> {
        let pairs = x.iter().zip(y).filter_map(|(x, y)| Some(((*x)?, (*y)?)));
        let (x, y): (Vec<f64>, Vec<f64>) = pairs.unzip();
        let n = x.len();
        if n < FEWEST {
            return None;
        }
        let [x, y] = [x, y].map(|values| Data::new(values).ranks(RankTieBreaker::Average));
        let covariance = x.iter().covariance(y.iter());
        let rank_correlation = covariance / (x.iter().std_dev() * y.iter().std_dev());
        // Round-off leaves the range that the transformation is of.
        let rank_correlation = rank_correlation.clamp(-1.0, 1.0);
        let reach = NORMAL_95 * (VARIANCE / (n as f64 - 3.0)).sqrt();
        let middle = libm::atanh(rank_correlation);
        let interval = [middle - reach, middle + reach].map(libm::tanh);
        rank_correlation.is_finite().then(|| Self {
            key: key.to_owned(),
            rank_correlation,
            interval,
        })
    }

    /// Whether it is told from none.
    pub(super) fn is_clear(&self) -> bool {
        self.interval[0] * self.interval[1] > 0.0
    }
}

/// A bar for each key from −1 to 1, with its interval.
pub(super) fn bars(found: &[Dependence]) -> String {
    const WIDTH: f64 = 400.0;
    const LETTERS: f64 = 7.0;
    const ROW: f64 = 28.0;
    let longest = found.iter().map(|one| one.key.chars().count()).max().unwrap_or(0);
    let left = (LETTERS * longest as f64 + 12.0).min(0.5 * WIDTH);
    let at = |value: f64| left + (WIDTH - left - 12.0) * 0.5 * (1.0 + value);
    let bottom = ROW * found.len() as f64 + 8.0;
    let letters = |place, text: String, anchor| Mark::Text {
        place,
        text,
        size: 11.5,
        anchor,
        upright: false,
    };
    let line = |from: [f64; 2], to: [f64; 2], width, dash| Mark::Line {
        points: vec![from, to],
        colour: INK,
        width,
        dash,
    };
    let mut marks = vec![line([at(0.0), 4.0], [at(0.0), bottom], 1.0, 0.0)];
    for (row, one) in found.iter().enumerate() {
        let middle = ROW * (row as f64 + 0.5) + 4.0;
        let [from, to] = [at(one.rank_correlation.min(0.0)), at(one.rank_correlation.max(0.0))];
        let colour = if one.is_clear() { [0, 114, 178] } else { [170, 170, 170] };
        marks.push(letters([left - 8.0, middle], one.key.clone(), Anchor::End));
        marks.push(Mark::Box { place: [from, middle - 8.0, (to - from).max(1.0), 16.0], colour });
        let [low, high] = one.interval.map(at);
        marks.push(line([low, middle], [high, middle], 2.0, 0.0));
    }
    for value in [-1.0, -0.5, 0.0, 0.5, 1.0] {
        marks.push(line([at(value), bottom], [at(value), bottom + 4.0], 1.0, 0.0));
        marks.push(letters([at(value), bottom + 13.0], plots::short(value), Anchor::Middle));
    }
    let size = (WIDTH as u32, bottom as u32 + 24);
    Sheet { size, layers: vec![Layer { clip: None, marks }] }.svg()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_response_that_rises_falls_or_does_not_care_is_told_apart() {
        let x: Vec<Option<f64>> = (0..40).map(|at| Some(f64::from(at))).collect();
        let of = |law: fn(f64) -> f64| {
            let y: Vec<Option<f64>> = x.iter().map(|x| x.map(law)).collect();
            Dependence::of("key", &x, &y)
        };
        // A rank correlation asks for the order alone.
        let rises = of(|x| libm::exp(0.3 * x)).expect("there are enough");
        assert!((rises.rank_correlation - 1.0).abs() < 1e-12 && rises.is_clear(), "{rises:?}");
        let falls = of(|x| 1.0 / (1.0 + x)).expect("there are enough");
        assert!((falls.rank_correlation + 1.0).abs() < 1e-12 && falls.is_clear(), "{falls:?}");
        let neither = of(|x| (x - 19.5).abs()).expect("there are enough");
        assert!(neither.rank_correlation.abs() < 0.01 && !neither.is_clear(), "{neither:?}");
        assert_eq!(of(|_| 1.0), None);
        assert_eq!(Dependence::of("key", &x[..5], &x[..5]), None);
    }

    #[test]
    fn one_exchange_in_ten_is_spearmans_formula() {
        // ρ = 1 − 6 Σd² / (n (n² − 1)) without ties: two neighbours exchanged make Σd² = 2.
        let x: Vec<Option<f64>> = (0..10).map(|at| Some(f64::from(at))).collect();
        let mut y = x.clone();
        y.swap(3, 4);
        let found = Dependence::of("key", &x, &y).expect("there are enough");
        assert!((found.rank_correlation - (1.0 - 12.0 / 990.0)).abs() < 1e-12, "{found:?}");
    }
}
