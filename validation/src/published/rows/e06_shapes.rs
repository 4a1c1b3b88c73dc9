//! E6: how deep cylinder, hemisphere and cone go at equal energy, and the logarithm of it.

use std::collections::BTreeMap;

use crate::published::check::{Band, Check, Estimate, SIGMAS};
use crate::published::laboratory::Laboratory;
use crate::published::plot::{Panel, Plot, Points};
use crate::published::regression::{self, Fitted};
use crate::published::row::{Findings, PublishedError, Row, Table};
use crate::published::shapes::{self, Impact};
use crate::three_shapes::{Case, SHAPES, mean_and_error};

pub(super) static ROW: Row = Row {
    id: "E6",
    title: "Cylinder < hemisphere and hemisphere < cone in depth, logarithmic in the energy",
    source: "three-shape manuscript, eqs 17, 22, Fig. 13",
    how: [
        "3 shapes × 5 speeds on one bed of 3 000 spheres, 2.6 diameters across",
        "3 shapes × 8 speeds × 3 beds of 8 000 spheres, 3.6 diameters across",
    ],
    judge,
};

/// What depths of one shape scatter by from bed to bed, as a share, in the order of the shapes: the root mean square over
/// eight speeds on three beds each, by the full run of this row (`validation/results/published.csv`). For impacts on one bed, which do
/// not tell.
const SCATTER: [f64; 3] = [0.100, 0.070, 0.059];

/// Mass of every shape (kg) and strength of gravity (m/s²).
const MASS: f64 = 0.015;
const GRAVITY: f64 = 9.81;

fn judge(laboratory: &Laboratory<'_>) -> Result<Findings, PublishedError> {
    let impacts = shapes::all_shapes(laboratory)?;
    let mut findings = Findings::default();
    findings.checks.extend(order(&impacts));
    let mut panel = Panel::default();
    let mut table = Table::new(
        "Equation 22 fitted to each shape: z = M/(2χ) ln(1 + 2χK/(M(β − Mg))).",
        &["shape", "χ (kg/m)", "β (N)", "correlation", "R²"],
    );
    for (at, shape) in SHAPES.into_iter().enumerate() {
        let own = shapes::of(&impacts, shape);
        let energies: Vec<f64> = own.iter().map(|(_, one)| one.impact_energy_j).collect();
        let depths: Vec<f64> = own.iter().map(|(_, one)| shapes::deepest(one)).collect();
        let places = energies.iter().zip(&depths).map(|(k, z)| (1e3 * k, 1e3 * z, 0.0)).collect();
        panel.points.push(Points { series: at, places });
        let fitted = regression::logarithmic(&energies, &depths);
        findings.checks.extend(over_energy(shapes::name(shape), &energies, &depths));
        let scatter = from_bed_to_bed(&own).unwrap_or(SCATTER[at]);
        findings.checks.push(logarithm(shapes::name(shape), fitted.as_ref(), &depths, scatter));
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
            format!("{:.3}", fitted.r_squared),
        ]);
        let greatest = energies.iter().copied().fold(0.0, f64::max);
        let curve = (0..=60).map(|k| greatest * f64::from(k) / 60.0);
        let curve = curve.map(|k| (1e3 * k, 1e3 * scale * libm::log1p(k / energy)));
        panel.curves.push((at, curve.collect()));
    }
    findings.tables.push(table);
    findings.checks.push(Check::not_published(
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

/// Whether the depths rise with the logarithm of the energy.
fn over_energy(shape: &str, energies: &[f64], depths: &[f64]) -> Option<Check> {
    let logs = energies.iter().map(|energy| libm::log(*energy)).collect();
    let in_mm: Vec<f64> = depths.iter().map(|depth| 1e3 * depth).collect();
    let fitted = regression::linear(&[logs, vec![1.0; depths.len()]], &in_mm, None)?;
    let slope = Estimate::new(fitted.coefficients[0], fitted.error(0));
    let reason = "two standard errors (Student's t) of what the line leaves over";
    let band = Band { half: fitted.as_surely_as(SIGMAS) * slope.error, reason };
    let what = format!("{shape}: depth (mm) over ln K, the slope");
    Some(Check::positive(what, "rises with the energy", slope, band))
}

/// Whether the depths lie about equation 22 as closely as beds let them, `scatter` being the share that they differ by
/// from bed to bed.
fn logarithm(shape: &str, fitted: Option<&Fitted>, depths: &[f64], scatter: f64) -> Check {
    let what = format!("{shape}: what equation 22 leaves of the depths, over their mean (%)");
    let published = "a logarithm (eq. 22)";
    let Some(fitted) = fitted else {
        return Check::undecided(what, published, "fewer than three energies are there");
    };
    let freedom = fitted.freedom.unwrap_or(0);
    let mean = depths.iter().sum::<f64>() / depths.len() as f64;
    let left = Estimate::new(100.0 * fitted.residual / mean, 0.0);
    // A residual with so much freedom scatters by 1/√(2n) of itself.
    let allowed = 1.0 + SIGMAS / (2.0 * freedom as f64).sqrt();
    let reason = "what beds differ by at the same energy (of one bed, by the full run), and two standard errors of such a residual";
    Check::at_most(what, published, left, Band { half: 100.0 * scatter * allowed, reason })
        .undecided_if(freedom == 0)
}

/// What depths of one shape differ by from bed to bed at the same energy, as a share of their mean: none where every
/// energy is there once.
fn from_bed_to_bed(own: &[&Impact]) -> Option<f64> {
    let mean = |depths: &[f64]| depths.iter().sum::<f64>() / depths.len() as f64;
    let mut at_speed = BTreeMap::<u64, Vec<f64>>::new();
    for (case, one) in own {
        at_speed.entry(case.speed.to_bits()).or_default().push(shapes::deepest(one));
    }
    let freedom: usize = at_speed.values().map(|depths| depths.len() - 1).sum();
    let squares = at_speed.values().map(|depths| {
        let mean = mean(depths);
        depths.iter().map(|depth| (depth - mean) * (depth - mean)).sum::<f64>()
    });
    let all: Vec<f64> = at_speed.values().flatten().copied().collect();
    (freedom > 0).then(|| (squares.sum::<f64>() / freedom as f64).sqrt() / mean(&all))
}

/// Whether each shape goes deeper than the one before it at equal energy: in the mean over energies, bed by bed, or on
/// one bed, energy by energy.
fn order(impacts: &[Impact]) -> [Check; 2] {
    [[0, 1], [1, 2]].map(|pair| {
        let [before, after] = pair.map(|at| SHAPES[at]);
        let depth = |case: &Case| {
            let same = |(other, _): &&Impact| {
                other.model == after
                    && other.seed == case.seed
                    && (other.speed - case.speed).abs() < 1e-9
            };
            impacts.iter().find(same).map(|(_, one)| shapes::deepest(one))
        };
        let mut on_bed = BTreeMap::<u64, Vec<f64>>::new();
        for (case, one) in shapes::of(impacts, before) {
            let deeper = depth(case).map(|depth| 1e3 * (depth - shapes::deepest(one)));
            on_bed.entry(case.seed).or_default().extend(deeper);
        }
        on_bed.retain(|_, deeper| !deeper.is_empty());
        let means = on_bed.values().map(|deeper| mean_and_error(deeper).0).collect();
        let single = on_bed.values().next().filter(|_| on_bed.len() == 1).cloned();
        let values: Vec<f64> = single.unwrap_or(means);
        let (mean, error) = mean_and_error(&values);
        let sigmas = regression::student(SIGMAS, values.len().saturating_sub(1));
        let [before, after] = [before, after].map(shapes::name);
        Check::positive(
            format!("{after} deeper than {before} at equal energy (mm)"),
            "deeper",
            Estimate::new(mean, error),
            Band { half: sigmas * error, reason: "two standard errors (Student's t) from bed to bed; on one bed, from energy to energy" },
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::published::Verdict;

    const ENERGIES: [f64; 5] = [0.002, 0.004, 0.008, 0.015, 0.03];

    fn verdicts(depths: [f64; 5]) -> [Verdict; 2] {
        let fitted = regression::logarithmic(&ENERGIES, &depths);
        let rises = over_energy("cone", &ENERGIES, &depths).expect("a line").verdict;
        [rises, logarithm("cone", fitted.as_ref(), &depths, SCATTER[2]).verdict]
    }

    #[test]
    fn depths_that_are_a_logarithm_pass_and_others_fail() {
        let logarithm = ENERGIES.map(|energy| 2e-3 * libm::log1p(energy / 1e-4));
        assert_eq!(verdicts(logarithm), [Verdict::Pass; 2]);
        let falling = ENERGIES.map(|energy| 0.02 - 2e-3 * libm::log(energy / 1e-3));
        assert_eq!(verdicts(falling), [Verdict::Fail; 2]);
        // A square bends the other way than a logarithm ever does.
        let square = ENERGIES.map(|energy| 5e-3 + 10.0 * energy * energy);
        assert_eq!(verdicts(square)[1], Verdict::Fail);
        let scattered = [0.010, 0.012, 0.009, 0.013, 0.0105];
        assert_eq!(verdicts(scattered), [Verdict::Undecided, Verdict::Fail]);
    }

    /// Impacts at three speeds whose depths (m) grow by a tenth from each to the next, on each of `beds`.
    fn impacts(beds: &[[f64; 3]]) -> Vec<Impact> {
        let mut impacts = Vec::new();
        for (depths, seed) in beds.iter().zip(1..) {
            for (shape, depth) in SHAPES.into_iter().zip(depths) {
                for (speed, times) in [(1.0, 1.0), (2.0, 1.1), (3.0, 1.2)] {
                    let (case, outcome) = shapes::blank(shape, speed);
                    let outcome =
                        crate::three_shapes::Outcome { depth_m: times * depth, ..outcome };
                    impacts.push((Case { seed, ..case }, outcome));
                }
            }
        }
        impacts
    }

    #[test]
    fn shapes_in_the_published_order_pass_and_two_that_changed_places_fail() {
        let verdicts = |beds: &[[f64; 3]]| order(&impacts(beds)).map(|check| check.verdict);
        let (right, wrong) = ([0.007, 0.012, 0.021], [0.012, 0.007, 0.021]);
        assert_eq!(verdicts(&[right]), [Verdict::Pass; 2]);
        assert_eq!(verdicts(&[wrong]), [Verdict::Fail, Verdict::Pass]);
        let alike = [0.008, 0.012, 0.022];
        assert_eq!(verdicts(&[right, right, alike]), [Verdict::Pass; 2]);
        // Beds that do not agree.
        assert_eq!(verdicts(&[right, wrong, alike]), [Verdict::Undecided, Verdict::Pass]);
    }

    #[test]
    fn depths_differ_from_bed_to_bed_by_what_they_do_at_the_same_speed() {
        let own = |beds: &[[f64; 3]]| {
            let impacts = impacts(beds);
            from_bed_to_bed(&shapes::of(&impacts, SHAPES[0]))
        };
        assert_eq!(own(&[[0.01; 3]]), None);
        // Two beds apart by 2 %: 0.02/√2 at every speed, weighted by the depths there.
        let share = own(&[[0.0101; 3], [0.0099; 3]]).expect("two beds");
        let weight = ((1.0 + 1.21 + 1.44) / 3.0_f64).sqrt() / 1.1;
        assert!((share - weight * 0.02 / 2.0_f64.sqrt()).abs() < 1e-12, "{share}");
    }
}
