//! What is promised is held by tests that exist.

use super::{Problem, TextFile, numbered};

/// The document of promises: tables whose last column names tests as `file::name`.
const DOCUMENT: &str = "docs/promises.md";

/// Checks that every row names what holds it, and that all of that is there.
pub(crate) fn check(files: &[TextFile]) -> Vec<Problem> {
    let Some(document) = files.iter().find(|file| file.path.as_os_str() == DOCUMENT) else {
        return Vec::new();
    };
    let problem = |line, what, right: &str| {
        let file = document.path.clone();
        Problem { file, line, what, right: right.to_owned() }
    };
    let mut problems = Vec::new();
    for (line, content) in rows(&document.text) {
        let named: Vec<(&str, &str)> = references(content).collect();
        if named.is_empty() {
            let what = "a promise that nothing holds".to_owned();
            problems.push(problem(line, what, "name its test as `file::name`, or do not make it"));
        }
        for (file, name) in named {
            if !files.iter().any(|one| one.path.as_os_str() == file && is_run(&one.text, name)) {
                let what = format!("there is no test `{name}` in {file}");
                problems.push(problem(line, what, "name the test as it is called now"));
            }
        }
    }
    problems
}

/// The rows of tables, without heads and the lines under them.
fn rows(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let is_rule = |line: &str| line.starts_with("|--") || line.starts_with("| --");
    let lines: Vec<(usize, &str)> = numbered(text).collect();
    let heads: Vec<usize> =
        lines.iter().filter(|(_, line)| is_rule(line)).map(|(number, _)| number - 1).collect();
    lines.into_iter().filter(move |(number, line)| {
        line.starts_with('|') && !is_rule(line) && !heads.contains(number)
    })
}

/// What stands between backticks and has the form `file::name`.
fn references(row: &str) -> impl Iterator<Item = (&str, &str)> {
    row.split('`').skip(1).step_by(2).filter_map(|quoted| quoted.split_once("::"))
}

/// Whether `text` has a test called `name`, or is a script with a phase of that name.
fn is_run(text: &str, name: &str) -> bool {
    let lines: Vec<&str> = text.lines().map(str::trim_start).collect();
    let is_test = |at: usize| {
        let attributes = lines[..at].iter().rev().take_while(|line| line.starts_with("#["));
        attributes.into_iter().any(|line| *line == "#[test]")
    };
    let function = format!("fn {name}(");
    let phase = format!("{name}() {{");
    (0..lines.len())
        .any(|at| lines[at].starts_with(&function) && is_test(at) || lines[at].starts_with(&phase))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(rows: &str) -> Vec<(usize, String)> {
        let file = |path: &str, text: &str| TextFile { path: path.into(), text: text.to_owned() };
        let document = format!("# Promises\n\n| promise | held by |\n|---|---|\n{rows}\n");
        let tests = "#[test]\nfn it_holds() {}\n\nfn helper() {}\n\
                     proptest! {\n    #[test]\n    fn any_bytes(bytes in bytes()) {}\n}\n";
        let files = [
            file(DOCUMENT, &document),
            file("engine/tests/all.rs", tests),
            file(".ci/run", "look_at_it() {\n    true\n}\n"),
        ];
        check(&files).into_iter().map(|problem| (problem.line, problem.what)).collect()
    }

    #[test]
    fn a_promise_with_its_tests_passes() {
        for held_by in [
            "`engine/tests/all.rs::it_holds`",
            "`engine/tests/all.rs::any_bytes`, `.ci/run::look_at_it`",
        ] {
            assert_eq!(found(&format!("| it holds | {held_by} |")), []);
        }
    }

    #[test]
    fn a_promise_without_a_test_that_exists_is_reported() {
        assert_eq!(
            found("| it holds | |\n| it holds | `engine/tests/all.rs::it_held` |"),
            [
                (5, "a promise that nothing holds".to_owned()),
                (6, "there is no test `it_held` in engine/tests/all.rs".to_owned()),
            ]
        );
        let helper = found("| it holds | `engine/tests/all.rs::helper` |");
        assert_eq!(helper, [(5, "there is no test `helper` in engine/tests/all.rs".to_owned())]);
    }
}
