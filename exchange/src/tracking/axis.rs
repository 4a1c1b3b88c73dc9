//! Which axis of a table the body falls along, and which way it counts, held against what is stated.

use measurements::{Fall, Frame};

use super::fault::Fault;
use super::track::Track;

/// Least ratio of an acceleration to its standard error at which a fall is seen.
const CLEAR: f64 = 10.0;

/// Whether a fall is seen.
fn is_clear(fall: Option<Fall>) -> bool {
    fall.is_some_and(|Fall { acceleration, .. }| acceleration.value > CLEAR * acceleration.se)
}

/// Refuses the stated direction of the axis, 1 for down and -1 for up, if the falls in both directions contradict it.
pub(super) fn refuse_other_way(
    track: &Track,
    sign: f64,
    [down, up]: [Option<Fall>; 2],
) -> Result<(), Fault> {
    let (stated, right, own, other) = match sign > 0.0 {
        true => ("down", "up", down, up),
        false => ("up", "down", up, down),
    };
    let speed = |fall: Option<Fall>| fall.map_or(0.0, |fall| fall.velocity);
    if is_clear(own) || !is_clear(other) || speed(own) > speed(other) {
        return Ok(());
    }
    let what = format!(
        "--{stated} is stated, and the fall says that `{}` counts {right}",
        track.vertical.name
    );
    Err(Fault::new(&track.file, what, format!("leave --{stated} out, or write --{right}")))
}

/// Refuses the path of a body that falls along the other axis of its table; `falls` are those along the vertical axis, counted
/// down and up.
pub(super) fn refuse_other(
    track: &Track,
    frames: &[Frame],
    falls: [Option<Fall>; 2],
) -> Result<(), Fault> {
    /// How many times farther the body goes along the other axis.
    const FARTHER: f64 = 3.0;
    let Some(other) = &track.forward else { return Ok(()) };
    let way = |of: fn(&Frame) -> f64| {
        let ends =
            frames.iter().map(of).fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| {
                [low.min(at), high.max(at)]
            });
        ends[1] - ends[0]
    };
    let along = |sign: f64| -> Vec<Frame> {
        frames.iter().map(|frame| Frame { z: sign * frame.x, ..*frame }).collect()
    };
    if way(|frame| frame.x) < FARTHER * way(|frame| frame.z)
        || falls.into_iter().any(is_clear)
        || ![1.0, -1.0].into_iter().any(|sign| is_clear(Fall::of_frames(&along(sign))))
    {
        return Ok(());
    }
    let (own, other) = (&track.vertical.name, &other.name);
    let what = format!("the body falls along `{other}`, and not along `{own}`");
    Err(Fault::new(&track.file, what, format!("write --column z=\"{other}\"")))
}
