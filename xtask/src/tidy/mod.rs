//! `cargo xtask tidy`: the rules of the repository that no other tool knows.
//!
//! Each rule is a pure function from text to [`Problem`]s; only this file reads the disk.

mod arrows;
mod circles;
mod pages;
mod promises;
mod text;

use std::fmt;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result};
use xshell::{Shell, cmd};

/// A place that breaks a rule, and what would keep it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Problem {
    /// Relative to the workspace.
    file: PathBuf,
    /// Counted from 1.
    line: usize,
    /// What stands there.
    what: String,
    /// What would be right.
    right: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { file, line, what, right } = self;
        write!(f, "{}:{line}: {what}\n    {right}", file.display())
    }
}

/// A file of the repository that is text.
pub(crate) struct TextFile {
    /// Relative to the workspace, with `/` between folders.
    path: PathBuf,
    text: String,
}

/// Checks every rule and prints what was found.
pub(crate) fn run(sh: &Shell) -> Result<ExitCode> {
    let files = text_files(sh)?;
    let metadata = cmd!(sh, "cargo metadata --format-version 1 --no-deps --locked")
        .quiet()
        .read()
        .context("cannot ask cargo for the crates")?;

    let mut problems = arrows::check(&metadata, &files)?;
    problems.extend(circles::check(&files));
    problems.extend(pages::check(&files));
    problems.extend(promises::check(&files));
    problems.extend(files.iter().flat_map(|file| text::check(&file.path, &file.text)));
    problems.sort();

    for problem in &problems {
        eprintln!("{problem}");
    }
    match problems.len() {
        0 => {
            println!("tidy: {} files, nothing to mend", files.len());
            Ok(ExitCode::SUCCESS)
        }
        n => {
            eprintln!("tidy: {n} to mend");
            Ok(ExitCode::FAILURE)
        }
    }
}

/// Every text file that git knows or would offer to add, so a rule speaks before the commit does.
fn text_files(sh: &Shell) -> Result<Vec<TextFile>> {
    let list = cmd!(sh, "git ls-files -z --cached --others --exclude-standard --deduplicate")
        .quiet()
        .read()
        .context("tidy checks what git tracks, so it needs git and a clone")?;
    let mut files = Vec::new();
    for path in list.split_terminator('\0').map(Path::new) {
        let full = sh.current_dir().join(path);
        // Deleted but still in the index, or a submodule.
        if !full.is_file() {
            continue;
        }
        let bytes = std::fs::read(&full).with_context(|| format!("{}", path.display()))?;
        if bytes.contains(&0) {
            continue;
        }
        if let Ok(text) = String::from_utf8(bytes) {
            files.push(TextFile { path: path.to_owned(), text });
        }
    }
    Ok(files)
}

/// The lines of a text with their numbers, counted from 1.
fn numbered(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.lines().enumerate().map(|(index, line)| (index + 1, line))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_problem_says_file_line_what_and_what_would_be_right() {
        let problem = Problem {
            file: "engine/src/step.rs".into(),
            line: 7,
            what: "a thing".into(),
            right: "do this instead".into(),
        };
        assert_eq!(problem.to_string(), "engine/src/step.rs:7: a thing\n    do this instead");
    }
}
