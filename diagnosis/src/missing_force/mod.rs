//! The force that a model lacks where no listed effect explains what was measured: as a function of what the body went
//! through, with a band; and a formula for it that predicts, where one does.
//!
//! The force is a Gaussian process over depth, speed and impact angle, seen through the linear answer of the measurements
//! to a force around each node of a grid; parameters of the model and errors of the apparatus are projected out. It acts
//! against the motion; on oblique impacts also normal to it, where that is clearly more likely. A
//! formula is chosen from a library of dimensionless forms by what it explains in the space of the
//! measurements, refitted as a part of the model, and kept where it takes a quarter of a clear error on conditions that
//! were not fitted to. It fits and predicts; it does not explain.

mod apart;
mod formula;
mod found;
mod library;
mod process;
mod response;
mod table;
mod term;
mod with_field;

use std::sync::Arc;

use serde::Serialize;
use serde_json::{Map, Value};

pub use self::formula::{FOUND, Formula};
pub use self::table::{Component, Reading, table};

use self::formula::Search;
use self::found::Found;
use self::term::State;
use self::with_field::WithField;
use crate::fit::fitted_parameters::parameters;
use crate::fit::problem::{FitError, FitProblem, Fitted};
use crate::forward::field::Field;
use crate::forward::{ByFormulas, Moment, Passages};
use crate::misfit::held_out::HeldOut;
use crate::noise::between::Between;
use crate::rounding::{six_digits, six_digits_or_null};

/// The file with the force along the paths.
pub const FILE: &str = "missing_force.csv";

/// Misfit, in units of the noise, from which a force is looked for once more around the best formula, and how often.
const FAR: f64 = 1.5;
const AGAIN: usize = 3;

/// Number of noises under which the search is completed: those with the best evidence after its first step.
const SETTLED: usize = 2;

/// Impacts less steep than this (degrees) tell of a force normal to the motion.
const OBLIQUE: f64 = 80.0;

/// Logarithm of the odds by which a force normal to the motion too has to be more likely than one against it alone: 20 to 1.
const CLEARLY: f64 = 3.0;

/// Parts of the depth over which the force is summed up in words.
const PARTS: usize = 10;

/// What a model lacks.
#[derive(Clone, Debug, Serialize)]
pub struct MissingForce {
    /// The table with the force and its band.
    pub file: &'static str,
    /// The force as a formula, `q` being its amplitude; none where no formula predicts.
    pub formula: Option<String>,
    /// `friction` or `drag`, as a model file writes it.
    pub kind: Option<&'static str>,
    /// The amplitude.
    #[serde(serialize_with = "six_digits_or_null")]
    pub q: Option<f64>,
    /// Its standard error.
    #[serde(serialize_with = "six_digits_or_null")]
    pub se: Option<f64>,
    /// What the force looks like.
    pub words: String,
    /// Errors on held-out conditions without and with the formula.
    pub holdout: Option<HeldOut>,
    /// Logarithm of the odds of some force against none.
    #[serde(serialize_with = "six_digits")]
    pub log_odds: f64,
    /// Likewise of the best listed effect.
    #[serde(serialize_with = "six_digits_or_null")]
    pub log_odds_of_best_effect: Option<f64>,
    /// Parameters of the model with the formula, with their units.
    #[serde(skip_serializing_if = "Map::is_empty")]
    pub parameters: Map<String, Value>,
    /// Whether a formula was looked for: beds of grains take none.
    pub formula_sought: bool,
    /// The table of the formula for a model file.
    pub candidate: Option<String>,
    /// The force along the paths.
    #[serde(skip)]
    pub readings: Vec<Reading>,
    /// The model with the formula, fitted.
    #[serde(skip)]
    pub fitted: Option<Fitted>,
}

/// What `baseline` lacks; `best` are the log odds of the best listed effect against none. `None` of models that take no force
/// beside their own, and where nothing can be told: the verdict does not need it.
///
/// # Errors
/// If predictions do not have the layout of the measurements.
pub fn missing_force(
    problem: &FitProblem<'_>,
    baseline: &Fitted,
    best: Option<f64>,
) -> Result<Option<MissingForce>, FitError> {
    let any = any_force(problem, baseline)?;
    any.map_or(Ok(None), |any| described(problem, baseline, (any, best)))
}

/// A force of any form on the bodies of a model, and the noise under which it is most likely.
#[derive(Clone, Debug)]
pub(crate) struct AnyForce {
    under: Fitted,
    found: Found,
}

impl AnyForce {
    /// Logarithm of the odds of it against none in the model of `baseline`.
    pub(crate) fn log_odds(&self, baseline: &Fitted) -> f64 {
        self.found.evidence(&self.under) + 0.5 * baseline.deviance()
    }
}

/// The most likely force of any form on the bodies of the model of `baseline`; `None` of models that take no force beside
/// their own, and where nothing can be told.
///
/// # Errors
/// If predictions do not have the layout of the measurements.
pub(crate) fn any_force(
    problem: &FitProblem<'_>,
    baseline: &Fitted,
) -> Result<Option<AnyForce>, FitError> {
    let Some(through) = problem.forward.passages() else { return Ok(None) };
    if_told(most_likely(problem, through, baseline))
}

/// What `any` force is, in a formula and in words; `best` are the log odds of the best listed effect against none.
///
/// # Errors
/// If predictions do not have the layout of the measurements.
pub(crate) fn described(
    problem: &FitProblem<'_>,
    baseline: &Fitted,
    (any, best): (AnyForce, Option<f64>),
) -> Result<Option<MissingForce>, FitError> {
    if_told(with_band(problem, baseline, (any, best)))
}

fn with_band(
    problem: &FitProblem<'_>,
    baseline: &Fitted,
    (any, best): (AnyForce, Option<f64>),
) -> Result<Option<MissingForce>, FitError> {
    let Some(through) = problem.forward.passages() else { return Ok(None) };
    let AnyForce { under, found } = any;
    let (found, formula) = match problem.forward.by_formulas() {
        Some(by) => with_formula(problem, by, baseline, (&under, found))?,
        None => (found, None),
    };
    let any = AnyForce { under, found };
    let AnyForce { under, found } = &any;
    let readings = table::readings(problem, through, (found, baseline), under.noise.sessions.sd)?;
    let band = in_words(&readings);
    Ok(Some(MissingForce {
        file: FILE,
        words: match &formula {
            Some(formula) => format!("{}; {band}", formula.words),
            None => band,
        },
        kind: formula.as_ref().map(|one| one.kind),
        q: formula.as_ref().map(Formula::amplitude),
        se: formula
            .as_ref()
            .and_then(|one| one.fitted.fit.standard_error(one.fitted.fit.point.parameters.len())),
        holdout: formula.as_ref().map(|one| one.holdout.clone()),
        log_odds: any.log_odds(baseline),
        log_odds_of_best_effect: best,
        parameters: formula
            .as_ref()
            .map_or_else(Map::new, |one| parameters(problem.forward, &one.fitted.fit)),
        formula_sought: problem.forward.by_formulas().is_some(),
        candidate: formula.as_ref().map(Formula::table),
        formula: formula.as_ref().map(|one| one.force.clone()),
        fitted: formula.map(|one| one.fitted),
        readings,
    }))
}

/// What is `found`; none if the model fails.
fn if_told<T>(found: Result<Option<T>, FitError>) -> Result<Option<T>, FitError> {
    match found {
        Err(FitError::Predict(_) | FitError::Singular { .. }) => Ok(None),
        other => other,
    }
}

/// The best formula for the force that was `found` under the noise of `under`, and the force around it, where that is
/// more likely.
fn with_formula(
    problem: &FitProblem<'_>,
    by: &dyn ByFormulas,
    baseline: &Fitted,
    (under, mut found): (&Fitted, Found),
) -> Result<(Found, Option<Formula>), FitError> {
    let look = |found: &Found| {
        let states = states(problem, &found.passages);
        let near = &found.fit.point.parameters;
        let search = Search {
            problem,
            by,
            baseline: under,
            near,
            response: &found.response,
            states: &states,
        };
        search.refitted()
    };
    let mut refitted = look(&found);
    for _ in 0..AGAIN {
        // Answers far from the force that is there mislead: once more around the best formula.
        if found.misfit() <= FAR {
            break;
        }
        let grid = &found.field.grid;
        let Some((best, field)) =
            refitted.iter().find_map(|one| Some((one, one.field(problem, grid)?)))
        else {
            break;
        };
        let with = WithField { forward: problem.forward, field: Arc::new(field.clone()) };
        let with = FitProblem { forward: &with, ..*problem };
        let Ok(fit) = with.data(&under.weights).fit_as_listed(&best.point()) else { break };
        let Some(next) = Found::from(problem, by, (under, fit), field)? else { break };
        if next.fit.chi2 >= found.fit.chi2 {
            break;
        }
        found = next;
        refitted.extend(look(&found));
        refitted.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
    }
    Ok((found, Formula::kept(problem, by, baseline, refitted)?))
}

/// Whether a force of some form exceeds none by `least` log odds or more in the model of `fitted`, as the first step of the search
/// for it sees it, along the motion.
///
/// # Errors
/// If predictions do not have the layout of the measurements.
pub(crate) fn is_a_force_left(
    problem: &FitProblem<'_>,
    fitted: &Fitted,
    least: f64,
) -> Result<bool, FitError> {
    let Some(by) = problem.forward.passages() else { return Ok(false) };
    let is_clear =
        |(under, found): &(Fitted, Found)| found.evidence(under) + 0.5 * fitted.deviance() >= least;
    let first = if_told(look(problem, by, fitted.clone(), false))?;
    Ok(first.as_ref().is_some_and(is_clear)
        || with_less_scatter(problem, by, fitted).any(|one| is_clear(&one)))
}

/// The first step of the search for a force, with the model fitted under the noise of `under`.
fn look(
    problem: &FitProblem<'_>,
    by: &dyn Passages,
    under: Fitted,
    is_sideways: bool,
) -> Result<Option<(Fitted, Found)>, FitError> {
    let grid = response::grid(problem, is_sideways);
    let nothing = Field { values: vec![0.0; grid.len()], grid };
    let found = Found::around(problem, by, (&under, under.fit.clone()), nothing)?;
    Ok(found.map(|found| (under, found)))
}

/// The same under less and less of the scatter between conditions of `baseline`. A noise under which the model cannot be fitted
/// is left out.
fn with_less_scatter(
    problem: &FitProblem<'_>,
    by: &dyn Passages,
    baseline: &Fitted,
) -> impl Iterator<Item = (Fitted, Found)> {
    let Between { sd, sigma, .. } = baseline.noise.sessions;
    // In steps of one ratio from what the fit takes for scatter to what is known of it beforehand, then none.
    let steps = [libm::cbrt(sigma * sd * sd), libm::cbrt(sigma * sigma * sd), sigma, 0.0];
    steps.into_iter().filter(move |less| *less < sd).filter_map(move |less| {
        let under = problem.with_scatter_between_conditions(less, baseline).ok()?;
        look(problem, by, under, false).ok().flatten()
    })
}

/// The most likely force, with the model fitted under its noise. A model that lacks a force takes it for scatter between
/// conditions, so the noise of `baseline` is tried with less of that scatter too.
fn most_likely(
    problem: &FitProblem<'_>,
    by: &dyn Passages,
    baseline: &Fitted,
) -> Result<Option<AnyForce>, FitError> {
    let Some(first) = look(problem, by, baseline.clone(), false)? else { return Ok(None) };
    let mut begun = vec![first];
    begun.extend(with_less_scatter(problem, by, baseline));
    let evidence = |(under, found): &(Fitted, Found)| {
        let of_more = if found.field.grid.is_sideways { CLEARLY } else { 0.0 };
        found.evidence(under) - of_more
    };
    begun.sort_by(|a, b| evidence(b).total_cmp(&evidence(a)));
    begun.truncate(SETTLED);
    let is_oblique = |&condition: &usize| problem.set.conditions[condition].angle_deg < OBLIQUE;
    if problem.observed.fit.iter().any(is_oblique) {
        let best = evidence(&begun[0]);
        let both = look(problem, by, begun[0].0.clone(), true)?;
        begun.extend(both.filter(|both| evidence(both) > best));
    }
    let mut settled = Vec::with_capacity(begun.len());
    for (under, found) in begun {
        let found = found.settled(problem, by, &under)?;
        settled.push((under, found));
    }
    let best = settled.into_iter().max_by(|a, b| evidence(a).total_cmp(&evidence(b)));
    Ok(best.map(|(under, found)| AnyForce { under, found }))
}

/// What the bodies go through.
fn states(problem: &FitProblem<'_>, passages: &[Vec<Moment>]) -> Vec<State> {
    let each = problem.observed.fit.iter().zip(passages);
    each.flat_map(|(&condition, moments)| {
        let body = &problem.set.conditions[condition];
        let gravity = problem.set.bed_of(body).gravity;
        let (angle, diameter) = (body.angle_deg.to_radians(), body.diameter);
        let impact_speed = body.speed;
        moments.iter().map(move |one| {
            let (depth, speed) = (one.depth, one.speed);
            State { depth, speed, impact_speed, angle, diameter, gravity }
        })
    })
    .collect()
}

/// Where the bands leave out zero, in words.
fn in_words(readings: &[Reading]) -> String {
    let against = against_in_words(readings);
    let clearest = |of: fn(&Reading) -> Option<Component>| {
        let all = readings.iter().filter_map(|one| Some((one, of(one)?)));
        let clear = all.filter(|(_, part)| part.is_clear());
        clear.max_by(|a, b| a.1.clarity().total_cmp(&b.1.clarity()))
    };
    let told = |name: &str, (at, part): (&Reading, Component)| {
        format!(
            "; {name} it is clearest at {:.0} mm and {:.2} m/s: {:+.3} \u{b1} {:.3} N",
            1e3 * at.depth,
            at.speed,
            part.force,
            part.se
        )
    };
    let sideways = clearest(|one| one.sideways);
    let normal = sideways.map(|one| told("normal to the motion", one)).unwrap_or_default();
    let forward = match sideways {
        // Against the motion alone, the horizontal part says nothing new.
        None => String::new(),
        Some(_) => clearest(|one| Some(one.horizontal))
            .map(|one| told("along the surface", one))
            .unwrap_or_default(),
    };
    format!("{against}{normal}{forward}")
}

/// Where the band of the force against the motion leaves out zero, in a sentence.
fn against_in_words(readings: &[Reading]) -> String {
    let reach = readings.iter().map(|one| one.depth).fold(0.0, f64::max);
    let clearest = (0..PARTS).filter_map(|part| {
        let inside = |one: &&Reading| {
            let share = PARTS as f64 * one.depth / reach;
            (part as f64..part as f64 + 1.0).contains(&share) && one.is_clear()
        };
        readings.iter().filter(inside).max_by(|a, b| a.clarity().total_cmp(&b.clarity()))
    });
    let clearest: Vec<&Reading> = clearest.collect();
    if clearest.is_empty() {
        return "its band holds zero at every depth: these data show that a force is missing, not where".to_owned();
    }
    let ends = clearest.iter().fold((f64::INFINITY, 0.0_f64), |(least, most), one| {
        (least.min(one.depth), most.max(one.depth))
    });
    let Some(best) = clearest.iter().max_by(|a, b| a.clarity().total_cmp(&b.clarity())) else {
        return String::new();
    };
    // Where a body comes to rest, the model may have no force.
    let share = 100.0 * best.force / best.model;
    let share = match share.abs() < 1e3 {
        true => format!("{share:+.0} % of the model's"),
        false => format!("where the model has {:.3} N", best.model),
    };
    format!(
        "the missing force is clear of zero from {:.0} to {:.0} mm deep, and clearest at {:.0} mm and {:.2} m/s: \
         {:+.3} \u{b1} {:.3} N, {share}",
        1e3 * ends.0,
        1e3 * ends.1,
        1e3 * best.depth,
        best.speed,
        best.force,
        best.se
    )
}
