//! E8: the energy of an impact in three parts, and how long and how widely a bed dissipates it.

use crate::published::check::{Band, Check, Estimate};
use crate::published::laboratory::Laboratory;
use crate::published::plot::{Panel, Plot, Points};
use crate::published::regression;
use crate::published::row::{Findings, PublishedError, Row, Table};
use crate::published::shapes::{self, Impact};

pub(super) static ROW: Row = Row {
    id: "E8",
    title: "Energy in three parts with a constant sum; T γ = ζ ln E + c",
    source: "three-shape study, eqs 23–24, Figs 14–15",
    how: ["the hemisphere of E6", "the hemisphere of E6"],
    judge,
};

/// Largest energy unaccounted for, as a share of that of the impact.
const CLOSURE: Band =
    Band { half: 1e-3, reason: "what the ledger of every shipped model keeps to at its step" };

/// Kinetic energy that is left at the end, as a share of that of the impact: 5 % of the speed, squared.
const AT_REST: Band = Band {
    half: 2.5e-3,
    reason: "rest is 5 % of the impact speed, which squared is what may be left",
};

const HEMISPHERE: &str = "hemisphere-3d";

/// Mass (kg) and strength of gravity (m/s²).
const MASS: f64 = 0.015;
const GRAVITY: f64 = 9.81;

fn judge(laboratory: &Laboratory<'_>) -> Result<Findings, PublishedError> {
    let impacts = shapes::over_speed(laboratory, &[HEMISPHERE])?;
    let mut findings = Findings::default();
    findings.checks.extend(sum(&impacts));
    findings.checks.extend(dissipation(&impacts, &mut findings.tables));
    let names = ["intruder, mechanical", "grains, mechanical", "dissipated"].map(str::to_owned);
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
        let depth = one.path_m.last().copied().unwrap_or(f64::NAN);
        (end + MASS * GRAVITY * depth).abs() / one.impact_energy_j
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

/// What rises with the energy, and equation 24.
fn dissipation(impacts: &[Impact], tables: &mut Vec<Table>) -> Vec<Check> {
    let mut table = Table::new(
        "Hemisphere: greatest mechanical energy E of the grains, share γ of the grains that move, time T until the \
         bed is calm.",
        &["speed (m/s)", "bed", "impact (mJ)", "E (mJ)", "γ", "T (ms)", "T γ (ms)"],
    );
    let mut points = Vec::new();
    for (case, one) in impacts {
        let most = one.energies.grains_j.iter().copied().fold(0.0, f64::max);
        let time = one.dissipation_time_s;
        let shown =
            |time: Option<f64>| time.map_or("–".to_owned(), |time| format!("{:.1}", 1e3 * time));
        table.rows.push(vec![
            format!("{}", case.speed),
            format!("{}", case.seed),
            format!("{:.2}", 1e3 * one.impact_energy_j),
            format!("{:.2}", 1e3 * most),
            format!("{:.3}", one.moving_share),
            shown(time),
            shown(time.map(|time| time * one.moving_share)),
        ]);
        if let Some(time) = time {
            points.push((most, time, one.moving_share));
        }
    }
    tables.push(table);
    let logs: Vec<f64> = points.iter().map(|(energy, ..)| libm::log(*energy)).collect();
    let rising = |what: &str, published: &str, of: fn(&(f64, f64, f64)) -> f64| {
        let values: Vec<f64> = points.iter().map(of).collect();
        let fitted = regression::linear(&[logs.clone(), vec![1.0; logs.len()]], &values, None);
        let Some(fitted) = fitted else {
            return Check::not_checkable(what, published, "fewer than two beds came to be calm");
        };
        let slope = Estimate::new(fitted.coefficients[0], fitted.error(0));
        let reason = "two standard errors (Student's t) of what the line leaves over";
        let band = Band { half: fitted.as_surely_as(2.0) * slope.error, reason };
        let what = format!("{what}: slope, of a line that explains {:.3}", fitted.r_squared);
        Check::positive(what, published, slope, band)
    };
    vec![
        rising("T γ (s) over ln E", "T γ = ζ ln E + c", |(_, time, share)| time * share),
        rising("γ over ln E", "rises with the energy", |(_, _, share)| *share),
        rising("T (s) over ln E", "rises with the energy", |(_, time, _)| *time),
        Check::not_checkable(
            "ζ and c",
            "Fig. 15",
            "the figure's numbers and the table of parameters are lost",
        ),
    ]
}

fn panel((case, one): &Impact) -> Panel {
    let parts = [&one.energies.intruder_j, &one.energies.grains_j, &one.energies.dissipated_j];
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
