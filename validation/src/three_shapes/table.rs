//! The study as text.

use std::fmt::Write as _;

use super::{Case, FRICTIONS, Outcome, RUBBED, SHAPES, SPEEDS, group, mean_and_error};

/// Depth at each speed and shape, whether the order holds, and what friction changes.
pub fn table(results: &[(Case, Outcome)]) -> String {
    let mut text = String::from(
        "Depth (mm): mean over the seeds, its standard error, and the single beds.\n\n\
         | speed (m/s) | cylinder | hemisphere | cone | order on every bed |\n|---|---|---|---|---|\n",
    );
    for speed in SPEEDS {
        let depths = SHAPES.map(|model| {
            let outcomes = group(results, model, speed, None);
            outcomes.iter().map(|outcome| 1e3 * outcome.depth_m).collect::<Vec<f64>>()
        });
        let _ = write!(text, "| {speed} |");
        for depths in &depths {
            let (mean, error) = mean_and_error(depths);
            let each: Vec<String> = depths.iter().map(|depth| format!("{depth:.1}")).collect();
            let _ = write!(text, " {mean:.1} ± {error:.1} ({}) |", each.join(", "));
        }
        let [cylinder, hemisphere, cone] = &depths;
        let holds = cylinder.iter().zip(hemisphere).zip(cone).all(|((a, b), c)| a < b && b < c);
        let _ = writeln!(text, " {} |", if holds { "yes" } else { "no" });
    }
    let _ = writeln!(text, "\nLargest closure: {:.1e}.", largest(results, |one| one.closure));
    for (low, high) in largest_difference(results) {
        let _ = writeln!(
            text,
            "Friction {} to {}: largest difference of speed {low:.3} m/s, {high:.1} % of the impact's.",
            FRICTIONS[0], FRICTIONS[1]
        );
    }
    text
}

fn largest(results: &[(Case, Outcome)], of: fn(&Outcome) -> f64) -> f64 {
    results.iter().map(|(_, outcome)| of(outcome)).fold(0.0, f64::max)
}

/// Per bed: the largest difference of speed (m/s) between the two frictions, and in percent of that of
/// the impact.
fn largest_difference(results: &[(Case, Outcome)]) -> Vec<(f64, f64)> {
    let (model, speed) = RUBBED;
    let [without, with] = FRICTIONS.map(|friction| group(results, model, speed, Some(friction)));
    without
        .into_iter()
        .zip(with)
        .map(|(a, b)| {
            let pairs = a.down_m_per_s.iter().zip(&b.down_m_per_s);
            let most = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            (most, 100.0 * most / speed)
        })
        .collect()
}
