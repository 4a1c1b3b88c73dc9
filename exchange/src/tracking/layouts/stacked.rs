//! Plain tables of one drop below each other, each with its own line of names and mostly a title above it.

use super::Layout;
use crate::tracking::fault::Fault;
use crate::tracking::grid::Grid;
use crate::tracking::heading::{Heading, is_statistic};
use crate::tracking::settings::Columns;
use crate::tracking::sheet::{Number, Row, Sheet};
use crate::tracking::track::Track;

pub(super) const LAYOUT: Layout = Layout { fits: |sheet, _| blocks(sheet).len() > 1, read };

/// One of the tables.
struct Block<'a> {
    /// The rows of words above its line of names.
    title: Option<String>,
    /// Its line of names and the rows below it.
    rows: &'a [Row],
}

fn read(sheet: &Sheet, columns: &Columns) -> Result<Vec<Track>, Fault> {
    let blocks = blocks(sheet);
    let is_told = |(at, block): (usize, &Block<'_>)| {
        let others = &blocks[..at];
        block.title.is_some() && others.iter().all(|other| other.title != block.title)
    };
    let are_told = blocks.iter().enumerate().all(is_told);
    let mut tracks: Vec<Track> = Vec::new();
    for (at, block) in blocks.iter().enumerate() {
        let title = block.title.as_ref().filter(|_| are_told);
        let notes = if at == 0 { sheet.notes.clone() } else { Vec::new() };
        let inside = Sheet { rows: block.rows.to_vec(), notes, ..sheet.without_rows() };
        for track in super::tracks(&inside, columns)? {
            let name = match (title, &track.name) {
                (Some(title), Some(own)) => Some(format!("{title}-{own}")),
                (title, own) => title.or(own.as_ref()).cloned(),
            };
            let layout = format!("stacked, {}", sheet.separated);
            let track = Track { name, layout, ..track };
            // A line of names that is repeated within a drop.
            match tracks.iter_mut().rfind(|one| one.name == track.name && goes_on(one, &track)) {
                Some(one) => one.samples.extend(track.samples),
                None => tracks.push(track),
            }
        }
    }
    if tracks.len() > 1 && tracks.iter().all(|track| track.name.is_none()) {
        let nth = (1..).map(|nth: usize| Some(nth.to_string()));
        tracks.iter_mut().zip(nth).for_each(|(track, nth)| track.name = nth);
    }
    Ok(tracks)
}

/// Whether the readings of `next` come after those of `one`.
fn goes_on(one: &Track, next: &Track) -> bool {
    let ends = one.samples.last().zip(next.samples.first());
    ends.is_some_and(|(last, first)| last.t < first.t)
}

/// Tables whose lines of names are that of the first.
fn blocks(sheet: &Sheet) -> Vec<Block<'_>> {
    let Ok(Grid { header, .. }) = Grid::found(sheet) else { return Vec::new() };
    let rows = &sheet.rows;
    // A table without names repeats readings, not a line of names.
    if sheet.is_numeric(&rows[header], 1) {
        return Vec::new();
    }
    let headers = (header..rows.len()).filter(|at| rows[*at].cells == rows[header].cells);
    let headers: Vec<usize> = headers.collect();
    // Lines with words above the names are the title.
    let is_title =
        |row: &Row| sheet.has_words(row) && !sheet.is_numeric(row, 2) && !is_statistic(row.cell(0));
    let titles = |at: usize| {
        let is_names = |row: &Row| row.cells == rows[header].cells;
        let above =
            rows[..at].iter().rev().take_while(|row| is_title(row) && !is_names(row)).count();
        &rows[at - above..at]
    };
    let ends = headers.iter().skip(1).map(|&next| next - titles(next).len());
    let block = |(&at, end): (&usize, usize)| Block {
        title: title(sheet, titles(at)),
        rows: &rows[at..end],
    };
    headers.iter().zip(ends.chain([rows.len()])).map(block).collect()
}

/// The name that lines above a table give it; a quantity in two cells is written as `h10cm`.
fn title(sheet: &Sheet, rows: &[Row]) -> Option<String> {
    let words = |row: &Row| {
        let cells = row.cells.iter().filter(|cell| !cell.is_empty()).map(String::as_str);
        match cells.collect::<Vec<_>>()[..] {
            [name, value]
                if matches!(sheet.number(value), Number::Value(_)) && name.contains(['(', '[']) =>
            {
                let Heading { stem, unit, .. } = Heading::of(name);
                format!("{stem}{value}{}", unit.word())
            }
            ref cells => cells.join(" ").trim_matches(['#', ' ', ':']).to_owned(),
        }
    };
    let words: Vec<String> = rows.iter().map(words).filter(|words| !words.is_empty()).collect();
    (!words.is_empty()).then(|| words.join(" "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tracking::text;

    fn tracks(text: &str) -> Vec<Track> {
        let sheet = text::read("a.csv", "a", text.as_bytes()).expect("a table");
        assert!((LAYOUT.fits)(&sheet, &Columns::default()));
        read(&sheet, &Columns::default()).expect("tracks")
    }

    #[test]
    fn titles_name_the_drops() {
        let all =
            tracks("low, 5 cm\nt (s),y (mm)\n0,1\n1,2\nhigh, 9 cm\nt (s),y (mm)\n0,3\n1,4\n2,5\n");
        let told: Vec<_> = all.iter().map(|one| (one.name.as_deref(), one.samples.len())).collect();
        assert_eq!(told, [(Some("low 5 cm"), 2), (Some("high 9 cm"), 3)]);
        assert_eq!(all[1].samples[0].line, 7);
    }

    #[test]
    fn readings_without_names_that_come_again_begin_no_drop() {
        let sheet = text::read("a.csv", "a", b"0 1\n0 1\n1 2\n2 3\n0 1\n").expect("a table");
        assert!(!(LAYOUT.fits)(&sheet, &Columns::default()));
    }

    #[test]
    fn without_titles_drops_are_counted() {
        let told = |text: &str| -> Vec<(Option<String>, usize)> {
            tracks(text).into_iter().map(|one| (one.name, one.samples.len())).collect()
        };
        let named = |name: &str, n: usize| (Some(name.to_owned()), n);
        assert_eq!(told("t,y\n0,1\n1,2\nt,y\n0,3\n1,4\n"), [named("1", 2), named("2", 2)]);
        assert_eq!(told("t,y\n0,1\n1,2\nt,y\n2,3\n3,4\n"), [(None, 4)]);
        let long = "run,t,y\na,0,1\na,1,2\nrun,t,y\na,2,3\nb,0,3\nrun,t,y\nb,1,4\n";
        assert_eq!(told(long), [named("a", 3), named("b", 2)]);
    }
}
