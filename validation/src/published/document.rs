//! What came of the rows, as JSON and as Markdown.

use std::fmt::Write as _;

use serde_json::{Value, json};

use super::check::{Check, Verdict};
use super::laboratory::{Effort, Laboratory};
use super::row::{Findings, PublishedError, Row, Table};

/// A row and what came of it.
pub struct Judged {
    /// The row.
    pub row: &'static Row,
    /// What came of it; why there is nothing, else.
    pub findings: Result<Findings, String>,
}

impl Judged {
    /// Judges `row`. One of whose impacts none was run yet has nothing to be held against, and does not fail.
    pub fn by(row: &'static Row, laboratory: &Laboratory<'_>) -> Self {
        let findings = match (row.judge)(laboratory) {
            Err(why @ PublishedError::NotYet) => {
                Ok(Findings { notes: vec![format!("Not judged: {why}.")], ..Findings::default() })
            }
            found => found.map_err(|error| error.to_string()),
        };
        Self { row, findings }
    }

    /// The verdict; a row that could not be run fails.
    pub fn verdict(&self) -> Verdict {
        self.findings.as_ref().map_or(Verdict::Fail, Findings::verdict)
    }

    /// How many of its checks have `verdict`.
    pub fn count(&self, verdict: Verdict) -> usize {
        let checks = self.findings.iter().flat_map(|findings| &findings.checks);
        checks.filter(|check| check.verdict == verdict).count()
    }

    /// How it was run.
    pub fn how(&self, effort: Effort) -> &'static str {
        self.row.how[usize::from(effort == Effort::Full)]
    }

    fn to_json(&self, effort: Effort) -> Value {
        let mut value = json!({
            "id": self.row.id,
            "title": self.row.title,
            "source": self.row.source,
            "how": self.how(effort),
            "verdict": self.verdict(),
        });
        match &self.findings {
            Ok(findings) => {
                value["headline"] = json!(findings.headline);
                value["checks"] = json!(findings.checks);
                value["tables"] = json!(findings.tables);
                value["figures"] = json!(findings.figures);
                value["notes"] = json!(findings.notes);
            }
            Err(why) => value["error"] = json!(why),
        }
        value
    }
}

/// Everything, as `validation.json` has it.
pub fn to_json(judged: &[Judged], effort: Effort) -> Value {
    json!({
        "effort": word(effort),
        "verdict": judged.iter().map(Judged::verdict).max(),
        "rows": judged.iter().map(|one| one.to_json(effort)).collect::<Vec<_>>(),
    })
}

/// Everything, as `REPORT.md` has it.
pub fn markdown(judged: &[Judged], effort: Effort) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = write_all(&mut text, judged, effort);
    text
}

/// Every check as a line of CSV: `row, check, published, ours, band, verdict, cause`.
pub fn checks_csv(judged: &[Judged]) -> Result<String, csv::Error> {
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record(["row", "check", "published", "ours", "band", "verdict", "cause"])?;
    for one in judged {
        for check in one.findings.iter().flat_map(|findings| &findings.checks) {
            let Check { what, published, ours, band, verdict, cause, .. } = check;
            let numbers = [published.to_string(), ours.to_string()];
            let [published, ours] = &numbers;
            table.write_record([one.row.id, what, published, ours, band, verdict.name(), cause])?;
        }
    }
    table.flush()?;
    let bytes = table.into_inner().map_err(|error| error.into_error())?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

fn word(effort: Effort) -> &'static str {
    match effort {
        Effort::Quick => "quick",
        Effort::Full => "full",
    }
}

/// How many rows have each verdict: `14 rows: 5 pass, 1 undecided`.
pub fn tally(judged: &[Judged]) -> String {
    let count = |verdict| judged.iter().filter(|one| one.verdict() == verdict).count();
    tally_of(judged.len(), &Verdict::ALL.map(|verdict| (verdict, count(verdict))))
}

fn tally_of(rows: usize, counts: &[(Verdict, usize)]) -> String {
    let there = counts.iter().filter(|(_, n)| *n > 0);
    let words: Vec<String> = there.map(|(verdict, n)| format!("{n} {verdict}")).collect();
    format!("{rows} row{}: {}", if rows == 1 { "" } else { "s" }, words.join(", "))
}

/// What stands below the table of rows.
const UNDECIDED: &str = "The verdict of a row is the worst of its checks: fail, deviates, undecided, pass, in this order. A check is \
                         undecided where the scatter of the impacts that were run allows either answer. What the source does \
                         not give (not published), what plunge has no model of (not modelled) and what plunge could run and did \
                         not (not run) is counted apart and does not count in the verdict.";

fn write_all(text: &mut String, judged: &[Judged], effort: Effort) -> std::fmt::Result {
    writeln!(text, "# Published results, run again ({}): {}\n", word(effort), tally(judged))?;
    write!(text, "| row | what | source |")?;
    Verdict::ALL.iter().try_for_each(|verdict| write!(text, " {verdict} |"))?;
    writeln!(text, " verdict |\n|{}", "---|".repeat(4 + Verdict::ALL.len()))?;
    for one in judged {
        let row = one.row;
        write!(text, "| {} | {} | {} |", row.id, cell(row.title), cell(row.source))?;
        for verdict in Verdict::ALL {
            write!(text, " {} |", one.count(verdict))?;
        }
        writeln!(text, " **{}** |", one.verdict())?;
    }
    writeln!(text, "\n{UNDECIDED}")?;
    let findings = judged.iter().flat_map(|one| &one.findings);
    findings
        .filter_map(|found| found.headline.as_ref())
        .try_for_each(|one| write_table(text, one))?;
    judged.iter().try_for_each(|one| write_row(text, one, effort))
}

fn write_row(text: &mut String, one: &Judged, effort: Effort) -> std::fmt::Result {
    let row = one.row;
    writeln!(
        text,
        "\n## {}: {}\n\n{}. Run: {}.\n",
        row.id,
        row.title,
        row.source,
        one.how(effort)
    )?;
    let findings = match &one.findings {
        Ok(findings) => findings,
        Err(why) => return writeln!(text, "Could not be run: {why}."),
    };
    if !findings.checks.is_empty() {
        writeln!(text, "| check | published | ours | band | verdict |\n|---|---|---|---|---|")?;
    }
    for check in &findings.checks {
        let Check { what, published, ours, band, verdict, cause, .. } = check;
        let because = if cause.is_empty() { String::new() } else { format!(": {cause}") };
        let cells = [what.clone(), published.to_string(), ours.to_string(), band.clone()];
        let [what, published, ours, band] = cells.map(|text| cell(&text));
        writeln!(
            text,
            "| {what} | {published} | {ours} | {band} | **{verdict}**{} |",
            cell(&because)
        )?;
    }
    for table in &findings.tables {
        write_table(text, table)?;
    }
    for note in &findings.notes {
        writeln!(text, "\n{note}")?;
    }
    for figure in &findings.figures {
        writeln!(text, "\n![{}]({})", figure.caption, figure.file)?;
    }
    Ok(())
}

fn write_table(text: &mut String, table: &Table) -> std::fmt::Result {
    let line = |cells: &[String]| {
        format!("| {} |", cells.iter().map(|text| cell(text)).collect::<Vec<_>>().join(" | "))
    };
    writeln!(text, "\n{}\n\n{}", table.caption, line(&table.head))?;
    writeln!(text, "|{}", "---|".repeat(table.head.len()))?;
    table.rows.iter().try_for_each(|row| writeln!(text, "{}", line(row)))
}

/// `text` as it stands in a cell.
fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::published::check::{Band, Estimate};

    static ROW: Row = Row {
        id: "E0",
        title: "A test",
        source: "nobody",
        how: ["at once", "at length"],
        judge: |_| Ok(Findings::default()),
    };

    fn judged(ours: f64) -> Judged {
        let band = Band { half: 0.1, reason: "a|b" };
        let check = Check::number("n", Estimate::new(1.0, 0.0), Estimate::new(ours, 0.0), band);
        let findings = Findings { checks: vec![check], ..Findings::default() };
        Judged { row: &ROW, findings: Ok(findings) }
    }

    #[test]
    fn the_worst_row_decides_and_one_that_could_not_be_run_fails() {
        let broken = Judged { row: &ROW, findings: Err("no bed".to_owned()) };
        assert_eq!(to_json(&[judged(1.0)], Effort::Quick)["verdict"], "pass");
        assert_eq!(to_json(&[judged(1.0), judged(2.0)], Effort::Quick)["verdict"], "fail");
        assert_eq!(to_json(&[judged(1.0), broken], Effort::Full)["verdict"], "fail");
    }

    #[test]
    fn what_is_undecided_lowers_its_row_and_what_has_no_answer_is_counted_apart() {
        let mut one = judged(1.0);
        if let Ok(findings) = &mut one.findings {
            let check = findings.checks[0].clone();
            findings.checks.push(check.undecided_if(true));
            findings.checks.push(Check::not_published("c", "Fig. 1", "its numbers are lost"));
            findings.headline = Some(Table::new("at a glance", &["angle"]));
        }
        let text = markdown(&[one], Effort::Quick);
        assert!(
            text.starts_with("# Published results, run again (quick): 1 row: 1 undecided\n"),
            "{text}"
        );
        assert!(
            text.contains("| E0 | A test | nobody | 1 | 1 | 0 | 0 | 1 | 0 | 0 | **undecided** |"),
            "{text}"
        );
        assert!(text.find("at a glance") < text.find("## E0"), "{text}");
    }

    #[test]
    fn the_kept_checks_and_the_pages_that_speak_of_them_count_the_rows_alike() {
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let read = |path: &str| {
            std::fs::read_to_string(root.join(path))
                .unwrap_or_else(|error| panic!("{path}: {error}"))
        };
        let kept = read("validation/results/published.csv");
        let mut worst = std::collections::BTreeMap::new();
        for check in csv::Reader::from_reader(kept.as_bytes()).deserialize() {
            let KeptCheck { row, verdict } = check.expect("a check");
            let named = Verdict::ALL.into_iter().find(|own| own.name() == verdict);
            let verdict = named.unwrap_or_else(|| panic!("{verdict}"));
            worst
                .entry(row)
                .and_modify(|own: &mut Verdict| *own = verdict.max(*own))
                .or_insert(verdict);
        }
        assert!(crate::published::ROWS.iter().all(|row| worst.contains_key(row.id)));
        assert_eq!(worst.len(), crate::published::ROWS.len());
        let count = |verdict| worst.values().filter(|own| **own == verdict).count();
        let tally = tally_of(worst.len(), &Verdict::ALL.map(|verdict| (verdict, count(verdict))));
        for path in ["README.md", "docs/validation.md"] {
            assert!(read(path).contains(&tally), "{path} does not say: {tally}");
        }
    }

    #[derive(serde::Deserialize)]
    struct KeptCheck {
        row: String,
        verdict: String,
    }

    #[test]
    fn a_check_is_a_line_of_a_table() {
        let text = checks_csv(&[judged(2.0)]).expect("a table");
        assert_eq!(
            text,
            "row,check,published,ours,band,verdict,cause\nE0,n,1.000,2.000,± 0.1000: a|b,fail,\n"
        );
    }

    #[test]
    fn a_table_in_markdown_keeps_its_columns() {
        let text = markdown(&[judged(1.0)], Effort::Quick);
        let line = text.lines().find(|line| line.starts_with("| n |")).expect("the check");
        assert_eq!(line.replace("\\|", "").matches('|').count(), 6, "{line}");
        assert!(text.contains("Run: at once."), "{text}");
    }
}
