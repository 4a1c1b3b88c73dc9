//! Numbered tasks, and the script that each of them runs.

use std::path::Path;

use engine::checkpoint::write_whole;

use super::error::SchedulerError;

/// Tasks to be handed over.
#[derive(Clone, Copy, Debug)]
pub struct Array<'a> {
    /// What the scheduler lists them as.
    pub name: &'a str,
    /// Their numbers, rising, from 1.
    pub tasks: &'a [usize],
    /// Where the script is and where logs go, on a disk that all machines see.
    pub folder: &'a Path,
    /// The script's name there.
    pub script: &'a str,
}

/// A word of the command that tasks run.
#[derive(Clone, Copy, Debug)]
pub enum Word<'a> {
    /// As it is.
    Plain(&'a str),
    /// A path, made absolute.
    Path(&'a Path),
}

/// Leaves the script `name` in `folder`: `command`, with the number of the task as its last word.
///
/// # Errors
/// If a path of it is not text, or the script cannot be written.
pub fn script(folder: &Path, name: &str, command: &[Word<'_>]) -> Result<(), SchedulerError> {
    let word = |word: &Word<'_>| match word {
        Word::Plain(text) => Ok(quoted(text)),
        Word::Path(path) => absolute(path).map(|text| quoted(&text)),
    };
    let words = command.iter().map(word).collect::<Result<Vec<_>, _>>()?;
    let text = format!(
        "#!/bin/sh\n\
         # One task: its number with the scheduler, and where its array begins.\n\
         task=${{SLURM_ARRAY_TASK_ID:-$HQ_TASK_ID}}\n\
         exec {} $((task + ${{PLUNGE_OFFSET:-0}}))\n",
        words.join(" ")
    );
    let path = folder.join(name);
    write_whole(&path, text.as_bytes()).map_err(|source| SchedulerError::Script { path, source })
}

/// Tasks of one call: each number and the offset together are a task.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Block {
    pub(super) offset: usize,
    /// As both schedulers take it: `1-5,8`.
    pub(super) tasks: String,
}

/// `tasks`, rising, in arrays whose numbers go from 1 to at most `largest`.
pub(super) fn blocks(tasks: &[usize], largest: usize) -> Vec<Block> {
    let block = |task: &usize| (task - 1) / largest;
    tasks
        .chunk_by(|a, b| block(a) == block(b))
        .map(|tasks| {
            let offset = block(&tasks[0]) * largest;
            let runs = tasks.chunk_by(|a, b| a + 1 == *b).map(|run| {
                let (first, last) = (run[0] - offset, run[run.len() - 1] - offset);
                if first == last { first.to_string() } else { format!("{first}-{last}") }
            });
            Block { offset, tasks: runs.collect::<Vec<_>>().join(",") }
        })
        .collect()
}

/// `text` as one word of a shell.
fn quoted(text: &str) -> String {
    format!("'{}'", text.replace('\'', "'\\''"))
}

/// A task may begin in any folder.
pub(super) fn absolute(path: &Path) -> Result<String, SchedulerError> {
    let full = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let text = full.to_str().map(str::to_owned);
    text.ok_or_else(|| SchedulerError::NotText { path: path.to_owned() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tasks_become_arrays_no_larger_than_a_scheduler_takes() {
        let block = |offset, tasks: &str| Block { offset, tasks: tasks.to_owned() };
        let tasks: Vec<usize> = (1..=7).chain([9, 11, 12]).collect();
        assert_eq!(blocks(&tasks, usize::MAX), [block(0, "1-7,9,11-12")]);
        assert_eq!(blocks(&tasks, 5), [block(0, "1-5"), block(5, "1-2,4"), block(10, "1-2")]);
        assert_eq!(blocks(&[], 5), []);
    }

    #[test]
    fn a_path_is_one_word_of_a_script_whatever_it_holds() {
        assert_eq!(quoted("it's here; $HOME"), "'it'\\''s here; $HOME'");
    }
}
