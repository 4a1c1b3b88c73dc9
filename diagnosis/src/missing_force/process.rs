//! A force as a Gaussian process over depth, speed, angle and diameter, seen through the answer of the measurements to it.
//!
//! The force at the nodes of a grid is normal beforehand, with a covariance that falls with the square of their distance
//! (Rasmussen & Williams 2006, Gaussian Processes for Machine Learning, eq. 2.31). Parameters of the model and errors of the
//! apparatus are projected out of the answer and of the residual. Its size and its four lengths are averaged over a
//! grid, weighed by the evidence of each (ibid., eq. 5.8).

use std::sync::OnceLock;

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use rayon::prelude::*;

use super::response::Response;
use crate::forward::field::{Grid, Scaled};
use crate::noise::log_determinant;

/// Sizes of the force over that of the model, and lengths over the extent of each axis, that are tried.
const SIZES: [f64; 4] = [0.05, 0.15, 0.5, 1.5];
const LENGTHS: [f64; 3] = [0.12, 0.3, 1.0];
const ANGLES: [f64; 2] = [0.5, 2.0];
const DIAMETERS: [f64; 2] = [0.7, 4.0];

/// Lengths of the half of the variance that all nodes share: a force that only resists has a mean.
const LONG: [f64; 4] = [2.0; 4];

/// Share of the variance of each node that no other shares.
const OWN: f64 = 1e-6;

/// Variance, relative to that of the noise, below which a direction carries no information.
const NOTHING: f64 = 1e-5;

/// Settings less likely by this logarithm than the best do not count.
const NEGLIGIBLE: f64 = 8.0;

/// What measurements say of the force at the nodes, in units of ρ g A D.
#[derive(Clone, Debug)]
pub(super) struct Process {
    /// By node of the grid; nothing where no path comes near.
    pub(super) mean: DVector<f64>,
    /// Logarithm of the odds of such a force against none.
    pub(super) log_odds: f64,
    told: Told,
    /// Of the nodes that some path comes near; computed when it is first asked for, because a step of a search needs the mean
    /// alone.
    covariance: OnceLock<DMatrix<f64>>,
}

/// What a process follows from.
#[derive(Clone, Debug)]
struct Told {
    /// Of forces of size 1 at the nodes that some path comes near, by lengths.
    covariances: Vec<DMatrix<f64>>,
    sizes: [f64; SIZES.len()],
    gram: DMatrix<f64>,
    pull: DVector<f64>,
}

impl Told {
    fn averaged(&self) -> Option<Averaged<'_>> {
        Averaged::over(&self.covariances, &self.sizes, (&self.gram, &self.pull))
    }
}

/// The measurements of the force at the nodes, compressed to the few numbers that carry their information.
pub(super) struct Seen {
    /// Answer of each number to the force at each node. Its Gram matrix is that of all measurements.
    root: DMatrix<f64>,
    /// Values of these numbers.
    values: DVector<f64>,
}

impl Seen {
    /// `gram` and `pull` are the products of the answers with themselves and with what they explain; forces are no larger
    /// than `most`. The root is the Cholesky factor with pivots (Higham 2002, Accuracy and Stability of Numerical
    /// Algorithms, § 10.3), truncated where the rest carries no information.
    pub(super) fn of(gram: &DMatrix<f64>, pull: &DVector<f64>, most: f64) -> Self {
        let n = gram.nrows();
        let mut left = gram.diagonal();
        let (mut columns, mut values): (Vec<DVector<f64>>, Vec<f64>) = (Vec::new(), Vec::new());
        while columns.len() < n {
            let (pivot, largest) = left.argmax();
            if largest * most * most < NOTHING {
                break;
            }
            let scale = largest.sqrt();
            let mut column = gram.column(pivot).into_owned();
            let mut value = pull[pivot];
            for (before, own) in columns.iter().zip(&values) {
                column.axpy(-before[pivot], before, 1.0);
                value -= before[pivot] * own;
            }
            column /= scale;
            left.iter_mut().zip(column.iter()).for_each(|(left, one)| *left -= one * one);
            left[pivot] = 0.0;
            columns.push(column);
            values.push(value / scale);
        }
        let root = match columns.is_empty() {
            true => DMatrix::zeros(0, n),
            false => DMatrix::from_columns(&columns).transpose(),
        };
        Self { root, values: DVector::from_vec(values) }
    }
}

/// One size and four lengths.
struct Setting {
    log_odds: f64,
    size: f64,
    solved: Cholesky<f64, Dyn>,
}

/// The settings of one covariance of forces of size 1.
struct Settings<'a> {
    covariance: &'a DMatrix<f64>,
    /// Its product with the root of what is seen.
    answers: DMatrix<f64>,
    each: Vec<Setting>,
}

impl<'a> Settings<'a> {
    fn of(covariance: &'a DMatrix<f64>, sizes: &[f64], seen: &Seen) -> Self {
        let answers = &seen.root * covariance;
        let inner = &answers * seen.root.transpose();
        let each = sizes.iter().filter_map(|&size| setting(&inner, &seen.values, size)).collect();
        Self { covariance, answers, each }
    }

    fn mean(&self, one: &Setting, seen: &Seen) -> DVector<f64> {
        self.answers.tr_mul(&one.solved.solve(&seen.values)) * (one.size * one.size)
    }

    fn spread(&self, one: &Setting) -> DMatrix<f64> {
        let square = one.size * one.size;
        let told = self.answers.transpose() * one.solved.solve(&self.answers);
        (self.covariance - told * square) * square
    }
}

/// What settings say together, each weighed by its evidence.
pub(super) struct Averaged<'a> {
    /// Logarithm of the odds of such a force against none.
    pub(super) log_odds: f64,
    /// By node.
    pub(super) mean: DVector<f64>,
    settings: Vec<Settings<'a>>,
    /// The settings that count: the share of each, its mean, and its places in `settings` and below.
    told: Vec<(f64, DVector<f64>, [usize; 2])>,
}

impl<'a> Averaged<'a> {
    /// Over `sizes` and over lengths, which `covariances` of forces of size 1 are of; `gram` and `pull` are the products of
    /// the answers with themselves and with what they explain. `None` where nothing can be told.
    pub(super) fn over(
        covariances: &'a [DMatrix<f64>],
        sizes: &[f64],
        (gram, pull): (&DMatrix<f64>, &DVector<f64>),
    ) -> Option<Self> {
        let most = sizes.iter().copied().fold(0.0, f64::max);
        let seen = Seen::of(gram, pull, most);
        let settings = covariances.par_iter().map(|one| Settings::of(one, sizes, &seen));
        let settings: Vec<Settings<'a>> = settings.collect();
        let below = |of: usize| (0..settings[of].each.len()).map(move |at| [of, at]);
        let all: Vec<[usize; 2]> = (0..settings.len()).flat_map(below).collect();
        let log_odds = |[of, at]: &[usize; 2]| settings[*of].each[*at].log_odds;
        let best = all.iter().map(log_odds).fold(f64::NEG_INFINITY, f64::max);
        let share = |one| libm::exp(log_odds(one) - best);
        let total: f64 = all.iter().map(share).sum();
        let counted: Vec<_> = all.iter().filter(|one| log_odds(one) > best - NEGLIGIBLE).collect();
        let told = counted.par_iter().map(|one| {
            let [of, at] = **one;
            let mean = settings[of].mean(&settings[of].each[at], &seen);
            (share(one) / total, mean, [of, at])
        });
        let told: Vec<_> = told.collect();
        let mut mean = DVector::zeros(pull.len());
        told.iter().for_each(|(share, own, ..)| mean.axpy(*share, own, 1.0));
        let log_odds = best + libm::log(total / all.len() as f64);
        log_odds.is_finite().then_some(Self { log_odds, mean, settings, told })
    }

    /// Of the nodes.
    pub(super) fn covariance(&self) -> DMatrix<f64> {
        let n = self.mean.len();
        let spread = |[of, at]: [usize; 2]| self.settings[of].spread(&self.settings[of].each[at]);
        let spreads = self.told.par_iter().map(|(.., place)| spread(*place));
        let spreads: Vec<DMatrix<f64>> = spreads.collect();
        let mut covariance = DMatrix::zeros(n, n);
        for ((share, own, ..), spread) in self.told.iter().zip(spreads) {
            let off = own - &self.mean;
            covariance += (spread + &off * off.transpose()) * *share;
        }
        covariance
    }
}

impl Process {
    /// Of `response` on `grid`; `unit` is the size of the model's force in units of ρ g A D, and `misfit` the variance of
    /// what is left over in units of the noise: what no force that is near enough explains counts as noise.
    pub(super) fn of(response: &Response, grid: &Grid, unit: f64, misfit: f64) -> Option<Self> {
        let gram = response.beside.transpose() * &response.beside / misfit;
        let pull = response.beside.tr_mul(&response.residual) / misfit;
        let places: Vec<Scaled> = response.nodes.iter().map(|&node| grid.scaled(node)).collect();
        let varied = |axis: usize, of: &'static [f64]| match grid.axes[axis].len() {
            1 => &of[..1],
            _ => of,
        };
        let tried = lengths(varied(2, &ANGLES), varied(3, &DIAMETERS)).into_par_iter();
        let covariances: Vec<DMatrix<f64>> = tried.map(|lengths| alike(&places, lengths)).collect();
        let told = Told { covariances, sizes: SIZES.map(|size| size * unit), gram, pull };
        let Averaged { log_odds, mean, .. } = told.averaged()?;
        let mut whole = DVector::zeros(grid.len());
        response.nodes.iter().zip(mean.iter()).for_each(|(&node, value)| whole[node] = *value);
        Some(Self { mean: whole, log_odds, told, covariance: OnceLock::new() })
    }

    /// Variance of the sum of the forces at the nodes that some path comes near, times `weights`.
    pub(super) fn variance(&self, weights: &DVector<f64>) -> f64 {
        let of_told =
            || self.told.averaged().map_or_else(|| DMatrix::zeros(0, 0), |one| one.covariance());
        let covariance = self.covariance.get_or_init(of_told);
        weights.dot(&(covariance * weights)).max(0.0)
    }
}

/// The lengths over depth, speed, angle and diameter that are tried.
fn lengths(angles: &[f64], diameters: &[f64]) -> Vec<[f64; 4]> {
    let mut all = Vec::new();
    for depth in LENGTHS {
        for speed in LENGTHS {
            for &angle in angles {
                all.extend(diameters.iter().map(|&diameter| [depth, speed, angle, diameter]));
            }
        }
    }
    all
}

/// The covariance of a force of size 1, whose component against the motion says nothing of that normal to it.
pub(super) fn alike(places: &[Scaled], lengths: [f64; 4]) -> DMatrix<f64> {
    let axes: [Axis; 4] = std::array::from_fn(|axis| Axis::of(places, axis, lengths[axis]));
    DMatrix::from_fn(places.len(), places.len(), |a, b| {
        if places[a].is_sideways != places[b].is_sideways {
            return 0.0;
        }
        let start = if a == b { OWN } else { 0.0 };
        let [own, long] = axes.iter().fold([0.5; 2], |[own, long], axis| {
            let [near, far] = axis.alike(a, b);
            [own * near, long * far]
        });
        start + own + long
    })
}

/// How alike forces are for their distance along one axis: a grid has few coordinates, and a covariance many entries.
struct Axis {
    /// Of each place, which of the distinct coordinates it has.
    coordinate: Vec<usize>,
    /// By pairs of coordinates, over the length that is tried and over the long one.
    alike: Vec<[f64; 2]>,
    n: usize,
}

impl Axis {
    fn of(places: &[Scaled], axis: usize, length: f64) -> Self {
        let mut distinct: Vec<f64> = places.iter().map(|place| place.at[axis]).collect();
        distinct.sort_by(f64::total_cmp);
        distinct.dedup_by(|a, b| a.total_cmp(b).is_eq());
        let at = |place: &Scaled| distinct.partition_point(|one| *one < place.at[axis]);
        let pairs = distinct.iter().flat_map(|a| distinct.iter().map(move |b| a - b));
        let alike = pairs.map(|apart| {
            [length, LONG[axis]].map(|length| libm::exp(-0.5 * (apart / length).powi(2)))
        });
        Self {
            coordinate: places.iter().map(at).collect(),
            alike: alike.collect(),
            n: distinct.len(),
        }
    }

    fn alike(&self, a: usize, b: usize) -> [f64; 2] {
        self.alike[self.coordinate[a] * self.n + self.coordinate[b]]
    }
}

/// What follows from a force of `size`; `inner` is the covariance that one of size 1 gives what is seen, `values`.
fn setting(inner: &DMatrix<f64>, values: &DVector<f64>, size: f64) -> Option<Setting> {
    let n = values.len();
    let solved = Cholesky::new(DMatrix::identity(n, n) + inner * (size * size))?;
    let explained = values.norm_squared() - values.dot(&solved.solve(values));
    let log_odds = 0.5 * (explained - log_determinant(&solved));
    Some(Setting { log_odds, size, solved })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A node at this share of the greatest depth.
    fn against(depth: f64) -> Scaled {
        Scaled { at: [depth, 0.0, 0.0, 0.0], is_sideways: false }
    }

    #[test]
    fn a_force_against_the_motion_says_nothing_of_one_normal_to_it() {
        let places = [against(0.3), Scaled { is_sideways: true, ..against(0.3) }];
        let covariance = alike(&places, [0.3; 4]);
        let answer = DMatrix::from_row_slice(1, 2, &[1e3, 0.0]);
        let one = said(&covariance, 1.0, &answer, &DVector::from_element(1, 3e3));
        assert!((one.mean[0] - 3.0).abs() < 1e-4 && one.mean[1].abs() < 1e-12);
    }

    /// What one covariance and one size say.
    fn said<'a>(
        covariance: &'a DMatrix<f64>,
        size: f64,
        answer: &DMatrix<f64>,
        read: &DVector<f64>,
    ) -> Averaged<'a> {
        let (gram, pull) = (answer.tr_mul(answer), answer.tr_mul(read));
        let covariances = std::slice::from_ref(covariance);
        Averaged::over(covariances, &[size], (&gram, &pull)).expect("a force")
    }

    #[test]
    fn a_force_without_any_answer_is_what_it_was_beforehand() {
        let n = 4;
        let places: Vec<Scaled> = (0..n).map(|k| against(k as f64 / 3.0)).collect();
        let covariance = alike(&places, [0.25; 4]);
        let one = said(&covariance, 2.0, &DMatrix::zeros(1, n), &DVector::zeros(1));
        assert!(one.log_odds.abs() < 1e-12, "nothing is learned");
        assert!(one.mean.norm() < 1e-12);
        let sd = one.covariance()[(0, 0)].sqrt();
        assert!((sd - 2.0).abs() < 1e-5, "{sd}");
    }

    #[test]
    fn a_node_that_is_measured_exactly_has_the_force_that_was_measured() {
        let places = [0.0, 1.0].map(against);
        let covariance = alike(&places, [0.12; 4]);
        // One reading of the first node, 3 with a standard deviation of 1e-3.
        let answer = DMatrix::from_row_slice(1, 2, &[1e3, 0.0]);
        let one = said(&covariance, 1.0, &answer, &DVector::from_element(1, 3e3));
        assert!((one.mean[0] - 3.0).abs() < 1e-4, "{}", one.mean[0]);
        assert!((one.covariance()[(0, 0)].sqrt() / 1e-3 - 1.0).abs() < 1e-3);
        // Far away half of the variance is shared still, over a length of 2: exp(−1/8) of it at a distance of 1.
        let shared = 0.5 * libm::exp(-0.125);
        let there = one.covariance()[(1, 1)];
        assert!((there - (1.0 - shared * shared)).abs() < 1e-4, "{there}");
        assert!((one.mean[1] - 3.0 * shared).abs() < 1e-4, "{}", one.mean[1]);
        // Its odds are those of a normal of variance 1 + 1e-6 against one of 1e-6.
        let expected = 0.5 * (9e6 - 9.0 / (1.0 + 1e-6)) - 0.5 * libm::log(1.0 + 1e6);
        assert!((one.log_odds / expected - 1.0).abs() < 1e-5, "{} {expected}", one.log_odds);
    }

    #[test]
    fn fewer_numbers_say_what_all_measurements_say() {
        let places: Vec<Scaled> = (0..5).map(|k| against(f64::from(k) / 4.0)).collect();
        let covariance = alike(&places, [0.3; 4]);
        // Seven readings of three kinds.
        let kinds = DMatrix::from_fn(3, 5, |a, b| libm::sin(((1 + a) * (1 + b)) as f64));
        let mixed = DMatrix::from_fn(7, 3, |a, b| libm::pow(0.3 * (a + 1) as f64, b as f64));
        let answer = mixed * kinds;
        let read = DVector::from_fn(7, |k, _| libm::sin(2.0 * k as f64));
        let seen = Seen::of(&answer.tr_mul(&answer), &answer.tr_mul(&read), 1.0);
        assert_eq!(seen.values.len(), 3);
        let one = said(&covariance, 1.0, &answer, &read);
        let whole = DMatrix::identity(7, 7) + &answer * &covariance * answer.transpose();
        let gain = &covariance * answer.transpose() * whole.try_inverse().expect("regular");
        assert!((&gain * &read - &one.mean).norm() < 1e-6);
        assert!((&covariance - gain * &answer * &covariance - one.covariance()).norm() < 1e-6);
    }
}
