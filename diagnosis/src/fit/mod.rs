//! Weighted least squares: the free parameters of a model, and the amplitudes of effects added to it.
//!
//! A parameter that cannot be negative is fitted in a logarithm that turns linear near zero (an inverse hyperbolic sine),
//! the others and all amplitudes as they are. One that ends outside its range is held at the bound while the rest is
//! fitted again, and set free if χ² then falls from the bound inwards.

pub(crate) mod broyden;
pub mod fitted_parameters;
pub mod problem;
pub(crate) mod restricted_likelihood;
mod scale;
mod search;

use nalgebra::{Cholesky, DMatrix, DVector};
use rayon::prelude::*;

use crate::forward::sensitivity::Point;
use crate::forward::{Bound, Forward, ParameterKind, PredictError, Prior};
use crate::noise::weights::Weight;
use crate::observed::Observed;
pub(crate) use scale::{Scale, point_of, unknowns, value, value_mut};
pub(crate) use search::correct;
use search::{Derivatives, Known, Residual, Search, TOLERANCE};

/// How often what is held at bounds is set free: a step too long leaves a range that the best fit is in.
const RELEASES: usize = 10;

/// Standard deviations of the prediction over which a search may come and leave its derivatives as they are.
const NEAR: f64 = 0.5;

/// The same over which a search may come with corrected derivatives and end there.
const AT_REST: f64 = 0.02;

/// Standard deviations of its prior beyond which an error of the apparatus is strained: a fit that takes it there may make
/// up for what the model lacks.
const STRAINED: f64 = 4.0;

/// An unknown that moves the prediction by less than this share of what the others do is idle.
const IDLE: f64 = 1e-6;

/// What is fitted to.
#[derive(Clone, Copy)]
pub struct Data<'a> {
    /// The model.
    pub forward: &'a dyn Forward,
    /// The measurements.
    pub observed: &'a Observed,
    /// Indices of the conditions that are fitted to, or judged by.
    pub conditions: &'a [usize],
    /// One per condition of `conditions`, in that order.
    pub weights: &'a [Weight],
}

/// The residual of `data` by unknowns, at points like `like`.
struct ByUnknowns<'a> {
    data: &'a Data<'a>,
    scales: &'a [Scale],
    like: &'a Point,
}

impl Residual for ByUnknowns<'_> {
    fn at(&self, unknowns: &[f64]) -> Option<DVector<f64>> {
        let residual = self.data.residual(&point_of(unknowns, self.scales, self.like)).ok()?;
        residual.iter().all(|r| r.is_finite()).then_some(residual)
    }

    fn rows(&self) -> usize {
        self.data.rows()
    }
}

/// How far a search goes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Until {
    /// As far as kept derivatives lead: another search begins there.
    Near,
    /// To the minimum.
    Minimum,
}

/// Whitened derivatives of a prediction that are known, by unknown.
type Columns<'a> = dyn Fn(usize) -> Option<DVector<f64>> + Sync + 'a;

/// Those that a search knows where it ended, at `point`.
fn columns<'a>(
    known: Option<&'a Known>,
    point: &'a Point,
    scales: &'a [Scale],
) -> impl Fn(usize) -> Option<DVector<f64>> + Sync + 'a {
    let near = known.filter(|known| known.moved <= NEAR);
    move |at| Some(near?.slope(at)? / -scales[at].slope(value(point, at)))
}

/// The result of a fit.
#[derive(Clone, Debug)]
pub struct Fit {
    /// Parameters and amplitudes.
    pub point: Point,
    /// Covariance of the parameters, then of the amplitudes; zero for what is held at a bound.
    pub covariance: DMatrix<f64>,
    /// Weighted sum of squares.
    pub chi2: f64,
    /// Whitened measured less predicted, condition after condition; then parameters with a prior: its mean less the
    /// value, in its standard deviations.
    pub residual: DVector<f64>,
    /// Whitened derivative of the prediction by what is not held at a bound.
    pub jacobian: DMatrix<f64>,
    /// Unknowns that are not held at a bound, parameters first.
    free: Vec<usize>,
}

impl Fit {
    /// The parameters as they are, the effects left out.
    pub(crate) fn without_effects(&self) -> Self {
        let point = Point { effects: Vec::new(), parameters: self.point.parameters.clone() };
        Self { point, ..self.clone() }
    }

    /// Number of unknowns that are not held at a bound.
    pub fn n_free(&self) -> usize {
        self.free.len()
    }

    /// Whitened derivative of the prediction by unknown `at`; `None` of one that is held.
    fn column(&self, at: usize) -> Option<DVector<f64>> {
        let place = self.free.iter().position(|free| *free == at)?;
        Some(self.jacobian.column(place).into_owned())
    }

    /// The unknowns that are not held at a bound, parameters first.
    pub(crate) fn free(&self) -> &[usize] {
        &self.free
    }

    /// The point that fits best to first order where `residual` is what is left over at this one, within the ranges of
    /// `scales`; `None` where the unknowns are not told apart.
    pub(crate) fn moved(&self, residual: &DVector<f64>, scales: &[Scale]) -> Option<Point> {
        let factor = Cholesky::new(self.jacobian.tr_mul(&self.jacobian))?;
        let steps = factor.solve(&self.jacobian.tr_mul(residual));
        let mut point = self.point.clone();
        for (&at, step) in self.free.iter().zip(steps.iter()) {
            let place = value_mut(&mut point, at);
            *place = (*place + step).clamp(scales[at].min, scales[at].max);
        }
        Some(point)
    }

    /// Covariance of the unknowns that are not held at a bound.
    pub(crate) fn free_covariance(&self) -> DMatrix<f64> {
        self.covariance.select_rows(&self.free).select_columns(&self.free)
    }

    /// Standard error of unknown `index`, parameters first; none when it is held at a bound, or nothing depends on it.
    pub fn standard_error(&self, index: usize) -> Option<f64> {
        Some(self.covariance[(index, index)]).filter(|own| *own > 0.0).map(f64::sqrt)
    }
}

impl Data<'_> {
    /// Fits the parameters and the amplitudes of the effects of `start`, from there.
    ///
    /// # Errors
    /// If the model cannot be integrated at the start or at the end.
    pub fn fit(&self, start: &Point) -> Result<Fit, PredictError> {
        let scales = self.scales(start);
        let free = vec![false; scales.len()];
        self.fit_but(start, &scales, free)
    }

    /// Whether an error of the apparatus is far beyond what is known of it at `point`.
    pub(crate) fn is_strained(&self, point: &Point) -> bool {
        self.forward.parameters().iter().zip(&point.parameters).any(|(parameter, value)| {
            let far = |prior: Prior| (value - prior.mean).abs() > STRAINED * prior.sigma;
            parameter.kind == ParameterKind::Apparatus && parameter.prior.is_some_and(far)
        })
    }

    /// Fits the parameters and the amplitudes of the effects of `start` as their formulas have them: a fall of χ² by one
    /// amplitude is not that by several numbers of its form.
    pub(crate) fn fit_as_listed(&self, start: &Point) -> Result<Fit, PredictError> {
        self.fit_but(start, &self.scales(start), self.forms(start))
    }

    /// Fits `candidate` as listed from where parameters start, without what another fit has found and with the apparatus
    /// as it is stated. The derivatives by errors of the apparatus are those of `near`, a fit to the same measurements under
    /// the same weights. A search by all of them from there may end
    /// where errors of the apparatus make up for a law.
    pub(crate) fn fit_with_apparatus_as_stated(
        &self,
        candidate: usize,
        near: &Fit,
    ) -> Result<Fit, PredictError> {
        let start = Point { effects: vec![(candidate, 0.0)], ..Point::start(self.forward) };
        let scales = self.scales(&start);
        let is_apparatus = |at: usize| {
            let parameter = self.forward.parameters().get(at);
            parameter.is_some_and(|one| one.kind == ParameterKind::Apparatus)
        };
        let forms = self.forms(&start).into_iter().enumerate();
        let held = forms.map(|(at, is_form)| is_form || is_apparatus(at)).collect();
        // It is where other searches begin.
        let (point, mut held, known) = self.search(&start, &scales, (held, Until::Near))?;
        held.iter_mut().enumerate().for_each(|(at, held)| *held &= !is_apparatus(at));
        let own = columns(known.as_ref(), &point, &scales);
        self.result(point.clone(), (&scales, &held), &|at| {
            own(at).or_else(|| near.column(at).filter(|_| is_apparatus(at)))
        })
    }

    /// What a fit as listed would be that ends at `point`.
    pub(crate) fn as_listed_at(&self, point: Point) -> Result<Fit, PredictError> {
        let held = self.forms(&point);
        self.ending_at(point, held)
    }

    /// Fits as listed, with the covariance that numbers of a form have around it: what a fit predicts elsewhere holds
    /// what its form leaves open.
    pub(crate) fn fit_as_listed_within_forms(&self, start: &Point) -> Result<Fit, PredictError> {
        let point = self.fit_as_listed(start)?.point;
        let held = vec![false; point.parameters.len() + point.effects.len()];
        self.ending_at(point, held)
    }

    /// What a fit would be that ends at `point`, with what is `held` and what is at a bound.
    fn ending_at(&self, point: Point, mut held: Vec<bool>) -> Result<Fit, PredictError> {
        let scales = self.scales(&point);
        for (at, scale) in scales.iter().enumerate() {
            held[at] |= Bound::at(value(&point, at), scale.min, scale.max).is_some();
        }
        self.result(point, (&scales, &held), &|_| None)
    }

    /// Which unknowns of `point` are numbers of a form.
    fn forms(&self, point: &Point) -> Vec<bool> {
        let parameters = self.forward.parameters().iter();
        let forms = parameters.map(|parameter| parameter.kind == ParameterKind::Form);
        forms.chain(point.effects.iter().map(|_| false)).collect()
    }

    /// Fits what is not `held`.
    fn fit_but(
        &self,
        start: &Point,
        scales: &[Scale],
        held: Vec<bool>,
    ) -> Result<Fit, PredictError> {
        let (point, at_end, known) = self.search(start, scales, (held, Until::Minimum))?;
        let known = columns(known.as_ref(), &point, scales);
        self.result(point.clone(), (scales, &at_end), &known)
    }

    /// Searches what is not `held` from `start`, as far as `until`; gives the best, what is held there, since it is at a
    /// bound, and the derivatives that are known there.
    fn search(
        &self,
        start: &Point,
        scales: &[Scale],
        (mut held, until): (Vec<bool>, Until),
    ) -> Result<(Point, Vec<bool>, Option<Known>), PredictError> {
        let mut best = self.residual(start)?.norm_squared();
        let mut point = start.clone();
        let (mut known, mut derivatives) = (None, Derivatives::Kept);
        let (fixed, mut is_released) = (held.clone(), false);
        for _ in 0..=RELEASES {
            let from = best;
            point = self.descend((start, point), (scales, &mut held), (&mut known, derivatives));
            let residual = self.residual(&point)?;
            best = residual.norm_squared();
            known = known.and_then(|known| known.after(&unknowns(&point, scales), &residual));
            let is_known = known.as_ref().is_some_and(|known| known.moved <= AT_REST);
            if derivatives == Derivatives::Kept && !is_known && until == Until::Minimum {
                derivatives = Derivatives::Anew;
                known = None;
                continue;
            }
            let inward = (0..scales.len()).filter(|&at| held[at] && !fixed[at]);
            let inward: Vec<usize> =
                inward.filter(|&at| self.falls_inward(&point, scales, at, best)).collect();
            let gains = from - best > TOLERANCE * from;
            if inward.is_empty() || (is_released && !gains) {
                break;
            }
            inward.into_iter().for_each(|at| held[at] = false);
            is_released = true;
        }
        Ok((point, held, known))
    }

    /// Whether χ² falls below `chi2` where unknown `at`, held at a bound, moves into its range.
    fn falls_inward(&self, point: &Point, scales: &[Scale], at: usize, chi2: f64) -> bool {
        let scale = &scales[at];
        let step = scale.physical_step(value(point, at));
        let mut moved = point.clone();
        let place = value_mut(&mut moved, at);
        *place = if *place + step < scale.max { *place + step } else { *place - step };
        self.residual(&moved).is_ok_and(|there| there.norm_squared() < chi2)
    }

    /// Searches what is not `held` from `point`, and holds what ends outside its range.
    fn descend(
        &self,
        (start, mut point): (&Point, Point),
        (scales, held): (&[Scale], &mut [bool]),
        (known, derivatives): (&mut Option<Known>, Derivatives),
    ) -> Point {
        while held.contains(&false) {
            let from = (unknowns(&point, scales), known.as_ref());
            let residual = ByUnknowns { data: self, scales, like: start };
            let search = Search::new(&residual, (scales, held), from, derivatives);
            let (unknowns, at_end) = search.minimum();
            *known = at_end;
            point = point_of(&unknowns, scales, start);
            let mut outside = false;
            for (at, scale) in scales.iter().enumerate() {
                let beyond = !held[at] && !scale.contains(unknowns[at]);
                held[at] |= beyond;
                outside |= beyond;
            }
            if !outside {
                break;
            }
        }
        point
    }

    /// Whitened measured less predicted at `point`, condition after condition; then parameters with a prior likewise.
    pub fn residual(&self, point: &Point) -> Result<DVector<f64>, PredictError> {
        let of_condition = |(&condition, weight): (&usize, &Weight)| {
            let mean = &self.observed.conditions[condition].mean;
            let difference = mean - weight.predict(point, self.forward, condition)?;
            Ok(weight.whiten(&difference))
        };
        let each = self.conditions.par_iter().zip(self.weights.par_iter()).map(of_condition);
        let each: Vec<Result<DVector<f64>, PredictError>> = each.collect();
        let mut residual = Vec::new();
        for one in each {
            residual.extend(one?.iter());
        }
        let known = self.forward.parameters().iter().zip(&point.parameters);
        residual.extend(known.filter_map(|(parameter, value)| {
            parameter.prior.map(|prior| (prior.mean - value) / prior.sigma)
        }));
        Ok(DVector::from_vec(residual))
    }

    /// How many numbers were measured: rows of a residual, before those of priors.
    pub fn measured(&self) -> usize {
        self.weights.iter().map(|weight| weight.shift.len()).sum()
    }

    fn rows(&self) -> usize {
        let priors = self.forward.parameters().iter().filter(|one| one.prior.is_some());
        self.measured() + priors.count()
    }

    /// Whitened derivative of the prediction at `point` by the unknowns of `fit` that are not held at
    /// a bound.
    pub(crate) fn jacobian(&self, fit: &Fit) -> Result<DMatrix<f64>, PredictError> {
        self.derivative(&fit.point, &self.scales(&fit.point), &fit.free, &|_| None)
    }

    /// The columns that `known` gives are not taken anew.
    fn derivative(
        &self,
        point: &Point,
        scales: &[Scale],
        free: &[usize],
        known: &Columns<'_>,
    ) -> Result<DMatrix<f64>, PredictError> {
        let here = self.residual(point)?;
        let column = |&at: &usize| {
            if let Some(column) = known(at) {
                return column;
            }
            let step = scales[at].physical_step(value(point, at));
            let moved = |by: f64| {
                let mut point = point.clone();
                *value_mut(&mut point, at) += by;
                self.residual(&point)
            };
            // To the other side where the model cannot be integrated on one; what cannot be moved at all is where it
            // is, as at a bound.
            moved(step)
                .map(|more| (&here - more) / step)
                .or_else(|_| moved(-step).map(|less| (less - &here) / step))
                .unwrap_or_else(|_| &here * 0.0)
        };
        let columns: Vec<DVector<f64>> = free.par_iter().map(column).collect();
        Ok(match columns.is_empty() {
            true => DMatrix::zeros(self.rows(), 0),
            false => DMatrix::from_columns(&columns),
        })
    }

    fn result(
        &self,
        point: Point,
        (scales, held): (&[Scale], &[bool]),
        known: &Columns<'_>,
    ) -> Result<Fit, PredictError> {
        let free: Vec<usize> = (0..scales.len()).filter(|&at| !held[at]).collect();
        let jacobian = self.derivative(&point, scales, &free, known)?;
        // What nothing depends on any more is at a bound too.
        let weight = |column: usize| {
            let at = free[column];
            jacobian.column(column).norm() * scales[at].reach(value(&point, at))
        };
        let heaviest = (0..free.len()).map(weight).fold(0.0, f64::max);
        let alive: Vec<usize> =
            (0..free.len()).filter(|&column| weight(column) > IDLE * heaviest).collect();
        let jacobian = jacobian.select_columns(&alive);
        let free: Vec<usize> = alive.into_iter().map(|column| free[column]).collect();
        let residual = self.residual(&point)?;
        let mut covariance = DMatrix::zeros(scales.len(), scales.len());
        if let Some(factor) = Cholesky::new(jacobian.tr_mul(&jacobian)) {
            let inverse = factor.inverse();
            for (i, &row) in free.iter().enumerate() {
                for (j, &column) in free.iter().enumerate() {
                    covariance[(row, column)] = inverse[(i, j)];
                }
            }
        }
        Ok(Fit { point, covariance, chi2: residual.norm_squared(), residual, jacobian, free })
    }

    /// How each unknown of `start` is searched.
    pub(crate) fn scales(&self, start: &Point) -> Vec<Scale> {
        let parameters = self.forward.parameters().iter();
        let candidates = self.forward.candidates();
        let amplitudes = start.effects.iter();
        let amplitudes = amplitudes.map(|&(index, _)| Scale::of_amplitude(&candidates[index]));
        parameters.map(Scale::of_parameter).chain(amplitudes).collect()
    }
}
