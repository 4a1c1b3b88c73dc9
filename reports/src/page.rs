//! What a report consists of, and how it becomes HTML.

use askama::Template;

use crate::ReportError;
use crate::tables::Table;

/// A page, from its title to its foot.
#[derive(Template)]
#[template(path = "page.html")]
pub(crate) struct Page {
    /// Its subject.
    pub(crate) title: String,
    /// What kind of report it is.
    pub(crate) kind: &'static str,
    /// One sentence on it.
    pub(crate) lead: String,
    /// What one wants to know first.
    pub(crate) headline: Vec<Number>,
    pub(crate) sections: Vec<Section>,
    /// Where it is from: names and values.
    pub(crate) origin: Vec<(&'static str, String)>,
}

/// A number of the headline, as it is shown.
pub(crate) struct Number {
    pub(crate) name: String,
    pub(crate) value: String,
    /// What goes with it; may be empty.
    pub(crate) note: String,
}

/// A section under its heading.
pub(crate) struct Section {
    pub(crate) heading: String,
    pub(crate) parts: Vec<Part>,
}

/// What a section is made of.
pub(crate) enum Part {
    /// A paragraph.
    Text(String),
    /// A sentence that stands out.
    Answer(String),
    /// A figure as SVG, and what it shows.
    Figure(String, String),
    /// Small figures side by side, each with what it shows.
    Panels(Vec<(String, String)>),
    /// The scenes of a run as JSON, and the frame to begin with.
    Player {
        data: String,
        frame: usize,
    },
    /// Words and what they mean.
    Terms(Vec<(&'static str, &'static str)>),
    Table(Table),
    Cards(Vec<Card>),
    /// Something to paste.
    Listing(String),
}

/// What is known of one effect.
pub(crate) struct Card {
    pub(crate) title: String,
    /// Its place among the others.
    pub(crate) rank: String,
    pub(crate) summary: String,
    /// Names and values.
    pub(crate) facts: Vec<(&'static str, String)>,
    /// Names and texts.
    pub(crate) notes: Vec<(&'static str, String)>,
    /// Whether it is among those that the verdict names.
    pub(crate) named: bool,
}

/// Characters of the longest cell of a table of numbers.
const LONGEST_NUMBER: usize = 40;

impl Table {
    /// Whether it holds sentences.
    fn has_sentences(&self) -> bool {
        self.rows.iter().flatten().any(|cell| cell.chars().count() > LONGEST_NUMBER)
    }

    /// What a column is called; nothing where it has no name.
    fn name(&self, column: &usize) -> &str {
        self.head.get(*column).map_or("", String::as_str)
    }
}

impl Page {
    /// Whether something on it plays.
    fn plays(&self) -> bool {
        let mut parts = self.sections.iter().flat_map(|section| &section.parts);
        parts.any(|part| matches!(part, Part::Player { .. }))
    }

    pub(crate) fn html(&self) -> Result<String, ReportError> {
        // Names and texts are of files from anywhere.
        Ok(configs::printable(&self.render()?))
    }
}

impl Number {
    pub(crate) fn new(name: &str, value: impl Into<String>, note: impl Into<String>) -> Self {
        Self { name: name.to_owned(), value: value.into(), note: note.into() }
    }
}

impl Section {
    /// A section; none if it has no parts.
    pub(crate) fn new(heading: &str, parts: Vec<Part>) -> Option<Self> {
        (!parts.is_empty()).then(|| Self { heading: heading.to_owned(), parts })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_of_a_file_do_not_reach_a_page() {
        let page = Page {
            title: "a\u{1b}[2Jb".to_owned(),
            kind: "run",
            lead: String::new(),
            headline: Vec::new(),
            sections: Vec::new(),
            origin: Vec::new(),
        };
        let html = page.html().expect("a page");
        assert!(html.contains("a\u{fffd}[2Jb") && !html.contains('\u{1b}'), "{html}");
    }

    #[test]
    fn names_from_outside_cannot_become_tags_or_addresses() {
        let hostile = "<script src=\"http://x\">&";
        let table = Table { head: vec![hostile.to_owned()], rows: vec![vec![hostile.to_owned()]] };
        let page = Page {
            title: hostile.to_owned(),
            kind: "run",
            lead: hostile.to_owned(),
            headline: vec![Number::new(hostile, hostile, hostile)],
            sections: vec![Section {
                heading: hostile.to_owned(),
                parts: vec![Part::Text(hostile.to_owned()), Part::Table(table)],
            }],
            origin: vec![("model", hostile.to_owned())],
        };
        let html = page.html().expect("a page");
        assert!(!html.contains("<script src"), "{html}");
        // The title stands twice: in the head too. A heading also names the table below it.
        assert_eq!(html.matches("&#60;script src=").count(), 12, "{html}");
        assert!(html.contains("default-src 'none'"), "nothing is fetched");
    }
}
