//! Kinovea: text of trajectories (`#T X Y`), one block for each, with times as numbers or `h:mm:ss:cc`.

use super::{Layout, first_row};
use crate::tracking::fault::Fault;
use crate::tracking::settings::Columns;
use crate::tracking::sheet::{Number, Row, Sheet};
use crate::tracking::track::{Measure, Sample, Track};
use crate::tracking::units::Unit;

pub(super) const LAYOUT: Layout = Layout { fits, read };

fn fits(sheet: &Sheet, _: &Columns) -> bool {
    first_row(sheet).starts_with("#kinovea")
}

fn read(sheet: &Sheet, _: &Columns) -> Result<Vec<Track>, Fault> {
    let mut tracks: Vec<Track> = Vec::new();
    let mut named = None;
    let mut before = None;
    for row in &sheet.rows[1..] {
        if row.cell(0).starts_with('#') {
            let words = row.cells.join(" ");
            let name = words.trim_start_matches('#').trim();
            named = (!name.eq_ignore_ascii_case("t x y")).then(|| name.to_owned());
            before = None;
            continue;
        }
        // A block ends in a blank line, or where another is named.
        if before.is_none_or(|line| row.line > line + 1) {
            let name = named.take().unwrap_or_else(|| format!("path{}", tracks.len() + 1));
            tracks.push(empty(sheet, name));
        }
        before = Some(row.line);
        if let Some(track) = tracks.last_mut() {
            add(sheet, row, track)?;
        }
    }
    if let [only] = &mut tracks[..] {
        only.name = None;
    }
    match tracks.is_empty() {
        true => {
            Err(sheet.fault("it holds no trajectory", "rows of a time, x and y below `#T X Y`"))
        }
        false => Ok(tracks),
    }
}

fn empty(sheet: &Sheet, name: String) -> Track {
    let measure = |name: &str| Measure { name: name.to_owned(), unit: Unit::Unstated };
    Track {
        file: sheet.file.clone(),
        stem: sheet.stem.clone(),
        name: Some(name),
        called: None,
        layout: "Kinovea".to_owned(),
        time: measure("T"),
        vertical: measure("Y"),
        forward: Some(measure("X")),
        labels: Vec::new(),
        samples: Vec::new(),
        holes: 0,
        notes: sheet.notes.clone(),
    }
}

fn add(sheet: &Sheet, row: &Row, track: &mut Track) -> Result<(), Fault> {
    let number = |at: usize| match sheet.number(row.cell(at)) {
        Number::Value(value) => Ok(Some(value)),
        Number::Missing => Ok(None),
        Number::Other => {
            let what = format!("\"{}\" is not a number", configs::shorten(row.cell(at)));
            Err(sheet
                .fault(what, "a row is a time, x and y, with blanks between them")
                .at(row.line))
        }
    };
    let time = match clock(row.cell(0)) {
        Some(seconds) => {
            track.time.unit = Unit::Clock;
            Some(seconds)
        }
        None => number(0)?,
    };
    match (time, number(1)?, number(2)?) {
        (Some(t), Some(x), Some(z)) => track.samples.push(Sample { line: row.line, t, z, x }),
        _ => track.holes += 1,
    }
    Ok(())
}

/// Seconds of `h:mm:ss:cc`, or of `h:mm:ss:mmm`.
fn clock(text: &str) -> Option<f64> {
    let parts: Vec<f64> = text.split(':').map(|part| part.parse().ok()).collect::<Option<_>>()?;
    let share = if text.rsplit(':').next()?.len() == 3 { 1000.0 } else { 100.0 };
    match parts[..] {
        [hours, minutes, seconds, shares] => {
            Some(3600.0 * hours + 60.0 * minutes + seconds + shares / share)
        }
        _ => None,
    }
}
