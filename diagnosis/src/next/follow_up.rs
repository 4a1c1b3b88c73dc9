//! What an earlier diagnosis expected of the runs that came after it, and what they say about its hypotheses.

use nalgebra::DVector;
use serde::{Serialize, Serializer};

use super::hypothesis::{Expectation, Hypothesis};
use super::prospect::{Prospect, entropy, posterior};
use super::{hypotheses, probabilities};
use crate::fit::problem::FitProblem;
use crate::forward::observable::{Layout, Observable};
use crate::forward::{Forward, PredictError};
use crate::misfit::lack_of_fit::at_least;
use crate::observed::Observed;
use crate::rounding::six_digits;
use crate::verdict::Diagnosis;

/// Probability below which misses are not by chance.
const UNEXPECTED: f64 = 0.01;

/// Runs that came after a diagnosis, held against what it expected.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FollowUp {
    /// Every hypothesis of the earlier diagnosis, its leader first.
    pub hypotheses: Vec<Share>,
    /// What the new runs told about which of them holds (bits); negative where they raise doubts.
    #[serde(serialize_with = "six_digits")]
    pub told_bits: f64,
    /// Probability that the numbers of `came` differ so much from what the most likely hypothesis expects. If it is small, no
    /// hypothesis expects them, and the probabilities only say which is nearest.
    #[serde(serialize_with = "six_digits")]
    pub p_nearest: f64,
    /// Whether that is below 0.01.
    pub is_unexpected: bool,
    /// Every condition with new runs.
    pub came: Vec<NewRuns>,
}

/// A hypothesis before and after the new runs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Share {
    /// An effect, or `no effect`.
    pub id: String,
    /// Its probability among them before.
    #[serde(serialize_with = "six_digits")]
    pub before: f64,
    /// The same after the new runs.
    #[serde(serialize_with = "six_digits")]
    pub after: f64,
    /// χ² of the new runs over how many numbers they are: about 1 if they came as expected.
    #[serde(serialize_with = "six_digits")]
    pub chi2_per_number: f64,
}

/// A condition with new runs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NewRuns {
    /// Its id.
    pub condition: String,
    /// How many new runs it has.
    pub runs: usize,
    /// The number that is shown of them, with its unit: `final_z_m`, `stop_time_s`, `z_m`, …
    #[serde(serialize_with = "key")]
    pub quantity: Observable,
    /// Where it was read: the time (s) or the depth (m) of a reading along the way.
    pub at: Option<f64>,
    /// Its mean over the new runs.
    #[serde(serialize_with = "six_digits")]
    pub measured: f64,
    /// What each hypothesis expected of that mean.
    pub expected: Vec<Expected>,
}

fn key<S: Serializer>(quantity: &Observable, to: S) -> Result<S::Ok, S::Error> {
    to.serialize_str(quantity.key())
}

/// What a hypothesis expects of a number.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Expected {
    /// An effect, or `no effect`.
    pub id: String,
    /// The number.
    #[serde(serialize_with = "six_digits")]
    pub value: f64,
    /// Its standard error: of the fit, and of a mean over so many runs.
    #[serde(serialize_with = "six_digits")]
    pub se: f64,
}

/// What `diagnosis`, of the runs on `earlier`, expected of `later`, whose model `forward` predicts the same conditions;
/// `None` if it has no hypothesis with which that can be predicted.
///
/// # Errors
/// If the model fails as it is.
pub fn follow_up(
    earlier: &FitProblem<'_>,
    diagnosis: &Diagnosis,
    (later, forward): (&Observed, &dyn Forward),
) -> Result<Option<FollowUp>, PredictError> {
    let Some(proposed) = &diagnosis.proposed else { return Ok(None) };
    let mut hypotheses = match diagnosis.p1 {
        Some(_) if diagnosis.is_something_missing() => hypotheses(earlier, diagnosis),
        _ => Vec::new(),
    };
    if hypotheses.is_empty() {
        let bare = (&proposed.fit.point, 0.0);
        hypotheses.push(Hypothesis::fitted(earlier, &proposed.weights, bare)?);
    }
    let conditions: Vec<usize> =
        (0..later.conditions.len()).filter(|&at| !later.conditions[at].layout.is_empty()).collect();
    let prospects: Option<Vec<Prospect>> = conditions
        .iter()
        .map(|&at| {
            let observed = &later.conditions[at];
            Prospect::of((forward, at), observed, &proposed.noise, &hypotheses)
        })
        .collect();
    let Some(prospects) = prospects.filter(|all| !all.is_empty()) else { return Ok(None) };
    let before = probabilities(&hypotheses);
    let measured: Vec<&DVector<f64>> =
        conditions.iter().map(|&at| &later.conditions[at].mean).collect();
    let all: Vec<&Prospect> = prospects.iter().collect();
    let Some((after, chi2)) = posterior(&all, &measured, &before) else { return Ok(None) };
    let numbers: usize = measured.iter().map(|mean| mean.len()).sum();
    let shares = hypotheses.iter().enumerate().map(|(at, hypothesis)| Share {
        id: hypothesis.name().to_owned(),
        before: before[at],
        after: after[at],
        chi2_per_number: chi2[at] / numbers as f64,
    });
    let came = conditions.iter().zip(&prospects).map(|(&at, prospect)| {
        let observed = &later.conditions[at];
        let (place, quantity, read_at) = shown(&observed.layout);
        let expected = hypotheses.iter().zip(&prospect.expectations).map(|(hypothesis, one)| {
            let (value, se) = number(prospect, one, place);
            Expected { id: hypothesis.name().to_owned(), value, se }
        });
        NewRuns {
            condition: observed.id.clone(),
            runs: observed.runs.len(),
            quantity,
            at: read_at,
            measured: observed.mean[place],
            expected: expected.collect(),
        }
    });
    let came: Vec<NewRuns> = came.collect();
    let nearest = (0..after.len()).max_by(|&a, &b| after[a].total_cmp(&after[b]));
    let miss = |one: &NewRuns, at: usize| {
        let Expected { value, se, .. } = one.expected[at];
        ((one.measured - value) / se).powi(2)
    };
    let misses = |at: usize| came.iter().map(|one| miss(one, at)).sum::<f64>();
    let p_nearest = nearest.and_then(|at| at_least(misses(at), came.len() as f64)).unwrap_or(1.0);
    Ok(Some(FollowUp {
        hypotheses: shares.collect(),
        told_bits: entropy(&before) - entropy(&after),
        p_nearest,
        is_unexpected: p_nearest < UNEXPECTED,
        came,
    }))
}

/// Place, kind and reading of the number that says most of an impact: where it ended, else when, else the last reading
/// of its depth.
fn shown(layout: &Layout) -> (usize, Observable, Option<f64>) {
    let places = layout.places();
    let last = |kind| places.iter().rposition(|(other, _)| *other == kind);
    let of = [Observable::FinalDepth, Observable::StopTime, Observable::Depth];
    let place = of.into_iter().find_map(last).unwrap_or(places.len().saturating_sub(1));
    (place, places[place].0, places[place].1)
}

/// The number at `place` that `expectation` gives, and its standard error.
fn number(prospect: &Prospect, expectation: &Expectation, place: usize) -> (f64, f64) {
    let weight = &prospect.weight;
    let open = [&expectation.shared, &expectation.own];
    let columns = open.iter().flat_map(|open| open.column_iter());
    let open = columns.map(|column| weight.colour(&column.into_owned())[place].powi(2));
    let variance = weight.standard_errors()[place].powi(2) + open.sum::<f64>();
    (weight.colour(&expectation.mean)[place], variance.sqrt())
}
