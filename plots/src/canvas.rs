//! An SVG whose signs say their values to whoever points at them.

use std::cell::RefCell;
use std::fmt::Write as _;
use std::io;

use plotters::element::{Drawable, PointCollection};
use plotters::prelude::SVGBackend;
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind,
    FontFamily, FontStyle, FontTransform, text_anchor::Pos,
};

/// What a picture is drawn on: SVG, and over it the places that have something to say.
pub struct Canvas<'a> {
    svg: SVGBackend<'a>,
    hovers: &'a RefCell<Vec<Placed>>,
}

/// A place of a picture and what it says.
pub(super) struct Placed {
    area: Shape,
    text: String,
}

/// The part of a picture that listens (pixels).
#[derive(Clone, Copy)]
enum Shape {
    /// Centre and radius.
    Circle(BackendCoord, i32),
    /// Two opposite corners.
    Rectangle([BackendCoord; 2]),
}

/// Radius of the circle around a point that listens (pixels).
const REACH: i32 = 7;

/// An element without colour that shows a text while the pointer is over it.
pub struct Hover<C> {
    /// A point, or two opposite corners.
    places: Vec<C>,
    text: String,
}

impl<C> Hover<C> {
    /// Around the point `place`.
    pub fn at(place: C, text: impl Into<String>) -> Self {
        Self { places: vec![place], text: text.into() }
    }

    /// Between two opposite `corners`.
    pub fn over(corners: [C; 2], text: impl Into<String>) -> Self {
        Self { places: corners.into(), text: text.into() }
    }
}

impl<'a, C> PointCollection<'a, C> for &'a Hover<C> {
    type Point = &'a C;
    type IntoIter = std::slice::Iter<'a, C>;

    fn point_iter(self) -> Self::IntoIter {
        self.places.iter()
    }
}

impl<C> Drawable<Canvas<'_>> for Hover<C> {
    fn draw<I: Iterator<Item = BackendCoord>>(
        &self,
        mut places: I,
        canvas: &mut Canvas<'_>,
        _: (u32, u32),
    ) -> Result<(), DrawingErrorKind<io::Error>> {
        let area = match (places.next(), places.next()) {
            (Some(a), Some(b)) => Shape::Rectangle([a, b]),
            (Some(centre), None) => Shape::Circle(centre, REACH),
            (None, _) => return Ok(()),
        };
        canvas.hovers.borrow_mut().push(Placed { area, text: self.text.clone() });
        Ok(())
    }
}

impl<'a> Canvas<'a> {
    /// That draws into `text`, of `size` (pixels), and leaves what listens in `hovers`.
    pub(super) fn new(
        text: &'a mut String,
        size: (u32, u32),
        hovers: &'a RefCell<Vec<Placed>>,
    ) -> Self {
        Self { svg: SVGBackend::with_string(text, size), hovers }
    }
}

type Done = Result<(), DrawingErrorKind<io::Error>>;

impl DrawingBackend for Canvas<'_> {
    type ErrorType = io::Error;

    fn get_size(&self) -> (u32, u32) {
        self.svg.get_size()
    }

    fn ensure_prepared(&mut self) -> Done {
        self.svg.ensure_prepared()
    }

    fn present(&mut self) -> Done {
        self.svg.present()
    }

    fn draw_pixel(&mut self, point: BackendCoord, colour: BackendColor) -> Done {
        self.svg.draw_pixel(point, colour)
    }

    fn draw_line<S: BackendStyle>(
        &mut self,
        from: BackendCoord,
        to: BackendCoord,
        style: &S,
    ) -> Done {
        self.svg.draw_line(from, to, style)
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        upper_left: BackendCoord,
        bottom_right: BackendCoord,
        style: &S,
        fill: bool,
    ) -> Done {
        self.svg.draw_rect(upper_left, bottom_right, style, fill)
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Done {
        self.svg.draw_path(path, style)
    }

    fn draw_circle<S: BackendStyle>(
        &mut self,
        centre: BackendCoord,
        radius: u32,
        style: &S,
        fill: bool,
    ) -> Done {
        self.svg.draw_circle(centre, radius, style, fill)
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        corners: I,
        style: &S,
    ) -> Done {
        self.svg.fill_polygon(corners, style)
    }

    fn draw_text<S: BackendTextStyle>(
        &mut self,
        text: &str,
        style: &S,
        place: BackendCoord,
    ) -> Done {
        self.svg.draw_text(text, &Readable(style), place)
    }

    fn estimate_text_size<S: BackendTextStyle>(
        &self,
        text: &str,
        style: &S,
    ) -> Result<(u32, u32), DrawingErrorKind<io::Error>> {
        self.svg.estimate_text_size(text, &Readable(style))
    }
}

/// The least size of letters: SVG has them 11 pixels high, by the factor of `plotters`.
const LEAST: f64 = 14.0;

/// A style whose letters are large enough to be read.
struct Readable<'s, S>(&'s S);

impl<S: BackendTextStyle> BackendTextStyle for Readable<'_, S> {
    type FontError = S::FontError;

    fn color(&self) -> BackendColor {
        self.0.color()
    }

    fn size(&self) -> f64 {
        self.0.size().max(LEAST)
    }

    fn transform(&self) -> FontTransform {
        self.0.transform()
    }

    fn style(&self) -> FontStyle {
        self.0.style()
    }

    fn anchor(&self) -> Pos {
        self.0.anchor()
    }

    fn family(&self) -> FontFamily<'_> {
        self.0.family()
    }

    fn layout_box(&self, text: &str) -> Result<(BackendCoord, BackendCoord), Self::FontError> {
        self.0.layout_box(text)
    }

    fn draw<E, D: FnMut(i32, i32, BackendColor) -> Result<(), E>>(
        &self,
        text: &str,
        place: BackendCoord,
        draw: D,
    ) -> Result<Result<(), E>, Self::FontError> {
        self.0.draw(text, place, draw)
    }
}

impl Placed {
    /// As SVG: a shape that is not seen, with its title.
    fn write(&self, into: &mut String) {
        let text = escaped(&self.text);
        // Writing to a string cannot fail.
        let _ = match self.area {
            Shape::Circle((x, y), r) => {
                write!(
                    into,
                    "<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\"><title>{text}</title></circle>"
                )
            }
            Shape::Rectangle([(x0, y0), (x1, y1)]) => {
                let (x, y) = (x0.min(x1), y0.min(y1));
                let (w, h) = ((x1 - x0).abs().max(1), (y1 - y0).abs().max(1));
                write!(
                    into,
                    "<rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\"><title>{text}</title></rect>"
                )
            }
        };
        into.push('\n');
    }
}

/// `text` as it stands between tags.
pub(crate) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// Puts what listens over all else in `svg`, so that nothing is in its way.
pub(super) fn lay_over(svg: &mut String, hovers: &[Placed]) {
    const END: &str = "</svg>";
    let Some(end) = svg.rfind(END).filter(|_| !hovers.is_empty()) else { return };
    svg.truncate(end);
    svg.push_str("<g class=\"hover\" fill=\"none\" stroke=\"none\" pointer-events=\"all\">\n");
    hovers.iter().for_each(|hover| hover.write(svg));
    svg.push_str("</g>\n</svg>\n");
}

#[cfg(test)]
mod tests {
    use plotters::prelude::*;

    use super::*;
    use crate::svg;

    #[test]
    fn a_point_and_a_column_say_their_texts_where_they_are_drawn() {
        let picture = svg((200, 100), |area| {
            let mut chart = ChartBuilder::on(area).build_cartesian_2d(0.0..2.0, 0.0..1.0)?;
            chart.draw_series([Circle::new((1.0, 0.5), 3, BLACK.filled())])?;
            chart.draw_series([Hover::at((1.0, 0.5), "a < b & c")])?;
            chart.draw_series([Hover::over([(0.0, 0.0), (1.0, 1.0)], "left half")])?;
            Ok(())
        })
        .expect("a picture");
        // Of the circle that is drawn, and of the one that listens.
        let centre_with = |radius: &str| {
            let circles = picture.split("<circle ").skip(1);
            let centre = circles.filter_map(|one| one.split_once(radius)).map(|(centre, _)| centre);
            centre.last().expect("a circle of that radius").to_owned()
        };
        assert_eq!(centre_with("r=\"3\""), centre_with("r=\"7\""));
        assert!(picture.contains("r=\"7\"><title>a &lt; b &amp; c</title></circle>"), "{picture}");
        assert!(picture.contains("<title>left half</title></rect>"), "{picture}");
        assert!(picture.ends_with("</g>\n</svg>\n"), "over all else");
    }

    #[test]
    fn letters_are_never_too_small_to_be_read() {
        let picture = svg((200, 100), |area| {
            area.draw(&Text::new("small", (10, 10), ("sans-serif", 5.0)))?;
            area.draw(&Text::new("large", (10, 50), ("sans-serif", 30.0)))
        })
        .expect("a picture");
        let sizes: Vec<f64> = picture
            .split("font-size=\"")
            .skip(1)
            .filter_map(|from| from.split('"').next()?.parse().ok())
            .collect();
        assert!(sizes.len() == 2 && sizes[0] >= 11.0 && sizes[1] > 20.0, "{sizes:?}");
    }

    #[test]
    fn a_picture_without_values_has_no_group_for_them() {
        let picture = svg((20, 10), |_| Ok(())).expect("a picture");
        assert!(!picture.contains("<g"), "{picture}");
    }
}
