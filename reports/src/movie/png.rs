//! Pictures as PNG, alone or one after another.

use std::io::{self, Write};

use exchange::Stop;
use plots::sheet::Pixels;
use png::{BitDepth, ColorType, Encoder, EncodingError};

use super::{Film, MovieError};

pub(super) fn write(film: &Film<'_>, out: impl Write, stop: Stop<'_>) -> Result<(), MovieError> {
    let mut encoder = encoder(out, film.size);
    encoder.set_animated(film.frames.len() as u32, 0).map_err(failed)?;
    encoder.set_frame_delay(1, film.per_second.clamp(1, 1000) as u16).map_err(failed)?;
    let mut writer = encoder.write_header().map_err(failed)?;
    film.each_picture(stop, |pixels| writer.write_image_data(&pixels.rgb).map_err(failed))?;
    writer.finish().map_err(failed)
}

pub(super) fn write_one(pixels: &Pixels, out: impl Write) -> Result<(), MovieError> {
    let mut writer = encoder(out, pixels.size).write_header().map_err(failed)?;
    writer.write_image_data(&pixels.rgb).map_err(failed)?;
    writer.finish().map_err(failed)
}

fn encoder<W: Write>(out: W, (width, height): (u32, u32)) -> Encoder<'static, W> {
    let mut encoder = Encoder::new(out, width, height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder
}

fn failed(error: EncodingError) -> MovieError {
    MovieError::Write(match error {
        EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    })
}
