//! Errors of means of runs, drawn again from the deviations of the runs.

use nalgebra::{Cholesky, DMatrix};
use rand::RngExt;
use rand_pcg::Pcg64;

use crate::fit::problem::{FitProblem, Fitted};
use crate::misfit::directions::{Along, Directions};
use crate::random::{Purpose, normal, scale_of_noise, stream};

/// Fewest runs of a condition that are resampled. The deviations of two have one direction and one
/// size, whatever their sign, so that draws from them hardly differ; fewer are drawn from the noise
/// model, which is learned from all conditions together.
const ENOUGH_RUNS: usize = 4;

/// Errors of means, drawn from the deviations of runs.
pub(crate) struct Redraw {
    conditions: Vec<Source>,
    /// From how many independent numbers the noise model is known.
    freedom: f64,
    scale: Pcg64,
}

/// Where the errors of the mean of one condition are drawn from.
struct Source {
    /// Its whitened deviations along the directions that are looked at; of too few runs, the units of
    /// its numbers.
    columns: Along,
    /// Of how many runs the deviations are; columns behind theirs are the error of the prediction itself.
    runs: Option<usize>,
    random: Pcg64,
}

impl Redraw {
    /// Of the conditions that `fitted` was fitted to.
    pub(crate) fn new(
        problem: &FitProblem<'_>,
        fitted: &Fitted,
        directions: &Directions,
        seed: u64,
    ) -> Self {
        let fit = problem.observed.fit.iter();
        let each = fit.zip(&fitted.weights).zip(directions.conditions());
        let conditions = each.map(|((&condition, weight), within)| {
            let observed = &problem.observed.conditions[condition];
            let n = observed.mean.len();
            let runs = Some(observed.runs.len()).filter(|&runs| runs >= ENOUGH_RUNS);
            let columns = runs.map_or_else(
                || DMatrix::identity(n, n),
                |runs| {
                    let deviations = (0..runs).map(|run| weight.whiten(&observed.deviation(run)));
                    let mut columns: Vec<_> = deviations.collect();
                    let effects = &fitted.fit.point.effects;
                    let own = problem.own_covariance(condition, effects, &fitted.noise);
                    let own = own.and_then(Cholesky::new).map(|factor| factor.l());
                    for shared in own.iter().chain(weight.between()) {
                        let shared = weight.whiten_columns(shared);
                        columns.extend(shared.column_iter().map(|column| column.into_owned()));
                    }
                    DMatrix::from_columns(&columns)
                },
            );
            let columns = within.of(&columns);
            Source { columns, runs, random: stream(seed, Purpose::Resampling, condition) }
        });
        let conditions = conditions.collect();
        Self {
            conditions,
            freedom: problem.observed.freedom(),
            scale: stream(seed, Purpose::NoiseScale, 0),
        }
    }

    /// Whitened errors of the means of all conditions along the directions that are looked at.
    pub(crate) fn draw(&mut self) -> Vec<Along> {
        let scale = scale_of_noise(self.freedom, &mut self.scale);
        let draw = |source: &mut Source| {
            let random = &mut source.random;
            let n = source.columns.own.ncols();
            let factors = match source.runs {
                Some(runs) => {
                    let mut factors = factors(runs, random);
                    factors.extend((runs..n).map(|_| normal(random)));
                    factors
                }
                None => (0..n).map(|_| scale * normal(random)).collect(),
            };
            let factors = DMatrix::from_column_slice(n, 1, &factors);
            Along {
                parameters: &source.columns.parameters * &factors,
                coherent: &source.columns.coherent * &factors,
                own: &source.columns.own * &factors,
            }
        };
        self.conditions.iter_mut().map(draw).collect()
    }
}

/// Factors on the deviations of `runs` runs whose sum has the covariance of their mean: they are drawn
/// with replacement, and enlarged by √(r/(r−1)) since deviations from a mean are too small by that.
fn factors(runs: usize, random: &mut Pcg64) -> Vec<f64> {
    let r = runs as f64;
    let mut counts = vec![0.0; runs];
    for _ in 0..runs {
        counts[random.random_range(0..runs)] += 1.0;
    }
    let scale = (r / (r - 1.0)).sqrt() / r;
    counts.iter().map(|count| count * scale).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn resampled_means_scatter_as_much_as_means_do() {
        for runs in [4, 5, 10] {
            let mut random = stream(1, Purpose::Resampling, 0);
            let values: Vec<f64> = (0..runs).map(|_| normal(&mut random)).collect();
            let mean = values.iter().sum::<f64>() / runs as f64;
            let squares = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>();
            let expected = squares / ((runs - 1) * runs) as f64;
            let draws = 20_000;
            let drawn = (0..draws).map(|_| {
                let factors = factors(runs, &mut random);
                factors.iter().zip(&values).map(|(f, v)| f * (v - mean)).sum::<f64>().powi(2)
            });
            let variance = drawn.sum::<f64>() / f64::from(draws);
            // The variance of a variance over so many draws is about 1 %; four of those.
            assert!((variance / expected - 1.0).abs() < 0.04, "{runs}: {variance} {expected}");
        }
    }
}
