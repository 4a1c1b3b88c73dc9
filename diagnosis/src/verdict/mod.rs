//! What a diagnosis says, and how it is written.

pub mod added_force;
pub(crate) mod amplitudes;
pub(crate) mod doubts;
pub(crate) mod frequency;
pub(crate) mod judge;
pub(crate) mod ranked;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use crate::fit::Fit;
use crate::fit::problem::Fitted;
use crate::forward::apparatus::is_of_the_instrument;
use crate::forward::sensitivity::Point;
use crate::forward::{Bound, Candidate, Forward, ParameterKind};
use crate::misfit::held_out::HeldOut;
use crate::missing_force::{AnyForce, MissingForce};
use crate::noise::between::Between;
use crate::rounding::{six_digits, six_digits_or_null};
pub use crate::strength::{Strength, StrengthReason};
use crate::verdict::added_force::AddedForce;

/// The answer to "which effect is missing?".
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// The data are explained as they are.
    NothingDetected,
    /// One effect, told apart from all others.
    Supported,
    /// One of several effects that these data do not tell apart.
    NotSeparable,
    /// Two effects, or one that is not listed.
    Pair,
    /// Something is missing that no listed effect explains.
    NoneOfTheCandidates,
    /// Errors of the apparatus, and no effect.
    ExplainedByApparatus,
    /// Another preparation of the bed, and no effect.
    ExplainedByPreparation,
    /// Something is missing, and held-out conditions are missed by no more than a name needs.
    BelowNoise,
    /// The data cannot answer.
    CannotTell,
}

impl Verdict {
    /// Whether the model as it is explains the data.
    #[must_use]
    pub fn is_explained(self) -> bool {
        matches!(
            self,
            Self::NothingDetected | Self::ExplainedByApparatus | Self::ExplainedByPreparation
        )
    }

    /// Whether it names effects.
    #[must_use]
    pub fn names_effects(self) -> bool {
        matches!(self, Self::Supported | Self::NotSeparable | Self::Pair)
    }
}

/// What verdicts were counted in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Counted {
    /// Sets of the benchmark, of another design.
    Benchmark,
    /// Sets of the benchmark of beds, of another design: by whether an effect is named.
    BedBenchmark,
    /// Simulated sets of the design of the set.
    Design,
}

/// Probabilities of what is true, given a verdict.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Probability {
    /// Where such verdicts were counted.
    pub counted_in: Counted,
    /// The effect that is named, or one of those named, is missing; none where nothing is named.
    #[serde(serialize_with = "six_digits_or_null")]
    pub right: Option<f64>,
    /// Nothing is missing.
    #[serde(serialize_with = "six_digits_or_null")]
    pub nothing: Option<f64>,
    /// Something is missing that no list has.
    #[serde(serialize_with = "six_digits_or_null")]
    pub unlisted: Option<f64>,
}

/// What the noise is known from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Evidence {
    /// The scatter of repeats.
    Repeats,
    /// Repeats with fewer than eight independent deviations.
    FewRepeats,
    /// What the set states, or what is usual.
    StatedErrors,
}

/// What became of an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// It was fitted and has its place.
    Ranked,
    /// The data lack what would show it.
    NotTestable,
    /// The model with it could not be integrated.
    NotIntegrated,
    /// In these data the parameters of the model do the same.
    Imitated,
    /// Nothing was tested.
    NotTested,
}

/// A diagnosis of one model by one measurement set.
#[derive(Clone, Debug, Serialize)]
pub struct Diagnosis {
    /// The answer.
    pub verdict: Verdict,
    /// What it rests on.
    pub strength: Strength,
    /// How likely it is that this comes true, as such verdicts do in the benchmark, or in simulated sets of the same design
    /// where they were asked for; none of grain beds.
    pub probability: Option<Probability>,
    /// What the noise is known from.
    pub evidence: Evidence,
    /// What one should know before one believes it, in sentences.
    pub warnings: Vec<String>,
    /// Why it is only suggested; empty where it is confirmed.
    pub strength_reasons: Vec<StrengthReason>,
    /// The one effect (of a pair, the two) that the verdict names.
    pub effects: Vec<String>,
    /// All that cannot be told apart, the leader first; empty under other verdicts.
    pub not_separable: Vec<String>,
    /// All that cannot be told from the first of the ranking, itself included, whatever the verdict.
    #[serde(skip)]
    pub leaders: Vec<String>,
    /// Every effect, best first, those that the data cannot show last.
    pub ranking: Vec<RankedEffect>,
    /// Probability that the best of all effects explains so much by chance; none if nothing was
    /// ranked.
    #[serde(serialize_with = "six_digits_or_null")]
    pub p1: Option<f64>,
    /// Probability of a lack of fit as large as that of the model as it is, if it were right.
    #[serde(serialize_with = "six_digits_or_null")]
    pub p_lof: Option<f64>,
    /// The same for the model with the best effect, or with the pair that is named.
    #[serde(serialize_with = "six_digits_or_null")]
    pub p_lof_with: Option<f64>,
    /// How much measurements scatter.
    pub noise: Value,
    /// Errors where nothing was fitted; none if nothing could be fitted at all.
    pub holdout: Option<HeldOut>,
    /// What no listed effect explains.
    pub unexplained: Unexplained,
    /// The force that is missing where no listed effect explains the data.
    pub missing_force: Option<MissingForce>,
    /// Errors that runs share, as the fit finds them.
    pub apparatus: Vec<ApparatusError>,
    /// By what the measured bed differs from that of the model, as the fit finds it.
    pub preparation: Vec<ApparatusError>,
    /// Experiments that would tell more, in the order of measuring them.
    pub next: Vec<Value>,
    /// The names of the runs that it rests on, by condition.
    pub measured: BTreeMap<String, Vec<String>>,
    /// What an earlier diagnosis expected of the runs that came after it; null unless one was given.
    pub after: Option<Value>,
    /// Parameters with what is named added (without, where nothing is), with standard error and unit.
    pub parameters: Map<String, Value>,
    /// Amplitudes of what is named, fitted together.
    pub amplitudes: Vec<Amplitude>,
    /// Correlation of the two amplitudes of a pair.
    #[serde(serialize_with = "six_digits_or_null")]
    pub amplitude_correlation: Option<f64>,
    /// The model as it is, fitted; none if nothing could be.
    #[serde(skip)]
    pub baseline: Option<Fitted>,
    /// The model with what is named, fitted; the model as it is, where nothing is.
    #[serde(skip)]
    pub proposed: Option<Fitted>,
    /// A force of any form, where the verdict asked for it; [`Self::missing_force`] describes it.
    #[serde(skip)]
    pub(crate) any_force: Option<AnyForce>,
    /// Log odds of the best listed effect against none, each under its own noise.
    #[serde(skip)]
    pub(crate) log_odds_of_leader: Option<f64>,
}

/// One effect in a ranking.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RankedEffect {
    /// kebab-case.
    pub id: String,
    /// What it takes beside its amplitude where that is not as listed (SI): the form that the data ask for.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub form: BTreeMap<&'static str, f64>,
    /// Fitted amplitude.
    #[serde(serialize_with = "six_digits_or_null")]
    pub q: Option<f64>,
    /// Its standard error; none where the amplitude is held at a bound.
    #[serde(serialize_with = "six_digits_or_null")]
    pub se: Option<f64>,
    /// The end of its range at which the amplitude is held: the data ask for as much or more, or for as little or less.
    pub at_bound: Option<Bound>,
    /// Least and greatest amplitude that one would expect, where that is known.
    pub usual_range: Option<[f64; 2]>,
    /// Whether the amplitude is outside of that by more than two standard errors.
    pub unusual: bool,
    /// Unit of the amplitude; 1 where it has none.
    pub unit: String,
    /// Fall of χ² by adding it; of twice the negative logarithm of the likelihood, where what effects do is known from
    /// a few runs.
    #[serde(serialize_with = "six_digits_or_null")]
    pub delta: Option<f64>,
    /// Probability that it would be ranked first, were it there with this amplitude.
    #[serde(serialize_with = "six_digits_or_null")]
    pub predicted_top1: Option<f64>,
    /// What became of it.
    pub status: Status,
    /// Whether the data can show it at all; one with which the model could not be integrated they may.
    pub testable: bool,
    /// The smallest amplitude that the data would show.
    #[serde(serialize_with = "six_digits_or_null")]
    pub detection_limit: Option<f64>,
    /// Parameters of the model with it alone, with their units.
    #[serde(skip_serializing_if = "Map::is_empty")]
    pub parameters: Map<String, Value>,
    /// Why it is not ranked, or what it takes to tell it from its confounders.
    pub note: String,
    /// The model with it, fitted.
    #[serde(skip)]
    pub point: Option<Point>,
}

/// The amplitude of an effect that is named.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Amplitude {
    /// kebab-case.
    pub id: String,
    /// As in [`RankedEffect::form`].
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub form: BTreeMap<&'static str, f64>,
    /// Amplitude.
    #[serde(serialize_with = "six_digits")]
    pub q: f64,
    /// Its standard error; none where the amplitude is held at a bound.
    #[serde(serialize_with = "six_digits_or_null")]
    pub se: Option<f64>,
    /// The end of its range at which it is held.
    pub at_bound: Option<Bound>,
    /// Least and greatest value that the data allow, 95 %; null where the range of the effect holds it back.
    pub interval_95: [Option<f64>; 2],
    /// Whether it is outside of what one would expect of its effect, by more than two standard errors.
    pub unusual: bool,
    /// What it is as a force; none of grain beds, and of effects that are no force against the motion.
    pub force: Option<AddedForce>,
}

/// An error that runs share: of the clock, a zero, the speed, its angle, the scale, a mass, gravity, a session or a bed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ApparatusError {
    /// Which: `time-zero`, `depth-zero`, `surface`, `speed-scale`, `launch-angle`, `camera-scale`, `range-zero`, `tilt`, `mass`,
    /// `session` or `bed`.
    pub id: String,
    /// Of which body, or of which session and coefficient.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub of: Option<String>,
    /// How large the fit finds it.
    #[serde(serialize_with = "six_digits")]
    pub value: f64,
    /// Its standard error.
    #[serde(serialize_with = "six_digits_or_null")]
    pub se: Option<f64>,
    /// Unit of both.
    pub unit: String,
    /// Standard deviation of what is known beforehand.
    #[serde(serialize_with = "six_digits_or_null")]
    pub prior_sigma: Option<f64>,
    /// Whether it is there, and larger than one would expect, in a fit that explains the data.
    pub named: bool,
}

/// An error that is named is so many of its standard errors away from zero,
const CLEAR_OF_ZERO: f64 = 4.0;

/// and at least so many standard deviations of what is known beforehand.
const UNEXPECTED: f64 = 2.0;

/// So many standard deviations of what is known beforehand are no error of an apparatus.
const IMPLAUSIBLE: f64 = 5.0;

/// The same of a preparation: what is known of a bed beforehand is that beds differ.
const UNEXPECTED_BED: f64 = 1.5;

impl ApparatusError {
    /// All of the apparatus in `fitted`; the last is how much conditions differ beyond their runs, where that is learned.
    pub(crate) fn all(forward: &dyn Forward, fitted: &Fitted) -> Vec<Self> {
        let mut all = Self::of(forward, &fitted.fit, ParameterKind::Apparatus);
        all.extend(Self::between(&fitted.noise.sessions));
        all
    }

    /// All of the preparation in `fit`.
    pub(crate) fn of_preparation(forward: &dyn Forward, fit: &Fit) -> Vec<Self> {
        Self::of(forward, fit, ParameterKind::Preparation)
    }

    /// Whether nobody's apparatus is so far off: what is known of the instrument beforehand leaves this out.
    pub(crate) fn is_implausible(&self) -> bool {
        let beyond = |limit: f64, sigma: Option<f64>| {
            sigma.is_some_and(|sigma| sigma > 0.0 && self.value.abs() >= limit * sigma)
        };
        is_of_the_instrument(&self.id)
            && beyond(IMPLAUSIBLE, self.prior_sigma)
            && beyond(CLEAR_OF_ZERO, self.se)
    }

    fn of(forward: &dyn Forward, fit: &Fit, kind: ParameterKind) -> Vec<Self> {
        let unexpected = match kind {
            ParameterKind::Preparation => UNEXPECTED_BED,
            _ => UNEXPECTED,
        };
        let values = forward.parameters().iter().zip(&fit.point.parameters).enumerate();
        let errors = values.filter(|(_, (parameter, _))| parameter.kind == kind);
        errors
            .map(|(at, (parameter, &value))| {
                let se = fit.standard_error(at);
                let prior_sigma = parameter.prior.map(|prior| prior.sigma);
                let beyond = |limit: f64, sigma: Option<f64>| {
                    sigma.is_some_and(|sigma| value.abs() >= limit * sigma)
                };
                let (id, of) = match parameter.name.split_once(" (") {
                    Some((id, of)) => (id.to_owned(), Some(of.trim_end_matches(')').to_owned())),
                    None => (parameter.name.clone(), None),
                };
                let unit = parameter.unit.clone();
                // The prior draws the fit towards zero: what the data alone say counts.
                let own = |se: f64, sigma: f64| (1.0 - (se / sigma).powi(2)).max(0.0);
                let drawn = se.zip(prior_sigma).map_or(1.0, |(se, sigma)| own(se, sigma));
                let named = beyond(CLEAR_OF_ZERO, se) && beyond(unexpected * drawn, prior_sigma);
                Self { id, of, value, se, unit, prior_sigma, named }
            })
            .collect()
    }

    fn between(between: &Between) -> Option<Self> {
        let &Between { sd, gain, sigma } = between;
        (sigma > 0.0).then(|| Self {
            id: "session".to_owned(),
            of: Some("each condition its own".to_owned()),
            value: sd,
            se: None,
            unit: "1".to_owned(),
            prior_sigma: Some(sigma),
            // A fall of the likelihood is the square of a distance in standard errors.
            named: gain >= CLEAR_OF_ZERO.powi(2) && sd >= UNEXPECTED * sigma,
        })
    }
}

impl RankedEffect {
    /// That of `candidate`, which was not ranked because of `note`.
    pub(crate) fn not_ranked(candidate: &Candidate, status: Status, note: String) -> Self {
        Self {
            id: candidate.id.clone(),
            form: BTreeMap::new(),
            q: None,
            se: None,
            at_bound: None,
            usual_range: candidate.usual,
            unusual: false,
            unit: candidate.unit.clone(),
            delta: None,
            predicted_top1: None,
            status,
            testable: status == Status::NotIntegrated,
            detection_limit: None,
            parameters: Map::new(),
            note,
            point: None,
        }
    }
}

/// What remains.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Unexplained {
    /// What the remaining force error depends on, clearest first.
    pub depends_on: Vec<&'static str>,
    /// One sentence; empty if nothing remains.
    pub hint: String,
}

impl Diagnosis {
    /// Has it rest on the errors `held_out` in place of those that it was judged by.
    pub(crate) fn rest_on(&mut self, held_out: HeldOut) {
        let above = StrengthReason::HeldOutAboveNoise;
        self.strength_reasons.retain(|reason| *reason != above);
        if self.verdict.is_explained() && held_out.is_above_noise() == Some(true) {
            self.strength_reasons.push(above);
        }
        self.strength = Strength::of(&self.strength_reasons);
        self.holdout = Some(held_out);
    }

    /// Where nothing can be told, and why.
    pub(crate) fn cannot_tell(ranking: Vec<RankedEffect>, why: String) -> Self {
        Self {
            verdict: Verdict::CannotTell,
            strength: Strength::Suggested,
            probability: None,
            evidence: Evidence::StatedErrors,
            warnings: Vec::new(),
            strength_reasons: Vec::new(),
            effects: Vec::new(),
            not_separable: Vec::new(),
            leaders: Vec::new(),
            ranking,
            p1: None,
            p_lof: None,
            p_lof_with: None,
            noise: Value::Null,
            holdout: None,
            apparatus: Vec::new(),
            preparation: Vec::new(),
            unexplained: Unexplained { hint: why, ..Unexplained::default() },
            missing_force: None,
            any_force: None,
            log_odds_of_leader: None,
            next: Vec::new(),
            measured: BTreeMap::new(),
            after: None,
            parameters: Map::new(),
            amplitudes: Vec::new(),
            amplitude_correlation: None,
            baseline: None,
            proposed: None,
        }
    }

    /// Warns of effects that could not be tested, if the diagnosis names something: they are not excluded.
    pub(crate) fn tell_untested(&mut self) {
        let is_untested = |effect: &&RankedEffect| effect.status == Status::NotTestable;
        let ids = self.ranking.iter().filter(is_untested).map(|effect| effect.id.as_str());
        let untested: Vec<&str> = ids.collect();
        if untested.is_empty() || !self.verdict.names_effects() {
            return;
        }
        if 2 * untested.len() >= self.ranking.len() {
            self.strength_reasons.push(StrengthReason::FewTested);
        }
        let names = untested.join(", ");
        self.warnings.push(format!("not tested, and so not excluded: {names}"));
    }

    /// Whether the verdict says that the model lacks an effect.
    pub(crate) fn is_something_missing(&self) -> bool {
        matches!(
            self.verdict,
            Verdict::Supported
                | Verdict::NotSeparable
                | Verdict::Pair
                | Verdict::NoneOfTheCandidates
                | Verdict::BelowNoise
        )
    }

    /// As one JSON object.
    pub fn to_json(&self) -> serde_json::Result<Value> {
        serde_json::to_value(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn effects(statuses: &[Status]) -> Vec<RankedEffect> {
        let candidate = Candidate::default();
        let one = |status: &Status| RankedEffect::not_ranked(&candidate, *status, String::new());
        statuses.iter().map(one).collect()
    }

    #[test]
    fn a_name_is_suggested_where_half_of_the_effects_could_not_be_tested() {
        let told = |verdict, statuses: &[Status]| {
            let mut diagnosis = Diagnosis::cannot_tell(effects(statuses), String::new());
            diagnosis.verdict = verdict;
            diagnosis.tell_untested();
            (diagnosis.warnings.len(), diagnosis.strength_reasons)
        };
        let (tested, not) = (Status::Ranked, Status::NotTestable);
        let few = vec![StrengthReason::FewTested];
        assert_eq!(told(Verdict::Supported, &[tested, not]), (1, few));
        assert_eq!(told(Verdict::Supported, &[tested, tested, not]), (1, Vec::new()));
        assert_eq!(told(Verdict::Supported, &[tested]), (0, Vec::new()));
        assert_eq!(told(Verdict::NothingDetected, &[not]), (0, Vec::new()), "nothing is named");
    }

    #[test]
    fn an_instrument_is_not_five_standard_deviations_off_and_a_day_may_be() {
        let error = |id: &str, value: f64, se: f64| ApparatusError {
            id: id.to_owned(),
            of: None,
            value,
            se: Some(se),
            unit: "1".to_owned(),
            prior_sigma: Some(0.02),
            named: false,
        };
        for id in ["speed-scale", "camera-scale", "launch-angle", "tilt"] {
            assert!(error(id, -0.11, 0.01).is_implausible(), "{id}");
            assert!(!error(id, -0.09, 0.01).is_implausible(), "{id}: within five");
            assert!(!error(id, -0.11, 0.05).is_implausible(), "{id}: not clear of zero");
        }
        for id in ["time-zero", "depth-zero", "range-zero", "session", "mass"] {
            assert!(!error(id, 0.2, 0.01).is_implausible(), "{id}");
        }
        let exact = ApparatusError { prior_sigma: None, ..error("tilt", 1.0, 0.01) };
        assert!(!exact.is_implausible(), "nothing is known of it");
    }

    #[test]
    fn errors_on_fresh_beds_decide_whether_an_explanation_is_within_the_noise() {
        let held_out = |before| HeldOut::of_errors(before, before, 1.0);
        let mut diagnosis = Diagnosis::cannot_tell(Vec::new(), String::new());
        diagnosis.verdict = Verdict::NothingDetected;
        diagnosis.rest_on(held_out(3.0));
        assert_eq!(diagnosis.strength_reasons, [StrengthReason::HeldOutAboveNoise]);
        assert_eq!(diagnosis.strength, Strength::Suggested);
        diagnosis.rest_on(held_out(1.0));
        assert_eq!(diagnosis.strength, Strength::Confirmed);
        assert_eq!(diagnosis.holdout, Some(held_out(1.0)));
    }
}
