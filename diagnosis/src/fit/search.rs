//! The search of a fit, with derivatives that are kept where they hold.
//!
//! Derivatives by differences cost one prediction of the set for each unknown; a step of the search costs one. Derivatives are
//! therefore corrected by what a step did (Broyden 1965, Math. Comp. 19, 577), and taken anew where they foresaw too little
//! of it.

use std::cell::RefCell;

use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::storage::Owned;
use nalgebra::{DMatrix, DVector, Dyn};
use rayon::prelude::*;

use super::scale::Scale;

/// Where the search ends: relative change of χ² and of the unknowns.
pub(super) const TOLERANCE: f64 = 1e-6;

/// Most evaluations per unknown, and one more: a search that converges takes a tenth of them.
const PATIENCE: usize = 30;

/// Longest first step, in units of the distance from zero: a longer one leaves where derivatives hold, and logarithms
/// do not come back.
const FIRST_STEP: f64 = 1.0;

/// By how much what cannot be integrated misses, in units of the best that was tried: the search turns back from it
/// and takes a tenth of the step.
const REFUSED: f64 = 1e3;

/// Share of what a step did that derivatives may miss and are corrected; they are taken anew where they miss more.
const MISSED: f64 = 0.2;

/// Share of the residual that a step may change, likewise: far from the minimum, corrected derivatives lead elsewhere.
const SMALL: f64 = 0.3;

/// What a search does with derivatives after a step.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Derivatives {
    /// It corrects them by what the step did.
    Kept,
    /// It takes them anew: corrected ones may end it in a narrow valley, on the way to the minimum.
    Anew,
}

/// Derivatives by the unknowns of a search, known where it came by.
#[derive(Clone)]
pub(super) struct Known {
    /// The unknowns of the fit that are searched.
    free: Vec<usize>,
    /// All unknowns where the derivatives are known.
    unknowns: Vec<f64>,
    residual: DVector<f64>,
    /// Of the residual, a column for each unknown that is searched.
    slopes: DMatrix<f64>,
    /// How far the search has come since differences were taken, in standard deviations of the prediction.
    pub(super) moved: f64,
}

impl Known {
    /// By `unknowns` that are searched only: `None` where others are too.
    fn by(&self, free: &[usize]) -> Option<Self> {
        let place = |at: &usize| self.free.iter().position(|known| known == at);
        let columns: Vec<usize> = free.iter().map(place).collect::<Option<_>>()?;
        Some(Self {
            free: free.to_vec(),
            slopes: self.slopes.select_columns(&columns),
            ..self.clone()
        })
    }

    /// The derivative of the residual by unknown `at`.
    pub(super) fn slope(&self, at: usize) -> Option<DVector<f64>> {
        let column = self.free.iter().position(|known| *known == at)?;
        Some(self.slopes.column(column).into_owned())
    }

    /// At `unknowns` with this `residual`, corrected by the way there; `None` where it was not foreseen.
    pub(super) fn after(&self, unknowns: &[f64], residual: &DVector<f64>) -> Option<Self> {
        let change = self.free.iter().map(|&at| unknowns[at] - self.unknowns[at]);
        let change = DVector::from_iterator(self.free.len(), change);
        let did = residual - &self.residual;
        let foreseen = &self.slopes * &change;
        let missed = &did - &foreseen;
        let is_foreseen = missed.norm() <= MISSED * did.norm();
        if !is_foreseen || did.norm() > SMALL * self.residual.norm() {
            return None;
        }
        let mut slopes = self.slopes.clone();
        // In units in which each unknown moves the prediction by one standard deviation.
        let sizes = self.slopes.column_iter().map(|column| column.norm_squared());
        let scaled = DVector::from_iterator(change.len(), sizes).component_mul(&change);
        correct(&mut slopes, &missed, (&change, &scaled));
        let moved = self.moved + did.norm();
        let (unknowns, residual) = (unknowns.to_vec(), residual.clone());
        Some(Self { free: self.free.clone(), unknowns, residual, slopes, moved })
    }
}

/// Corrects derivatives that `missed` a part of what a `change` of the unknowns did, so that they say all of it (Broyden 1965).
/// `scaled` is the change in units in which the unknowns count alike.
pub(crate) fn correct(
    slopes: &mut DMatrix<f64>,
    missed: &DVector<f64>,
    (change, scaled): (&DVector<f64>, &DVector<f64>),
) {
    let length = scaled.dot(change);
    if length > 0.0 {
        *slopes += missed * scaled.transpose() / length;
    }
}

/// What a fit leaves over, by its unknowns.
pub(super) trait Residual: Sync {
    /// Whitened measured less predicted; none where the model cannot be integrated, or gives no finite numbers.
    fn at(&self, unknowns: &[f64]) -> Option<DVector<f64>>;

    /// How many numbers that are.
    fn rows(&self) -> usize;
}

/// The search of the unknowns that are not held.
pub(super) struct Search<'a> {
    residual: &'a dyn Residual,
    scales: &'a [Scale],
    free: Vec<usize>,
    unknowns: Vec<f64>,
    /// χ² and unknowns of the best that was tried.
    best: RefCell<(f64, Vec<f64>)>,
    known: RefCell<Option<Known>>,
    derivatives: Derivatives,
}

impl<'a> Search<'a> {
    /// Of what is not `held`, from `unknowns`, with the derivatives that are `known` there, if any are.
    pub(super) fn new(
        residual: &'a dyn Residual,
        (scales, held): (&'a [Scale], &[bool]),
        (unknowns, known): (Vec<f64>, Option<&Known>),
        derivatives: Derivatives,
    ) -> Self {
        let free: Vec<usize> = (0..held.len()).filter(|&at| !held[at]).collect();
        let known = RefCell::new(known.and_then(|known| known.by(&free)));
        let best = RefCell::new((f64::INFINITY, unknowns.clone()));
        Self { residual, scales, free, unknowns, best, known, derivatives }
    }

    /// The best unknowns that were tried, since the search may end where the model cannot be integrated, and the
    /// derivatives where they are known last.
    pub(super) fn minimum(self) -> (Vec<f64>, Option<Known>) {
        let solver = LevenbergMarquardt::new()
            .with_ftol(TOLERANCE)
            .with_xtol(TOLERANCE)
            .with_patience(PATIENCE)
            .with_stepbound(FIRST_STEP);
        let (search, _) = solver.minimize(self);
        let (_, unknowns) = search.best.into_inner();
        (unknowns, search.known.into_inner())
    }

    fn differences(&self, here: &DVector<f64>) -> DMatrix<f64> {
        let Self { residual, scales, unknowns, .. } = self;
        let column = |&at: &usize| {
            // Inwards from the upper end of a range, where a step outwards changes nothing.
            let step = scales[at].unknown_step();
            let step = if scales[at].contains(unknowns[at] + step) { step } else { -step };
            let moved = |by: f64| {
                let mut unknowns = unknowns.clone();
                unknowns[at] += by;
                residual.at(&unknowns)
            };
            let forth = moved(step).map(|there| (there - here) / step);
            let slope = forth.or_else(|| moved(-step).map(|there| (here - there) / step));
            slope.unwrap_or_else(|| here * 0.0)
        };
        let columns: Vec<_> = self.free.par_iter().map(column).collect();
        DMatrix::from_columns(&columns)
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Search<'_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;

    fn set_params(&mut self, free: &DVector<f64>) {
        for (&at, unknown) in self.free.iter().zip(free.iter()) {
            self.unknowns[at] = *unknown;
        }
    }

    fn params(&self) -> DVector<f64> {
        DVector::from_iterator(self.free.len(), self.free.iter().map(|&at| self.unknowns[at]))
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        let mut best = self.best.borrow_mut();
        let Some(residual) = self.residual.at(&self.unknowns) else {
            let rows = self.residual.rows();
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
        let here = self.residual.at(&self.unknowns)?;
        let mut known = self.known.borrow_mut();
        let after = known.take().and_then(|known| known.after(&self.unknowns, &here));
        let after = after.filter(|now| self.derivatives == Derivatives::Kept || now.moved <= 0.0);
        let now = after.unwrap_or_else(|| Known {
            free: self.free.clone(),
            unknowns: self.unknowns.clone(),
            slopes: self.differences(&here),
            residual: here,
            moved: 0.0,
        });
        let slopes = now.slopes.clone();
        *known = Some(now);
        Some(slopes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The second unknown moves the second row by 2 for each unit, the derivatives say 1.9.
    fn known() -> Known {
        Known {
            free: vec![0, 2],
            unknowns: vec![1.0, 7.0, 1.0],
            residual: DVector::from_vec(vec![10.0, 10.0]),
            slopes: DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 0.0, 1.9]),
            moved: 0.0,
        }
    }

    #[test]
    fn derivatives_that_foresaw_a_step_are_corrected_to_say_what_it_did() {
        let there = DVector::from_vec(vec![10.0, 11.0]);
        let now = known().after(&[1.0, 7.0, 1.5], &there).expect("a step that was foreseen");
        assert!((now.slopes[(1, 1)] - 2.0).abs() < 1e-12 && (now.moved - 1.0).abs() < 1e-12);
        assert!((now.slopes[(0, 0)] - 1.0).abs() < 1e-12, "the other unknown stood still");
        let told = now.slope(2).expect("an unknown that is searched");
        assert!((told[1] - 2.0).abs() < 1e-12 && now.slope(1).is_none());
    }

    #[test]
    fn derivatives_are_forgotten_by_steps_that_they_did_not_foresee_and_by_long_ones() {
        let unforeseen = DVector::from_vec(vec![10.0, 9.5]);
        assert!(known().after(&[1.0, 7.0, 1.5], &unforeseen).is_none());
        let far = DVector::from_vec(vec![10.0, 19.5]);
        assert!(known().after(&[1.0, 7.0, 6.0], &far).is_none());
    }
}
