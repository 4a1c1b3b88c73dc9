//! Plain tables of several drops beside each other, each with its own column of times; the drops are told by titles above
//! or in the names of the columns.

use super::Layout;
use crate::tracking::fault::Fault;
use crate::tracking::grid::{Grid, Places};
use crate::tracking::heading::Role;
use crate::tracking::settings::Columns;
use crate::tracking::sheet::Sheet;
use crate::tracking::track::Track;

pub(super) const LAYOUT: Layout = Layout { fits, read };

fn fits(sheet: &Sheet, columns: &Columns) -> bool {
    let asked = columns.of(Role::Vertical).is_some();
    let has_times =
        |grid: &Grid<'_>| grid.headings.iter().any(|one| one.role() == Some(Role::Time));
    let are_pairs =
        |grid: Grid<'_>| drops(&grid).len() > 1 || (named(&grid).len() == 1 && !has_times(&grid));
    !asked && Grid::found(sheet).is_ok_and(are_pairs)
}

fn read(sheet: &Sheet, columns: &Columns) -> Result<Vec<Track>, Fault> {
    let grid = Grid::found(sheet)?;
    grid.column(Role::Run, columns)?;
    let drops = drops(&grid);
    let named: Option<Vec<Option<String>>> = drops
        .iter()
        .map(|drop| drop.t.and_then(|t| grid.headings[t].of_drop()).map(|of| Some(of.1)))
        .collect();
    let titles = grid.header.checked_sub(1).map(|above| &sheet.rows[above]);
    let ends = drops.iter().skip(1).map(|next| next.t).chain([Some(grid.headings.len())]);
    let title = |(places, end): (&Places, Option<usize>)| {
        let cells = (places.t?..end?).map(|at| titles.map_or("", |row| row.cell(at)));
        let mut words: Vec<&str> = cells.filter(|cell| !cell.is_empty()).collect();
        words.dedup();
        (!words.is_empty()).then(|| words.join(" "))
    };
    let titles = named.unwrap_or_else(|| drops.iter().zip(ends).map(title).collect());
    let are_told =
        (0..titles.len()).all(|at| titles[at].is_some() && !titles[..at].contains(&titles[at]));
    let one = |(at, (places, title)): (usize, (&Places, Option<String>))| {
        let layout = format!("pairs, {}", sheet.separated);
        let track = grid.track(&layout, *places, grid.all_rows())?;
        let name = title.filter(|_| are_told).unwrap_or_else(|| (at + 1).to_string());
        let notes = if at == 0 { track.notes } else { Vec::new() };
        Ok(Track { name: Some(name), notes, ..track })
    };
    drops.iter().zip(titles).enumerate().map(one).collect()
}

/// Columns of the drops, by the names of columns or by their order.
fn drops(grid: &Grid<'_>) -> Vec<Places> {
    let (named, in_order) = (named(grid), in_order(grid));
    if named.len() > 1 || in_order.is_empty() { named } else { in_order }
}

/// Columns of times and positions whose names have a drop in common.
fn named(grid: &Grid<'_>) -> Vec<Places> {
    let all: Vec<(usize, Role, String)> = (0..grid.headings.len())
        .filter_map(|at| grid.headings[at].of_drop().map(|(role, drop)| (at, role, drop)))
        .collect();
    let of = |wanted: Role, drop: &str| {
        let mut own = all.iter().filter(|(_, role, own)| *role == wanted && own == drop);
        own.next().map(|one| one.0).filter(|_| own.next().is_none())
    };
    let times = all.iter().filter(|(_, role, _)| *role == Role::Time);
    let places = |(t, _, drop): &(usize, Role, String)| {
        let z = of(Role::Vertical, drop)?;
        Some(Places { t: Some(*t), z, x: of(Role::Forward, drop) })
    };
    times.map(places).collect::<Option<_>>().unwrap_or_default()
}

/// Each begins with the column of its times, and has one of positions.
fn in_order(grid: &Grid<'_>) -> Vec<Places> {
    let role = |at: usize| grid.headings[at].role();
    let all = 0..grid.headings.len();
    let starts = |wanted: Role| all.clone().filter(move |at| role(*at) == Some(wanted));
    let mut times: Vec<usize> = starts(Role::Time).collect();
    if times.is_empty() {
        times = starts(Role::Frame).collect();
    }
    let ends = times.iter().skip(1).copied().chain([grid.headings.len()]);
    let drop = |(&t, end): (&usize, usize)| {
        let of = |wanted: Role| (t..end).filter(move |at| role(*at) == Some(wanted));
        let mut vertical = of(Role::Vertical);
        match (vertical.next(), vertical.next()) {
            (Some(z), None) => Some(Places { t: Some(t), z, x: of(Role::Forward).next() }),
            _ => None,
        }
    };
    times.iter().zip(ends).map(drop).collect::<Option<_>>().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tracking::text;

    #[test]
    fn a_title_stands_above_the_columns_of_its_drop() {
        let text = "low,,high,,\nt (s),y (mm),t (s),y (mm),note\n0,1,0,5,\n1,2,1,6,\n,,2,7,\n";
        let sheet = text::read("a.csv", "a", text.as_bytes()).expect("a table");
        assert!(fits(&sheet, &Columns::default()));
        let all = read(&sheet, &Columns::default()).expect("tracks");
        let told: Vec<_> = all.iter().map(|one| (one.name.as_deref(), one.samples.len())).collect();
        assert_eq!(told, [(Some("low"), 2), (Some("high"), 3)]);
        assert_eq!(all[1].samples[2].z.to_bits(), 7.0_f64.to_bits());
    }

    #[test]
    fn names_of_columns_tell_drops() {
        let told = |text: &[u8]| {
            let sheet = text::read("a.csv", "a", text).expect("a table");
            assert!(fits(&sheet, &Columns::default()));
            let all = read(&sheet, &Columns::default()).expect("tracks");
            all.into_iter().filter_map(|one| one.name).collect::<Vec<_>>()
        };
        assert_eq!(told(b"t_a (ms),y_a (cm),t_b (ms),y_b (cm)\n0,1,0,5\n1,2,1,6\n"), ["a", "b"]);
        assert_eq!(told(b"t0,y0,t1,y1\n0,1,0,5\n1,2,1,6\n"), ["0", "1"]);
        let capstone = b"Time (s) Run #1,Position (m) Run #1,Time (s) Run #2,Position (m) Run #2\n0,1,0,5\n1,2,1,6\n";
        assert_eq!(told(capstone), ["run #1", "run #2"]);
        assert_eq!(told(b"Time (s) Run #3,Position (m) Run #3\n0,1\n1,2\n"), ["run #3"]);
        assert_eq!(
            told(b"Run #1,Run #1,Run #2,Run #2\nt (s),y (m),t (s),y (m)\n0,1,0,5\n1,2,1,6\n"),
            ["Run #1", "Run #2"]
        );
    }

    #[test]
    fn one_column_of_times_makes_no_pairs() {
        let sheet = text::read("a.csv", "a", b"t,y1,y2\n0,1,2\n1,2,3\n").expect("a table");
        assert!(!fits(&sheet, &Columns::default()));
    }
}
