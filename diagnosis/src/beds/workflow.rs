//! From a model of grains and a set to a comparison, or to a diagnosis: what is run, in which order, and
//! what is made of it.

use runner::beds::Impacts;
use runner::beds::Job;
use runner::beds::Record;
use serde_json::{Value, json};

use super::baseline::Baseline;
use super::confirmation::Confirmation;
use super::emulator::{BedForward, Screened};
use super::error::BedError;
use super::line_search::{Against, LineSearch};
use super::plan::{LEADERS, Plan, SEARCHES};
use super::response::Response;
use super::screening::screened;
use super::stand::{Draw, Stand};
use super::switch::Switch;
use super::variation::Variation;
use crate::bench::Bench;
use crate::compare::parameters;
use crate::diagnose::{diagnose, withdraw};
use crate::forward::Forward;
use crate::held_out::{HeldOut, WITHIN};
use crate::observable::Layout;
use crate::observed::Observed;
use crate::rounding::rounded;
use crate::sensitivity::Point;
use crate::verdict::{Diagnosis, Status, Strength, StrengthReason, Verdict};

/// Where they correlate more than this, effects are screened one at a time: what each does alone is worth
/// more than what half of the runs of a design would save.
const ALONE: f64 = 0.5;

/// Most frames of a condition that a diagnosis looks at: of neighbours in time a few dozen runs cannot tell
/// what one says beside the other, and a covariance that seems to would veto what is true.
const FRAMES: usize = 12;

/// Draws of a comparison.
pub const COMPARED: usize = 6;

/// A diagnosis of a bed of grains.
pub struct BedDiagnosis {
    /// What it says.
    pub diagnosis: Diagnosis,
    /// The model that it was made with.
    pub forward: BedForward,
    /// The conditions that were fitted to, and none else.
    pub observed: Observed,
    /// What was confirmed with fresh beds; none where nothing was named, or nothing is held out.
    pub confirmation: Option<Confirmation>,
    /// Correlation of depths of two runs on one draw; none where no pair was run.
    pub correlation: Option<f64>,
    /// What is run in all.
    pub plan: Plan,
    /// Impacts of this diagnosis, those that were kept counted.
    pub impacts: usize,
}

/// The model of `stand` as it is, under all conditions of the set that have something to compare.
///
/// # Errors
/// If the impacts cannot be run, or say nothing.
pub fn bed_forward(
    stand: &Stand<'_>,
    observed: &Observed,
    place: &dyn Impacts,
) -> Result<BedForward, BedError> {
    let records = place.run(&compare_jobs(stand, observed)?)?;
    let mut by_condition = vec![Vec::new(); observed.conditions.len()];
    let conditions = observed.fit.iter().chain(&observed.holdout);
    for (&condition, runs) in conditions.zip(records.chunks(COMPARED)) {
        by_condition[condition] = runs.iter().flatten().cloned().collect();
    }
    let baseline = Baseline::of(stand, &observed.layouts(), &by_condition)?;
    Ok(BedForward::new(baseline, Vec::new(), &[], &[]))
}

/// What [`bed_forward`] would run.
///
/// # Errors
/// If a condition is no model.
pub fn compare_jobs(stand: &Stand<'_>, observed: &Observed) -> Result<Vec<Job>, BedError> {
    let conditions = [&observed.fit[..], &observed.holdout].concat();
    let draws = stand.draws(0, COMPARED, conditions.len());
    Ok(stand.jobs(&conditions, &draws, &Variation::default())?)
}

/// Impacts of the model as it stands, which others are held against.
#[derive(Clone, Copy)]
struct Standing<'a> {
    /// One list per condition.
    draws: &'a [Vec<Draw>],
    /// Likewise; none where one did not end.
    runs: &'a [Vec<Option<Record>>],
    /// Of two runs on one draw.
    correlation: f64,
}

/// A diagnosis under way.
struct Work<'a> {
    stand: &'a Stand<'a>,
    place: &'a dyn Impacts,
    plan: Plan,
    layouts: Vec<Layout>,
    /// The set, with the conditions of the plan alone to fit to.
    observed: Observed,
    seed: u64,
    impacts: usize,
}

/// Diagnoses the model of `stand` by the runs of `plan`; of a plan that does not fit its budget
/// [`unaffordable`] says what there is to say.
///
/// # Errors
/// If the impacts cannot be run, or say nothing.
pub fn diagnose_bed(
    stand: &Stand<'_>,
    measured: &Observed,
    place: &dyn Impacts,
    plan: Plan,
    seed: u64,
) -> Result<BedDiagnosis, BedError> {
    let measured = measured.thinned(FRAMES);
    let mut observed = measured.clone();
    observed.fit = plan.fit.clone();
    // What is held out is judged by impacts, and not by what is made of others.
    observed.holdout = Vec::new();
    let layouts = measured.layouts();
    let work = Work { stand, place, plan, layouts, observed, seed, impacts: 0 };
    work.diagnose(&measured)
}

impl Work<'_> {
    fn diagnose(mut self, measured: &Observed) -> Result<BedDiagnosis, BedError> {
        let draws = self.plan.draws(self.stand);
        let jobs = self.plan.baseline_jobs(self.stand, &draws.fit)?;
        let records = self.run(&jobs)?;
        let runs: Vec<Vec<Option<Record>>> =
            records.chunks(self.plan.size.draws).map(<[_]>::to_vec).collect();
        let correlation = self.correlation(&draws.fit, &runs)?;
        let mut by_condition = vec![Vec::new(); self.layouts.len()];
        for (&condition, runs) in self.plan.fit.iter().zip(&runs) {
            by_condition[condition] = runs.iter().flatten().cloned().collect();
        }
        let baseline = Baseline::of(self.stand, &self.layouts, &by_condition)?;

        let screening = self.plan.screening(self.stand);
        let paired = correlation.unwrap_or(0.0).clamp(0.0, 0.9);
        let standing = Standing { draws: &draws.fit, runs: &runs, correlation: paired };
        let screened = if paired > ALONE {
            self.one_at_a_time(&screening.switches, &baseline, standing)?
        } else {
            let records = self.run(&screening.jobs(self.stand)?)?;
            screening.signatures(self.stand, &self.layouts, &records, (paired, &baseline))
        };
        let wish = &self.plan.wish;
        let mut forward = BedForward::new(baseline, screened, &wish.free, &wish.apparatus());

        let mut diagnosis = self.judge(&forward)?;
        let mut searched: Vec<usize> = Vec::new();
        for _ in 0..SEARCHES {
            let leaders = leaders(&diagnosis, &forward, &searched);
            if leaders.is_empty() {
                break;
            }
            for (at, guess) in leaders {
                searched.push(at);
                self.refine(&mut forward, (at, guess), standing)?;
            }
            diagnosis = self.judge(&forward)?;
        }
        let confirmation = self.confirm(&forward, &diagnosis, &draws.confirm, measured)?;
        let mut diagnosis = match &confirmation {
            Some(confirmation) => self.held_against(diagnosis, &forward, confirmation)?,
            None => diagnosis,
        };
        self.weigh(&mut diagnosis, confirmation.as_ref());
        let confirmation = confirmation.filter(|_| !diagnosis.amplitudes.is_empty());
        let Self { observed, plan, impacts, .. } = self;
        Ok(BedDiagnosis { diagnosis, forward, observed, confirmation, correlation, plan, impacts })
    }

    fn run(&mut self, jobs: &[Job]) -> Result<Vec<Option<Record>>, BedError> {
        self.impacts += jobs.len();
        Ok(self.place.run(jobs)?)
    }

    fn judge(&self, forward: &BedForward) -> Result<Diagnosis, BedError> {
        let bench = Bench { set: self.stand.set, observed: &self.observed, forward };
        Ok(diagnose(&bench, self.seed)?)
    }

    /// Correlation of the depths of two runs on one draw, from the scatter of their differences: it costs
    /// one degree of freedom less than a coefficient of Pearson, and is below it where the change of the
    /// parameter changes the scatter. None from fewer than three pairs.
    fn correlation(
        &mut self,
        draws: &[Vec<Draw>],
        runs: &[Vec<Option<Record>>],
    ) -> Result<Option<f64>, BedError> {
        let again = self.plan.rerun_jobs(self.stand, draws)?;
        let again = self.run(&again)?;
        let Some(first) = runs.get(self.plan.middle()) else { return Ok(None) };
        let pairs: Vec<[f64; 2]> = first
            .iter()
            .zip(&again)
            .filter_map(|(a, b)| Some([a.as_ref()?.deepest, b.as_ref()?.deepest]))
            .collect();
        if pairs.len() < 3 {
            return Ok(None);
        }
        let variance = |values: Vec<f64>| {
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            values.iter().map(|value| (value - mean).powi(2)).sum::<f64>()
        };
        let of = |at: usize| variance(pairs.iter().map(|pair| pair[at]).collect());
        let difference = variance(pairs.iter().map(|[a, b]| a - b).collect());
        let both = of(0) + of(1);
        Ok((both > 0.0).then(|| 1.0 - difference / both))
    }

    fn refine(
        &mut self,
        forward: &mut BedForward,
        (at, guess): (usize, f64),
        standing: Standing<'_>,
    ) -> Result<(), BedError> {
        let (draws, fit) = (self.searched(standing.draws), self.plan.fit.clone());
        let search = LineSearch::around(forward.screened()[at].switch, guess, &fit, &draws);
        let Some(responses) = self.search(&search, forward.baseline(), standing)? else {
            return Ok(());
        };
        let tried = search.tried();
        forward.refine(at, responses, tried);
        Ok(())
    }

    /// Those of `draws` that a switch alone is tried on.
    fn searched(&self, draws: &[Vec<Draw>]) -> Vec<Vec<Draw>> {
        let most = self.plan.size.line_draws;
        draws.iter().map(|draws| draws[..most.min(draws.len())].to_vec()).collect()
    }

    /// What every switch does alone, at the amplitude that is screened.
    fn one_at_a_time(
        &mut self,
        switches: &[&'static Switch],
        baseline: &Baseline,
        standing: Standing<'_>,
    ) -> Result<Vec<Screened>, BedError> {
        let (draws, fit) = (self.searched(standing.draws), self.plan.fit.clone());
        let mut all = Vec::with_capacity(switches.len());
        let runs_of_all = switches.len() * draws.iter().map(Vec::len).sum::<usize>();
        for &switch in switches {
            let search = LineSearch::once(switch, &fit, &draws);
            let found = self.search(&search, baseline, standing)?;
            let responses = found.unwrap_or_else(|| vec![None; self.layouts.len()]);
            all.push(screened(switch, responses, (baseline, runs_of_all)));
        }
        Ok(all)
    }

    /// The responses that `search` finds; none where the step of the model is too long for an amplitude:
    /// then what screening found has to do.
    fn search(
        &mut self,
        search: &LineSearch<'_>,
        baseline: &Baseline,
        Standing { runs, correlation, .. }: Standing<'_>,
    ) -> Result<Option<Vec<Option<Response>>>, BedError> {
        let Ok(jobs) = search.jobs(self.stand) else { return Ok(None) };
        let records = self.run(&jobs)?;
        let n = search.draws.first().map_or(0, Vec::len);
        let against = Against {
            layouts: &self.layouts,
            baseline: runs
                .iter()
                .map(|runs| runs[..n].iter().map(Option::as_ref).collect())
                .collect(),
            means: baseline.observed.conditions.iter().map(|one| &one.mean).collect(),
            spread: &baseline.spread,
            correlation,
        };
        Ok(Some(search.responses(self.stand, &records, &against)))
    }

    fn confirm(
        &mut self,
        forward: &BedForward,
        diagnosis: &Diagnosis,
        draws: &[Vec<Draw>],
        measured: &Observed,
    ) -> Result<Option<Confirmation>, BedError> {
        let named =
            matches!(diagnosis.verdict, Verdict::Supported | Verdict::NotSeparable | Verdict::Pair);
        let (Some(proposed), true) = (&diagnosis.proposed, named && !self.plan.confirm.is_empty())
        else {
            return Ok(None);
        };
        let point = &proposed.fit.point;
        let change = change_at(self.stand, forward, point);
        let conditions = self.plan.confirm.clone();
        let mut records = Vec::with_capacity(2);
        for variation in [Variation::default(), change] {
            let Ok(jobs) = self.stand.jobs(&conditions, draws, &variation) else {
                return Ok(None);
            };
            records.push(self.run(&jobs)?);
        }
        let runs = (conditions.as_slice(), [&records[0][..], &records[1][..]]);
        Ok(Some(Confirmation::of(self.stand, measured, (forward, point), runs)?))
    }

    /// Has the verdict rest on what was confirmed: what has its impacts miss fresh beds by more than without it, and
    /// by more than noise, is not named.
    fn held_against(
        &self,
        mut diagnosis: Diagnosis,
        forward: &BedForward,
        Confirmation { held_out, .. }: &Confirmation,
    ) -> Result<Diagnosis, BedError> {
        if self.plan.held_out || diagnosis.holdout.is_none() {
            diagnosis.holdout = Some(held_out.clone());
        }
        let HeldOut {
            before: Some(before),
            after: Some(after),
            noise_floor: Some(noise_floor),
            ..
        } = *held_out
        else {
            return Ok(diagnosis);
        };
        if !self.plan.supports || after < before {
            return Ok(diagnosis);
        }
        if after <= WITHIN * noise_floor {
            diagnosis.unexplained.hint =
                "impacts with it, on fresh beds, are no nearer to what was held out".to_owned();
            return Ok(diagnosis);
        }
        let why = format!(
            "{} would explain what was fitted to, but impacts with it, on fresh beds, miss what was held out by \
             {:.2} times the noise, and without it by {:.2}",
            diagnosis.leaders.join(" or "),
            after / noise_floor,
            before / noise_floor,
        );
        diagnosis.holdout =
            Some(HeldOut { after: Some(before), log_density_gain: 0.0, ..held_out.clone() });
        let bench = Bench { set: self.stand.set, observed: &self.observed, forward };
        Ok(withdraw(&bench, diagnosis, why, self.seed)?)
    }

    /// How much the verdict weighs.
    fn weigh(&self, diagnosis: &mut Diagnosis, confirmation: Option<&Confirmation>) {
        let nearer = |one: &Confirmation| {
            let errors = one.held_out.before.zip(one.held_out.after);
            errors.is_some_and(|(before, after)| after < before)
        };
        let reasons = &mut diagnosis.strength_reasons;
        if !self.plan.supports {
            reasons.push(StrengthReason::SmallPlan);
        }
        if !confirmation.is_none_or(nearer) {
            reasons.push(StrengthReason::FreshBedsNoNearer);
        }
        if !reasons.is_empty() {
            diagnosis.strength = Strength::Suggested;
        }
        let lost = |effect: &crate::verdict::RankedEffect| effect.status != Status::Ranked;
        if diagnosis.verdict == Verdict::CannotTell && diagnosis.ranking.iter().all(lost) {
            let why = diagnosis.ranking.iter().map(|effect| effect.note.as_str());
            diagnosis.unexplained.hint = why.max_by_key(|why| why.len()).unwrap_or("").to_owned();
        }
    }
}

/// What there is to say where the budget of `plan` does not pay for it.
#[must_use]
pub fn unaffordable(plan: &Plan) -> Diagnosis {
    let minutes = |seconds: f64| (seconds / 60.0).ceil();
    let why = format!(
        "the smallest plan takes about {} min with {} impacts at a time, and the budget is {} min: \
         --budget \"{} min\" would do, or fewer candidates",
        minutes(plan.seconds()),
        plan.workers,
        minutes(plan.wish.budget.unwrap_or(0.0)),
        minutes(1.1 * plan.seconds()),
    );
    Diagnosis::cannot_tell(Vec::new(), why)
}

/// The switches to be searched that were not yet, with the guess of each: the first two of the first few, whatever
/// of the apparatus leads them, and of what cannot be told from the leader. A screening sees an effect beside all
/// others, so who is behind may be so for want of a search. None where nothing is named.
fn leaders(diagnosis: &Diagnosis, forward: &BedForward, searched: &[usize]) -> Vec<(usize, f64)> {
    if matches!(diagnosis.verdict, Verdict::NothingDetected | Verdict::CannotTell) {
        return Vec::new();
    }
    let candidates = Forward::candidates(forward);
    let switches = diagnosis.ranking.iter().filter_map(|effect| {
        let index = candidates.iter().position(|one| one.id == effect.id)?;
        Some((forward.switch(index)?, effect.q?, diagnosis.leaders.contains(&effect.id)))
    });
    switches
        .enumerate()
        .filter(|(rank, (at, _, leads))| {
            (*rank < SEARCHES * LEADERS || *leads) && !searched.contains(at)
        })
        .map(|(_, (at, guess, _))| (at, guess))
        .take(LEADERS)
        .collect()
}

/// The model with the switches of `point` at their amplitudes.
fn change_at(stand: &Stand<'_>, forward: &BedForward, point: &Point) -> Variation {
    let parameters = forward.free().iter().copied().zip(point.parameters.iter().copied());
    let effects = point.effects.iter().filter_map(|&(at, q)| Some((forward.switch(at)?, q)));
    parameters.chain(effects).fold(Variation::default(), |all, (at, q)| {
        all.and(forward.screened()[at].switch.change(stand.grains(), q))
    })
}

impl BedDiagnosis {
    /// The diagnosis as one JSON object, with what was learned of the beds.
    ///
    /// # Errors
    /// Never for a diagnosis that this crate made.
    pub fn to_json(&self, stand: &Stand<'_>) -> serde_json::Result<Value> {
        let mut object = self.diagnosis.to_json()?;
        object["bed"] = json!({
            "scatter": self.forward.scatter(stand.set),
            "correlation_on_one_draw": self.correlation.map(rounded),
            "force_law": self.located(stand),
            "seeds": self.seeds(stand),
        });
        object["ledger"] = self.confirmation.as_ref().map_or(Value::Null, Confirmation::ledger);
        object["cost"] = json!({ "impacts": self.impacts, "plan": self.plan.to_json(stand) });
        Ok(object)
    }

    /// The model with the switches of each effect that is worth adding, as a name and a model file; what the
    /// apparatus does is no part of a bed.
    ///
    /// # Errors
    /// If a changed model is none.
    pub fn proposals(
        &self,
        stand: &Stand<'_>,
    ) -> Result<Vec<(String, String)>, configs::ConfigError> {
        let named = &self.diagnosis;
        let points: Vec<Point> = match named.verdict {
            Verdict::Supported | Verdict::Pair => {
                named.proposed.iter().map(|fitted| fitted.fit.point.clone()).collect()
            }
            Verdict::NotSeparable => named
                .ranking
                .iter()
                .filter(|effect| named.not_separable.contains(&effect.id))
                .filter_map(|effect| effect.point.clone())
                .collect(),
            _ => Vec::new(),
        };
        let mut proposals = Vec::new();
        for point in points {
            let ids = self.forward.of_the_bed(&point.effects);
            if !ids.is_empty() {
                let text = stand.proposal(&change_at(stand, &self.forward, &point))?;
                proposals.push((format!("model+{}.toml", ids.join("+")), text));
            }
        }
        Ok(proposals)
    }

    /// The two terms of the force law that comes nearest to the runs of the model, and to what was
    /// measured: which term is off, whatever it is by.
    fn located(&self, stand: &Stand<'_>) -> Value {
        let baseline = self.forward.baseline();
        let law = &baseline.stand_in.forward;
        let bench = Bench { set: stand.set, observed: &self.observed, forward: law };
        let measured = bench.fit(&Point::start(law)).ok();
        json!({
            "of_the_model": parameters(law, &baseline.fitted.fit),
            "of_what_was_measured": measured.map(|fitted| parameters(law, &fitted.fit)),
        })
    }

    fn seeds(&self, stand: &Stand<'_>) -> Value {
        let draws = self.plan.draws(stand);
        let of = |draws: &[Vec<Draw>]| {
            let mut seeds: Vec<u64> = draws.iter().flatten().map(|draw| draw.seed).collect();
            seeds.sort_unstable();
            seeds.dedup();
            seeds
        };
        json!({ "baseline": of(&draws.fit), "confirmation": of(&draws.confirm) })
    }
}
