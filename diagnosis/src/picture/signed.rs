//! Signed force errors as colours.

use plots::legend::{self, Sign};
use plots::{Area, COLOURS, Drawn, GREY, centred, letters, short};
use plotters::prelude::*;

use crate::misfit::force_error::ForceCell;

/// Where a scale may end.
const LIMITS: [f64; 9] = [0.05, 0.1, 0.2, 0.3, 0.4, 0.6, 1.0, 2.0, 5.0];

/// Share of the errors that the scale holds.
const MOST: f64 = 0.8;

/// Steps of the drawn scale to either side.
const STEPS: i32 = 20;

/// Height of the scale with its explanations (pixels).
pub(super) const HEIGHT: u32 = 110;

/// The force error of `cell` in words.
pub(super) fn in_words(cell: &ForceCell) -> String {
    let significant = if cell.significant { ", significant" } else { "" };
    let (error, se) = (100.0 * cell.force_error, 100.0 * cell.se);
    format!("force error {error:+.1} \u{b1} {se:.1} %{significant}")
}

/// Blue where the force is smaller than in the model, vermilion where it is larger, white between.
pub(super) struct Scale {
    limit: f64,
}

impl Scale {
    /// That holds most of the cells to be believed, or most of all where none is: a single large error
    /// must not make the others pale.
    pub(super) fn of<'c>(cells: impl Iterator<Item = &'c ForceCell> + Clone) -> Self {
        let size = |cell: &ForceCell| cell.force_error.abs();
        let mut sizes: Vec<f64> = cells.clone().filter(|cell| cell.significant).map(size).collect();
        if sizes.is_empty() {
            sizes = cells.map(size).collect();
        }
        sizes.sort_by(f64::total_cmp);
        let most = sizes.get((MOST * sizes.len() as f64) as usize).copied().unwrap_or(0.0);
        let limit = LIMITS.into_iter().find(|limit| *limit >= most);
        Self { limit: limit.unwrap_or(LIMITS[LIMITS.len() - 1]) }
    }

    /// Of a force error (1 = 100 %); grey if its standard error `se` is as wide as the scale.
    pub(super) fn colour(&self, force_error: f64, se: f64) -> RGBColor {
        if se >= self.limit {
            return GREY;
        }
        let share = (force_error / self.limit).clamp(-1.0, 1.0);
        let RGBColor(r, g, b) = if share < 0.0 { COLOURS[0] } else { COLOURS[1] };
        let towards = |end: u8| (255.0 + (f64::from(end) - 255.0) * share.abs()).round() as u8;
        RGBColor(towards(r), towards(g), towards(b))
    }

    /// The scale, and what the signs of a map mean.
    pub(super) fn draw(&self, area: &Area<'_>) -> Drawn {
        let (left, width) = (70, 5);
        for step in -STEPS..=STEPS {
            let x = left + width * (step + STEPS);
            let colour = self.colour(self.limit * f64::from(step) / f64::from(STEPS), 0.0);
            area.draw(&Rectangle::new([(x, 4), (x + width, 20)], colour.filled()))?;
        }
        let right = left + width * (2 * STEPS + 1);
        area.draw(&Rectangle::new([(left, 4), (right, 20)], BLACK.stroke_width(1)))?;
        let limit = short(100.0 * self.limit);
        for (x, text) in [
            (left, format!("\u{2264} \u{2212}{limit} %")),
            ((left + right) / 2, "0".to_owned()),
            (right, format!("\u{2265} +{limit} %")),
        ] {
            area.draw(&Text::new(text, (x, 30), centred()))?;
        }
        let what = "force error: by how much the force is larger than in the model";
        area.draw(&Text::new(what, (right + 30, 6), letters()))?;
        let (_, below) = area.split_vertically(46);
        legend::draw(
            &below,
            &[
                (Sign::Mark, "significant at a false-discovery rate of 5 %".to_owned()),
                (Sign::Square(GREY), "known no better than to the width of the scale".to_owned()),
            ],
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_tell_the_sign_and_what_is_not_known() {
        let cell = |force_error, significant| {
            let (condition, from, to, se) = (0, 0.0, 0.1, 0.02);
            ForceCell { condition, from, to, force_error, se, significant }
        };
        let scale = Scale::of([cell(-0.15, true), cell(3.0, false)].iter());
        assert_eq!(scale.colour(-0.2, 0.0), COLOURS[0]);
        assert_eq!(scale.colour(7.0, 0.0), COLOURS[1]);
        assert_eq!(scale.colour(0.0, 0.0), WHITE);
        assert_eq!(scale.colour(0.1, 0.2), GREY);
    }
}
