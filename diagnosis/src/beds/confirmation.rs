//! Impacts on fresh beds under conditions that nothing was fitted to: the only number that is quoted as
//! "the error falls", and the ledgers of both models.

use nalgebra::DVector;
use runner::beds::Record;
use serde_json::{Value, json};

use super::bed_model::BedModel;
use super::emulator::BedForward;
use super::error::BedError;
use super::observables::observables;
use crate::fit::Fit;
use crate::fit::problem::FitError;
use crate::forward::sensitivity::Point;
use crate::misfit::error_unit::Unit;
use crate::misfit::errors::Sums;
use crate::misfit::held_out::{Fails, HeldOut, LeftOut, NotPredicted};
use crate::misfit::noise_floor::standard_errors;
use crate::observed::Observed;
use crate::rounding::rounded;

/// What impacts on fresh beds say.
#[derive(Clone, Debug)]
pub struct Confirmation {
    /// Errors of the model as it is and with what is proposed; the floor is of the means of both, of
    /// measurements and of impacts, and of what all runs share.
    pub held_out: HeldOut,
    /// Every channel that dissipates.
    pub channels: Vec<Channel>,
}

/// Where the energy of impacts goes, as a share of all that is dissipated.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// As in the ledger.
    pub name: String,
    /// Mean and standard error over the impacts of the model as it is; nothing where it has no such
    /// channel.
    pub before: (f64, f64),
    /// With what is proposed.
    pub after: (f64, f64),
}

impl Confirmation {
    /// Of `runs` under `conditions`: those of the model as it is, and those with the candidates of a model on, condition
    /// after condition; what all runs share in the two models, and what an effect of a force law does, is added by
    /// `fits`.
    pub(super) fn of(
        bed_model: &BedModel<'_>,
        measured: &Observed,
        (forward, fits): (&BedForward, [&Fit; 2]),
        (conditions, runs): (&[usize], [&[Option<Record>]; 2]),
    ) -> Result<Self, BedError> {
        let mut sums = [Sums::default(), Sums::default(), Sums::default()];
        let (mut gain, mut judged, mut not_predicted) = (0.0, 0, Vec::new());
        for (at, &condition) in conditions.iter().enumerate() {
            let observed = &measured.conditions[condition];
            let of_set = &bed_model.set.conditions[condition];
            let means: Vec<Option<Mean>> = runs
                .iter()
                .map(|runs| {
                    let n = runs.len() / conditions.len();
                    let numbers = runs[at * n..(at + 1) * n].iter().flatten();
                    let numbers = numbers
                        .map(|run| observables(run, &observed.layout, of_set, bed_model.set));
                    Mean::of(&numbers.collect::<Vec<_>>())
                })
                .collect();
            let (plain, with) = match &means[..] {
                [Some(plain), Some(with)] => (plain, with),
                means => {
                    not_predicted.push(without_impacts(&of_set.id, means));
                    continue;
                }
            };
            judged += 1;
            let beside = |point: &Point| -> Result<_, BedError> {
                Ok(forward.beside_the_bed(condition, point).map_err(FitError::from)?)
            };
            let [before, after] = fits.map(|fit| &fit.point);
            let errors = [
                &observed.mean - &plain.mean - beside(before)?,
                &observed.mean - &with.mean - beside(after)?,
            ];
            let own = standard_errors(observed);
            let beside = fits.map(|fit| forward.unknown_beside(condition, fit));
            let beside = beside[0].zip_map(&beside[1], f64::max).map(f64::sqrt);
            let floor = own.zip_map(&with.error, libm::hypot).zip_map(&beside, libm::hypot);
            gain += 0.5 * (mean_square(&errors[0], &floor) - mean_square(&errors[1], &floor));
            for (sums, error) in sums.iter_mut().zip(errors.iter().chain([&floor])) {
                sums.add(observed, error);
            }
        }
        let unit = Unit::of(bed_model.set.kind);
        let [before, after, noise_floor] = sums.map(|sums| unit.pick(&sums.errors()));
        let [.., explained] = HeldOut::share(before, after, noise_floor);
        let held_out = HeldOut {
            ratio_at_most: None,
            weighed: None,
            explained,
            before,
            after,
            noise_floor,
            expected: noise_floor,
            unit,
            conditions: LeftOut::Holdout,
            conditions_judged: judged,
            not_predicted,
            // Numbers of one condition hang together: each condition counts as one.
            log_density_gain: gain,
        };
        Ok(Self { held_out, channels: channels(runs) })
    }

    /// The channels as JSON.
    pub(super) fn ledger(&self) -> Value {
        let entry = |(mean, se): (f64, f64)| json!({ "share": rounded(mean), "se": rounded(se) });
        let channels = self.channels.iter().map(|one| {
            let (before, after) = (entry(one.before), entry(one.after));
            (one.name.clone(), json!({ "before": before, "after": after }))
        });
        Value::Object(channels.collect())
    }
}

/// A condition under which two impacts at least did not end, of the model as it is (the first of `means`) or of that
/// with what is proposed.
fn without_impacts(id: &str, means: &[Option<Mean>]) -> NotPredicted {
    let by = match means {
        [Some(_), None] => Fails::After,
        [None, Some(_)] => Fails::Before,
        _ => Fails::Both,
    };
    let why = "fewer than two impacts under it ended".to_owned();
    NotPredicted { condition: id.to_owned(), by, why, is_open: false }
}

/// Mean of runs, and its standard error.
struct Mean {
    mean: DVector<f64>,
    error: DVector<f64>,
}

impl Mean {
    /// Of two runs at least.
    fn of(runs: &[DVector<f64>]) -> Option<Self> {
        let n = runs.len();
        let first = runs.first().filter(|_| n > 1)?;
        let zero = first.map(|_| 0.0);
        let mean = runs.iter().fold(zero.clone(), |sum, run| sum + run) / n as f64;
        let square = |run: &DVector<f64>| (run - &mean).map(|d| d * d);
        let squares = runs.iter().fold(zero, |sum, run| sum + square(run));
        Some(Self { error: (squares / (n * (n - 1)) as f64).map(f64::sqrt), mean })
    }
}

/// Mean square of `error` in units of `floor`; numbers without an error are left out.
fn mean_square(error: &DVector<f64>, floor: &DVector<f64>) -> f64 {
    let known: Vec<f64> = error
        .iter()
        .zip(floor.iter())
        .filter(|(_, floor)| **floor > 0.0)
        .map(|(error, floor)| (error / floor).powi(2))
        .collect();
    known.iter().sum::<f64>() / known.len().max(1) as f64
}

fn channels(runs: [&[Option<Record>]; 2]) -> Vec<Channel> {
    let mut names: Vec<String> = Vec::new();
    for (name, _) in runs.iter().flat_map(|runs| runs.iter().flatten()).flat_map(Record::dissipated)
    {
        if !names.iter().any(|known| known == name) {
            names.push(name.to_owned());
        }
    }
    let share = |runs: &[Option<Record>], name: &str| {
        let shares: Vec<DVector<f64>> = runs
            .iter()
            .flatten()
            .map(|run| {
                let all: f64 = run.dissipated().map(|(_, value)| value).sum();
                let own = run.dissipated().find(|(key, _)| *key == name).map_or(0.0, |(_, v)| v);
                DVector::from_element(1, if all > 0.0 { own / all } else { 0.0 })
            })
            .collect();
        Mean::of(&shares).map_or((f64::NAN, f64::NAN), |mean| (mean.mean[0], mean.error[0]))
    };
    let channel = |name: String| {
        let (before, after) = (share(runs[0], &name), share(runs[1], &name));
        Channel { name, before, after }
    };
    names.into_iter().map(channel).collect()
}
