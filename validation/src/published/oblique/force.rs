//! The force on the intruder at fixed depths, from the path of each impact itself, and the law that it is
//! separated into.
//!
//! A path is sampled every 0.5 ms; by Newton's law its second difference is the mean force around a sample,
//! over about as long as the article's window of ±1 mm takes at 2 m/s.

use super::matrix::{Cell, GRAVITY, MASS};
use super::tables::ForceLaw;
use crate::beds::Record;
use crate::published::check::Estimate;
use crate::published::regression;

/// The article's nine depths (m).
pub const DEPTHS: [f64; 9] = [0.015, 0.025, 0.035, 0.045, 0.055, 0.065, 0.075, 0.085, 0.095];

/// Half the article's window around a depth (m).
const WINDOW: f64 = 1e-3;

/// A component of the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Component {
    /// Along the motion.
    Horizontal,
    /// Downward.
    Vertical,
}

/// What acts at a depth in one impact: means over the samples within the window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// (m).
    pub depth: f64,
    /// Square of the velocity component (m²/s²).
    pub square: f64,
    /// Force of the bed against the motion (N).
    pub force: f64,
}

/// A law separated from the readings of impacts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Separated {
    /// α (kg/m).
    pub drag: Estimate,
    /// f (N/m).
    pub friction: Estimate,
    /// Correlation of both.
    pub correlation: f64,
    /// Share of the variance of the forces, averaged over positions, that the law explains.
    pub r_squared: f64,
    /// Impacts that it was separated from, and that were left out one after another.
    pub impacts: usize,
}

impl Separated {
    /// How many of its standard errors hold a coefficient as surely as so many `sigmas` do where the scatter is
    /// known.
    #[must_use]
    pub fn as_surely_as(&self, sigmas: f64) -> f64 {
        regression::student(sigmas, self.impacts.saturating_sub(1))
    }

    /// The law without its errors.
    #[must_use]
    pub fn law(&self) -> ForceLaw {
        ForceLaw { drag: self.drag.value, friction: self.friction.value }
    }
}

/// The readings of one impact at the depths that it passes before it stops.
#[must_use]
pub fn readings(record: &Record, component: Component) -> Vec<Option<Reading>> {
    let path = match component {
        Component::Horizontal => &record.range,
        Component::Vertical => &record.depth,
    };
    let (dt, stop) = (record.interval, record.stopping_time.unwrap_or(record.end));
    let last = ((stop / dt) as usize).min(path.len().saturating_sub(2));
    let sample = |at: usize| {
        let velocity = (path[at + 1] - path[at - 1]) / (2.0 * dt);
        let acceleration = (path[at + 1] - 2.0 * path[at] + path[at - 1]) / (dt * dt);
        let weight = if component == Component::Vertical { MASS * GRAVITY } else { 0.0 };
        (velocity * velocity, weight - MASS * acceleration)
    };
    let at_depth = |depth: f64| {
        let near = |&at: &usize| (record.depth[at] - depth).abs() <= WINDOW;
        let mut samples: Vec<usize> = (1..=last).filter(near).collect();
        if samples.is_empty() {
            // Faster than a window per sample: the two on either side.
            let beyond = (1..=last).find(|&at| record.depth[at] > depth)?;
            samples = [beyond.saturating_sub(1).max(1), beyond].to_vec();
        }
        let n = samples.len() as f64;
        let (square, force) = samples
            .into_iter()
            .map(sample)
            .fold((0.0, 0.0), |sum, one| (sum.0 + one.0 / n, sum.1 + one.1 / n));
        Some(Reading { depth, square, force })
    };
    DEPTHS.iter().map(|&depth| at_depth(depth)).collect()
}

/// The law `α v² + f y` of the impacts of one reading at one angle. Errors are those of leaving out one
/// impact after another: the forces of one path are not independent. `None` where the paths do not decide.
#[must_use]
pub fn separate(cells: &[&Cell], component: Component) -> Option<Separated> {
    let by_impact: Vec<Vec<Reading>> = cells
        .iter()
        .flat_map(|cell| &cell.records)
        .map(|record| readings(record, component).into_iter().flatten().collect())
        .collect();
    let n = by_impact.len();
    let without = |left_out: Option<usize>| {
        let kept = by_impact.iter().enumerate().filter(|(at, _)| Some(*at) != left_out);
        fit(&kept.flat_map(|(_, readings)| readings.iter().copied()).collect::<Vec<_>>())
    };
    let [drag, friction] = without(None)?;
    let left: Vec<[f64; 2]> = (0..n).filter_map(|at| without(Some(at))).collect();
    let covariance = |i: usize, j: usize| -> f64 {
        let mean = |k: usize| left.iter().map(|one| one[k]).sum::<f64>() / left.len() as f64;
        let (a, b) = (mean(i), mean(j));
        let sum: f64 = left.iter().map(|one| (one[i] - a) * (one[j] - b)).sum();
        sum * (left.len() as f64 - 1.0) / left.len() as f64
    };
    let errors = [covariance(0, 0).sqrt(), covariance(1, 1).sqrt()];
    Some(Separated {
        drag: Estimate::new(drag, errors[0]),
        friction: Estimate::new(friction, errors[1]),
        correlation: covariance(0, 1) / (errors[0] * errors[1]),
        r_squared: explained(cells, component, [drag, friction]),
        impacts: n,
    })
}

/// The forces of a cell at each depth, averaged over its positions.
#[must_use]
pub fn mean_readings(cell: &Cell, component: Component) -> Vec<Reading> {
    let all: Vec<Vec<Option<Reading>>> =
        cell.records.iter().map(|record| readings(record, component)).collect();
    let at_depth = |at: usize| {
        let here: Vec<Reading> = all.iter().filter_map(|readings| readings[at]).collect();
        let n = here.len() as f64;
        let mean = |of: fn(&Reading) -> f64| here.iter().map(of).sum::<f64>() / n;
        (!here.is_empty()).then(|| Reading {
            depth: DEPTHS[at],
            square: mean(|one| one.square),
            force: mean(|one| one.force),
        })
    };
    (0..DEPTHS.len()).filter_map(at_depth).collect()
}

fn fit(readings: &[Reading]) -> Option<[f64; 2]> {
    let column = |of: fn(&Reading) -> f64| readings.iter().map(of).collect::<Vec<f64>>();
    let columns = [column(|one| one.square), column(|one| one.depth)];
    let fitted = regression::linear(&columns, &column(|one| one.force), None)?;
    Some([fitted.coefficients[0], fitted.coefficients[1]])
}

fn explained(cells: &[&Cell], component: Component, [drag, friction]: [f64; 2]) -> f64 {
    let all: Vec<Reading> = cells.iter().flat_map(|cell| mean_readings(cell, component)).collect();
    let mean = all.iter().map(|one| one.force).sum::<f64>() / all.len() as f64;
    let left = |one: &Reading| one.force - drag * one.square - friction * one.depth;
    let left: f64 = all.iter().map(|one| left(one) * left(one)).sum();
    let about: f64 = all.iter().map(|one| (one.force - mean) * (one.force - mean)).sum();
    1.0 - left / about
}

#[cfg(test)]
mod tests {
    use super::super::matrix::READINGS;
    use super::super::records::record;
    use super::super::tables::published;
    use super::*;

    /// An impact straight down under `α v² + f y` from `speed` (m/s), integrated finely.
    fn impact(law: ForceLaw, speed: f64) -> Record {
        let (mut depth, mut velocity, dt) = (0.0, speed, 1e-6);
        let (mut path, mut time) = (vec![0.0], 0.0);
        for step in 1.. {
            let at = |y: f64, v: f64| GRAVITY - (law.drag * v * v + law.friction * y) / MASS;
            let half = velocity + 0.5 * dt * at(depth, velocity);
            depth += dt * half;
            velocity = half + 0.5 * dt * at(depth, half);
            time = f64::from(step) * dt;
            if step % 500 == 0 {
                path.push(depth);
            }
            if velocity <= 0.0 {
                break;
            }
        }
        let stopped = Record {
            deepest: depth,
            stopping_time: Some(time),
            ..record(5e-4, vec![0.0; path.len()], path)
        };
        Record { end: time, ..stopped }
    }

    #[test]
    fn the_published_law_is_found_again_in_its_own_paths() {
        let published = published(90.0).expect("an angle of the tables");
        let law = published.vertical.expect("a law at 90 deg");
        let cell = |speed: f64| Cell {
            reading: &READINGS[0],
            published,
            speed,
            records: vec![impact(law, speed)],
        };
        let cells: Vec<Cell> = [1.0, 2.0, 3.0, 4.0].map(cell).into();
        let found = separate(&cells.iter().collect::<Vec<_>>(), Component::Vertical);
        let found = found.expect("four speeds decide");
        // Velocities and forces are means over 1 mm of a force that bends: a hundredth.
        assert!((found.drag.value / law.drag - 1.0).abs() < 0.01, "{found:?}");
        assert!((found.friction.value / law.friction - 1.0).abs() < 0.01, "{found:?}");
        assert!(found.r_squared > 0.999, "{found:?}");
    }

    #[test]
    fn depths_below_the_stop_have_no_reading() {
        // From rest twice the weight over the friction, 70 mm, and a little more.
        let record = impact(ForceLaw { drag: 0.3, friction: 9.0 }, 0.2);
        let n = readings(&record, Component::Vertical).iter().flatten().count();
        let passed = DEPTHS.iter().filter(|depth| **depth + WINDOW < record.deepest).count();
        assert!(n >= passed && n < DEPTHS.len(), "{n} of {passed} at {}", record.deepest);
    }
}
