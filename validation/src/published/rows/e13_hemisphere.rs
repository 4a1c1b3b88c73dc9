//! E13: the course of the hemisphere's impact.

use crate::published::check::{Band, Check, Estimate, SIGMAS};
use crate::published::laboratory::Laboratory;
use crate::published::regression;
use crate::published::row::{Findings, PublishedError, Row, Table};
use crate::published::shapes::{self, Impact};
use crate::three_shapes::{Outcome, mean_and_error};

pub(super) static ROW: Row = Row {
    id: "E13",
    title: "Hemisphere: falling force peaks, transfer of energy to the grains and its maximum",
    source: "three-shape manuscript, Figs 3–5, 8, 9, 12, 14, 15",
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
    findings.checks.extend(peaks(&impacts, &mut findings.tables));
    findings.checks.extend(first.iter().map(|(case, one)| main_carrier(case.speed, one)));
    findings.checks.extend(over_energy(&impacts));
    findings.checks.push(Check::not_published(
        "speed almost zero within 10 ms",
        "Fig. 4",
        "size, mass and bed of the study are lost, and with them its scale of time",
    ));
    findings.checks.push(Check::not_published(
        "depth and contact area over the size of the intruder",
        "Fig. 9",
        "sizes and values of the figure are lost",
    ));
    Ok(findings)
}

/// Whether the force has three peaks, no more and no fewer, in every impact, and whether the first three fall, in the mean
/// over impacts. The study states no tolerance of the number; what counts as a peak is [`STANDS_OUT`].
fn peaks(impacts: &[Impact], tables: &mut Vec<Table>) -> [Check; 3] {
    let mut table = Table::new(
        "Peaks of the force until the stop, over the first: means over 1 ms, each standing out by a tenth.",
        &["speed (m/s)", "bed", "peaks", "second", "third"],
    );
    let mut falls: [Vec<f64>; 2] = [Vec::new(), Vec::new()];
    let (mut counts, mut larger) = (Vec::new(), 0);
    for (case, one) in impacts {
        let found = peaks_of(one);
        counts.push(found.len());
        larger += usize::from(found.get(1).is_some_and(|second| *second > found[0]));
        let over = |at: usize| found.get(at).map(|peak| peak / found[0]);
        if let [Some(second), Some(third)] = [over(1), over(2)] {
            falls[0].push(1.0 - second);
            falls[1].push(second - third);
        }
        let shown = |at| over(at).map_or("–".to_owned(), |ratio| format!("{ratio:.2}"));
        let [speed, bed] = [format!("{}", case.speed), format!("{}", case.seed)];
        table.rows.push(vec![speed, bed, found.len().to_string(), shown(1), shown(2)]);
    }
    tables.push(table);
    let n = impacts.len();
    let exact = counts.iter().filter(|count| **count == 3).count();
    let [least, most] =
        [counts.iter().min(), counts.iter().max()].map(|end| end.copied().unwrap_or(0));
    let three = Check::trend(
        "peaks of the force",
        ("three", format!("three in {exact} of {n} impacts, {least} to {most} in all")),
        "three in every impact, until the stop, each standing out by a tenth",
        exact == n,
    );
    let falling = |what: String, falls: &[f64]| {
        let (mean, error) = mean_and_error(falls);
        let half = regression::student(SIGMAS, falls.len().saturating_sub(1)) * error;
        let reason = "two standard errors (Student's t) of the scatter of impacts";
        Check::positive(what, "falling", Estimate::new(mean, error), Band { half, reason })
    };
    [
        three,
        falling(
            format!(
                "first less second peak, over the first; the second is larger in {larger} of {n}"
            ),
            &falls[0],
        ),
        falling("second less third peak, over the first".to_owned(), &falls[1]),
    ]
}

/// The peaks of the force over the mass until the stop, as changes of the speed (m/s) in 1 ms.
fn peaks_of(one: &Outcome) -> Vec<f64> {
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
    peaks
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

/// What rises with the energy of the impact.
fn over_energy(impacts: &[Impact]) -> Vec<Check> {
    let most = |one: &Outcome| one.energies.grains_j.iter().copied().fold(0.0, f64::max);
    let logs: Vec<f64> = impacts.iter().map(|(_, one)| libm::log(one.impact_energy_j)).collect();
    let rising = |what: &str, of: &dyn Fn(&Outcome) -> f64| {
        let values: Vec<f64> = impacts.iter().map(|(_, one)| libm::log(of(one))).collect();
        let fitted = regression::linear(&[logs.clone(), vec![1.0; logs.len()]], &values, None)?;
        let slope = Estimate::new(fitted.coefficients[0], fitted.error(0));
        let reason = "two standard errors (Student's t) of what the line leaves over";
        let band = Band { half: fitted.as_surely_as(SIGMAS) * slope.error, reason };
        let what = format!("{what}: power of the energy of the impact that it goes with");
        Some(Check::positive(what, "rises with the energy of the impact", slope, band))
    };
    let found = [
        rising("greatest mechanical energy of the grains", &most),
        rising("depth", &shapes::deepest),
    ];
    found.into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::published::Verdict;
    use crate::three_shapes::Energies;

    /// An impact whose force has peaks of these heights (m/s in 1 ms), 3 ms apart.
    fn impact(speed: f64, heights: &[f64]) -> Impact {
        let mut speeds = vec![speed];
        for height in heights {
            for k in 0..30 {
                let push = if (10..20).contains(&k) { height / SMOOTH as f64 } else { 0.0 };
                speeds.push(speeds[speeds.len() - 1] - push);
            }
        }
        let (case, outcome) = shapes::blank(HEMISPHERE, speed);
        let time_s = (0..speeds.len()).map(|k| 1e-4 * k as f64).collect();
        let energies = Energies { grains_j: vec![speed], ..Energies::default() };
        let depth_m = 0.01 * speed;
        (case, Outcome { depth_m, time_s, down_m_per_s: speeds, energies, ..outcome })
    }

    #[test]
    fn peaks_that_fall_pass_and_others_fail() {
        let verdicts = |heights: &[[f64; 3]; 3]| {
            let impacts = heights.each_ref().map(|heights| impact(4.0, heights));
            peaks(&impacts, &mut Vec::new()).map(|check| check.verdict)
        };
        let falling = [[1.0, 0.6, 0.3], [1.0, 0.62, 0.3], [1.0, 0.61, 0.29]];
        assert_eq!(verdicts(&falling), [Verdict::Pass; 3]);
        let rising = falling.map(|[a, b, c]| [c, b, a]);
        assert_eq!(verdicts(&rising), [Verdict::Pass, Verdict::Fail, Verdict::Fail]);
        let mixed = [[1.0, 0.6, 0.9], [1.0, 1.2, 0.4], [1.0, 0.9, 0.5]];
        assert_eq!(verdicts(&mixed)[1], Verdict::Undecided);
    }

    #[test]
    fn three_peaks_are_three_and_a_second_that_is_larger_than_the_first_is_counted() {
        let impacts = [impact(4.0, &[1.0, 0.6, 0.3, 0.2]), impact(4.0, &[0.6, 1.0, 0.3])];
        let [three, second, _] = peaks(&impacts, &mut Vec::new());
        assert_eq!(three.verdict, Verdict::Fail);
        assert_eq!(three.ours.to_string(), "three in 1 of 2 impacts, 3 to 4 in all");
        assert!(second.what.contains("larger in 1 of 2"), "{}", second.what);
    }

    #[test]
    fn depths_that_rise_with_the_energy_pass_and_falling_ones_fail() {
        let rising = [1.0, 2.0, 3.0, 4.0].map(|speed| impact(speed, &[0.1]));
        let falling =
            rising.clone().map(|(case, one)| (case, Outcome { depth_m: 0.1 - one.depth_m, ..one }));
        assert_eq!(over_energy(&rising)[1].verdict, Verdict::Pass);
        assert_eq!(over_energy(&falling)[1].verdict, Verdict::Fail);
    }

    #[test]
    fn grains_that_hold_more_than_the_intruder_before_the_stop_pass_and_later_ones_fail() {
        let verdict = |stop: f64| {
            let (_, outcome) = shapes::blank(HEMISPHERE, 1.0);
            let (intruder_j, grains_j) = (vec![1.0, 0.6, 0.3], vec![0.0, 0.3, 0.5]);
            let energies = Energies { intruder_j, grains_j, ..Energies::default() };
            let (stopping_time_s, time_s) = (Some(stop), vec![0.0, 0.001, 0.002]);
            main_carrier(1.0, &Outcome { stopping_time_s, time_s, energies, ..outcome }).verdict
        };
        assert_eq!([verdict(0.01), verdict(0.001)], [Verdict::Pass, Verdict::Fail]);
    }
}
