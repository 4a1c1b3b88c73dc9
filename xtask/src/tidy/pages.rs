//! Pages stay short enough to be read: what is new on a page takes the place of what says the same.

use super::{Problem, TextFile};

/// Pages in `docs/` at most.
const MOST_PAGES: usize = 14;

/// Words on all pages of `docs/` at most.
const MOST_WORDS: usize = 16_000;

/// Pages outside `docs/` with the lines that each has at most.
const MOST_LINES: [(&str, usize); 3] =
    [("README.md", 120), ("ARCHITECTURE.md", 150), ("CONTRIBUTING.md", 60)];

/// Checks the number of pages, their words, and the lines of the pages that a reader meets first.
pub(crate) fn check(files: &[TextFile]) -> Vec<Problem> {
    let mut pages: Vec<(&TextFile, usize)> =
        files.iter().filter(|file| is_page(file)).map(|file| (file, words(&file.text))).collect();
    pages.sort_by_key(|(page, words)| (*words, &page.path));
    let mut problems = Vec::new();
    // The longest page is where to begin.
    if let Some((longest, most)) = pages.last() {
        let mut too_much = |what, right: &str| {
            let file = longest.path.clone();
            problems.push(Problem { file, line: 1, what, right: right.to_owned() });
        };
        if pages.len() > MOST_PAGES {
            let what = format!("docs/ has {} pages, the limit is {MOST_PAGES}", pages.len());
            too_much(what, "merge two pages that a reader needs together");
        }
        let all: usize = pages.iter().map(|(_, words)| words).sum();
        if all > MOST_WORDS {
            let what = format!(
                "the pages of docs/ have {all} words, the limit is {MOST_WORDS}; this one has {most}"
            );
            too_much(what, "say things once, link, and leave out history");
        }
    }
    for (name, limit) in MOST_LINES {
        let page = files.iter().find(|file| file.path.as_os_str() == name);
        let lines = page.map_or(0, |page| page.text.lines().count());
        if lines > limit {
            problems.push(Problem {
                file: name.into(),
                line: limit + 1,
                what: format!("{name} has {lines} lines, the limit is {limit}"),
                right: "move what only some readers need to a page of docs/".to_owned(),
            });
        }
    }
    problems
}

/// Whether `file` is a page of `docs/`.
fn is_page(file: &TextFile) -> bool {
    file.path.starts_with("docs") && file.path.extension().is_some_and(|kind| kind == "md")
}

/// The words of a page: what stands between blanks and has a letter or a digit, so bars of tables do not count.
fn words(text: &str) -> usize {
    text.split_whitespace().filter(|word| word.contains(char::is_alphanumeric)).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(path: &str, text: &str) -> TextFile {
        TextFile { path: path.into(), text: text.to_owned() }
    }

    fn found(files: &[TextFile]) -> Vec<(String, usize, String)> {
        let told = |one: Problem| (one.file.display().to_string(), one.line, one.what);
        check(files).into_iter().map(told).collect()
    }

    #[test]
    fn a_repository_at_its_limits_passes() {
        let mut files: Vec<TextFile> =
            (0..MOST_PAGES).map(|n| file(&format!("docs/{n}.md"), "| --- |\n")).collect();
        files[0].text = "word ".repeat(MOST_WORDS) + "| - ";
        for (name, limit) in MOST_LINES {
            files.push(file(name, &"line\n".repeat(limit)));
        }
        files.push(file("docs/picture.svg", &"word ".repeat(MOST_WORDS)));
        assert_eq!(found(&files), []);
        assert_eq!(found(&[]), []);
    }

    #[test]
    fn too_many_pages_words_and_lines_are_reported_with_number_and_limit() {
        let mut files: Vec<TextFile> =
            (0..=MOST_PAGES).map(|n| file(&format!("docs/{n}.md"), "word")).collect();
        files[3].text = "word ".repeat(MOST_WORDS);
        files.push(file("README.md", &"line\n".repeat(121)));
        files.push(file("ARCHITECTURE.md", &"line\n".repeat(151)));
        let [pages, words, readme, architecture] = [
            "docs/ has 15 pages, the limit is 14",
            "the pages of docs/ have 16014 words, the limit is 16000; this one has 16000",
            "README.md has 121 lines, the limit is 120",
            "ARCHITECTURE.md has 151 lines, the limit is 150",
        ]
        .map(str::to_owned);
        assert_eq!(
            found(&files),
            [
                ("docs/3.md".to_owned(), 1, pages),
                ("docs/3.md".to_owned(), 1, words),
                ("README.md".to_owned(), 121, readme),
                ("ARCHITECTURE.md".to_owned(), 151, architecture),
            ]
        );
    }
}
