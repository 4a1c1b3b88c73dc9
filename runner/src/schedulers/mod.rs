//! Schedulers of clusters, called as the programs that they are: numbered tasks, and a script that each of
//! them runs with its number.
//!
//! Nothing is scheduled here. An [`Array`] is handed over, and either left alone ([`Scheduler::submit`]) or
//! waited for ([`Scheduler::begin`]). What a task does has to bear being killed, requeued and done twice.

mod array;
mod error;
mod waiting;

use std::io;
use std::process::{Command, Stdio};

pub use array::{Array, Word, script};
pub use error::SchedulerError;
pub use waiting::Waiting;

use array::{Block, absolute, blocks};

/// Most tasks of a job array: the default of SLURM's `MaxArraySize` less one, as it counts from 0.
const LARGEST_ARRAY: usize = 1000;

/// A scheduler that tasks are given to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scheduler {
    /// SLURM, by job arrays.
    Slurm,
    /// HyperQueue, by one job of many tasks.
    HyperQueue,
}

impl Scheduler {
    /// What `word` means after `--on`: nothing for `local`, the cores of this machine.
    ///
    /// # Errors
    /// If it is none of the words that are known, with all of them.
    pub fn after_on(word: &str) -> Result<Option<Self>, String> {
        match word {
            "local" => Ok(None),
            "slurm" => Ok(Some(Self::Slurm)),
            "hyperqueue" => Ok(Some(Self::HyperQueue)),
            other => Err(format!("`{other}` is none of local, slurm and hyperqueue")),
        }
    }

    /// Hands `array` over and goes on.
    ///
    /// # Errors
    /// If the scheduler is not there or refuses.
    pub fn submit(self, array: &Array<'_>) -> Result<(), SchedulerError> {
        for block in blocks(array.tasks, self.largest_array()) {
            let mut call = self.call(array, &block, false)?;
            let output = call.output().map_err(|source| self.not_there(source))?;
            if !output.status.success() {
                return Err(self.refused(&output.stderr));
            }
        }
        Ok(())
    }

    /// Hands `array` over, to be waited for.
    ///
    /// # Errors
    /// If the scheduler is not there.
    pub fn begin(self, array: &Array<'_>) -> Result<Waiting, SchedulerError> {
        let mut waiting = Waiting::new(self);
        for block in blocks(array.tasks, self.largest_array()) {
            let mut call = self.call(array, &block, true)?;
            let call = call.stdout(Stdio::piped()).stderr(Stdio::piped());
            waiting.push(call.spawn().map_err(|source| self.not_there(source))?);
        }
        Ok(waiting)
    }

    fn program(self) -> &'static str {
        match self {
            Self::Slurm => "sbatch",
            Self::HyperQueue => "hq",
        }
    }

    fn largest_array(self) -> usize {
        match self {
            Self::Slurm => LARGEST_ARRAY,
            Self::HyperQueue => usize::MAX,
        }
    }

    fn call(
        self,
        array: &Array<'_>,
        Block { offset, tasks }: &Block,
        is_waited_for: bool,
    ) -> Result<Command, SchedulerError> {
        let Array { name, folder, script, .. } = array;
        let folder = absolute(folder)?;
        let script = format!("{folder}/{script}");
        let mut call = Command::new(self.program());
        call.stdin(Stdio::null());
        match self {
            Self::Slurm => {
                call.args([format!("--job-name={name}"), format!("--array={tasks}")]);
                call.arg(format!("--export=ALL,PLUNGE_OFFSET={offset}"));
                call.args(["--cpus-per-task=1", "--requeue", "--open-mode=append"]);
                call.arg(format!("--output={folder}/slurm-%A.log"));
                if is_waited_for {
                    call.arg("--wait");
                }
                call.arg(script);
            }
            Self::HyperQueue => {
                call.args(["submit", &format!("--name={name}"), &format!("--array={tasks}")]);
                call.args(["--cpus=1", "--crash-limit=10", "--stdout=none", "--stderr=none"]);
                if is_waited_for {
                    call.arg("--wait");
                }
                call.args(["--", "sh", &script]);
            }
        }
        Ok(call)
    }

    fn not_there(self, source: io::Error) -> SchedulerError {
        let hint = match self {
            Self::Slurm => "SLURM's commands have to be on PATH",
            Self::HyperQueue => {
                "HyperQueue has to be on PATH, and its server be running (hq server start)"
            }
        };
        SchedulerError::NotThere { program: self.program(), source, hint }
    }

    fn refused(self, stderr: &[u8]) -> SchedulerError {
        let why = String::from_utf8_lossy(stderr).trim().to_owned();
        SchedulerError::Refused { program: self.program(), why }
    }
}
