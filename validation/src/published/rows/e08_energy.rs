//! E8: the energy of an impact in three parts, and how long and how widely a bed dissipates it.

use crate::published::check::{Band, Check, Estimate, SIGMAS};
use crate::published::laboratory::Laboratory;
use crate::published::plot::{Panel, Plot, Points};
use crate::published::regression;
use crate::published::row::{Findings, PublishedError, Row, Table};
use crate::published::shapes::{self, Impact};
use crate::three_shapes::Outcome;

pub(super) static ROW: Row = Row {
    id: "E8",
    title: "Energy in three parts with a constant sum; T γ = ζ ln E + c",
    source: "three-shape manuscript, eqs 23–24, Figs 14–15",
    how: ["the hemisphere of E6", "the hemisphere of E6"],
    judge,
};

/// Largest energy unaccounted for, as a share of that of the impact.
const CLOSURE: Band =
    Band { half: 1e-3, reason: "what the ledger of every shipped model keeps to at its step" };

/// What is left at the end, as a share of the energy of the impact.
const AT_REST: Band = Band {
    half: 2.5e-3,
    reason: "rest is 5 % of the impact speed, which squared is what may be left",
};

/// Kinetic energy at which a bed is calm, over the greatest of all impacts.
const CALM_SHARE: f64 = 0.01;

const HEMISPHERE: &str = "hemisphere-3d";

/// Mass (kg) and strength of gravity (m/s²).
const MASS: f64 = 0.015;
const GRAVITY: f64 = 9.81;

fn judge(laboratory: &Laboratory<'_>) -> Result<Findings, PublishedError> {
    let impacts = shapes::over_speed(laboratory, &[HEMISPHERE])?;
    let mut findings = Findings::default();
    findings.checks.extend(sum(&impacts));
    findings.checks.extend(dissipation(&impacts, &mut findings.tables));
    let names = ["intruder, mechanical", "grains, mechanical", "dissipated", "sum of the three"]
        .map(str::to_owned);
    let panels = impacts.iter().filter(|(case, _)| case.seed == 1).map(panel).collect();
    let plot = Plot { axes: ["time (ms)", "energy (mJ)"], names: names.to_vec(), panels };
    findings.show(
        "e8-energy.svg",
        "The energy of impacts of the hemisphere in three parts over time. The intruder ends below its start.",
        plot.draw()?,
    );
    findings.notes.push(
        "The grains' part counts their kinetic, potential and elastic energy, without which the sum is not \
         constant. Under the law of these beds (Hertz–Mindlin with a restitution) the normal force may not pull."
            .to_owned(),
    );
    Ok(findings)
}

fn sum(impacts: &[Impact]) -> [Check; 2] {
    let closure = impacts.iter().map(|(_, one)| one.closure).fold(0.0, f64::max);
    let left = impacts.iter().map(|(_, one)| {
        let end = one.energies.intruder_j.last().copied().unwrap_or(f64::NAN);
        (end + MASS * GRAVITY * one.fall_m).abs() / one.impact_energy_j
    });
    let left = left.fold(0.0, f64::max);
    [
        Check::at_most(
            "sum of the three parts: largest change over the energy of the impact (–)",
            "constant",
            Estimate::new(closure, 0.0),
            CLOSURE,
        ),
        Check::at_most(
            "mechanical energy of the intruder at the end, less −M g z, over that of the impact (–)",
            "0",
            Estimate::new(left, 0.0),
            AT_REST,
        ),
    ]
}

/// Kinetic energy of the grains (J) below which a bed counts as calm after any of `impacts`: the study shows the energies of
/// all in one figure, where a hundredth of the greatest is nothing. A share of the own greatest would make T shorter
/// the harder the impact, since what is left would be held against more.
fn calm_below(impacts: &[Impact]) -> f64 {
    let energies = impacts.iter().flat_map(|(_, one)| &one.energies.moving_j);
    CALM_SHARE * energies.copied().fold(0.0, f64::max)
}

/// From when on (s) the kinetic energy of the grains stays below `calm` (J); none if it is not there at the end.
fn dissipation_time(one: &Outcome, calm: f64) -> Option<f64> {
    let last = one.energies.moving_j.iter().rposition(|energy| *energy > calm);
    let next = last.map_or(0, |last| last + 1);
    one.time_s.get(next).copied()
}

/// What equation 24 needs of an impact.
#[derive(Clone, Copy)]
struct Dissipated {
    /// Greatest mechanical energy of the grains (J).
    energy: f64,
    /// Largest share of the grains that move at one time.
    share: f64,
    /// Time (s) until the bed is calm; none where it is not at the end.
    time: Option<f64>,
}

/// What rises with the energy, and equation 24.
fn dissipation(impacts: &[Impact], tables: &mut Vec<Table>) -> Vec<Check> {
    let calm = calm_below(impacts);
    let caption = format!(
        "Hemisphere: greatest mechanical energy E of the grains, largest share γ of the grains that move at one time, time T \
         until the kinetic energy of the grains stays below {:.0} µJ, a hundredth of the greatest of all impacts.",
        1e6 * calm
    );
    let head = ["speed (m/s)", "bed", "impact (mJ)", "E (mJ)", "γ", "T (ms)", "T γ (ms)"];
    let mut table = Table::new(&caption, &head);
    let mut all = Vec::new();
    for (case, one) in impacts {
        let energy = one.energies.grains_j.iter().copied().fold(0.0, f64::max);
        let here =
            Dissipated { energy, share: one.moving_share, time: dissipation_time(one, calm) };
        let shown =
            |time: Option<f64>| time.map_or("–".to_owned(), |time| format!("{:.1}", 1e3 * time));
        table.rows.push(vec![
            format!("{}", case.speed),
            format!("{}", case.seed),
            format!("{:.2}", 1e3 * one.impact_energy_j),
            format!("{:.2}", 1e3 * energy),
            format!("{:.3}", here.share),
            shown(here.time),
            shown(here.time.map(|time| time * here.share)),
        ]);
        all.push(here);
    }
    tables.push(table);
    equation_24(&all)
}

/// Equation 24, and what rises with the energy of `all` impacts.
fn equation_24(all: &[Dissipated]) -> Vec<Check> {
    let calm = all.iter().filter(|one| one.time.is_some()).count();
    let title = |what: &str| match all.len() - calm {
        0 => format!("{what} over ln E"),
        left_out => format!(
            "{what} over ln E, {calm} of {} impacts ({left_out} not calm at their end)",
            all.len()
        ),
    };
    let product = points(all, |one| Some(one.time? * one.share));
    vec![
        straight(&title("T γ (s)"), "T γ = ζ ln E + c", &product),
        rising(&title("T γ (s)"), "rises with the energy", &product),
        rising("γ over ln E", "rises with the energy", &points(all, |one| Some(one.share))),
        rising(&title("T (s)"), "rises with the energy", &points(all, |one| one.time)),
        Check::not_published(
            "ζ and c",
            "Fig. 15",
            "the figure's numbers and the table of parameters are lost",
        ),
    ]
}

/// The logarithm of the energy of each impact and a number of it, of those that have it.
fn points(all: &[Dissipated], of: fn(&Dissipated) -> Option<f64>) -> [Vec<f64>; 2] {
    let there = all.iter().filter_map(|one| Some((libm::log(one.energy), of(one)?)));
    let (logs, values): (Vec<f64>, Vec<f64>) = there.unzip();
    [logs, values]
}

/// Whether `values` lie on a straight line over `logs`: a square term does not improve it. What contradicts a line as
/// surely as can be is a curve that turns within the range.
fn straight(what: &str, published: &str, [logs, values]: &[Vec<f64>; 2]) -> Check {
    let n = logs.len() as f64;
    let middle = logs.iter().sum::<f64>() / n;
    let linear: Vec<f64> = logs.iter().map(|log| log - middle).collect();
    let square = linear.iter().map(|log| log * log).collect();
    let reach = linear.iter().copied().map(f64::abs).fold(0.0, f64::max);
    let fitted = regression::linear(&[square, linear, vec![1.0; logs.len()]], values, None);
    let Some(fitted) = fitted.filter(|fitted| fitted.freedom > Some(0)) else {
        return Check::undecided(what, published, "fewer than four beds came to be calm");
    };
    let curvature = Estimate::new(fitted.coefficients[0], fitted.error(0));
    let turning = fitted.coefficients[1] / (2.0 * reach);
    let reason = "two standard errors (Student's t) of what the curve leaves over";
    let band = Band { half: fitted.as_surely_as(SIGMAS) * curvature.error, reason };
    let sigmas = curvature.value / curvature.error;
    let what = format!("{what}: curvature, {sigmas:+.1} standard errors from zero");
    Check::zero(what, published, curvature, band, turning)
}

/// Whether `values` rise with `logs`, the logarithm of the energy.
fn rising(what: &str, published: &str, [logs, values]: &[Vec<f64>; 2]) -> Check {
    let columns = [logs.clone(), vec![1.0; logs.len()]];
    let Some(fitted) = regression::linear(&columns, values, None) else {
        return Check::undecided(what, published, "fewer than two beds came to be calm");
    };
    let slope = Estimate::new(fitted.coefficients[0], fitted.error(0));
    let reason = "two standard errors (Student's t) of what the line leaves over";
    let band = Band { half: fitted.as_surely_as(SIGMAS) * slope.error, reason };
    let what = format!("{what}: slope, of a line that explains {:.3}", fitted.r_squared);
    Check::positive(what, published, slope, band)
}

fn panel((case, one): &Impact) -> Panel {
    let [intruder, grains, dissipated] =
        [&one.energies.intruder_j, &one.energies.grains_j, &one.energies.dissipated_j];
    let sum = intruder.iter().zip(grains).zip(dissipated).map(|((a, b), c)| a + b + c).collect();
    let parts = [intruder, grains, dissipated, &sum];
    let curve = |part: &Vec<f64>| {
        let samples = one.time_s.iter().zip(part).step_by(5);
        samples.map(|(t, e)| (1e3 * t, 1e3 * e)).collect::<Vec<_>>()
    };
    let curves = parts.iter().map(|part| curve(part)).enumerate().collect();
    // The ends say their values.
    let end = |part: &Vec<f64>| (1e3 * one.time_s[part.len() - 1], 1e3 * part[part.len() - 1], 0.0);
    let points = parts
        .iter()
        .enumerate()
        .map(|(series, part)| Points { series, places: vec![end(part)] })
        .collect();
    Panel { title: format!("{} m/s", case.speed), points, curves }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::published::Verdict;
    use crate::three_shapes::Energies;

    /// An impact whose grains lose a tenth of their kinetic energy every millisecond from `most` (J) on.
    fn impact(most: f64) -> Impact {
        let (case, outcome) = shapes::blank(HEMISPHERE, 1.0);
        let moving_j: Vec<f64> = (0..200).map(|k| most * (0.9_f64).powi(k)).collect();
        let time_s = (0..200).map(|k| 1e-3 * f64::from(k)).collect();
        let energies = Energies { moving_j, ..Energies::default() };
        (case, Outcome { time_s, energies, ..outcome })
    }

    #[test]
    fn a_sum_that_is_constant_and_ends_at_the_weight_times_the_depth_passes_and_another_fails() {
        let verdicts = |closure: f64, end: f64| {
            let (case, outcome) = shapes::blank(HEMISPHERE, 1.0);
            let energies = Energies { intruder_j: vec![1.0, end], ..Energies::default() };
            let one = Outcome { closure, energies, fall_m: 0.01, ..outcome };
            sum(&[(case, one)]).map(|check| check.verdict)
        };
        assert_eq!(verdicts(1e-4, -MASS * GRAVITY * 0.01), [Verdict::Pass; 2]);
        assert_eq!(verdicts(1e-2, 0.1), [Verdict::Fail; 2]);
    }

    #[test]
    fn a_bed_is_calm_below_what_all_impacts_share_and_that_takes_the_longer_the_harder() {
        let impacts = [0.01, 0.1, 1.0].map(impact);
        let calm = calm_below(&impacts);
        assert!((calm - 0.01).abs() < 1e-15, "a hundredth of one, to rounding");
        let times = impacts.each_ref().map(|(_, one)| dissipation_time(one, calm));
        // ln 100 / −ln 0.9 = 43.7 ms for the hardest; the slowest is no higher to begin with.
        assert_eq!(times, [Some(0.0), Some(0.022), Some(0.044)]);
        assert_eq!(dissipation_time(&impact(1.0).1, 1e-12), None);
    }

    /// Impacts of four energies on `beds` beds, which differ by 2 %, with a product of time and share as told of ln E;
    /// every share is a half.
    fn impacts_of(beds: usize, product: impl Fn(f64) -> f64) -> Vec<Dissipated> {
        let one = |bed: usize, energy: f64| {
            let scatter = 0.98 + 0.02 * (bed % 3) as f64;
            let time = Some(2.0 * scatter * product(libm::log(energy)));
            Dissipated { energy, share: 0.5, time }
        };
        (0..beds).flat_map(|bed| [1.0, 2.0, 4.0, 8.0].map(|energy| one(bed, energy))).collect()
    }

    #[test]
    fn what_rises_passes_and_what_falls_fails() {
        let verdict = |sign: f64| {
            let all = impacts_of(3, |log| 0.1 + 0.05 * sign * log);
            rising("", "", &points(&all, |one| one.time)).verdict
        };
        assert_eq!([1.0, -1.0].map(verdict), [Verdict::Pass, Verdict::Fail]);
    }

    #[test]
    fn a_product_on_a_line_over_the_logarithm_passes_and_a_power_of_the_energy_fails() {
        let verdict = |all: &[Dissipated]| equation_24(all)[0].verdict;
        assert_eq!(verdict(&impacts_of(3, |log| 0.1 + 0.05 * log)), Verdict::Pass);
        let power = impacts_of(3, |log| 0.1 * libm::exp(log));
        assert_eq!(verdict(&power), Verdict::Fail);
        // It rises all the same, which is not what equation 24 says.
        assert_eq!(equation_24(&power)[1].verdict, Verdict::Pass);
        assert_eq!(verdict(&impacts_of(1, |log| 0.1 + 0.05 * log)[..3]), Verdict::Undecided);
    }

    #[test]
    fn an_impact_after_which_the_bed_is_not_calm_is_counted_and_used_where_its_time_is_not_needed()
    {
        let mut all = impacts_of(3, |log| 0.1 + 0.05 * log);
        for (at, one) in all.iter_mut().enumerate() {
            one.share = 0.1 + 0.1 * libm::log(one.energy) + 0.01 * (at % 2) as f64;
        }
        let checks = equation_24(&all);
        all[3].time = None;
        let without = equation_24(&all);
        assert!(without[0].what.contains("11 of 12 impacts (1 not calm"), "{}", without[0].what);
        assert_ne!(checks[0].ours, without[0].ours);
        assert_eq!(checks[2], without[2], "γ needs no time");
    }
}
