//! Pictures of a report, as SVG or pixels: the same input gives the same bytes.
//!
//! [`svg`] renders what is drawn on a [`Canvas`]; a [`Hover`] is a place that shows its value under the pointer, and
//! [`legend`] explains signs and colours. A [`sheet`] is a picture of many grains.

pub mod axes;
mod canvas;
pub mod legend;
pub mod sheet;

use std::cell::RefCell;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use thiserror::Error;

pub use canvas::{Canvas, Hover};

/// Why there is no picture.
#[derive(Debug, Error)]
#[error("cannot draw: {0}")]
pub struct PictureError(pub String);

/// Colours that stay apart for most colour-blind eyes (Okabe & Ito 2008).
pub const COLOURS: [RGBColor; 8] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(0, 0, 0),
    RGBColor(240, 228, 66),
];

/// Bands, and what is not known.
pub const GREY: RGBColor = RGBColor(222, 222, 222);

/// Letters of titles, labels and legends (pixels).
const LETTERS: f64 = 13.0;

/// Width of a letter of that size, on average (pixels).
pub const LETTER: f64 = 6.6;

/// A part of a picture.
pub type Area<'a> = DrawingArea<Canvas<'a>, Shift>;

/// What drawing comes to.
pub type Drawn = Result<(), DrawingAreaErrorKind<std::io::Error>>;

/// A picture of `size` (pixels) on white.
pub fn svg(
    size: (u32, u32),
    draw: impl for<'a> FnOnce(&Area<'a>) -> Drawn,
) -> Result<String, PictureError> {
    let mut text = String::new();
    let hovers = RefCell::default();
    {
        let area = Canvas::new(&mut text, size, &hovers).into_drawing_area();
        area.fill(&WHITE)
            .and_then(|()| draw(&area))
            .and_then(|()| area.present())
            .map_err(|error| PictureError(error.to_string()))?;
    }
    canvas::lay_over(&mut text, &hovers.into_inner());
    Ok(text)
}

/// The colour of model, effect or series `index`.
pub fn colour(index: usize) -> RGBColor {
    COLOURS[index % COLOURS.len()]
}

/// Letters that begin at their place.
pub fn letters() -> TextStyle<'static> {
    ("sans-serif", LETTERS).into_font().into()
}

/// Letters around their place.
pub fn centred() -> TextStyle<'static> {
    letters().pos(Pos::new(HPos::Center, VPos::Center))
}

/// Letters that run upwards and end at their place.
pub fn upright() -> TextStyle<'static> {
    letters().transform(FontTransform::Rotate270).pos(Pos::new(HPos::Right, VPos::Center))
}

/// `value` to so many significant digits.
pub fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value)
}

/// A number as labels have it: three digits, no zeros behind the point.
pub fn short(value: f64) -> String {
    let value = rounded(value, 3);
    match value.abs() {
        size if (1e-3..1e9).contains(&size) => value.to_string(),
        size if size > 0.0 => format!("{value:e}"),
        // Of either sign.
        _ => "0".to_owned(),
    }
}

/// As much of `text` as fits `width` pixels, with a mark where some is missing.
pub fn fitting(text: &str, width: u32) -> String {
    let room = (f64::from(width) / LETTER) as usize;
    if text.chars().count() <= room {
        return text.to_owned();
    }
    text.chars().take(room.saturating_sub(1)).chain(['\u{2026}']).collect()
}

/// `low` and `high` with a ninth of their distance beyond either.
pub fn padded(low: f64, high: f64) -> std::ops::Range<f64> {
    let distance = high - low;
    let pad = if distance > 0.0 { distance / 9.0 } else { low.abs().max(1.0) / 9.0 };
    low - pad..high + pad
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_series_of_a_figure_have_one_colour() {
        let colours: std::collections::BTreeSet<_> =
            COLOURS.iter().map(|colour| colour.to_backend_color().rgb).collect();
        assert_eq!(colours.len(), COLOURS.len());
    }

    #[test]
    fn a_short_number_has_three_digits_and_small_ones_a_power_of_ten() {
        assert_eq!(short(12.345), "12.3");
        assert_eq!(short(-0.0), "0");
        assert_eq!(short(1.377e-3), "0.00138");
        assert_eq!(short(-1.223e-6), "-1.22e-6");
    }
}
