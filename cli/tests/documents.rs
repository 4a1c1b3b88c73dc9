//! What the documents show works: commands in blocks marked `sh run` are run as they stand there, page by page in
//! a folder that is empty at first, and print what stands in the `text` block below them. Other blocks of commands or output are marked
//! as examples: `sh example`, `text example`.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A line of output that ends so is shown up to there.
const CUT: char = '…';

/// Languages of commands; pages use the first.
const SHELLS: [&str; 4] = ["sh", "bash", "console", "shell"];

/// A block of a page between fences.
struct Block<'a> {
    /// Of its first fence, counted from 1.
    line: usize,
    language: &'a str,
    /// The word behind the language.
    manner: &'a str,
    lines: Vec<&'a str>,
}

impl Block<'_> {
    fn is_run(&self) -> bool {
        (self.language, self.manner) == ("sh", "run")
    }

    fn is_example(&self) -> bool {
        self.manner == "example"
    }
}

/// The pages, by their names from the root of the repository.
fn pages() -> Vec<(String, String)> {
    let root = root();
    let docs = fs::read_dir(root.join("docs")).expect("docs").map(|entry| entry.expect("a page"));
    let docs = docs.map(|entry| format!("docs/{}", entry.file_name().display()));
    let mut names: Vec<String> = docs.filter(|name| name.ends_with(".md")).collect();
    names.extend(["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md"].map(str::to_owned));
    names.sort();
    let read = |name: String| {
        let text = fs::read_to_string(root.join(&name)).expect("a page");
        (name, text)
    };
    names.into_iter().map(read).collect()
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn blocks(page: &str) -> Vec<Block<'_>> {
    let mut blocks = Vec::new();
    let mut open: Option<Block<'_>> = None;
    for (line, text) in (1..).zip(page.lines()) {
        match (text.trim_start().strip_prefix("```"), open.take()) {
            (Some(_), Some(block)) => blocks.push(block),
            (Some(words), None) => {
                let mut words = words.split_whitespace();
                let [language, manner] = [(); 2].map(|()| words.next().unwrap_or_default());
                open = Some(Block { line, language, manner, lines: Vec::new() });
            }
            (None, Some(mut block)) => {
                block.lines.push(text);
                open = Some(block);
            }
            (None, None) => {}
        }
    }
    blocks
}

/// What is wrong with the marks of the blocks of a page, with their lines.
fn unmarked(page: &str) -> Vec<(usize, &'static str)> {
    let mut wrong = Vec::new();
    let mut follows_a_run = false;
    for block in blocks(page) {
        let what = match block.language {
            "" => Some("a block says its language: ```sh, ```text, ```toml …"),
            "sh" if block.is_run() || block.is_example() => None,
            shell if SHELLS.contains(&shell) => Some("commands are ```sh run or ```sh example"),
            "text" if follows_a_run || block.is_example() => None,
            "text" => Some("output below no ```sh run is ```text example"),
            _ => None,
        };
        wrong.extend(what.map(|what| (block.line, what)));
        follows_a_run = block.is_run();
    }
    wrong
}

/// Whether `said` has the line that a page shows.
fn has_line(said: &str, shown: &str) -> bool {
    let shown = shown.trim_end();
    let is_shown = |one: &str| match shown.strip_suffix(CUT) {
        Some(start) => one.starts_with(start.trim_end()),
        None => one.trim_end() == shown,
    };
    shown.is_empty() || said.lines().any(is_shown)
}

/// What `command` prints, run by a shell in `folder` with our `plunge` first on its path.
fn output(command: &str, folder: &Path) -> String {
    let program = Path::new(env!("CARGO_BIN_EXE_plunge"));
    let programs = program.parent().expect("the program is in a folder").to_owned();
    let others = env::var_os("PATH").unwrap_or_default();
    let path = env::join_paths([programs].into_iter().chain(env::split_paths(&others)));
    let ended = Command::new("sh")
        .args(["-c", command])
        .current_dir(folder)
        .env("PATH", path.expect("a path"))
        .env_remove("PLUNGE_CACHE")
        .output()
        .expect("a shell");
    let errors = String::from_utf8_lossy(&ended.stderr);
    assert!(ended.status.success(), "{command}: {errors}");
    String::from_utf8(ended.stdout).expect("UTF-8")
}

#[test]
fn every_block_of_commands_is_run_or_marked_as_an_example() {
    let mut wrong = String::new();
    let mut blocks_of_all = 0;
    for (name, page) in pages() {
        blocks_of_all += blocks(&page).len();
        for (line, what) in unmarked(&page) {
            wrong.push_str(&format!("{name}:{line}: {what}\n"));
        }
    }
    assert_eq!(wrong, "");
    // Pages whose blocks are not found would pass without one.
    assert!(blocks_of_all >= 20, "{blocks_of_all}");
}

#[cfg(unix)]
#[test]
fn every_command_of_a_page_runs_and_prints_what_the_page_shows() {
    let (mut commands, mut shown, mut wrong) = (0, 0, String::new());
    for (name, page) in pages() {
        let here = tempfile::tempdir().expect("a folder");
        let mut said = String::new();
        for block in blocks(&page) {
            if block.is_run() {
                commands += block.lines.len();
                said = block.lines.iter().map(|line| output(line, here.path())).collect();
            } else if block.language == "text" && !block.is_example() {
                for (at, line) in (block.line + 1..).zip(block.lines) {
                    shown += 1;
                    if !has_line(&said, line) {
                        wrong.push_str(&format!("{name}:{at}: {line:?} is not in\n{said}\n"));
                    }
                }
            }
        }
        for folder in fs::read_dir(here.path().join("runs")).into_iter().flatten() {
            let folder = folder.expect("results").path();
            let is_hidden = folder.file_name().is_some_and(|name| name == ".cache");
            assert!(is_hidden || folder.join("report.html").is_file(), "{}", folder.display());
        }
    }
    assert_eq!(wrong, "");
    assert!(commands >= 10 && shown >= 10, "{commands} commands, {shown} lines shown");
}

#[test]
fn a_block_without_its_mark_is_told_with_its_line() {
    let page = "# A page\n\n```sh\nplunge run x\n```\n\n```text\nx\n```\n\n```sh run\ntrue\n```\n\n\
                ```text\nx\n```\n\n```text\ny\n```\n\n```console example\n$ true\n```\n\n```\nx\n```\n";
    let lines: Vec<usize> = unmarked(page).into_iter().map(|(line, _)| line).collect();
    assert_eq!(lines, [3, 7, 19, 23, 27]);
    assert_eq!(unmarked("```sh example\nx\n```\n\n```text example\ny\n```\n\n```toml\n```\n"), []);
}

#[test]
fn a_line_that_is_cut_is_compared_up_to_there() {
    let said = "depth 1.25 mm\n  range 3 mm  \n";
    for shown in ["depth 1.25 mm", "  range 3 mm", "depth …", "", "…"] {
        assert!(has_line(said, shown), "{shown:?}");
    }
    for shown in ["depth 1.26 mm", "range 3 mm", "width …"] {
        assert!(!has_line(said, shown), "{shown:?}");
    }
}
