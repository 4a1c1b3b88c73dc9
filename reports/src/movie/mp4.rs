//! A film as MP4, by the program `ffmpeg`.

use std::ffi::OsStr;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use exchange::Stop;

use super::{Film, MovieError};

/// The program, where the path of the environment finds it.
#[derive(Clone, Debug)]
pub struct Ffmpeg(PathBuf);

/// Looks for `ffmpeg` in the folders of `path`, as of the variable `PATH`.
#[must_use]
pub fn find_ffmpeg(path: &OsStr) -> Option<Ffmpeg> {
    let programs = std::env::split_paths(path).map(|folder| folder.join("ffmpeg"));
    programs.into_iter().find(|program| program.is_file()).map(Ffmpeg)
}

impl Ffmpeg {
    /// Writes `film` to `out`.
    ///
    /// # Errors
    /// If a log cannot be read, the program fails, or `stop` says so between two pictures.
    pub fn write(&self, film: &Film<'_>, out: &Path, stop: Stop<'_>) -> Result<(), MovieError> {
        let mut child = self.start(film, out)?;
        let drawn = match child.stdin.take() {
            Some(mut into) => film.each_picture(stop, |pixels| Ok(into.write_all(&pixels.rgb)?)),
            None => Ok(()),
        };
        let said = self.end(child);
        match (drawn, said) {
            // A program that has ended takes no pictures: what it says is the reason.
            (Err(MovieError::Write(_)) | Ok(()), Err(error)) => Err(error),
            (drawn, _) => drawn,
        }
    }

    fn start(&self, film: &Film<'_>, out: &Path) -> Result<Child, MovieError> {
        let (width, height) = film.size;
        Command::new(&self.0)
            .args(["-hide_banner", "-loglevel", "error", "-nostdin", "-y"])
            .args(["-f", "rawvideo", "-pixel_format", "rgb24", "-video_size"])
            .arg(format!("{width}x{height}"))
            .args(["-framerate", &film.per_second.to_string(), "-i", "-"])
            // What every player shows; nothing of the time or the machine in the file.
            .args(["-pix_fmt", "yuv420p", "-movflags", "+faststart"])
            .args(["-fflags", "+bitexact", "-flags:v", "+bitexact", "-f", "mp4"])
            .arg(out)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|error| self.failed(error.to_string()))
    }

    fn end(&self, mut child: Child) -> Result<(), MovieError> {
        let mut said = String::new();
        if let Some(mut from) = child.stderr.take() {
            from.read_to_string(&mut said)?;
        }
        match child.wait()?.success() {
            true => Ok(()),
            false => Err(self.failed(said.trim().to_owned())),
        }
    }

    fn failed(&self, why: String) -> MovieError {
        MovieError::Ffmpeg { program: self.0.clone(), why }
    }
}
