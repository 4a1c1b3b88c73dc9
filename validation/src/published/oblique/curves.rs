//! Numbers of an impact over its speed, one curve per angle: fitted as the article fits them, and held
//! against its curves and its coefficients.

use runner::beds::Record;

use super::matrix::{self, Cell, READINGS, Reading};
use super::tables::Published;
use crate::published::check::{Band, Check, Estimate, Known, SIGMAS, Verdict};
use crate::published::plot::{Panel, Plot, Points};
use crate::published::regression::{self, Fitted};
use crate::published::row::{Findings, PublishedError, Table};

/// Speeds (m/s) at which the article's fits are taken to have been made, and how many positions each of
/// their points is the mean of.
const SPEEDS: [f64; 8] = [0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0];
const POSITIONS: f64 = 6.0;

/// Slowest impacts (m/s) that count in the mean deviation: below, the law of the article and its impacts differ
/// most, and a fluctuation decides when a slow disc stops.
const FROM: f64 = 1.0;

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
    /// What a source stated of the disagreement beforehand, per reading: of every impact from 1 m/s on.
    pub known: [Known; 2],
    /// Angle (deg) that it was stated of; it excuses no other.
    pub known_at: f64,
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

    /// Whether coefficient `number` is twice as large for a curve that is twice as high everywhere.
    #[must_use]
    pub fn scales(self, number: usize) -> bool {
        self == Self::Line || number != 1
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
    /// Degrees of freedom that the errors were found with.
    pub freedom: usize,
}

/// Our points of `cells`.
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
    Series { speeds: points.into_iter().map(|(speed, _)| speed).collect(), means, errors, freedom }
}

/// Gives single impacts the error that a curve of `form` through each of `all` leaves over, as a share that is the
/// same for all.
fn scatter_about(form: Form, all: &mut [(usize, Series)]) {
    let (mut squares, mut freedom) = (0.0, 0);
    for (_, series) in all.iter().filter(|(_, series)| series.errors.is_none()) {
        let Some(fitted) = form.fit(&series.speeds, &series.means, None) else { continue };
        let n = fitted.freedom.unwrap_or(0);
        let mean = series.means.iter().sum::<f64>() / series.means.len() as f64;
        squares += n as f64 * (fitted.residual / mean) * (fitted.residual / mean);
        freedom += n;
    }
    if freedom == 0 {
        return;
    }
    let share = (squares / freedom as f64).sqrt();
    for (_, series) in all.iter_mut().filter(|(_, series)| series.errors.is_none()) {
        series.errors = Some(series.means.iter().map(|mean| share * mean.abs()).collect());
        series.freedom = freedom;
    }
}

impl Quantity {
    /// Holds the impacts `cells` against the article.
    ///
    /// # Errors
    /// If a picture cannot be drawn.
    pub fn judge(&self, cells: &[Cell], figure: &str) -> Result<Findings, PublishedError> {
        let mut findings = Findings::default();
        let [mut each, mut mean] = self.tables();
        let mut panels = Vec::new();
        for angle in matrix::angles(cells) {
            let mut panel = Panel { title: format!("{angle} deg"), ..Panel::default() };
            let own = READINGS.each_ref().map(|reading| matrix::of(cells, reading, angle));
            let mut all: Vec<(usize, Series)> = own
                .iter()
                .enumerate()
                .filter(|(_, own)| !own.is_empty())
                .map(|(at, own)| (at, series(own, self.of)))
                .collect();
            let published = own.iter().flatten().next().map(|cell| cell.published);
            if let Some(curve) = published.and_then(self.published) {
                scatter_about(curve.form, &mut all);
                let mut line = vec![format!("{angle}")];
                for at in 0..READINGS.len() {
                    let own = all.iter().find(|(own, _)| *own == at);
                    let off =
                        own.map(|(_, one)| self.compare(&mut findings, (at, angle), one, &curve));
                    line.push(off.map_or("–".to_owned(), |off| format!("{off:.1}")));
                }
                mean.rows.push(line);
                each.rows.extend(deviations(angle, &all, &curve));
                let fine = |k: u32| 0.5 + 3.5 * f64::from(k) / 40.0;
                let line = (0..=40).map(|k| (fine(k), curve.form.at(&curve.values, fine(k))));
                panel.curves.push((READINGS.len(), line.collect()));
            }
            panel.points.extend(all.iter().map(|(at, series)| points(*at, series)));
            panels.push(panel);
        }
        findings.tables.extend([mean, each]);
        let mut names: Vec<String> = READINGS.iter().map(|one| one.name.to_owned()).collect();
        names.push("published".to_owned());
        let plot = Plot { axes: ["impact speed (m/s)", self.axis], names, panels };
        let caption = format!("{} over the impact speed, at each angle.", self.name);
        findings.show(figure, &caption, plot.draw()?);
        Ok(findings)
    }

    /// Mean absolute deviation (%) of our means from the published curve of an angle (deg), from 1 m/s on; none where
    /// nothing is published or no such impact is there.
    pub fn deviation(&self, cells: &[Cell], reading: &Reading, angle: f64) -> Option<f64> {
        let own = matrix::of(cells, reading, angle);
        let curve = (self.published)(own.first()?.published)?;
        let ratios = ratios(&series(&own, self.of), &curve);
        (!ratios.is_empty()).then(|| mean_deviation(&ratios))
    }

    /// What becomes of mean and of single deviations.
    fn tables(&self) -> [Table; 2] {
        let caption = format!(
            "{}: mean deviation of our means from the published curve, {FROM} to 4 m/s (%).",
            self.name
        );
        let mut mean = Table::new(&caption, &["angle (deg)"]);
        let caption = format!("{}: our means over the published curve, less one (%).", self.name);
        let mut each = Table::new(&caption, &["angle (deg)", "speed (m/s)", "published"]);
        for table in [&mut mean, &mut each] {
            table.head.extend(READINGS.iter().map(|reading| reading.name.to_owned()));
        }
        [each, mean]
    }

    /// The checks of one reading at one angle; the mean deviation (%).
    fn compare(
        &self,
        findings: &mut Findings,
        (at, angle): (usize, f64),
        series: &Series,
        curve: &Curve,
    ) -> f64 {
        let title = format!("{angle}°, {}", READINGS[at].name);
        let ratios = ratios(series, curve);
        let n = ratios.len() as f64;
        let mean = ratios.iter().sum::<f64>() / n;
        let off = mean_deviation(&ratios);
        // The scatter of one mean, as a share.
        let scatter = series.errors.as_ref().map_or(0.0, |errors| {
            let shares = errors.iter().zip(&series.means).map(|(e, y)| e / y.abs());
            shares.sum::<f64>() / errors.len() as f64
        });
        let of_mean = scatter / n.sqrt();
        let ours = Estimate::new(off, 100.0 * of_mean);
        let what = format!(
            "{title}: {}, mean deviation from the published curve (%), {mean:.3} of it in the mean",
            self.name
        );
        let sigmas = series.sigmas();
        let known = Some(&self.known[at]).filter(|_| angle.total_cmp(&self.known_at).is_eq());
        let of_one = if scatter > 0.0 { sigmas * scatter } else { 0.0 };
        let as_listed =
            known.is_some_and(|known| ratios.iter().all(|ratio| known.covers(*ratio, of_one)));
        let cause = known.map_or("", |known| known.cause);
        let by_scatter = match scatter > 0.0 {
            true => 100.0 * regression::deviation_by_scatter(&vec![scatter; ratios.len()], sigmas),
            // Nothing is known of it.
            false => f64::INFINITY,
        };
        let check = Check::deviation(what, "0", ours, by_scatter, self.goal);
        let check = check.listed(as_listed, cause);
        let curve_deviates = check.verdict == Verdict::Deviates;
        findings.checks.push(check);
        let share = self.stated_scatter.unwrap_or(scatter);
        let fitted = curve.form.fit(&series.speeds, &series.means, series.errors.as_deref());
        for (name, number) in curve.names.iter().zip(0..) {
            let what = format!("{title}: {name}");
            let published = Estimate::new(curve.values[number], curve.error(number, share));
            let Some(fitted) = fitted.as_ref().filter(|_| series.errors.is_some()) else {
                let why = "too few impacts to know the scatter of their fit";
                findings.checks.push(Check::undecided(what, &published.to_string(), why));
                continue;
            };
            let ours = Estimate::new(fitted.coefficients[number], fitted.error(number));
            let half = libm::hypot(SIGMAS * published.error, sigmas * ours.error);
            let reason = "two standard errors (Student's t): of the published fit by the scatter of its positions, \
                          and of ours";
            let check = Check::number(what, published, ours, Band { half, reason });
            // Judged by its own number, where its curve is off by what was listed. A rate does not grow with its curve.
            let [ratio, margin] =
                [ours.value, sigmas * ours.error].map(|one| one / published.value);
            let scales = curve.form.scales(number);
            let as_listed = known.is_some_and(|known| known.covers(ratio, margin.abs()));
            findings.checks.push(check.listed(curve_deviates && scales && as_listed, cause));
        }
        off
    }
}

impl Curve {
    /// Standard error of coefficient `number` of the published fit, whose impacts scatter by `share`.
    fn error(&self, number: usize, share: f64) -> f64 {
        let points: Vec<f64> = SPEEDS.iter().map(|v| self.form.at(&self.values, *v)).collect();
        let errors: Vec<f64> = points.iter().map(|y| share * y / POSITIONS.sqrt()).collect();
        self.form.fit(&SPEEDS, &points, Some(&errors)).map_or(0.0, |fitted| fitted.error(number))
    }
}

impl Series {
    /// How many of its errors hold a number as surely as [`SIGMAS`] do of a scatter that is known.
    fn sigmas(&self) -> f64 {
        regression::student(SIGMAS, self.freedom)
    }

    /// How many standard errors of a curve `fitted` to it hold a coefficient as surely as so many `sigmas` do where the
    /// scatter is known.
    pub fn as_surely_as(&self, fitted: &Fitted, sigmas: f64) -> f64 {
        match self.errors {
            Some(_) => regression::student(sigmas, self.freedom),
            None => fitted.as_surely_as(sigmas),
        }
    }
}

/// Means over the published curve, from 1 m/s on.
fn ratios(series: &Series, curve: &Curve) -> Vec<f64> {
    let places = series.speeds.iter().zip(&series.means).filter(|(v, _)| **v >= FROM);
    places.map(|(v, y)| y / curve.form.at(&curve.values, *v)).collect()
}

/// Mean absolute deviation of `ratios` from one (%).
fn mean_deviation(ratios: &[f64]) -> f64 {
    let off = ratios.iter().map(|ratio| (ratio - 1.0).abs());
    100.0 * off.sum::<f64>() / ratios.len() as f64
}

/// How far single means are off (%), a line per speed.
fn deviations(angle: f64, all: &[(usize, Series)], curve: &Curve) -> Vec<Vec<String>> {
    let Some((_, first)) = all.first() else { return Vec::new() };
    let row = |speed: &f64| {
        let published = curve.form.at(&curve.values, *speed);
        let percent = |at: usize| {
            let (_, series) = all.iter().find(|(own, _)| *own == at)?;
            let place = series.speeds.iter().position(|own| (own - speed).abs() < 1e-9)?;
            Some(format!("{:+.1}", 100.0 * (series.means[place] / published - 1.0)))
        };
        let head = [format!("{angle}"), format!("{speed}"), format!("{published:.4}")];
        let off = (0..READINGS.len()).map(|at| percent(at).unwrap_or_else(|| "–".to_owned()));
        head.into_iter().chain(off).collect()
    };
    first.speeds.iter().map(row).collect()
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
        known_at: 90.0,
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
        // The deviation is the first check of every three. What is listed is listed of 90°, the last of seven angles.
        let first = |verdicts: &[Verdict]| verdicts.iter().copied().step_by(3).collect::<Vec<_>>();
        let deeper = first(&verdicts(1.15));
        for (at, verdict) in deeper.iter().enumerate() {
            let is_listed = at / READINGS.len() == PUBLISHED.len() - 1;
            assert_eq!(*verdict, if is_listed { Verdict::Deviates } else { Verdict::Fail }, "{at}");
        }
        assert!(first(&verdicts(1.5)).iter().all(|verdict| *verdict == Verdict::Fail));
    }

    /// The checks at 90° as printed of impacts that are `depth` (m) deep at a speed (m/s), two positions 1 % off.
    fn at_90(depth: impl Fn(f64) -> f64) -> Vec<Check> {
        let published = PUBLISHED.last().expect("angles");
        let cell = |speed: f64| {
            let at = |share: f64| record(0.1, vec![0.0, 0.0], vec![0.0, share * depth(speed)]);
            let reading = &READINGS[0];
            Cell { reading, published, speed, records: vec![at(0.99), at(1.01)] }
        };
        let cells = SPEEDS.map(cell);
        DEPTH.judge(&cells, "depth.svg").expect("a picture").checks
    }

    #[test]
    fn a_coefficient_deviates_only_with_its_curve_and_by_its_own_number() {
        let published = PUBLISHED.last().expect("angles").depth;
        let verdicts = |depth: &dyn Fn(f64) -> f64| {
            at_90(depth).iter().map(|check| check.verdict).collect::<Vec<_>>()
        };
        // A sixth deeper at every speed, as listed: so are both coefficients, which deviate or are within their bands.
        let deeper = verdicts(&|v| 1.15 * published.at(v));
        assert_eq!(deeper[0], Verdict::Deviates);
        assert!(deeper.iter().all(|verdict| *verdict < Verdict::Fail), "{deeper:?}");
        // A line turned about 2 m/s: near the published one in the mean, and its slope is off by a third.
        let turned = |v: f64| published.at(v) + 0.33 * published.slope * (v - 2.0);
        let turned = verdicts(&turned);
        assert_eq!(turned[1], Verdict::Fail, "{turned:?}");
    }

    #[test]
    fn a_curve_is_off_as_listed_only_if_it_is_at_every_speed() {
        let published = PUBLISHED.last().expect("angles").depth;
        // In the mean a tenth deeper, as listed; a quarter at the ends.
        let bent = |v: f64| {
            (1.25 - 0.3 * libm::sin((v - 1.0) / 3.0 * std::f64::consts::PI)) * published.at(v)
        };
        assert_eq!(at_90(bent)[0].verdict, Verdict::Fail);
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
