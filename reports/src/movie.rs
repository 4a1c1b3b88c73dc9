//! Films and stills of an impact: the scenes of its page, as GIF, animated PNG, MP4, PNG or SVG.
//!
//! The same log and options give the same bytes of a GIF, a PNG and an SVG. An MP4 is made by the program `ffmpeg`.

mod gif;
mod mp4;
mod png;

use std::io::{self, Write};
use std::ops::ControlFlow;
use std::path::PathBuf;

use exchange::Stop;
use plots::PictureError;
use plots::sheet::{Pixels, Sheet};
use thiserror::Error;

use crate::scene::{Extent, Impact, Quantity, Scene, SceneError, View, height_for, sheet};

pub use mp4::{Beside, Ffmpeg, find_ffmpeg};

/// Why there is no film.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum MovieError {
    #[error(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    Picture(#[from] PictureError),
    #[error("cannot write: {0}")]
    Write(#[from] io::Error),
    #[error("a GIF has at most 65535 pixels a side, not {0} x {1}")]
    TooLarge(u32, u32),
    #[error("{} has failed: {why}", program.display())]
    Ffmpeg { program: PathBuf, why: String },
    #[error("stopped before the end")]
    Stopped,
}

/// What is filmed and how.
#[derive(Clone, Debug)]
pub struct Film<'a> {
    /// The impact.
    pub impact: &'a Impact,
    /// From where.
    pub view: View,
    /// How much of it.
    pub window: Extent,
    /// What grains are coloured by.
    pub quantity: Quantity,
    /// Width and height (pixels).
    pub size: (u32, u32),
    /// Frames of the log, in rising order.
    pub frames: Vec<usize>,
    /// How many are shown in a second.
    pub per_second: u32,
}

/// What a film is written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilmFormat {
    /// GIF.
    Gif,
    /// Animated PNG: browsers play it, other programs show its first picture.
    Png,
}

/// Width that letters are made for (pixels): a wider picture has larger ones.
const WIDTH: f64 = 640.0;

/// The size of a picture of `window` as wide as this; both sides are even, as films ask for.
pub fn size_for(window: &Extent, width: u32) -> (u32, u32) {
    let inner = f64::from(width).min(WIDTH);
    let height = f64::from(height_for(window, inner as u32)) * f64::from(width) / inner;
    let even = |side: f64| 2 * ((0.5 * side).round() as u32).max(1);
    (even(f64::from(width)), even(height))
}

impl Film<'_> {
    /// The picture of `scene`.
    pub fn sheet(&self, scene: &Scene) -> Sheet {
        let scale = (f64::from(self.size.0) / WIDTH).max(1.0);
        let (w, h) = self.size;
        let side = |side: u32| (f64::from(side) / scale).round().max(1.0) as u32;
        sheet((self.impact, &self.view), scene, self.quantity, (side(w), side(h)))
    }

    /// Writes the film in `format`.
    ///
    /// # Errors
    /// If a log cannot be read, `out` cannot be written to, or `stop` says so between two pictures.
    pub fn write(
        &self,
        format: FilmFormat,
        out: impl Write,
        stop: Stop<'_>,
    ) -> Result<(), MovieError> {
        match format {
            FilmFormat::Gif => gif::write(self, out, stop),
            FilmFormat::Png => png::write(self, out, stop),
        }
    }

    /// The scenes of its frames.
    pub fn scenes(&self) -> Result<Vec<Scene>, MovieError> {
        let mut scenes = Vec::new();
        self.impact.scenes(&self.view, &self.window, &self.frames, |scene| {
            scenes.push(scene);
            ControlFlow::Continue(())
        })?;
        Ok(scenes)
    }

    /// Hands every picture to `take`, in order.
    fn each_picture(
        &self,
        stop: Stop<'_>,
        mut take: impl FnMut(&Pixels) -> Result<(), MovieError>,
    ) -> Result<(), MovieError> {
        let mut failed = None;
        self.impact.scenes(&self.view, &self.window, &self.frames, |scene| {
            let picture = || match stop() {
                true => Err(MovieError::Stopped),
                false => Ok(self.sheet(&scene).pixels(self.size)?),
            };
            match picture().and_then(|pixels| take(&pixels)) {
                Ok(()) => ControlFlow::Continue(()),
                Err(error) => {
                    failed = Some(error);
                    ControlFlow::Break(())
                }
            }
        })?;
        failed.map_or(Ok(()), Err)
    }
}

/// A picture as PNG.
///
/// # Errors
/// If `out` cannot be written to.
pub fn write_png(pixels: &Pixels, out: impl Write) -> Result<(), MovieError> {
    png::write_one(pixels, out)
}
