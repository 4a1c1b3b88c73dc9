//! The points of a campaign on other machines: a script, and a call of the scheduler that is there.
//!
//! Every task of the scheduler is one point and does what is not done, so that a task that is killed,
//! requeued or submitted twice does no point twice.

use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

use thiserror::Error;

use crate::folder::{Folder, FolderError};
use crate::plan::Planned;
use crate::run::missing;

/// The script in the folder of a campaign.
pub const SCRIPT: &str = "point.sh";

/// Most tasks of a job array: the default of SLURM's `MaxArraySize` less one, as it counts from 0.
const LARGEST_ARRAY: usize = 1000;

/// A scheduler that points are given to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scheduler {
    /// SLURM, by job arrays.
    Slurm,
    /// HyperQueue, by one job of many tasks.
    HyperQueue,
}

/// What a task needs to know to run a point.
#[derive(Clone, Debug)]
pub struct Task {
    /// This program.
    pub program: PathBuf,
    /// The campaign file.
    pub campaign: PathBuf,
    /// The folder of prepared beds.
    pub cache: PathBuf,
    /// Folders below which files may be read.
    pub allow_paths: Vec<PathBuf>,
}

/// Why points are not submitted.
#[derive(Debug, Error)]
pub enum SchedulerError {
    /// It is not installed, or cannot be started.
    #[error("cannot start `{program}`: {source}; {hint}")]
    NotThere {
        /// The program.
        program: &'static str,
        /// Why not.
        source: io::Error,
        /// What to do.
        hint: &'static str,
    },
    /// It refuses.
    #[error("`{program}` refuses: {why}")]
    Refused {
        /// The program.
        program: &'static str,
        /// What it says.
        why: String,
    },
    /// A path that no script can hold.
    #[error("{} is not UTF-8, and a script cannot name it", path.display())]
    NotText {
        /// The path.
        path: PathBuf,
    },
    /// The folder of the campaign.
    #[error(transparent)]
    Folder(#[from] FolderError),
}

impl Scheduler {
    /// Submits the points of `planned` that are not done, and says how many they are.
    ///
    /// # Errors
    /// If the scheduler is not there or refuses, or the folder cannot be used.
    pub fn submit(
        self,
        planned: &Planned,
        folder: &Folder,
        task: &Task,
    ) -> Result<usize, SchedulerError> {
        // Released at the end: the tasks are other processes.
        let _held = folder.claim(&planned.plan)?;
        let points: Vec<usize> =
            missing(planned, folder)?.into_iter().map(|index| index + 1).collect();
        let folder_path = absolute(folder.path())?;
        folder.write(SCRIPT, &script(task, &folder_path)?)?;
        let script = format!("{folder_path}/{SCRIPT}");
        for block in blocks(&points, self.largest_array()) {
            self.call(&self.arguments(&planned.plan.name, &block, &script, &folder_path))?;
        }
        Ok(points.len())
    }

    fn program(self) -> (&'static str, &'static str) {
        match self {
            Self::Slurm => ("sbatch", "SLURM's commands have to be on PATH"),
            Self::HyperQueue => {
                ("hq", "HyperQueue has to be on PATH, and its server be running (hq server start)")
            }
        }
    }

    fn largest_array(self) -> usize {
        match self {
            Self::Slurm => LARGEST_ARRAY,
            Self::HyperQueue => usize::MAX,
        }
    }

    fn arguments(self, name: &str, block: &Block, script: &str, folder: &str) -> Vec<String> {
        let Block { offset, array } = block;
        match self {
            Self::Slurm => vec![
                format!("--job-name={name}"),
                format!("--array={array}"),
                format!("--export=ALL,PLUNGE_OFFSET={offset}"),
                "--cpus-per-task=1".to_owned(),
                "--requeue".to_owned(),
                "--open-mode=append".to_owned(),
                format!("--output={folder}/slurm-%A.log"),
                script.to_owned(),
            ],
            Self::HyperQueue => [
                "submit",
                &format!("--name={name}"),
                &format!("--array={array}"),
                "--cpus=1",
                "--crash-limit=10",
                "--stdout=none",
                "--stderr=none",
                "--",
                "sh",
                script,
            ]
            .map(str::to_owned)
            .to_vec(),
        }
    }

    fn call(self, arguments: &[String]) -> Result<(), SchedulerError> {
        let (program, hint) = self.program();
        let output = Command::new(program)
            .args(arguments)
            .output()
            .map_err(|source| SchedulerError::NotThere { program, source, hint })?;
        match output.status.success() {
            true => Ok(()),
            false => {
                let why = String::from_utf8_lossy(&output.stderr).trim().to_owned();
                Err(SchedulerError::Refused { program, why })
            }
        }
    }
}

/// Tasks of one array: each number and the offset together are a point.
#[derive(Debug, PartialEq, Eq)]
struct Block {
    offset: usize,
    /// As both schedulers take it: `1-5,8`.
    array: String,
}

/// `points`, rising, in arrays whose numbers go from 1 to at most `largest`.
fn blocks(points: &[usize], largest: usize) -> Vec<Block> {
    let block = |point: &usize| (point - 1) / largest;
    points
        .chunk_by(|a, b| block(a) == block(b))
        .map(|points| {
            let offset = block(&points[0]) * largest;
            let runs = points.chunk_by(|a, b| a + 1 == *b).map(|run| {
                let (first, last) = (run[0] - offset, run[run.len() - 1] - offset);
                if first == last { first.to_string() } else { format!("{first}-{last}") }
            });
            Block { offset, array: runs.collect::<Vec<_>>().join(",") }
        })
        .collect()
}

/// What a task does.
fn script(task: &Task, folder: &str) -> Result<String, SchedulerError> {
    let mut command = format!(
        "exec {} sweep {} --out {} --cache {}",
        quoted(&absolute(&task.program)?),
        quoted(&absolute(&task.campaign)?),
        quoted(folder),
        quoted(&absolute(&task.cache)?)
    );
    for path in &task.allow_paths {
        command.push_str(&format!(" --allow-path {}", quoted(&absolute(path)?)));
    }
    Ok(format!(
        "#!/bin/sh\n\
         # One point of the campaign: the task of the scheduler, and where its array begins.\n\
         task=${{SLURM_ARRAY_TASK_ID:-$HQ_TASK_ID}}\n\
         {command} --quiet --point $((task + ${{PLUNGE_OFFSET:-0}}))\n"
    ))
}

/// A task may begin in any folder.
fn absolute(path: &Path) -> Result<String, SchedulerError> {
    let full = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let text = full.to_str().map(str::to_owned);
    text.ok_or_else(|| SchedulerError::NotText { path: path.to_owned() })
}

/// `text` as one word of a shell.
fn quoted(text: &str) -> String {
    format!("'{}'", text.replace('\'', "'\\''"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_become_arrays_no_larger_than_a_scheduler_takes() {
        let block = |offset, array: &str| Block { offset, array: array.to_owned() };
        let points: Vec<usize> = (1..=7).chain([9, 11, 12]).collect();
        assert_eq!(blocks(&points, usize::MAX), [block(0, "1-7,9,11-12")]);
        assert_eq!(blocks(&points, 5), [block(0, "1-5"), block(5, "1-2,4"), block(10, "1-2")]);
        assert_eq!(blocks(&[], 5), []);
    }

    #[test]
    fn a_path_is_one_word_of_a_script_whatever_it_holds() {
        assert_eq!(quoted("it's here; $HOME"), "'it'\\''s here; $HOME'");
    }
}
