//! How the unknowns of a fit are searched: which as they are, which by their logarithms.

use crate::forward::sensitivity::Point;
use crate::forward::{Candidate, Parameter};

/// Share of its start below which a parameter without a sign is searched as it is: a logarithm never comes to zero, and
/// from next to zero never back.
const LINEAR: f64 = 0.1;

/// Share of a parameter by which it is moved for a derivative.
const STEP: f64 = 1e-3;

/// Share of the standard deviation of a prior around zero, likewise: above what rounding does to differences.
const OF_PRIOR: f64 = 0.05;

/// How an unknown is searched.
pub(crate) struct Scale {
    /// Size below which one without a sign is searched as it is, above by its logarithm; none for what has a sign.
    linear: Option<f64>,
    pub(crate) min: f64,
    pub(crate) max: f64,
    step: f64,
}

impl Scale {
    /// Of a parameter of a model.
    pub(super) fn of_parameter(parameter: &Parameter) -> Self {
        Self {
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
        }
    }

    /// Of the amplitude of an effect.
    pub(super) fn of_amplitude(candidate: &Candidate) -> Self {
        let Candidate { min, max, step, .. } = *candidate;
        Self { linear: None, min, max, step: 0.1 * step }
    }

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

    pub(super) fn contains(&self, unknown: f64) -> bool {
        (self.unknown(self.min)..=self.unknown(self.max)).contains(&unknown)
    }

    /// By how much an unknown of this value is moved in earnest, to weigh derivatives by.
    pub(super) fn reach(&self, value: f64) -> f64 {
        if self.linear.is_some() { self.slope(value) } else { self.step / STEP }
    }

    pub(super) fn unknown_step(&self) -> f64 {
        if self.linear.is_some() { STEP } else { self.step }
    }

    pub(super) fn physical_step(&self, value: f64) -> f64 {
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
