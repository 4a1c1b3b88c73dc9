//! A sheet in pixels.

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};
use tiny_skia::{
    Color, FillRule, LineCap, Mask, Paint, Path, PathBuilder, Pixmap, Rect, Stroke, StrokeDash,
    Transform,
};

use super::{Anchor, INK, Layer, Mark, PAPER, Rgb, Sheet};
use crate::PictureError;

/// A picture in pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pixels {
    /// Width and height.
    pub size: (u32, u32),
    /// Red, green and blue of each pixel, in rows from the top.
    pub rgb: Vec<u8>,
}

impl Sheet {
    /// The sheet on white, scaled to the width of a picture of `size`; the same sheet gives the same bytes.
    ///
    /// # Errors
    /// If it has no pixel, or more than memory holds.
    pub fn pixels(&self, (w, h): (u32, u32)) -> Result<Pixels, PictureError> {
        let scale = f64::from(w) / f64::from(self.size.0.max(1));
        let too_large = || PictureError(format!("a picture of {w} x {h} pixels"));
        let mut painting = Painting { map: Pixmap::new(w, h).ok_or_else(too_large)?, scale };
        painting.map.fill(colour(PAPER));
        for layer in &self.layers {
            painting.layer(layer);
        }
        let opaque = painting.map.data().as_chunks::<4>().0.iter();
        Ok(Pixels { size: (w, h), rgb: opaque.flat_map(|[r, g, b, _]| [*r, *g, *b]).collect() })
    }
}

struct Painting {
    map: Pixmap,
    scale: f64,
}

impl Painting {
    fn layer(&mut self, layer: &Layer) {
        let mask = layer.clip.and_then(|[x, y, w, h]| {
            let mut mask = Mask::new(self.map.width(), self.map.height())?;
            let path = PathBuilder::from_rect(self.rect([x, y, w, h])?);
            mask.fill_path(&path, FillRule::Winding, true, Transform::identity());
            Some(mask)
        });
        for mark in &layer.marks {
            self.mark(mark, mask.as_ref());
        }
    }

    fn mark(&mut self, mark: &Mark, mask: Option<&Mask>) {
        match mark {
            Mark::Disc { centre, radius, colour } => {
                let [x, y] = self.place(*centre);
                let radius = (self.scale * radius) as f32;
                self.fill(PathBuilder::from_circle(x, y, radius), *colour, mask);
            }
            Mark::Polygon { corners, colour } => {
                let path = self.path(corners, true);
                self.fill(path.clone(), *colour, mask);
                self.stroke(path, INK, 1.0, 0.0, mask);
            }
            Mark::Box { place, colour } => {
                let path = self.rect(*place).map(PathBuilder::from_rect);
                self.fill(path, *colour, mask);
            }
            Mark::Line { points, colour, width, dash } => {
                let path = self.path(points, false);
                self.stroke(path, *colour, *width, *dash, mask);
            }
            Mark::Text { place, text, size, anchor, upright } => {
                self.text(*place, text, *size, *anchor, *upright);
            }
        }
    }

    fn place(&self, place: [f64; 2]) -> [f32; 2] {
        place.map(|value| (self.scale * value) as f32)
    }

    fn rect(&self, [x, y, w, h]: [f64; 4]) -> Option<Rect> {
        let [x, y, w, h] = [x, y, w, h].map(|value| (self.scale * value) as f32);
        Rect::from_xywh(x, y, w, h)
    }

    fn path(&self, points: &[[f64; 2]], closed: bool) -> Option<Path> {
        let mut path = PathBuilder::new();
        for (at, point) in points.iter().enumerate() {
            let [x, y] = self.place(*point);
            match at {
                0 => path.move_to(x, y),
                _ => path.line_to(x, y),
            }
        }
        if closed {
            path.close();
        }
        path.finish()
    }

    fn fill(&mut self, path: Option<Path>, rgb: Rgb, mask: Option<&Mask>) {
        if let Some(path) = path {
            self.map.fill_path(&path, &paint(rgb), FillRule::Winding, Transform::identity(), mask);
        }
    }

    fn stroke(&mut self, path: Option<Path>, rgb: Rgb, width: f64, dash: f64, mask: Option<&Mask>) {
        let dash = (self.scale * dash) as f32;
        let stroke = Stroke {
            width: (self.scale * width) as f32,
            line_cap: LineCap::Butt,
            dash: (dash > 0.0).then(|| StrokeDash::new(vec![dash, dash], 0.0)).flatten(),
            ..Stroke::default()
        };
        if let Some(path) = path {
            self.map.stroke_path(&path, &paint(rgb), &stroke, Transform::identity(), mask);
        }
    }

    /// Letters in the size of the font that comes nearest.
    fn text(&mut self, place: [f64; 2], text: &str, size: f64, anchor: Anchor, upright: bool) {
        // A box of the font is as high as letters with their leading.
        let height = nearest(1.25 * size * self.scale);
        let step = get_raster_width(FontWeight::Regular, height) as f64;
        let length = step * text.chars().count() as f64;
        let back = match anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => 0.5 * length,
            Anchor::End => length,
        };
        let [x, y] = place.map(|value| self.scale * value);
        let high = height.val() as f64;
        for (at, letter) in text.chars().enumerate() {
            let along = step * at as f64 - back;
            let Some(glyph) = get_raster(letter, FontWeight::Regular, height) else { continue };
            for (row, pixels) in glyph.rows().enumerate() {
                for (column, ink) in pixels.iter().enumerate() {
                    let (right, down) = (along + column as f64, row as f64 - 0.5 * high);
                    let at = if upright { (x + down, y - right) } else { (x + right, y + down) };
                    self.darken(at, *ink);
                }
            }
        }
    }

    /// Puts so much ink on a pixel.
    fn darken(&mut self, (x, y): (f64, f64), ink: u8) {
        let (x, y) = (x.round(), y.round());
        let (w, h) = (self.map.width() as usize, self.map.height() as usize);
        if x < 0.0 || y < 0.0 || x as usize >= w || y as usize >= h || ink == 0 {
            return;
        }
        let at = 4 * (y as usize * w + x as usize);
        for (channel, of_ink) in self.map.data_mut()[at..at + 3].iter_mut().zip(INK) {
            let (under, over) = (u32::from(*channel), u32::from(of_ink));
            *channel = ((under * (255 - u32::from(ink)) + over * u32::from(ink)) / 255) as u8;
        }
    }
}

fn nearest(height: f64) -> RasterHeight {
    match height {
        high if high < 18.0 => RasterHeight::Size16,
        high if high < 22.0 => RasterHeight::Size20,
        high if high < 28.0 => RasterHeight::Size24,
        _ => RasterHeight::Size32,
    }
}

fn colour([r, g, b]: Rgb) -> Color {
    Color::from_rgba8(r, g, b, 255)
}

fn paint(rgb: Rgb) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color(colour(rgb));
    paint
}

#[cfg(test)]
mod tests {
    use super::*;

    fn painted(marks: Vec<Mark>, clip: Option<[f64; 4]>) -> Pixels {
        Sheet { size: (40, 30), layers: vec![Layer { clip, marks }] }
            .pixels((80, 60))
            .expect("pixels")
    }

    fn dark(pixels: &Pixels) -> usize {
        pixels.rgb.as_chunks::<3>().0.iter().filter(|[r, ..]| *r < 128).count()
    }

    #[test]
    fn a_disc_covers_its_area_and_a_clip_cuts_it() {
        let disc = || vec![Mark::Disc { centre: [20.0, 15.0], radius: 10.0, colour: INK }];
        // A radius of 20 pixels; the edge adds or takes less than a pixel around.
        let area = std::f64::consts::PI * 400.0;
        let whole = painted(disc(), None);
        assert_eq!(whole.size, (80, 60));
        assert!((dark(&whole) as f64 - area).abs() < 0.02 * area, "{}", dark(&whole));
        let half = dark(&painted(disc(), Some([0.0, 0.0, 20.0, 30.0]))) as f64;
        assert!((half - 0.5 * area).abs() < 0.02 * area, "{half}");
    }

    #[test]
    fn letters_leave_ink_where_they_stand_and_upright_ones_above_it() {
        let text = |upright| Mark::Text {
            place: [20.0, 20.0],
            text: "MM".to_owned(),
            size: 8.0,
            anchor: Anchor::Start,
            upright,
        };
        let span = |pixels: &Pixels| {
            let inked = pixels.rgb.as_chunks::<3>().0.iter().enumerate();
            let inked = inked.filter(|(_, [r, ..])| *r < 128).map(|(at, _)| (at % 80, at / 80));
            inked.fold((80, 0, 60, 0), |(l, r, t, b), (x, y)| {
                (l.min(x), r.max(x), t.min(y), b.max(y))
            })
        };
        let (left, right, top, bottom) = span(&painted(vec![text(false)], None));
        assert!(
            left >= 40 && right > 48 && top >= 32 && bottom < 48,
            "{left} {right} {top} {bottom}"
        );
        let (left, right, top, bottom) = span(&painted(vec![text(true)], None));
        assert!(
            left >= 32 && right < 48 && top < 32 && bottom <= 40,
            "{left} {right} {top} {bottom}"
        );
    }
}
