//! Forces on a body that is pushed at a stated speed: its motion is known, and nothing is integrated.

use resistive::{Impact, ResistanceLaw};

use crate::forward::Scatter;

/// How often the depth behind a reading is corrected by what it would be read as: errors of a scale are small.
const CORRECTIONS: usize = 8;

/// Forces (N) of the medium against the motion of `impact` where depths are read as `depths` (m).
pub(super) fn forces(
    impact: &Impact,
    depths: &[f64],
    scatter: &Scatter,
) -> Result<Vec<f64>, String> {
    let force = |&read: &f64| {
        let depth = behind(read, |depth| reading(impact.laws(), depth, scatter));
        impact.resistance_at(depth).map_err(|error| error.to_string())
    };
    depths.iter().map(force).collect()
}

/// What a depth (m) is read as.
fn reading(laws: &[Box<dyn ResistanceLaw>], depth: f64, scatter: &Scatter) -> f64 {
    let (mut depth, mut range) = (depth + scatter.level, 0.0);
    laws.iter().for_each(|law| law.read(&mut depth, &mut range));
    depth * (1.0 + scatter.scale)
}

/// The depth (m) that is read as `read`.
fn behind(read: f64, reading: impl Fn(f64) -> f64) -> f64 {
    (0..CORRECTIONS).fold(read, |depth, _| depth + read - reading(depth))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_depth_behind_a_reading_is_read_as_it() {
        let scatter = Scatter { level: 4e-3, scale: 0.02, ..Scatter::default() };
        let depth = behind(0.05, |depth| reading(&[], depth, &scatter));
        // What is left of 6 mm after eight times two per cent is nothing.
        assert!((depth - (0.05 / 1.02 - 4e-3)).abs() < 1e-15, "{depth}");
    }
}
