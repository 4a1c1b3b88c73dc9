//! E6: how deep cylinder, hemisphere and cone go at equal energy, and the logarithm of it.

use crate::published::check::{Check, Estimate};
use crate::published::laboratory::Laboratory;
use crate::published::plot::{Panel, Plot, Points};
use crate::published::regression;
use crate::published::row::{Findings, PublishedError, Row, Table};
use crate::published::shapes::{self, Impact};
use crate::three_shapes::{Case, SHAPES};

pub(super) static ROW: Row = Row {
    id: "E6",
    title: "Cylinder < hemisphere < cone in depth, logarithmic in the energy",
    source: "three-shape study, eqs 17, 22, Fig. 13",
    how: [
        "3 shapes × 3 speeds on one bed of 3 000 spheres, 2.6 diameters across",
        "3 shapes × 8 speeds × 3 beds of 8 000 spheres, 3.6 diameters across",
    ],
    judge,
};

/// Share of the variance of the depths that the logarithm has to explain: as much as a figure shows by eye.
const EXPLAINED: f64 = 0.9;

/// Mass of every shape (kg) and strength of gravity (m/s²).
const MASS: f64 = 0.015;
const GRAVITY: f64 = 9.81;

fn judge(laboratory: &Laboratory<'_>) -> Result<Findings, PublishedError> {
    let impacts = shapes::all_shapes(laboratory)?;
    let mut findings = Findings::default();
    findings.checks.push(order(&impacts));
    let mut panel = Panel::default();
    let mut table = Table::new(
        "Equation 22 fitted to each shape: z = M/(2χ) ln(1 + 2χK/(M(β − Mg))).",
        &["shape", "χ (kg/m)", "β (N)", "correlation", "R²"],
    );
    for (at, shape) in SHAPES.into_iter().enumerate() {
        let own = shapes::of(&impacts, shape);
        let energies: Vec<f64> = own.iter().map(|(_, one)| one.impact_energy_j).collect();
        let depths: Vec<f64> = own.iter().map(|(_, one)| one.depth_m).collect();
        let places = energies.iter().zip(&depths).map(|(k, z)| (1e3 * k, 1e3 * z, 0.0)).collect();
        panel.points.push(Points { series: at, places });
        let fitted = regression::logarithmic(&energies, &depths);
        let r_squared = fitted.as_ref().map_or(f64::NAN, |fitted| fitted.r_squared);
        findings.checks.push(Check::trend(
            format!("{}: depth over the energy of the impact", shapes::name(shape)),
            ("a logarithm (eq. 22)", format!("R² = {r_squared:.3}")),
            "nine tenths of the variance of the depths",
            r_squared > EXPLAINED,
        ));
        let Some(fitted) = fitted else { continue };
        let [scale, energy] = [fitted.coefficients[0], fitted.coefficients[1]];
        let chi = MASS / (2.0 * scale);
        // χ = M/(2a) falls with a; β = Mg + c/a falls with a and rises with c.
        let by = [-energy / (scale * scale), 1.0 / scale];
        let covariance = |i: usize, j: usize| fitted.covariance[(i, j)];
        let beta = by[0] * by[0] * covariance(0, 0)
            + 2.0 * by[0] * by[1] * covariance(0, 1)
            + by[1] * by[1] * covariance(1, 1);
        let chi_beta = -(by[0] * covariance(0, 0) + by[1] * covariance(0, 1));
        let correlation = chi_beta / (fitted.error(0) * beta.max(0.0).sqrt());
        table.rows.push(vec![
            shapes::name(shape).to_owned(),
            Estimate::new(chi, chi * fitted.error(0) / scale).to_string(),
            Estimate::new(MASS * GRAVITY + energy / scale, beta.max(0.0).sqrt()).to_string(),
            format!("{correlation:.2}"),
            format!("{r_squared:.3}"),
        ]);
        let greatest = energies.iter().copied().fold(0.0, f64::max);
        let curve = (0..=60).map(|k| greatest * f64::from(k) / 60.0);
        let curve = curve.map(|k| (1e3 * k, 1e3 * scale * libm::log1p(k / energy)));
        panel.curves.push((at, curve.collect()));
    }
    findings.tables.push(table);
    findings.checks.push(Check::not_checkable(
        "χ and β of each shape",
        "curves in Fig. 13",
        "the figure's numbers and the table of parameters are lost",
    ));
    let names = SHAPES.map(|shape| shapes::name(shape).to_owned()).to_vec();
    let plot =
        Plot { axes: ["energy of the impact (mJ)", "depth (mm)"], names, panels: vec![panel] };
    findings.show(
        "e6-shapes.svg",
        "Depth over the energy of the impact, and equation 22.",
        plot.draw()?,
    );
    Ok(findings)
}

/// Whether the order holds on every bed at every energy.
fn order(impacts: &[Impact]) -> Check {
    let depth = |shape: &str, case: &Case| {
        let same = |(other, _): &&Impact| {
            other.model == shape
                && other.seed == case.seed
                && (other.speed - case.speed).abs() < 1e-9
        };
        impacts.iter().find(same).map(|(_, one)| one.depth_m)
    };
    let held: Vec<bool> = shapes::of(impacts, SHAPES[0])
        .iter()
        .filter_map(|(case, _)| {
            let [cylinder, hemisphere, cone] = SHAPES.map(|shape| depth(shape, case));
            Some(cylinder? < hemisphere? && hemisphere? < cone?)
        })
        .collect();
    let n = held.iter().filter(|held| **held).count();
    Check::trend(
        "depth at equal energy",
        ("cylinder < hemisphere < cone", format!("{n} of {} beds and energies", held.len())),
        "on every bed at every energy",
        n == held.len() && n > 0,
    )
}
