//! Which physical effect a model lacks.
//!
//! The model is refitted with every effect in turn, and the fall of χ² is held against what noise does
//! to the best of so many (`p1`). What the data cannot tell apart is named together. Whatever is named
//! must leave no lack of fit and must predict conditions that were not fitted to.

use std::cell::OnceCell;

use crate::fit::fitted_parameters::parameters;
use crate::fit::problem::{FitError, FitProblem, Fitted};
use crate::forward::sensitivity::Point;
use crate::misfit::held_out::HeldOut;
use crate::misfit::lack_of_fit::lack_of_fit;
use crate::missing_force::{any_force, described};
use crate::noise::Noise;
use crate::ranking::marginal::{Marginals, marginals};
use crate::ranking::score::Ranking;
use crate::verdict::judge::{Grounds, Judge, adequate, cannot_tell, nothing, unexplained};
use crate::verdict::{ApparatusError, Diagnosis, Strength, Verdict};

pub use crate::verdict::judge::ALPHA;

/// How often weights and ranking are taken in turn: the weights are those along the best model.
const ROUNDS: usize = 2;

/// Diagnoses the model on `problem`; equal `seed` and measurements give equal bytes.
pub fn diagnose(problem: &FitProblem<'_>, seed: u64) -> Result<Diagnosis, FitError> {
    let mut diagnosis = verdict(problem, seed)?;
    // Of a bed it is sought once, when impacts have confirmed the verdict.
    let is_asked = diagnosis.verdict == Verdict::NoneOfTheCandidates;
    if is_asked && problem.forward.by_formulas().is_some() {
        seek_missing_force(problem, &mut diagnosis)?;
    }
    Ok(diagnosis)
}

/// The same without the missing force, whose search takes longer than all the rest.
pub(crate) fn verdict(problem: &FitProblem<'_>, seed: u64) -> Result<Diagnosis, FitError> {
    let baseline = match problem.fit(&Point::start(problem.forward)) {
        Ok(fitted) => fitted,
        Err(why @ (FitError::NoErrors | FitError::TooFew { .. })) => {
            return Ok(cannot_tell(problem, why.to_string()));
        }
        Err(other) => return Err(other),
    };
    let judge = match ranked_by(problem, &baseline, seed)? {
        Some(judge) if judge.leader_is_nil() => {
            // An effect of no amplitude improves nothing: its search has found the better fit of the model as it is.
            let better = problem.fit(&judge.leader.fit.without_effects().point)?;
            ranked_by(problem, &better, seed)?
        }
        other => other,
    };
    match judge {
        Some(judge) => judge.verdict(),
        None => Ok(cannot_tell(problem, "no effect can be tested with these data".to_owned())),
    }
}

/// All effects beside `baseline`; `None` where none can be tested.
fn ranked_by<'a>(
    problem: &'a FitProblem<'a>,
    baseline: &Fitted,
    seed: u64,
) -> Result<Option<Judge<'a>>, FitError> {
    let candidates: Vec<usize> = (0..problem.forward.candidates().len())
        .filter(|&index| problem.forward.candidates()[index].not_testable.is_none())
        .collect();
    let marginals = marginals(problem, baseline, &candidates, seed)?;
    let weighed = match marginals {
        Some(Marginals { between, .. }) => {
            problem.fit_once(&baseline.fit.point, &Noise { between, ..baseline.noise })?
        }
        None => baseline.clone(),
    };
    let rank = |weighed: &Fitted| match &marginals {
        Some(marginals) => Ranking::by_likelihood(problem, weighed, marginals, seed),
        None => Ranking::of(problem, weighed, &candidates, seed),
    };
    let settled = |mut weighed: Fitted| -> Result<Option<(Fitted, Ranking, Fitted)>, FitError> {
        let mut ranking = rank(&weighed);
        for _ in 1..ROUNDS {
            let leader = lead(problem, &mut ranking, &weighed, marginals.as_ref())?;
            let Some(leader) = leader else { break };
            let fit = problem.data(&leader.weights).fit(&baseline.fit.point)?;
            weighed = Fitted { fit, ..leader };
            ranking = rank(&weighed);
        }
        let leader = lead(problem, &mut ranking, &weighed, marginals.as_ref())?;
        Ok(leader.map(|leader| (weighed, ranking, leader)))
    };
    // A model that lacks a force across the motion takes it for angles that are off: effects are tried with angles as well
    // known as they are beforehand, and with exact ones.
    let exact = problem.with_angles_within(0.0, &weighed)?;
    let exact = exact.and_then(|exact| settled(exact).ok().flatten());
    let known =
        problem.with_angles_within(weighed.noise.angles.sigma, &weighed)?.unwrap_or(weighed);
    let both = settled(known)?.into_iter().chain(exact);
    let best = both.min_by(|(.., a), (.., b)| a.deviance().total_cmp(&b.deviance()));
    Ok(best.map(|(weighed, ranking, leader)| Judge {
        problem,
        seed,
        baseline: baseline.clone(),
        weighed,
        alike: ranking.not_separable(problem),
        ranking,
        leader,
        any_force: OnceCell::new(),
    }))
}

/// What there is to say of the model as it is, before any effect is looked for.
pub(crate) fn as_it_is(problem: &FitProblem<'_>, seed: u64) -> Result<Diagnosis, FitError> {
    let baseline = match problem.fit(&Point::start(problem.forward)) {
        Ok(fitted) => fitted,
        Err(why @ (FitError::NoErrors | FitError::TooFew { .. })) => {
            return Ok(cannot_tell(problem, why.to_string()));
        }
        Err(other) => return Err(other),
    };
    let ranking = Ranking::of(problem, &baseline, &[], seed);
    let (weighed, leader) = (baseline.clone(), baseline.clone());
    let (alike, any_force) = (Vec::new(), OnceCell::new());
    let judge = Judge { problem, seed, baseline, weighed, ranking, alike, leader, any_force };
    let p_lof = lack_of_fit(problem, &judge.baseline, seed)?;
    let verdict = match adequate(p_lof) {
        true => nothing(problem, &judge.baseline),
        false => Verdict::NoneOfTheCandidates,
    };
    judge.diagnosis(verdict, &judge.baseline, Grounds { p_lof, ..Grounds::default() })
}

/// The model with the best effect under its own noise; effects around whose fit the model cannot be
/// integrated are taken out on the way.
fn lead(
    problem: &FitProblem<'_>,
    ranking: &mut Ranking,
    weighed: &Fitted,
    marginals: Option<&Marginals>,
) -> Result<Option<Fitted>, FitError> {
    while let Some(best) = ranking.scores.first() {
        let noise =
            marginals.map_or(weighed.noise, |all| all.noise_with(&weighed.noise, best.candidate()));
        match problem.fit_once(&best.point, &noise) {
            Err(FitError::Predict(why)) => ranking.give_up_first(why),
            other => return other.map(Some),
        }
    }
    Ok(None)
}

/// Seeks the force that the model lacks where the verdict of `diagnosis` did not ask for it.
pub fn seek_missing_force(
    problem: &FitProblem<'_>,
    diagnosis: &mut Diagnosis,
) -> Result<(), FitError> {
    if let (Some(baseline), None) = (&diagnosis.baseline, &diagnosis.missing_force) {
        let best = diagnosis.log_odds_of_leader;
        let any = match diagnosis.any_force.take() {
            None => any_force(problem, baseline)?,
            known => known,
        };
        if let Some(any) = any {
            diagnosis.missing_force = described(problem, baseline, (any, best))?;
        }
    }
    Ok(())
}

/// Takes back what `diagnosis` names, since `why`: what is left is whether the model as it is explains the data.
pub(crate) fn withdraw(
    problem: &FitProblem<'_>,
    diagnosis: Diagnosis,
    why: String,
    seed: u64,
) -> Result<Diagnosis, FitError> {
    let Some(baseline) = &diagnosis.baseline else { return Ok(diagnosis) };
    let is_above = diagnosis.holdout.as_ref().and_then(HeldOut::is_above_noise);
    let is_small = is_above == Some(false);
    // What helps by more than chance, where the error is clear, is something, whether it can be named or not.
    let is_clear = is_above == Some(true) && diagnosis.p1.is_some_and(|p| p <= ALPHA);
    let verdict = match adequate(diagnosis.p_lof) {
        true if is_clear => Verdict::BelowNoise,
        true => nothing(problem, baseline),
        false if is_small => Verdict::BelowNoise,
        false => Verdict::NoneOfTheCandidates,
    };
    let mut strength_reasons = diagnosis.strength_reasons;
    strength_reasons.retain(|reason| reason.is_of_measurements());
    Ok(Diagnosis {
        verdict,
        strength: Strength::of(&strength_reasons),
        strength_reasons,
        unexplained: unexplained(problem, verdict, baseline, (why, seed))?,
        effects: Vec::new(),
        not_separable: Vec::new(),
        amplitudes: Vec::new(),
        amplitude_correlation: None,
        parameters: parameters(problem.forward, &baseline.fit),
        apparatus: ApparatusError::all(problem.forward, baseline),
        preparation: ApparatusError::of_preparation(problem.forward, &baseline.fit),
        noise: baseline.noise.to_json(problem.set, problem.forward),
        proposed: Some(baseline.clone()),
        ..diagnosis
    })
}
