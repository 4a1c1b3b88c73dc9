//! The impacts of three shapes that rows E6 to E8 and E13 share.

use runner::beds::Impacts;

use super::laboratory::{Effort, Laboratory, Missing};
use super::row::PublishedError;
use crate::three_shapes::{self, Bed, Case, FRICTIONS, Outcome, RUBBED, SHAPES};

/// Speeds (m/s), quick and in full. From 4 m/s on the small beds of quick throw the intruder back before it
/// has gone as deep as it does in a wide bed: what the impact has set off comes back from the walls first.
const SPEEDS: [&[f64]; 2] = [&[0.5, 0.7, 1.0, 1.4, 2.0], &[0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0]];

/// Beds, quick and in full.
const SEEDS: [u64; 2] = [1, 3];

/// An impact and what came of it.
pub type Impact = (Case, Outcome);

/// The impacts of `shapes` at every speed, on every bed.
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
pub fn all_shapes(laboratory: &Laboratory<'_>) -> Result<Vec<Impact>, PublishedError> {
    over_speed(laboratory, &SHAPES)
}

/// The hemisphere without and with friction, a pair per bed.
pub fn rubbed(laboratory: &Laboratory<'_>) -> Result<Vec<[Impact; 2]>, PublishedError> {
    let (bed, which) = of_effort(laboratory);
    let (model, speed) = RUBBED;
    let with = |seed, friction| Case { model, speed, seed, friction: Some(friction), bed };
    let cases = (1..=SEEDS[which]).flat_map(|seed| FRICTIONS.map(|friction| with(seed, friction)));
    let impacts = run(laboratory, cases.collect())?;
    let pairs = impacts.chunk_by(|(a, _), (b, _)| a.seed == b.seed);
    Ok(pairs.filter_map(|pair| <[Impact; 2]>::try_from(pair.to_vec()).ok()).collect())
}

/// Largest depth (m) of an impact: the study's "maximum impact depth". Where the bed throws the intruder back it is
/// more than that until the velocity is first zero.
pub fn deepest(one: &Outcome) -> f64 {
    one.path_m.iter().copied().fold(one.depth_m, f64::max)
}

/// Those of one shape.
pub fn of<'a>(impacts: &'a [Impact], shape: &str) -> Vec<&'a Impact> {
    impacts.iter().filter(|(case, _)| case.model == shape).collect()
}

/// The shape's name without its dimension.
pub fn name(shape: &str) -> &str {
    shape.trim_end_matches("-3d")
}

fn of_effort(laboratory: &Laboratory<'_>) -> (Bed, usize) {
    match laboratory.effort {
        Effort::Quick => (Bed::Small, 0),
        Effort::Full => (Bed::Study, 1),
    }
}

/// The impacts of `cases`, or those of them that are there.
fn run(laboratory: &Laboratory<'_>, cases: Vec<Case>) -> Result<Vec<Impact>, PublishedError> {
    let places = &laboratory.shapes;
    let outcomes = match laboratory.missing {
        Missing::LeaveOut => three_shapes::kept(&cases, places)?,
        Missing::Run => {
            if let Some(elsewhere) = laboratory.place.elsewhere {
                three_shapes::have_done(&cases, places, elsewhere, laboratory.place.watch)?;
            }
            let workers = laboratory.place.n_workers();
            let outcomes = three_shapes::run(&cases, places, workers, &|_, _| ())?;
            outcomes.into_iter().map(Some).collect()
        }
    };
    let impacts: Vec<Impact> =
        cases.into_iter().zip(outcomes).filter_map(|(case, one)| Some((case, one?))).collect();
    match impacts.is_empty() {
        true => Err(PublishedError::NotYet),
        false => Ok(impacts),
    }
}

/// An impact of the shape `model` at `speed` (m/s) of which nothing but its energy is known, for tests.
#[cfg(test)]
pub(crate) fn blank(model: &'static str, speed: f64) -> Impact {
    let case = Case { model, speed, seed: 1, friction: None, bed: Bed::Small };
    let outcome = Outcome {
        key: String::new(),
        depth_m: 0.0,
        stopping_time_s: None,
        impact_energy_j: speed * speed,
        closure: 0.0,
        moving_share: 0.0,
        dissipation_time_s: None,
        time_s: Vec::new(),
        down_m_per_s: Vec::new(),
        path_m: Vec::new(),
        fall_m: 0.0,
        energies: three_shapes::Energies::default(),
    };
    (case, outcome)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_depth_is_that_after_a_rebound_where_it_is_more() {
        let (_, outcome) = blank(SHAPES[0], 1.0);
        let path_m = vec![0.0, 2.8e-3, 2.5e-3, 4.0e-3];
        let thrown_back = Outcome { depth_m: 2.8e-3, path_m, ..outcome };
        assert!((deepest(&thrown_back) - 4.0e-3).abs() < 1e-18, "a copy");
    }
}
