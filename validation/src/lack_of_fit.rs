//! Whether a fitted model leaves something behind that is not noise.
//!
//! The residual is held against changes of the force around each depth (against the motion, and, on
//! half as many depths, normal to it), once coherent over conditions
//! (the same change, and one that grows with speed or angle), once free in every condition. How large
//! noise alone makes the two is learned by resampling the deviations of runs within conditions; a
//! theoretical distribution with one pooled scale rejects too many true models.

use nalgebra::{DMatrix, DVector};
use rand::RngExt;
use rand_pcg::Pcg64;
use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::bench::{Bench, BenchError, Fitted};
use crate::noise::NoiseSource;
use crate::projection::Basis;
use crate::random::{Purpose, normal, stream};
use crate::sensitivity::{Direction, force_response};

/// Fewest runs of a condition that are resampled. The deviations of two have one direction and one
/// size, whatever their sign, so that draws from them hardly differ; fewer are drawn from the noise
/// model, which is learned from all conditions together.
const ENOUGH_RUNS: usize = 4;

/// How many numbers the noise model has.
const NOISE_PARAMETERS: usize = 3;

/// Resampled sets of means.
const DRAWS: usize = 999;

/// Bounds of the number of nodes of depth: fewer let a layer slip through, more find nothing new.
const NODES: (usize, usize) = (10, 24);

/// Spacing of the nodes where the path is long enough (m), if the grains are finer.
const SPACING: f64 = 3e-3;

/// Spacing in grains.
const GRAINS: f64 = 4.0;

/// Probability of a lack of fit at least as large, if `fitted` were true; `None` where as much is free
/// as was measured, so that nothing is left to judge by.
///
/// # Errors
/// If the model fails.
pub fn lack_of_fit(
    bench: &Bench<'_>,
    fitted: &Fitted,
    seed: u64,
) -> Result<Option<f64>, BenchError> {
    let observed = bench.observed;
    let residual = &fitted.fit.residual;
    if residual.len() <= fitted.fit.n_free() {
        return Ok(None);
    }
    if fitted.noise.source != NoiseSource::Repeats {
        let freedom = (residual.len() - fitted.fit.n_free()) as f64;
        return Ok(ChiSquared::new(freedom).ok().map(|chi2| chi2.sf(fitted.fit.chi2)));
    }
    let reach = observed.fit.iter().fold(0.0_f64, |r, &c| r.max(observed.conditions[c].reach));
    let grain = bench.set.bed.grain_diameter.unwrap_or(0.0);
    let (least, most) = NODES;
    let nodes = ((reach / SPACING.max(GRAINS * grain)).ceil() as usize + 1).clamp(least, most);

    let mut responses = Vec::with_capacity(observed.fit.len());
    for (&condition, weight) in observed.fit.iter().zip(&fitted.weights) {
        let response = |direction, nodes| {
            let point = &fitted.fit.point;
            force_response(point, bench.forward, condition, direction, (nodes, reach))
        };
        let along = response(Direction::Along, nodes)?;
        let sideways = response(Direction::Sideways, nodes.div_ceil(2))?;
        let columns: Vec<_> = along.column_iter().chain(sideways.column_iter()).collect();
        responses.push(weight.whiten_columns(&DMatrix::from_columns(&columns)));
    }
    let statistics = Statistics::new(bench, fitted, &responses);
    let measured = statistics.of(&statistics.split(residual));
    let mut noise = Resampled::new(bench, fitted, &statistics, seed);
    let mut reached = [1_usize; 2];
    for _ in 0..DRAWS {
        let drawn = statistics.of(&noise.draw());
        for (count, (drawn, measured)) in reached.iter_mut().zip(drawn.iter().zip(&measured)) {
            *count += usize::from(drawn >= measured);
        }
    }
    let least = reached[0].min(reached[1]) as f64 / (DRAWS + 1) as f64;
    Ok(Some((2.0 * least).min(1.0)))
}

/// The two squared lengths that a residual is judged by.
struct Statistics {
    conditions: Vec<Directions>,
}

/// In which directions the residual of one condition is looked at.
struct Directions {
    /// Its first row, and how many.
    rows: (usize, usize),
    /// What the parameters can do, over all conditions.
    parameters: DMatrix<f64>,
    /// What forces can do that change in all conditions together.
    coherent: DMatrix<f64>,
    /// What its own forces can do.
    own: DMatrix<f64>,
    /// The second within the first of these: what its own forces do of the parameters.
    shared: DMatrix<f64>,
}

/// What of residuals, as columns, lies along the directions of one condition.
struct Along {
    parameters: DMatrix<f64>,
    coherent: DMatrix<f64>,
    own: DMatrix<f64>,
}

impl Statistics {
    fn new(bench: &Bench<'_>, fitted: &Fitted, responses: &[DMatrix<f64>]) -> Self {
        let parameters = Basis::of(&fitted.fit.jacobian);
        let conditions: Vec<_> =
            bench.observed.fit.iter().map(|&index| &bench.set.conditions[index]).collect();
        let speeds = standardised(conditions.iter().map(|condition| condition.speed).collect());
        let angles = standardised(conditions.iter().map(|condition| condition.angle_deg).collect());
        let nodes = responses.first().map_or(0, DMatrix::ncols);
        let mut coherent = DMatrix::zeros(fitted.fit.residual.len(), 3 * nodes);
        let mut start = 0;
        for (at, response) in responses.iter().enumerate() {
            let rows = response.nrows();
            for (block, factor) in [1.0, speeds[at], angles[at]].into_iter().enumerate() {
                let mut part = coherent.view_mut((start, block * nodes), (rows, nodes));
                part.copy_from(&(response * factor));
            }
            start += rows;
        }
        let coherent = Basis::beside(&coherent, &parameters).to_matrix(start);
        let parameters = parameters.to_matrix(start);
        start = 0;
        let conditions = responses.iter().map(|response| {
            let rows = (start, response.nrows());
            start += rows.1;
            let own = Basis::of(response).to_matrix(rows.1);
            let parameters = parameters.rows(rows.0, rows.1).into_owned();
            let coherent = coherent.rows(rows.0, rows.1).into_owned();
            Directions { rows, shared: own.tr_mul(&parameters), parameters, coherent, own }
        });
        Self { conditions: conditions.collect() }
    }

    /// A residual of all conditions along their directions.
    fn split(&self, residual: &DVector<f64>) -> Vec<Along> {
        let each = self.conditions.iter();
        each.map(|directions| {
            let (start, rows) = directions.rows;
            directions.along(&DMatrix::from_columns(&[residual.rows(start, rows)]))
        })
        .collect()
    }

    /// Of the sums of the columns.
    fn of(&self, columns: &[Along]) -> [f64; 2] {
        let sum = |part: fn(&Along) -> &DMatrix<f64>| {
            let mut sums = columns.iter().map(|along| part(along).column_sum());
            let first = sums.next().unwrap_or_else(|| DVector::zeros(0));
            sums.fold(first, |total, one| total + one)
        };
        let parameters = sum(|along| &along.parameters);
        let own = self.conditions.iter().zip(columns).map(|(directions, along)| {
            (along.own.column_sum() - &directions.shared * &parameters).norm_squared()
        });
        let own = own.sum();
        [sum(|along| &along.coherent).norm_squared(), own]
    }
}

impl Directions {
    fn along(&self, columns: &DMatrix<f64>) -> Along {
        Along {
            parameters: self.parameters.tr_mul(columns),
            coherent: self.coherent.tr_mul(columns),
            own: self.own.tr_mul(columns),
        }
    }
}

/// Values less their mean, over their standard deviation; zero if they are all the same.
fn standardised(values: Vec<f64>) -> Vec<f64> {
    let n = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / n;
    let sd = (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / n).sqrt();
    values
        .iter()
        .map(|value| if sd > 1e-9 * mean.abs() { (value - mean) / sd } else { 0.0 })
        .collect()
}

/// Errors of means, drawn from the deviations of runs.
struct Resampled {
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
    /// Of how many runs the deviations are.
    runs: Option<usize>,
    random: Pcg64,
}

impl Resampled {
    fn new(bench: &Bench<'_>, fitted: &Fitted, statistics: &Statistics, seed: u64) -> Self {
        let fit = bench.observed.fit.iter();
        let each = fit.zip(&fitted.weights).zip(&statistics.conditions);
        let conditions = each.map(|((&condition, weight), directions)| {
            let observed = &bench.observed.conditions[condition];
            let n = observed.mean.len();
            let runs = Some(observed.runs.len()).filter(|&runs| runs >= ENOUGH_RUNS);
            let columns = runs.map_or_else(
                || DMatrix::identity(n, n),
                |runs| {
                    let deviations = (0..runs).map(|run| weight.whiten(&observed.deviation(run)));
                    DMatrix::from_columns(&deviations.collect::<Vec<_>>())
                },
            );
            let columns = directions.along(&columns);
            Source { columns, runs, random: stream(seed, Purpose::Resampling, condition) }
        });
        let conditions = conditions.collect();
        let deviations = bench.observed.fit.iter().map(|&condition| {
            let observed = &bench.observed.conditions[condition];
            (observed.runs.len() - 1) * observed.mean.len()
        });
        let freedom = deviations.sum::<usize>().saturating_sub(NOISE_PARAMETERS).max(1) as f64;
        Self { conditions, freedom, scale: stream(seed, Purpose::NoiseScale, 0) }
    }

    /// Whitened errors of the means of all conditions along the directions that are looked at.
    fn draw(&mut self) -> Vec<Along> {
        let scale = 1.0 / mean_square(self.freedom, normal(&mut self.scale)).sqrt();
        let draw = |source: &mut Source| {
            let random = &mut source.random;
            let n = source.columns.own.ncols();
            let factors = match source.runs {
                Some(runs) => factors(runs, random),
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

/// The mean square of `freedom` normal numbers where a normal number is `z` (Wilson & Hilferty 1931,
/// Proc. Natl. Acad. Sci. 17, 684): a noise that is known from few numbers may be larger than it seems.
fn mean_square(freedom: f64, z: f64) -> f64 {
    let spread = 2.0 / (9.0 * freedom);
    (1.0 - spread + z * spread.sqrt()).max(0.1).powi(3)
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
