//! What a campaign has come to, at any time.

use serde_json::{Value, json};

use super::done::{Done, Headline, Status};
use super::folder::{Folder, FolderError};
use super::plan::{Plan, Point};

/// The plan of a campaign and what came of its points so far.
#[derive(Clone, Debug, PartialEq)]
pub struct Results {
    /// The plan.
    pub plan: Plan,
    /// What came of each point, in the order of the plan.
    pub outcomes: Vec<Outcome>,
}

/// What came of a point so far.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// It is done, or failed.
    Ended(Box<Done>),
    /// It was begun.
    Begun,
    /// It was not.
    Waiting,
}

/// How many points have come how far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// All of them.
    pub points: usize,
    /// Done.
    pub done: usize,
    /// Failed.
    pub failed: usize,
    /// Begun and not ended.
    pub begun: usize,
    /// Not begun.
    pub waiting: usize,
}

impl Results {
    /// What is in `folder` now.
    ///
    /// # Errors
    /// If there is no campaign, or a file cannot be read or understood.
    pub fn read(folder: &Folder) -> Result<Self, FolderError> {
        let plan = folder.plan()?;
        let outcome = |point: &Point| {
            Ok(match folder.done(&point.hash)? {
                Some(done) => Outcome::Ended(Box::new(done)),
                None if folder.of_point(&point.hash).exists() => Outcome::Begun,
                None => Outcome::Waiting,
            })
        };
        let outcomes = plan.points.iter().map(outcome).collect::<Result<_, _>>()?;
        Ok(Self { plan, outcomes })
    }

    /// How far it has come.
    pub fn counts(&self) -> Counts {
        let mut counts = Counts { points: self.outcomes.len(), ..Counts::default() };
        for outcome in &self.outcomes {
            *match outcome {
                Outcome::Ended(done) if done.status == Status::Done => &mut counts.done,
                Outcome::Ended(_) => &mut counts.failed,
                Outcome::Begun => &mut counts.begun,
                Outcome::Waiting => &mut counts.waiting,
            } += 1;
        }
        counts
    }

    /// Every point with what came of it.
    pub fn points(&self) -> impl Iterator<Item = (&Point, &Outcome)> {
        self.plan.points.iter().zip(&self.outcomes)
    }

    /// The same as JSON: counts, and the points that failed with why.
    pub fn to_json(&self) -> Value {
        let Counts { points, done, failed, begun, waiting } = self.counts();
        let failures: Vec<Value> = self
            .points()
            .filter_map(|(point, outcome)| {
                let error = outcome.error()?;
                Some(json!({ "point": point.point, "hash": point.hash, "error": error }))
            })
            .collect();
        json!({
            "campaign": self.plan.name,
            "points": points,
            "done": done,
            "failed": failed,
            "begun": begun,
            "waiting": waiting,
            "failures": failures,
        })
    }
}

impl Outcome {
    /// Its numbers, if it is done.
    pub fn headline(&self) -> Option<&Headline> {
        match self {
            Self::Ended(done) => done.headline.as_ref(),
            _ => None,
        }
    }

    /// Why it failed, if it did.
    pub fn error(&self) -> Option<&str> {
        match self {
            Self::Ended(done) => done.error.as_deref(),
            _ => None,
        }
    }

    /// How far it has come, in a word.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Ended(done) => match done.status {
                Status::Done => "done",
                Status::Failed => "failed",
            },
            Self::Begun => "begun",
            Self::Waiting => "waiting",
        }
    }
}

impl Counts {
    /// Whether nothing is left to do.
    pub fn is_complete(&self) -> bool {
        self.done + self.failed == self.points
    }
}
