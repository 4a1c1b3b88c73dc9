//! Outcomes of trials that are kept while others are still diagnosed, one JSON object per line.

use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::plan::Plan;
use super::trial::{Outcome, Trial};

/// Outcomes so far. They are of one program: a diagnosis that was changed wants another file.
pub struct Kept {
    known: BTreeMap<String, Outcome>,
    file: Mutex<File>,
    path: PathBuf,
}

/// A file of outcomes that cannot be read or written.
#[derive(Debug, Error)]
#[error("{}: {why}", path.display())]
pub struct KeptError {
    path: PathBuf,
    why: String,
}

/// One line.
#[derive(Serialize, Deserialize)]
struct Line {
    trial: String,
    outcome: Outcome,
}

impl Kept {
    /// Reads the file at `path`, or creates it. A last line that a kill has cut off is left out.
    ///
    /// # Errors
    /// If it cannot be read or written, or has another line that is no outcome.
    pub fn open(path: &Path) -> Result<Self, KeptError> {
        let failed = |why: String| KeptError { path: path.to_owned(), why };
        let text = match std::fs::read_to_string(path) {
            Err(error) if error.kind() == ErrorKind::NotFound => String::new(),
            read => read.map_err(|error| failed(error.to_string()))?,
        };
        let mut known = BTreeMap::new();
        for (number, line) in text.split_inclusive('\n').enumerate() {
            match serde_json::from_str::<Line>(line) {
                Ok(line) => known.insert(line.trial, line.outcome),
                Err(_) if !line.ends_with('\n') => None,
                Err(error) => {
                    return Err(failed(format!("line {} is no outcome: {error}", number + 1)));
                }
            };
        }
        let file = OpenOptions::new().create(true).append(true).open(path);
        let file = file.map_err(|error| failed(error.to_string()))?;
        let whole = text.rfind('\n').map_or(0, |end| end + 1);
        file.set_len(whole as u64).map_err(|error| failed(error.to_string()))?;
        Ok(Self { known, file: Mutex::new(file), path: path.to_owned() })
    }

    /// The trial of `plan`, if it is there.
    pub fn find(&self, plan: &Plan) -> Option<Trial> {
        let outcome = self.known.get(&key(plan))?.clone();
        Some(Trial { plan: plan.clone(), outcome })
    }

    /// Keeps a trial.
    pub fn keep(&self, trial: &Trial) -> Result<(), KeptError> {
        let failed = |why: String| KeptError { path: self.path.clone(), why };
        let line = Line { trial: key(&trial.plan), outcome: trial.outcome.clone() };
        let text = serde_json::to_string(&line).map_err(|error| failed(error.to_string()))?;
        let mut file = self.file.lock().map_err(|error| failed(error.to_string()))?;
        file.write_all((text + "\n").as_bytes()).map_err(|error| failed(error.to_string()))
    }
}

/// What tells a plan from every other: all of it.
fn key(plan: &Plan) -> String {
    format!("{plan:?}")
}

#[cfg(test)]
mod tests {
    use super::super::plan::{Row, Seeds, Size};
    use super::*;

    fn trials(count: usize) -> Vec<Trial> {
        let size = Size { draws: 1, rows: vec![Row::Camera] };
        let plans = size.plans(Seeds::Development).into_iter().step_by(5).take(count);
        let skipped = |plan: Plan| Outcome::Skipped(format!("{} is left out", plan.seed));
        plans.map(|plan| Trial { outcome: skipped(plan.clone()), plan }).collect()
    }

    fn why(trial: Option<Trial>) -> Option<String> {
        match trial?.outcome {
            Outcome::Skipped(why) => Some(why),
            Outcome::Answered(_) => None,
        }
    }

    #[test]
    fn what_is_kept_is_found_again_and_a_line_that_a_kill_cut_off_is_left_out() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("kept.jsonl");
        let trials = trials(2);
        let kept = Kept::open(&path).expect("a new file");
        trials.iter().for_each(|trial| kept.keep(trial).expect("it is written"));
        let text = std::fs::read_to_string(&path).expect("two lines");
        std::fs::write(&path, &text[..text.len() - 10]).expect("it is written");
        let kept = Kept::open(&path).expect("a line and a half");
        let found = |at: usize| why(kept.find(&trials[at].plan));
        assert_eq!(found(0), Some(format!("{} is left out", trials[0].plan.seed)));
        assert_eq!(found(1), None);
        kept.keep(&trials[1]).expect("it is written");
        let kept = Kept::open(&path).expect("two lines");
        assert!(trials.iter().all(|trial| kept.find(&trial.plan).is_some()));
    }

    #[test]
    fn a_whole_line_that_is_no_outcome_is_an_error_with_its_number() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("kept.jsonl");
        std::fs::write(&path, "{}\n").expect("it is written");
        let error = Kept::open(&path).err().map(|error| error.to_string()).unwrap_or_default();
        assert!(error.contains("line 1 is no outcome"), "{error}");
    }
}
