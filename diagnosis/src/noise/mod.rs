//! How much the runs of one condition scatter, learned from the deviations from their own mean.
//!
//! The deviations hold no error of a model, so a missing effect is not taken for noise, nor noise for
//! an effect. Their likelihood is the restricted one (Patterson & Thompson 1971, Biometrika 58, 545):
//! the mean of each condition is projected out before anything is estimated.

pub mod between;
pub mod weights;

use argmin::core::{CostFunction, Executor, State};
use argmin::solver::neldermead::NelderMead;
use measurements::{Instrument, MeasurementSet};
use nalgebra::{Cholesky, DMatrix, DVector};
use serde::Serialize;
use serde_json::{Value, json};

use crate::forward::Forward;
use crate::forward::sensitivity::{Sensitivity, Spread};
use crate::noise::between::Between;
use crate::observed::curves::reading_error;
use crate::observed::reading_error::{least_position_error, position_error};
use crate::observed::{Observed, ObservedCondition};
use crate::rounding::rounded;

/// Bounds of a relative scatter: below, it is nothing; above, a bed is no longer one condition.
const SPREAD_BOUNDS: (f64, f64) = (1e-4, 1.0);

/// Bounds of the scatter of what a set does not state: impact speed (relative), its angle (rad), level (m), and clock (in
/// frames).
const SPEED_BOUNDS: (f64, f64) = (1e-5, 0.2);
const ANGLE_BOUNDS: (f64, f64) = (1e-5, 0.2);
const LEVEL_BOUNDS: (f64, f64) = (1e-6, 1e-2);
const FRAMES_BOUNDS: (f64, f64) = (1e-3, 2.0);

/// Most that readings may be worse than stated.
const READING_MOST: f64 = 30.0;

/// Fall of twice the negative logarithm of the likelihood beyond which repeats show that angles scatter: the 95 % point of
/// a variance that is tested at its bound (Self & Liang 1987, J. Am. Stat. Assoc. 82, 605, case 5).
const SHOWN: f64 = 2.71;

/// Most searches one after the other, and the fall of twice the negative logarithm of the likelihood that is worth one.
const SEARCHES: usize = 5;
const MORE: f64 = 0.05;

/// Iterations after which the likelihood is taken as it is; a fraction of it is common.
const ITERATIONS: u64 = 600;

/// How much the numbers of one run scatter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// Where it is from.
    pub source: NoiseSource,
    /// Error of readings over what the instrument states.
    pub reading: f64,
    /// Scatter of what differs from run to run.
    pub spread: Spread,
    /// Variance by which the means of conditions differ from those of the model beyond what its runs explain, over the
    /// variance of a run of the model; 0 for a model without runs.
    pub between: f64,
    /// Scatter of coefficients from condition to condition beyond that of runs: sessions that are not stated.
    pub sessions: Between,
    /// Scatter of the angle (rad) from condition to condition beyond that of runs: each is set anew.
    pub angles: Between,
}

/// Where a noise is from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum NoiseSource {
    /// The scatter of repeats.
    Repeats,
    /// Errors that the set states.
    Stated,
    /// Readings as the set states them, and a run-to-run scatter that is assumed as in
    /// `assumed_scatter`, since nothing was repeated.
    #[serde(rename = "assumed")]
    AssumedScatter,
    /// Nothing: 5 % of every number, so that a fit has weights. No test is made on it.
    Assumed,
}

/// Relative error of numbers about whose error nothing is known.
const ASSUMED: f64 = 0.05;

impl Noise {
    /// What the set states: nothing is known about the run-to-run scatter.
    pub fn stated() -> Self {
        let spread = Spread {
            coefficient: 0.0,
            path: 0.0,
            speed: 0.0,
            angle: 0.0,
            level: 0.0,
            clock: 0.0,
            start: 0.0,
        };
        Self {
            source: NoiseSource::Stated,
            reading: 1.0,
            spread,
            between: 0.0,
            sessions: Between::default(),
            angles: Between::default(),
        }
    }

    /// For comparing where nothing is known.
    pub fn assumed() -> Self {
        Self { source: NoiseSource::Assumed, ..Self::stated() }
    }

    /// Where readings have a stated error and nothing was repeated: coefficients scatter by 5 %, the
    /// force along the path by 12 %, as in common beds.
    pub(crate) fn assumed_scatter(instrument: &Instrument) -> Self {
        let spread = Spread::of_one_run(0.05, 0.12, instrument);
        Self { source: NoiseSource::AssumedScatter, spread, ..Self::guess(instrument) }
    }

    /// A first guess where there are repeats: coefficients to 5 %, the path to 12 %.
    pub fn guess(instrument: &Instrument) -> Self {
        let spread = Spread::new(0.05, 0.12, instrument);
        Self {
            source: NoiseSource::Repeats,
            reading: 1.0,
            spread,
            between: 0.0,
            sessions: Between::default(),
            angles: Between::default(),
        }
    }

    /// The most likely noise of the runs of the conditions `fit`, whose observables follow the
    /// run-to-run inputs by `sensitivities` (in the same order), searched from `self`.
    pub fn estimate(
        &self,
        observed: &Observed,
        sensitivities: &[Sensitivity],
        instrument: &Instrument,
    ) -> Self {
        if self.source != NoiseSource::Repeats {
            return *self;
        }
        let conditions = observed.fit.iter().map(|&index| &observed.conditions[index]);
        let terms: Vec<Term> = conditions
            .zip(sensitivities)
            .filter(|(condition, _)| condition.runs.len() > 1)
            .map(|(condition, sensitivity)| Term::new(condition, sensitivity))
            .collect();
        let unstated = Unstated::of(instrument, sensitivities);
        let without = Unstated { angle: false, start: None, ..unstated };
        let mut likelihood = Likelihood { terms, instrument: *instrument, unstated: without };
        let mut found = likelihood.most_likely(*self);
        // Neither is taken for granted: each must show in the repeats.
        let angle = Unstated { angle: true, ..without };
        let start = Unstated { start: unstated.start, ..without };
        for more in
            [unstated.angle.then_some(angle), unstated.start.map(|_| start)].into_iter().flatten()
        {
            let before = likelihood.unstated;
            likelihood.unstated = before.and(more);
            let wider = likelihood.most_likely(found);
            match likelihood.deviance(&found) - likelihood.deviance(&wider) > SHOWN {
                true => found = wider,
                false => likelihood.unstated = before,
            }
        }
        Self { between: self.between, sessions: self.sessions, angles: self.angles, ..found }
    }

    /// The logarithms of what is learned from repeats: reading, coefficients and path; then what is `unstated`.
    fn to_logarithms(self, unstated: Unstated) -> Vec<f64> {
        let Spread { coefficient, path, speed, angle, level, clock, start: way } = self.spread;
        let mut all = vec![libm::log(self.reading), libm::log(coefficient), libm::log(path)];
        let mut add = |value: f64, start: f64, (low, high): (f64, f64)| {
            let value = if value > 0.0 { value } else { start };
            all.push(libm::log(value.clamp(low, high)));
        };
        if unstated.speed {
            add(speed, 3e-3, SPEED_BOUNDS);
        }
        if unstated.angle {
            add(angle, 2e-3, ANGLE_BOUNDS);
        }
        if unstated.level {
            add(level, 1e-4, LEVEL_BOUNDS);
        }
        if let Some(rate) = unstated.rate {
            add(clock * rate, 0.05, FRAMES_BOUNDS);
        }
        if let Some(rate) = unstated.start {
            add(way * rate, 0.05, FRAMES_BOUNDS);
        }
        all
    }

    /// As JSON for a report on `set`, by `forward`.
    pub fn to_json(&self, set: &MeasurementSet, forward: &dyn Forward) -> Value {
        let (key, reading) = match set.kind.curve() {
            Some(curve) => (curve.sigma_key, reading_error(set, curve)),
            None => ("position_sigma_m", position_error(&set.instrument)),
        };
        let mut all = json!({
            "source": self.source,
            (key): rounded(self.reading * reading),
            "speed_sd": rounded(self.spread.speed),
            "angle_sd_deg": rounded(self.spread.angle.to_degrees()),
            "level_sd_m": rounded(self.spread.level),
            "clock_sd_s": rounded(self.spread.clock),
            "range_zero_sd_s": rounded(self.spread.start),
            "between_conditions_sd": rounded(self.sessions.sd),
            "between_conditions_angle_sd_deg": rounded(self.angles.sd.to_degrees()),
        });
        // Where the model has runs of its own, those of the set scatter as they do, by this share of their numbers.
        if forward.ways_of_scatter(0).is_some() {
            all["run_sd_rel"] = rounded(self.spread.path);
        } else {
            all["coefficient_sd"] = rounded(self.spread.coefficient);
            all["path_force_sd"] = rounded(self.spread.path);
        }
        all
    }

    /// Covariance of the numbers of one run.
    pub fn covariance(
        &self,
        condition: &ObservedCondition,
        sensitivity: &Sensitivity,
    ) -> DMatrix<f64> {
        match self.source {
            NoiseSource::Repeats | NoiseSource::AssumedScatter => {
                let scatter = scaled_columns(&sensitivity.slope, &sensitivity.spread(&self.spread));
                let readings = condition.reading.map(|sd| (self.reading * sd).powi(2));
                DMatrix::from_diagonal(&readings) + &scatter * scatter.transpose()
            }
            NoiseSource::Stated => stated_covariance(condition, 0.0),
            NoiseSource::Assumed => stated_covariance(condition, ASSUMED),
        }
    }

    /// What the mean of a condition scatters by together with all its runs, a column for each coefficient and for the
    /// angle: its covariance is the product with the transposed. `None` where nothing scatters between conditions.
    pub(crate) fn between_conditions(&self, sensitivity: &Sensitivity) -> Option<DMatrix<f64>> {
        let slope = sensitivity.by_coefficients();
        let of_coefficients = slope.column_iter().filter(|_| self.sessions.sd > 0.0);
        let mut columns: Vec<_> = of_coefficients.map(|column| self.sessions.sd * column).collect();
        columns.extend(self.angle_of_condition(sensitivity));
        (!columns.is_empty()).then(|| DMatrix::from_columns(&columns))
    }

    /// The column of the angle among these.
    pub(crate) fn angle_of_condition(&self, sensitivity: &Sensitivity) -> Option<DVector<f64>> {
        let slope = sensitivity.by_angle();
        let column = slope.column_iter().next()?;
        (self.angles.sd > 0.0).then(|| self.angles.sd * column)
    }
}

/// A stated relative error is one factor on all numbers of a kind, beside the error of readings; that
/// of a scalar is the whole of its error, since a number of the whole impact is stated as it was read.
fn stated_covariance(condition: &ObservedCondition, otherwise: f64) -> DMatrix<f64> {
    let kinds = condition.layout.kinds();
    let error = |at: usize| condition.stated[at].unwrap_or(otherwise) * condition.mean[at];
    DMatrix::from_fn(kinds.len(), kinds.len(), |i, j| {
        let together = if kinds[i] == kinds[j] { error(i) * error(j) } else { 0.0 };
        // A share of nothing is no error, and would have no inverse.
        let whole =
            kinds[i].is_scalar() && condition.stated[i].is_some() && condition.mean[i] != 0.0;
        together + if i == j && !whole { condition.reading[i].powi(2) } else { 0.0 }
    })
}

fn scaled_columns(matrix: &DMatrix<f64>, scale: &DVector<f64>) -> DMatrix<f64> {
    let mut scaled = matrix.clone();
    for (mut column, factor) in scaled.column_iter_mut().zip(scale.iter()) {
        column *= *factor;
    }
    scaled
}

/// What a set does not state of the scatter from run to run, and its numbers depend on.
#[derive(Clone, Copy, Debug)]
struct Unstated {
    speed: bool,
    angle: bool,
    level: bool,
    /// Of the frames (1/s), where the clock scatters.
    rate: Option<f64>,
    /// The same, where the zero of ways forward does.
    start: Option<f64>,
}

impl Unstated {
    fn of(instrument: &Instrument, sensitivities: &[Sensitivity]) -> Self {
        let matters = |input: fn(&Sensitivity) -> bool| sensitivities.iter().any(input);
        Self {
            speed: instrument.speed_sigma_rel.is_none() && matters(Sensitivity::depends_on_speed),
            angle: instrument.angle_sigma_deg.is_none() && matters(Sensitivity::depends_on_angle),
            level: instrument.level_sigma.is_none() && matters(Sensitivity::depends_on_level),
            rate: instrument.rate.filter(|_| matters(Sensitivity::depends_on_clock)),
            start: instrument.rate.filter(|_| matters(Sensitivity::depends_on_start)),
        }
    }

    /// With what `other` leaves unstated too.
    fn and(self, other: Self) -> Self {
        let angle = self.angle || other.angle;
        Self { angle, start: self.start.or(other.start), ..self }
    }
}

fn from_logarithms(at: &[f64], instrument: &Instrument, unstated: Unstated) -> Noise {
    let (low, high) = SPREAD_BOUNDS;
    let least = least_position_error(instrument) / position_error(instrument);
    let reading = libm::exp(at[0]).clamp(least, READING_MOST);
    let [coefficient, path] = [at[1], at[2]].map(|log| libm::exp(log).clamp(low, high));
    let mut spread = Spread::new(coefficient, path, instrument);
    let mut others = at[3..].iter();
    let mut next =
        |(low, high): (f64, f64)| others.next().map_or(0.0, |log| libm::exp(*log).clamp(low, high));
    if unstated.speed {
        spread.speed = next(SPEED_BOUNDS);
    }
    if unstated.angle {
        spread.angle = next(ANGLE_BOUNDS);
    }
    if unstated.level {
        spread.level = next(LEVEL_BOUNDS);
    }
    if let Some(rate) = unstated.rate {
        spread.clock = next(FRAMES_BOUNDS) / rate;
    }
    if let Some(rate) = unstated.start {
        spread.start = next(FRAMES_BOUNDS) / rate;
    }
    Noise {
        source: NoiseSource::Repeats,
        reading,
        spread,
        between: 0.0,
        sessions: Between::default(),
        angles: Between::default(),
    }
}

/// What the likelihood needs of one condition, in units of the stated error of its readings.
struct Term {
    sensitivity: Sensitivity,
    /// The inputs that the observables follow.
    felt: Vec<usize>,
    /// Number of observables.
    n: f64,
    /// Number of independent deviations.
    contrasts: f64,
    /// JᵀJ of the sensitivities to these.
    gram: DMatrix<f64>,
    /// Jᵀ times the deviations, a column for each run.
    projected: DMatrix<f64>,
    /// Sum of squares of the deviations.
    trace: f64,
}

impl Term {
    fn new(condition: &ObservedCondition, sensitivity: &Sensitivity) -> Self {
        let mut slope = sensitivity.slope.clone();
        for (mut row, sd) in slope.row_iter_mut().zip(condition.reading.iter()) {
            row /= *sd;
        }
        let deviations = (0..condition.runs.len())
            .map(|run| condition.deviation(run).component_div(&condition.reading));
        let felt = slope.column_iter().enumerate();
        let felt = felt.filter(|(_, column)| column.iter().any(|slope| *slope != 0.0));
        let felt: Vec<usize> = felt.map(|(input, _)| input).collect();
        let slope = slope.select_columns(&felt);
        let deviations: Vec<DVector<f64>> = deviations.collect();
        let trace = deviations.iter().map(DVector::norm_squared).sum();
        let projected = slope.tr_mul(&DMatrix::from_columns(&deviations));
        Self {
            n: condition.reading.len() as f64,
            contrasts: condition.runs.len() as f64 - 1.0,
            gram: slope.tr_mul(&slope),
            projected,
            trace,
            sensitivity: sensitivity.clone(),
            felt,
        }
    }

    /// Twice the negative logarithm of the likelihood, by Woodbury's identity: the covariance is
    /// diagonal plus one dimension per random input.
    fn cost(&self, noise: &Noise) -> Option<f64> {
        let f2 = noise.reading.powi(2);
        let sd = self.sensitivity.spread(&noise.spread).select_rows(&self.felt);
        let inner = DMatrix::from_fn(sd.len(), sd.len(), |i, j| {
            f64::from(u8::from(i == j)) + sd[i] * self.gram[(i, j)] * sd[j] / f2
        });
        let inner = Cholesky::new(inner)?;
        let mut onto = self.projected.clone();
        onto.row_iter_mut().zip(sd.iter()).for_each(|(mut row, sd)| row *= *sd / noise.reading);
        inner.l_dirty().solve_lower_triangular_mut(&mut onto);
        let explained = onto.norm_squared();
        let determinant = self.n * libm::log(f2) + log_determinant(&inner);
        Some(self.contrasts * determinant + (self.trace - explained) / f2)
    }
}

/// Logarithm of the determinant of a matrix from its factor.
pub(crate) fn log_determinant(factor: &Cholesky<f64, nalgebra::Dyn>) -> f64 {
    2.0 * factor.l_dirty().diagonal().iter().map(|d| libm::log(*d)).sum::<f64>()
}

struct Likelihood {
    terms: Vec<Term>,
    instrument: Instrument,
    unstated: Unstated,
}

impl Likelihood {
    /// The noise of largest likelihood, searched from `start`; `start` where the search fails. A simplex that has shrunk
    /// beside a bound, where the likelihood is flat, begins anew for as long as that finds more.
    fn most_likely(&self, start: Noise) -> Noise {
        let (mut best, mut least) = (start, f64::INFINITY);
        for _ in 0..SEARCHES {
            let next = self.search(best);
            let deviance = self.deviance(&next);
            if deviance > least - MORE {
                break;
            }
            (best, least) = (next, deviance);
        }
        best
    }

    fn search(&self, start: Noise) -> Noise {
        let first = start.to_logarithms(self.unstated);
        let mut simplex = vec![first.clone()];
        for axis in 0..first.len() {
            let mut corner = first.clone();
            corner[axis] += 0.4;
            simplex.push(corner);
        }
        // In the logarithms, so 1e-4 is a hundredth of a percent of a standard deviation.
        let best = NelderMead::new(simplex)
            .with_sd_tolerance(1e-4)
            .and_then(|solver| {
                let run = Executor::new(self, solver);
                run.configure(|state| state.max_iters(ITERATIONS)).run()
            })
            .ok()
            .and_then(|result| result.state().get_best_param().cloned());
        best.map_or(start, |at| from_logarithms(&at, &self.instrument, self.unstated))
    }

    /// Twice the negative logarithm of the likelihood.
    fn deviance(&self, noise: &Noise) -> f64 {
        let total = self.terms.iter().map(|term| term.cost(noise)).sum::<Option<f64>>();
        total.unwrap_or(f64::INFINITY)
    }
}

impl CostFunction for &Likelihood {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, at: &Self::Param) -> Result<f64, argmin::core::Error> {
        Ok(self.deviance(&from_logarithms(at, &self.instrument, self.unstated)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_sets::{condition, scalar_run, set};
    use measurements::{Kind, StatedError};

    #[test]
    fn a_scalar_with_a_stated_error_has_that_error_alone() {
        // Repeated, so that the stopping time counts although its error is not stated.
        let runs = vec![scalar_run(0, [Some(0.1), Some(0.05), None]); 2];
        let mut set = set(Kind::Scalar, vec![condition(1.0, 90.0)], runs);
        set.stated = StatedError { final_z: Some(0.06), ..StatedError::default() };
        let observed = &Observed::of(&set).conditions[0];
        let covariance = stated_covariance(observed, 0.0);
        // Both are one rounding of a product away from the value.
        assert!((covariance[(1, 1)].sqrt() / (0.06 * 0.05) - 1.0).abs() < 1e-12);
        assert!((covariance[(0, 0)].sqrt() / observed.reading[0] - 1.0).abs() < 1e-12);
    }
}
