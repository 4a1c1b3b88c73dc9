//! Rules for single files: their length, open ends, and paths of one machine.

use std::path::Path;

use super::{Problem, numbered};

/// A file longer than this holds more than one concept.
const MAX_LINES: usize = 600;

/// Spelt in halves, so that this file keeps the rule it checks.
const MARKERS: [&str; 2] = [concat!("TO", "DO"), concat!("FIX", "ME")];
const MACHINE_FOLDERS: [&str; 4] = [
    concat!("/ho", "me/"),
    concat!("/ro", "ot/"),
    concat!("/Us", "ers/"),
    concat!("\\Us", "ers\\"),
];

const CODE: [&str; 7] = ["rs", "toml", "py", "sh", "yml", "yaml", "proto"];

/// Checks one text file against every rule of this kind.
pub(crate) fn check(path: &Path, text: &str) -> Vec<Problem> {
    let mut problems = Vec::new();
    let extension = path.extension().and_then(|extension| extension.to_str());
    let mut problem = |line, what, right: &str| {
        problems.push(Problem { file: path.to_owned(), line, what, right: right.to_owned() });
    };

    let n_lines = text.lines().count();
    if extension == Some("rs") && n_lines > MAX_LINES {
        let what = format!("the file has {n_lines} lines, {MAX_LINES} are allowed");
        problem(MAX_LINES + 1, what, "split it by concept; aim below 400, tests included");
    }
    // `.ci/run` and its like are programs without an extension.
    let is_code = extension.is_none_or(|extension| CODE.contains(&extension));
    for (line, content) in numbered(text) {
        if is_code && let Some(marker) = marker_without_issue(content) {
            let right =
                format!("give the number of its issue, as in `{marker}(#12)`, or do it now");
            problem(line, format!("`{marker}` without an issue"), &right);
        }
        if let Some(folder) = machine_folder(content) {
            let what = format!("a path of one machine (`{folder}…`)");
            problem(line, what, "write it relative to the repository");
        }
    }
    problems
}

/// The marker of an open end in `line` that no `#` and number follow.
fn marker_without_issue(line: &str) -> Option<&'static str> {
    let is_word = |character: char| character.is_alphanumeric() || character == '_';
    MARKERS.into_iter().find(|marker| {
        line.match_indices(marker).any(|(at, _)| {
            let (before, after) = (&line[..at], &line[at + marker.len()..]);
            let whole = !before.ends_with(is_word) && !after.starts_with(is_word);
            let numbered = after
                .split('#')
                .skip(1)
                .any(|rest| rest.starts_with(|character: char| character.is_ascii_digit()));
            whole && !numbered
        })
    })
}

/// The folder in `line` that exists on one machine only; a later part of a longer path or of an
/// address is none.
fn machine_folder(line: &str) -> Option<&'static str> {
    let continues = |character: char| character.is_alphanumeric() || "._-~*}>)".contains(character);
    MACHINE_FOLDERS.into_iter().find(|folder| {
        line.match_indices(folder).any(|(at, _)| {
            // The last kind has a drive before it.
            folder.starts_with('\\') || !line[..at].ends_with(continues)
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(path: &str, text: &str) -> Vec<(usize, String)> {
        check(Path::new(path), text).into_iter().map(|p| (p.line, p.what)).collect()
    }

    #[test]
    fn a_source_file_may_have_600_lines_and_not_one_more() {
        assert_eq!(found("a.rs", &"\n".repeat(600)), []);
        let problem = (601, "the file has 601 lines, 600 are allowed".to_owned());
        assert_eq!(found("a.rs", &"\n".repeat(601)), [problem]);
        assert_eq!(found("data.csv", &"\n".repeat(5000)), []);
    }

    #[test]
    fn an_open_end_needs_the_number_of_its_issue() {
        for marker in MARKERS {
            let bare = format!("fn f() {{}}\n// {marker}: later");
            assert_eq!(found("a.rs", &bare), [(2, format!("`{marker}` without an issue"))]);
            assert_eq!(found(".ci/run", &bare).len(), 1);
            assert_eq!(found("a.rs", &format!("// {marker}(#31): later")), []);
            assert_eq!(found("a.rs", &format!("// {marker}: later, see #31")), []);
            assert_eq!(found("a.rs", &format!("// {marker} # later")).len(), 1);
            assert_eq!(found("a.rs", &format!("const {marker}_LIST: u8 = 1;")), []);
            assert_eq!(found("guide.md", &format!("no {marker} without an issue")), []);
        }
    }

    #[test]
    fn a_path_of_one_machine_is_found_in_every_kind_of_text() {
        for folder in MACHINE_FOLDERS {
            let line = format!("see {folder}me/notes");
            assert_eq!(found("guide.md", &line).len(), 1, "{line}");
        }
        let [unix, ..] = MACHINE_FOLDERS;
        assert_eq!(found("a.toml", &format!("file = \"{unix}me/a.csv\"")).len(), 1);
        assert_eq!(found("a.rs", &format!("// https://example.org{unix}page")), []);
        assert_eq!(found("a.rs", &format!("data{unix}a.csv")), []);
    }
}
