//! Plain tables in long form: a column says which run a row is of, or several columns do together.

use std::collections::BTreeMap;

use super::Layout;
use crate::tracking::bodies::is_body;
use crate::tracking::fault::Fault;
use crate::tracking::grid::{Grid, Places};
use crate::tracking::heading::Role;
use crate::tracking::names::{SET, is_of_run};
use crate::tracking::settings::Columns;
use crate::tracking::sheet::{Number, Row, Sheet};
use crate::tracking::track::Track;
use crate::tracking::units::Unit;

pub(super) const LAYOUT: Layout = Layout { fits, read };

fn fits(sheet: &Sheet, columns: &Columns) -> bool {
    Grid::found(sheet).is_ok_and(|grid| !telling(&grid, columns).is_empty())
}

fn read(sheet: &Sheet, columns: &Columns) -> Result<Vec<Track>, Fault> {
    let grid = Grid::found(sheet)?;
    let telling = telling(&grid, columns);
    let places = super::single::places(&grid, columns)?;
    let told: Vec<String> = grid.rows.iter().map(|row| name(row, &telling)).collect();
    let mut names: Vec<&String> = Vec::new();
    for (row, name) in grid.rows.iter().zip(&told) {
        if let Some(at) = telling.iter().find(|at| row.cell(**at).is_empty()) {
            let what = format!("the column `{}` is empty", grid.headings[*at].name);
            return Err(sheet.fault(what, "every row needs the name of its run").at(row.line));
        }
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let of = |name: &String| {
        let own = grid.all_rows().filter(|(at, _)| told[*at] == *name);
        let own: Vec<(usize, &Row)> = own.collect();
        let rows: Vec<&Row> = own.iter().map(|(_, row)| *row).collect();
        let layout = format!("long, {}", sheet.separated);
        let track = grid.track(&layout, places, own.into_iter())?;
        let mut used: Vec<usize> =
            [places.t, Some(places.z), places.x].into_iter().flatten().collect();
        if let [run] = telling[..] {
            used.push(run);
        }
        let mut labels = grid.labels(&used, &rows);
        let called = (telling.len() > 1).then(|| called(&grid, &telling, rows[0]));
        // The number of a run that begins again is that of the repeat.
        let run = telling.iter().find(|at| grid.headings[**at].role() == Some(Role::Run));
        if let (Some(run), Some(_)) = (run, &called) {
            labels.push(("repeat".to_owned(), rows[0].cell(*run).to_owned()));
        }
        Ok(Track { name: Some(name.clone()), called, labels, ..track })
    };
    names.into_iter().map(of).collect()
}

/// The columns that tell runs apart: that of runs, with others where its numbers begin again, else all labels, where the times of
/// several drops stand below each other.
fn telling(grid: &Grid<'_>, columns: &Columns) -> Vec<usize> {
    let places = super::single::places(grid, columns);
    let run = grid.column(Role::Run, columns).ok().flatten();
    let Ok(Places { t: Some(t), z, x }) = places else { return run.into_iter().collect() };
    let is_other = |at: &usize| ![Some(t), Some(z), x, run].contains(&Some(*at));
    let labels = (0..grid.headings.len()).filter(is_other).filter(|at| grid.is_label(*at));
    let labels: Vec<usize> = labels.collect();
    let time = |row: &Row| match grid.sheet.number(row.cell(t)) {
        Number::Value(time) => Some(time),
        _ => None,
    };
    if let Some(run) = run {
        if columns.of(Role::Run).is_some() {
            return vec![run];
        }
        let others = beside(grid, run, |at| is_other(&at));
        let with: Vec<usize> = others.iter().copied().chain([run]).collect();
        let all: Vec<usize> = labels.iter().copied().chain([run]).collect();
        let is_told = |telling: &Vec<usize>| !starts_again(grid, telling, &labels, &time);
        return [vec![run], all]
            .into_iter()
            .filter(|_| others.is_empty())
            .chain([with])
            .find(is_told)
            .unwrap_or(vec![run]);
    }
    let starts_again =
        |pair: &[Row]| time(&pair[0]).zip(time(&pair[1])).is_some_and(|(a, b)| b < a);
    let is_told = |pair: &&[Row]| name(&pair[0], &labels) != name(&pair[1], &labels);
    let starts: Vec<&[Row]> = grid.rows.windows(2).filter(|pair| starts_again(pair)).collect();
    let all_are_told = !starts.is_empty() && starts.iter().all(is_told);
    if all_are_told { labels } else { Vec::new() }
}

/// The columns for bodies or heights that say several things of one run of the column `run`: its numbers begin again in each.
fn beside(grid: &Grid<'_>, run: usize, is_other: impl Fn(usize) -> bool) -> Vec<usize> {
    let varies = |at: usize| {
        let mut said: BTreeMap<&str, &str> = BTreeMap::new();
        grid.rows
            .iter()
            .any(|row| *said.entry(row.cell(run)).or_insert(row.cell(at)) != row.cell(at))
    };
    let is_it = |at: &usize| {
        let stem = grid.headings[*at].stem.as_str();
        is_other(*at)
            && (is_body(stem) || SET.contains(&stem))
            && grid.has_few_values(*at)
            && varies(*at)
    };
    (0..grid.headings.len()).filter(is_it).collect()
}

/// Whether the time of a run that these columns tell goes back where another began between, or where `labels` change.
fn starts_again(
    grid: &Grid<'_>,
    telling: &[usize],
    labels: &[usize],
    time: &impl Fn(&Row) -> Option<f64>,
) -> bool {
    let mut last: BTreeMap<String, usize> = BTreeMap::new();
    let goes_back = |(at, row): (usize, &Row)| {
        let before = last.insert(name(row, telling), at)?;
        let is_back = time(&grid.rows[before]).zip(time(row)).is_some_and(|(a, b)| b < a);
        let is_parted = before + 1 < at || name(&grid.rows[before], labels) != name(row, labels);
        (is_back && is_parted).then_some(())
    };
    grid.rows.iter().enumerate().find_map(goes_back).is_some()
}

/// What stands in the columns `telling` of a row.
fn name(row: &Row, telling: &[usize]) -> String {
    telling.iter().map(|&at| row.cell(at)).collect::<Vec<_>>().join("_")
}

/// The same with what each of them says of conditions; the number of the repeat stands last.
fn called(grid: &Grid<'_>, telling: &[usize], row: &Row) -> String {
    let said = |at: &usize| {
        let (heading, value) = (&grid.headings[*at], row.cell(*at));
        let is_repeat = heading.role() == Some(Role::Run) || is_of_run(&heading.stem);
        let is_one = grid.rows.iter().all(|other| other.cell(*at) == value);
        let unit = if heading.unit == Unit::Unstated { "" } else { heading.unit.word() };
        match grid.sheet.number(value) {
            _ if is_repeat => (true, format!("r{value}")),
            _ if is_one => (false, String::new()),
            Number::Value(_) => (false, format!("{}{value}{unit}", heading.stem.replace(' ', "_"))),
            _ => (false, value.to_owned()),
        }
    };
    let mut all: Vec<(bool, String)> =
        telling.iter().map(said).filter(|(_, text)| !text.is_empty()).collect();
    all.sort_by_key(|(is_repeat, _)| *is_repeat);
    all.into_iter().map(|(_, text)| text).collect::<Vec<_>>().join("/")
}
