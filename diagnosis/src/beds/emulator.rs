//! A bed of grains as the statistics see it: means of runs, and how they answer to each candidate.

use nalgebra::{DMatrix, DVector};

use measurements::MeasurementSet;
use serde_json::{Value, json};

use super::baseline::Baseline;
use super::bed_candidate::BedCandidate;
use super::bed_candidates::are_alike_below;
use super::clarity::lost;
use super::preparation::is_far;
use super::response::Response;
use super::shared::Shared;
use crate::fit::Fit;
use crate::forward::sensitivity::Point;
use crate::forward::{
    Candidate, Forward, Moment, Parameter, ParameterKind, Passages, PredictError, Request, Scatter,
};
use crate::misfit::noise_floor::noise_floor;
use crate::rounding::rounded;

/// So many times the amplitude that was screened, what was found there is extrapolated: far enough for a
/// search to begin with.
const SCREENED: f64 = 4.0;

/// The same for the largest amplitude of a line search.
const SEARCHED: f64 = 1.5;

/// A derivative by an amplitude is taken over this share of the one that is screened.
const STEP: f64 = 1e-2;

/// A candidate, and what was found of it.
pub(super) struct Screened {
    pub(super) bed_candidate: &'static BedCandidate,
    /// One per condition of the set; none for those that were not run.
    pub(super) responses: Vec<Option<Response>>,
    /// Least and greatest amplitude that the responses are good for.
    pub(super) range: (f64, f64),
    /// Why it cannot be tested.
    pub(super) not_testable: Option<String>,
}

/// What an index of the statistics means.
#[derive(Clone, Copy)]
enum Source {
    BedCandidate(usize),
    /// Index of a candidate of the force law that stands in.
    Apparatus(usize),
}

/// Means of runs, with the candidates that were screened.
pub struct BedForward {
    baseline: Baseline,
    screened: Vec<Screened>,
    /// Those of `screened` that are free parameters.
    free: Vec<usize>,
    sources: Vec<Source>,
    parameters: Vec<Parameter>,
    candidates: Vec<Candidate>,
    /// What all runs share; its parameters stand behind those of `free`.
    shared: Shared,
    /// Whether readings from before contact are among what is fitted to.
    flight: bool,
}

impl BedForward {
    /// Of `baseline` and what all runs `shared`, without candidates.
    pub(super) fn new(baseline: Baseline, shared: Shared) -> Self {
        let layouts = baseline.observed.conditions.iter().map(|one| &one.layout);
        let flight = layouts.flat_map(|layout| &layout.times).any(|time| *time < 0.0);
        let mut forward = Self {
            baseline,
            shared,
            screened: Vec::new(),
            free: Vec::new(),
            sources: Vec::new(),
            parameters: Vec::new(),
            candidates: Vec::new(),
            flight,
        };
        forward.describe();
        forward
    }

    /// With what was `screened`: candidates whose id is in `free` are parameters of the model, the others candidates beside
    /// those of the force law that are named in `apparatus`.
    pub(super) fn with(
        mut self,
        screened: Vec<Screened>,
        free: &[String],
        apparatus: &[&str],
    ) -> Self {
        let is_free = |one: &Screened| free.iter().any(|id| id == one.bed_candidate.id);
        let (parameters, others): (Vec<usize>, Vec<usize>) =
            (0..screened.len()).partition(|&at| is_free(&screened[at]));
        self.sources = others.into_iter().map(Source::BedCandidate).collect();
        let of_law = self.baseline.stand_in.forward.candidates().iter().enumerate();
        let named = of_law.filter(|(_, one)| apparatus.contains(&one.id.as_str()));
        self.sources.extend(named.map(|(at, _)| Source::Apparatus(at)));
        (self.screened, self.free) = (screened, parameters);
        self.describe();
        self
    }

    /// Says anew what the statistics are told of parameters and candidates.
    fn describe(&mut self) {
        let parameter = |&at: &usize| {
            let one = &self.screened[at];
            let (min, max) = one.range;
            let name = one.bed_candidate.id.to_owned();
            Parameter {
                name,
                unit: String::new(),
                start: 0.0,
                min,
                max,
                prior: None,
                kind: ParameterKind::Model,
            }
        };
        let candidate = |source: &Source| match *source {
            Source::BedCandidate(at) => self.screened[at].candidate(),
            Source::Apparatus(at) => {
                let of_law = self.baseline.stand_in.forward.candidates()[at].clone();
                let not_testable = match self.baseline.stand_in.answers_any() {
                    true => of_law.not_testable.clone(),
                    false => Some("a crater alone does not tell: add depths or times".to_owned()),
                };
                Candidate { unresolved: Vec::new(), not_testable, ..of_law }
            }
        };
        let parameters = self.free.iter().map(parameter);
        let parameters = parameters.chain(self.shared.parameters().iter().cloned()).collect();
        let mut candidates: Vec<Candidate> = self.sources.iter().map(candidate).collect();
        if !self.flight {
            let testable = candidates.iter().filter(|one| one.not_testable.is_none());
            let testable: Vec<String> = testable.map(|one| one.id.clone()).collect();
            for one in candidates.iter_mut().filter(|one| one.not_testable.is_none()) {
                let alike = testable.iter().filter(|other| are_alike_below(&one.id, other));
                one.unresolved = alike.cloned().collect();
            }
        }
        (self.parameters, self.candidates) = (parameters, candidates);
    }

    /// The candidate behind candidate `candidate`; none for what the apparatus does.
    pub(super) fn bed_candidate(&self, candidate: usize) -> Option<usize> {
        match self.sources[candidate] {
            Source::BedCandidate(at) => Some(at),
            Source::Apparatus(_) => None,
        }
    }

    /// The candidates that stand for the parameters, in their order.
    pub(super) fn free(&self) -> &[usize] {
        &self.free
    }

    pub(super) fn screened(&self) -> &[Screened] {
        &self.screened
    }

    pub(super) fn baseline(&self) -> &Baseline {
        &self.baseline
    }

    /// Puts what a line search over amplitudes of `tried` found of candidate `at` in place of what screening had
    /// found.
    pub(super) fn refine(
        &mut self,
        at: usize,
        responses: Vec<Option<Response>>,
        tried: (f64, f64),
    ) {
        let (min, max) = self.screened[at].bed_candidate.range;
        let largest = if tried.1 > -tried.0 { tried.1 } else { tried.0 };
        let runs = responses.iter().flatten().map(|one| one.deviations.len()).sum();
        self.screened[at].not_testable = lost((&responses, largest), &self.baseline, runs);
        self.screened[at].responses = responses;
        self.screened[at].range = (min.max(SEARCHED * tried.0), max.min(SEARCHED * tried.1));
        self.describe();
    }

    /// Makes every candidate testable with what is known of it. Gives the index of each that is lost in the scatter, with the
    /// reason.
    pub(super) fn take_at_face_value(&mut self) -> Vec<(usize, String)> {
        let screened = self.screened.iter_mut().enumerate();
        let lost = screened.filter_map(|(at, one)| Some((at, one.not_testable.take()?))).collect();
        self.describe();
        lost
    }

    /// Makes the candidates `lost`, given by index and reason, untestable again.
    pub(super) fn give_up(&mut self, lost: Vec<(usize, String)>) {
        for (at, why) in lost {
            self.screened[at].not_testable = Some(why);
        }
        self.describe();
    }

    /// Whether a parameter that all runs share is in `fit` farther from what is known of it than one may expect.
    pub(super) fn is_strained(&self, fit: &Fit) -> bool {
        let each = self.parameters.iter().zip(&fit.point.parameters).enumerate();
        let mut known =
            each.filter_map(|(at, (one, value))| one.prior.map(|prior| (at, prior, *value)));
        known.any(|(at, prior, value)| is_far(prior, value, fit.standard_error(at).unwrap_or(0.0)))
    }

    /// Scatter of the runs of the model from bed to bed: relative standard deviations of coefficients and
    /// of the force along the path, and of every scalar, condition by condition.
    pub fn scatter(&self, set: &MeasurementSet) -> Value {
        let noise = &self.baseline.fitted.noise;
        let conditions = self.baseline.observed.fit.iter().map(|&at| {
            let observed = &self.baseline.observed.conditions[at];
            let kinds = observed.layout.kinds().into_iter().enumerate();
            let relative = kinds.filter(|(_, kind)| kind.is_scalar()).map(|(row, kind)| {
                let runs = observed.runs.len();
                let squares = (0..runs).map(|run| observed.deviation(run)[row].powi(2));
                let sd = (squares.sum::<f64>() / (runs - 1) as f64).sqrt();
                (kind.key().to_owned(), rounded(sd / observed.mean[row].abs()))
            });
            let relative: serde_json::Map<String, Value> = relative.collect();
            let (id, runs) = (&set.conditions[at].id, observed.runs.len());
            json!({ "condition": id, "runs": runs, "relative_sd": relative })
        });
        json!({
            "coefficient_sd": rounded(noise.spread.coefficient),
            "path_force_sd": rounded(noise.spread.path),
            "conditions": conditions.collect::<Vec<_>>(),
        })
    }

    /// Standard errors of the means of the runs of the model, by kind of number: no error below it says
    /// anything of the model.
    pub fn noise_floor(&self) -> Value {
        let observed = &self.baseline.observed;
        noise_floor(observed, &observed.fit).to_json()
    }

    /// The names of those of `effects` that are candidates of the simulation.
    pub(crate) fn of_the_bed(&self, effects: &[(usize, f64)]) -> Vec<&'static str> {
        let bed_candidates = effects.iter().filter_map(|&(index, _)| self.bed_candidate(index));
        bed_candidates.map(|at| self.screened[at].bed_candidate.id).collect()
    }

    /// What all runs share at `point`, and its effects of the force law, change of the observables; any condition of the
    /// set, run or not.
    pub(super) fn beside_the_bed(
        &self,
        condition: usize,
        point: &Point,
    ) -> Result<DVector<f64>, PredictError> {
        let of_law = self.respond(condition, &point.effects, &Scatter::default())?;
        let shared = &point.parameters[self.free.len().min(point.parameters.len())..];
        Ok(of_law + self.shared.change(condition, shared))
    }

    /// Variance of each number of what all runs share in `fit`.
    pub(super) fn unknown_beside(&self, condition: usize, fit: &Fit) -> DVector<f64> {
        let (free, n) = (self.free.len(), self.shared.parameters().len());
        let covariance = fit.covariance.view((free, free), (n, n)).into_owned();
        self.shared.variance(condition, &fit.point.parameters[free..free + n], &covariance)
    }

    /// What all runs share.
    pub(super) fn shared(&self) -> &Shared {
        &self.shared
    }

    /// How the observables of `condition` follow the logarithms of the coefficients of the force law that stands in.
    pub(super) fn by_coefficients(&self, condition: usize) -> Result<DMatrix<f64>, PredictError> {
        const STEP: f64 = 0.05;
        let n = self.baseline.stand_in.n_scattering();
        let column = |at: usize| {
            let coefficients = (0..n).map(|k| if k == at { STEP } else { 0.0 }).collect();
            let scatter = Scatter { coefficients, ..Scatter::default() };
            Ok(self.baseline.stand_in.response(condition, &[], &scatter)? / STEP)
        };
        let columns = (0..n).map(column).collect::<Result<Vec<_>, PredictError>>()?;
        Ok(DMatrix::from_columns(&columns))
    }

    fn respond(
        &self,
        condition: usize,
        effects: &[(usize, f64)],
        scatter: &Scatter,
    ) -> Result<DVector<f64>, PredictError> {
        let of_law: Vec<(usize, f64)> = effects
            .iter()
            .filter_map(|&(index, q)| match self.sources[index] {
                Source::Apparatus(at) => Some((at, q)),
                Source::BedCandidate(_) => None,
            })
            .collect();
        self.baseline.stand_in.response(condition, &of_law, scatter)
    }

    /// The candidates at work, as (index in `screened`, q).
    fn at_work<'a>(
        &'a self,
        parameters: &'a [f64],
        effects: &'a [(usize, f64)],
    ) -> impl Iterator<Item = (usize, f64)> + 'a {
        let of_model = self.free.iter().copied().zip(parameters.iter().copied());
        let added = effects.iter().filter_map(|&(index, q)| Some((self.bed_candidate(index)?, q)));
        of_model.chain(added)
    }
}

impl Screened {
    /// `bed_candidate` as it was screened.
    pub(super) fn new(
        bed_candidate: &'static BedCandidate,
        responses: Vec<Option<Response>>,
        not_testable: Option<String>,
    ) -> Self {
        let (min, max) = bed_candidate.range;
        let reach = SCREENED * bed_candidate.screen;
        Self { bed_candidate, responses, range: (min.max(-reach), max.min(reach)), not_testable }
    }

    fn candidate(&self) -> Candidate {
        let (min, max) = self.range;
        Candidate {
            id: self.bed_candidate.id.to_owned(),
            unit: "1".to_owned(),
            min,
            max,
            usual: None,
            step: STEP * self.bed_candidate.screen,
            not_testable: self.not_testable.clone(),
            separable_from: self.bed_candidate.separable_from.to_owned(),
            form: Vec::new(),
            unresolved: Vec::new(),
        }
    }
}

impl Forward for BedForward {
    fn is_judged_by_held_out(&self) -> bool {
        false
    }

    fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    fn candidates(&self) -> &[Candidate] {
        &self.candidates
    }

    fn n_scattering_coefficients(&self) -> usize {
        self.baseline.stand_in.n_scattering()
    }

    fn predict(&self, condition: usize, at: &Request<'_>) -> Result<Vec<f64>, PredictError> {
        let observed = &self.baseline.observed.conditions[condition];
        let missing = || PredictError {
            condition,
            id: observed.id.clone(),
            why: "no impact was run under it".to_owned(),
        };
        if observed.runs.is_empty() {
            return Err(missing());
        }
        let mut predicted = observed.mean.clone();
        let shared = &at.parameters[self.free.len().min(at.parameters.len())..];
        if shared.iter().any(|value| *value != 0.0) {
            predicted += self.shared.change(condition, shared);
        }
        let of_law = |&(index, q): &(usize, f64)| q != 0.0 && self.bed_candidate(index).is_none();
        if !at.scatter.is_still() || at.effects.iter().any(of_law) {
            predicted += self.respond(condition, at.effects, at.scatter)?;
        }
        for (bed_candidate, q) in self.at_work(at.parameters, at.effects).filter(|(_, q)| *q != 0.0)
        {
            let response = self.screened[bed_candidate].responses[condition].as_ref();
            predicted += response.ok_or_else(missing)?.at(q);
        }
        Ok(predicted.as_slice().to_vec())
    }

    fn own_covariance(&self, condition: usize, effects: &[(usize, f64)]) -> Option<DMatrix<f64>> {
        let runs = self.baseline.observed.conditions[condition].runs.len();
        if runs == 0 {
            return None;
        }
        let spread = &self.baseline.spread[condition];
        let of_effects = self.at_work(&[], effects).filter_map(|(bed_candidate, q)| {
            let response = self.screened[bed_candidate].responses[condition].as_ref()?;
            Some(response.covariance_at(q, spread))
        });
        let of_means = spread / runs as f64 + self.shared.unknown(condition);
        Some(of_effects.fold(of_means, |sum, one| sum + one))
    }

    fn spread_of_runs(&self, condition: usize) -> Option<&DMatrix<f64>> {
        let spread = &self.baseline.spread[condition];
        (!spread.is_empty()).then_some(spread)
    }

    fn ways_of_scatter(&self, condition: usize) -> Option<&DMatrix<f64>> {
        Some(&self.baseline.ways[condition])
    }

    fn passages(&self) -> Option<&dyn Passages> {
        self.baseline.stand_in.answers_any().then_some(self)
    }
}

impl Passages for BedForward {
    /// By the force law that stands in: what candidates change of the force along a path is not known.
    fn passage(
        &self,
        condition: usize,
        at: &Request<'_>,
        others: &[Request<'_>],
        n: usize,
    ) -> Result<Vec<Moment>, PredictError> {
        let others: Vec<&Scatter> = others.iter().map(|other| other.scatter).collect();
        self.baseline.stand_in.passage(condition, (at.scatter, &others), n)
    }
}
