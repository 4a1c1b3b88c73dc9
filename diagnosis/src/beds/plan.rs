//! What a diagnosis of a bed of grains runs, said before anything is run.

use runner::beds::Job;
use runner::beds::{Impacts, Outstanding, SETTLING};
use serde_json::{Value, json};

use super::bed_candidate::BedCandidate;
use super::bed_candidates::{BED_CANDIDATES, OF_THE_APPARATUS};
use super::bed_model::{BedModel, Draw};
use super::error::BedError;
use super::line_search;
use super::preparation::at_level;
use super::screening::Screening;
use super::variation::Variation;
use crate::observed::Observed;
use crate::observed::series::evenly;
use crate::verdict::Diagnosis;

/// How many effects a line search and a confirmation take up.
pub(super) const LEADERS: usize = 2;

/// How often leaders are searched at most: those that lead once the first are better known, too.
pub(super) const SEARCHES: usize = 2;

/// Most effects beside the leader that are confirmed on fresh beds.
pub(super) const RIVALS: usize = 3;

/// Draws of a looser and of a denser bed, per condition.
pub(super) const SIDE_DRAWS: usize = 3;

/// Most pairs of runs on one draw: a correlation from eight is known well enough to choose a way of screening.
const PAIRS: usize = 8;

/// How much is run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Size {
    /// What it is called.
    pub name: &'static str,
    /// Conditions that are fitted to.
    pub conditions: usize,
    /// Draws of the model as it stands, per condition.
    pub draws: usize,
    /// How often the design of a screening is run.
    pub repeats: usize,
    /// Draws of a line search.
    pub line_draws: usize,
    /// Conditions that confirm.
    pub confirm_conditions: usize,
    /// Draws of either model that confirm.
    pub confirm_draws: usize,
}

/// From the smallest that says anything to one for a night.
pub const SIZES: [Size; 4] = [
    Size {
        name: "smallest",
        conditions: 2,
        draws: 4,
        repeats: 1,
        line_draws: 3,
        confirm_conditions: 1,
        confirm_draws: 4,
    },
    Size {
        name: "quick",
        conditions: 3,
        draws: 6,
        repeats: 1,
        line_draws: 3,
        confirm_conditions: 2,
        confirm_draws: 6,
    },
    Size {
        name: "standard",
        conditions: 6,
        draws: 6,
        repeats: 1,
        line_draws: 3,
        confirm_conditions: 3,
        confirm_draws: 6,
    },
    Size {
        name: "thorough",
        conditions: 6,
        draws: 16,
        repeats: 4,
        line_draws: 8,
        confirm_conditions: 4,
        confirm_draws: 12,
    },
];

/// The size where no budget is given.
const STANDARD: usize = 2;

/// Sizes below this one suggest; from it on, they support.
const SUPPORTS: usize = 1;

/// What is asked of a diagnosis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Wish {
    /// Time that may be spent (s); the standard plan without.
    pub budget: Option<f64>,
    /// Candidates that are parameters of the model: they compensate what they can before any effect is
    /// ranked.
    pub free: Vec<String>,
    /// Candidates, the free ones aside: candidates, and what the apparatus may do; if there are none, all that
    /// measurements may have.
    pub candidates: Vec<String>,
}

impl Wish {
    /// Whether `id` is a candidate; `by_default` where none is named.
    fn considers(&self, id: &str, by_default: bool) -> bool {
        match self.candidates.is_empty() {
            true => by_default,
            false => self.candidates.iter().any(|one| one == id),
        }
    }

    /// Whether the plan covers `bed_candidate`, either as a free parameter or as a ranked candidate.
    fn takes(&self, bed_candidate: &BedCandidate) -> bool {
        self.considers(bed_candidate.id, bed_candidate.of_measurements)
            || self.free.iter().any(|id| id == bed_candidate.id)
    }

    /// What the apparatus may do that is a candidate.
    pub(super) fn apparatus(&self) -> Vec<&'static str> {
        OF_THE_APPARATUS.iter().copied().filter(|id| self.considers(id, true)).collect()
    }
}

/// What is run, stage by stage.
#[derive(Clone, Debug)]
pub struct Plan {
    /// How much.
    pub size: Size,
    /// Whether it is enough to support a verdict rather than to suggest it.
    pub supports: bool,
    /// Indices of the conditions that are fitted to.
    pub fit: Vec<usize>,
    /// Indices of those that confirm.
    pub confirm: Vec<usize>,
    /// Whether those are held out by the set; else they are those that are not fitted to.
    pub held_out: bool,
    /// Name, impacts and seconds of every stage, those that are kept not counted in seconds.
    pub stages: Vec<PlannedStage>,
    /// Grain-steps per second of one worker.
    pub rate: f64,
    /// Impacts at a time.
    pub workers: usize,
    /// What was asked for.
    pub wish: Wish,
}

/// A stage of a plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlannedStage {
    /// What it answers.
    pub name: &'static str,
    /// Impacts.
    pub impacts: usize,
    /// Of those, not kept yet, as far as they are known.
    pub to_run: usize,
    /// Beds to be prepared.
    pub beds: usize,
    /// Estimated time (s).
    pub seconds: f64,
}

/// Draws of the stages, condition by condition.
pub(super) struct Draws {
    /// Of the model as it stands, of the screening and of line searches: what is held against each other
    /// lies on the same beds.
    pub(super) fit: Vec<Vec<Draw>>,
    /// Of the confirmation: on fresh beds.
    pub(super) confirm: Vec<Vec<Draw>>,
}

impl Plan {
    /// The largest plan for `bed_model` that fits the budget of `wish`, or the standard plan; the smallest, if
    /// none is, which [`Plan::fits`] then denies.
    ///
    /// # Errors
    /// If a condition is no model, or a name no candidate.
    pub fn new(
        bed_model: &BedModel<'_>,
        observed: &Observed,
        place: &dyn Impacts,
        wish: &Wish,
    ) -> Result<Self, BedError> {
        let bed_candidates: Vec<&str> = bed_candidates(bed_model).map(|one| one.id).collect();
        let candidates = [&bed_candidates[..], &OF_THE_APPARATUS].concat();
        for (ids, known) in [(&wish.free, &bed_candidates), (&wish.candidates, &candidates)] {
            if let Some(id) = ids.iter().find(|id| !known.contains(&id.as_str())) {
                return Err(BedError::UnknownCandidate { id: id.clone(), known: known.clone() });
            }
        }
        let rate = place.rate(bed_model.grains())?;
        let sized = |at| Self::sized(bed_model, observed, place, (at, rate, wish));
        let Some(budget) = wish.budget else { return sized(STANDARD) };
        let mut chosen = sized(0)?;
        for at in 1..SIZES.len() {
            let larger = sized(at)?;
            if larger.seconds() > budget {
                break;
            }
            chosen = larger;
        }
        Ok(chosen)
    }

    fn sized(
        bed_model: &BedModel<'_>,
        observed: &Observed,
        place: &dyn Impacts,
        (at, rate, wish): (usize, f64, &Wish),
    ) -> Result<Self, BedError> {
        let size = SIZES[at];
        let fit = spread_over(&observed.fit, size.conditions);
        let held_out = !observed.holdout.is_empty();
        let others: Vec<usize> = match held_out {
            true => observed.holdout.clone(),
            false => observed.fit.iter().copied().filter(|one| !fit.contains(one)).collect(),
        };
        let mut plan = Self {
            size,
            supports: at >= SUPPORTS,
            confirm: spread_over(&others, size.confirm_conditions),
            fit,
            held_out,
            stages: Vec::new(),
            rate,
            workers: place.n_workers(),
            wish: wish.clone(),
        };
        plan.stages = plan.stages_of(bed_model, place)?;
        Ok(plan)
    }

    fn stages_of(
        &self,
        bed_model: &BedModel<'_>,
        place: &dyn Impacts,
    ) -> Result<Vec<PlannedStage>, BedError> {
        let draws = self.draws(bed_model);
        let baseline = self.baseline_jobs(bed_model, &draws.fit)?;
        let again = self.rerun_jobs(bed_model, &draws.fit)?;
        let screening = self.screening(bed_model);
        let screened = screening.jobs(bed_model)?;
        let pace = self.rate * self.workers as f64;
        let stage = |name, jobs: &[Job]| -> Result<PlannedStage, BedError> {
            let Outstanding { impacts, beds, work } = place.outstanding(jobs)?;
            let seconds = work / pace;
            Ok(PlannedStage { name, impacts: jobs.len(), to_run: impacts, beds, seconds })
        };
        // What comes later is known in number; a job of the baseline stands for each.
        let mean = baseline.iter().map(Job::work).sum::<f64>() / baseline.len().max(1) as f64;
        let later = |name, impacts: usize, beds: usize| {
            let work = mean * (impacts as f64 + SETTLING * beds as f64);
            PlannedStage { name, impacts, to_run: impacts, beds, seconds: work / pace }
        };
        let Size { line_draws, confirm_draws, .. } = self.size;
        let beds_of = |draws: usize, conditions: usize| match conditions {
            0 => 0,
            _ => bed_model.n_beds(draws, conditions),
        };
        let (fitted, confirming) = (self.fit.len(), self.confirm.len());
        let sides = match at_level(bed_model.grains(), 1.0) {
            Some(_) => 2,
            None => 0,
        };
        let of_sides =
            SIDE_DRAWS.min(self.size.draws) * fitted + SIDE_DRAWS.min(confirm_draws) * confirming;
        let beds_of_sides = sides * (beds_of(SIDE_DRAWS, fitted) + beds_of(SIDE_DRAWS, confirming));
        // One search more is of what screening lost.
        let lines =
            (SEARCHES + 1) * LEADERS * line_search::AMPLITUDES * line_draws * self.fit.len();
        let confirm = confirming * confirm_draws;
        Ok(vec![
            stage("scatter of beds", &baseline)?,
            stage("correlation of pairs", &again)?,
            later("response to packing", sides * of_sides, beds_of_sides),
            later("held out, unchanged", confirm, beds_of(confirm_draws, confirming)),
            stage("screening, if anything is missing", &screened)?,
            later("line search, at most", lines, 0),
            later("confirmation of names, at most", (1 + RIVALS) * confirm, 0),
        ])
    }

    /// Estimated time (s).
    pub fn seconds(&self) -> f64 {
        self.stages.iter().map(|stage| stage.seconds).sum()
    }

    /// Impacts in all.
    pub fn impacts(&self) -> usize {
        self.stages.iter().map(|stage| stage.impacts).sum()
    }

    /// Whether it is done within the budget, as far as is known.
    pub fn fits(&self) -> bool {
        self.wish.budget.is_none_or(|budget| self.seconds() <= budget)
    }

    /// As JSON; times are estimates of this machine.
    pub fn to_json(&self, bed_model: &BedModel<'_>) -> Value {
        let id = |at: &usize| bed_model.set.conditions[*at].id.clone();
        let stages = self.stages.iter().map(|stage| {
            json!({
                "stage": stage.name,
                "impacts": stage.impacts,
                "to_run": stage.to_run,
                "beds": stage.beds,
                "estimated_s": stage.seconds.round(),
            })
        });
        json!({
            "size": self.size.name,
            "fit": self.fit.iter().map(id).collect::<Vec<_>>(),
            "confirm": self.confirm.iter().map(id).collect::<Vec<_>>(),
            "impacts": self.impacts(),
            "estimated_s": self.seconds().round(),
            "workers": self.workers,
            "grain_steps_per_s": self.rate.round(),
            "stages": stages.collect::<Vec<_>>(),
        })
    }

    pub(super) fn draws(&self, bed_model: &BedModel<'_>) -> Draws {
        let Size { draws, confirm_draws, .. } = self.size;
        let behind = bed_model.n_beds(draws, self.fit.len());
        Draws {
            fit: bed_model.draws(0, draws, self.fit.len()),
            confirm: bed_model.draws(behind, confirm_draws, self.confirm.len()),
        }
    }

    /// The model as it stands: condition after condition, draw after draw.
    pub(super) fn baseline_jobs(
        &self,
        bed_model: &BedModel<'_>,
        draws: &[Vec<Draw>],
    ) -> Result<Vec<Job>, BedError> {
        Ok(bed_model.jobs(&self.fit, draws, &Variation::default())?)
    }

    /// The middle one of the conditions that are fitted to, as a place in [`Plan::fit`].
    pub(super) fn middle(&self) -> usize {
        self.fit.len() / 2
    }

    /// The same with a parameter changed by a little, under the middle condition: what two runs on one
    /// draw have in common. None where the model has no number that does.
    pub(super) fn rerun_jobs(
        &self,
        bed_model: &BedModel<'_>,
        draws: &[Vec<Draw>],
    ) -> Result<Vec<Job>, BedError> {
        const LITTLE: f64 = 0.02;
        let known = ["restitution", "grain-friction"];
        let bed_candidate = BED_CANDIDATES
            .iter()
            .find(|one| known.contains(&one.id) && one.lacks(bed_model.grains()).is_none());
        let middle = self.middle()..(self.middle() + 1).min(self.fit.len());
        let Some(bed_candidate) = bed_candidate else { return Ok(Vec::new()) };
        let change = bed_candidate.change(bed_model.grains(), LITTLE);
        let few: Vec<Vec<Draw>> = draws[middle.clone()]
            .iter()
            .map(|draws| draws[..PAIRS.min(draws.len())].to_vec())
            .collect();
        Ok(bed_model.jobs(&self.fit[middle], &few, &change)?)
    }

    pub(super) fn screening(&self, bed_model: &BedModel<'_>) -> Screening {
        let bed_candidates = bed_candidates(bed_model).filter(|one| self.wish.takes(one)).collect();
        let draws = self.draws(bed_model).fit;
        Screening::new(bed_candidates, self.fit.clone(), self.size.repeats, draws)
    }
}

/// The candidates of `bed_model`. A change that makes the time step of the model too long is left out.
fn bed_candidates<'a>(
    bed_model: &'a BedModel<'_>,
) -> impl Iterator<Item = &'static BedCandidate> + use<'a> {
    let first = bed_model.draws(0, 1, 1).concat();
    let is_sound = move |one: &&BedCandidate| {
        let change = one.change(bed_model.grains(), one.screen);
        first.iter().all(|&draw| bed_model.job(0, draw, &change).is_ok())
    };
    let is_open = |one: &&BedCandidate| {
        one.lacks(bed_model.grains()).is_none()
            && !one.stated_by.is_some_and(|says| says(&bed_model.set.bed))
    };
    BED_CANDIDATES.iter().filter(is_open).filter(is_sound)
}

/// At most `count` of `conditions`, evenly spaced, with the first and the last.
fn spread_over(conditions: &[usize], count: usize) -> Vec<usize> {
    evenly(conditions.len(), count).into_iter().map(|at| conditions[at]).collect()
}

/// What there is to say where the budget of `plan` does not pay for it.
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
