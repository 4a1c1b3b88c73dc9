//! E15: a plate pushed slowly into spheres.

use std::f64::consts::FRAC_PI_4;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

use configs::{LoadOptions, Model, ModelSource, find_shipped};
use runner::beds::{Job, Record};

use crate::published::check::{Band, Check, Estimate, SIGMAS};
use crate::published::laboratory::Laboratory;
use crate::published::plot::{Panel, Plot, Points};
use crate::published::regression;
use crate::published::row::{Findings, PublishedError, Row};
use crate::three_shapes::mean_and_error;

pub(super) static ROW: Row = Row {
    id: "E15",
    title: "Slow intrusion: stress of a plate linear in depth, whatever its speed and size",
    source: "Li, Zhang & Goldman, Science 339, 1408 (2013), supplement, Table S2; Treers, Cao & Stuart, IEEE Robot. Autom. \
             Lett. 6 (2021), doi 10.1109/LRA.2021.3057052",
    how: [
        "a plate of 40 mm on four beds of 18 000 spheres",
        "plates of 30 and 40 mm at 5 cm/s and 10 cm/s on eight beds of 18 000 spheres",
    ],
    judge,
};

/// Beds, quick and in full.
const BEDS: [u64; 2] = [4, 8];

/// Terms of α_z(β, γ) = A₀₀ + A₁₀ cos 2β + B₁₁ sin(2β + γ) + B₀₁ sin γ + B₋₁₁ sin(−2β + γ) (N/cm³) of Table S2, the
/// generic ones, by name.
const GENERIC: [f64; 5] = [0.206, 0.169, 0.212, 0.358, 0.055];

/// What multiplies them for the glass beads of Treers, Cao & Stuart.
const GLASS_BEADS: f64 = 0.33;

/// From what depth on (m) forces count: two grains, before which single contacts carry the plate.
const FROM: f64 = 0.01;

/// Equal parts of the way behind it that a force is averaged over.
const READINGS: usize = 20;

/// A push.
#[derive(Clone, Copy)]
struct Push {
    seed: u64,
    /// Of the plate (m).
    diameter: f64,
    /// (m/s).
    speed: f64,
}

/// The slope of the square root of the depth from 20 to 30 mm over that from 10 to 20 mm: lines through ten readings each.
const SQUARE_ROOT: f64 = 0.77;

/// What the shipped model has.
const AS_SHIPPED: Push = Push { seed: 1, diameter: 0.04, speed: 0.05 };

/// Where the shipped push ends (m).
const TO: f64 = 0.03;

/// Stress over depth of a push.
struct Line {
    /// (m).
    depth: Vec<f64>,
    /// (N/cm²).
    stress: Vec<f64>,
    closure: f64,
}

fn judge(laboratory: &Laboratory<'_>) -> Result<Findings, PublishedError> {
    let seeds = 1..=laboratory.quick_or_full(BEDS[0], BEDS[1]);
    let of = |change: fn(Push) -> Push| -> Result<Vec<Line>, PublishedError> {
        lines(laboratory, seeds.clone().map(|seed| change(Push { seed, ..AS_SHIPPED })).collect())
    };
    let plain = of(|push| push)?;
    let mut findings = Findings::default();
    findings.checks.extend([linear(&plain), stiffness(&plain)]);
    if laboratory.quick_or_full(false, true) {
        let fast = of(|push| Push { speed: 0.1, ..push })?;
        findings.checks.push(unchanged("at 10 cm/s over that at 5 cm/s", &plain, &fast));
        let small = of(|push| Push { diameter: 0.03, ..push })?;
        findings.checks.push(unchanged("on 30 mm over that on 40 mm", &plain, &small));
    }
    let closure = plain.iter().map(|line| line.closure).fold(0.0, f64::max);
    let band = Band { half: 1e-3, reason: "of the energy given to the bed" };
    findings.checks.push(Check::at_most(
        "largest energy unaccounted for, over what was supplied",
        "energy is conserved",
        Estimate::new(closure, 0.0),
        band,
    ));
    let published = vec![(0.0, 0.0), (1e3 * TO, 1e2 * published() * TO)];
    let plot = Plot {
        axes: ["depth (mm)", "stress (N/cm²)"],
        names: vec!["beds of plunge".to_owned(), "published for glass beads".to_owned()],
        panels: vec![Panel {
            title: "a plate of 40 mm".to_owned(),
            points: vec![Points {
                series: 0,
                places: plain.iter().flat_map(Line::points).collect(),
            }],
            curves: vec![(1, published)],
        }],
    };
    let caption = "Stress on the plate over depth, and the published line for glass beads.";
    findings.show("e15-intrusion.svg", caption, plot.draw()?);
    findings.notes.push(
        "Neither source states friction, packing fraction or tolerance of the glass beads; those of plunge have a friction of \
         0.3."
            .to_owned(),
    );
    Ok(findings)
}

/// Stress over depth (N/cm³) of a horizontal plate that sinks into glass beads: β = 0, γ = π/2.
fn published() -> f64 {
    GLASS_BEADS * GENERIC.iter().sum::<f64>()
}

/// The slope behind the middle of the way over that before it; undecided where the square root of the depth would pass too.
fn linear(lines: &[Line]) -> Check {
    let ratio = |line: &Line| {
        Some(line.slope_of(READINGS / 2..READINGS)? / line.slope_of(0..READINGS / 2)?)
    };
    let ratios: Vec<f64> = lines.iter().filter_map(ratio).collect();
    let ours = over_beds(&ratios);
    let band = of_beds(ours, &ratios);
    let is_wide = (ours.value - 1.0).abs() <= band.half && band.half >= 1.0 - SQUARE_ROOT;
    let what = "slope from 20 to 30 mm over that from 10 to 20 mm";
    Check::number(what, Estimate::new(1.0, 0.0), ours, band).undecided_if(is_wide)
}

/// The slope of the stress over depth.
fn stiffness(lines: &[Line]) -> Check {
    let slopes: Vec<f64> = lines.iter().map(Line::slope).collect();
    let ours = over_beds(&slopes);
    let Band { half, .. } = of_beds(ours, &slopes);
    let reason = "two standard errors (Student's t) of the mean over beds, and half of the last digit of the published factor";
    let band = Band { half: half + 0.005, reason };
    Check::number("stress over depth (N/cm³)", Estimate::new(published(), 0.0), ours, band)
}

/// That the slope of `changed` is the one of `plain`, bed by bed.
fn unchanged(what: &str, plain: &[Line], changed: &[Line]) -> Check {
    let ratios: Vec<f64> =
        plain.iter().zip(changed).map(|(plain, changed)| changed.slope() / plain.slope()).collect();
    let ours = over_beds(&ratios);
    let what = format!("stress over depth {what}");
    Check::number(what, Estimate::new(1.0, 0.0), ours, of_beds(ours, &ratios))
}

fn over_beds(values: &[f64]) -> Estimate {
    let (mean, error) = mean_and_error(values);
    Estimate::new(mean, error)
}

/// Two standard errors of the mean over beds.
fn of_beds(ours: Estimate, values: &[f64]) -> Band {
    let sure = regression::student(SIGMAS, values.len().saturating_sub(1));
    let reason = "two standard errors (Student's t) of the mean over beds";
    Band { half: sure * ours.error, reason }
}

impl Line {
    fn of(record: &Record, push: Push) -> Self {
        let area = FRAC_PI_4 * push.diameter * push.diameter;
        let reading = |at: usize| FROM + (TO - FROM) * (at as f64 + 0.5) / READINGS as f64;
        let depth: Vec<f64> = (0..READINGS).map(reading).collect();
        // The mean over the readings' own distance: a force of grains fluctuates within a grain.
        let half = 0.5 * (TO - FROM) / READINGS as f64;
        let mean = |&z: &f64| {
            let near =
                record.depth.iter().zip(&record.force).filter(|(at, _)| (**at - z).abs() <= half);
            let (sum, n) = near.fold((0.0, 0.0), |(sum, n), (_, force)| (sum + force, n + 1.0));
            1e-4 * sum / n / area
        };
        Self { stress: depth.iter().map(mean).collect(), closure: record.closure, depth }
    }

    /// Depth (mm) and stress (N/cm²) of its readings, without an error.
    fn points(&self) -> Vec<(f64, f64, f64)> {
        self.depth.iter().zip(&self.stress).map(|(z, s)| (1e3 * z, *s, 0.0)).collect()
    }

    /// Slope (N/cm³) of the straight line through `readings`; its intercept is what a plate meets at the surface.
    fn slope_of(&self, readings: Range<usize>) -> Option<f64> {
        let (depth, stress) = (&self.depth[readings.clone()], &self.stress[readings]);
        let columns = [depth.to_vec(), vec![1.0; depth.len()]];
        Some(1e-2 * regression::linear(&columns, stress, None)?.coefficients[0])
    }

    /// That through all of them.
    fn slope(&self) -> f64 {
        self.slope_of(0..READINGS).unwrap_or(f64::NAN)
    }
}

/// The pushes that ended, in their order.
fn lines(laboratory: &Laboratory<'_>, pushes: Vec<Push>) -> Result<Vec<Line>, PublishedError> {
    let jobs = pushes.iter().map(Push::job).collect::<Result<Vec<_>, _>>()?;
    let records = laboratory.impacts(&jobs)?;
    let lines: Option<Vec<Line>> = records
        .iter()
        .zip(&pushes)
        .map(|(record, push)| Some(Line::of(record.as_ref()?, *push)))
        .collect();
    lines.ok_or(PublishedError::NotYet)
}

impl Push {
    fn job(&self) -> Result<Job, PublishedError> {
        let source = find_shipped("plate-3d").map(ModelSource::Shipped);
        let source = source.unwrap_or_else(|| ModelSource::Path(PathBuf::from("plate-3d")));
        let sets = vec![
            format!("intruder.diameter=\"{:?} m\"", self.diameter),
            format!("intrusion.speed=\"{:?} m/s\"", self.speed),
        ];
        let options = LoadOptions { sets, seed: Some(self.seed), ..LoadOptions::default() };
        let model = Arc::new(Model::load(source, &options)?.model);
        Ok(Job { bed: Arc::clone(&model), model, expected: TO / self.speed, settles: false })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::published::Verdict;
    use crate::published::oblique::records::record;

    /// A push of a plate of 40 mm into what resists with `stress` (N/cm²) of the depth (m).
    fn line(stress: impl Fn(f64) -> f64) -> Line {
        let depth: Vec<f64> = (0..=3000).map(|at| f64::from(at) * 1e-5).collect();
        let area = FRAC_PI_4 * 0.04 * 0.04;
        let force = depth.iter().map(|&z| 1e4 * stress(z) * area).collect();
        let path = record(5e-4, vec![0.0; depth.len()], depth);
        Line::of(&Record { force, ..path }, AS_SHIPPED)
    }

    #[test]
    fn a_line_has_its_slope_whatever_it_starts_with() {
        // The sources' slope, one in a hundred off on either side.
        let lines = [0.99, 1.01].map(|more| line(|z| 0.05 + more * 33.0 * z));
        assert!((lines[1].slope() - 0.3333).abs() < 1e-3, "{}", lines[1].slope());
        assert!((published() - 0.33).abs() < 1e-12);
        assert_eq!(stiffness(&lines).verdict, Verdict::Pass);
        let straight =
            [1.0, 1.02, 0.97].map(|more| line(|z| 33.0 * z + 20.0 * more * z * z - 20.0 * z * z));
        assert_eq!(linear(&straight).verdict, Verdict::Pass);
        let scattered = [1.0, 8.0, -6.0].map(|more| line(|z| 33.0 * z + 100.0 * more * z * z));
        assert_eq!(linear(&scattered).verdict, Verdict::Undecided);
    }

    #[test]
    fn curves_and_softer_beds_fail() {
        let root = [1.0, 1.02].map(|more| line(|z| more * z.sqrt()));
        assert_eq!(linear(&root).verdict, Verdict::Fail);
        let ratio = root[0].slope_of(10..20).zip(root[0].slope_of(0..10)).map(|(b, a)| b / a);
        assert!(ratio.is_some_and(|ratio| (ratio - SQUARE_ROOT).abs() < 0.01), "{ratio:?}");
        let soft = [0.2, 0.21].map(|slope| line(|z| 1e2 * slope * z));
        assert_eq!(stiffness(&soft).verdict, Verdict::Fail);
        assert_eq!(unchanged("", &root, &soft).verdict, Verdict::Fail);
    }

    #[test]
    fn the_pushes_are_those_of_the_shipped_model() {
        let job = AS_SHIPPED.job().expect("a model");
        assert_eq!(job.model.impact.pushed_to.map(f64::to_bits), Some(TO.to_bits()));
    }
}
