//! E13: the course of the hemisphere's impact.

use crate::published::check::Check;
use crate::published::laboratory::Laboratory;
use crate::published::row::{Findings, PublishedError, Row};
use crate::published::shapes::{self, Impact};
use crate::three_shapes::Outcome;

pub(super) static ROW: Row = Row {
    id: "E13",
    title: "Hemisphere: falling force peaks, transfer of energy to the grains and its maximum",
    source: "three-shape study, Figs 3–5, 8, 9, 12, 14, 15",
    how: ["the hemisphere of E6", "the hemisphere of E6"],
    judge,
};

const HEMISPHERE: &str = "hemisphere-3d";

/// Samples that a force is averaged over: 1 ms, a tenth of the time that the study's peaks lie in.
const SMOOTH: usize = 10;

/// A peak stands out from the valley before it by this share of itself.
const STANDS_OUT: f64 = 0.1;

fn judge(laboratory: &Laboratory<'_>) -> Result<Findings, PublishedError> {
    let impacts = shapes::over_speed(laboratory, &[HEMISPHERE])?;
    let first: Vec<&Impact> = impacts.iter().filter(|(case, _)| case.seed == 1).collect();
    let mut findings = Findings::default();
    for (case, one) in &first {
        findings.checks.push(peaks(case.speed, one));
        findings.checks.push(main_carrier(case.speed, one));
    }
    findings.checks.extend(over_energy(&first));
    findings.checks.push(Check::not_checkable(
        "speed almost zero within 10 ms",
        "Fig. 4",
        "size, mass and bed of the study are lost, and with them its scale of time",
    ));
    findings.checks.push(Check::not_checkable(
        "depth and contact area over the size of the intruder",
        "Fig. 9",
        "sizes and values of the figure are lost",
    ));
    Ok(findings)
}

/// The first three peaks of the force, smoothed.
fn peaks(speed: f64, one: &Outcome) -> Check {
    let stop = one.stopping_time_s.unwrap_or(f64::INFINITY);
    let forces: Vec<f64> = one
        .down_m_per_s
        .windows(SMOOTH + 1)
        .zip(&one.time_s)
        .take_while(|(_, time)| **time <= stop)
        .map(|(speeds, _)| speeds[0] - speeds[SMOOTH])
        .collect();
    let (mut peaks, mut valley, mut top) = (Vec::new(), 0.0_f64, f64::NEG_INFINITY);
    for force in forces {
        if top.is_finite() && force < (1.0 - STANDS_OUT) * top {
            peaks.push(top);
            (valley, top) = (force, f64::NEG_INFINITY);
        } else if force > (1.0 + STANDS_OUT) * valley.max(0.0) || top.is_finite() {
            top = top.max(force);
        }
        valley = valley.min(force);
    }
    let falls = peaks.windows(2).take(2).all(|pair| pair[1] < pair[0]);
    let shown: Vec<String> =
        peaks.iter().take(4).map(|peak| format!("{:.2}", peak / peaks[0])).collect();
    Check::trend(
        format!("{speed} m/s: peaks of the force over the first"),
        ("three, falling", format!("{} peaks: {}", peaks.len(), shown.join(", "))),
        "three or more until the stop, of which the first three fall; over 1 ms, standing out by a tenth",
        peaks.len() >= 3 && falls,
    )
}

/// When the grains hold more mechanical energy than the intruder.
fn main_carrier(speed: f64, one: &Outcome) -> Check {
    let parts = one.energies.intruder_j.iter().zip(&one.energies.grains_j);
    let turn = parts.zip(&one.time_s).find(|((intruder, grains), _)| grains > intruder);
    let ours = turn.map_or("never".to_owned(), |(_, time)| format!("after {:.1} ms", 1e3 * time));
    let before = turn.is_some_and(|(_, time)| one.stopping_time_s.is_none_or(|stop| *time <= stop));
    Check::trend(
        format!("{speed} m/s: grains become the main carrier of energy"),
        ("during the impact", ours),
        "their mechanical energy passes the intruder's before the stop",
        before,
    )
}

/// What rises from energy to energy.
fn over_energy(impacts: &[&Impact]) -> [Check; 2] {
    let most = |one: &Outcome| one.energies.grains_j.iter().copied().fold(0.0, f64::max);
    let rising = |what: &str, of: &dyn Fn(&Outcome) -> f64| {
        let values: Vec<f64> = impacts.iter().map(|(_, one)| of(one)).collect();
        let shown: Vec<String> = values.iter().map(|value| format!("{:.2}", 1e3 * value)).collect();
        Check::trend(
            what,
            ("rises with the energy of the impact", shown.join("; ")),
            "every step from speed to speed",
            values.windows(2).all(|pair| pair[0] < pair[1]),
        )
    };
    [
        rising("greatest mechanical energy of the grains (mJ)", &most),
        rising("depth (mm)", &|one| one.depth_m),
    ]
}
