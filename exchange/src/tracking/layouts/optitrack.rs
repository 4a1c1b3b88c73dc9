//! Takes of OptiTrack: a line of properties, lines of markers and quantities, then frames.

use super::Layout;
use crate::tracking::fault::Fault;
use crate::tracking::grid::{Grid, Places};
use crate::tracking::heading::Role;
use crate::tracking::settings::Columns;
use crate::tracking::sheet::{Row, Sheet};
use crate::tracking::track::Track;
use crate::tracking::units::Unit;

pub(super) const LAYOUT: Layout =
    Layout { fits: |sheet, _| super::first_row(sheet).starts_with("format version"), read };

fn read(sheet: &Sheet, columns: &Columns) -> Result<Vec<Track>, Fault> {
    let is_header = |row: &Row| row.cell(0).eq_ignore_ascii_case("frame");
    let Some(header) = sheet.rows.iter().position(is_header) else {
        let right = "export the take with its header: Frame, Time (Seconds), X, Y, Z";
        return Err(sheet.fault("the line of names `Frame,Time (Seconds)` is missing", right));
    };
    let mut grid = Grid::below(sheet, header, None);
    let properties = &sheet.rows[0].cells;
    let unit = properties.windows(2).find(|pair| pair[0].eq_ignore_ascii_case("length units"));
    let unit = unit.map_or(Unit::Unstated, |pair| Unit::of(&pair[1]));
    let t = grid.column(Role::Time, columns)?.or(grid.column(Role::Frame, columns)?);
    // Lines above the names say type, name, number and quantity of each column.
    let above = &sheet.rows[1..header];
    let is_turn = |at: usize| above.iter().any(|row| row.cell(at).eq_ignore_ascii_case("rotation"));
    let named = above.iter().find(|row| {
        let has =
            |words: [&str; 3]| words.iter().any(|word| row.cell(2).eq_ignore_ascii_case(word));
        !has(["marker", "rigid body", "bone"]) && !row.cell(2).is_empty()
    });
    let is_place =
        |at: &usize| matches!(grid.headings[*at].stem.as_str(), "x" | "y" | "z") && !is_turn(*at);
    let places: Vec<usize> = (0..grid.headings.len()).filter(is_place).collect();
    if places.len() < 3 {
        return Err(Fault::new(
            &sheet.file,
            "the take has no columns X, Y and Z of positions".to_owned(),
            "export positions of markers or rigid bodies, not rotations alone".to_owned(),
        ));
    }
    places.iter().for_each(|at| grid.headings[*at].unit = unit.clone());
    let several = places.len() > 3;
    let mut tracks = Vec::new();
    for one in places.chunks_exact(3) {
        let [x, y, z] = [one[0], one[1], one[2]];
        // Its second axis is up, unless another was chosen.
        let vertical = match (columns.of(Role::Vertical), &grid.moving(&[y, z])[..]) {
            (Some(asked), _) if asked.eq_ignore_ascii_case("z") => z,
            (None, [only]) => *only,
            _ => y,
        };
        let track =
            grid.track("OptiTrack", Places { t, z: vertical, x: Some(x) }, grid.all_rows())?;
        let name = named.map(|row| row.cell(x).to_owned()).filter(|_| several);
        tracks.push(Track { name, ..track });
    }
    Ok(tracks)
}
