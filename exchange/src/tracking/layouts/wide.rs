//! Plain tables in wide form: one column of times, and a column of positions for each drop.

use super::Layout;
use crate::tracking::fault::Fault;
use crate::tracking::grid::{Grid, Places};
use crate::tracking::heading::{Role, is_statistic};
use crate::tracking::settings::Columns;
use crate::tracking::sheet::{Number, Sheet};
use crate::tracking::track::{Track, deviation, without_still};

pub(super) const LAYOUT: Layout = Layout { fits, read };

fn fits(sheet: &Sheet, columns: &Columns) -> bool {
    let asked = columns.of(Role::Vertical).is_some();
    !asked && Grid::found(sheet).is_ok_and(|grid| !drops(&grid).is_empty())
}

fn read(sheet: &Sheet, columns: &Columns) -> Result<Vec<Track>, Fault> {
    let grid = Grid::found(sheet)?;
    let t = time(&grid, columns)?;
    let one = |(name, z, x): (String, usize, Option<usize>)| {
        let layout = format!("wide, {}", sheet.separated);
        let track = grid.track(&layout, Places { t, z, x }, grid.all_rows())?;
        Ok(Track { name: Some(name), ..track })
    };
    grid.column(Role::Run, columns)?;
    let tracks: Vec<Track> = drops(&grid).into_iter().map(one).collect::<Result<_, _>>()?;
    let mut tracks = without_still(tracks);
    let taken = |name: &str| tracks.iter().any(|track| track.name.as_deref() == Some(name));
    refuse_twice(&tracks, sheet)?;
    let stems = grid.headings.iter().map(|heading| heading.stem.as_str());
    let left: Vec<&str> = stems.filter(|stem| is_statistic(stem) && !taken(stem)).collect();
    if !left.is_empty() {
        let note = format!("{}: no drop by its name, left out", left.join(", "));
        tracks.iter_mut().take(1).for_each(|first| first.notes.push(note.clone()));
    }
    // The name of the one column of positions is no name of a run.
    if let [only] = &mut tracks[..] {
        only.name = None;
    }
    Ok(tracks)
}

fn time(grid: &Grid<'_>, columns: &Columns) -> Result<Option<usize>, Fault> {
    match grid.column(Role::Time, columns)? {
        Some(at) => Ok(Some(at)),
        None => grid.column(Role::Frame, columns),
    }
}

/// Refuses columns that are of one body by their names, such as `raw` and `filtered`, and by their motion.
fn refuse_twice(tracks: &[Track], sheet: &Sheet) -> Result<(), Fault> {
    const NAMES: [&str; 20] = [
        "raw",
        "filtered",
        "filt",
        "smooth",
        "smoothed",
        "corrected",
        "fit",
        "fitted",
        "top",
        "bottom",
        "upper",
        "lower",
        "centre",
        "center",
        "middle",
        "tip",
        "left",
        "right",
        "front",
        "back",
    ];
    let is_part = |name: &str| name.split([' ', '_', '-']).any(|word| NAMES.contains(&word));
    let parts = tracks.iter().filter(|track| track.name.as_deref().is_some_and(is_part));
    refuse_together(&parts.collect::<Vec<_>>(), sheet)
}

/// Refuses parts that keep their distance.
pub(super) fn refuse_together(parts: &[&Track], sheet: &Sheet) -> Result<(), Fault> {
    let pairs = parts
        .iter()
        .enumerate()
        .flat_map(|(at, one)| parts[at + 1..].iter().map(move |other| (*one, *other)));
    let Some((one, other)) = pairs.into_iter().find(|(one, other)| move_together(one, other))
    else {
        return Ok(());
    };
    let [one, other] = [one, other].map(|track| &track.vertical.name);
    let what = format!("`{one}` and `{other}` move together: they are of one body");
    Err(sheet.fault(what, format!("say which is imported: --column z=\"{one}\"")))
}

/// Whether the readings of two tracks of one clock keep their distance.
fn move_together(one: &Track, other: &Track) -> bool {
    /// Standard deviation of the distance over that of the position.
    const STEADY: f64 = 0.05;
    let (apart, own): (Vec<f64>, Vec<f64>) =
        one.beside(other).map(|[one, other]| (one - other, one)).unzip();
    deviation(&apart) < STEADY * deviation(&own)
}

/// Names of the drops, with the columns of their positions: points of a coordinate (`y1`, `y2`), or, where no
/// column is called like a position, every column of numbers.
fn drops(grid: &Grid<'_>) -> Vec<(String, usize, Option<usize>)> {
    let role = |at: usize| grid.headings[at].role();
    let has = |wanted: Role| (0..grid.headings.len()).any(|at| role(at) == Some(wanted));
    if has(Role::Vertical) || !(has(Role::Time) || has(Role::Frame)) {
        return Vec::new();
    }
    let points = |wanted: Role| {
        (0..grid.headings.len()).filter_map(move |at| {
            let (role, name) = grid.headings[at].point()?;
            // `v_y` and `a_y` are no places.
            let is_place = !matches!(name.as_str(), "v" | "a" | "velocity" | "acceleration" | "");
            (role == wanted && is_place).then_some((name, at))
        })
    };
    let forward: Vec<(String, usize)> = points(Role::Forward).collect();
    let named: Vec<_> = points(Role::Vertical)
        .map(|(name, z)| {
            let x = forward.iter().find(|(other, _)| *other == name).map(|(_, x)| *x);
            (name, z, x)
        })
        .collect();
    if !named.is_empty() {
        return named;
    }
    let numbers = |at: usize| {
        let is_value = |cell: &str| matches!(grid.sheet.number(cell), Number::Value(_));
        2 * grid.rows.iter().filter(|row| is_value(row.cell(at))).count() > grid.rows.len()
    };
    let others = (0..grid.headings.len()).filter(|at| role(*at).is_none() && numbers(*at));
    let all: Vec<_> = others.map(|at| (grid.headings[at].stem.clone(), at, None)).collect();
    let drops: Vec<_> = all.iter().filter(|(name, ..)| !is_statistic(name)).cloned().collect();
    if drops.is_empty() { all } else { drops }
}
