//! Many impacts on beds side by side, each kept as it ends. What is kept is not run again, so a campaign that
//! was killed has lost the impacts in flight.

use std::fs;
use std::num::NonZero;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use configs::GrainModel;

use super::job::Job;
use super::lie::Lie;
use super::rate::{self, Rate};
use super::record::Record;
use super::task::BedTask;
use crate::elsewhere::Elsewhere;
use crate::error::CampaignError;
use crate::run::{Control, bed_file};
use crate::workers::{Stage, Watch, Workers};

/// Where impacts are run and kept.
#[derive(Clone, Copy)]
pub struct Place<'a> {
    /// The folder of beds and impacts.
    pub cache: &'a Path,
    /// Impacts at a time; none for one per core.
    pub workers: Option<NonZero<usize>>,
    /// Whoever watches.
    pub watch: &'a dyn Watch,
    /// Who runs them, if not this process.
    pub elsewhere: Option<&'a Elsewhere>,
}

/// What a campaign would have to run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Outstanding {
    /// Impacts that are not kept yet.
    pub impacts: usize,
    /// Beds that are not.
    pub beds: usize,
    /// Work of both (grain-steps).
    pub work: f64,
}

/// Where the records of jobs come from.
pub trait Impacts {
    /// How many impacts run at a time.
    fn n_workers(&self) -> usize;

    /// Grain-steps per second of one of them, on beds like that of `model`.
    fn rate(&self, model: GrainModel<'_>) -> Result<f64, CampaignError>;

    /// The records of `jobs`, in their order, and the same however many workers there are. An impact
    /// whose steps cannot be trusted has none.
    ///
    /// # Errors
    /// The first of any job in their order; [`CampaignError::Interrupted`] if it was stopped.
    fn run(&self, jobs: &[Job]) -> Result<Vec<Option<Record>>, CampaignError>;

    /// How the beds of `jobs` lie, in their order; they are prepared where they are not kept.
    ///
    /// # Errors
    /// As of [`Impacts::run`].
    fn lies(&self, jobs: &[Job]) -> Result<Vec<Lie>, CampaignError>;

    /// What of `jobs` is still to be run.
    ///
    /// # Errors
    /// If a model is no bed of grains.
    fn outstanding(&self, jobs: &[Job]) -> Result<Outstanding, CampaignError>;
}

impl Impacts for Place<'_> {
    fn n_workers(&self) -> usize {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        self.workers.map_or(cores, usize::from)
    }

    fn rate(&self, model: GrainModel<'_>) -> Result<f64, CampaignError> {
        rate::grain_steps_per_second(self.cache, model)
    }

    fn run(&self, jobs: &[Job]) -> Result<Vec<Option<Record>>, CampaignError> {
        self.make_folders()?;
        if let Some(elsewhere) = self.elsewhere {
            self.have_done(elsewhere, jobs)?;
        }
        let keys = jobs.iter().map(Job::key).collect::<Result<Vec<_>, _>>()?;
        let kept: Vec<Option<Record>> = keys.iter().map(|key| Job::kept(self.cache, key)).collect();
        let missing = first_of_each(&keys, |at| kept[at].is_none());
        if self.elsewhere.is_none() {
            self.tell_damages(&keys, &missing);
        }
        let beds = self.missing_beds(jobs, &missing)?;
        let work = |&at: &usize| rate::SETTLING * jobs[at].work();
        self.side_by_side(Stage::Beds, &beds, (&work, 0), |at, signals| {
            jobs[at]
                .prepare_bed(self.cache, signals)?
                .then_some(())
                .ok_or(CampaignError::Interrupted)
        })?;
        let done = jobs.len() - missing.len();
        let pace = Mutex::new(Rate::default());
        let work = |&at: &usize| jobs[at].work();
        let ran = self.side_by_side(Stage::Impacts, &missing, (&work, done), |at, signals| {
            let job = &jobs[at];
            match job.kept_or_run((self.cache, &keys[at]), signals) {
                Ok(Some((record, was_run))) => {
                    if was_run {
                        pace.lock().unwrap_or_else(PoisonError::into_inner).learn(&record);
                    }
                    Ok(Some(record))
                }
                Ok(None) => Err(CampaignError::Interrupted),
                Err(why) if why.is_of_an_impact() => {
                    let name = &job.model.run.name;
                    self.watch.warn(&format!("an impact of {name} is left out: {why}"));
                    Ok(None)
                }
                Err(other) => Err(other),
            }
        });
        // What was learned of this machine stays, also where the campaign does not end.
        pace.into_inner().unwrap_or_else(PoisonError::into_inner).store(self.cache);
        let ran = ran?;
        let found = |at: usize| {
            let same = |&other: &usize| keys[other] == keys[at];
            missing.iter().position(same).and_then(|place| ran[place].clone())
        };
        Ok((0..jobs.len()).zip(kept).map(|(at, kept)| kept.or_else(|| found(at))).collect())
    }

    fn lies(&self, jobs: &[Job]) -> Result<Vec<Lie>, CampaignError> {
        self.make_folders()?;
        if let Some(elsewhere) = self.elsewhere {
            self.have_prepared(elsewhere, jobs, &(0..jobs.len()).collect::<Vec<_>>())?;
        }
        let keys = jobs.iter().map(Job::bed_key).collect::<Result<Vec<_>, _>>()?;
        let firsts = first_of_each(&keys, |_| true);
        let work = |&at: &usize| rate::SETTLING * jobs[at].work();
        let found = self.side_by_side(Stage::Beds, &firsts, (&work, 0), |at, signals| {
            let bed = &jobs[at].bed;
            let grains = bed.grains().ok_or_else(|| CampaignError::no_grains(bed))?;
            Lie::of(grains, self.cache, signals)?.ok_or(CampaignError::Interrupted)
        })?;
        let of = |key: &[u8; 32]| firsts.iter().position(|&first| keys[first] == *key);
        Ok(keys.iter().filter_map(|key| of(key).map(|place| found[place])).collect())
    }

    fn outstanding(&self, jobs: &[Job]) -> Result<Outstanding, CampaignError> {
        let keys = jobs.iter().map(Job::key).collect::<Result<Vec<_>, _>>()?;
        let missing = first_of_each(&keys, |at| Job::kept(self.cache, &keys[at]).is_none());
        let beds = self.missing_beds(jobs, &missing)?;
        let impacts: f64 = missing.iter().map(|&at| jobs[at].work()).sum();
        let settling: f64 = beds.iter().map(|&at| rate::SETTLING * jobs[at].work()).sum();
        // The sum of nothing is −0.
        let work = 0.0 + impacts + settling;
        Ok(Outstanding { impacts: missing.len(), beds: beds.len(), work })
    }
}

impl Place<'_> {
    /// The records of those of `jobs` that are kept, in their order; nothing is run.
    ///
    /// # Errors
    /// If a model is no bed of grains.
    pub fn kept(&self, jobs: &[Job]) -> Result<Vec<Option<Record>>, CampaignError> {
        jobs.iter().map(|job| Ok(Job::kept(self.cache, &job.key()?))).collect()
    }

    /// Warns of records at the places `missing` that are there and cannot be used.
    fn tell_damages(&self, keys: &[[u8; 32]], missing: &[usize]) {
        let damages = missing.iter().filter_map(|&at| Job::damage(self.cache, &keys[at]));
        damages.for_each(|why| self.watch.warn(&format!("{why}; the impact is run again")));
    }

    fn make_folders(&self) -> Result<(), CampaignError> {
        for folder in ["beds", "impacts"] {
            let path = self.cache.join(folder);
            fs::create_dir_all(&path).map_err(|source| CampaignError::Io {
                action: "make",
                path,
                source,
            })?;
        }
        Ok(())
    }

    /// Has those beds of the jobs at `places` that are not there prepared by `elsewhere`.
    fn have_prepared(
        &self,
        elsewhere: &Elsewhere,
        jobs: &[Job],
        places: &[usize],
    ) -> Result<(), CampaignError> {
        let beds = self.missing_beds(jobs, places)?;
        let tasks: Vec<BedTask> = beds.iter().map(|&at| BedTask::bed(&jobs[at])).collect();
        let files = beds.iter().map(|&at| jobs[at].bed_key().map(|key| bed_file(self.cache, &key)));
        let files = files.collect::<Result<Vec<_>, _>>()?;
        let is_there = |at: usize| files[at].is_file();
        elsewhere.run(Stage::Beds, &tasks, self.cache, self.watch, &is_there)
    }

    /// Has what is missing of `jobs` done by `elsewhere`. An impact whose steps cannot be trusted has no
    /// record then either, and is found out about here.
    fn have_done(&self, elsewhere: &Elsewhere, jobs: &[Job]) -> Result<(), CampaignError> {
        let keys = jobs.iter().map(Job::key).collect::<Result<Vec<_>, _>>()?;
        let missing = first_of_each(&keys, |at| Job::kept(self.cache, &keys[at]).is_none());
        self.tell_damages(&keys, &missing);
        self.have_prepared(elsewhere, jobs, &missing)?;
        let tasks: Vec<BedTask> =
            missing.iter().map(|&at| BedTask::impact(&jobs[at], &keys[at])).collect();
        let is_there = |at: usize| Job::path(self.cache, &keys[missing[at]]).is_file();
        elsewhere.run(Stage::Impacts, &tasks, self.cache, self.watch, &is_there)
    }

    /// One of the `missing` jobs per bed that is not there yet.
    fn missing_beds(&self, jobs: &[Job], missing: &[usize]) -> Result<Vec<usize>, CampaignError> {
        let keys = missing.iter().map(|&at| jobs[at].bed_key()).collect::<Result<Vec<_>, _>>()?;
        let is_missing = |place: usize| {
            let name = bed_file(self.cache, &keys[place]);
            !name.is_file()
                && jobs[missing[place]].bed.grains().is_some_and(|g| g.read_bed().is_none())
        };
        Ok(first_of_each(&keys, is_missing).into_iter().map(|place| missing[place]).collect())
    }

    /// Does `tasks` side by side, as [`Workers::side_by_side`] does.
    ///
    /// # Errors
    /// As there.
    pub fn side_by_side<R: Send>(
        &self,
        what: Stage,
        tasks: &[usize],
        work: (&(dyn Fn(&usize) -> f64 + Sync), usize),
        task: impl Fn(usize, &mut dyn Control) -> Result<R, CampaignError> + Sync,
    ) -> Result<Vec<R>, CampaignError> {
        let workers = Workers { number: self.n_workers(), watch: self.watch };
        workers.side_by_side(what, tasks, work, task)
    }
}

/// The first place of every key for which `wanted` holds.
fn first_of_each(keys: &[[u8; 32]], wanted: impl Fn(usize) -> bool) -> Vec<usize> {
    let mut seen = std::collections::BTreeSet::new();
    (0..keys.len()).filter(|&at| seen.insert(keys[at]) && wanted(at)).collect()
}
