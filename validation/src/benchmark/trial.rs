//! One world, measured and diagnosed blindly.

use std::time::Instant;

use configs::{ConfigError, LoadOptions, Model, ModelSource, find_shipped};
use diagnosis::diagnose::{diagnose, seek_missing_force};
use diagnosis::fit::problem::{DEFAULT_SEED, FitError, FitProblem, Fitted};
use diagnosis::forward::observable::Observable;
use diagnosis::forward::sensitivity::Point;
use diagnosis::misfit::held_out::HeldOut;
use diagnosis::missing_force::MissingForce;
use diagnosis::observed::Observed;
use diagnosis::ranking::pair::best_two;
use diagnosis::resistive::ResistiveForward;
use diagnosis::verdict::{Diagnosis, RankedEffect, Status, Verdict};
use measurements::MeasurementSet;
use nalgebra::DVector;
use resistive::find_resistance;
use serde::{Deserialize, Serialize};

use super::chance::Chance;
use super::laboratory::{Nature, measure, missing_force, resting_points};
use super::next::Resolved;
use super::path::WorldError;
use super::plan::{Plan, Row};
use super::strength::amplitude;

/// The model that every set is diagnosed with.
const BASELINE: &str = "two-term-vector";

/// A planned set with what came of it.
#[derive(Clone, Debug)]
pub struct Trial {
    /// What was hidden where.
    pub plan: Plan,
    /// What came of it.
    pub outcome: Outcome,
}

/// What came of a planned set.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum Outcome {
    /// The diagnosis.
    Answered(Box<Answer>),
    /// Why there is none that could be scored.
    Skipped(String),
}

/// What a diagnosis said, as far as it is scored.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// The verdict.
    pub verdict: Verdict,
    /// Probability that the best of all effects explains so much by chance.
    pub p1: Option<f64>,
    /// Of the lack of fit of the baseline.
    pub p_lof: Option<f64>,
    /// Of the lack of fit with the best effect, or with the pair.
    pub p_lof_with: Option<f64>,
    /// Ranked effects, best first.
    pub ranked: Vec<String>,
    /// Those that the set cannot show.
    pub refused: Vec<String>,
    /// Those that cannot be told from the first.
    pub leaders: Vec<String>,
    /// Those that the verdict names.
    pub named: Vec<String>,
    /// Predicted probability that the first is ranked first, were it there.
    pub predicted_first: Option<f64>,
    /// Amplitude of the first, with its standard error.
    pub amplitude: Option<(f64, f64)>,
    /// Amplitudes that were hidden, in the order of the plan.
    pub hidden: Vec<f64>,
    /// Root mean square error of the resting points of held-out conditions (m) against the mean bed of
    /// the world, without and with what is named; none where nothing is named.
    pub endpoint: Option<[f64; 2]>,
    /// Errors on held-out conditions without and with what is named, and noise of their means (m, or relative).
    pub held_out: Option<[Option<f64>; 3]>,
    /// Errors of the apparatus that are named.
    pub apparatus: Vec<String>,
    /// The pair that a search finds, whatever the verdict; none where it is not asked for.
    pub pair: Option<Vec<String>>,
    /// Whether more conditions leave the truth alone; none where that is not asked, or where the set does
    /// not leave several effects.
    pub resolved: Option<Resolved>,
    /// The force that is missing, where no listed effect explains the data.
    pub missing: Option<Missing>,
    /// The same, sought beside a verdict that did not ask for it.
    #[serde(default)]
    pub asked: Option<Missing>,
    /// Time that the diagnosis took (s).
    pub seconds: f64,
}

/// What a diagnosis said of the missing force.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Missing {
    /// The formula that it offers.
    pub formula: Option<String>,
    /// Error on held-out conditions without and with the formula, and noise of their means (m).
    pub held_out: Option<[Option<f64>; 3]>,
    /// Moments at which the true missing force lies within its 95 % band, and all.
    pub covered: [usize; 2],
    /// Logarithm of the odds of a missing force against none.
    pub log_odds: f64,
}

/// The model that every set is diagnosed with.
///
/// # Errors
/// If the shipped model does not load.
pub fn baseline() -> Result<Model, Box<ConfigError>> {
    let text = find_shipped(BASELINE).map_or("", |shipped| shipped.text).to_owned();
    let source = ModelSource::Text { name: BASELINE.to_owned(), text, folder: ".".into() };
    Model::load(source, &LoadOptions::default()).map(|loaded| loaded.model).map_err(Box::new)
}

/// Draws the world of `plan` and measures in it.
///
/// # Errors
/// If nothing in it is as strong as planned, or a sphere does not stop.
pub fn draw(plan: &Plan) -> Result<(Nature, MeasurementSet), WorldError> {
    let mut chance = Chance::new(plan.seed);
    let mut nature = Nature::drawn(&mut chance);
    for &hidden in &plan.hidden {
        let signs = hidden.form().signs;
        let sign = signs[chance.below(signs.len())];
        let q = amplitude(&plan.design, &nature, (hidden, sign), plan.strength)?;
        nature.hidden.push((hidden, q));
    }
    let set = measure(&plan.design, &nature, &mut chance)?;
    Ok((nature, set))
}

impl Trial {
    /// Draws the world of `plan`, measures in it, and has `model` diagnosed by the measurements.
    pub fn of(plan: Plan, model: &Model) -> Self {
        let unknown = plan
            .hidden
            .iter()
            .find(|hidden| hidden.is_listed() && find_resistance(hidden.id()).is_none());
        let outcome = match unknown {
            Some(hidden) => Err(format!("{} is no candidate", hidden.id())),
            None => draw(&plan)
                .map_err(|error| error.to_string())
                .and_then(|(nature, set)| answer(&plan, &nature, &set, model)),
        };
        let answered = |answer| Outcome::Answered(Box::new(answer));
        Self { plan, outcome: outcome.map_or_else(Outcome::Skipped, answered) }
    }

    /// Whether the effect `id` is hidden.
    pub fn hides(&self, id: &str) -> bool {
        self.plan.hidden.iter().any(|hidden| hidden.id() == id)
    }

    /// The answer, if there is one.
    pub fn answer(&self) -> Option<&Answer> {
        match &self.outcome {
            Outcome::Answered(answer) => Some(answer),
            Outcome::Skipped(_) => None,
        }
    }
}

fn answer(
    plan: &Plan,
    nature: &Nature,
    set: &MeasurementSet,
    model: &Model,
) -> Result<Answer, String> {
    let clock = Instant::now();
    let observed = Observed::of(set);
    let forward = ResistiveForward::new(model, set, &observed.layouts())
        .map_err(|error| error.to_string())?;
    let problem = FitProblem { set, observed: &observed, forward: &forward };
    let mut diagnosis = diagnose(&problem, DEFAULT_SEED).map_err(|error| error.to_string())?;
    let seconds = clock.elapsed().as_secs_f64();
    let pair = match plan.hidden.len() {
        2 => pair_found(&problem).map_err(|error| error.to_string())?,
        _ => None,
    };
    let resolved = match plan.row {
        Row::Next => Resolved::of(plan, nature, set, model)?,
        _ => None,
    };
    let rest = resting_points(&plan.design, nature).map_err(|error| error.to_string())?;
    let endpoint = endpoints(&problem, &diagnosis, &rest).map_err(|error| error.to_string())?;
    let missing = diagnosis.missing_force.as_ref().map(|force| Missing::of(force, plan, nature));
    let asked = match plan.row {
        Row::Beyond if missing.is_none() && is_unlisted(plan) => {
            seek_missing_force(&problem, &mut diagnosis).map_err(|error| error.to_string())?;
            diagnosis.missing_force.as_ref().map(|force| Missing::of(force, plan, nature))
        }
        _ => None,
    };
    let apart = Apart { pair, endpoint, resolved, missing, asked, seconds };
    Ok(Answer::new(diagnosis, nature, apart))
}

/// Whether something is hidden that no candidate is.
fn is_unlisted(plan: &Plan) -> bool {
    plan.hidden.iter().any(|hidden| !hidden.is_listed())
}

/// What is learned beside a diagnosis.
struct Apart {
    pair: Option<Vec<String>>,
    endpoint: Option<[f64; 2]>,
    resolved: Option<Resolved>,
    missing: Option<Missing>,
    asked: Option<Missing>,
    seconds: f64,
}

impl Missing {
    fn of(force: &MissingForce, plan: &Plan, nature: &Nature) -> Self {
        /// Standard deviations to either side that hold 95 % of a normal distribution.
        const NORMAL_95: f64 = 1.96;
        let within = force.readings.iter().filter(|one| {
            let truth = missing_force(&plan.design, nature, one);
            (one.force - truth).abs() <= NORMAL_95 * one.se
        });
        let errors = |one: &HeldOut| [one.before, one.after, one.noise_floor];
        Self {
            formula: force.formula.clone(),
            held_out: force.holdout.as_ref().map(errors),
            covered: [within.count(), force.readings.len()],
            log_odds: force.log_odds,
        }
    }
}

impl Answer {
    fn new(diagnosis: Diagnosis, nature: &Nature, apart: Apart) -> Self {
        let ids = |of: fn(&&RankedEffect) -> bool| {
            diagnosis.ranking.iter().filter(of).map(|effect| effect.id.clone()).collect()
        };
        let first = diagnosis.ranking.first().filter(|effect| effect.status == Status::Ranked);
        Self {
            verdict: diagnosis.verdict,
            p1: diagnosis.p1,
            p_lof: diagnosis.p_lof,
            p_lof_with: diagnosis.p_lof_with,
            ranked: ids(|effect| effect.status == Status::Ranked),
            refused: ids(|effect| effect.status != Status::Ranked),
            predicted_first: first.and_then(|effect| effect.predicted_top1),
            amplitude: first
                .and_then(|effect| effect.q.zip(effect.se))
                .filter(|(q, se)| q.is_finite() && se.is_finite()),
            hidden: nature.hidden.iter().map(|(_, q)| *q).collect(),
            held_out: diagnosis.holdout.map(|one| [one.before, one.after, one.noise_floor]),
            apparatus: diagnosis
                .apparatus
                .iter()
                .filter(|error| error.named)
                .map(|error| error.id.clone())
                .collect(),
            leaders: diagnosis.leaders,
            named: diagnosis.effects,
            endpoint: apart.endpoint,
            pair: apart.pair,
            resolved: apart.resolved,
            missing: apart.missing,
            asked: apart.asked,
            seconds: apart.seconds,
        }
    }
}

/// The two effects that a search for pairs ends with.
fn pair_found(problem: &FitProblem<'_>) -> Result<Option<Vec<String>>, FitError> {
    let baseline = problem.fit(&Point::start(problem.forward))?;
    let candidates = problem.forward.candidates();
    let testable: Vec<usize> =
        (0..candidates.len()).filter(|&at| candidates[at].not_testable.is_none()).collect();
    let pair = best_two(problem, &baseline, &testable, DEFAULT_SEED)?;
    Ok(pair.map(|pair| pair.iter().map(|&index| candidates[index].id.to_string()).collect()))
}

/// Errors of the resting points `rest` (m) of held-out conditions, without and with what is named.
fn endpoints(
    problem: &FitProblem<'_>,
    diagnosis: &Diagnosis,
    rest: &[[f64; 2]],
) -> Result<Option<[f64; 2]>, FitError> {
    let (Some(baseline), Some(proposed)) = (&diagnosis.baseline, &diagnosis.proposed) else {
        return Ok(None);
    };
    if diagnosis.verdict != Verdict::Supported {
        return Ok(None);
    }
    let error = |fitted: &Fitted| -> Result<f64, FitError> {
        let (mut square, mut n) = (0.0, 0.0);
        for &condition in &problem.observed.holdout {
            let predicted = fitted.fit.point.predict(problem.forward, condition)?;
            let [x, z] = rest[condition];
            square += distance_squared(problem, condition, &predicted, [x, z]);
            n += 1.0;
        }
        Ok((square / f64::max(n, 1.0)).sqrt())
    };
    Ok(Some([error(baseline)?, error(proposed)?]))
}

fn distance_squared(
    problem: &FitProblem<'_>,
    condition: usize,
    predicted: &DVector<f64>,
    [x, z]: [f64; 2],
) -> f64 {
    let kinds = problem.observed.conditions[condition].layout.kinds();
    let each = kinds.iter().zip(predicted.iter());
    each.map(|(kind, value)| match kind {
        Observable::FinalDepth => (value - z).powi(2),
        Observable::FinalRange => (value - x).powi(2),
        _ => 0.0,
    })
    .sum()
}
