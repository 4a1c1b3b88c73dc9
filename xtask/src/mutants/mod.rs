//! `cargo xtask mutants`: whether tests notice wrong lines.
//!
//! Each mutant is put into a copy of the sources below `target/mutants`, where the tests that have to notice it are built
//! and run. All of them are run on the copy as it is before: a test that fails by itself notices nothing.

mod list;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail, ensure};
use serde_json::Value;
use xshell::{Shell, cmd};

use list::{MUTANTS, Mutant, Suite};

/// Longest time for the tests of one suite; the slowest take a fifth of it. A mutant that makes one of them run for ever is noticed.
const PATIENCE: Duration = Duration::from_secs(300);

/// What became of a mutant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fate {
    /// A test failed.
    Killed,
    /// A test did not end.
    TimedOut,
    /// All tests passed.
    Alive,
    /// It is no program.
    DoesNotBuild,
}

impl Fate {
    fn name(self) -> &'static str {
        match self {
            Self::Killed => "killed",
            Self::TimedOut => "killed: no end",
            Self::Alive => "ALIVE",
            Self::DoesNotBuild => "DOES NOT BUILD",
        }
    }

    fn is_good(self) -> bool {
        matches!(self, Self::Killed | Self::TimedOut)
    }
}

/// Puts in the mutants with these numbers, or all of them, one at a time, and says which of them live.
pub(crate) fn run(sh: &Shell, numbers: &[u32]) -> Result<ExitCode> {
    let chosen: Vec<&Mutant> = MUTANTS
        .iter()
        .filter(|mutant| numbers.is_empty() || numbers.contains(&mutant.number))
        .collect();
    ensure!(
        numbers.is_empty() || chosen.len() == numbers.len(),
        "no mutant has one of these numbers"
    );
    let copy = Copy::make(sh)?;
    let suites: BTreeSet<Suite> = chosen.iter().flat_map(|mutant| mutant.suites).copied().collect();
    println!("{} suites without a mutant", suites.len());
    for suite in suites {
        let fate = copy.fate_of(&[suite])?;
        ensure!(fate == Fate::Alive, "without any mutant, {suite:?} is {}", fate.name());
    }
    let mut fates = Vec::new();
    for mutant in &chosen {
        let start = Instant::now();
        let fate = copy.with(mutant, || copy.fate_of(mutant.suites))?;
        let seconds = start.elapsed().as_secs();
        println!("{:>3}  {:<14}  {:>4} s  {}", mutant.number, fate.name(), seconds, mutant.what);
        fates.push(fate);
    }
    let good = fates.iter().filter(|fate| fate.is_good()).count();
    println!("{good} of {} killed", fates.len());
    Ok(if good == fates.len() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// The sources, to be changed.
struct Copy {
    tree: PathBuf,
    build: PathBuf,
}

impl Copy {
    /// Makes the copy what the sources are; what is the same stays as it is, and is not built again.
    fn make(sh: &Shell) -> Result<Self> {
        let root = sh.current_dir();
        let folder = root.join("target/mutants");
        let (tree, build) = (folder.join("tree"), folder.join("build"));
        let listed =
            cmd!(sh, "git ls-files --cached --others --exclude-standard -z").quiet().read()?;
        for name in listed.split('\0').filter(|name| !name.is_empty()) {
            // What was removed is still listed until that is committed.
            let Ok(content) = fs::read(root.join(name)) else { continue };
            write_if_other(&tree.join(name), &content)?;
        }
        Ok(Self { tree, build })
    }

    /// What `work` says with `mutant` in place.
    fn with<T>(&self, mutant: &Mutant, work: impl FnOnce() -> Result<T>) -> Result<T> {
        let path = self.tree.join(mutant.file);
        let before = fs::read_to_string(&path).with_context(|| path.display().to_string())?;
        fs::write(&path, mutant.of(&before)?)?;
        let outcome = work();
        fs::write(&path, before)?;
        outcome
    }

    /// What the tests of `suites` say: the first that notices something ends it.
    fn fate_of(&self, suites: &[Suite]) -> Result<Fate> {
        for suite in suites {
            let Some(programs) = self.built(suite)? else { return Ok(Fate::DoesNotBuild) };
            for program in programs {
                match program.passes(suite.filter)? {
                    Some(true) => {}
                    Some(false) => return Ok(Fate::Killed),
                    None => return Ok(Fate::TimedOut),
                }
            }
        }
        Ok(Fate::Alive)
    }

    /// The test programs of `suite`; `None` if they cannot be built.
    fn built(&self, suite: &Suite) -> Result<Option<Vec<Program>>> {
        let mut cargo = Command::new("cargo");
        cargo.args(["test", "--locked", "--no-run", "--message-format=json", "-p", suite.package]);
        match suite.target {
            "" => cargo.arg("--lib"),
            target => cargo.args(["--test", target]),
        };
        cargo.current_dir(&self.tree).env("CARGO_TARGET_DIR", &self.build).stderr(Stdio::null());
        let output = cargo.output().context("cannot start cargo")?;
        if !output.status.success() {
            return Ok(None);
        }
        let text = String::from_utf8_lossy(&output.stdout);
        let messages = text.lines().filter_map(|line| serde_json::from_str::<Value>(line).ok());
        let programs: Vec<Program> = messages
            .filter(|message| message["profile"]["test"] == true)
            .filter_map(|message| Program::of(&message))
            .collect();
        ensure!(!programs.is_empty(), "{suite:?} has no test program");
        Ok(Some(programs))
    }
}

/// A test program, and the folder that it expects to be started in.
struct Program {
    path: PathBuf,
    folder: PathBuf,
}

impl Program {
    fn of(message: &Value) -> Option<Self> {
        let path = PathBuf::from(message["executable"].as_str()?);
        let folder = Path::new(message["manifest_path"].as_str()?).parent()?.to_owned();
        Some(Self { path, folder })
    }

    /// Whether the tests with `filter` in their names pass; `None` if they do not end.
    fn passes(&self, filter: &str) -> Result<Option<bool>> {
        let mut program = Command::new(&self.path);
        program.arg(filter).current_dir(&self.folder).stdout(Stdio::null()).stderr(Stdio::null());
        let mut tests = program.spawn().with_context(|| self.path.display().to_string())?;
        let start = Instant::now();
        while start.elapsed() < PATIENCE {
            if let Some(status) = tests.try_wait()? {
                return Ok(Some(status.success()));
            }
            std::thread::sleep(Duration::from_millis(50));
        }
        tests.kill()?;
        tests.wait()?;
        Ok(None)
    }
}

impl Mutant {
    /// `source` with its edits.
    fn of(&self, source: &str) -> Result<String> {
        let mut source = source.to_owned();
        for (from, to) in self.edits {
            match source.matches(from).count() {
                1 => source = source.replacen(from, to, 1),
                n => bail!("mutant {}: {} has {n} times: {from}", self.number, self.file),
            }
        }
        Ok(source)
    }
}

/// Writes `path` unless that is what it holds.
fn write_if_other(path: &Path, content: &[u8]) -> Result<()> {
    if fs::read(path).is_ok_and(|held| held == content) {
        return Ok(());
    }
    fs::create_dir_all(path.parent().context("a file has a folder")?)?;
    fs::write(path, content).with_context(|| path.display().to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_mutant_has_a_number_of_its_own_and_changes_what_stands_in_its_file() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let numbers: BTreeSet<u32> = MUTANTS.iter().map(|mutant| mutant.number).collect();
        assert_eq!(numbers.len(), MUTANTS.len());
        for mutant in MUTANTS {
            let source = fs::read_to_string(root.join(mutant.file)).expect(mutant.file);
            assert_ne!(mutant.of(&source).expect("it applies"), source);
            assert!(!mutant.suites.is_empty(), "{}", mutant.number);
        }
    }
}
