//! What the statistics ask of a model: predictions of observables, nothing else.
//!
//! A resistive-force model answers by integrating an impact; a grain bed answers from cached runs, whose
//! number is finite, and says how far off it may be for that.

pub mod apparatus;
pub mod field;
pub mod observable;
pub mod sensitivity;

use std::sync::Arc;

use nalgebra::DMatrix;
use resistive::{Draft, OwnEffectError, Space};
use serde::Serialize;
use thiserror::Error;

use crate::forward::field::Field;

/// A model that predicts the observables of every condition of a measurement set.
///
/// Implementations are pure: equal requests give equal bits, in any order, from any thread.
pub trait Forward: Sync {
    /// The free parameters β.
    fn parameters(&self) -> &[Parameter];

    /// The effects that could be added, in the order of the registry.
    fn candidates(&self) -> &[Candidate];

    /// How many coefficients scatter from run to run: [`Scatter::coefficients`] has this length.
    fn n_scattering_coefficients(&self) -> usize;

    /// The observables of condition `condition` of the set, in the order of the layout of
    /// that condition.
    ///
    /// They must be smooth in everything that is asked for, down to the steps of derivatives: the end
    /// of an impact is interpolated, not taken from the nearest step. Times before contact are of the
    /// free flight, times after the stop have the resting point.
    fn predict(&self, condition: usize, at: &Request<'_>) -> Result<Vec<f64>, PredictError>;

    /// The model that this one adds something to. What follows is that of this model unless it says otherwise.
    fn within(&self) -> Option<&dyn Forward> {
        None
    }

    /// Covariance of what [`Forward::predict`] says with the amplitudes `effects`, as (index in
    /// [`Forward::candidates`], q): of a model that is known from few runs of its own. `None` for one
    /// that is exact.
    fn own_covariance(&self, condition: usize, effects: &[(usize, f64)]) -> Option<DMatrix<f64>> {
        self.within()?.own_covariance(condition, effects)
    }

    /// Covariance of the numbers of one run, of a model that has runs of its own. `None` for one that is exact.
    fn spread_of_runs(&self, condition: usize) -> Option<&DMatrix<f64>> {
        self.within()?.spread_of_runs(condition)
    }

    /// Error (s) with which the stopping time of `condition` is weighted if it has a kink in the parameters, at which a fit
    /// would stop too early; `None` if it is smooth.
    fn stop_error(&self, condition: usize) -> Option<f64> {
        self.within()?.stop_error(condition)
    }

    /// Whether an error on held-out conditions decides here whether an effect is named; of a bed, impacts on fresh beds
    /// do so afterwards.
    fn is_judged_by_held_out(&self) -> bool {
        self.within().is_none_or(|model| model.is_judged_by_held_out())
    }

    /// Effects whose χ² falls by less than this behind the best are not told apart.
    fn separation(&self) -> f64 {
        self.within().map_or(SEPARATE, |model| model.separation())
    }

    /// How the observables differ from run to run, of a model that has runs of its own to tell it by: one column
    /// per independent way, of one standard deviation where runs scatter by as much as they are, so that a
    /// relative scatter multiplies them. `None` where [`Scatter`] says it.
    fn ways_of_scatter(&self, condition: usize) -> Option<&DMatrix<f64>> {
        self.within()?.ways_of_scatter(condition)
    }

    /// The model as one to which forces can be added by formulas; `None` for a model that is no force law.
    fn by_formulas(&self) -> Option<&dyn ByFormulas> {
        None
    }

    /// What bodies go through in the model; `None` of one that takes no [`Scatter::field`].
    fn passages(&self) -> Option<&dyn Passages> {
        Some(self.by_formulas()?)
    }
}

/// A model whose bodies a further force may act on, that of [`Scatter::field`].
pub trait Passages: Sync {
    /// What the body of `condition` goes through in the bed on the run that `at` asks for, about `n` moments of it, and
    /// what it would meet there by each of `others`; of the first part of a chain.
    fn passage(
        &self,
        condition: usize,
        at: &Request<'_>,
        others: &[Request<'_>],
        n: usize,
    ) -> Result<Vec<Moment>, PredictError>;
}

/// A force law to which forces can be added that no list has, by their formulas.
pub trait ByFormulas: Passages {
    /// The dimension in which formulas are written.
    fn space(&self) -> Space;

    /// The model with `drafts` as candidates behind its own; indices of its own stay.
    ///
    /// # Errors
    /// If a draft is not an effect.
    fn extended(&self, drafts: Vec<Draft>) -> Result<Box<dyn Forward + '_>, OwnEffectError>;
}

/// A body in the bed at one moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Moment {
    /// Time since contact (s).
    pub time: f64,
    /// Way forward along the surface (m).
    pub way: f64,
    /// Depth of its lowest point (m).
    pub depth: f64,
    /// Speed (m/s).
    pub speed: f64,
    /// Direction of the motion: forward along the surface, and out of the bed.
    pub direction: [f64; 2],
    /// ρ g A D (N): bulk density, gravity, area that drag and friction act on, and diameter.
    pub unit: f64,
    /// Force of the model against the motion (N).
    pub force: f64,
    /// Forces of other models in this state, against the motion and normal to it, out of the bed where the body sinks (N).
    pub others: Vec<[f64; 2]>,
}

/// The sense of the forward component of a direction of motion: none on a vertical fall.
pub(crate) fn sense(forward: f64) -> f64 {
    f64::from(i8::from(forward > 0.0) - i8::from(forward < 0.0))
}

/// Odds of 100 to 1, in χ²: as rare as an error that a verdict allows itself.
pub(crate) const SEPARATE: f64 = 9.2;

/// At a bound is what differs from it by less than this share of it.
const AT_BOUND: f64 = 1e-6;

/// Standard errors to either side that hold 95 % of a normal distribution.
pub(crate) const NORMAL_95: f64 = 1.96;

/// An amplitude that is farther than so many standard errors outside of its usual range is outside of it.
const OUTSIDE: f64 = 2.0;

/// Where a prediction is asked for.
#[derive(Clone, Copy, Debug)]
pub struct Request<'a> {
    /// β, in the order of [`Forward::parameters`].
    pub parameters: &'a [f64],
    /// Amplitudes of candidates, as (index in [`Forward::candidates`], q); others are absent.
    pub effects: &'a [(usize, f64)],
    /// What differs from run to run.
    pub scatter: &'a Scatter,
}

/// A free parameter of a model.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its path in the model file: `resistance.drag`.
    pub name: String,
    /// Unit for reports; empty if dimensionless.
    pub unit: String,
    /// Where a fit starts (SI).
    pub start: f64,
    /// Least allowed value (SI).
    pub min: f64,
    /// Greatest allowed value (SI).
    pub max: f64,
    /// What is known of it before the measurements, if anything is.
    pub prior: Option<Prior>,
    /// What it is of.
    pub kind: ParameterKind,
}

/// What is so small a share of its start tells nothing from zero.
const NOTHING: f64 = 1e-9;

impl Parameter {
    /// Whether it has no sign: its logarithm is searched, down to a share of its start.
    pub(crate) fn has_no_sign(&self) -> bool {
        self.min >= 0.0 && self.start > 0.0
    }

    /// The end of its range at which `value` is held, if it is. What is next to nothing stands for zero.
    pub(crate) fn bound_at(&self, value: f64) -> Option<Bound> {
        let nothing = self.min.max(NOTHING * self.start);
        let is_nothing = self.has_no_sign() && value <= nothing;
        if is_nothing { Some(Bound::Lower) } else { Bound::at(value, self.min, self.max) }
    }

    /// What is said of a `value` that was searched: the end of the range at which it is held.
    pub(crate) fn told(&self, value: f64) -> f64 {
        match self.bound_at(value) {
            Some(Bound::Lower) => self.min,
            _ => value,
        }
    }
}

/// What a parameter is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParameterKind {
    /// The model: a coefficient, an amplitude of an effect that it has.
    Model,
    /// The apparatus: an error that runs share.
    Apparatus,
    /// How the bed was prepared.
    Preparation,
    /// The form of effects that are added: by how much it differs from their formula ([`Bend`]).
    Form,
}

/// A normal distribution of what a number is before the measurements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prior {
    /// Its mean (SI).
    pub mean: f64,
    /// Its standard deviation (SI).
    pub sigma: f64,
}

/// What an effect takes beside its amplitude where that is not as listed, by key (SI).
pub type Form = Vec<(&'static str, f64)>;

/// An effect that could be added to a model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Candidate {
    /// kebab-case; that of an effect in several forms is the same for all.
    pub id: String,
    /// Its form: empty for the one that is listed, which comes before the others.
    pub form: Form,
    /// Unit of the amplitude; 1 where it has none.
    pub unit: String,
    /// Least allowed amplitude.
    pub min: f64,
    /// Greatest allowed amplitude.
    pub max: f64,
    /// Least and greatest amplitude that one would expect; `None` where nobody says it.
    pub usual: Option<[f64; 2]>,
    /// A small amplitude, for derivatives at zero.
    pub step: f64,
    /// Why these data cannot show it at all; `None` if they can.
    pub not_testable: Option<String>,
    /// What it takes to tell it from its confounders, in words; empty if it has none.
    pub separable_from: String,
    /// Ids of the candidates that these data cannot tell it from, because they lack what it takes; each
    /// of them has it likewise.
    pub unresolved: Vec<String>,
}

/// An end of the range of an amplitude.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Bound {
    /// The least allowed value: the data ask for it or less.
    Lower,
    /// The greatest allowed value: the data ask for it or more.
    Upper,
}

impl Bound {
    /// The end of the range from `min` to `max` at which `value` is held, if it is.
    pub(crate) fn at(value: f64, min: f64, max: f64) -> Option<Self> {
        let is_at = |bound: f64| (value - bound).abs() <= AT_BOUND * bound.abs();
        match (is_at(min), is_at(max)) {
            (true, _) => Some(Self::Lower),
            (_, true) => Some(Self::Upper),
            _ => None,
        }
    }
}

impl Candidate {
    /// The end of its range at which amplitude `q` is held, if it is.
    pub(crate) fn bound_at(&self, q: f64) -> Option<Bound> {
        Bound::at(q, self.min, self.max)
    }

    /// Least and greatest amplitude that an estimate `q` with standard error `se` allows, 95 %, within the range; `None`
    /// for an end that the range decides.
    pub fn interval_95(&self, q: f64, se: Option<f64>) -> [Option<f64>; 2] {
        let Some(se) = se else {
            return match self.bound_at(q) {
                Some(Bound::Upper) => [Some(q), None],
                Some(Bound::Lower) => [None, Some(q)],
                None => [None, None],
            };
        };
        let [least, greatest] = [q - NORMAL_95 * se, q + NORMAL_95 * se];
        [Some(least).filter(|end| *end > self.min), Some(greatest).filter(|end| *end < self.max)]
    }

    /// Whether amplitude `q` is outside of what one would expect, by more than two of its standard errors `se`; none
    /// count where none is known, as at a bound.
    pub(crate) fn is_unusual(&self, q: f64, se: Option<f64>) -> bool {
        let margin = OUTSIDE * se.unwrap_or(0.0);
        self.usual.is_some_and(|[least, greatest]| q + margin < least || q - margin > greatest)
    }
}

/// Inputs of a run that the model has no coefficient for, random ones and errors of the apparatus: all zero for the
/// run of the mean bed before an exact apparatus.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scatter {
    /// Logarithm of the factor on each scattering coefficient.
    pub coefficients: Vec<f64>,
    /// Relative deviation of the impact speed.
    pub speed: f64,
    /// By how much the impact is steeper (rad), beyond the vertical too where ways forward are measured.
    pub steeper: f64,
    /// Deviation of the level of the surface (m): positive when it lies lower than assumed.
    pub level: f64,
    /// How late the clock is zero (s): positive when contact is before it.
    pub clock: f64,
    /// Way forward (m) at contact.
    pub ahead: f64,
    /// How long after contact the body is where ways forward are zero (s).
    pub start: f64,
    /// Relative error of every length that is read.
    pub scale: f64,
    /// Relative deviation of the mass of the body from what is stated.
    pub mass: f64,
    /// Angle by which gravity leans forward (rad).
    pub tilt: f64,
    /// Relative deviation of the whole resistance at equally spaced nodes of depth, from the surface
    /// to [`Scatter::reach`], linear in between; empty for none.
    pub along: Vec<f64>,
    /// Force normal to the velocity, in units of the resistance, at nodes likewise; in the plane of
    /// motion, positive out of the bed.
    pub sideways: Vec<f64>,
    /// A force that the model lacks, on every run.
    pub field: Option<Arc<Field>>,
    /// Relative change of the strength of every effect of the request with depth, from the surface to the greatest of the
    /// set, and with speed, from rest to the greatest: an effect of the same kind and another form.
    pub bend: Bend,
    /// Depth of the last node (m); beyond it the last value holds.
    pub reach: f64,
}

impl Scatter {
    /// Whether this is the run of the mean bed.
    pub fn is_still(&self) -> bool {
        let Self {
            coefficients,
            speed,
            steeper,
            level,
            clock,
            ahead,
            start,
            scale,
            mass,
            tilt,
            along,
            sideways,
            field,
            ..
        } = self;
        let lists = coefficients.iter().chain(along).chain(sideways);
        let single = [speed, steeper, level, clock, ahead, start, scale, mass, tilt];
        let is_still = lists.chain(single).all(|value| *value == 0.0);
        is_still && field.is_none()
    }
}

/// A smooth relative change over depth and speed, in polynomials that are between −1 and 1: straight and curved over
/// depth, straight and curved over speed, and straight over both together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bend(pub [f64; Self::TERMS]);

impl Bend {
    /// How many polynomials there are.
    pub(crate) const TERMS: usize = 5;

    /// The factor at these shares of depth and of speed, from 0 to 1; beyond, that of the end.
    pub fn factor(&self, depth: f64, speed: f64) -> f64 {
        let [u, w] = [depth, speed].map(|share| 2.0 * share.clamp(0.0, 1.0) - 1.0);
        let curved = |x: f64| 2.0 * x * x - 1.0;
        let terms = [u, curved(u), w, curved(w), u * w];
        1.0 + self.0.iter().zip(terms).map(|(by, term)| by * term).sum::<f64>()
    }

    /// Its derivative by the share of depth.
    pub fn growth(&self, depth: f64, speed: f64) -> f64 {
        if !(0.0..1.0).contains(&depth) {
            return 0.0;
        }
        let [u, w] = [depth, speed].map(|share| 2.0 * share.clamp(0.0, 1.0) - 1.0);
        let Self([straight, curved, _, _, both]) = self;
        2.0 * (straight + 4.0 * curved * u + both * w)
    }
}

/// Why a model could not predict.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("the model cannot be integrated for the condition `{id}`: {why}")]
pub struct PredictError {
    /// Index of the condition.
    pub condition: usize,
    /// Its name in the set.
    pub id: String,
    /// What went wrong.
    pub why: String,
}
