//! The force on the intruder at fixed depths, from the path of each impact itself, and the law that it is
//! separated into.
//!
//! A path is sampled every 0.5 ms; by Newton's law its second difference is the mean force around a sample,
//! over about as long as the article's window of ±1 mm takes at 2 m/s.

use runner::beds::Record;

use super::matrix::{Cell, GRAVITY, MASS};
use super::tables::ForceLaw;
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
#[derive(Clone, Debug, PartialEq)]
pub struct Separated {
    /// α (kg/m).
    pub drag: Estimate,
    /// f (N/m).
    pub friction: Estimate,
    /// Correlation of both.
    pub correlation: f64,
    /// Share of the variance of the forces, averaged over positions, that the law explains.
    pub explained: Estimate,
    /// The laws without one of the impacts after another.
    pub left_out: Vec<ForceLaw>,
}

impl Separated {
    /// How many of its standard errors hold a coefficient as surely as so many `sigmas` do where the scatter is
    /// known.
    pub fn as_surely_as(&self, sigmas: f64) -> f64 {
        regression::student(sigmas, self.left_out.len().saturating_sub(1))
    }

    /// The law without its errors.
    pub fn law(&self) -> ForceLaw {
        ForceLaw { drag: self.drag.value, friction: self.friction.value }
    }
}

/// The readings of one impact at the depths that it passes before it stops.
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
pub fn separate(cells: &[&Cell], component: Component) -> Option<Separated> {
    let impacts: Vec<(usize, Vec<Option<Reading>>)> = cells
        .iter()
        .enumerate()
        .flat_map(|(cell, one)| one.records.iter().map(move |record| (cell, record)))
        .map(|(cell, record)| (cell, readings(record, component)))
        .collect();
    // Both coefficients and what they explain.
    let without = |left_out: Option<usize>| -> Option<[f64; 3]> {
        let kept = impacts.iter().enumerate().filter(|(at, _)| Some(*at) != left_out);
        let kept: Vec<_> = kept.map(|(_, impact)| impact).collect();
        let all: Vec<Reading> =
            kept.iter().flat_map(|(_, own)| own.iter().flatten()).copied().collect();
        let law = fit(&all)?;
        let means = (0..cells.len()).flat_map(|cell| {
            let own = kept.iter().filter(|(of, _)| *of == cell).map(|(_, own)| &own[..]);
            means(&own.collect::<Vec<_>>())
        });
        Some([law.drag, law.friction, explained(&means.collect::<Vec<_>>(), law)])
    };
    let whole = without(None)?;
    let left: Vec<[f64; 3]> = (0..impacts.len()).filter_map(|at| without(Some(at))).collect();
    let covariance = |i: usize, j: usize| -> f64 {
        let mean = |k: usize| left.iter().map(|one| one[k]).sum::<f64>() / left.len() as f64;
        let (a, b) = (mean(i), mean(j));
        let sum: f64 = left.iter().map(|one| (one[i] - a) * (one[j] - b)).sum();
        sum * (left.len() as f64 - 1.0) / left.len() as f64
    };
    let [drag, friction, explained] =
        [0, 1, 2].map(|at| Estimate::new(whole[at], covariance(at, at).sqrt()));
    Some(Separated {
        drag,
        friction,
        correlation: covariance(0, 1) / (drag.error * friction.error),
        explained,
        left_out: left.iter().map(|&[drag, friction, _]| ForceLaw { drag, friction }).collect(),
    })
}

/// The forces of a cell at each depth, averaged over its positions.
pub fn mean_readings(cell: &Cell, component: Component) -> Vec<Reading> {
    let all: Vec<Vec<Option<Reading>>> =
        cell.records.iter().map(|record| readings(record, component)).collect();
    means(&all.iter().map(Vec::as_slice).collect::<Vec<_>>())
}

/// The means at each depth that one of `all` impacts at least passes.
fn means(all: &[&[Option<Reading>]]) -> Vec<Reading> {
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

fn fit(readings: &[Reading]) -> Option<ForceLaw> {
    let column = |of: fn(&Reading) -> f64| readings.iter().map(of).collect::<Vec<f64>>();
    let columns = [column(|one| one.square), column(|one| one.depth)];
    let fitted = regression::linear(&columns, &column(|one| one.force), None)?;
    Some(ForceLaw { drag: fitted.coefficients[0], friction: fitted.coefficients[1] })
}

/// Share of the variance of the forces `all` that the law explains.
fn explained(all: &[Reading], ForceLaw { drag, friction }: ForceLaw) -> f64 {
    let mean = all.iter().map(|one| one.force).sum::<f64>() / all.len() as f64;
    let left = |one: &Reading| one.force - drag * one.square - friction * one.depth;
    let left: f64 = all.iter().map(|one| left(one) * left(one)).sum();
    let about: f64 = all.iter().map(|one| (one.force - mean) * (one.force - mean)).sum();
    1.0 - left / about
}

#[cfg(test)]
mod tests {
    use super::super::records::{cells, straight_down};
    use super::super::tables::published;
    use super::*;

    #[test]
    fn the_published_law_is_found_again_in_its_own_paths() {
        let published = published(90.0).expect("an angle of the tables");
        let law = published.vertical.expect("a law at 90 deg");
        let cells = cells(90.0, &[1.0, 2.0, 3.0, 4.0], |speed| {
            straight_down(speed, |y, v| law.drag * v * v + law.friction * y)
        });
        let found = separate(&cells.iter().collect::<Vec<_>>(), Component::Vertical);
        let found = found.expect("four speeds decide");
        // Velocities and forces are means over 1 mm of a force that bends: a hundredth.
        assert!((found.drag.value / law.drag - 1.0).abs() < 0.01, "{found:?}");
        assert!((found.friction.value / law.friction - 1.0).abs() < 0.01, "{found:?}");
        assert!(found.explained.value > 0.999 && found.left_out.len() == 4, "{found:?}");
    }

    #[test]
    fn depths_below_the_stop_have_no_reading() {
        // From rest twice the weight over the friction, 70 mm, and a little more.
        let record = straight_down(0.2, |y, v| 0.3 * v * v + 9.0 * y);
        let n = readings(&record, Component::Vertical).iter().flatten().count();
        let passed = DEPTHS.iter().filter(|depth| **depth + WINDOW < record.deepest).count();
        assert!(n >= passed && n < DEPTHS.len(), "{n} of {passed} at {}", record.deepest);
    }
}
