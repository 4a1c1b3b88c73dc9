//! Amplitudes of the effects that a verdict names.

use crate::fit::Fit;
use crate::fit::problem::{FitError, FitProblem, Fitted};
use crate::forward::ParameterKind;
use crate::verdict::Amplitude;
use crate::verdict::added_force::{AddedForce, added_forces};

/// Fall of χ² from which the data ask for another form than the listed one: once in a hundred by chance, where its five numbers
/// are free.
const FORM: f64 = 15.1;

/// The amplitudes of the effects of `fit`, with the forces that they are.
pub(super) fn amplitudes(problem: &FitProblem<'_>, fit: &Fit) -> Vec<Amplitude> {
    let forces = added_forces(problem, fit);
    let effects = fit.point.effects.iter().enumerate().zip(forces);
    let one = |((at, &(index, q)), force): ((usize, &(usize, f64)), Option<AddedForce>)| {
        let se = fit.standard_error(fit.point.parameters.len() + at);
        let candidate = &problem.forward.candidates()[index];
        Amplitude {
            id: candidate.id.clone(),
            form: candidate.form.iter().copied().collect(),
            q,
            se,
            at_bound: candidate.bound_at(q),
            interval_95: candidate.interval_95(q, se),
            unusual: candidate.is_unusual(q, se),
            force,
        }
    };
    effects.map(one).collect()
}

/// Of the amplitudes of a pair.
pub(super) fn correlation(fit: &Fit) -> Option<f64> {
    let first = fit.point.parameters.len();
    if fit.point.effects.len() != 2 {
        return None;
    }
    let (a, b) = (fit.standard_error(first)?, fit.standard_error(first + 1)?);
    Some(fit.covariance[(first, first + 1)] / (a * b)).filter(|c| c.is_finite())
}

/// `proposed` with effects of exactly the form that is listed, as a model has them, if the data ask for no other one; else as
/// it is. Beside a form that nothing fixes, an amplitude is one of many that give the same force where there are data.
pub(super) fn as_listed(problem: &FitProblem<'_>, proposed: &Fitted) -> Result<Fit, FitError> {
    if proposed.fit.point.effects.is_empty() {
        return Ok(proposed.fit.clone());
    }
    let parameters = problem.forward.parameters();
    let mut start = proposed.fit.point.clone();
    let of_forms = start.parameters.iter_mut().zip(parameters);
    let forms = of_forms.filter(|(_, one)| one.kind == ParameterKind::Form);
    if forms.map(|(value, one)| *value = one.start).count() == 0 {
        return Ok(proposed.fit.clone());
    }
    let listed = problem.data(&proposed.weights).fit_as_listed(&start)?;
    let is_asked_for = listed.chi2 - proposed.fit.chi2 > FORM;
    Ok(if is_asked_for { proposed.fit.clone() } else { listed })
}
