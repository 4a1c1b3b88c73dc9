//! How often verdicts are right for sets of one design: sets are simulated, diagnosed and counted.
//!
//! Each simulated set has the conditions, repeats and noise of the measured one, and errors of the apparatus and forms
//! of effects drawn from their priors. What is missing in it is nothing, one effect, or a force outside the list. The
//! noise is the one that the fit assumes, so the counts are optimistic.

use std::collections::BTreeMap;

use nalgebra::{Cholesky, DMatrix, DVector};
use rand::RngExt;
use rand_pcg::Pcg64;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::diagnose::verdict;
use crate::fit::problem::{FitError, FitProblem, Fitted};
use crate::forward::sensitivity::Point;
use crate::forward::{ParameterKind, Scatter};
use crate::observed::{Observed, ObservedCondition};
use crate::random::{Purpose, normal, stream};
use crate::verdict::{Counted, Diagnosis, Probability, Status, Verdict};

/// How many sets are simulated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// Sets in which nothing is missing, and as many in which something is that no list has.
    pub others: usize,
    /// Sets in which effects are missing; every effect that these data can show is in as many as any other, in one at
    /// least.
    pub listed: usize,
}

impl Default for Size {
    /// About forty sets: three minutes on two cores for 16 conditions.
    fn default() -> Self {
        Self { others: 8, listed: 20 }
    }
}

/// Least amplitude of a simulated effect, in detection limits; half of the usual maximum, where that is more.
const LIMITS: f64 = 2.0;

/// Greatest relative change of the resistance over depth by a force outside the list.
const UNLISTED: f64 = 0.6;

/// Nodes of depth between which that change is linear.
const NODES: usize = 12;

/// Most draws of a set with which the model cannot be integrated.
const DRAWS: i32 = 3;

/// What is true in a simulated set.
#[derive(Clone, Debug, PartialEq)]
enum Truth {
    Nothing,
    Unlisted,
    /// Index of the candidate, and its amplitude.
    Effect(usize, f64),
}

impl Truth {
    /// The same with an effect of half the size, so many times over.
    fn weakened(&self, halvings: i32) -> Self {
        match *self {
            Self::Effect(index, q) => Self::Effect(index, q * libm::ldexp(1.0, -halvings)),
            _ => self.clone(),
        }
    }
}

/// A simulated set and what was said of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Simulated {
    /// `nothing`, `unlisted` or the effect that is missing.
    pub truth: String,
    /// What is said.
    pub verdict: Verdict,
    /// What is named, alone, as a pair or as a set.
    pub named: Vec<String>,
    /// Whether the 95 % interval of the amplitude holds the true one; none where the truth is not named alone.
    pub covered: Option<bool>,
}

/// The simulated sets and their verdicts.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Calibration {
    /// One entry per set.
    pub sets: Vec<Simulated>,
}

/// Sets with one truth, and how many of them had each end.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// `nothing`, `unlisted` or the effect.
    pub truth: String,
    /// How many sets.
    pub sets: usize,
    /// The truth is named alone.
    pub alone: usize,
    /// The truth is named among others.
    pub among: usize,
    /// Something else is named.
    pub wrong: usize,
    /// Nothing is named, by verdict.
    pub unnamed: BTreeMap<String, usize>,
    /// Of those named alone, how many 95 % intervals hold the true amplitude.
    pub covered: usize,
}

/// Simulates sets like that of `problem`, which `diagnosis` is of, and diagnoses them; equal seeds give equal numbers.
///
/// # Errors
/// If the model fails, or `diagnosis` has no fit.
pub fn calibrate(
    problem: &FitProblem<'_>,
    diagnosis: &Diagnosis,
    size: Size,
    seed: u64,
) -> Result<Calibration, FitError> {
    let Some(baseline) = &diagnosis.baseline else { return Err(FitError::NoErrors) };
    let noise = problem
        .observed
        .conditions
        .iter()
        .enumerate()
        .map(|(at, condition)| RunNoise::of(problem, baseline, (at, condition)))
        .collect::<Result<Vec<_>, _>>()?;
    let truths = truths(problem, diagnosis, size);
    let sets = truths
        .par_iter()
        .enumerate()
        .map(|(number, truth)| {
            let mut random = stream(seed, Purpose::Simulation, number);
            // A draw of the apparatus with which the model cannot be integrated is drawn again, with half the effect: a body
            // that floats and drifts never comes to rest.
            for halvings in 0..DRAWS {
                let truth = &truth.weakened(halvings);
                let Some(observed) = simulate(problem, baseline, (&noise, truth), &mut random)
                else {
                    continue;
                };
                let simulated = FitProblem { observed: &observed, ..*problem };
                match verdict(&simulated, seed) {
                    Ok(said) => return Ok(Some(judged(problem, truth, &said))),
                    Err(FitError::Predict(_)) => (),
                    Err(other) => return Err(other),
                }
            }
            Ok(None)
        })
        .collect::<Result<Vec<_>, FitError>>()?;
    Ok(Calibration { sets: sets.into_iter().flatten().collect() })
}

/// What is to be true in each set.
fn truths(problem: &FitProblem<'_>, diagnosis: &Diagnosis, size: Size) -> Vec<Truth> {
    let candidates = problem.forward.candidates();
    let effects: Vec<Truth> = diagnosis
        .ranking
        .iter()
        .filter(|effect| effect.status == Status::Ranked)
        .filter_map(|effect| {
            let index = candidates.iter().position(|one| one.id == effect.id)?;
            let candidate = &candidates[index];
            let usual = candidate.usual.map_or(0.0, |[_, most]| 0.5 * most);
            let size = (LIMITS * effect.detection_limit?).max(usual);
            let up = size.min(candidate.max);
            let q = if up > 0.0 { up } else { (-size).max(candidate.min) };
            Some(Truth::Effect(index, q))
        })
        .collect();
    let each = size.listed.div_ceil(effects.len().max(1));
    let listed =
        (0..each).flat_map(|_| effects.iter().cloned()).take(size.listed.max(effects.len()));
    let others = (0..size.others).flat_map(|_| [Truth::Nothing, Truth::Unlisted]);
    others.chain(listed).collect()
}

/// How the runs of a condition differ from the run of the mean bed.
struct RunNoise {
    /// Cholesky factor of their covariance.
    factor: DMatrix<f64>,
    /// Of their mean.
    shift: DVector<f64>,
}

impl RunNoise {
    fn of(
        problem: &FitProblem<'_>,
        fitted: &Fitted,
        (at, condition): (usize, &ObservedCondition),
    ) -> Result<Self, FitError> {
        if condition.layout.is_empty() {
            return Ok(Self { factor: DMatrix::zeros(0, 0), shift: DVector::zeros(0) });
        }
        let sensitivity = problem.sensitivity(&fitted.fit.point, at)?;
        let covariance = fitted.noise.covariance(condition, &sensitivity);
        let factor = Cholesky::new(covariance)
            .ok_or_else(|| FitError::Singular { id: condition.id.clone() })?
            .l();
        Ok(Self { factor, shift: sensitivity.shift_of_mean(&fitted.noise.spread) })
    }
}

/// Runs of every condition in which `truth` holds; `None` where the model cannot be integrated with it.
fn simulate(
    problem: &FitProblem<'_>,
    baseline: &Fitted,
    (noise, truth): (&[RunNoise], &Truth),
    random: &mut Pcg64,
) -> Option<Observed> {
    let mut point = Point { effects: Vec::new(), ..baseline.fit.point.clone() };
    for (value, parameter) in point.parameters.iter_mut().zip(problem.forward.parameters()) {
        if let Some(prior) = parameter.prior.filter(|_| parameter.kind != ParameterKind::Model) {
            let drawn = prior.mean + prior.sigma * normal(random);
            *value = drawn.clamp(parameter.min, parameter.max);
        }
    }
    if let Truth::Effect(index, q) = *truth {
        point.effects.push((index, q));
    }
    let mut observed = problem.observed.clone();
    let reach = observed.conditions.iter().fold(0.0, |reach, one| f64::max(reach, one.reach));
    let along = match truth {
        Truth::Unlisted => unlisted(random),
        _ => Vec::new(),
    };
    let coefficients = vec![0.0; problem.forward.n_scattering_coefficients()];
    let scatter = Scatter { coefficients, along, reach, ..Scatter::default() };
    for (at, (condition, noise)) in observed.conditions.iter_mut().zip(noise).enumerate() {
        if condition.layout.is_empty() {
            continue;
        }
        let mean = point.predict_run(problem.forward, at, &scatter).ok()? + &noise.shift;
        for run in &mut condition.runs {
            let white = DVector::from_fn(mean.len(), |_, _| normal(random));
            *run = &mean + &noise.factor * white;
        }
        let sum = condition.runs.iter().fold(&mean * 0.0, |sum, run| sum + run);
        condition.mean = sum / condition.runs.len() as f64;
    }
    Some(observed)
}

/// A relative change of the resistance over depth: a wave of random length and phase, which no listed effect has.
fn unlisted(random: &mut Pcg64) -> Vec<f64> {
    let [waves, phase] = [random.random_range(1.0..3.0), random.random_range(0.0..1.0)];
    let size = random.random_range(0.5 * UNLISTED..UNLISTED);
    let wave = |node: usize| {
        let share = node as f64 / (NODES - 1) as f64;
        size * libm::sin(std::f64::consts::TAU * (waves * share + phase))
    };
    (0..NODES).map(wave).collect()
}

fn judged(problem: &FitProblem<'_>, truth: &Truth, said: &Diagnosis) -> Simulated {
    let named = match said.verdict {
        Verdict::NotSeparable => said.not_separable.clone(),
        _ => said.effects.clone(),
    };
    let (name, covered) = match truth {
        Truth::Nothing => ("nothing".to_owned(), None),
        Truth::Unlisted => ("unlisted".to_owned(), None),
        Truth::Effect(index, q) => {
            let id = problem.forward.candidates()[*index].id.clone();
            let alone = said.amplitudes.iter().find(|one| one.id == id && named.len() == 1);
            let holds = |[least, most]: [Option<f64>; 2]| {
                least.is_none_or(|least| least <= *q) && most.is_none_or(|most| *q <= most)
            };
            (id, alone.map(|amplitude| holds(amplitude.interval_95)))
        }
    };
    Simulated { truth: name, verdict: said.verdict, named, covered }
}

impl Simulated {
    fn is_right(&self) -> bool {
        self.named.contains(&self.truth)
    }
}

impl Calibration {
    /// Sets by their truth: nothing and unlisted first.
    pub fn rows(&self) -> Vec<Row> {
        let mut truths: Vec<&str> = vec!["nothing", "unlisted"];
        for set in &self.sets {
            if !truths.contains(&set.truth.as_str()) {
                truths.push(&set.truth);
            }
        }
        let of = |truth: &str| {
            let sets: Vec<&Simulated> = self.sets.iter().filter(|set| set.truth == truth).collect();
            let count = |is: &dyn Fn(&Simulated) -> bool| sets.iter().filter(|set| is(set)).count();
            let mut unnamed = BTreeMap::new();
            for set in sets.iter().filter(|set| set.named.is_empty()) {
                *unnamed.entry(name_of(set.verdict)).or_default() += 1;
            }
            Row {
                truth: truth.to_owned(),
                sets: sets.len(),
                alone: count(&|set| set.is_right() && set.named.len() == 1),
                among: count(&|set| set.is_right() && set.named.len() > 1),
                wrong: count(&|set| !set.named.is_empty() && !set.is_right()),
                unnamed,
                covered: count(&|set| set.covered == Some(true)),
            }
        };
        truths.into_iter().map(of).filter(|row| row.sets > 0).collect()
    }

    /// What is true of `diagnosis`, where nothing, a listed effect and an unlisted one are equally likely beforehand:
    /// the shares among the simulated sets that had the same verdict. None where none had it.
    pub fn probability(&self, diagnosis: &Diagnosis) -> Probability {
        let of_kind = |is: &dyn Fn(&Simulated) -> bool| {
            self.sets.iter().filter(|set| is(set)).count().max(1) as f64
        };
        let is_listed = |set: &Simulated| !["nothing", "unlisted"].contains(&set.truth.as_str());
        let weights = [
            1.0 / of_kind(&is_listed),
            1.0 / of_kind(&|set| set.truth == "nothing"),
            1.0 / of_kind(&|set| set.truth == "unlisted"),
        ];
        let weight = |set: &Simulated| match set.truth.as_str() {
            "nothing" => weights[1],
            "unlisted" => weights[2],
            _ => weights[0],
        };
        let same: Vec<&Simulated> =
            self.sets.iter().filter(|set| set.verdict == diagnosis.verdict).collect();
        let all: f64 = same.iter().map(|set| weight(set)).sum();
        let share = |is: &dyn Fn(&Simulated) -> bool| {
            let some: f64 = same.iter().filter(|set| is(set)).map(|set| weight(set)).sum();
            // The sum of nothing is minus zero.
            (all > 0.0).then(|| some.abs() / all)
        };
        Probability {
            counted_in: Counted::Design,
            right: share(&|set| set.is_right())
                .filter(|_| same.iter().any(|set| !set.named.is_empty())),
            nothing: share(&|set| set.truth == "nothing"),
            unlisted: share(&|set| set.truth == "unlisted"),
        }
    }
}

/// The verdict as it is written.
fn name_of(verdict: Verdict) -> String {
    let name = serde_json::to_value(verdict).ok();
    name.and_then(|name| name.as_str().map(str::to_owned)).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(truth: &str, verdict: Verdict, named: &[&str]) -> Simulated {
        let named = named.iter().map(|id| (*id).to_owned()).collect();
        Simulated { truth: truth.into(), verdict, named, covered: None }
    }

    #[test]
    fn a_probability_is_the_share_among_sets_of_the_same_verdict() {
        let sets = vec![
            set("lift", Verdict::Supported, &["lift"]),
            set("lift", Verdict::Supported, &["janssen"]),
            set("nothing", Verdict::NothingDetected, &[]),
            set("nothing", Verdict::Supported, &["lift"]),
            set("unlisted", Verdict::NoneOfTheCandidates, &[]),
        ];
        let calibration = Calibration { sets };
        let said =
            |verdict| Diagnosis { verdict, ..Diagnosis::cannot_tell(Vec::new(), String::new()) };
        // Of supported, two listed of weight 1/2 and a null of weight 1/2: one of three is right.
        let named = calibration.probability(&said(Verdict::Supported));
        let third = |share: Option<f64>| (share.unwrap_or(0.0) - 1.0 / 3.0).abs() < 1e-12;
        assert!(third(named.right) && third(named.nothing), "{named:?}");
        assert_eq!(named.unlisted, Some(0.0));
        assert_eq!(calibration.probability(&said(Verdict::Pair)).right, None);
    }

    #[test]
    fn rows_count_every_set_once() {
        let calibration = Calibration {
            sets: vec![
                set("lift", Verdict::Supported, &["lift"]),
                set("lift", Verdict::NotSeparable, &["janssen", "lift"]),
                set("lift", Verdict::Pair, &["janssen", "tilt"]),
                set("lift", Verdict::BelowNoise, &[]),
            ],
        };
        let rows = calibration.rows();
        let row = &rows[0];
        assert_eq!((rows.len(), row.sets), (1, 4));
        assert_eq!((row.alone, row.among, row.wrong), (1, 1, 1));
        assert_eq!(row.unnamed.get("below-noise"), Some(&1));
    }
}
