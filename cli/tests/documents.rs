//! The tour works word by word: its commands are run as they stand in the document, in one folder, and
//! print what stands under them.

use std::env;
use std::path::Path;
use std::process::Command;

const TOUR: &str = include_str!("../../docs/tour.md");

/// A block of the document between fences: its language, and its lines.
struct Block<'a> {
    language: &'a str,
    lines: Vec<&'a str>,
}

fn blocks(document: &str) -> Vec<Block<'_>> {
    let mut blocks = Vec::new();
    let mut open: Option<Block<'_>> = None;
    for line in document.lines() {
        match (line.strip_prefix("```"), open.take()) {
            (Some(_), Some(block)) => blocks.push(block),
            (Some(language), None) => open = Some(Block { language, lines: Vec::new() }),
            (None, Some(mut block)) => {
                block.lines.push(line);
                open = Some(block);
            }
            (None, None) => {}
        }
    }
    blocks
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

#[cfg(unix)]
#[test]
fn every_command_of_the_tour_runs_and_prints_what_the_document_shows() {
    let here = tempfile::tempdir().expect("a folder");
    for name in ["validation", "examples"] {
        let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(name);
        std::os::unix::fs::symlink(data, here.path().join(name)).expect("a link");
    }
    let (mut commands, mut shown, mut said) = (0, 0, String::new());
    for Block { language, lines } in blocks(TOUR) {
        match language {
            "sh" => {
                commands += lines.len();
                said = lines.iter().map(|line| output(line, here.path())).collect();
            }
            "text" => {
                for line in lines {
                    shown += 1;
                    let found = said.lines().any(|one| one.trim_end() == line.trim_end());
                    assert!(found, "{line:?} is not in\n{said}");
                }
            }
            other => panic!("the tour has a block of {other:?}"),
        }
    }
    // A document whose blocks are not found would pass without a command.
    assert!(commands >= 10 && shown >= 10, "{commands} commands, {shown} lines shown");
    for report in ["runs/two-term-vector", "runs/seen", "runs/both", "runs/sphere-in-beads"] {
        assert!(here.path().join(report).join("report.html").is_file(), "{report}");
    }
}
