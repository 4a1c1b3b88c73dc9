//! A film as GIF, with one palette for all its pictures.

use std::borrow::Cow;
use std::io::{self, Write};

use exchange::Stop;
use gif::{Encoder, EncodingError, Frame, Repeat};
use plots::sheet::{INK, PAPER, Rgb};

use super::{Film, MovieError};
use crate::scene::{BODY, LINES, PATH, STEPS, ramp};

/// Most colours of a GIF.
const COLOURS: usize = 256;

/// Bits of a channel by which colours are looked up.
const BITS: usize = 5;

pub(super) fn write(film: &Film<'_>, out: impl Write, stop: Stop<'_>) -> Result<(), MovieError> {
    let (w, h) = film.size;
    let (Ok(width), Ok(height)) = (u16::try_from(w), u16::try_from(h)) else {
        return Err(MovieError::TooLarge(w, h));
    };
    let palette = Palette::new();
    let mut encoder =
        Encoder::new(out, width, height, palette.colours.as_flattened()).map_err(failed)?;
    encoder.set_repeat(Repeat::Infinite).map_err(failed)?;
    // A GIF counts time in hundredths of a second.
    let delay = (100 / film.per_second.max(1)).clamp(1, 6000) as u16;
    film.each_picture(stop, |pixels| {
        let pixels = pixels.rgb.as_chunks::<3>().0.iter();
        let indices: Vec<u8> = pixels.map(|pixel| palette.nearest(*pixel)).collect();
        let frame = Frame { width, height, delay, buffer: Cow::Owned(indices), ..Frame::default() };
        encoder.write_frame(&frame).map_err(failed)
    })
}

fn failed(error: EncodingError) -> MovieError {
    MovieError::Write(match error {
        EncodingError::Io(error) => error,
        other => io::Error::other(other),
    })
}

/// The colours that scenes are drawn in, with what their edges are blended to, and which is nearest to any.
struct Palette {
    colours: Vec<Rgb>,
    /// By the upper bits of red, green and blue.
    nearest: Vec<u8>,
}

impl Palette {
    fn new() -> Self {
        let blend = |a: Rgb, b: Rgb, part: f64| -> Rgb {
            std::array::from_fn(|channel| {
                let [a, b] = [a, b].map(|colour| f64::from(colour[channel]));
                (a + part * (b - a)).round() as u8
            })
        };
        let steps = |n: usize| (0..n).map(move |at| at as f64 / n as f64);
        let along = |at: usize| (at as f64 / (STEPS - 1) as f64).powi(2);
        let grains = (0..STEPS).map(|at| ramp(along(at), 1.0));
        let mut colours: Vec<Rgb> =
            grains.flat_map(|of| steps(5).map(move |part| blend(of, PAPER, part))).collect();
        colours.extend(steps(32).map(|part| blend(INK, PAPER, part)));
        for of in [BODY, PATH, LINES] {
            colours.extend(steps(8).map(|part| blend(of, PAPER, part)));
        }
        colours.push(PAPER);
        debug_assert!(colours.len() <= COLOURS);
        let side = 1_usize << BITS;
        let middle = |bits: usize| ((bits << (8 - BITS)) + (1 << (7 - BITS))) as i32;
        let cells = (0..side * side * side).map(|cell| {
            let of = [cell >> (2 * BITS), (cell >> BITS) % side, cell % side].map(middle);
            let distance = |colour: &Rgb| -> i32 {
                colour.iter().zip(of).map(|(a, b)| (i32::from(*a) - b).pow(2)).sum()
            };
            let nearest = (0..colours.len()).min_by_key(|at| distance(&colours[*at]));
            nearest.unwrap_or(0) as u8
        });
        Self { nearest: cells.collect(), colours }
    }

    fn nearest(&self, [r, g, b]: Rgb) -> u8 {
        // White is most of a picture, and the middle of its cell is not white.
        if [r, g, b] == PAPER {
            return (self.colours.len() - 1) as u8;
        }
        let [r, g, b] = [r, g, b].map(|channel| usize::from(channel) >> (8 - BITS));
        self.nearest[(r << (2 * BITS)) | (g << BITS) | b]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_colours_of_grains_survive_the_palette() {
        let palette = Palette::new();
        assert!(palette.colours.len() <= COLOURS);
        for at in 0..STEPS {
            let colour = ramp((at as f64 / 31.0).powi(2), 1.0);
            let found = palette.colours[usize::from(palette.nearest(colour))];
            let off = colour.iter().zip(found).map(|(a, b)| a.abs_diff(b)).max();
            // A cell is 8 wide: its middle is off by 4, and the nearest to it by as much again.
            assert!(off <= Some(9), "{colour:?} became {found:?}");
        }
        assert_eq!(palette.colours[usize::from(palette.nearest(PAPER))], PAPER);
    }
}
