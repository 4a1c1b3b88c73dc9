//! Residual trajectories beside the noise of the means.

use plots::legend::Sign;
use plots::{PictureError, colour};

use super::multiples::{self, Panel, Track, tracks};
use crate::misfit::residual::Residual;
use crate::where_it_fails::WhereItFails;

/// Most panels.
const PANELS: usize = 16;

const COLUMNS: usize = 4;

/// Those tracks that the first model misses most; `None` without trajectories.
pub(crate) fn residuals(found: &WhereItFails<'_>) -> Result<Option<String>, PictureError> {
    let Some(first) = found.models.first() else { return Ok(None) };
    let mut worst: Vec<(f64, Track)> = tracks(&first.residuals)
        .into_iter()
        .map(|track| (track.misfit(&first.residuals), track))
        .collect();
    if worst.is_empty() {
        return Ok(None);
    }
    worst.sort_by(|(a, _), (b, _)| b.total_cmp(a));
    let all = worst.len();
    worst.truncate(PANELS);
    let panels: Vec<Panel> = worst
        .iter()
        .map(|(_, track)| Panel {
            title: track.title(found),
            axes: [track.axes()[0], track.axes()[1]],
            band: track.band(&first.residuals),
            points: Vec::new(),
            lines: found
                .models
                .iter()
                .enumerate()
                .map(|(at, model)| {
                    let left = |_: usize, one: &Residual| one.measured - one.predicted;
                    (colour(at), track.along(&model.residuals, left))
                })
                .collect(),
        })
        .collect();
    let mut rows: Vec<(Sign, String)> = found
        .models
        .iter()
        .enumerate()
        .map(|(at, model)| {
            (Sign::Line(colour(at)), format!("measured less predicted by {}", model.model))
        })
        .collect();
    let shown = panels.len();
    rows.push((
        Sign::Band,
        format!(
            "95 % of means of so many runs, if the model were right; {shown} of {all}, worst first"
        ),
    ));
    multiples::picture(&panels, COLUMNS, &rows).map(Some)
}
