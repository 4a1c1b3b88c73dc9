//! What `compare` and `diagnose` share: a set, models before it, and a folder for results.

use std::fs::{self, File};
use std::io::{self, ErrorKind};
use std::path::{Component, Path, PathBuf};

use clap::Args;
use configs::{LoadOptions, Loaded, Model};
use diagnosis::fit::problem::FitError;
use diagnosis::missing_force;
use diagnosis::observed::Observed;
use diagnosis::resistive::ResistiveForward;
use diagnosis::where_it_fails;
use engine::checkpoint;
use exchange::staging::{STAGING, Staging};
use measurements::{ContradictionKind, MeasurementSet, SetError};

use crate::BEGINS_AGAIN;
use crate::control::stopped;
use crate::host;
use crate::output::{self, CommandError, CommandResult, stderr_color};
use crate::signals;

/// The seed of every resampling when none is given.
const SEED: u64 = 1;

/// The file that says what the results of a folder are from.
const INPUTS: &str = "inputs.blake3";

/// Behind the hash there, while not all results are written.
const UNFINISHED: &str = "unfinished";

/// What these commands write, besides proposed models and [`where_it_fails::FILES`].
const RESULTS: [&str; 8] = [
    "comparison.json",
    "comparison.svg",
    "diagnosis.json",
    "paths.svg",
    CALIBRATION,
    missing_force::FILE,
    where_it_fails::MISSING_FORCE,
    reports::FILE,
];

/// How often verdicts come true, where it was asked.
pub(crate) const CALIBRATION: &str = "calibration.json";

/// The flags of commands about a measurement set.
#[derive(Args, Clone, Debug)]
pub(crate) struct Flags {
    /// Change a key of every model; the value is TOML if it parses as TOML, else a string.
    #[arg(long = "set", value_name = "KEY.PATH=VALUE")]
    sets: Vec<String>,
    /// The seed of resampling; equal seeds give equal bytes.
    #[arg(long, default_value_t = SEED)]
    pub(crate) seed: u64,
    /// The folder to write to.
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print one JSON object to stdout.
    #[arg(long)]
    pub(crate) json: bool,
    /// No notes and no warnings.
    #[arg(long)]
    pub(crate) quiet: bool,
    /// Replace results of other inputs.
    #[arg(long)]
    force: bool,
    /// Impacts on beds of grains at a time, 1 to 256; no result depends on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    pub(crate) threads: Option<u16>,
    /// Go on although the trajectories contradict stopping times, final depths or final ranges.
    #[arg(long)]
    trust_scalars: bool,
    /// Go on although the trajectories contradict the zero of depth or clock.
    #[arg(long)]
    trust_zeros: bool,
    /// Go on although the trajectories contradict the stated speeds, or look like another unit.
    #[arg(long)]
    trust_speeds: bool,
    /// Let models read data files below this folder too.
    #[arg(long = "allow-path", value_name = "DIR")]
    allow_paths: Vec<PathBuf>,
}

/// A model under the name that the user gave it.
pub(crate) struct Candidate {
    pub(crate) name: String,
    pub(crate) loaded: Loaded,
    /// The file as its author wrote it, unless the command line changed it.
    pub(crate) text: String,
}

/// A set with its observables.
pub(crate) struct Measured {
    pub(crate) set: MeasurementSet,
    pub(crate) observed: Observed,
    folder: PathBuf,
}

impl From<SetError> for CommandError {
    fn from(error: SetError) -> Self {
        Self::BadInput(error.render(stderr_color()))
    }
}

impl Flags {
    /// Reads the set at `path`, which `models` are to answer, and shows its warnings.
    ///
    /// # Errors
    /// Everything that is wrong with it; or where it contradicts its own frames, unless a flag says to go
    /// on.
    pub(crate) fn measured(
        &self,
        path: &Path,
        models: &[PathBuf],
    ) -> Result<Measured, CommandError> {
        // What is wrong with a model is said once the set is read.
        let each = models.iter().filter_map(|name| self.load(name).ok());
        let grains = each.filter_map(|loaded| Some(loaded.model.grains()?.largest_grain()));
        let loaded = MeasurementSet::load_over_grains(path, grains.fold(0.0, f64::max))?;
        let (trusted, doubted) = self.trusted();
        let doubts = loaded.render_contradictions(&doubted, stderr_color());
        if !doubts.is_empty() {
            let how = overruled_by(&loaded, &doubted);
            return Err(CommandError::BadInput(format!(
                "{doubts}error: nothing is fitted to a set that contradicts itself; {how}\n"
            )));
        }
        if !self.quiet {
            output::to_stderr(&loaded.render_contradictions(&trusted, stderr_color()));
            output::to_stderr(&loaded.render_warnings(stderr_color()));
        }
        let measurements::Loaded { mut set, contradictions, .. } = loaded;
        let overruled = contradictions.iter().map(|one| &one.diagnostic.message);
        set.notes.extend(overruled.map(|what| format!("Overruled by a flag: {what}.")));
        let folder = match path.is_dir() {
            true => path.to_owned(),
            false => path.parent().unwrap_or(Path::new("")).to_owned(),
        };
        Ok(Measured { observed: Observed::of(&set), set, folder })
    }

    /// `measured` as all of `models` can answer it: force laws say nothing of craters.
    ///
    /// # Errors
    /// If craters are all that it holds.
    pub(crate) fn answerable(
        &self,
        measured: Measured,
        models: &[Candidate],
    ) -> Result<Measured, CommandError> {
        let Some(law) = models.iter().find(|model| model.loaded.model.grains().is_none()) else {
            return Ok(measured);
        };
        let (set, had) = measured.set.without_craters();
        if !had {
            return Ok(Measured { set, ..measured });
        }
        let observed = Observed::of(&set);
        if observed.conditions.iter().all(|condition| condition.layout.is_empty()) {
            return Err(CommandError::bad_input(format!(
                "{} holds craters alone, of which the force law {} says nothing; a bed of grains does, or add depths or stopping times",
                set.id, law.loaded.model.run.name
            )));
        }
        self.notes(&[
            "The craters of the set are left out: a force law says nothing of them, a bed of grains does"
                .to_owned(),
        ]);
        Ok(Measured { observed, set, ..measured })
    }

    /// Kinds of contradictions that a flag overrules, and the others.
    fn trusted(&self) -> (Vec<ContradictionKind>, Vec<ContradictionKind>) {
        ContradictionKind::ALL.into_iter().partition(|kind| match kind {
            ContradictionKind::Speeds => self.trust_speeds,
            ContradictionKind::Zeros => self.trust_zeros,
            ContradictionKind::Scalars => self.trust_scalars,
        })
    }

    /// The models called `names`, or the baseline that the set starts from.
    pub(crate) fn models(
        &self,
        names: &[PathBuf],
        measured: &Measured,
    ) -> Result<Vec<Candidate>, CommandError> {
        if !names.is_empty() {
            return names.iter().map(|name| self.model(name, name)).collect();
        }
        let Some(baseline) = &measured.set.baseline else {
            return Err(CommandError::bad_input(format!(
                "the set {} names no baseline; give --model, or `[model] baseline`",
                measured.set.id
            )));
        };
        if configs::find_shipped(baseline).is_some() {
            return Ok(vec![self.model(Path::new(baseline), Path::new(baseline))?]);
        }
        // A set may be from anywhere: it names a model beside it, and no other file.
        let is_below =
            Path::new(baseline).components().all(|part| matches!(part, Component::Normal(_)));
        let path = measured.folder.join(baseline);
        if !is_below || !path.is_file() {
            let shipped: Vec<&str> = configs::SHIPPED.iter().map(|model| model.name).collect();
            return Err(CommandError::bad_input(format!(
                "`[model] baseline = \"{baseline}\"` of the set {} is no file beside the set and no \
                 shipped model; shipped: {}",
                measured.set.id,
                shipped.join(", ")
            )));
        }
        Ok(vec![self.model(Path::new(baseline), &path)?])
    }

    /// Whether `--set` was given.
    pub(crate) fn change_models(&self) -> bool {
        !self.sets.is_empty()
    }

    /// The folder that `--out` names, for results that follow from `inputs`; none without `--out`.
    pub(crate) fn chosen_results(
        &self,
        inputs: &blake3::Hash,
    ) -> Result<Option<Results>, CommandError> {
        let claim = |folder| Results::claim(folder, &inputs.to_hex(), self.force);
        self.out.clone().map(claim).transpose()
    }

    fn load(&self, path: &Path) -> Result<Loaded, CommandError> {
        let options = LoadOptions {
            sets: self.sets.clone(),
            seed: None,
            allow_paths: self.allow_paths.clone(),
        };
        Ok(Model::load(host::model_source(path), &options)?)
    }

    fn model(&self, name: &Path, path: &Path) -> Result<Candidate, CommandError> {
        let loaded = self.load(path)?;
        if !self.quiet {
            output::show_warnings(&loaded);
        }
        // What the command line changed has to be in a model that is proposed.
        let text = match self.sets.is_empty() {
            true => loaded.original.clone(),
            false => loaded.model.resolved_toml().to_owned(),
        };
        Ok(Candidate { name: name.display().to_string(), loaded, text })
    }

    /// Shows sentences about what was assumed or left aside.
    pub(crate) fn notes(&self, notes: &[String]) {
        if !self.quiet {
            for note in notes {
                output::to_stderr(&format!("note: {}\n", configs::printable(note)));
            }
        }
    }

    /// The folder for the results of `command`, which follow from `inputs`.
    pub(crate) fn results(
        &self,
        measured: &Measured,
        command: &str,
        models: &[Candidate],
    ) -> Result<Results, CommandError> {
        self.results_of(measured, command, models, "")
    }

    /// The same, for results that follow from `more` as well.
    pub(crate) fn results_of(
        &self,
        measured: &Measured,
        command: &str,
        models: &[Candidate],
        more: &str,
    ) -> Result<Results, CommandError> {
        let default = || PathBuf::from("runs").join(format!("{}-{command}", measured.set.id));
        let folder = self.out.clone().unwrap_or_else(default);
        let mut hash = blake3::Hasher::new();
        hash.update(env!("CARGO_PKG_VERSION").as_bytes());
        // Names of runs and the order of rows are no inputs: the observables are in an order of their own.
        let MeasurementSet {
            id,
            kind,
            instrument,
            bed,
            stated,
            stop,
            last,
            feasible,
            conditions,
            ..
        } = &measured.set;
        let set = (id, kind, instrument, bed, stated, stop, last, feasible, conditions);
        hash.update(format!("{command} {} {set:?}", self.seed).as_bytes());
        hash.update(more.as_bytes());
        hash.update(format!("{:?}", measured.observed.conditions).as_bytes());
        for model in models {
            hash.update(model.name.as_bytes());
            hash.update(model.loaded.model.resolved_toml().as_bytes());
        }
        Results::claim(folder, &hash.finalize().to_hex(), self.force)
    }
}

/// Which flags go on with `loaded` all the same.
pub(crate) fn overruled_by(loaded: &measurements::Loaded, doubted: &[ContradictionKind]) -> String {
    let met = |kind: &ContradictionKind| {
        loaded.contradictions.iter().any(|one| one.kind == *kind) && doubted.contains(kind)
    };
    let flags: Vec<&str> = ContradictionKind::ALL
        .into_iter()
        .filter(met)
        .map(|kind| match kind {
            ContradictionKind::Speeds => "--trust-speeds",
            ContradictionKind::Zeros => "--trust-zeros",
            ContradictionKind::Scalars => "--trust-scalars",
        })
        .collect();
    format!("{} goes on all the same", flags.join(" "))
}

impl Candidate {
    /// The model before the set; says which of its parameters the set cannot tell anything of.
    pub(crate) fn forward(
        &self,
        measured: &Measured,
        flags: &Flags,
    ) -> Result<ResistiveForward, CommandError> {
        self.forward_before(&measured.set, measured, flags)
    }

    /// The same with the errors shared by runs that the set states, and no others: `compare` reports the whole error of a
    /// model, but what the user knows of the apparatus.
    pub(crate) fn forward_before_stated_apparatus(
        &self,
        measured: &Measured,
        flags: &Flags,
    ) -> Result<ResistiveForward, CommandError> {
        let instrument = measured.set.instrument.with_stated_errors_alone();
        let exact = MeasurementSet { instrument, ..measured.set.clone() };
        self.forward_before(&exact, measured, flags)
    }

    /// The model before `set`, whose runs are `observed`.
    ///
    /// # Errors
    /// If it cannot predict what the set has.
    pub(crate) fn forward_of(
        &self,
        set: &MeasurementSet,
        observed: &Observed,
    ) -> Result<ResistiveForward, CommandError> {
        ResistiveForward::new(&self.loaded.model, set, &observed.layouts())
            .map_err(|error| CommandError::bad_input(format!("{}: {error}", self.name)))
    }

    fn forward_before(
        &self,
        set: &MeasurementSet,
        measured: &Measured,
        flags: &Flags,
    ) -> Result<ResistiveForward, CommandError> {
        let forward = self.forward_of(set, &measured.observed)?;
        if !forward.idle().is_empty() {
            let (n, first) = (forward.idle().len(), &forward.idle()[0]);
            let which = match n {
                1 => first.clone(),
                _ => format!("{first} and {} others", n - 1),
            };
            let name = &self.name;
            flags.notes(&[format!(
                "{name}: nothing in the set depends on {which}; left as they are"
            )]);
        }
        let unused = forward.unused_priors();
        if !unused.is_empty() {
            let (name, unused) = (&self.name, unused.join(", "));
            flags.notes(&[format!(
                "{name}: the set has priors for {unused}, which the model does not leave free; [fit] free names what it does"
            )]);
        }
        Ok(forward)
    }
}

/// A failure of the numbers themselves: too little to fit to is bad input, the rest is not.
pub(crate) fn failed(error: FitError, name: &str) -> CommandError {
    match error {
        FitError::TooFew { .. } | FitError::NoErrors => {
            CommandError::bad_input(format!("{name}: {error}"))
        }
        error => CommandError::Failed(anyhow::Error::new(error).context(name.to_owned())),
    }
}

/// A folder that results are written to.
pub(crate) struct Results {
    folder: PathBuf,
    inputs: String,
}

impl Results {
    /// A folder that holds nothing, results of the same inputs, or what may be replaced.
    fn claim(folder: PathBuf, inputs: &str, replace: bool) -> Result<Self, CommandError> {
        let stamp = folder.join(INPUTS);
        let shown = folder.display();
        let refusal = match fs::read_to_string(&stamp) {
            Ok(found) => {
                let of = found.split_whitespace().next().unwrap_or_default();
                (of != inputs).then_some("results of other inputs")
            }
            Err(error) if error.kind() == ErrorKind::NotFound => {
                let occupied = fs::read_dir(&folder)
                    .is_ok_and(|files| files.flatten().any(|file| file.file_name() != STAGING));
                occupied.then_some("files that are no results of this command")
            }
            Err(error) => {
                return Err(CommandError::bad_input(format!(
                    "{shown} is no folder that results can be written to: {error}"
                )));
            }
        };
        match refusal {
            Some(what) if !replace => Err(CommandError::bad_input(format!(
                "{shown} holds {what}; choose another --out, or --force to write there"
            ))),
            _ => Ok(Self { folder, inputs: inputs.to_owned() }),
        }
    }

    /// The file `name` that an earlier call with the same inputs has written.
    pub(crate) fn written_before(&self, name: &str) -> Option<String> {
        let stamp = fs::read_to_string(self.folder.join(INPUTS)).ok()?;
        let text = || fs::read_to_string(self.folder.join(name)).ok();
        (stamp.trim_end() == self.inputs).then(text).flatten()
    }

    /// Writes the files, and what they are from. All of them are on the disk before the first of an earlier call is
    /// touched: if there is no room for them, those are kept. Whoever has asked to stop waits for no results any more.
    pub(crate) fn write(&self, files: &[(String, String)]) -> CommandResult {
        if signals::is_asked_to_stop() {
            return Err(stopped(BEGINS_AGAIN));
        }
        let cannot = |what: &str, path: &Path, error: io::Error| {
            let shown = format!("cannot {what} {}", path.display());
            CommandError::Failed(anyhow::Error::new(error).context(shown))
        };
        let folder = &self.folder;
        fs::create_dir_all(folder).map_err(|error| match error.kind() {
            ErrorKind::StorageFull => cannot("make", folder, error),
            _ => CommandError::bad_input(format!("cannot make {}: {error}", folder.display())),
        })?;
        // Two calls with the same results write them one after the other.
        let handle = File::open(folder).map_err(|error| cannot("open", folder, error))?;
        handle.lock().map_err(|error| cannot("lock", folder, error))?;
        let staging =
            Staging::at(folder.join(STAGING)).map_err(|error| cannot("make", folder, error))?;
        let begun = (UNFINISHED, format!("{} {UNFINISHED}\n", self.inputs));
        let ended = (INPUTS, format!("{}\n", self.inputs));
        for (name, text) in [&begun, &ended].map(|(name, text)| (*name, text.as_str())) {
            write_whole(&staging.path().join(name), text)?;
        }
        for (name, text) in files {
            write_whole(&staging.path().join(name), text)?;
        }
        let hand_over = |name: &str, to: &str| {
            let path = folder.join(to);
            staging.hand_over(name, &path).map_err(|error| cannot("write", &path, error))
        };
        // Whoever is stopped on the way may write here again: from now on the folder is of these inputs.
        hand_over(UNFINISHED, INPUTS)?;
        let is_new = |name: &String| files.iter().any(|(new, _)| new == name);
        for name in self.earlier()?.into_iter().filter(|name| !is_new(name)) {
            let path = folder.join(name);
            fs::remove_file(&path).map_err(|error| cannot("remove", &path, error))?;
        }
        for (name, _) in files {
            hand_over(name, name)?;
        }
        hand_over(INPUTS, INPUTS)
    }

    /// The results of an earlier call, by their names.
    fn earlier(&self) -> Result<Vec<String>, CommandError> {
        let fail = |error| {
            let shown = format!("cannot read {}", self.folder.display());
            CommandError::Failed(anyhow::Error::new(error).context(shown))
        };
        let mut names = Vec::new();
        for entry in fs::read_dir(&self.folder).map_err(fail)? {
            let name = entry.map_err(fail)?.file_name().to_string_lossy().into_owned();
            let proposed = name.starts_with("model+") && name.ends_with(".toml");
            let known = RESULTS.iter().chain(&where_it_fails::FILES);
            if proposed || known.copied().any(|known| known == name) {
                names.push(name);
            }
        }
        names.sort();
        Ok(names)
    }

    /// Where they are, for messages.
    pub(crate) fn shown(&self) -> String {
        self.folder.display().to_string()
    }

    /// That `files` are there.
    pub(crate) fn told(&self, files: &[(String, String)]) -> String {
        let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
        format!("\nwritten to {}: {}\n", self.shown(), names.join(", "))
    }
}

/// Writes the file `path` whole or not at all.
pub(crate) fn write_whole(path: &Path, text: &str) -> CommandResult {
    checkpoint::write_whole(path, text.as_bytes()).map_err(|error| {
        let shown = format!("cannot write {}", path.display());
        CommandError::Failed(anyhow::Error::new(error).context(shown))
    })
}
