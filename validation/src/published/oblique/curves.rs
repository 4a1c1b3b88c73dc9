//! Numbers of an impact over its speed, one curve per angle: fitted as the article fits them, and held
//! against its curves and its coefficients.

use super::matrix::{self, Cell, READINGS, Reading};
use super::tables::Published;
use crate::beds::Record;
use crate::published::check::{Band, Check, Estimate, Known};
use crate::published::plot::{Panel, Plot, Points};
use crate::published::regression::{self, Fitted};
use crate::published::row::{Findings, PublishedError, Table};

/// Speeds (m/s) at which the article's fits are taken to have been made, and how many positions each of
/// their points is the mean of.
const SPEEDS: [f64; 8] = [0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0];
const POSITIONS: f64 = 6.0;

/// Standard errors of the difference that a coefficient may be off by.
const SIGMAS: f64 = 2.0;

/// A number of an impact that the article gives over the speed.
pub struct Quantity {
    /// What it is, without a unit.
    pub name: &'static str,
    /// With its unit, for an axis.
    pub axis: &'static str,
    /// Of an impact (SI).
    pub of: fn(&Record) -> Option<f64>,
    /// The published curve of an angle.
    pub published: fn(&Published) -> Option<Curve>,
    /// Mean deviation from the published curve that is agreement, as a share of it, and why.
    pub goal: Band,
    /// Scatter of one impact to another place of the bed, as a share, where the article states it.
    pub stated_scatter: Option<f64>,
    /// What was known of the disagreement beforehand, per reading.
    pub known: [Known; 2],
}

/// The form of a published curve, with names and published values of its coefficients.
pub struct Curve {
    /// Which form.
    pub form: Form,
    /// Names, with their units.
    pub names: &'static [&'static str],
    /// Published (SI).
    pub values: Vec<f64>,
}

/// The form of a curve over the speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Slope and intercept.
    Line,
    /// Amplitude, rate and plateau.
    Exponential,
}

impl Form {
    /// Fits `y` over the speeds `v` (m/s).
    #[must_use]
    pub fn fit(self, v: &[f64], y: &[f64], errors: Option<&[f64]>) -> Option<Fitted> {
        match self {
            Self::Line => regression::linear(&[v.to_vec(), vec![1.0; v.len()]], y, errors),
            Self::Exponential => regression::exponential(v, y, errors),
        }
    }

    /// The value at the speed `v` (m/s).
    #[must_use]
    pub fn at(self, values: &[f64], v: f64) -> f64 {
        match self {
            Self::Line => values[0] * v + values[1],
            Self::Exponential => values[0] * libm::exp(-values[1] * v) + values[2],
        }
    }
}

/// Our points of one reading at one angle.
pub struct Series {
    /// (m/s).
    pub speeds: Vec<f64>,
    /// Means over the positions (SI).
    pub means: Vec<f64>,
    /// Standard errors of these means; none where each is a single impact.
    pub errors: Option<Vec<f64>>,
}

/// Our points of `cells`.
#[must_use]
pub fn series(cells: &[&Cell], of: fn(&Record) -> Option<f64>) -> Series {
    let points: Vec<(f64, Vec<f64>)> = cells
        .iter()
        .map(|cell| (cell.speed, cell.records.iter().filter_map(of).collect::<Vec<f64>>()))
        .filter(|(_, values)| !values.is_empty())
        .collect();
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let means: Vec<f64> = points.iter().map(|(_, values)| mean(values)).collect();
    // Positions scatter by a share that is the same at every speed: pooled, it is known better.
    let squares: f64 = points
        .iter()
        .zip(&means)
        .flat_map(|((_, values), mean)| values.iter().map(move |value| value / mean - 1.0))
        .map(|off| off * off)
        .sum();
    let freedom: usize = points.iter().map(|(_, values)| values.len() - 1).sum();
    let share = (squares / freedom as f64).sqrt();
    let errors = (freedom > 0).then(|| {
        let one = |((_, values), mean): (&(f64, Vec<f64>), &f64)| {
            share * mean.abs() / (values.len() as f64).sqrt()
        };
        points.iter().zip(&means).map(one).collect()
    });
    Series { speeds: points.into_iter().map(|(speed, _)| speed).collect(), means, errors }
}

impl Quantity {
    /// Holds the impacts `cells` against the article.
    ///
    /// # Errors
    /// If a picture cannot be drawn.
    pub fn judge(&self, cells: &[Cell], figure: &str) -> Result<Findings, PublishedError> {
        let mut findings = Findings::default();
        let caption = format!("{}: our means over the published curve, less one (%).", self.name);
        let mut table = Table::new(&caption, &["angle (deg)", "speed (m/s)", "published"]);
        table.head.extend(READINGS.iter().map(|reading| reading.name.to_owned()));
        let mut panels = Vec::new();
        for angle in matrix::angles(cells) {
            let mut panel = Panel { title: format!("{angle} deg"), ..Panel::default() };
            let mut deviations = Vec::new();
            for (at, reading) in READINGS.iter().enumerate() {
                let own = matrix::of(cells, reading, angle);
                let Some(published) = own.first().map(|cell| cell.published) else { continue };
                let series = series(&own, self.of);
                panel.points.push(points(at, &series));
                let Some(curve) = (self.published)(published) else { continue };
                self.compare(&mut findings, (reading, at, angle), &series, &curve);
                let fine = |k: u32| 0.5 + 3.5 * f64::from(k) / 40.0;
                let line = (0..=40).map(|k| (fine(k), curve.form.at(&curve.values, fine(k))));
                panel.curves.push((READINGS.len(), line.collect()));
                let off = series.speeds.iter().zip(&series.means);
                deviations.push(
                    off.map(|(v, y)| (*v, curve.form.at(&curve.values, *v), *y))
                        .collect::<Vec<_>>(),
                );
            }
            if let [first, second] = &deviations[..] {
                for (one, other) in first.iter().zip(second) {
                    let percent = |(_, published, ours): &(f64, f64, f64)| {
                        format!("{:+.1}", 100.0 * (ours / published - 1.0))
                    };
                    let row = [format!("{angle}"), format!("{}", one.0), format!("{:.4}", one.1)];
                    table.rows.push([&row[..], &[percent(one), percent(other)]].concat());
                }
            }
            panels.push(panel);
        }
        findings.tables.push(table);
        let mut names: Vec<String> = READINGS.iter().map(|one| one.name.to_owned()).collect();
        names.push("published".to_owned());
        let plot = Plot { axes: ["impact speed (m/s)", self.axis], names, panels };
        let caption = format!("{} over the impact speed, at each angle.", self.name);
        findings.show(figure, &caption, plot.draw()?);
        Ok(findings)
    }

    /// The checks of one reading at one angle.
    fn compare(
        &self,
        findings: &mut Findings,
        (reading, number, angle): (&Reading, usize, f64),
        series: &Series,
        curve: &Curve,
    ) {
        let title = format!("{angle}°, {}", reading.name);
        let ratios: Vec<f64> = series
            .speeds
            .iter()
            .zip(&series.means)
            .map(|(v, y)| y / curve.form.at(&curve.values, *v))
            .collect();
        let n = ratios.len() as f64;
        let mean = ratios.iter().sum::<f64>() / n;
        let off = 100.0 * ratios.iter().map(|ratio| (ratio - 1.0).abs()).sum::<f64>() / n;
        let fitted = curve.form.fit(&series.speeds, &series.means, series.errors.as_deref());
        // The scatter of one mean, as a share.
        let scatter = match &series.errors {
            Some(errors) => {
                errors.iter().zip(&series.means).map(|(e, y)| e / y.abs()).sum::<f64>() / n
            }
            None => fitted.as_ref().map_or(0.0, |fitted| {
                fitted.residual * n / series.means.iter().map(|y| y.abs()).sum::<f64>()
            }),
        };
        let ours = Estimate::new(off, 100.0 * scatter / n.sqrt());
        let what = format!("{title}: {}, mean deviation from the published curve (%)", self.name);
        let known = &self.known[number];
        let check = Check::at_most(what, format!("ours over it: {mean:.3}"), ours, self.goal)
            .unless_known(Some(known), mean);
        let is_listed = check.verdict <= crate::published::Verdict::Deviates;
        findings.checks.push(check);
        let Some(fitted) = fitted else { return };
        let share = self.stated_scatter.unwrap_or(scatter);
        let at_source: Vec<f64> = SPEEDS.iter().map(|v| curve.form.at(&curve.values, *v)).collect();
        let errors: Vec<f64> = at_source.iter().map(|y| share * y / POSITIONS.sqrt()).collect();
        let source = curve.form.fit(&SPEEDS, &at_source, Some(&errors));
        for (at, name) in curve.names.iter().enumerate() {
            let published = Estimate::new(
                curve.values[at],
                source.as_ref().map_or(0.0, |fitted| fitted.error(at)),
            );
            let ours = Estimate::new(fitted.coefficients[at], fitted.error(at));
            let half =
                SIGMAS * (published.error * published.error + ours.error * ours.error).sqrt();
            let reason = "two standard errors: of the published fit by the scatter of its positions, and of ours";
            let check =
                Check::number(format!("{title}: {name}"), published, ours, Band { half, reason });
            findings
                .checks
                .push(check.listed(is_listed, "follows from the curve, which is judged above"));
        }
    }
}

fn points(series: usize, of: &Series) -> Points {
    let error = |at: usize| of.errors.as_ref().map_or(0.0, |errors| errors[at]);
    let places = (0..of.means.len()).map(|at| (of.speeds[at], of.means[at], error(at)));
    Points { series, places: places.collect() }
}

#[cfg(test)]
mod tests {
    use super::super::records::record;
    use super::super::tables::{Line, PUBLISHED};
    use super::*;
    use crate::published::Verdict;

    const DEPTH: Quantity = Quantity {
        name: "depth",
        axis: "depth (m)",
        of: |record| Some(record.deepest),
        published: |one| {
            let Line { slope, intercept } = one.depth;
            let names = &["slope (s)", "intercept (m)"];
            Some(Curve { form: Form::Line, names, values: vec![slope, intercept] })
        },
        goal: Band { half: 6.0, reason: "a test" },
        stated_scatter: Some(0.06),
        known: [Known { ratio: [1.0, 1.2], cause: "a test" }; 2],
    };

    /// Impacts of every angle, two positions each, `factor` times as deep as published and 1 % off.
    fn cells(factor: f64) -> Vec<Cell> {
        let cell = |reading, published: &'static Published, speed: f64| {
            let depth = factor * published.depth.at(speed);
            let at = |share: f64| record(0.1, vec![0.0, 0.0], vec![0.0, share * depth]);
            Cell { reading, published, speed, records: vec![at(0.99), at(1.01)] }
        };
        READINGS
            .iter()
            .flat_map(|reading| PUBLISHED.iter().map(move |published| (reading, published)))
            .flat_map(|(reading, published)| SPEEDS.map(|speed| cell(reading, published, speed)))
            .collect()
    }

    fn verdicts(factor: f64) -> Vec<Verdict> {
        let findings = DEPTH.judge(&cells(factor), "depth.svg").expect("a picture");
        findings.checks.iter().map(|check| check.verdict).collect()
    }

    #[test]
    fn the_published_depths_pass_and_deeper_ones_deviate_as_listed_or_fail() {
        // Two readings of seven angles: the deviation, the slope and the intercept.
        let published = verdicts(1.0);
        assert_eq!(published.len(), 2 * 7 * 3);
        assert!(published.iter().all(|verdict| *verdict == Verdict::Pass), "{published:?}");
        // The deviation is the first check of every three.
        let first = |verdicts: &[Verdict]| verdicts.iter().copied().step_by(3).collect::<Vec<_>>();
        assert!(first(&verdicts(1.15)).iter().all(|verdict| *verdict == Verdict::Deviates));
        assert!(first(&verdicts(1.5)).iter().all(|verdict| *verdict == Verdict::Fail));
    }

    #[test]
    fn the_scatter_of_positions_is_that_of_their_mean() {
        let cells = cells(1.0);
        let own: Vec<&Cell> = cells.iter().take(SPEEDS.len()).collect();
        let series = series(&own, |record| Some(record.deepest));
        let errors = series.errors.expect("two positions");
        // Two positions 1 % to either side: a standard deviation of √2 %, of their mean 1 %.
        let is_one_percent = |(error, mean): (&f64, &f64)| (error / mean - 0.01).abs() < 1e-12;
        assert!(errors.iter().zip(&series.means).all(is_one_percent), "{errors:?}");
    }
}
