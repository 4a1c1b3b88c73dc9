//! Runs what is not done yet: beds first, then points, side by side and each on one thread.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use crate::beds::Place;
use crate::run::{Control, Existing, Places, RunError};
use crate::{CampaignError, Stage};

use super::done::Done;
use super::folder::{Folder, FolderError};
use super::plan::{Need, Planned, Point};

/// The logs of a run, and what one that failed has left of them.
const LOGS: [&str; 6] = [
    "run.mcap",
    "grains.mcap",
    "run.mcap.partial",
    "grains.mcap.partial",
    "checkpoint",
    "checkpoint.prev",
];

/// Beds that could not be prepared, and why.
type Failures = BTreeMap<[u8; 32], String>;

/// Runs the points of `planned` that are not done, in `folder` and with the beds of `place`. A point that
/// fails is a result; one that was begun goes on from its checkpoint.
///
/// # Errors
/// What is not the fault of a point: a folder or file that cannot be used, or
/// [`CampaignError::Interrupted`].
pub fn run(planned: &Planned, folder: &Folder, place: &Place<'_>) -> Result<(), SweepError> {
    let _held = folder.claim(&planned.plan)?;
    let missing = missing(planned, folder)?;
    if !planned.plan.keep_logs {
        clear_done(planned, &missing, folder);
    }
    let failures = beds(planned, &missing, place)?;
    let before = planned.plan.n_distinct() - missing.len();
    let work = |&index: &usize| planned.needs[index].work;
    place.side_by_side(Stage::Impacts, &missing, (&work, before), |index, control| {
        let done = point(planned, index, (folder, place, &failures), control)?;
        conclude(&planned.plan.points[index], &done, planned.plan.keep_logs, folder)
            .map_err(FolderError::into_campaign)
    })?;
    Ok(())
}

/// Runs the one point of `only` ([`Planned::of_point`]), unless it is done: for a scheduler, which runs
/// others at the same time.
///
/// # Errors
/// As [`run`].
pub fn run_one(only: &Planned, folder: &Folder, place: &Place<'_>) -> Result<(), SweepError> {
    let planned = &only.plan.points[0];
    if folder.done(&planned.hash)?.is_some() {
        return Ok(());
    }
    let failures = beds(only, &[0], place)?;
    let work = |_: &usize| 1.0;
    place.side_by_side(Stage::Impacts, &[0], (&work, 0), |index, control| {
        let done = point(only, index, (folder, place, &failures), control)?;
        conclude(planned, &done, only.plan.keep_logs, folder).map_err(FolderError::into_campaign)
    })?;
    Ok(())
}

/// The first point of every hash that is not done.
pub(crate) fn missing(planned: &Planned, folder: &Folder) -> Result<Vec<usize>, FolderError> {
    let mut seen = BTreeSet::new();
    let mut missing = Vec::new();
    for (index, point) in planned.plan.points.iter().enumerate() {
        if seen.insert(&point.hash) && folder.done(&point.hash)?.is_none() {
            missing.push(index);
        }
    }
    Ok(missing)
}

/// Why a campaign ends early.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum SweepError {
    #[error(transparent)]
    Folder(#[from] FolderError),
    #[error(transparent)]
    Campaign(#[from] CampaignError),
}

impl FolderError {
    /// As an error of a task.
    fn into_campaign(self) -> CampaignError {
        match self {
            Self::Io { action, path, source } => CampaignError::Io { action, path, source },
            other => CampaignError::Io {
                action: "use",
                path: std::path::PathBuf::new(),
                source: std::io::Error::other(other.to_string()),
            },
        }
    }
}

/// Prepares the beds that the `missing` points fall on.
fn beds(
    planned: &Planned,
    missing: &[usize],
    place: &Place<'_>,
) -> Result<Failures, CampaignError> {
    let mut seen = BTreeSet::new();
    let is_first = |index: &usize| planned.needs[*index].bed.is_some_and(|key| seen.insert(key));
    let firsts: Vec<usize> = missing.iter().copied().filter(is_first).collect();
    let failures = Mutex::new(Failures::new());
    let work = |&index: &usize| planned.needs[index].work;
    place.side_by_side(Stage::Beds, &firsts, (&work, 0), |index, control| {
        let model = planned.load(index)?.model;
        let (Some(grains), Some(key)) = (model.grains(), planned.needs[index].bed) else {
            return Ok(());
        };
        match crate::run::prepare(grains, place.cache, control) {
            Ok(Some(_)) => Ok(()),
            Ok(None) => Err(CampaignError::Interrupted),
            Err(error) if is_of_the_point(&error) => {
                let mut failures = failures.lock().unwrap_or_else(PoisonError::into_inner);
                failures.insert(key, error.to_string());
                Ok(())
            }
            Err(error) => Err(error.into()),
        }
    })?;
    Ok(failures.into_inner().unwrap_or_else(PoisonError::into_inner))
}

/// What comes of the point at `index`.
fn point(
    planned: &Planned,
    index: usize,
    (folder, place, failures): (&Folder, &Place<'_>, &Failures),
    control: &mut dyn Control,
) -> Result<Done, CampaignError> {
    let hash = &planned.plan.points[index].hash;
    let Need { bed, .. } = planned.needs[index];
    if let Some(why) = bed.and_then(|key| failures.get(&key)) {
        return Ok(Done::failed(hash, why.clone(), 0.0));
    }
    let loaded = planned.load(index)?;
    let places = Places {
        out: folder.of_point(hash),
        cache: place.cache.to_owned(),
        existing: Existing::Resume,
    };
    let start = Instant::now();
    match crate::run::run(&loaded.model, &loaded.original, &places, control) {
        Ok(crate::run::Outcome::One(summary)) => Ok(Done::of(hash, &summary)),
        Ok(crate::run::Outcome::Interrupted) => Err(CampaignError::Interrupted),
        Ok(crate::run::Outcome::List(_)) => {
            Ok(Done::failed(hash, "it lists conditions of its own".to_owned(), 0.0))
        }
        Err(error) if is_of_the_point(&error) => {
            Ok(Done::failed(hash, error.to_string(), start.elapsed().as_secs_f64()))
        }
        Err(error) => Err(error.into()),
    }
}

/// Leaves `done`, and takes away what a point is not asked to keep.
fn conclude(
    point: &Point,
    done: &Done,
    keep_logs: bool,
    folder: &Folder,
) -> Result<(), FolderError> {
    folder.conclude(done)?;
    if !keep_logs {
        clear(point, folder);
    }
    Ok(())
}

/// Takes away what a kill has left of points that are done: it came between their `done.json` and the removal of
/// their logs.
fn clear_done(planned: &Planned, missing: &[usize], folder: &Folder) {
    let missing: BTreeSet<&str> =
        missing.iter().map(|&index| planned.plan.points[index].hash.as_str()).collect();
    let done = planned.plan.points.iter().filter(|point| !missing.contains(point.hash.as_str()));
    done.for_each(|point| clear(point, folder));
}

/// Takes away the logs of `point`; what stays only takes room.
fn clear(point: &Point, folder: &Folder) {
    let of_point = folder.of_point(&point.hash);
    for name in LOGS {
        drop(fs::remove_file(of_point.join(name)));
    }
}

/// Whether another try at the same point would fail likewise.
fn is_of_the_point(error: &RunError) -> bool {
    matches!(
        error,
        RunError::Restless { .. }
            | RunError::TableOverlaps { .. }
            | RunError::Build(_)
            | RunError::Settling { .. }
            | RunError::Step(_)
            | RunError::Impact(_)
            | RunError::OpenBudget { .. }
    )
}
