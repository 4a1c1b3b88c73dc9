//! A row: a published result, how it is run again, and what came of it.

use configs::ConfigError;
use diagnosis::compare::CompareError;
use diagnosis::fit::problem::FitError;
use engine::error::ThreadsError;
use plots::PictureError;
use resistive::ImpactError;
use runner::CampaignError;
use serde::Serialize;
use thiserror::Error;

use super::check::{Check, Verdict};
use super::laboratory::Laboratory;

/// A published result that is run again and judged.
pub struct Row {
    /// `E1` and so on.
    pub id: &'static str,
    /// What was published, in one line.
    pub title: &'static str,
    /// Where.
    pub source: &'static str,
    /// How much of it is run, quick and in full.
    pub how: [&'static str; 2],
    /// Runs it and judges.
    pub judge: fn(&Laboratory<'_>) -> Result<Findings, PublishedError>,
}

/// What came of a row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Findings {
    /// What belongs at the head of a report, if anything does.
    pub headline: Option<Table>,
    /// Its comparisons.
    pub checks: Vec<Check>,
    /// Numbers behind them.
    pub tables: Vec<Table>,
    /// What they are seen in.
    pub figures: Vec<Figure>,
    /// What one should know of it.
    pub notes: Vec<String>,
}

/// Numbers of a row that are compared by no verdict of their own.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Table {
    /// What it shows.
    pub caption: String,
    /// Names of its columns, with their units.
    pub head: Vec<String>,
    /// Its lines, as they are shown.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// An empty one.
    pub fn new(caption: &str, head: &[&str]) -> Self {
        let head = head.iter().map(|&name| name.to_owned()).collect();
        Self { caption: caption.to_owned(), head, rows: Vec::new() }
    }
}

/// A picture of a row.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Figure {
    /// Its file: `e1-stopping-time.svg`.
    pub file: String,
    /// What it shows.
    pub caption: String,
    /// The picture.
    #[serde(skip)]
    pub svg: String,
}

impl Findings {
    /// The worst verdict of its checks, in the order of [`Verdict`].
    pub fn verdict(&self) -> Verdict {
        self.checks.iter().map(|check| check.verdict).max().unwrap_or(Verdict::NotRun)
    }

    /// Adds the picture `svg` under `caption`.
    pub(super) fn show(&mut self, file: &str, caption: &str, svg: String) {
        self.figures.push(Figure { file: file.to_owned(), caption: caption.to_owned(), svg });
    }
}

/// Why a row could not be judged.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum PublishedError {
    #[error(transparent)]
    Campaign(#[from] CampaignError),
    #[error(transparent)]
    Config(#[from] ConfigError),
    #[error(transparent)]
    Impact(#[from] ImpactError),
    #[error(transparent)]
    FitProblem(#[from] FitError),
    #[error(transparent)]
    Compare(#[from] CompareError),
    #[error(transparent)]
    Picture(#[from] PictureError),
    #[error(transparent)]
    Threads(#[from] ThreadsError),
    #[error("none of its impacts was run yet")]
    NotYet,
    #[error("{0}")]
    Missing(String),
}
