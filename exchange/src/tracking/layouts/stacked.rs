//! Plain tables of one drop below each other, each with its own line of names and mostly a title above it.

use super::Layout;
use crate::tracking::fault::Fault;
use crate::tracking::grid::Grid;
use crate::tracking::settings::Columns;
use crate::tracking::sheet::{Row, Sheet};
use crate::tracking::track::Track;

pub(super) const LAYOUT: Layout = Layout { fits: |sheet, _| blocks(sheet).len() > 1, read };

/// One of the tables.
struct Block<'a> {
    /// The row above its line of names, of another block for the first at most.
    title: Option<String>,
    /// Its line of names, and what is below it.
    rows: &'a [Row],
}

fn read(sheet: &Sheet, columns: &Columns) -> Result<Vec<Track>, Fault> {
    let blocks = blocks(sheet);
    let is_told = |(at, block): (usize, &Block<'_>)| {
        let others = &blocks[..at];
        block.title.is_some() && others.iter().all(|other| other.title != block.title)
    };
    let are_told = blocks.iter().enumerate().all(is_told);
    let mut tracks = Vec::new();
    for (at, block) in blocks.iter().enumerate() {
        let title = block.title.clone().filter(|_| are_told);
        let title = title.unwrap_or_else(|| (at + 1).to_string());
        let notes = if at == 0 { sheet.notes.clone() } else { Vec::new() };
        let inside = Sheet { rows: block.rows.to_vec(), notes, ..sheet.without_rows() };
        for track in super::tracks(&inside, columns)? {
            let name = match &track.name {
                Some(own) => format!("{title}-{own}"),
                None => title.clone(),
            };
            let layout = format!("stacked, {}", sheet.separated);
            tracks.push(Track { name: Some(name), layout, ..track });
        }
    }
    Ok(tracks)
}

/// Tables whose lines of names are that of the first.
fn blocks(sheet: &Sheet) -> Vec<Block<'_>> {
    let Ok(Grid { header, .. }) = Grid::found(sheet) else { return Vec::new() };
    let rows = &sheet.rows;
    let headers = (header..rows.len()).filter(|at| rows[*at].cells == rows[header].cells);
    let headers: Vec<usize> = headers.collect();
    // A line of words above the names is a title.
    let titled = |at: usize| at > 0 && !sheet.is_numeric(&rows[at - 1], 1);
    let ends = headers.iter().skip(1).map(|&next| next - usize::from(titled(next)));
    let block = |(&at, end): (&usize, usize)| Block {
        title: titled(at).then(|| title(&rows[at - 1])),
        rows: &rows[at..end],
    };
    headers.iter().zip(ends.chain([rows.len()])).map(block).collect()
}

fn title(row: &Row) -> String {
    let cells = row.cells.iter().filter(|cell| !cell.is_empty()).map(String::as_str);
    cells.collect::<Vec<_>>().join(" ").trim_matches(['#', ' ', ':']).to_owned()
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
    fn without_titles_drops_are_counted() {
        let all = tracks("t,y1,y2\n0,1,1\n1,2,2\nt,y1,y2\n0,3,1\n1,4,2\n");
        let told: Vec<_> = all.iter().filter_map(|one| one.name.as_deref()).collect();
        assert_eq!(told, ["1-1", "1-2", "2-1", "2-2"]);
    }
}
