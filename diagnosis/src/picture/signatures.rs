//! What a model leaves over, and what the best two candidates would do about it.

use plots::axes::Frame;
use plots::legend::{self, Sign};
use plots::{Area, Drawn, Hover, LETTER, PictureError, colour, fitting, letters, svg, upright};
use plotters::prelude::*;

use super::multiples::{self, Panel, Track, tracks};
use crate::forward::NORMAL_95;
use crate::forward::observable::Observable;
use crate::misfit::residual::Residual;
use crate::where_it_fails::{Signature, WhereItFails};

/// Most tracks, and most conditions of scalars.
const TRACKS: usize = 6;
const CONDITIONS: usize = 12;

const COLUMNS: usize = 3;

/// Size of a panel of scalars without the names below it (pixels).
const PANEL: (u32, u32) = (400, 260);

/// Where the signatures differ most; `None` without any.
pub(crate) fn signatures(found: &WhereItFails<'_>) -> Result<Option<String>, PictureError> {
    let Some(model) = found.models.first().filter(|_| !found.signatures.is_empty()) else {
        return Ok(None);
    };
    let residuals = model.residuals.as_slice();
    let difference = |place: usize| difference(&found.signatures, residuals, place);
    let mut tracks: Vec<(f64, Track)> = tracks(residuals)
        .into_iter()
        .map(|track| (track.places.iter().map(|&place| difference(place)).sum(), track))
        .collect();
    tracks.sort_by(|(a, _), (b, _)| b.total_cmp(a));
    tracks.truncate(TRACKS);
    if tracks.is_empty() {
        return scalars(found, residuals).map(Some);
    }
    let panels: Vec<Panel> = tracks
        .iter()
        .map(|(_, track)| Panel {
            title: track.title(found),
            axes: [track.axes()[0], track.axes()[1]],
            band: track.band(residuals),
            points: track.along(residuals, |_, one| one.measured - one.predicted),
            lines: found
                .signatures
                .iter()
                .enumerate()
                .map(|(at, signature)| {
                    (colour(at), track.along(residuals, |place, _| signature.change[place]))
                })
                .collect(),
        })
        .collect();
    let mut rows = rows(found, Sign::Line);
    rows.push((Sign::Band, "95 % of means of so many runs".to_owned()));
    multiples::picture(&panels, COLUMNS, &rows).map(Some)
}

/// Square of the difference of two signatures at a number, in standard errors; of one, of its size.
fn difference(signatures: &[Signature], residuals: &[Residual], place: usize) -> f64 {
    let change = |at: usize| signatures.get(at).map_or(0.0, |signature| signature.change[place]);
    ((change(0) - change(1)) / residuals[place].standard_error).powi(2)
}

fn rows(found: &WhereItFails<'_>, sign: fn(RGBColor) -> Sign) -> Vec<(Sign, String)> {
    let name = &found.models[0].model;
    let mut rows = vec![(Sign::Dot(BLACK), format!("measured less predicted by {name}"))];
    rows.extend(found.signatures.iter().enumerate().map(|(at, signature)| {
        let effect = &signature.effect;
        (sign(colour(at)), format!("what {effect} would add, once the parameters have compensated"))
    }));
    rows
}

/// One panel per kind of scalar, one place per condition.
fn scalars(found: &WhereItFails<'_>, residuals: &[Residual]) -> Result<String, PictureError> {
    let mut conditions: Vec<(f64, usize)> = Vec::new();
    for (place, one) in residuals.iter().enumerate() {
        let by = difference(&found.signatures, residuals, place);
        match conditions.iter_mut().find(|(_, condition)| *condition == one.condition) {
            Some((sum, _)) => *sum += by,
            None => conditions.push((by, one.condition)),
        }
    }
    conditions.sort_by(|(a, _), (b, _)| b.total_cmp(a));
    conditions.truncate(CONDITIONS);
    let mut conditions: Vec<usize> =
        conditions.into_iter().map(|(_, condition)| condition).collect();
    conditions.sort_unstable();
    let names: Vec<String> =
        conditions.iter().map(|&at| fitting(&found.set.conditions[at].id, 140)).collect();
    let longest = names.iter().map(|name| name.chars().count()).max().unwrap_or(0);
    let below = (longest as f64 * LETTER) as u32 + 14;
    let kinds = [
        (Observable::StopTime, "stopping time (ms)"),
        (Observable::FinalDepth, "final depth (mm)"),
        (Observable::FinalRange, "final range (mm)"),
    ];
    let has = |kind: Observable| residuals.iter().any(|one| one.observable == kind);
    let kinds: Vec<_> = kinds.into_iter().filter(|(kind, _)| has(*kind)).collect();
    let rows = rows(found, Sign::Dot);
    let height = PANEL.1 + below;
    let size = ((PANEL.0 * kinds.len() as u32).max(640), height + legend::height(rows.len()));
    svg(size, |area| {
        let (charts, legend_area) = area.split_vertically(height);
        let (charts, _) = charts.split_horizontally(PANEL.0 * kinds.len() as u32);
        for ((kind, title), chart) in kinds.iter().zip(charts.split_evenly((1, kinds.len()))) {
            let numbers: Vec<(usize, usize)> = (0..residuals.len())
                .filter(|&place| residuals[place].observable == *kind)
                .filter_map(|place| {
                    let own = residuals[place].condition;
                    Some((conditions.iter().position(|&condition| condition == own)?, place))
                })
                .collect();
            let scalars = Scalars { title, below, names: &names, numbers: &numbers };
            scalars.draw(&chart, residuals, &found.signatures)?;
        }
        legend::draw(&legend_area, &rows)
    })
}

/// A panel: the names of conditions, and (place of the condition, place of the number).
struct Scalars<'a> {
    title: &'a str,
    below: u32,
    names: &'a [String],
    numbers: &'a [(usize, usize)],
}

impl Scalars<'_> {
    fn draw(&self, area: &Area<'_>, residuals: &[Residual], signatures: &[Signature]) -> Drawn {
        area.draw(&Text::new(self.title, (52, 8), letters()))?;
        let left = |place: usize| 1e3 * (residuals[place].measured - residuals[place].predicted);
        let half = |place: usize| 1e3 * NORMAL_95 * residuals[place].standard_error;
        let change = |signature: &Signature, place: usize| 1e3 * signature.change[place];
        let mut most = 1e-6_f64;
        for &(_, place) in self.numbers {
            most = most.max(left(place).abs() + half(place));
            most = signatures.iter().fold(most, |most, one| most.max(change(one, place).abs()));
        }
        let mut chart = Frame {
            ranges: [0.0..self.names.len() as f64, -1.05 * most..1.05 * most],
            ticks: [0, 6],
            names: ["", ""],
            above: 30,
            below: self.below,
            grid: true,
        }
        .draw(area)?;
        let zero = [(0.0, 0.0), (self.names.len() as f64, 0.0)];
        chart.draw_series([PathElement::new(zero, BLACK.stroke_width(1))])?;
        for &(condition, place) in self.numbers {
            let x = condition as f64 + 0.5;
            let bar = [(x, left(place) - half(place)), (x, left(place) + half(place))];
            chart.draw_series([PathElement::new(bar, BLACK.stroke_width(1))])?;
            chart.draw_series([Circle::new((x, left(place)), 3, BLACK.filled())])?;
            for (at, signature) in signatures.iter().enumerate() {
                let x = x + 0.2 * (2.0 * at as f64 - 1.0);
                let dot = Circle::new((x, change(signature, place)), 4, colour(at).filled());
                chart.draw_series([dot])?;
                let text = format!(
                    "{}\n{} adds {:+.2}",
                    self.names[condition],
                    signature.effect,
                    change(signature, place)
                );
                chart.draw_series([Hover::at((x, change(signature, place)), text)])?;
            }
            let text = format!(
                "{}\nmeasured less predicted {:+.2} \u{b1} {:.2}",
                self.names[condition],
                left(place),
                half(place) / NORMAL_95
            );
            chart.draw_series([Hover::at((x, left(place)), text)])?;
        }
        let plot = chart.plotting_area();
        let corner = area.get_pixel_range();
        for (condition, name) in self.names.iter().enumerate() {
            let (x, y) = plot.map_coordinate(&(condition as f64 + 0.5, -1.05 * most));
            let place = (x - corner.0.start, y - corner.1.start + 6);
            area.draw(&Text::new(name.clone(), place, upright()))?;
        }
        Ok(())
    }
}
