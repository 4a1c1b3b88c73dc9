//! The report of the published results: what was run again, beside what was published.

use serde_json::Value;

use crate::figure::figure;
use crate::numbers::{list, text, texts as strings};
use crate::page::{Number, Page, Part, Section};
use crate::tables::Table;
use crate::{ReportError, Texts, object};

/// The file whose presence means published results.
pub(crate) const RESULT: &str = "validation.json";

/// Verdicts as they are counted: worse ones later, then those on what has no answer.
const VERDICTS: [(&str, &str); 7] = [
    ("pass", "pass"),
    ("undecided", "undecided"),
    ("deviates", "deviates"),
    ("fail", "fail"),
    ("not-published", "not published"),
    ("not-modelled", "not modelled"),
    ("not-run", "not run"),
];

pub(crate) fn page(texts: &Texts) -> Result<String, ReportError> {
    let found = object(texts, RESULT)?;
    let rows = list(&found["rows"]);
    let mut parts = vec![Part::Table(overview(rows))];
    for headline in rows.iter().map(|row| &row["headline"]).filter(|headline| headline.is_object())
    {
        parts.extend(numbers(headline));
    }
    let mut sections = vec![Section::new("All rows", parts)];
    sections.extend(rows.iter().map(|row| section(row, texts)));
    let page = Page {
        title: "Published results, run again".to_owned(),
        kind: "validation",
        lead: format!(
            "Each number with its band and the reason for it; a {} run.",
            text(&found["effort"])
        ),
        headline: headline(rows),
        sections: sections.into_iter().flatten().collect(),
        origin: vec![("plunge", env!("CARGO_PKG_VERSION").to_owned())],
    };
    page.html()
}

/// How many rows have each verdict.
fn headline(rows: &[Value]) -> Vec<Number> {
    let count = |verdict: &str| rows.iter().filter(|row| row["verdict"] == verdict).count();
    let counted =
        |key: &str| matches!(key, "pass" | "undecided" | "deviates" | "fail") || count(key) > 0;
    let numbers = VERDICTS.iter().filter(|(key, _)| counted(key)).map(|&(key, name)| {
        let of = if key == "pass" { format!("of {} rows", rows.len()) } else { String::new() };
        Number::new(name, count(key).to_string(), of)
    });
    numbers.collect()
}

fn overview(rows: &[Value]) -> Table {
    let mut table = Table::new(&["row", "what", "verdict"]);
    table.head.extend(VERDICTS.iter().map(|(_, name)| (*name).to_owned()));
    for row in rows {
        let checks = list(&row["checks"]);
        let count =
            |verdict: &str| checks.iter().filter(|check| check["verdict"] == verdict).count();
        let mut cells = vec![text(&row["id"]), text(&row["title"]), verdict(&row["verdict"])];
        cells.extend(VERDICTS.iter().map(|(key, _)| count(key).to_string()));
        table.rows.push(cells);
    }
    table
}

/// One row: how it was run, its checks, the numbers and figures behind them.
fn section(row: &Value, texts: &Texts) -> Option<Section> {
    let mut parts = vec![
        Part::Answer(format!("{}: {}", verdict(&row["verdict"]), text(&row["title"]))),
        Part::Text(format!("{}. Run: {}.", text(&row["source"]), text(&row["how"]))),
    ];
    if let Some(why) = row["error"].as_str() {
        parts.push(Part::Text(format!("Could not be run: {why}.")));
    }
    let checks = list(&row["checks"]);
    if !checks.is_empty() {
        parts.push(Part::Table(table_of(checks)));
    }
    for shown in list(&row["figures"]) {
        if let Some(svg) = shown["file"].as_str().and_then(|file| texts.get(file)) {
            parts.push(figure(svg, &text(&shown["caption"])));
        }
    }
    parts.extend(list(&row["tables"]).iter().flat_map(numbers));
    parts.extend(strings(&row["notes"]).into_iter().map(Part::Text));
    Section::new(&text(&row["id"]), parts)
}

/// A table of numbers below its caption.
fn numbers(table: &Value) -> [Part; 2] {
    let rows = list(&table["rows"]).iter().map(strings).collect();
    [
        Part::Text(text(&table["caption"])),
        Part::Table(Table { head: strings(&table["head"]), rows }),
    ]
}

fn table_of(checks: &[Value]) -> Table {
    let mut table = Table::new(&["check", "published", "ours", "band", "verdict"]);
    for check in checks {
        let cause = text(&check["cause"]);
        let verdict = verdict(&check["verdict"]);
        table.rows.push(vec![
            text(&check["what"]),
            side(&check["published"]),
            side(&check["ours"]),
            text(&check["band"]),
            if cause.is_empty() { verdict } else { format!("{verdict}: {cause}") },
        ]);
    }
    table
}

/// A verdict as it is counted, in words.
fn verdict(value: &Value) -> String {
    let key = text(value);
    let known = VERDICTS.iter().find(|(one, _)| *one == key);
    known.map_or(key, |(_, name)| (*name).to_owned())
}

/// A number with its error, or words.
fn side(side: &Value) -> String {
    let (value, error) = (side["value"].as_f64(), side["error"].as_f64());
    match (value, error) {
        (Some(value), Some(error)) if error > 0.0 => {
            let [value, error] = [value, error].map(plots::short);
            format!("{value}\u{a0}\u{b1}\u{a0}{error}")
        }
        (Some(value), _) => plots::short(value),
        (None, _) => side.as_str().unwrap_or("\u{2013}").to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn a_page_shows_every_check_with_its_verdict_and_says_what_could_not_be_run() {
        let check = json!({
            "what": "depth (m)",
            "published": { "value": 0.1, "error": 0.01 },
            "ours": "words",
            "band": "\u{b1} 0.02: two standard errors of the difference",
            "verdict": "deviates",
            "cause": "a cause",
        });
        let found = json!({ "effort": "quick", "rows": [
            { "id": "E1", "title": "one", "verdict": "deviates", "checks": [check],
              "headline": { "caption": "at a glance", "head": ["angle"], "rows": [["90"]] },
              "figures": [{ "file": "e1.svg", "caption": "a figure" }] },
            { "id": "E2", "title": "two", "verdict": "not-run", "error": "no bed" },
        ] });
        let svg = plots::svg((30, 20), |_| Ok(())).expect("a picture");
        let texts = [(RESULT.to_owned(), found.to_string()), ("e1.svg".to_owned(), svg)];
        let html = page(&texts.into_iter().collect()).expect("a page");
        // Words of a band are no number: they take several lines.
        assert!(html.contains("<table class=\"sentences\">"), "{html}");
        for shown in [
            "0.1\u{a0}\u{b1}\u{a0}0.01",
            "deviates: a cause",
            "not run: two",
            "Could not be run: no bed",
            "at a glance",
            "<svg",
        ] {
            assert!(html.contains(shown), "{shown} in {html}");
        }
    }
}
