//! The first screen of a run: the bed at contact, at the greatest force and at rest, and the player.

use std::ops::ControlFlow;
use std::path::Path;

use exchange::run_files::RunFiles;
use runner::run::Summary;

use super::player::Player;
use super::{Course, crater};
use crate::ReportError;
use crate::figure::panel;
use crate::page::Part;
use crate::scene::{Impact, Look, Quantity, SceneError, View, height_for, sheet};

/// Width of a still (pixels).
const STILL: u32 = 400;

/// What there is to see of a run.
#[derive(Debug)]
pub enum Seen {
    /// Its grains.
    Impact(Box<Impact>),
    /// A bed whose grains were not logged, or cannot be read; why.
    Not(String),
    /// A medium without grains.
    Nothing,
}

impl Seen {
    /// What there is to see of `run`, a folder or a log, of which `summary` and `course` tell.
    pub fn read(run: &Path, summary: &Summary, course: &Course) -> Self {
        if summary.bed.is_none() {
            return Self::Nothing;
        }
        Self::from_read(Impact::read(run, course.forces.clone()))
    }

    /// What there is to see of `run`, which has not ended.
    pub fn so_far(run: &Path, course: &Course) -> Self {
        if !RunFiles::so_far(run).grains.is_file() {
            return Self::Nothing;
        }
        match Impact::read(run, course.forces.clone()) {
            Err(SceneError::Empty { .. }) => {
                Self::Not("No frame of grains is written yet.".to_owned())
            }
            read => Self::from_read(read),
        }
    }

    fn from_read(read: Result<Impact, SceneError>) -> Self {
        match read {
            Ok(impact) => Self::Impact(Box::new(impact)),
            // Where the run is, is no part of its page.
            Err(SceneError::NotRecorded { .. }) => Self::Not(NOT_RECORDED.to_owned()),
            Err(error) => Self::Not(format!("The log of grains cannot be shown: {error}.")),
        }
    }
}

const NOT_RECORDED: &str = "The grains of this run were not recorded, so there is no picture of the bed. Run the model \
                            again with --set log.grains=true to see them here, and with --set log.frames_per_s=1000 \
                            for more frames.";

/// The pictures of the section; none of a medium without grains.
pub(super) fn parts(seen: &Seen, course: &Course) -> Result<Vec<Part>, ReportError> {
    let impact = match seen {
        Seen::Impact(impact) => impact,
        Seen::Not(why) => return Ok(vec![Part::Text(why.clone())]),
        Seen::Nothing => return Ok(Vec::new()),
    };
    let view = View::of(impact, Look::Side, None);
    let size = (STILL, height_for(&view.near, STILL));
    let moments = impact.moments();
    let mut frames = moments.to_vec();
    frames.dedup();
    let mut stills = Vec::new();
    impact.scenes(&view, &view.near, &frames, |scene| {
        let svg = sheet((impact, &view), &scene, Quantity::Speed, size).svg();
        stills.push((svg, caption(impact, scene.frame, course.end())));
        ControlFlow::Continue(())
    })?;
    let player = Player::of(impact, course)?;
    Ok(vec![
        Part::Panels(stills.into_iter().map(|(svg, caption)| panel(&svg, &caption)).collect()),
        Part::Text(words(impact, &player)),
        Part::Player { data: player.data, frame: moments[1] },
    ])
}

/// What a still shows.
fn caption(impact: &Impact, frame: usize, end: Option<f64>) -> String {
    let [contact, _, last] = impact.moments();
    let milliseconds = |time: f64| format!("{:.1} ms", 1e3 * time);
    let shown = milliseconds(impact.times[frame]);
    let when = match frame {
        frame if frame == contact => "At contact".to_owned(),
        frame if frame == last => match end.map(milliseconds).filter(|end| *end != shown) {
            Some(end) => format!("The last frame, at {shown} of {end}"),
            None => "At the end of the run".to_owned(),
        },
        _ => match impact.forces.greatest() {
            Some((time, newton)) => format!(
                "The frame at {shown}, the nearest to the greatest force of the bed, {} at {}",
                crate::numbers::with_prefix(newton, "N"),
                milliseconds(time)
            ),
            None => "In the middle of the run".to_owned(),
        },
    };
    let blue = if frame == contact { "" } else { "; blue is the path of its centre" };
    format!(
        "{when}: grains by their speed, and the force of the bed on the body as an arrow{blue}. The dashed line is the \
         undisturbed surface."
    )
}

fn words(impact: &Impact, player: &Player) -> String {
    let cut = match impact.planar {
        true => "",
        false => " From the side, the bed is cut open through the axis of the impact.",
    };
    let shown = match player.grains < impact.grains && impact.planar {
        true => format!(" The {} grains next to the impact are shown.", player.grains),
        false => String::new(),
    };
    let frames = match (player.frames, impact.times.len()) {
        (played, logged) if played == logged => format!("all of its {logged} frames"),
        (played, logged) => format!("{played} of its {logged} frames"),
    };
    format!(
        "The impact in {frames}. Colours go by the root of the quantity, so that slow motion is told from \
         rest; so do the arrows of the velocity field, which is the mean velocity of the grains of each cell between \
         neighbouring frames.{cut}{shown}"
    )
}

/// The crater, if there is one.
pub(super) fn crater(seen: &Seen) -> Result<Option<(String, String)>, ReportError> {
    let Seen::Impact(impact) = seen else { return Ok(None) };
    let [before, after] = &impact.surfaces;
    let picture = crater::picture([before, after], impact.planar)?;
    let around = match impact.planar {
        true => "averaged over intervals one mean grain diameter wide",
        false => "averaged over rings one mean grain diameter wide around the axis",
    };
    let caption = format!(
        "Crater: the surface of the bed at contact and at the end, {around}. Grains in the air do not count; negative \
         depths are the rim."
    );
    Ok(picture.map(|picture| (picture, caption)))
}
