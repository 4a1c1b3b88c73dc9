//! From a model of grains and a set to a comparison, or to a diagnosis: what is run, in which order, and
//! what is made of it.

use runner::beds::Impacts;
use runner::beds::Job;
use runner::beds::Record;

use super::baseline::Baseline;
use super::bed_model::{BedModel, Draw};
use super::confirmation::Confirmation;
use super::emulator::BedForward;
use super::error::BedError;
use super::found::{BedDiagnosis, change_at};
use super::leaders::{is_beaten, leaves_room};
use super::observables::observables;
use super::plan::{Plan, RIVALS, SIDE_DRAWS};
use super::preparation::{Known, Preparation, UNTOLD, at_level, dense, listed};
use super::response::correlation_of_pairs;
use super::shared::{Column, Shared};
use super::variation::Variation;
use super::work::{Standing, Work};
use crate::diagnose::{ALPHA, as_it_is, withdraw};
use crate::fit::Fit;
use crate::fit::problem::{FitError, FitProblem};
use crate::forward::apparatus::is_looked_for;
use crate::forward::{Parameter, ParameterKind};
use crate::misfit::held_out::HeldOut;
use crate::observed::Observed;
use crate::verdict::frequency::of_bed_benchmark;
use crate::verdict::{Diagnosis, RankedEffect, Status, Strength, StrengthReason, Verdict};

/// Where they correlate more than this, effects are screened one at a time: what each does alone is worth
/// more than what half of the runs of a design would save.
const ALONE: f64 = 0.5;

/// Most frames of a condition that a diagnosis looks at: of neighbours in time a few dozen runs cannot tell
/// what one says beside the other, and a covariance that seems to would veto what is true.
const FRAMES: usize = 12;

/// Least difference of the packing fractions of loose and dense beds that says how observables follow it.
const LEAST_DIFFERENCE: f64 = 0.002;

/// Farthest that a packing fraction is searched from what is known of it.
const MOST_PACKING: f64 = 0.2;

/// Draws of a comparison.
pub const COMPARED: usize = 6;

/// `bed_model` as it is, under all conditions of the set that have something to compare.
pub fn bed_forward(
    bed_model: &BedModel<'_>,
    observed: &Observed,
    place: &dyn Impacts,
) -> Result<BedForward, BedError> {
    let records = place.run(&compare_jobs(bed_model, observed)?)?;
    let mut by_condition = vec![Vec::new(); observed.conditions.len()];
    let conditions = observed.fit.iter().chain(&observed.holdout);
    for (&condition, runs) in conditions.zip(records.chunks(COMPARED)) {
        by_condition[condition] = runs.iter().flatten().cloned().collect();
    }
    let baseline = Baseline::of(bed_model, &observed.layouts(), &by_condition)?;
    let shared = Shared::of_apparatus(bed_model.set, &observed.layouts(), &baseline.stand_in);
    Ok(BedForward::new(baseline, shared.map_err(FitError::from)?))
}

/// What [`bed_forward`] would run.
///
/// # Errors
/// If a condition is no model.
pub fn compare_jobs(bed_model: &BedModel<'_>, observed: &Observed) -> Result<Vec<Job>, BedError> {
    let conditions = [&observed.fit[..], &observed.holdout].concat();
    let draws = bed_model.draws(0, COMPARED, conditions.len());
    Ok(bed_model.jobs(&conditions, &draws, &Variation::default())?)
}

/// Draws of beds that nothing was fitted to, one list per condition that confirms, and the impacts of the unchanged model on
/// them.
type Fresh<'a> = (&'a [Vec<Draw>], &'a [Option<Record>]);

/// Diagnoses `bed_model` by the runs of `plan`; of a plan that does not fit its budget
/// [`unaffordable`](super::unaffordable) says what there is to say. First the model is prepared to what the set states of its bed.
pub fn diagnose_bed(
    bed_model: &BedModel<'_>,
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
    let preparation = Preparation::of(bed_model, place)?;
    let prepared = bed_model.prepared(&preparation.changes)?;
    let bed_model = BedModel::new(&prepared, bed_model.set)?;
    let work = Work {
        bed_model: &bed_model,
        place,
        plan,
        layouts,
        observed,
        seed,
        impacts: 0,
        preparation,
    };
    work.diagnose(&measured)
}

impl Work<'_> {
    fn diagnose(mut self, measured: &Observed) -> Result<BedDiagnosis, BedError> {
        let draws = self.plan.draws(self.bed_model);
        let jobs = self.plan.baseline_jobs(self.bed_model, &draws.fit)?;
        let records = self.run(&jobs)?;
        let runs: Vec<Vec<Option<Record>>> =
            records.chunks(self.plan.size.draws).map(<[_]>::to_vec).collect();
        let correlation = self.correlation(&draws.fit, &runs)?;
        let mut by_condition = vec![Vec::new(); self.layouts.len()];
        for (&condition, runs) in self.plan.fit.iter().zip(&runs) {
            by_condition[condition] = runs.iter().flatten().cloned().collect();
        }
        let baseline = Baseline::of(self.bed_model, &self.layouts, &by_condition)?;
        let shared = Shared::of_apparatus(self.bed_model.set, &self.layouts, &baseline.stand_in);
        let mut shared = shared.map_err(FitError::from)?;
        self.add_packing(&mut shared, &baseline, (&draws.fit, &draws.confirm))?;
        let forward = BedForward::new(baseline, shared);

        let confirm = self.plan.confirm.clone();
        let jobs = self.bed_model.jobs(&confirm, &draws.confirm, &Variation::default())?;
        let plain = self.run(&jobs)?;
        if let Some(diagnosis) = self.at_once(&forward, measured, &plain)? {
            return self.done(diagnosis, forward, None, correlation);
        }

        let screening = self.plan.screening(self.bed_model);
        let paired = correlation.unwrap_or(0.0).clamp(0.0, 0.9);
        let standing = Standing { draws: &draws.fit, runs: &runs, correlation: paired };
        let baseline = forward.baseline();
        let screened = if paired > ALONE {
            self.one_at_a_time(&screening.bed_candidates, baseline, standing)?
        } else {
            let records = self.run(&screening.jobs(self.bed_model)?)?;
            screening.signatures(self.bed_model, &self.layouts, &records, (paired, baseline))
        };
        let wish = &self.plan.wish;
        let set = self.bed_model.set;
        let mut of_laws = wish.apparatus();
        of_laws.retain(|id| !is_looked_for(set, id));
        let mut forward = forward.with(screened, &wish.free, &of_laws);

        let fresh = (&draws.confirm[..], &plain[..]);
        let mut searched = Vec::new();
        let mut diagnosis = self.settle(&mut forward, &mut searched, standing)?;
        let mut confirmation = self.confirm(&forward, &diagnosis, fresh, measured)?;
        if leaves_room(&diagnosis, confirmation.as_ref().map(|one| &one.held_out))
            && self.search_lost(&mut forward, &mut searched, standing)?
        {
            diagnosis = self.settle(&mut forward, &mut searched, standing)?;
            confirmation = self.confirm(&forward, &diagnosis, fresh, measured)?;
        }
        let mut diagnosis = self.held_against(diagnosis, &forward, confirmation.as_ref())?;
        if let Some(leader) = &confirmation {
            self.narrow(&mut diagnosis, &forward, (leader, fresh), measured)?;
        }
        if let (None, Some(baseline)) = (&confirmation, &diagnosis.baseline) {
            let fresh = self.unchanged(&forward, &baseline.fit, measured, &plain)?;
            if fresh.before.is_some() {
                diagnosis.rest_on(fresh);
            }
        }
        self.weigh(&mut diagnosis, confirmation.as_ref());
        let confirmation = confirmation.filter(|_| !diagnosis.amplitudes.is_empty());
        self.done(diagnosis, forward, confirmation, correlation)
    }

    /// The end, with what is said of the preparation.
    fn done(
        self,
        mut diagnosis: Diagnosis,
        forward: BedForward,
        confirmation: Option<Confirmation>,
        correlation: Option<f64>,
    ) -> Result<BedDiagnosis, BedError> {
        let Self { bed_model, observed, plan, impacts, preparation, .. } = self;
        diagnosis.preparation = listed(&preparation, diagnosis.preparation);
        let baseline = diagnosis.baseline.as_ref();
        let is_strained = baseline.is_some_and(|one| forward.is_strained(&one.fit));
        if diagnosis.verdict.is_explained() && diagnosis.preparation.iter().any(|one| one.named) {
            diagnosis.verdict = Verdict::ExplainedByPreparation;
        } else if diagnosis.verdict == Verdict::ExplainedByPreparation
            || (diagnosis.verdict == Verdict::NothingDetected && is_strained)
        {
            // Only a bed that the set rules out would explain what no effect is large enough for.
            diagnosis.verdict = Verdict::BelowNoise;
        }
        if diagnosis.verdict == Verdict::ExplainedByPreparation && preparation.is_assumed {
            diagnosis.unexplained.hint = UNTOLD.to_owned();
        }
        let names = !diagnosis.effects.is_empty();
        diagnosis.probability = of_bed_benchmark(diagnosis.verdict, names);
        diagnosis.warnings.splice(0..0, preparation.sentences.iter().cloned());
        let changes = preparation.changes;
        let mut found = BedDiagnosis {
            diagnosis,
            forward,
            observed,
            confirmation,
            correlation,
            plan,
            impacts,
            changes,
        };
        if found.diagnosis.verdict == Verdict::NoneOfTheCandidates {
            found.seek_missing_force(bed_model.set)?;
        }
        Ok(found)
    }

    /// Adds the packing fraction to what all runs share: impacts on looser and on denser beds say how the observables
    /// follow it, also under the conditions that confirm. Where a model has no preparation to change, it has none.
    fn add_packing(
        &mut self,
        shared: &mut Shared,
        baseline: &Baseline,
        (fit, confirm): (&[Vec<Draw>], &[Vec<Draw>]),
    ) -> Result<(), BedError> {
        let Some(prior) = self.preparation.packing else { return Ok(()) };
        let conditions = [&self.plan.fit[..], &self.plan.confirm].concat();
        let few = |draws: &[Vec<Draw>]| -> Vec<Vec<Draw>> {
            draws.iter().map(|draws| draws[..SIDE_DRAWS.min(draws.len())].to_vec()).collect()
        };
        let draws = [few(fit), few(confirm)].concat();
        let mut sides = Vec::new();
        let dense = dense(self.bed_model.grains().medium.space).first();
        for &level in [1.0].iter().chain(dense) {
            let Some(changes) = at_level(self.bed_model.grains(), level) else { return Ok(()) };
            let variation = Variation { before: changes, during: Vec::new() };
            let Ok(jobs) = self.bed_model.jobs(&conditions, &draws, &variation) else { continue };
            let lies = self.place.lies(&jobs)?;
            let packing = Known::of(&lies, |one| one.packing_fraction).value;
            sides.push((packing, self.run(&jobs)?));
        }
        let [(loose, on_loose), (dense, on_dense)] = &sides[..] else { return Ok(()) };
        let between = dense - loose;
        if between.abs() < LEAST_DIFFERENCE {
            return Ok(());
        }
        let mut columns = vec![None; self.layouts.len()];
        let mut start = 0;
        for (&condition, draws) in conditions.iter().zip(&draws) {
            let of_condition = start..start + draws.len();
            start = of_condition.end;
            let seen = |records: &[Option<Record>]| {
                let runs = records[of_condition.clone()].iter().flatten();
                let (layout, of_set) =
                    (&self.layouts[condition], &self.bed_model.set.conditions[condition]);
                runs.map(|run| observables(run, layout, of_set, self.bed_model.set))
                    .collect::<Vec<_>>()
            };
            let sides = [seen(on_loose), seen(on_dense)];
            columns[condition] = Column::across(&sides, between, &baseline.spread[condition]);
        }
        let parameter = Parameter {
            name: "packing".to_owned(),
            unit: "1".to_owned(),
            start: prior.mean,
            min: prior.mean - MOST_PACKING,
            max: prior.mean + MOST_PACKING,
            prior: Some(prior),
            kind: ParameterKind::Preparation,
        };
        shared.add(parameter, columns);
        Ok(())
    }

    /// Correlation of the depths of two runs on one draw; none from fewer than three pairs.
    fn correlation(
        &mut self,
        draws: &[Vec<Draw>],
        runs: &[Vec<Option<Record>>],
    ) -> Result<Option<f64>, BedError> {
        let again = self.plan.rerun_jobs(self.bed_model, draws)?;
        let again = self.run(&again)?;
        let Some(first) = runs.get(self.plan.middle()) else { return Ok(None) };
        let pairs: Vec<[f64; 2]> = first
            .iter()
            .zip(&again)
            .filter_map(|(a, b)| Some([a.as_ref()?.deepest, b.as_ref()?.deepest]))
            .collect();
        Ok(correlation_of_pairs(&pairs))
    }

    fn confirm(
        &mut self,
        forward: &BedForward,
        diagnosis: &Diagnosis,
        (draws, plain): Fresh<'_>,
        measured: &Observed,
    ) -> Result<Option<Confirmation>, BedError> {
        let (Some(proposed), Some(baseline)) = (&diagnosis.proposed, &diagnosis.baseline) else {
            return Ok(None);
        };
        if !diagnosis.verdict.names_effects() || self.plan.confirm.is_empty() {
            return Ok(None);
        }
        self.on_fresh_beds(forward, [&baseline.fit, &proposed.fit], (draws, plain), measured)
    }

    /// What fresh beds say of the model as it is and of the one with effects, in these two fits.
    fn on_fresh_beds(
        &mut self,
        forward: &BedForward,
        [baseline, proposed]: [&Fit; 2],
        (draws, plain): Fresh<'_>,
        measured: &Observed,
    ) -> Result<Option<Confirmation>, BedError> {
        let alone = proposed.without_effects();
        // What no preparation and no apparatus can be expected to do is no explanation of the model as it is.
        let before = if forward.is_strained(baseline) { &alone } else { baseline };
        let conditions = self.plan.confirm.clone();
        let change = change_at(self.bed_model, forward, &proposed.point);
        let Ok(jobs) = self.bed_model.jobs(&conditions, draws, &change) else { return Ok(None) };
        let with = self.run(&jobs)?;
        let runs = (conditions.as_slice(), [plain, &with[..]]);
        Ok(Some(Confirmation::of(self.bed_model, measured, (forward, [before, proposed]), runs)?))
    }

    /// Takes out of what `diagnosis` does not tell apart what the fresh beds on which the leader was confirmed tell from it.
    fn narrow(
        &mut self,
        diagnosis: &mut Diagnosis,
        forward: &BedForward,
        (leader, (draws, plain)): (&Confirmation, Fresh<'_>),
        measured: &Observed,
    ) -> Result<(), BedError> {
        let (Some(proposed), Some(baseline)) = (&diagnosis.proposed, &diagnosis.baseline) else {
            return Ok(());
        };
        if diagnosis.verdict != Verdict::NotSeparable {
            return Ok(());
        }
        let mut beaten = Vec::new();
        let rivals = diagnosis.leaders.iter().filter(|id| !diagnosis.effects.contains(id));
        for id in rivals.take(RIVALS) {
            let ranked = diagnosis.ranking.iter().find(|effect| effect.id == *id);
            let Some(point) = ranked.and_then(|effect| effect.point.as_ref()) else { continue };
            let problem = FitProblem { set: self.bed_model.set, observed: &self.observed, forward };
            let Ok(fitted) = problem.fit_once(point, &proposed.noise) else { continue };
            let fits = [&baseline.fit, &fitted.fit];
            let fresh = self.on_fresh_beds(forward, fits, (draws, plain), measured)?;
            if fresh.is_some_and(|fresh| is_beaten(&fresh.held_out, &leader.held_out)) {
                beaten.push(id.clone());
            }
        }
        diagnosis.leaders.retain(|id| !beaten.contains(id));
        diagnosis.not_separable.retain(|id| !beaten.contains(id));
        if diagnosis.not_separable.len() == 1 {
            diagnosis.verdict = Verdict::Supported;
            diagnosis.not_separable.clear();
        }
        for effect in diagnosis.ranking.iter_mut().filter(|effect| beaten.contains(&effect.id)) {
            effect.note =
                "on fresh beds it misses held-out conditions by more than noise".to_owned();
        }
        Ok(())
    }

    /// The diagnosis where fresh impacts of the model as it is, `plain`, already say that no effect could be named, or
    /// where nothing is held out and nothing is left to be explained; `None` where effects are worth a look.
    fn at_once(
        &self,
        forward: &BedForward,
        measured: &Observed,
        plain: &[Option<Record>],
    ) -> Result<Option<Diagnosis>, BedError> {
        let problem = FitProblem { set: self.bed_model.set, observed: &self.observed, forward };
        let mut diagnosis = as_it_is(&problem, self.seed)?;
        let Some(baseline) = &diagnosis.baseline else { return Ok(Some(diagnosis)) };
        let fit = &baseline.fit;
        let fresh = self.unchanged(forward, fit, measured, plain)?;
        let is_above = match forward.is_strained(fit) {
            true => Some(true),
            false => fresh.is_above_noise(),
        };
        let is_rejected = diagnosis.p_lof.is_none_or(|p| p <= ALPHA);
        if is_above == Some(true) || (is_above.is_none() && is_rejected) {
            return Ok(None);
        }
        if is_above.is_some() {
            diagnosis.rest_on(fresh.clone());
        }
        if is_rejected {
            diagnosis.verdict = Verdict::BelowNoise;
            diagnosis.unexplained.hint = fresh.below().unwrap_or_default();
        }
        self.weigh(&mut diagnosis, None);
        Ok(Some(diagnosis))
    }

    /// What fresh beds say of the model as it is, in the fit `fit`.
    fn unchanged(
        &self,
        forward: &BedForward,
        fit: &Fit,
        measured: &Observed,
        plain: &[Option<Record>],
    ) -> Result<HeldOut, BedError> {
        let runs = (self.plan.confirm.as_slice(), [plain; 2]);
        Ok(Confirmation::of(self.bed_model, measured, (forward, [fit; 2]), runs)?.held_out)
    }

    /// Has the verdict rest on what was confirmed: a name needs held-out conditions that the model as it is misses by
    /// more than noise, and impacts with it, on fresh beds, that are clearly nearer; and nothing but noise left over where
    /// what was fitted to is not explained.
    fn held_against(
        &self,
        mut diagnosis: Diagnosis,
        forward: &BedForward,
        confirmation: Option<&Confirmation>,
    ) -> Result<Diagnosis, BedError> {
        if !diagnosis.verdict.names_effects() {
            return Ok(diagnosis);
        }
        let problem = FitProblem { set: self.bed_model.set, observed: &self.observed, forward };
        let explains = diagnosis.p_lof_with.is_some_and(|p| p > ALPHA);
        let name = diagnosis.leaders.join(" or ");
        let held_out = confirmation.map(|one| &one.held_out);
        if let Some(held_out) = held_out {
            diagnosis.holdout = Some(held_out.clone());
        }
        let why = match held_out {
            Some(held_out) => {
                let amplitude = diagnosis.amplitudes.first();
                let (q, se) = amplitude.map_or((0.0, 0.0), |one| (one.q, one.se.unwrap_or(0.0)));
                held_out.too_small(&diagnosis.leaders, q, se).or_else(|| {
                    (!explains && !held_out.is_within_noise()).then(|| {
                        format!(
                            "{name} explains a part, on fresh beds too, and leaves more than noise"
                        )
                    })
                })
            }
            None => (!explains).then(|| format!("{name} explains a part")),
        };
        let Some(why) = why else {
            diagnosis.unexplained.hint.clear();
            return Ok(diagnosis);
        };
        if let Some(held_out) = &mut diagnosis.holdout {
            held_out.after = held_out.before;
            held_out.log_density_gain = 0.0;
            held_out.explained = None;
        }
        Ok(withdraw(&problem, diagnosis, why, self.seed)?)
    }

    /// How much the verdict weighs.
    fn weigh(&self, diagnosis: &mut Diagnosis, confirmation: Option<&Confirmation>) {
        let reasons = &mut diagnosis.strength_reasons;
        if !self.plan.supports {
            reasons.push(StrengthReason::SmallPlan);
        }
        if confirmation.is_some_and(|one| one.held_out.is_nearer() != Some(true)) {
            reasons.push(StrengthReason::FreshBedsNoNearer);
        }
        diagnosis.tell_untested();
        if !diagnosis.strength_reasons.is_empty() {
            diagnosis.strength = Strength::Suggested;
        }
        let lost = |effect: &RankedEffect| effect.status != Status::Ranked;
        if diagnosis.verdict == Verdict::CannotTell && diagnosis.ranking.iter().all(lost) {
            let why = diagnosis.ranking.iter().map(|effect| effect.note.as_str());
            diagnosis.unexplained.hint = why.max_by_key(|why| why.len()).unwrap_or("").to_owned();
        }
    }
}
