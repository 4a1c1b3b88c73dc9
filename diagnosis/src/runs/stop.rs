//! Two stops beside each other.

use runner::run::Summary;
use serde::Serialize;

/// A number of one run beside that of another.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Change {
    /// First and second; none where a run does not reach it.
    pub values: [Option<f64>; 2],
    /// Second less first, if both reach it.
    pub difference: Option<f64>,
    /// The same over the magnitude of the first, unless that is 0.
    pub relative: Option<f64>,
}

/// Two stops, number by number.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct StopDifference {
    /// When the later of the velocity components first came to zero (s).
    #[serde(rename = "stopping_time_s")]
    pub stopping_time: Change,
    /// Depth reached (m).
    #[serde(rename = "depth_m")]
    pub depth: Change,
    /// Horizontal distance reached (m).
    #[serde(rename = "range_m")]
    pub range: Change,
    /// When the body was at rest (s).
    #[serde(rename = "rest_time_s")]
    pub rest_time: Change,
}

impl StopDifference {
    /// How the second run stops otherwise than the first.
    pub fn between(first: &Summary, second: &Summary) -> Self {
        let [a, b] = [&first.stop, &second.stop];
        Self {
            stopping_time: Change::between(a.stopping_time_s, b.stopping_time_s),
            depth: Change::between(Some(a.depth_m), Some(b.depth_m)),
            range: Change::between(Some(a.range_m), Some(b.range_m)),
            rest_time: Change::between(a.rest_time_s, b.rest_time_s),
        }
    }
}

impl Change {
    fn between(first: Option<f64>, second: Option<f64>) -> Self {
        let difference = first.zip(second).map(|(first, second)| second - first);
        let relative = difference
            .zip(first.filter(|first| *first != 0.0))
            .map(|(difference, first)| difference / first.abs());
        Self { values: [first, second], difference, relative }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_from_nothing_is_not_relative_and_one_to_nowhere_is_none() {
        let change = Change::between(Some(-2.0), Some(-3.0));
        assert_eq!((change.difference, change.relative), (Some(-1.0), Some(-0.5)));
        assert_eq!(Change::between(Some(0.0), Some(1.0)).relative, None);
        assert_eq!(Change::between(Some(1.0), None).difference, None);
    }
}
