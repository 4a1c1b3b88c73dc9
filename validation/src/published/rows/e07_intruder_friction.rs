//! E7: the hemisphere without and with friction against the grains.

use crate::published::check::{Band, Check, Estimate};
use crate::published::laboratory::Laboratory;
use crate::published::plot::{Panel, Plot, Points};
use crate::published::row::{Findings, PublishedError, Row};
use crate::published::shapes;
use crate::three_shapes::{FRICTIONS, RUBBED};

pub(super) static ROW: Row = Row {
    id: "E7",
    title: "Friction of hemisphere and grains does not change the hemisphere's velocity",
    source: "three-shape manuscript, Fig. 6",
    how: [
        "friction 0 and 0.8 on one bed of 3 000 spheres",
        "friction 0 and 0.8 on three beds of 8 000 spheres",
    ],
    judge,
};

/// Largest difference of speed that does not show in a figure (% of the impact speed).
const BAND: Band = Band { half: 2.0, reason: "the width of a line in a figure" };

fn judge(laboratory: &Laboratory<'_>) -> Result<Findings, PublishedError> {
    let pairs = shapes::rubbed(laboratory)?;
    let mut findings = Findings::default();
    let mut panels = Vec::new();
    for [(case, without), (_, with)] in &pairs {
        findings.checks.push(difference(case.seed, &without.down_m_per_s, &with.down_m_per_s));
        let path = |one: &crate::three_shapes::Outcome| {
            let samples = one.time_s.iter().zip(&one.down_m_per_s).step_by(10);
            samples.map(|(t, v)| (1e3 * t, *v)).collect::<Vec<_>>()
        };
        let points = path(without).into_iter().map(|(t, v)| (t, v, 0.0)).collect();
        panels.push(Panel {
            title: format!("bed {}", case.seed),
            points: vec![Points { series: 0, places: points }],
            curves: vec![(1, path(with))],
        });
    }
    let names = FRICTIONS.map(|friction| format!("friction {friction}")).to_vec();
    let plot = Plot { axes: ["time (ms)", "speed (m/s)"], names, panels };
    findings.show(
        "e7-friction.svg",
        "Downward speed of the hemisphere at 2 m/s over time.",
        plot.draw()?,
    );
    Ok(findings)
}

/// How far the speeds (m/s) of an impact on the bed `seed` drift apart without and with friction.
fn difference(seed: u64, without: &[f64], with: &[f64]) -> Check {
    let off = without.iter().zip(with).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let off = 100.0 * off / RUBBED.1;
    let what = format!("bed {seed}: largest difference of speed (% of the impact speed)");
    Check::at_most(what, "none visible", Estimate::new(off, 0.0), BAND)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::published::Verdict;

    #[test]
    fn speeds_that_agree_pass_and_a_difference_that_a_figure_shows_fails() {
        let verdict = |off: f64| difference(1, &[2.0, 1.0], &[2.0, 1.0 - off]).verdict;
        // 1 % and 5 % of the impact speed of 2 m/s.
        assert_eq!([0.02, 0.1].map(verdict), [Verdict::Pass, Verdict::Fail]);
    }
}
