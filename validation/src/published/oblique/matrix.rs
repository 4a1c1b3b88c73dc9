//! The impacts of Wang, Ye & Zheng (2012) on our beds: angles × speeds × positions, under two readings of
//! their contact law.

use std::path::PathBuf;
use std::sync::Arc;

use configs::{ConfigError, LoadOptions, Model, ModelSource, find_shipped};

use super::tables::{Published, published};
use crate::beds::{Impacts, Job, Record};
use crate::published::laboratory::{Effort, Laboratory};
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

/// Angles (deg), each with its speeds (m/s), of a quick run.
const QUICK: [(f64, &[f64]); 3] =
    [(15.0, &[1.0, 2.5, 4.0]), (45.0, &[0.5, 1.0, 2.0, 4.0]), (90.0, &[0.5, 1.0, 2.0, 3.0, 4.0])];

/// Speeds (m/s) of the full matrix, at every angle of the tables.
const SPEEDS: &[f64] = &[0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0];

/// Positions of the full matrix, as in the article.
const POSITIONS: usize = 6;

/// A quick bed: two thirds of the article's width, as deep and of the same mixture.
const QUICK_BED: [&str; 3] =
    ["bed.grains.0.count=8400", "bed.grains.1.count=1600", "container.width=\"0.679 m\""];

/// Widths of both beds (m).
const WIDTHS: [f64; 2] = [0.679, 1.0185];

/// How near to a side an impact starts or is expected to stop (diameters of the intruder).
const FROM_SIDES: f64 = 2.0;

/// How much longer than published an impact may be, in its range and in its time.
const LONGER: f64 = 1.25;

/// The impacts of all readings at those angles (deg) of the effort that `wanted` is true of.
///
/// # Errors
/// If an impact cannot be run.
pub fn cells(
    laboratory: &Laboratory<'_>,
    wanted: impl Fn(f64) -> bool,
) -> Result<Vec<Cell>, PublishedError> {
    let conditions: Vec<(&Published, &[f64])> = match laboratory.effort {
        Effort::Quick => {
            QUICK.iter().filter_map(|(angle, speeds)| Some((published(*angle)?, *speeds))).collect()
        }
        Effort::Full => super::tables::PUBLISHED.iter().map(|one| (one, SPEEDS)).collect(),
    };
    let mut cells = Vec::new();
    let mut jobs = Vec::new();
    for reading in &READINGS {
        for (published, speeds) in conditions.iter().filter(|(one, _)| wanted(one.angle_deg)) {
            for (place, &speed) in speeds.iter().enumerate() {
                cells.push(Cell { reading, published, speed, records: Vec::new() });
                for position in positions(laboratory.effort, place) {
                    jobs.push(job(laboratory.effort, &cells[cells.len() - 1], position)?);
                }
            }
        }
    }
    let each = jobs.len() / cells.len().max(1);
    let mut records = laboratory.place.run(&jobs)?.into_iter();
    for cell in &mut cells {
        cell.records = records.by_ref().take(each).flatten().collect();
        if cell.records.is_empty() {
            let Cell { reading, published, speed, .. } = cell;
            return Err(PublishedError::Missing(format!(
                "no impact at {} deg and {speed} m/s {} could be run to its end",
                published.angle_deg, reading.name
            )));
        }
    }
    Ok(cells)
}

/// Angles (deg) of which there are cells, in their order.
#[must_use]
pub fn angles(cells: &[Cell]) -> Vec<f64> {
    let mut angles: Vec<f64> = cells.iter().map(|cell| cell.published.angle_deg).collect();
    angles.sort_by(f64::total_cmp);
    angles.dedup();
    angles
}

/// The cells of one reading at one angle (deg).
#[must_use]
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

/// The impact of `cell` at `position`.
fn job(effort: Effort, cell: &Cell, position: usize) -> Result<Job, ConfigError> {
    let Cell { reading, published, speed, .. } = cell;
    let width = WIDTHS[usize::from(effort == Effort::Full)];
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
        sets.extend(QUICK_BED.map(str::to_owned));
    }
    let source = find_shipped(reading.model).map(ModelSource::Shipped);
    let source = source.unwrap_or_else(|| ModelSource::Path(PathBuf::from(reading.model)));
    let options = LoadOptions { sets, ..LoadOptions::default() };
    let model = Arc::new(Model::load(source, &options)?.model);
    // Between 0.15 and 0.6 s; at 30 deg, where none is published, about as long as at 45.
    let time = published.stopping_time.map_or(0.25, |time| time.at(*speed));
    Ok(Job { bed: Arc::clone(&model), model, expected: LONGER * time })
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
    fn every_impact_has_room_for_its_range_on_the_bed() {
        for published in &super::super::tables::PUBLISHED {
            for speed in SPEEDS {
                let range = published.range.map_or(0.0, |line| line.at(*speed));
                for position in 0..POSITIONS {
                    let x = start(Effort::Full, published.angle_deg, *speed, position);
                    assert!(x > DIAMETER && x + range < WIDTHS[1] - DIAMETER, "{published:?} {x}");
                }
            }
        }
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
