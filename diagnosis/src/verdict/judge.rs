//! From fits and a ranking to a verdict: what is named, what is refused, and why.

use std::cell::OnceCell;
use std::collections::BTreeMap;

use measurements::MeasurementSet;

use crate::fit::fitted_parameters::parameters;
use crate::fit::problem::{FitError, FitProblem, Fitted, MOST_BETWEEN};
use crate::misfit::force_error::ForceErrors;
use crate::misfit::held_out::HeldOut;
use crate::misfit::lack_of_fit::lack_of_fit;
use crate::missing_force::{AnyForce, any_force, is_a_force_left};
use crate::noise::Noise;
use crate::ranking::pair::{Pair, best_pair};
use crate::ranking::score::{Ranking, Score};
use crate::verdict::added_force::AddedForce;
use crate::verdict::amplitudes::{amplitudes, as_listed, correlation};
use crate::verdict::doubts::{doubts, evidence, no_repeats};
use crate::verdict::frequency::of_benchmark;
use crate::verdict::ranked::ranked;
use crate::verdict::{
    Amplitude, ApparatusError, Diagnosis, Strength, StrengthReason, Unexplained, Verdict,
};

/// Probability of error at which something counts as found, or a model as rejected.
pub const ALPHA: f64 = 0.01;

/// Fall of the likelihood from which a scatter between conditions is seen: two standard errors.
const SEEN: f64 = 4.0;

/// Fall of the deviance by which a pair has to exceed a single effect that explains the data: odds of 100 to 1, times the number
/// of effects to choose from. Log odds by which effects that leave a part have to exceed a force of any form.
const LIKELIER: f64 = 15.0;

/// Log odds by which two effects, or one that hardly explains the data, have to exceed a force of any form.
const NOT_ANY: f64 = 10.0;

/// The same of one effect that explains the data: ln 20 for the choice among some twenty effects, and as much for its amplitude,
/// which is fitted. In simulated sets, effects that are there do by 6 at least, and few effects that only resemble the force that is there do.
const NEAREST: f64 = 6.0;

/// Least log odds of a force of any form at which differences between conditions are not taken for undeclared sessions.
const MORE_THAN_SESSIONS: f64 = 7.0;

/// Log odds (20 to 1) from which a force of any form is missing beside effects with which conditions still differ.
const BESIDE: f64 = 3.0;

/// The best effect stands out if every other one lowers χ² by less than this share of its fall.
const STANDS_OUT: f64 = 0.5;

/// At or below this probability of a lack of fit, an effect that leaves a part is compared with a force of any form.
const DOUBTFUL: f64 = 0.1;

/// All that a verdict is made of.
pub(crate) struct Judge<'a> {
    pub(crate) problem: &'a FitProblem<'a>,
    pub(crate) seed: u64,
    /// The model as it is, under its own noise.
    pub(crate) baseline: Fitted,
    /// The model as it is, under the noise of the best model.
    pub(crate) weighed: Fitted,
    pub(crate) ranking: Ranking,
    /// Places of what is not told from the best, itself included.
    pub(crate) alike: Vec<usize>,
    /// The model with the best effect, under its own noise.
    pub(crate) leader: Fitted,
    /// A force of any form, once it was asked for; none where nothing can be told of one.
    pub(crate) any_force: OnceCell<Option<AnyForce>>,
}

/// Two effects that explain the data.
struct Two {
    pair: Pair,
    /// Probability of a lack of fit as large as theirs.
    p_lof: Option<f64>,
    held_out: HeldOut,
}

/// What a verdict rests on beside its fit.
#[derive(Default)]
pub(crate) struct Grounds {
    /// Probability of the lack of fit of the model as it is.
    pub(crate) p_lof: Option<f64>,
    /// The same with what is proposed.
    pub(crate) p_lof_with: Option<f64>,
    /// What the verdict leaves to say.
    pub(crate) hint: String,
    /// Errors on held-out conditions, where they are known already.
    pub(crate) held_out: Option<HeldOut>,
}

impl Judge<'_> {
    pub(crate) fn verdict(self) -> Result<Diagnosis, FitError> {
        let p_lof = lack_of_fit(self.problem, &self.baseline, self.seed)?;
        let grounds = Grounds { p_lof, ..Grounds::default() };
        match self.ranking.p > ALPHA {
            true if adequate(p_lof) => self.explained(grounds),
            true => self.rejected(grounds),
            false => self.helped(grounds),
        }
    }

    /// The verdict where no effect helps, and none is needed.
    fn explained(&self, grounds: Grounds) -> Result<Diagnosis, FitError> {
        if let Some(why) = no_repeats(&self.baseline) {
            return Ok(cannot_tell(self.problem, why));
        }
        let hint = self.differ_by_a_force()?;
        let verdict = match hint {
            Some(_) => Verdict::NoneOfTheCandidates,
            None => nothing(self.problem, &self.baseline),
        };
        let hint = hint.unwrap_or_default();
        self.diagnosis(verdict, &self.baseline, Grounds { hint, ..grounds })
    }

    /// The verdict where no effect helps a model that does not explain the data.
    fn rejected(&self, grounds: Grounds) -> Result<Diagnosis, FitError> {
        if let Some(wide) = self.problem.with_sessions_of_their_own(&self.baseline)?
            && adequate(lack_of_fit(self.problem, &wide, self.seed)?)
        {
            let hint = "conditions differ by more than their repeats show, as beds do that are poured anew; if they \
                        were, say which runs are of one pouring in a column `session` of the runs";
            let hint = hint.to_owned();
            let verdict = nothing(self.problem, &wide);
            let mut found = self.diagnosis(verdict, &wide, Grounds { hint, ..grounds })?;
            found.strength_reasons.push(StrengthReason::ConditionsDiffer);
            found.strength = Strength::of(&found.strength_reasons);
            return Ok(found);
        }
        let hint = "the model is rejected, and no listed effect helps".to_owned();
        self.refuse(Grounds { hint, ..grounds })
    }

    /// The verdict where the best effect helps by more than chance.
    fn helped(&self, grounds: Grounds) -> Result<Diagnosis, FitError> {
        let leader = without_width(self.problem, &self.leader)?;
        let p_leader = lack_of_fit(self.problem, &leader, self.seed)?;
        let leader = self.name(self.ranking.scores[0].candidate());
        if p_leader.is_none() {
            let why = format!("with {leader} as much is free as was measured: nothing judges it");
            return Ok(cannot_tell(self.problem, why));
        }
        let grounds = Grounds { p_lof_with: p_leader, ..grounds };
        let held_out = HeldOut::judging(self.problem, &self.weighed, &self.leader)?;
        let is_judged = self.problem.forward.is_judged_by_held_out();
        // Real effects do not follow formulas exactly: a lack of fit counts only if held-out conditions show it.
        let is_explained = adequate(p_leader) || (is_judged && held_out.is_within_noise());
        // Grains are asked again, by impacts on fresh beds: there, two are tried only where one is not enough.
        if is_explained && !is_judged && !self.leaves_conditions_apart() {
            return self.one(grounds, held_out);
        }
        if let Some(Two { pair, p_lof: p_lof_with, held_out }) = self.two(is_explained)? {
            let by_chance = pair.p;
            let hint = format!(
                "both are needed (each by chance: {by_chance:.1e} at most), or one effect outside the list"
            );
            let leaves_more = held_out.leaves_more_than_noise() == Some(true);
            let grounds = Grounds { p_lof_with, hint, held_out: Some(held_out), ..grounds };
            let found = self.diagnosis(Verdict::Pair, &pair.fitted, grounds)?;
            return Ok(if leaves_more { of_another_form(found) } else { found });
        }
        // What takes nearly all of a clear error is there, in a form that no formula here has, or not alone.
        let is_most = is_judged && self.alike.len() == 1 && held_out.takes_most();
        let is_named = is_explained || is_most;
        let is_one_of_many = is_named && self.is_one_of_many(p_leader, &held_out)?;
        let is_left = is_named && !is_one_of_many && self.leaves_a_force(&self.leader)?;
        let leaves_a_force = is_left && !self.stands_out();
        if is_named && !is_one_of_many && !leaves_a_force {
            let leaves_more =
                held_out.leaves_more_than_noise() == Some(true) && held_out.leaves_a_part();
            let found = self.one(grounds, held_out)?;
            let is_of_another_form = !adequate(p_leader) || leaves_more || is_left;
            return Ok(match is_of_another_form && !found.effects.is_empty() {
                true => of_another_form(found),
                false => found,
            });
        }
        if is_one_of_many {
            let hint = format!(
                "{leader} is nearest among the listed effects, and a force of another form is about as likely"
            );
            let mut found = self.refuse(Grounds { hint, ..grounds })?;
            found.strength_reasons.push(StrengthReason::NoLikelierThanAnyForce);
            // The verdicts that were counted rest on no effect that explains the data.
            found.probability = None;
            found.strength = Strength::of(&found.strength_reasons);
            return Ok(found);
        }
        let hint = match leaves_a_force {
            true => format!(
                "{leader} is nearest among the listed effects; with it, conditions still differ by more than their repeats show, and \
                 by a force that depends on speed, angle or body"
            ),
            false => explains_a_part(&leader, &held_out),
        };
        match is_judged {
            true => self.refuse(Grounds { hint, ..grounds }),
            // Impacts on fresh beds decide whether what is left matters.
            false => {
                let grounds = Grounds { hint, held_out: Some(held_out), ..grounds };
                self.diagnosis(self.of_the_best(), &self.leader, grounds)
            }
        }
    }

    /// The verdict that names the best effect, or what is not told from it.
    fn of_the_best(&self) -> Verdict {
        match self.alike.len() {
            1 => Verdict::Supported,
            _ => Verdict::NotSeparable,
        }
    }

    /// The hint for conditions that differ by more than their repeats show, if a force of some form explains the differences
    /// far better than beds that are poured anew, which differ at random.
    fn differ_by_a_force(&self) -> Result<Option<String>, FitError> {
        if self.baseline.noise.sessions.gain < SEEN || !self.problem.forward.is_judged_by_held_out()
        {
            return Ok(None);
        }
        let odds = self.of_any_force()?.filter(|odds| *odds >= MORE_THAN_SESSIONS);
        Ok(odds.map(|odds| {
            format!(
                "conditions differ by more than their repeats show, and a force that depends on speed, angle or body \
                 explains this better than beds that are poured anew (log odds {odds:.0})"
            )
        }))
    }

    /// Whether conditions differ with the best effect by more than their repeats show.
    fn leaves_conditions_apart(&self) -> bool {
        self.leader.noise.sessions.gain >= SEEN
    }

    /// Whether the best effect is only the nearest of the listed effects: a force of any form is about as likely. The odds have
    /// to be larger if few conditions show the effect, or if it leaves a part of the error that its predictions do not allow.
    /// Effects that leave none and are not told apart need no odds, since they are several forms themselves, nor does one that
    /// takes most of a clear error.
    fn is_one_of_many(&self, p: Option<f64>, held_out: &HeldOut) -> Result<bool, FitError> {
        let is_misfit = p.is_some_and(|p| p <= DOUBTFUL);
        let leaves_more = held_out.leaves_more_than_noise() == Some(true);
        let leaves = held_out.leaves_a_part() && (is_misfit || leaves_more);
        let explains = !is_misfit && (!leaves || held_out.leaves_what_is_expected());
        let least = match () {
            () if held_out.is_shown_by_few() => LIKELIER,
            () if !leaves && (self.alike.len() > 1 || held_out.takes_most()) => return Ok(false),
            () if explains => NEAREST,
            () if leaves => LIKELIER,
            () => NOT_ANY,
        };
        self.is_no_likelier(&self.leader, least)
    }

    /// Whether the best effect has an amplitude that changes nothing.
    pub(crate) fn leader_is_nil(&self) -> bool {
        self.ranking.scores.first().is_some_and(Score::is_nil)
    }

    /// Whether no other effect explains half of what the best one does. A force that is not listed is about equally far from
    /// several effects; one that is, in another form, is near one of them and leaves a force too.
    fn stands_out(&self) -> bool {
        let falls = |at: usize| self.ranking.scores.get(at).map_or(0.0, |score| score.delta);
        falls(1) < STANDS_OUT * falls(0)
    }

    /// Whether conditions differ with the effects of `fitted` by more than their repeats show, and not as beds do that are poured
    /// anew, at random: a force of some form explains the differences far better.
    fn leaves_a_force(&self, fitted: &Fitted) -> Result<bool, FitError> {
        if fitted.noise.sessions.gain < SEEN || !self.problem.forward.is_judged_by_held_out() {
            return Ok(false);
        }
        is_a_force_left(self.problem, fitted, BESIDE)
    }

    /// Whether the effects of `fitted` exceed a force of any form by less than `least` in log odds.
    fn is_no_likelier(&self, fitted: &Fitted, least: f64) -> Result<bool, FitError> {
        if !self.problem.forward.is_judged_by_held_out() {
            return Ok(false);
        }
        let of_effects = self.log_odds_of(fitted);
        Ok(self.of_any_force()?.zip(of_effects).is_some_and(|(of_any, own)| of_any + least > own))
    }

    /// Log odds of the effects of `fitted` against none; `None` where it has none.
    fn log_odds_of(&self, fitted: &Fitted) -> Option<f64> {
        let has_effects = !fitted.fit.point.effects.is_empty();
        has_effects.then(|| 0.5 * (self.baseline.deviance() - fitted.deviance()))
    }

    /// Log odds of a force of any form against none; `None` where that is not known.
    fn of_any_force(&self) -> Result<Option<f64>, FitError> {
        if self.any_force.get().is_none() {
            let found = any_force(self.problem, &self.baseline)?;
            self.any_force.get_or_init(|| found);
        }
        let known = self.any_force.get().and_then(Option::as_ref);
        Ok(known.map(|any| any.log_odds(&self.baseline)))
    }

    /// The verdict on the best effect alone, with which the model explains what was fitted.
    fn one(&self, grounds: Grounds, held_out: HeldOut) -> Result<Diagnosis, FitError> {
        if held_out.refutes() {
            let leader = self.name(self.ranking.scores[0].candidate());
            let hint = format!(
                "{leader} explains what was fitted, but predicts what was left out worse than without it"
            );
            return self.refuse(Grounds { hint, ..grounds });
        }
        if let Some(hint) = self.needs_an_implausible_apparatus(&self.leader) {
            return self.refuse(Grounds { hint, ..grounds });
        }
        let held_out = Some(held_out);
        if let Some(hint) = held_out.as_ref().and_then(|held_out| self.too_small(held_out)) {
            let grounds = Grounds { hint, held_out, ..grounds };
            return self.diagnosis(Verdict::BelowNoise, &self.baseline, grounds);
        }
        let (p_lof, p_lof_with) = (grounds.p_lof, grounds.p_lof_with);
        let grounds = Grounds { held_out, ..grounds };
        let found = self.diagnosis(self.of_the_best(), &self.leader, grounds)?;
        let mut forces = found.amplitudes.iter().filter_map(|one| one.force.as_ref());
        if forces.any(AddedForce::is_cancelled) {
            let leader = found.effects.join(" and ");
            let hint = format!(
                "{leader} explains the data only if it takes away more resistance than it leaves"
            );
            return self.refuse(Grounds { p_lof, p_lof_with, hint, held_out: None });
        }
        Ok(found)
    }

    /// That the effects of `fitted` explain the data only with an error of the apparatus that nobody's has, in a sentence.
    fn needs_an_implausible_apparatus(&self, fitted: &Fitted) -> Option<String> {
        if !self.problem.forward.is_judged_by_held_out() {
            return None;
        }
        let all = ApparatusError::all(self.problem.forward, fitted);
        let error = all.iter().find(|error| error.is_implausible())?;
        let times = error.value.abs() / error.prior_sigma?;
        let effects = fitted.fit.point.effects.iter().map(|(effect, _)| self.name(*effect));
        Some(format!(
            "{} explains the data only with a {} that is {times:.0} times as far off as it is known: state how well it is \
             known, or look at the apparatus",
            effects.collect::<Vec<_>>().join(" and "),
            error.id
        ))
    }

    /// The two effects that explain the data, if there are two; where one does (`is_explained`), two have to be far more
    /// likely.
    fn two(&self, is_explained: bool) -> Result<Option<Two>, FitError> {
        let pair = best_pair(self.problem, &self.weighed, &self.ranking, self.seed)?;
        let Some(pair) = pair.filter(|pair| pair.p <= ALPHA) else { return Ok(None) };
        if is_explained && self.leader.deviance() - pair.fitted.deviance() < LIKELIER {
            return Ok(None);
        }
        let narrow = without_width(self.problem, &pair.fitted)?;
        let p_lof = lack_of_fit(self.problem, &narrow, self.seed)?;
        let held_out = HeldOut::judging(self.problem, &self.weighed, &pair.fitted)?;
        // Two effects fit what one condition shows more easily than one does.
        let stands = adequate(p_lof)
            && self.needs_an_implausible_apparatus(&pair.fitted).is_none()
            && !held_out.refutes()
            && !held_out.is_shown_by_few()
            && self.too_small(&held_out).is_none()
            && !held_out.leaves_a_third()
            && !self.is_no_likelier(&pair.fitted, NOT_ANY)?
            && !self.leaves_a_force(&pair.fitted)?;
        Ok(stands.then_some(Two { pair, p_lof, held_out }))
    }

    /// The verdict none-of-the-candidates, or below-noise if the model misses held-out conditions by little more than
    /// their noise.
    fn refuse(&self, grounds: Grounds) -> Result<Diagnosis, FitError> {
        let held_out = HeldOut::of(self.problem, &self.baseline, &self.baseline)?;
        let is_small = held_out.is_above_noise() == Some(false);
        let verdict = match is_small && self.problem.forward.is_judged_by_held_out() {
            true => Verdict::BelowNoise,
            false => Verdict::NoneOfTheCandidates,
        };
        let grounds = Grounds { held_out: Some(held_out), ..grounds };
        self.diagnosis(verdict, &self.baseline, grounds)
    }

    /// The reason why an effect with this error on held-out conditions is too small to be named; `None` for an effect that
    /// is large enough.
    fn too_small(&self, held_out: &HeldOut) -> Option<String> {
        if !self.problem.forward.is_judged_by_held_out() {
            return None;
        }
        let best = &self.ranking.scores[0];
        let name = [self.name(best.candidate())];
        held_out.too_small(&name, best.amplitude(), best.standard_error.unwrap_or(0.0))
    }

    pub(crate) fn diagnosis(
        &self,
        verdict: Verdict,
        proposed: &Fitted,
        Grounds { p_lof, p_lof_with, hint, held_out }: Grounds,
    ) -> Result<Diagnosis, FitError> {
        let Self { problem, ranking, .. } = self;
        let leaders: Vec<String> =
            self.alike.iter().map(|&place| self.name(ranking.scores[place].candidate())).collect();
        let not_separable = match verdict {
            Verdict::NotSeparable => leaders.clone(),
            _ => Vec::new(),
        };
        let left_by = match verdict {
            Verdict::NoneOfTheCandidates => &self.baseline,
            _ => proposed,
        };
        let unexplained = unexplained(problem, verdict, left_by, (hint, self.seed))?;
        let before = if proposed.fit.point.effects.is_empty() { proposed } else { &self.weighed };
        let listed = as_listed(problem, proposed)?;
        let amplitudes = amplitudes(problem, &listed);
        let held_out = match held_out {
            Some(known) => known,
            None => HeldOut::of(problem, before, proposed)?,
        };
        // A fit that misses the data says nothing of the apparatus.
        let p_of_proposed = if proposed.fit.point.effects.is_empty() { p_lof } else { p_lof_with };
        let explains = verdict.is_explained() || adequate(p_of_proposed);
        let found = |mut errors: Vec<ApparatusError>| {
            errors.iter_mut().for_each(|error| error.named &= explains);
            errors
        };
        let mut strength_reasons = doubts(problem, proposed, &amplitudes, &held_out);
        if verdict.is_explained() && held_out.is_above_expected() == Some(true) {
            strength_reasons.push(StrengthReason::HeldOutAboveNoise);
        }
        Ok(Diagnosis {
            verdict,
            strength: Strength::of(&strength_reasons),
            probability: match problem.forward.is_judged_by_held_out() {
                true => of_benchmark(verdict),
                false => None,
            },
            evidence: evidence(problem, proposed),
            warnings: warnings(problem, proposed, &amplitudes),
            strength_reasons,
            effects: amplitudes.iter().map(|amplitude| amplitude.id.clone()).collect(),
            not_separable,
            leaders,
            ranking: ranked(problem, Some(ranking)),
            p1: (!ranking.scores.is_empty()).then_some(ranking.p),
            p_lof,
            p_lof_with,
            noise: proposed.noise.to_json(problem.set, problem.forward),
            holdout: Some(held_out),
            unexplained,
            missing_force: None,
            any_force: self.any_force.get().cloned().flatten(),
            log_odds_of_leader: self.log_odds_of(&self.leader),
            apparatus: found(ApparatusError::all(problem.forward, proposed)),
            preparation: ApparatusError::of_preparation(problem.forward, &proposed.fit),
            next: Vec::new(),
            measured: measured(problem.set),
            after: None,
            parameters: parameters(problem.forward, &listed),
            amplitudes,
            amplitude_correlation: correlation(&listed),
            baseline: Some(self.baseline.clone()),
            proposed: Some(proposed.clone()),
        })
    }

    fn name(&self, candidate: usize) -> String {
        self.problem.forward.candidates()[candidate].id.clone()
    }
}

/// `found`, which leaves more than noise.
fn of_another_form(found: Diagnosis) -> Diagnosis {
    let mut found = found;
    found.strength_reasons.push(StrengthReason::OfAnotherForm);
    found.strength = Strength::of(&found.strength_reasons);
    found
}

/// Says that `leader` alone does not explain the data, with the errors on held-out conditions.
fn explains_a_part(leader: &str, held_out: &HeldOut) -> String {
    let does = match held_out.is_no_nearer() {
        true => "fits best and predicts no better",
        false => "explains a part",
    };
    let errors = held_out.in_words().map_or(String::new(), |words| format!(": {words}"));
    format!("no one or two listed effects explain the data; {leader} {does}{errors}")
}

/// The verdict without an effect: it depends on what of the preparation and of the apparatus `fitted` names.
pub(crate) fn nothing(problem: &FitProblem<'_>, fitted: &Fitted) -> Verdict {
    let is_named = |errors: Vec<ApparatusError>| errors.iter().any(|error| error.named);
    if is_named(ApparatusError::of_preparation(problem.forward, &fitted.fit)) {
        Verdict::ExplainedByPreparation
    } else if is_named(ApparatusError::all(problem.forward, fitted)) {
        Verdict::ExplainedByApparatus
    } else {
        Verdict::NothingDetected
    }
}

/// What was left aside of the measurements, and what is unusual of what is named.
fn warnings(problem: &FitProblem<'_>, proposed: &Fitted, amplitudes: &[Amplitude]) -> Vec<String> {
    let between = proposed.noise.sessions;
    let differ = (between.gain >= SEEN).then(|| {
        format!(
            "conditions differ by {}{:.1} % of their resistance beyond what their repeats show{}: if they are of several \
             days or beds, say which in a column `session` of the runs",
            // The search for it ends there.
            if between.sd >= 0.99 * MOST_BETWEEN * between.sigma { "at least " } else { "" },
            100.0 * between.sd,
            if proposed.fit.point.effects.is_empty() { ", as a force does that the model lacks" } else { "" }
        )
    });
    let unusual = amplitudes.iter().filter(|amplitude| amplitude.unusual);
    let unusual = unusual.map(|amplitude| {
        format!("{} of {:.4} is outside of its usual range", amplitude.id, amplitude.q)
    });
    problem.observed.notes.iter().cloned().chain(differ).chain(unusual).collect()
}

/// What `fitted`, which is what `verdict` says, leaves over, and what to try where nothing listed helps.
pub(crate) fn unexplained(
    problem: &FitProblem<'_>,
    verdict: Verdict,
    fitted: &Fitted,
    (hint, seed): (String, u64),
) -> Result<Unexplained, FitError> {
    let remaining = ForceErrors::of(problem, fitted, seed)?;
    let depends_on = match verdict {
        Verdict::NoneOfTheCandidates | Verdict::Pair => remaining.depends_on(),
        _ => remaining.drifts(),
    };
    Ok(Unexplained { depends_on, hint })
}

/// Whether a model leaves no lack of fit; one that leaves nothing to judge by is not adequate.
pub(crate) fn adequate(p_lof: Option<f64>) -> bool {
    p_lof.is_some_and(|p| p > ALPHA)
}

pub(crate) fn cannot_tell(problem: &FitProblem<'_>, why: String) -> Diagnosis {
    Diagnosis {
        measured: measured(problem.set),
        ..Diagnosis::cannot_tell(ranked(problem, None), why)
    }
}

/// The names of all runs of `set`, by condition.
fn measured(set: &MeasurementSet) -> BTreeMap<String, Vec<String>> {
    let mut measured: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for run in &set.runs {
        let condition = set.conditions[run.condition].id.clone();
        measured.entry(condition).or_default().push(run.name.clone());
    }
    measured
}

/// `fitted` where conditions differ by no more than their runs explain: a misfit is judged by those.
fn without_width(problem: &FitProblem<'_>, fitted: &Fitted) -> Result<Fitted, FitError> {
    let noise = Noise { between: 0.0, ..fitted.noise };
    match fitted.noise.between > 0.0 {
        true => problem.fit_once(&fitted.fit.point, &noise),
        false => Ok(fitted.clone()),
    }
}
