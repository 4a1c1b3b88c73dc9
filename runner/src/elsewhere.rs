//! Impacts on other machines: a list of tasks in the cache, which all of them see, and a scheduler that has
//! each of them done.
//!
//! A task leaves its bed or its record in the cache as an impact of this process would, so that whoever asked
//! for it finds it there. What was handed over and not waited for is found likewise, later.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::sleep;
use std::time::{Duration, Instant};

use configs::{BedSource, ConfigError, LoadOptions, Medium, Model, ModelSource};
use engine::checkpoint::write_whole;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::error::CampaignError;
use crate::hexadecimal;
use crate::run::result_key;
use crate::schedulers::{Array, Scheduler, Word, script};
use crate::workers::{Progress, Stage, Watch, left};

/// The folder of lists, scripts and logs in a cache.
const FOLDER: &str = "tasks";

/// The word after which a program of ours is given a list, a cache and the number of a task.
pub const WORD: &str = "task";

/// Time between two looks at how far the tasks are.
const LOOK: Duration = Duration::from_millis(500);

/// One thing to be done by another process, on one thread.
pub trait Task: Serialize + DeserializeOwned {
    /// Does it, unless it is done; what it leaves is in `cache`, or where the task says.
    ///
    /// # Errors
    /// If what it needs or leaves cannot be read, prepared or written.
    fn run(&self, cache: &Path) -> Result<(), CampaignError>;
}

/// A model, complete, as another process reads it.
#[derive(Debug, Serialize, Deserialize)]
pub struct ModelText {
    toml: String,
    /// The folder of its table of grains.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    table: Option<PathBuf>,
}

impl ModelText {
    /// That of `model`.
    pub fn of(model: &Model) -> Self {
        let table = match &model.medium {
            Medium::Grains(medium) => match &medium.bed.source {
                BedSource::Csv(table) => table.file.parent().map(Path::to_owned),
                BedSource::Settle(_) => None,
            },
            Medium::Resistive(_) => None,
        };
        Self { toml: model.resolved_toml().to_owned(), table }
    }

    /// The model again.
    ///
    /// # Errors
    /// If its table of grains cannot be read.
    pub fn load(&self) -> Result<Arc<Model>, ConfigError> {
        let source = ModelSource::Text {
            name: "the model of a task".to_owned(),
            text: self.toml.clone(),
            folder: PathBuf::from("."),
        };
        let allow_paths = self.table.iter().cloned().collect();
        let options = LoadOptions { allow_paths, ..LoadOptions::default() };
        Ok(Arc::new(Model::load(source, &options)?.model))
    }
}

/// A scheduler, and a program of ours that it starts.
#[derive(Clone, Debug)]
pub struct Elsewhere {
    scheduler: Scheduler,
    program: PathBuf,
}

impl Elsewhere {
    /// Tasks of `scheduler` that are done by this program, called with [`WORD`].
    ///
    /// # Errors
    /// If the program cannot be found.
    pub fn by(scheduler: Scheduler) -> std::io::Result<Self> {
        Ok(Self { scheduler, program: std::env::current_exe()? })
    }

    /// Has `tasks` done, and waits for them; `is_there` says whether one has left what it is for. If this
    /// process stops waiting, the scheduler goes on with them.
    ///
    /// # Errors
    /// If they cannot be handed over, or not all end well; [`CampaignError::Interrupted`] if `watch` wants
    /// to stop.
    pub fn run<T: Task>(
        &self,
        what: Stage,
        tasks: &[T],
        cache: &Path,
        watch: &dyn Watch,
        is_there: &dyn Fn(usize) -> bool,
    ) -> Result<(), CampaignError> {
        if tasks.is_empty() {
            return Ok(());
        }
        let folder = cache.join(FOLDER);
        let io = |action, path: &Path| {
            let path = path.to_owned();
            move |source| CampaignError::Io { action, path, source }
        };
        fs::create_dir_all(&folder).map_err(io("make", &folder))?;
        let text = serde_json::to_string_pretty(tasks)
            .map_err(|error| io("write", &folder)(error.into()))?;
        let name = hexadecimal(&result_key(&text))[..16].to_owned();
        let list = folder.join(format!("{name}.json"));
        write_whole(&list, text.as_bytes()).map_err(io("write", &list))?;
        let words =
            [Word::Path(&self.program), Word::Plain(WORD), Word::Path(&list), Word::Path(cache)];
        let file = format!("{name}.sh");
        script(&folder, &file, &words)?;
        let numbers: Vec<usize> = (1..=tasks.len()).collect();
        let array = Array {
            name: &format!("plunge-{name}"),
            tasks: &numbers,
            folder: &folder,
            script: &file,
        };
        let (mut waiting, start) = (self.scheduler.begin(&array)?, Instant::now());
        loop {
            let ended = waiting.ended()?;
            let done = (0..tasks.len()).filter(|&at| is_there(at)).count();
            let share = done as f64 / tasks.len() as f64;
            let left = left(start.elapsed(), share);
            watch.progress(&Progress { what, done, of: tasks.len(), left });
            match ended {
                Some(true) => return Ok(()),
                Some(false) => {
                    let undone = tasks.len() - done;
                    return Err(CampaignError::Tasks { undone, of: tasks.len(), folder });
                }
                None if watch.wants_to_stop() => return Err(CampaignError::Interrupted),
                None => sleep(LOOK),
            }
        }
    }
}

/// Does task `number`, counted from 1, of the file `list`, in `cache`: what a scheduler calls a program of ours
/// for. An impact whose steps cannot be trusted is none that failed: it leaves no record.
///
/// # Errors
/// If there is no such task, or what it needs or leaves cannot be read, prepared or written.
pub fn work<T: Task>(list: &Path, cache: &Path, number: usize) -> Result<(), CampaignError> {
    let unreadable = |source| CampaignError::Io { action: "read", path: list.to_owned(), source };
    let text = fs::read_to_string(list).map_err(unreadable)?;
    let tasks: Vec<T> =
        serde_json::from_str(&text).map_err(|error| unreadable(std::io::Error::from(error)))?;
    let task = number.checked_sub(1).and_then(|at| tasks.get(at));
    let none = || CampaignError::NoTask { number, of: tasks.len(), list: list.to_owned() };
    task.ok_or_else(none)?.run(cache)
}
