//! A film as MP4, by the program `ffmpeg`.

use std::ffi::{OsStr, OsString};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use exchange::Stop;

use super::{Film, MovieError};

/// The program, where the path of the environment finds it.
#[derive(Clone, Debug)]
pub struct Ffmpeg(PathBuf);

/// A clip of the measured impact, shown to the right of the film at the pace of the film.
#[derive(Clone, Debug)]
pub struct Beside {
    /// A file that `ffmpeg` reads.
    pub clip: PathBuf,
    /// When the body touches the bed (s of the clip as it plays).
    pub contact: f64,
    /// How many frames the camera took in a second (Hz); without it the clip plays at the pace of the impact.
    pub rate: Option<f64>,
}

/// Looks for `ffmpeg` in the folders of `path`, as of the variable `PATH`.
pub fn find_ffmpeg(path: &OsStr) -> Option<Ffmpeg> {
    let programs = std::env::split_paths(path).map(|folder| folder.join("ffmpeg"));
    programs.into_iter().find(|program| program.is_file()).map(Ffmpeg)
}

impl Ffmpeg {
    /// Writes `film` to `out`, `beside` it a clip.
    ///
    /// # Errors
    /// If a log cannot be read, the program fails, or `stop` says so between two pictures.
    pub fn write(
        &self,
        film: &Film<'_>,
        beside: Option<&Beside>,
        out: &Path,
        stop: Stop<'_>,
    ) -> Result<(), MovieError> {
        let mut child = self.start(film, beside, out)?;
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

    fn start(
        &self,
        film: &Film<'_>,
        beside: Option<&Beside>,
        out: &Path,
    ) -> Result<Child, MovieError> {
        let (width, height) = film.size;
        let mut command = Command::new(&self.0);
        command
            .args(["-hide_banner", "-loglevel", "error", "-nostdin", "-y"])
            .args(["-f", "rawvideo", "-pixel_format", "rgb24", "-video_size"])
            .arg(format!("{width}x{height}"))
            .args(["-framerate", &film.per_second.to_string(), "-i", "-"]);
        if let Some(beside) = beside {
            // A name is a file, whatever else it could mean.
            let mut clip = OsString::from("file:");
            clip.push(&beside.clip);
            command.arg("-i").arg(clip).args(["-filter_complex", &beside.filter(film), "-an"]);
        }
        command
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

impl Beside {
    /// What `ffmpeg` is to make of the two: both at contact in the same moment, the clip as high as the film, its first
    /// and last picture for as long as it has none.
    fn filter(&self, film: &Film<'_>) -> String {
        let Film { impact, size: (_, height), per_second, .. } = film;
        let [contact, ..] = impact.moments();
        let time = |at: usize| film.frames.get(at).map_or(0.0, |frame| impact.times[*frame]);
        let (first, last) = (time(0), time(film.frames.len().saturating_sub(1)));
        // Seconds of the film per second of the impact.
        let shown = film.frames.len().saturating_sub(1) as f64 / f64::from(*per_second);
        let slower = if last > first { shown / (last - first) } else { 1.0 };
        let real = match self.rate {
            Some(rate) => format!("(T-({}))*FR/{rate}", self.contact),
            None => format!("(T-({}))", self.contact),
        };
        let at_contact = (impact.times[contact] - first) * slower;
        format!(
            "[1:v]setpts=({real}*{slower}+({at_contact}))/TB,fps=fps={per_second}:start_time=0,\
             tpad=stop_mode=clone:stop=-1,scale=-2:{height},setsar=1[clip];[0:v][clip]hstack=shortest=1"
        )
    }
}
