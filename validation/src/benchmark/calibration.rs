//! How far the predicted probability of a right answer can be trusted.

use plots::PictureError;
use plotters::prelude::*;

use super::interval::Share;
use super::scores::{Measured, Score, Target, is_first};
use super::trial::Trial;

/// Bins of the predicted probability.
const BINS: usize = 10;

/// Pixels.
const SIZE: (u32, u32) = (460, 440);

/// The trials whose prediction falls into one bin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bin {
    /// Mean predicted probability that the first-ranked effect is ranked first, if it is there.
    pub predicted: f64,
    /// How often it was the one that is there.
    pub observed: Share,
}

/// Predicted against observed over all of `trials` that hide one listed effect.
pub fn calibration(trials: &[Trial]) -> Vec<Bin> {
    let mut bins = [(0.0, Share::default()); BINS];
    for trial in trials {
        let [hidden] = trial.plan.hidden[..] else { continue };
        let Some(answer) = trial.answer().filter(|_| hidden.is_listed()) else { continue };
        let Some(predicted) = answer.predicted_first else { continue };
        let (sum, share) = &mut bins[((predicted * BINS as f64) as usize).min(BINS - 1)];
        *sum += predicted;
        share.n += 1;
        share.hits += usize::from(is_first(&(trial, answer)));
    }
    let filled = bins.into_iter().filter(|(_, share)| share.n > 0);
    filled.map(|(sum, observed)| Bin { predicted: sum / observed.n as f64, observed }).collect()
}

/// As rows of the tables.
pub fn rows(bins: &[Bin]) -> Vec<Score> {
    bins.iter()
        .map(|bin| Score {
            metric: format!("predicted {:.2} to be ranked first if there: observed", bin.predicted),
            measured: Measured::Share(bin.observed),
            target: Target::Within(bin.predicted - 0.1, bin.predicted + 0.1),
        })
        .collect()
}

/// As SVG: observed over predicted with intervals of 95 %; the line is a prediction that holds.
pub fn picture(bins: &[Bin]) -> Result<String, PictureError> {
    let mut text = String::new();
    draw(&mut text, bins).map_err(|error| PictureError(error.to_string()))?;
    Ok(text)
}

type Drawn<'a> = Result<(), DrawingAreaErrorKind<<SVGBackend<'a> as DrawingBackend>::ErrorType>>;

fn draw<'a>(text: &'a mut String, bins: &[Bin]) -> Drawn<'a> {
    let area = SVGBackend::with_string(text, SIZE).into_drawing_area();
    area.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&area)
        .caption("Is it the one that is ranked first?", ("sans-serif", 17))
        .margin(10)
        .x_label_area_size(40)
        .y_label_area_size(48)
        .build_cartesian_2d(0.0..1.02, 0.0..1.02)?;
    let mut mesh = chart.configure_mesh();
    mesh.x_desc("predicted probability").y_desc("share of trials").max_light_lines(0).draw()?;
    let even = [(0.0, 0.0), (1.0, 1.0)];
    chart.draw_series(DashedLineSeries::new(even, 4, 3, BLACK.stroke_width(1)))?;
    let colour = RGBColor(0, 114, 178);
    for bin in bins {
        let [low, high] = bin.observed.interval();
        let at = |share: f64| (bin.predicted, share);
        chart.draw_series([PathElement::new(vec![at(low), at(high)], colour.stroke_width(2))])?;
        let place = at(bin.observed.value().unwrap_or(0.0));
        chart.draw_series([Circle::new(place, 4, colour.filled())])?;
        let style = ("sans-serif", 11).into_font().color(&BLACK);
        chart.draw_series([Text::new(format!(" {}", bin.observed.n), at(low), style)])?;
    }
    area.present()
}
