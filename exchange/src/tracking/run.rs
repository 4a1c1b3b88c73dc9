//! One drop, counted from its contact.

use measurements::{Frame, Reading};

use super::begun::Begun;
use super::bodies::Body;
use super::motion;
use super::scales::Scales;
use super::set::Understood;
use super::surface::{Seen, Touch};

/// Degrees from the vertical up to which a fall counts as vertical: cameras are not held straighter.
const UPRIGHT: f64 = 5.0;

/// The column `name` with its unit and how that was `read`, which many names have already.
fn with_unit(name: &str, (unit, read): (&str, &str)) -> String {
    let has_it = [format!("({unit})"), format!("[{unit}]")].iter().any(|one| name.ends_with(one));
    if has_it && read.is_empty() { name.to_owned() } else { format!("{name} ({unit}{read})") }
}

/// One drop.
pub(super) struct Run {
    pub(super) name: String,
    /// Its name with what else tells it apart.
    pub(super) called: String,
    pub(super) file: String,
    pub(super) fields: Vec<(String, String)>,
    pub(super) labels: Vec<(String, String)>,
    pub(super) body: Body,
    pub(super) condition: String,
    /// 1 where the axis of its table counts downward, −1 upward.
    pub(super) sign: f64,
    pub(super) touch: Touch,
    pub(super) speed: Reading,
    /// (deg); exact where the drop is straight.
    pub(super) angle: Reading,
    /// Error of one reading (m).
    pub(super) noise: f64,
    /// Time between frames (s).
    pub(super) step: f64,
    /// From contact and surface; ways too.
    pub(super) frames: Vec<Frame>,
}

impl Run {
    /// The drop `begun`, with what was understood of it.
    pub(super) fn of(
        begun: Begun,
        (scales, frames, noise): (&Scales, &[Frame], f64),
        seen: &Seen,
        touch: Touch,
    ) -> (Self, Understood) {
        let Begun { name, called, fields, labels, body, path } = begun;
        let kept = motion::kept(frames, &seen.departure.contact, noise);
        let forward = seen.departure.contact.forward;
        let has_x = path.track.forward.is_some();
        let from_vertical = libm::atan2(forward.value.abs(), touch.sinking.value).to_degrees();
        let is_oblique = has_x && from_vertical > UPRIGHT && forward.value.abs() > 4.0 * forward.se;
        let (way, speed, angle) = match is_oblique {
            true => {
                let sinking = touch.sinking;
                let value = libm::hypot(sinking.value, forward.value);
                let se = libm::hypot(sinking.value * sinking.se, forward.value * forward.se);
                let turned =
                    libm::hypot(forward.value * touch.own_speed_error, sinking.value * forward.se);
                let angle = Reading {
                    value: 90.0 - from_vertical,
                    se: (turned / value.powi(2)).to_degrees(),
                };
                (forward.value.signum(), Reading { value, se: se / value }, angle)
            }
            false => (0.0, touch.sinking, Reading { value: 90.0, se: 0.0 }),
        };
        let before: Vec<&Frame> =
            frames[kept.clone()].iter().filter(|frame| frame.t <= touch.time.value).collect();
        let start = |frame: &&&Frame| frame.x - forward.value * (frame.t - touch.time.value);
        let n = before.len().max(1) as f64;
        let origin = before.iter().map(|frame| start(&frame)).sum::<f64>() / n;
        let counted = |frame: &Frame| Frame {
            t: frame.t - touch.time.value,
            z: frame.z - touch.level.value,
            x: way * (frame.x - origin),
            sigma: None,
        };
        let rows = [path.frames.len(), kept.len()];
        let read = if scales.is_read { ", by the fall" } else { "" };
        let direction = if path.sign > 0.0 { "down" } else { "up" };
        let file = path.track.file.rsplit(['/', '\\']).next().unwrap_or_default().to_owned();
        let understood = Understood {
            layout: path.track.layout.clone(),
            rows,
            time: with_unit(&path.track.time.name, (&scales.time.0, "")),
            axis: with_unit(&path.track.vertical.name, (&scales.length.0, read)) + ", " + direction,
            run: name.clone(),
            condition: String::new(),
            contact: touch.time,
            speed,
            file: file.clone(),
        };
        let run = Self {
            name,
            called,
            file,
            fields,
            labels,
            body,
            condition: String::new(),
            sign: path.sign,
            touch,
            speed,
            angle,
            noise,
            step: seen.departure.contact.step,
            frames: frames[kept].iter().map(counted).collect(),
        };
        (run, understood)
    }
}
