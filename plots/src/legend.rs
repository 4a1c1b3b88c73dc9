//! What signs and colours mean, in rows below a picture.

use plotters::element::DashedPathElement;
use plotters::prelude::*;

use super::{Area, Drawn, GREY, LETTERS, letters};

/// Height of a row (pixels).
const ROW: u32 = 20;

/// A sign of a legend.
#[derive(Clone, Copy)]
pub enum Sign {
    /// A line.
    Line(RGBColor),
    /// A dashed line.
    Dashed(RGBColor),
    /// A band of noise.
    Band,
    /// A filled circle.
    Dot(RGBColor),
    /// A filled square.
    Square(RGBColor),
    /// The mark of what is significant.
    Mark,
}

/// Height of a legend of `rows` (pixels).
pub fn height(rows: usize) -> u32 {
    ROW * rows as u32 + 14
}

/// Draws `rows` from the top of `area`.
pub fn draw(area: &Area<'_>, rows: &[(Sign, String)]) -> Drawn {
    for (row, (sign, text)) in rows.iter().enumerate() {
        let y = (4 + ROW / 2 + ROW * row as u32) as i32;
        draw_sign(area, *sign, y)?;
        area.draw(&Text::new(text.clone(), (70, y - LETTERS as i32 / 2), letters()))?;
    }
    Ok(())
}

fn draw_sign(area: &Area<'_>, sign: Sign, y: i32) -> Drawn {
    let line = vec![(20, y), (60, y)];
    let square = [(33, y - 7), (47, y + 7)];
    match sign {
        Sign::Line(colour) => area.draw(&PathElement::new(line, colour.stroke_width(2))),
        Sign::Dashed(colour) => {
            area.draw(&DashedPathElement::new(line, 5, 4, colour.stroke_width(2)))
        }
        Sign::Band => area.draw(&Rectangle::new([(20, y - 6), (60, y + 6)], GREY.filled())),
        Sign::Dot(colour) => area.draw(&Circle::new((40, y), 4, colour.filled())),
        Sign::Square(colour) => area.draw(&Rectangle::new(square, colour.filled())),
        Sign::Mark => mark(area, (40, y)),
    }
}

/// The mark of what is significant, around `place`.
pub fn mark(area: &Area<'_>, place: (i32, i32)) -> Drawn {
    area.draw(&Circle::new(place, 3, WHITE.filled()))?;
    area.draw(&Circle::new(place, 3, BLACK.stroke_width(1)))
}
