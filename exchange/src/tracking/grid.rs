//! Columns of numbers below a header, as tracks.

use std::collections::BTreeSet;

use super::fault::Fault;
use super::heading::{Heading, Role, is_statistic};
use super::settings::Columns;
use super::sheet::{Number, Row, Sheet};
use super::track::{Measure, STILL, Sample, Track};
use super::units::Unit;

/// What is wrong with a text that is no table.
pub(super) const NO_NUMBERS: &str = "no row of numbers is found";

/// What is wrong with a table that is of no drop.
pub(super) const NO_TIMES: &str = "no column of times or frames is found";

/// The same where each row is called something, as in a summary of runs.
pub(super) const NAMED_ROWS: &str = "its rows are named, and no column of times or frames is found";

/// A sheet with its header.
pub(super) struct Grid<'a> {
    pub(super) sheet: &'a Sheet,
    /// The row of names, among those of the sheet.
    pub(super) header: usize,
    pub(super) headings: Vec<Heading>,
    /// Whether no line of names stands above the numbers.
    pub(super) is_without_names: bool,
    /// Below the header.
    pub(super) rows: &'a [Row],
}

/// A column of labels changes in fewer rows than one in so many.
const MOST_CHANGES: usize = 6;

/// The columns of one track.
#[derive(Clone, Copy, Debug)]
pub(super) struct Places {
    /// `None` where rows are frames.
    pub(super) t: Option<usize>,
    pub(super) z: usize,
    pub(super) x: Option<usize>,
}

impl<'a> Grid<'a> {
    /// The sheet whose header is the row `header` and whose units are in the row `units`.
    pub(super) fn below(sheet: &'a Sheet, header: usize, units: Option<usize>) -> Self {
        // The mark of a comment is no name of a column.
        let is_mark =
            |cell: &&String| ["#", "%", "//", "columns:"].contains(&cell.to_lowercase().as_str());
        let cells = &sheet.rows[header].cells;
        let names = &cells[cells.iter().take_while(is_mark).count()..];
        let mut headings: Vec<Heading> = names.iter().map(|name| Heading::of(name)).collect();
        if let Some(units) = units {
            for (heading, unit) in headings.iter_mut().zip(&sheet.rows[units].cells) {
                heading.unit = Unit::of(unit);
            }
        }
        let first = units.map_or(header, |units| units.max(header)) + 1;
        Self { sheet, header, headings, is_without_names: false, rows: &sheet.rows[first..] }
    }

    /// The sheet below the names that stand above its first row of numbers, with a row of units between
    /// them or not.
    ///
    /// # Errors
    /// If there is no row of numbers.
    pub(super) fn found(sheet: &'a Sheet) -> Result<Self, Fault> {
        let Some(first) = sheet.rows.iter().position(|row| sheet.is_numeric(row, 2)) else {
            let right = "a line of names such as t (ms),y (cm), then rows of numbers";
            return Err(sheet.fault(NO_NUMBERS, right));
        };
        // Readings without a position may stand before the first that has one.
        let is_reading = |row: &&Row| sheet.is_numeric(row, 1) && !sheet.has_words(row);
        let first = first - sheet.rows[..first].iter().rev().take_while(is_reading).count();
        let is_header = |row: &Row| {
            let named = row.cells.iter().filter(|cell| !cell.is_empty()).count();
            named >= 2 && !sheet.is_numeric(row, 1)
        };
        let above: Vec<usize> =
            (0..first).rev().take_while(|at| is_header(&sheet.rows[*at])).collect();
        let is_units = |row: &Row| {
            let cells = || row.cells.iter().filter(|cell| !cell.is_empty());
            let is_unit =
                |cell: &String| Unit::maybe(cell).is_some() && !matches!(cell.as_str(), "t" | "T");
            // Speeds, forces and triggers stand beside positions.
            cells().any(is_unit) && cells().all(|cell| is_unit(cell) || Unit::is_of_others(cell))
        };
        match above[..] {
            [] => Ok(Self::without_names(sheet, first)),
            [units, header, ..] if is_units(&sheet.rows[units]) => {
                Ok(Self::below(sheet, header, Some(units)))
            }
            // Comments stand below names and units.
            [_, units, header, ..] if is_units(&sheet.rows[units]) => {
                Ok(Self { rows: &sheet.rows[first..], ..Self::below(sheet, header, Some(units)) })
            }
            [header, ..] => {
                Ok(Self { rows: &sheet.rows[first..], ..Self::below(sheet, header, None) })
            }
        }
    }

    /// The sheet whose first row is the row `first` of numbers: two columns of which the first grows are times and
    /// positions, others are called by their numbers.
    fn without_names(sheet: &'a Sheet, first: usize) -> Self {
        let rows = &sheet.rows[first..];
        let width = rows[0].cells.len();
        let times: Vec<f64> = rows
            .iter()
            .filter_map(|row| match sheet.number(row.cell(0)) {
                Number::Value(t) => Some(t),
                _ => None,
            })
            .collect();
        let headings = match times.windows(2).all(|pair| pair[1] >= pair[0]) && width == 2 {
            true => ["t", "z"].map(Heading::of).to_vec(),
            false => (1..=width).map(|at| Heading::of(&at.to_string())).collect(),
        };
        Self { sheet, header: first, headings, is_without_names: true, rows }
    }

    /// The column that the user or its name says is of this role.
    ///
    /// # Errors
    /// If the user names one that is not there, or several have the role.
    pub(super) fn column(&self, role: Role, columns: &Columns) -> Result<Option<usize>, Fault> {
        if let Some(asked) = columns.of(role) {
            return self.named(asked).map(Some);
        }
        let mut all: Vec<usize> =
            (0..self.headings.len()).filter(|at| self.headings[*at].role() == Some(role)).collect();
        if all.len() > 1 && role == Role::Vertical {
            // A height of release stands beside all readings of its drop.
            let moves = |at: &usize| !self.is_label(*at) && !self.has_few_values(*at);
            if all.iter().any(moves) {
                all.retain(moves);
            }
        }
        match all[..] {
            [] => Ok(None),
            [only] => Ok(Some(only)),
            _ if role == Role::Vertical => match self.moving(&all)[..] {
                [only] => Ok(Some(only)),
                _ => Err(self.ambiguous(&all)),
            },
            [first, ..] => Ok(Some(first)),
        }
    }

    /// The column that is called `name`, with or without its unit, or whose number from 1 it is.
    pub(super) fn named(&self, name: &str) -> Result<usize, Fault> {
        let lower = name.trim().to_lowercase();
        let with = |is_it: &dyn Fn(&Heading) -> bool| -> Vec<usize> {
            (0..self.headings.len()).filter(|at| is_it(&self.headings[*at])).collect()
        };
        let mut all = with(&|one| one.name.to_lowercase() == lower);
        if all.is_empty() {
            all = with(&|one| one.stem == lower);
        }
        if all.len() > 1 {
            let what = format!("{} columns are called `{name}`", all.len());
            return Err(self.sheet.fault(what, "give each a name of its own in the table"));
        }
        let by_number =
            || name.parse::<usize>().ok().filter(|n| (1..=self.headings.len()).contains(n));
        all.first().copied().or_else(|| Some(by_number()? - 1)).ok_or_else(|| {
            let names: Vec<&str> = self.headings.iter().map(|one| one.name.as_str()).collect();
            let near = configs::nearest(name, names.iter().copied());
            let right = match near {
                Some(near) => format!("did you mean `{near}`? found: {}", names.join(", ")),
                None => format!("found: {}", names.join(", ")),
            };
            self.sheet.fault(format!("no column is called `{name}`"), right)
        })
    }

    /// Whether a column says the same in most neighbouring rows.
    pub(super) fn is_label(&self, at: usize) -> bool {
        let changes = self.rows.windows(2).filter(|pair| pair[0].cell(at) != pair[1].cell(at));
        MOST_CHANGES * changes.count() < self.rows.len()
    }

    /// Those of the columns `all` that move beside the one that moves farthest.
    pub(super) fn moving(&self, all: &[usize]) -> Vec<usize> {
        let way = |at: usize| {
            let values = self.rows.iter().filter_map(|row| match self.sheet.number(row.cell(at)) {
                Number::Value(value) => Some(value),
                _ => None,
            });
            let ends = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
                [low.min(value), high.max(value)]
            });
            ends[1] - ends[0]
        };
        let farthest = all.iter().map(|at| way(*at)).fold(0.0, f64::max);
        all.iter().copied().filter(|at| way(*at) > STILL * farthest).collect()
    }

    /// Whether a column has too few different values to be readings.
    pub(super) fn has_few_values(&self, at: usize) -> bool {
        /// Rows for each value, at least.
        const ROWS: usize = 20;
        let values: BTreeSet<&str> = self.rows.iter().map(|row| row.cell(at)).collect();
        ROWS * values.len() <= self.rows.len()
    }

    fn ambiguous(&self, all: &[usize]) -> Fault {
        let names: Vec<String> =
            all.iter().map(|at| format!("`{}`", self.headings[*at].name)).collect();
        let what = format!("{} may each be the vertical position", names.join(" and "));
        let right = format!("say which: --column z=\"{}\"", self.headings[all[0]].name);
        self.sheet.fault(what, right)
    }

    /// The track in these columns of `rows`, of which it takes those that hold numbers.
    ///
    /// # Errors
    /// A cell that is not a number, or a row that is wider than its header.
    pub(super) fn track(
        &self,
        layout: &str,
        places: Places,
        rows: impl Iterator<Item = (usize, &'a Row)>,
    ) -> Result<Track, Fault> {
        let measure = |at: usize| {
            let heading = &self.headings[at];
            Measure { name: heading.name.clone(), unit: heading.unit.clone() }
        };
        let time = match places.t {
            Some(at) => {
                let is_frame = self.headings[at].role() == Some(Role::Frame);
                let measure = measure(at);
                match is_frame && measure.unit == Unit::Unstated {
                    true => Measure { unit: Unit::Frame, ..measure },
                    false => measure,
                }
            }
            None => Measure { name: "row".to_owned(), unit: Unit::Frame },
        };
        let (mut samples, mut holes) = (Vec::new(), 0);
        for (index, row) in rows {
            self.refuse_wider(row)?;
            // Below the readings may stand their means.
            if places.t.is_some_and(|at| is_statistic(row.cell(at))) {
                holes += 1;
                continue;
            }
            let cell = |at: usize| self.number(row, at);
            let t = match places.t {
                Some(at) => cell(at)?,
                None => Some(index as f64),
            };
            let (z, x) = (cell(places.z)?, places.x.map_or(Ok(Some(0.0)), cell)?);
            match (t, z, x) {
                (Some(t), Some(z), Some(x)) => samples.push(Sample { line: row.line, t, z, x }),
                _ => holes += 1,
            }
        }
        let read = samples.len();
        let samples = without_marks(samples);
        holes += read - samples.len();
        Ok(Track {
            file: self.sheet.file.clone(),
            stem: self.sheet.stem.clone(),
            name: None,
            called: None,
            layout: layout.to_owned(),
            time,
            vertical: measure(places.z),
            forward: places.x.map(measure),
            labels: Vec::new(),
            samples,
            holes,
            notes: self.sheet.notes.clone(),
        })
    }

    fn number(&self, row: &Row, at: usize) -> Result<Option<f64>, Fault> {
        let cell = row.cell(at);
        match self.sheet.number(cell) {
            Number::Value(value) => Ok(Some(value)),
            Number::Missing => Ok(None),
            Number::Other => {
                let name = &self.headings[at].name;
                let what = format!(
                    "\"{}\" in the column `{name}` is not a number",
                    configs::shorten(cell)
                );
                let right = match cell.contains(',') && cell.contains(|c: char| c.is_ascii_digit())
                {
                    true => {
                        "write decimals with a point, or all of the table with a comma and semicolons"
                    }
                    false => "leave a cell empty where nothing was tracked",
                };
                Err(self.sheet.fault(what, right).at(row.line))
            }
        }
    }

    /// Decimal commas between commas make more cells than names.
    fn refuse_wider(&self, row: &Row) -> Result<(), Fault> {
        let filled = row.cells.iter().rposition(|cell| !cell.is_empty()).map_or(0, |last| last + 1);
        let names = self.headings.len();
        if filled <= names {
            return Ok(());
        }
        let what = format!("{filled} cells stand below {names} names of columns");
        let right = match self.sheet.separated {
            "commas" => "decimals after a comma? then separate the columns by semicolons or tabs",
            _ => "every column needs a name, and a cell no separator in it",
        };
        Err(self.sheet.fault(what, right).at(row.line))
    }

    /// All rows with their places.
    pub(super) fn all_rows(&self) -> impl Iterator<Item = (usize, &'a Row)> {
        self.rows.iter().enumerate()
    }

    /// Columns beside those of `used` that say the same in all of `rows`: what they say, with its unit.
    pub(super) fn labels(&self, used: &[usize], rows: &[&Row]) -> Vec<(String, String)> {
        let label = |at: usize| {
            let value = rows.first()?.cell(at);
            let is_one = rows.iter().all(|row| row.cell(at) == value);
            let is_number = matches!(self.sheet.number(value), Number::Value(_));
            let value = match &self.headings[at].unit {
                Unit::Unstated => value.to_owned(),
                // Quantities have a decimal point.
                unit if is_number => format!("{} {}", value.replace(',', "."), unit.word()),
                unit => format!("{value} {}", unit.word()),
            };
            let stem = &self.headings[at].stem;
            (is_one && !value.is_empty() && !stem.is_empty()).then(|| (stem.clone(), value))
        };
        let others = (0..self.headings.len()).filter(|at| !used.contains(at));
        others.filter_map(label).collect()
    }
}

/// Readings but those of a number that trackers write where they saw nothing, far from all that they saw.
fn without_marks(samples: Vec<Sample>) -> Vec<Sample> {
    const MARKS: [f64; 7] = [0.0, -1.0, -99.0, -999.0, -9999.0, 999.0, 9999.0];
    let is = |mark: f64| move |one: &&Sample| one.z.total_cmp(&mark).is_eq();
    let is_mark = |mark: f64| {
        let others = || samples.iter().filter(move |one| !is(mark)(one));
        let steps = others().zip(others().skip(1)).map(|(a, b)| (b.z - a.z).abs());
        let step = steps.fold(0.0, f64::max);
        let nearest = others().map(|one| (one.z - mark).abs()).fold(f64::INFINITY, f64::min);
        nearest.is_finite() && nearest > 3.0 * step && samples.iter().any(|one| is(mark)(&one))
    };
    let marks: Vec<f64> = MARKS.into_iter().filter(|mark| is_mark(*mark)).collect();
    samples.into_iter().filter(|one| !marks.iter().any(|mark| is(*mark)(&one))).collect()
}
