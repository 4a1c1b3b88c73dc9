//! The impacts of three shapes that rows E6 to E8 and E13 share.

use super::laboratory::{Effort, Laboratory};
use super::row::PublishedError;
use crate::three_shapes::{self, Bed, Case, FRICTIONS, Outcome, RUBBED, SHAPES};

/// Speeds (m/s), quick and in full.
const SPEEDS: [&[f64]; 2] = [&[1.0, 2.0, 4.0], &[0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0]];

/// Beds, quick and in full.
const SEEDS: [u64; 2] = [1, 3];

/// An impact and what came of it.
pub type Impact = (Case, Outcome);

/// The impacts of `shapes` at every speed, on every bed.
///
/// # Errors
/// If one cannot be run.
pub fn over_speed(
    laboratory: &Laboratory<'_>,
    shapes: &[&'static str],
) -> Result<Vec<Impact>, PublishedError> {
    let (bed, which) = of_effort(laboratory);
    let mut cases = Vec::new();
    for seed in 1..=SEEDS[which] {
        for &model in shapes {
            let case = |&speed: &f64| Case { model, speed, seed, friction: None, bed };
            cases.extend(SPEEDS[which].iter().map(case));
        }
    }
    run(laboratory, cases)
}

/// The impacts of all three shapes.
///
/// # Errors
/// If one cannot be run.
pub fn all_shapes(laboratory: &Laboratory<'_>) -> Result<Vec<Impact>, PublishedError> {
    over_speed(laboratory, &SHAPES)
}

/// The hemisphere without and with friction, a pair per bed.
///
/// # Errors
/// If one cannot be run.
pub fn rubbed(laboratory: &Laboratory<'_>) -> Result<Vec<[Impact; 2]>, PublishedError> {
    let (bed, which) = of_effort(laboratory);
    let (model, speed) = RUBBED;
    let with = |seed, friction| Case { model, speed, seed, friction: Some(friction), bed };
    let cases = (1..=SEEDS[which]).flat_map(|seed| FRICTIONS.map(|friction| with(seed, friction)));
    let impacts = run(laboratory, cases.collect())?;
    Ok(impacts.chunks_exact(2).map(|pair| [pair[0].clone(), pair[1].clone()]).collect())
}

/// Those of one shape.
#[must_use]
pub fn of<'a>(impacts: &'a [Impact], shape: &str) -> Vec<&'a Impact> {
    impacts.iter().filter(|(case, _)| case.model == shape).collect()
}

/// The shape's name without its dimension.
#[must_use]
pub fn name(shape: &str) -> &str {
    shape.trim_end_matches("-3d")
}

fn of_effort(laboratory: &Laboratory<'_>) -> (Bed, usize) {
    match laboratory.effort {
        Effort::Quick => (Bed::Small, 0),
        Effort::Full => (Bed::Study, 1),
    }
}

fn run(laboratory: &Laboratory<'_>, cases: Vec<Case>) -> Result<Vec<Impact>, PublishedError> {
    let workers = laboratory
        .place
        .workers
        .map_or_else(|| std::thread::available_parallelism().map_or(1, usize::from), usize::from);
    let outcomes = three_shapes::run(&cases, &laboratory.shapes, workers, &|_, _| ())?;
    Ok(cases.into_iter().zip(outcomes).collect())
}
