//! What is promised is held by tests that exist.

use std::path::Path;

use super::{Problem, TextFile, numbered};

/// The document of promises: tables whose last column names tests as `file::name`.
const DOCUMENT: &str = "docs/promises.md";

/// What runs everything that a change must pass.
const CI: &str = ".ci/run";

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
                let what = format!("there is no test `{name}` in {file} that is run");
                let right = "name the test as it is called now, and do not ignore it";
                problems.push(problem(line, what, right));
            } else if let Some(target) = target_left_out(file, files) {
                let what = format!("{file} is of the target `{target}`, which nothing runs");
                let right = format!("take `test = false` away, or have {CI} run `--test {target}`");
                problems.push(problem(line, what, &right));
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

/// The target of the tests in `file`, if its manifest leaves it out of `cargo test` and nothing else runs it.
fn target_left_out(file: &str, files: &[TextFile]) -> Option<String> {
    let (folder, below) = file.split_once("/tests/")?;
    let manifest = Path::new(folder).join("Cargo.toml");
    let manifest = files.iter().find(|one| one.path == manifest)?;
    let target = below.split(['/', '.']).next()?;
    let named = format!("name = \"{target}\"");
    // Behind the first head, each piece is one target and what follows it.
    let mut targets = manifest.text.split("[[test]]").skip(1);
    let settings = targets.find(|target| target.lines().any(|line| line.trim() == named))?;
    let of_target = settings.lines().take_while(|line| !line.starts_with('['));
    let is_left_out = of_target.into_iter().any(|line| line.trim() == "test = false");
    let ci = files.iter().find(|one| one.path.as_os_str() == CI);
    let is_run = ci.is_some_and(|ci| {
        let words: Vec<&str> = ci.text.split_whitespace().collect();
        words.windows(2).any(|pair| pair == ["--test", target])
    });
    (is_left_out && !is_run).then(|| target.to_owned())
}

/// Whether `text` has a test called `name`, or is a script with a phase of that name.
fn is_run(text: &str, name: &str) -> bool {
    let lines: Vec<&str> = text.lines().map(str::trim_start).collect();
    let is_test = |at: usize| {
        let attributes = lines[..at].iter().rev().take_while(|line| line.starts_with("#["));
        let attributes: Vec<&str> = attributes.copied().collect();
        let is_ignored = |line: &&str| line.starts_with("#[ignore") || line.contains("ignore)");
        attributes.contains(&"#[test]") && !attributes.iter().any(is_ignored)
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
                     proptest! {\n    #[test]\n    fn any_bytes(bytes in bytes()) {}\n}\n\
                     #[test]\n#[ignore]\nfn later() {}\n\
                     #[cfg_attr(unix, ignore)]\n#[test]\nfn not_here() {}\n";
        let manifest = "[package]\nname = \"exchange\"\n\n\
                        [[test]]\nname = \"lammps\"\ntest = false\n\n\
                        [[test]]\nname = \"others\"\n\n\
                        [[test]]\nname = \"peers\"\ntest = false\n";
        let runs = "#[test]\nfn it_runs() {}\n";
        let files = [
            file(DOCUMENT, &document),
            file("engine/tests/all.rs", tests),
            file("exchange/Cargo.toml", manifest),
            file("exchange/tests/lammps/deck.rs", runs),
            file("exchange/tests/others.rs", runs),
            file("exchange/tests/peers.rs", runs),
            file(CI, "look_at_it() {\n    cargo test --test lammps\n}\n"),
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
                (6, "there is no test `it_held` in engine/tests/all.rs that is run".to_owned()),
            ]
        );
        for name in ["helper", "later", "not_here"] {
            let what = format!("there is no test `{name}` in engine/tests/all.rs that is run");
            assert_eq!(
                found(&format!("| it holds | `engine/tests/all.rs::{name}` |")),
                [(5, what)]
            );
        }
    }

    #[test]
    fn a_test_of_a_target_that_nothing_runs_holds_no_promise() {
        assert_eq!(found("| it holds | `exchange/tests/lammps/deck.rs::it_runs` |"), []);
        let what = "exchange/tests/peers.rs is of the target `peers`, which nothing runs";
        let peers = found("| it holds | `exchange/tests/peers.rs::it_runs` |");
        assert_eq!(peers, [(5, what.to_owned())]);
        assert_eq!(found("| it holds | `exchange/tests/others.rs::it_runs` |"), []);
    }
}
