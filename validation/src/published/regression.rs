//! Unweighted least squares, as the sources fit, with the errors that the scatter of the points leaves.

use argmin::core::{CostFunction, Executor, State};
use argmin::solver::brent::BrentOpt;
use nalgebra::{Cholesky, DMatrix, DVector};
use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

use super::check::Estimate;

/// Between which rates (s/m) the decay of an exponential is searched: a tenth of the slowest published one,
/// and a plateau that is reached within a quarter of the slowest impact.
const RATES: [f64; 2] = [0.1, 8.0];

/// Between which shares of the greatest energy that of a logarithm is searched: from a curve that is a
/// logarithm throughout to a straight line.
const ENERGIES: [f64; 2] = [1e-4, 1e2];

/// Evaluations of the search; it halves its interval at least every other one.
const EVALUATIONS: u64 = 100;

/// Coefficients of a linear fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Fitted {
    /// In the order of the columns.
    pub coefficients: Vec<f64>,
    /// Their covariance.
    pub covariance: DMatrix<f64>,
    /// Share of the variance of the points about their mean that is explained.
    pub r_squared: f64,
    /// Root mean square of what is left over, per degree of freedom; 0 without any.
    pub residual: f64,
    /// Degrees of freedom that the errors were found with; none where the points came with theirs.
    pub freedom: Option<usize>,
}

impl Fitted {
    /// Standard error of coefficient `at`.
    pub fn error(&self, at: usize) -> f64 {
        self.covariance[(at, at)].max(0.0).sqrt()
    }

    /// How many of its standard errors hold a coefficient as surely as so many `sigmas` do where the scatter is
    /// known: Student's t.
    pub fn as_surely_as(&self, sigmas: f64) -> f64 {
        self.freedom.map_or(sigmas, |freedom| student(sigmas, freedom))
    }

    /// Correlation of the first two coefficients.
    pub fn correlation(&self) -> f64 {
        self.covariance[(0, 1)] / (self.error(0) * self.error(1))
    }
}

/// The coefficients of `columns` that come nearest to `y`. With `errors`, one per point, they are
/// propagated; without, the scatter is that of what is left over. `None` where the columns do not decide.
pub fn linear(columns: &[Vec<f64>], y: &[f64], errors: Option<&[f64]>) -> Option<Fitted> {
    let (n, p) = (y.len(), columns.len());
    if n < p {
        return None;
    }
    let x = DMatrix::from_fn(n, p, |row, column| columns[column][row]);
    let y = DVector::from_column_slice(y);
    let inverse = Cholesky::new(x.tr_mul(&x))?.inverse();
    let solution = &inverse * x.tr_mul(&y);
    let left = &y - &x * &solution;
    let freedom = n - p;
    let residual = if freedom > 0 { left.norm_squared() / freedom as f64 } else { 0.0 };
    let covariance = match errors {
        Some(errors) => {
            let weighted = DMatrix::from_fn(n, p, |row, column| errors[row] * x[(row, column)]);
            &inverse * weighted.tr_mul(&weighted) * &inverse
        }
        None => &inverse * residual,
    };
    let mean = y.mean();
    let about_mean: f64 = y.iter().map(|value| (value - mean) * (value - mean)).sum();
    Some(Fitted {
        coefficients: solution.iter().copied().collect(),
        covariance,
        r_squared: 1.0 - left.norm_squared() / about_mean,
        residual: residual.sqrt(),
        freedom: errors.is_none().then_some(freedom),
    })
}

/// Amplitude, rate and plateau of `amplitude exp(−rate x) + plateau`, in this order. `None` with fewer than
/// four points, or where they do not decide.
pub fn exponential(x: &[f64], y: &[f64], errors: Option<&[f64]>) -> Option<Fitted> {
    if x.len() < 4 {
        return None;
    }
    let columns =
        |rate: f64| [x.iter().map(|x| libm::exp(-rate * x)).collect(), vec![1.0; x.len()]];
    let rate = search(RATES, |rate| left_over(&columns(rate), y))?;
    let decay: Vec<f64> = x.iter().map(|x| libm::exp(-rate * x)).collect();
    let plateau = vec![1.0; x.len()];
    let at_rate = linear(&[decay.clone(), plateau.clone()], y, errors)?;
    let [amplitude, level] = [at_rate.coefficients[0], at_rate.coefficients[1]];
    // About the solution the curve is linear in all three, the rate by its derivative.
    let by_rate = x.iter().zip(&decay).map(|(x, decay)| -amplitude * x * decay).collect();
    let left: Vec<f64> = (y.iter().zip(&decay)).map(|(y, d)| y - amplitude * d - level).collect();
    let about = linear(&[decay, by_rate, plateau], &left, errors)?;
    let residual = residual(&left, 3);
    Some(Fitted {
        coefficients: vec![amplitude, rate, level],
        covariance: about.covariance,
        r_squared: at_rate.r_squared,
        residual,
        freedom: about.freedom,
    })
}

/// Scale and energy of `scale ln(1 + x / energy)`, in this order, without the errors of the points. `None` with
/// fewer than three points, or where they do not decide.
pub fn logarithmic(x: &[f64], y: &[f64]) -> Option<Fitted> {
    if x.len() < 3 {
        return None;
    }
    let greatest = x.iter().copied().fold(0.0, f64::max);
    let column = |energy: f64| -> Vec<f64> { x.iter().map(|x| libm::log1p(x / energy)).collect() };
    let ends = ENERGIES.map(|share| libm::log(share * greatest));
    let energy = libm::exp(search(ends, |log| left_over(&[column(libm::exp(log))], y))?);
    let at_energy = linear(&[column(energy)], y, None)?;
    let scale = at_energy.coefficients[0];
    let by_energy = x.iter().map(|x| -scale * x / (energy * (energy + x))).collect();
    let left: Vec<f64> = y.iter().zip(column(energy)).map(|(y, c)| y - scale * c).collect();
    let about = linear(&[column(energy), by_energy], &left, None)?;
    let residual = residual(&left, 2);
    Some(Fitted {
        coefficients: vec![scale, energy],
        covariance: about.covariance,
        r_squared: at_energy.r_squared,
        residual,
        freedom: about.freedom,
    })
}

/// Root mean square per degree of freedom of what a curve of so many coefficients leaves over; where its search ended at
/// an end of its range, that is more than its linear form about there leaves.
fn residual(left: &[f64], coefficients: usize) -> f64 {
    let squares: f64 = left.iter().map(|one| one * one).sum();
    let freedom = left.len().saturating_sub(coefficients);
    if freedom > 0 { (squares / freedom as f64).sqrt() } else { 0.0 }
}

/// How many standard errors that were found with so many degrees of `freedom` hold a number as surely as `sigmas` of a
/// normal deviate do; infinite without any freedom.
pub fn student(sigmas: f64, freedom: usize) -> f64 {
    let share = Normal::standard().cdf(sigmas);
    let student = StudentsT::new(0.0, 1.0, freedom as f64);
    student.map_or(f64::INFINITY, |student| student.inverse_cdf(share))
}

/// Numbers that `fit` finds of `n` impacts, and their standard errors by leaving out one impact after another
/// (the jackknife): what was read of one impact is not independent. `fit` is given which one to leave out.
pub fn leaving_out(
    n: usize,
    fit: impl Fn(Option<usize>) -> Option<Vec<f64>>,
) -> Option<Vec<Estimate>> {
    let whole = fit(None)?;
    let left: Vec<Vec<f64>> = (0..n).filter_map(|at| fit(Some(at))).collect();
    let m = left.len() as f64;
    let error = |number: usize| {
        let mean = left.iter().map(|one| one[number]).sum::<f64>() / m;
        let off = left.iter().map(|one| (one[number] - mean) * (one[number] - mean));
        ((m - 1.0) / m * off.sum::<f64>()).sqrt()
    };
    Some(whole.into_iter().enumerate().map(|(at, value)| Estimate::new(value, error(at))).collect())
}

/// Up to what mean absolute deviation points with these standard `errors` have of a curve that they would lie on
/// without: the mean of |ε| is σ √(2/π), its variance σ² (1 − 2/π), and `sigmas` of that are allowed for.
pub fn deviation_by_scatter(errors: &[f64], sigmas: f64) -> f64 {
    let share = std::f64::consts::FRAC_2_PI;
    let n = errors.len() as f64;
    let squares: f64 = errors.iter().map(|error| error * error).sum();
    (errors.iter().sum::<f64>() * share.sqrt() + sigmas * (squares * (1.0 - share)).sqrt()) / n
}

/// Root mean square that the best coefficients of `columns` leave of `y`.
fn left_over(columns: &[Vec<f64>], y: &[f64]) -> f64 {
    linear(columns, y, None).map_or(f64::INFINITY, |fitted| fitted.residual)
}

/// Where between `ends` the `cost` is least; `None` if the search fails.
pub fn search(ends: [f64; 2], cost: impl Fn(f64) -> f64) -> Option<f64> {
    let solver = BrentOpt::new(ends[0], ends[1]);
    let search = Executor::new(Cost(cost), solver).configure(|state| state.max_iters(EVALUATIONS));
    search.run().ok()?.state().get_best_param().copied()
}

struct Cost<F>(F);

impl<F: Fn(f64) -> f64> CostFunction for Cost<F> {
    type Param = f64;
    type Output = f64;

    fn cost(&self, at: &f64) -> Result<f64, argmin::core::Error> {
        Ok((self.0)(*at))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_through_points_on_it_is_found_and_their_errors_are_propagated() {
        let x = [1.0, 2.0, 3.0, 4.0];
        let y = x.map(|x| 0.5 * x - 2.0);
        let fitted = linear(&[x.to_vec(), vec![1.0; 4]], &y, Some(&[0.1; 4])).expect("a line");
        // Rounding of sums of a few numbers of order one.
        assert!((fitted.coefficients[0] - 0.5).abs() < 1e-13);
        assert!((fitted.coefficients[1] + 2.0).abs() < 1e-13);
        // σ² / Σ(x − mean)² with Σ = 5, and σ² (1/4 + mean²/5).
        assert!((fitted.error(0) - 0.1 / 5.0_f64.sqrt()).abs() < 1e-13);
        assert!((fitted.error(1) - 0.1 * 1.5_f64.sqrt()).abs() < 1e-13);
        assert!((fitted.r_squared - 1.0).abs() < 1e-13);
    }

    #[test]
    fn the_published_stopping_times_at_90_degrees_give_their_own_coefficients() {
        let speeds = [0.5, 1.0, 1.5, 2.0, 3.0, 4.0];
        let times = speeds.map(|v| 0.16083 * libm::exp(-1.42537 * v) + 0.1591);
        let fitted = exponential(&speeds, &times, None).expect("an exponential");
        // The search ends where a move of the rate changes the error by rounding: its square root.
        for (found, published) in fitted.coefficients.iter().zip([0.16083, 1.42537, 0.1591]) {
            assert!((found - published).abs() < 1e-5 * published, "{found} for {published}");
        }
    }

    #[test]
    fn a_logarithm_is_found_again() {
        let energies = [0.01, 0.03, 0.06, 0.12, 0.25];
        let depths = energies.map(|k| 0.012 * libm::log1p(k / 0.02));
        let fitted = logarithmic(&energies, &depths).expect("a logarithm");
        // As above: the square root of rounding, over a slope of order one.
        assert!((fitted.coefficients[0] / 0.012 - 1.0).abs() < 1e-5, "{fitted:?}");
        assert!((fitted.coefficients[1] / 0.02 - 1.0).abs() < 1e-5, "{fitted:?}");
    }

    #[test]
    fn errors_that_few_points_leave_over_hold_a_coefficient_by_students_t() {
        let sigmas = |points: usize| {
            let x: Vec<f64> = (0..points).map(|at| at as f64).collect();
            let y: Vec<f64> = x.iter().map(|x| x * x).collect();
            linear(&[x, vec![1.0; points]], &y, None).expect("a line").as_surely_as(2.0)
        };
        // Of tables of the distribution at 95.45 %, as they are rounded there.
        for (points, expected) in [(3, 13.97), (4, 4.53), (7, 2.65), (12, 2.28)] {
            assert!((sigmas(points) - expected).abs() < 0.006, "{points}: {}", sigmas(points));
        }
        assert!(sigmas(2).is_infinite());
        let known = linear(&[vec![1.0, 2.0, 3.0]], &[1.0, 2.0, 3.0], Some(&[0.1; 3]));
        assert_eq!(known.map(|fitted| fitted.as_surely_as(2.0)), Some(2.0));
    }

    #[test]
    fn the_mean_of_impacts_has_its_standard_error_by_leaving_out() {
        let values = [1.0, 2.0, 3.0, 6.0];
        let mean = |without: Option<usize>| {
            let kept: Vec<f64> =
                (0..4).filter(|at| Some(*at) != without).map(|at| values[at]).collect();
            Some(vec![kept.iter().sum::<f64>() / kept.len() as f64])
        };
        let found = leaving_out(4, mean).expect("a mean");
        // Of a mean it is the textbook's: the root of Σ(x − 3)² / (4 · 3), here of 14/12.
        assert!((found[0].value - 3.0).abs() < 1e-15, "rounding");
        assert!((found[0].error - (14.0_f64 / 12.0).sqrt()).abs() < 1e-14, "rounding");
    }

    #[test]
    fn points_that_scatter_about_a_right_curve_deviate_by_less_than_is_allowed_for() {
        // Quantiles of a normal deviate at 5, 15, … 95 %.
        let quantiles: Vec<f64> =
            (0..10).map(|k| Normal::standard().inverse_cdf(0.05 + 0.1 * f64::from(k))).collect();
        let mean = quantiles.iter().map(|one| one.abs()).sum::<f64>() / 10.0;
        let [exact, allowed] = [0.0, 2.0].map(|sigmas| deviation_by_scatter(&[1.0; 10], sigmas));
        // Ten quantiles stand for the whole to a few hundredths.
        assert!((exact - mean).abs() < 0.03, "{exact} {mean}");
        assert!(mean < allowed && allowed < 1.2, "{allowed}");
    }

    #[test]
    fn what_a_curve_leaves_over_is_told_also_where_its_search_ends_at_an_end() {
        let energies = [0.002, 0.004, 0.008, 0.015, 0.03];
        let falling = energies.map(|energy| 0.02 - 2e-3 * libm::log(energy / 1e-3));
        let fitted = logarithmic(&energies, &falling).expect("a logarithm");
        // No logarithm falls: its mean is about 16 mm, and it lies off by 2 mm and more.
        assert!(fitted.residual > 2e-3, "{fitted:?}");
    }

    #[test]
    fn too_few_points_or_columns_alike_give_no_fit() {
        assert!(linear(&[vec![1.0], vec![1.0]], &[1.0], None).is_none());
        assert!(linear(&[vec![1.0; 3], vec![1.0; 3]], &[1.0, 2.0, 3.0], None).is_none());
        assert!(exponential(&[1.0, 2.0, 3.0], &[3.0, 2.0, 1.5], None).is_none());
    }
}
