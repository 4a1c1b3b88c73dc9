//! Reports: one HTML page per run, list of runs, campaign, comparison, diagnosis, validation or measurement set.
//!
//! A page holds its figures, its style and its script, asks nothing of any network, and reads on
//! screen, in the dark and on paper. It is made of the files of one folder and of nothing else, so that
//! [`of_folder`] makes it again, with the same bytes: wall times stay in `summary.json`.
//!
//! What a page consists of is in `page.rs`, what it looks like in `templates/`.

mod about;
mod campaign;
mod claim;
mod comparison;
mod diagnosis;
mod figure;
mod list;
pub mod movie;
mod numbers;
mod page;
mod published;
pub mod run;
pub mod scene;
mod set;
pub mod tables;
mod verdict;

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

pub use claim::{
    explains_if_conditions_differ, probability as probability_in_words, sentence as claim_in_words,
};
use exchange::read::ReadError;
use exchange::run_files::{RunFiles, is_log};
use plots::PictureError;
pub use plots::rounded;
use runner::campaign::{Folder, FolderError, PLAN, Results};
use runner::run::{ListSummary, Summary};
use serde_json::Value;
use thiserror::Error;

pub use run::sparkline;
pub use set::of_set;
pub use verdict::{apparatus_error, forces_in_words, strength_in_words, verdict_in_words};

/// Name of a report in its folder.
pub const FILE: &str = "report.html";

/// Why there is no report.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum ReportError {
    #[error("cannot read {}: {source}", path.display())]
    Io { path: PathBuf, source: io::Error },
    #[error(
        "{} holds no finished run, campaign, comparison, diagnosis or validation: no summary.json, \
         {PLAN}, comparison.json, diagnosis.json or validation.json",
        folder.display()
    )]
    Nothing { folder: PathBuf },
    #[error("{} is missing; it has the results of {}", summary.display(), log.display())]
    NoSummary { log: PathBuf, summary: PathBuf },
    #[error("{file} cannot be read: {why}")]
    Misunderstood { file: String, why: String },
    #[error(transparent)]
    Log(#[from] ReadError),
    #[error(transparent)]
    Scene(#[from] scene::SceneError),
    #[error(transparent)]
    Campaign(#[from] FolderError),
    #[error(transparent)]
    Picture(#[from] PictureError),
    #[error("cannot write a page: {0}")]
    Page(#[from] askama::Error),
}

/// The results of a comparison, diagnosis or validation, by the names of their files.
pub type Texts = BTreeMap<String, String>;

/// The page of what `folder` holds: a run, however far it has come, a list of runs, a campaign, however far it has come,
/// a comparison, a diagnosis or a validation. A run may also be named by its log.
///
/// # Errors
/// If the folder holds none of them, or a file cannot be read or understood.
pub fn of_folder(folder: &Path) -> Result<String, ReportError> {
    let summary = RunFiles::of(folder).summary;
    if summary.is_file() {
        let text = read(&summary)?;
        let why = |error: serde_json::Error| misunderstood(&summary.display().to_string(), &error);
        let value: Value = serde_json::from_str(&text).map_err(why)?;
        return match value.get("runs") {
            Some(_) => of_list(&serde_json::from_value(value).map_err(why)?),
            None => {
                let summary: Summary = serde_json::from_value(value).map_err(why)?;
                let course = run::Course::read(folder)?;
                let seen = run::Seen::read(folder, &summary, &course);
                run::page(&summary, &course, &seen)
            }
        };
    }
    if RunFiles::of(folder).are_unfinished() {
        let course = run::Course::read(folder)?;
        let seen = run::Seen::so_far(folder, &course);
        let name = folder.file_stem().unwrap_or(folder.as_os_str()).to_string_lossy();
        return run::page_so_far(&name, &course, &seen);
    }
    if is_log(folder) {
        return Err(ReportError::NoSummary { log: folder.to_owned(), summary });
    }
    if folder.join(PLAN).is_file() {
        return of_campaign(&Results::read(&Folder::new(folder))?);
    }
    let entries = fs::read_dir(folder).map_err(|source| io_error(folder, source))?;
    let mut texts = Texts::new();
    for entry in entries {
        let path = entry.map_err(|source| io_error(folder, source))?.path();
        let shown = path.extension().is_some_and(|end| end == "json" || end == "svg");
        if let Some(name) = path.file_name().and_then(|name| name.to_str()).filter(|_| shown) {
            texts.insert(name.to_owned(), read(&path)?);
        }
    }
    match of_texts(&texts) {
        Some(page) => page,
        None => Err(ReportError::Nothing { folder: folder.to_owned() }),
    }
}

/// The page of the results of a comparison, a diagnosis or a validation; `None` if `texts` are of none.
pub fn of_texts(texts: &Texts) -> Option<Result<String, ReportError>> {
    if texts.contains_key(published::RESULT) {
        return Some(published::page(texts));
    }
    if texts.contains_key(diagnosis::RESULT) {
        return Some(diagnosis::page(texts));
    }
    texts.contains_key(comparison::RESULT).then(|| comparison::page(texts))
}

/// The page of a list of runs.
pub fn of_list(summary: &ListSummary) -> Result<String, ReportError> {
    list::page(summary)
}

/// The page of what a campaign has come to.
pub fn of_campaign(results: &Results) -> Result<String, ReportError> {
    campaign::page(results)
}

fn read(path: &Path) -> Result<String, ReportError> {
    fs::read_to_string(path).map_err(|source| io_error(path, source))
}

fn io_error(path: &Path, source: io::Error) -> ReportError {
    ReportError::Io { path: path.to_owned(), source }
}

fn misunderstood(file: &str, why: &dyn std::fmt::Display) -> ReportError {
    ReportError::Misunderstood { file: file.to_owned(), why: why.to_string() }
}

/// The JSON object in the file `name` of `texts`.
fn object(texts: &Texts, name: &str) -> Result<Value, ReportError> {
    let text = texts.get(name).map_or("null", String::as_str);
    serde_json::from_str(text).map_err(|error| misunderstood(name, &error))
}
