//! The impacts of Wang, Ye & Zheng (2012) on our beds: angles × speeds × positions, under two readings of
//! their contact law.

use std::path::PathBuf;
use std::sync::Arc;

use configs::{ConfigError, LoadOptions, Model, ModelSource, find_shipped};
use runner::beds::{Job, Record};

use super::tables::{Published, published};
use crate::published::laboratory::{Effort, Laboratory, Missing};
use crate::published::row::PublishedError;

/// A reading of the contact law.
#[derive(Debug, PartialEq, Eq)]
pub struct Reading {
    /// As reports name it.
    pub name: &'static str,
    /// The shipped model.
    model: &'static str,
}

/// The law as printed, and the same with the rolling moment that equation 2 names, whose coefficient is
/// not printed.
pub static READINGS: [Reading; 2] = [
    Reading { name: "as printed", model: "vertical-2d" },
    Reading { name: "rolling 0.05", model: "rolling-2d" },
];

/// Impacts at one angle and speed under one reading, on different places of the bed.
#[derive(Clone, Debug)]
pub struct Cell {
    /// The reading.
    pub reading: &'static Reading,
    /// What is published of the angle.
    pub published: &'static Published,
    /// (m/s).
    pub speed: f64,
    /// One per position.
    pub records: Vec<Record>,
}

/// Intruder: diameter (m) and mass (kg).
pub const DIAMETER: f64 = 0.0446;
/// See [`DIAMETER`].
pub const MASS: f64 = 0.0322;

/// Strength of gravity (m/s²).
pub const GRAVITY: f64 = 9.81;

/// A bed of the article's mixture and depth: counts of small and large discs, and its width (m).
struct Bed {
    counts: [u32; 2],
    width: f64,
}

/// Half and two thirds of the article's width, and all of it.
static HALF: Bed = Bed { counts: [6300, 1200], width: 0.509_25 };
static TWO_THIRDS: Bed = Bed { counts: [8400, 1600], width: 0.679 };
static WHOLE: Bed = Bed { counts: [12600, 2400], width: 1.0185 };

/// Angles (deg) of a quick run, each with its speeds (m/s) and the bed that has room for its ranges.
static QUICK: [(f64, &[f64], &Bed); 3] = [
    (15.0, &[1.0, 2.0, 3.0, 4.0], &TWO_THIRDS),
    (45.0, &[0.5, 1.0, 2.0, 3.0, 4.0], &HALF),
    (90.0, &[0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0], &HALF),
];

/// Speeds (m/s) of the full matrix, at every angle of the tables.
const SPEEDS: &[f64] = &[0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0];

/// Positions of the full matrix, as in the article.
const POSITIONS: usize = 6;

/// Angles (deg) and positions that are run first: one angle of each regime and the vertical one, two places
/// away from each other and from the sides.
const FIRST_ANGLES: [f64; 3] = [90.0, 45.0, 15.0];
const FIRST_POSITIONS: [usize; 2] = [1, 4];

/// How near to a side an impact starts or is expected to stop (diameters of the intruder).
const FROM_SIDES: f64 = 2.0;

/// How much longer than published an impact may be, in its range and in its time.
const LONGER: f64 = 1.25;

/// Cells of the matrix, and how many of their impacts there are.
#[derive(Clone, Debug)]
pub struct Matrix {
    /// Those with an impact at least.
    pub cells: Vec<Cell>,
    /// Impacts that the effort asks for.
    pub asked: usize,
}

impl Matrix {
    /// What it cost to run.
    pub fn cost(&self) -> String {
        let records = || self.cells.iter().flat_map(|cell| &cell.records);
        let steps: f64 = records().map(|one| one.steps as f64 * one.grains as f64).sum();
        format!("{} impacts, {steps:.1e} grain-steps.", records().count())
    }

    /// What a report has to say of it while impacts are missing.
    pub fn note(&self) -> Option<String> {
        let there: usize = self.cells.iter().map(|cell| cell.records.len()).sum();
        (there < self.asked).then(|| format!("Judged by {there} of {} impacts.", self.asked))
    }
}

/// The impacts of all readings at those angles (deg) of the effort that `wanted` is true of.
///
/// # Errors
/// If an impact cannot be run, or a cell has none that ran to its end; of what is kept alone, if there is none.
pub fn run(
    laboratory: &Laboratory<'_>,
    wanted: impl Fn(f64) -> bool,
) -> Result<Matrix, PublishedError> {
    let conditions: Vec<(&Published, &[f64])> = match laboratory.effort {
        Effort::Quick => {
            let own = |(angle, speeds, _): &(f64, &'static [f64], &Bed)| {
                Some((published(*angle)?, *speeds))
            };
            QUICK.iter().filter_map(own).collect()
        }
        Effort::Full => super::tables::PUBLISHED.iter().map(|one| (one, SPEEDS)).collect(),
    };
    let mut cells = Vec::new();
    let mut places = Vec::new();
    for reading in &READINGS {
        for (published, speeds) in conditions.iter().filter(|(one, _)| wanted(one.angle_deg)) {
            for (place, &speed) in speeds.iter().enumerate() {
                let own = positions(laboratory.effort, place);
                places.extend(own.map(|position| (cells.len(), position)));
                cells.push(Cell { reading, published, speed, records: Vec::new() });
            }
        }
    }
    // Steep ones first within a turn and a position, both readings of an angle one after the other.
    places.sort_by_key(|&(cell, position)| {
        let flatness = (90.0 - cells[cell].published.angle_deg) as u32;
        (turn(&cells[cell], position), position, flatness)
    });
    let jobs = places
        .iter()
        .map(|&(cell, position)| job(laboratory.effort, &cells[cell], position))
        .collect::<Result<Vec<_>, _>>()?;
    let mut found: Vec<_> = places.iter().zip(laboratory.impacts(&jobs)?).collect();
    // As they are numbered, whatever came first.
    found.sort_by_key(|(place, _)| **place);
    for (&(cell, _), record) in found {
        cells[cell].records.extend(record);
    }
    let empty = cells.iter().find(|cell| cell.records.is_empty());
    if let (Some(Cell { reading, published, speed, .. }), Missing::Run) =
        (empty, laboratory.missing)
    {
        return Err(PublishedError::Missing(format!(
            "no impact at {} deg and {speed} m/s {} could be run to its end",
            published.angle_deg, reading.name
        )));
    }
    cells.retain(|cell| !cell.records.is_empty());
    if cells.is_empty() {
        return Err(PublishedError::NotYet);
    }
    Ok(Matrix { cells, asked: jobs.len() })
}

/// Which turn of the matrix an impact belongs to: what tells most with few impacts is run first.
fn turn(cell: &Cell, position: usize) -> usize {
    let is_first = FIRST_ANGLES.iter().any(|angle| (cell.published.angle_deg - angle).abs() < 1e-9);
    match (FIRST_POSITIONS.contains(&position), is_first) {
        (true, true) => 0,
        (true, false) => 1,
        (false, _) => 2,
    }
}

/// Angles (deg) of which there are cells, in their order.
pub fn angles(cells: &[Cell]) -> Vec<f64> {
    let mut angles: Vec<f64> = cells.iter().map(|cell| cell.published.angle_deg).collect();
    angles.sort_by(f64::total_cmp);
    angles.dedup();
    angles
}

/// The cells of one reading at one angle (deg).
pub fn of<'a>(cells: &'a [Cell], reading: &Reading, angle_deg: f64) -> Vec<&'a Cell> {
    let same = |cell: &&Cell| {
        cell.reading == reading && (cell.published.angle_deg - angle_deg).abs() < 1e-9
    };
    cells.iter().filter(same).collect()
}

/// The positions of a cell: all when full; when quick one, another one from speed to speed, so that what
/// is left over by a fit over speeds scatters as positions do.
fn positions(effort: Effort, place: usize) -> std::ops::Range<usize> {
    match effort {
        Effort::Quick => {
            let position = (2 * place + 1) % POSITIONS;
            position..position + 1
        }
        Effort::Full => 0..POSITIONS,
    }
}

/// The bed for impacts at an angle (deg).
fn bed(effort: Effort, angle_deg: f64) -> &'static Bed {
    let same = |(own, ..): &&(f64, &[f64], &Bed)| (own - angle_deg).abs() < 1e-9;
    let quick = QUICK.iter().find(same).filter(|_| effort == Effort::Quick);
    quick.map_or(&WHOLE, |(.., bed)| *bed)
}

/// The impact of `cell` at `position`.
fn job(effort: Effort, cell: &Cell, position: usize) -> Result<Job, ConfigError> {
    let Cell { reading, published, speed, .. } = cell;
    let &Bed { counts, width } = bed(effort, published.angle_deg);
    let range = published.range.map_or(0.0, |line| LONGER * line.at(*speed).max(0.0));
    let (left, right) = (FROM_SIDES * DIAMETER, width - FROM_SIDES * DIAMETER - range);
    let x = left + (position as f64 + 0.5) / POSITIONS as f64 * (right - left);
    let mut sets = vec![
        format!("impact.speed=\"{speed:?} m/s\""),
        format!("impact.angle=\"{:?} deg\"", published.angle_deg),
        format!("impact.x=\"{x:?} m\""),
        "run.duration=\"2 s\"".to_owned(),
    ];
    if effort == Effort::Quick {
        let count = |(kind, count)| format!("bed.grains.{kind}.count={count}");
        sets.extend(counts.iter().enumerate().map(count));
        sets.push(format!("container.width=\"{width} m\""));
    }
    let source = find_shipped(reading.model).map(ModelSource::Shipped);
    let source = source.unwrap_or_else(|| ModelSource::Path(PathBuf::from(reading.model)));
    let options = LoadOptions { sets, ..LoadOptions::default() };
    let model = Arc::new(Model::load(source, &options)?.model);
    // Between 0.15 and 0.6 s; at 30 deg, where none is published, about as long as at 45.
    let time = published.stopping_time.map_or(0.25, |time| time.at(*speed));
    Ok(Job { bed: Arc::clone(&model), model, expected: LONGER * time, settles: false })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn start(effort: Effort, angle: f64, speed: f64, position: usize) -> f64 {
        let published = published(angle).expect("an angle of the tables");
        let cell = Cell { reading: &READINGS[0], published, speed, records: Vec::new() };
        let job = job(effort, &cell, position).expect("a model");
        job.model.grains().and_then(|grains| grains.medium.start.x).expect("a place")
    }

    #[test]
    fn every_impact_has_room_for_its_range_on_its_bed() {
        let quick = QUICK.iter().map(|(angle, speeds, _)| (Effort::Quick, *angle, *speeds));
        let full = super::super::tables::PUBLISHED.iter();
        let full = full.map(|one| (Effort::Full, one.angle_deg, SPEEDS));
        for (effort, angle, speeds) in quick.chain(full) {
            let published = published(angle).expect("an angle of the tables");
            let width = bed(effort, angle).width;
            for speed in speeds {
                let range = published.range.map_or(0.0, |line| line.at(*speed));
                for position in 0..POSITIONS {
                    let x = start(effort, angle, *speed, position);
                    assert!(x > DIAMETER && x + range < width - DIAMETER, "{published:?} {x}");
                }
            }
        }
    }

    #[test]
    fn a_bed_of_a_quick_run_has_the_articles_mixture_and_depth() {
        for bed in [&HALF, &TWO_THIRDS] {
            let [small, large] = bed.counts.map(f64::from);
            // Counts are whole numbers of the article's share, widths to the last digit given.
            assert!((small / large - 5.25).abs() < 1e-12, "{small} {large}");
            assert!(((small + large) / bed.width / (15_000.0 / WHOLE.width) - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn a_matrix_of_which_little_is_there_says_so_and_one_that_is_whole_does_not() {
        let published = published(90.0).expect("an angle of the tables");
        let records = vec![super::super::records::record(1.0, vec![0.0; 2], vec![0.0, 0.1])];
        let cell = Cell { reading: &READINGS[0], published, speed: 1.0, records };
        let note = |asked| Matrix { cells: vec![cell.clone()], asked }.note();
        assert_eq!(note(1), None);
        assert!(note(6).is_some_and(|note| note.contains("1 of 6")));
    }

    #[test]
    fn both_readings_fall_on_the_same_bed() {
        let beds = READINGS.each_ref().map(|reading| {
            let published = published(90.0).expect("an angle of the tables");
            let cell = Cell { reading, published, speed: 1.0, records: Vec::new() };
            let job = job(Effort::Quick, &cell, 0).expect("a model");
            job.bed.grains().expect("a bed of grains").bed_key_text().to_owned()
        });
        assert_eq!(beds[0], beds[1]);
    }
}
