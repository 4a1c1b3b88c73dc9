//! Weighted least squares: the free parameters of a model, and the amplitudes of effects added to it.
//!
//! A parameter that cannot be negative is fitted in a logarithm that turns linear near zero (an inverse hyperbolic sine),
//! the others and all amplitudes as they are. One that ends outside its range is held at the bound while the rest is
//! fitted again, and set free if χ² then falls from the bound inwards.

use std::cell::RefCell;

use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::storage::Owned;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use rayon::prelude::*;

use crate::forward::{Bound, Forward, ParameterKind, PredictError, Prior};
use crate::observed::Observed;
use crate::sensitivity::Point;
use crate::weights::Weight;

/// Where the search ends: relative change of χ² and of the unknowns.
const TOLERANCE: f64 = 1e-6;

/// Most evaluations per unknown, and one more: a search that converges takes a tenth of them.
const PATIENCE: usize = 30;

/// Longest first step, in units of the distance from zero: a longer one leaves where derivatives hold, and logarithms
/// do not come back.
const FIRST_STEP: f64 = 1.0;

/// By how much what cannot be integrated misses, in units of the best that was tried: the search turns back from it
/// and takes a tenth of the step.
const REFUSED: f64 = 1e3;

/// How often what is held at bounds is set free: a step too long leaves a range that the best fit is in.
const RELEASES: usize = 10;

/// Share of its start below which a parameter without a sign is searched as it is: a logarithm never comes to zero, and
/// from next to zero never back.
const LINEAR: f64 = 0.1;

/// Share of a parameter by which it is moved for a derivative.
const STEP: f64 = 1e-3;

/// Share of the standard deviation of a prior around zero, likewise: above what rounding does to differences.
const OF_PRIOR: f64 = 0.05;

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
    #[must_use]
    pub fn n_free(&self) -> usize {
        self.free.len()
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
    #[must_use]
    pub(crate) fn free_covariance(&self) -> DMatrix<f64> {
        self.covariance.select_rows(&self.free).select_columns(&self.free)
    }

    /// Standard error of unknown `index`, parameters first; none when it is held at a bound, or nothing depends on it.
    #[must_use]
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
    ///
    /// # Errors
    /// If the model cannot be integrated at the start or at the end.
    pub(crate) fn fit_as_listed(&self, start: &Point) -> Result<Fit, PredictError> {
        self.fit_but(start, &self.scales(start), self.forms(start))
    }

    /// Fits `candidate` as listed from where parameters start, without what another fit has found and with the apparatus
    /// as it is stated; the derivatives are those by errors of the apparatus too. A search by all of them from there may end
    /// where errors of the apparatus make up for a law.
    ///
    /// # Errors
    /// If the model cannot be integrated at the start or at the end.
    pub(crate) fn fit_with_apparatus_as_stated(
        &self,
        candidate: usize,
    ) -> Result<Fit, PredictError> {
        let start = Point { effects: vec![(candidate, 0.0)], ..Point::start(self.forward) };
        let scales = self.scales(&start);
        let is_apparatus = |at: usize| {
            let parameter = self.forward.parameters().get(at);
            parameter.is_some_and(|one| one.kind == ParameterKind::Apparatus)
        };
        let forms = self.forms(&start).into_iter().enumerate();
        let held = forms.map(|(at, is_form)| is_form || is_apparatus(at)).collect();
        let (point, mut held) = self.search(&start, &scales, held)?;
        held.iter_mut().enumerate().for_each(|(at, held)| *held &= !is_apparatus(at));
        self.result(point, &scales, &held)
    }

    /// What a fit as listed would be that ends at `point`.
    ///
    /// # Errors
    /// If the model cannot be integrated there.
    pub(crate) fn as_listed_at(&self, point: Point) -> Result<Fit, PredictError> {
        let held = self.forms(&point);
        self.ending_at(point, held)
    }

    /// Fits as listed, with the covariance that numbers of a form have around it: what a fit predicts elsewhere holds
    /// what its form leaves open.
    ///
    /// # Errors
    /// If the model cannot be integrated at the start or at the end.
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
        self.result(point, &scales, &held)
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
        let (point, at_end) = self.search(start, scales, held)?;
        self.result(point, scales, &at_end)
    }

    /// Searches what is not `held` from `start`; gives the best and what is held there, since it is at a bound.
    fn search(
        &self,
        start: &Point,
        scales: &[Scale],
        mut held: Vec<bool>,
    ) -> Result<(Point, Vec<bool>), PredictError> {
        let mut best = self.residual(start)?.norm_squared();
        let mut point = start.clone();
        let fixed = held.clone();
        for _ in 0..=RELEASES {
            point = self.descend(start, point, scales, &mut held);
            let chi2 = self.residual(&point)?.norm_squared();
            if best - chi2 <= TOLERANCE * best {
                break;
            }
            best = chi2;
            let inward = (0..scales.len()).filter(|&at| held[at] && !fixed[at]);
            let inward: Vec<usize> =
                inward.filter(|&at| self.falls_inward(&point, scales, at, chi2)).collect();
            if inward.is_empty() {
                break;
            }
            inward.into_iter().for_each(|at| held[at] = false);
        }
        Ok((point, held))
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
        start: &Point,
        mut point: Point,
        scales: &[Scale],
        held: &mut [bool],
    ) -> Point {
        while held.contains(&false) {
            let unknowns = unknowns(&point, scales);
            let best = RefCell::new((f64::INFINITY, unknowns.clone()));
            let search = Search { data: self, scales, held, like: start, unknowns, best };
            let solver = LevenbergMarquardt::new()
                .with_ftol(TOLERANCE)
                .with_xtol(TOLERANCE)
                .with_patience(PATIENCE)
                .with_stepbound(FIRST_STEP);
            // The best that was tried, since the search may end where the model cannot be integrated.
            let (_, unknowns) = solver.minimize(search).0.best.into_inner();
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
    ///
    /// # Errors
    /// If the model cannot be integrated there.
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

    /// The same at `unknowns`; none where it cannot be integrated, or is not finite.
    fn residual_at(
        &self,
        unknowns: &[f64],
        scales: &[Scale],
        like: &Point,
    ) -> Option<DVector<f64>> {
        let residual = self.residual(&point_of(unknowns, scales, like)).ok()?;
        residual.iter().all(|r| r.is_finite()).then_some(residual)
    }

    /// How many numbers were measured: rows of a residual, before those of priors.
    #[must_use]
    pub fn measured(&self) -> usize {
        self.weights.iter().map(|weight| weight.shift.len()).sum()
    }

    fn rows(&self) -> usize {
        let priors = self.forward.parameters().iter().filter(|one| one.prior.is_some());
        self.measured() + priors.count()
    }

    /// Whitened derivative of the prediction at `point` by the unknowns of `fit` that are not held at
    /// a bound.
    ///
    /// # Errors
    /// If the model cannot be integrated there.
    pub(crate) fn jacobian(&self, fit: &Fit) -> Result<DMatrix<f64>, PredictError> {
        self.derivative(&fit.point, &self.scales(&fit.point), &fit.free)
    }

    fn derivative(
        &self,
        point: &Point,
        scales: &[Scale],
        free: &[usize],
    ) -> Result<DMatrix<f64>, PredictError> {
        let here = self.residual(point)?;
        let column = |&at: &usize| {
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

    fn result(&self, point: Point, scales: &[Scale], held: &[bool]) -> Result<Fit, PredictError> {
        let free: Vec<usize> = (0..scales.len()).filter(|&at| !held[at]).collect();
        let jacobian = self.derivative(&point, scales, &free)?;
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
        let parameters = parameters.map(|parameter| Scale {
            linear: parameter.has_no_sign().then_some(LINEAR * parameter.start),
            min: parameter.min,
            max: parameter.max,
            // An open range says nothing of the size of a number that starts at zero; a prior does.
            step: match parameter.prior {
                Some(prior) if parameter.start == 0.0 => OF_PRIOR * prior.sigma,
                _ => {
                    let size = 1e-3 * (parameter.max - parameter.min).min(1.0);
                    STEP * parameter.start.abs().max(size)
                }
            },
        });
        let candidates = self.forward.candidates();
        let amplitudes = start.effects.iter().map(|&(index, _)| Scale {
            linear: None,
            min: candidates[index].min,
            max: candidates[index].max,
            step: 0.1 * candidates[index].step,
        });
        parameters.chain(amplitudes).collect()
    }
}

/// How an unknown is searched.
pub(crate) struct Scale {
    /// Size below which one without a sign is searched as it is, above by its logarithm; none for what has a sign.
    linear: Option<f64>,
    pub(crate) min: f64,
    pub(crate) max: f64,
    step: f64,
}

impl Scale {
    /// Derivative of the value by its unknown, at `value`.
    pub(crate) fn slope(&self, value: f64) -> f64 {
        self.linear.map_or(1.0, |linear| libm::hypot(value, linear))
    }

    fn unknown(&self, value: f64) -> f64 {
        self.linear.map_or(value, |linear| libm::asinh(value / linear))
    }

    /// The value, brought into its range.
    fn value(&self, unknown: f64) -> f64 {
        let value = self.linear.map_or(unknown, |linear| linear * libm::sinh(unknown));
        value.clamp(self.min, self.max)
    }

    fn contains(&self, unknown: f64) -> bool {
        (self.unknown(self.min)..=self.unknown(self.max)).contains(&unknown)
    }

    /// By how much an unknown of this value is moved in earnest, to weigh derivatives by.
    fn reach(&self, value: f64) -> f64 {
        if self.linear.is_some() { self.slope(value) } else { self.step / STEP }
    }

    fn unknown_step(&self) -> f64 {
        if self.linear.is_some() { STEP } else { self.step }
    }

    fn physical_step(&self, value: f64) -> f64 {
        if self.linear.is_some() { STEP * self.slope(value) } else { self.step }
    }
}

pub(crate) fn value(point: &Point, at: usize) -> f64 {
    let n = point.parameters.len();
    if at < n { point.parameters[at] } else { point.effects[at - n].1 }
}

pub(crate) fn value_mut(point: &mut Point, at: usize) -> &mut f64 {
    let n = point.parameters.len();
    if at < n { &mut point.parameters[at] } else { &mut point.effects[at - n].1 }
}

pub(crate) fn unknowns(point: &Point, scales: &[Scale]) -> Vec<f64> {
    scales.iter().enumerate().map(|(at, scale)| scale.unknown(value(point, at))).collect()
}

pub(crate) fn point_of(unknowns: &[f64], scales: &[Scale], like: &Point) -> Point {
    let mut point = like.clone();
    for (at, (unknown, scale)) in unknowns.iter().zip(scales).enumerate() {
        *value_mut(&mut point, at) = scale.value(*unknown);
    }
    point
}

/// The search of the unknowns that are not held.
struct Search<'a> {
    data: &'a Data<'a>,
    scales: &'a [Scale],
    held: &'a [bool],
    like: &'a Point,
    unknowns: Vec<f64>,
    /// χ² and unknowns of the best that was tried.
    best: RefCell<(f64, Vec<f64>)>,
}

impl Search<'_> {
    fn free(&self) -> Vec<usize> {
        (0..self.held.len()).filter(|&at| !self.held[at]).collect()
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Search<'_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;

    fn set_params(&mut self, free: &DVector<f64>) {
        for (at, unknown) in self.free().into_iter().zip(free.iter()) {
            self.unknowns[at] = *unknown;
        }
    }

    fn params(&self) -> DVector<f64> {
        let free = self.free();
        DVector::from_iterator(free.len(), free.iter().map(|&at| self.unknowns[at]))
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        let mut best = self.best.borrow_mut();
        let Self { data, scales, like, unknowns, .. } = self;
        let Some(residual) = data.residual_at(unknowns, scales, like) else {
            let rows = self.data.rows();
            let size = REFUSED * (best.0.max(1.0) / rows.max(1) as f64).sqrt();
            return size.is_finite().then(|| DVector::from_element(rows, size));
        };
        let chi2 = residual.norm_squared();
        if chi2 < best.0 {
            *best = (chi2, self.unknowns.clone());
        }
        Some(residual)
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let Self { data, scales, like, unknowns, .. } = self;
        let here = data.residual_at(unknowns, scales, like)?;
        let column = |at: usize| {
            // Inwards from the upper end of a range, where a step outwards changes nothing.
            let step = scales[at].unknown_step();
            let step = if scales[at].contains(unknowns[at] + step) { step } else { -step };
            let moved = |by: f64| {
                let mut unknowns = unknowns.clone();
                unknowns[at] += by;
                data.residual_at(&unknowns, scales, like)
            };
            let forth = moved(step).map(|there| (there - &here) / step);
            let slope = forth.or_else(|| moved(-step).map(|there| (&here - there) / step));
            slope.unwrap_or_else(|| &here * 0.0)
        };
        let columns: Vec<_> = self.free().into_par_iter().map(column).collect();
        Some(DMatrix::from_columns(&columns))
    }
}
