//! The summary of a list of impacts.

use configs::Model;
use serde::{Deserialize, Serialize};

use super::Summary;

/// `summary.json` of a list of conditions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ListSummary {
    /// Of the model.
    pub name: String,
    /// Of the program that ran it.
    pub version: String,
    /// Of the resolved model, in hexadecimal.
    pub model_hash: String,
    /// `grains` or `resistive-force`.
    pub medium: String,
    /// One summary per impact, in their order.
    pub runs: Vec<Summary>,
    /// One per speed and angle.
    pub groups: Vec<Group>,
}

/// All positions of one speed and angle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Group {
    /// Impact speed (m/s).
    pub speed_m_per_s: f64,
    /// Angle of impact below the horizontal (deg).
    pub angle_deg: f64,
    /// Impacts.
    pub n: usize,
    /// Of [`StopSummary::depth_m`](super::StopSummary::depth_m).
    pub depth_m: Scatter,
    /// Of [`StopSummary::range_m`](super::StopSummary::range_m).
    pub range_m: Scatter,
    /// Of [`StopSummary::stopping_time_s`](super::StopSummary::stopping_time_s).
    pub stopping_time_s: Scatter,
    /// Of [`StopSummary::rest_time_s`](super::StopSummary::rest_time_s).
    pub rest_time_s: Scatter,
    /// Of [`EnergySummary::closure`](super::EnergySummary::closure).
    pub closure: Scatter,
}

/// Mean and standard deviation over the `n` runs that reached the quantity; null where too few did.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scatter {
    /// Runs that reached it.
    pub n: usize,
    /// In its unit; none without a run.
    pub mean: Option<f64>,
    /// Standard deviation, in its unit; none of fewer than two runs.
    pub sd: Option<f64>,
}

impl Scatter {
    fn of(values: &[f64]) -> Self {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
        Self {
            n: values.len(),
            mean: (!values.is_empty()).then_some(mean),
            sd: (values.len() > 1).then(|| (squares / (n - 1.0)).sqrt()),
        }
    }
}

impl ListSummary {
    /// The summaries of all conditions of `model`, in order.
    pub fn new(model: &Model, runs: Vec<Summary>) -> Self {
        let mut groups: Vec<(f64, f64, Vec<&Summary>)> = Vec::new();
        for run in &runs {
            let (speed, angle) = (run.impact.speed_m_per_s, run.impact.angle_deg);
            let same = |group: &&mut (f64, f64, Vec<&Summary>)| {
                group.0.to_bits() == speed.to_bits() && group.1.to_bits() == angle.to_bits()
            };
            match groups.iter_mut().find(same) {
                Some(group) => group.2.push(run),
                None => groups.push((speed, angle, vec![run])),
            }
        }
        let groups = groups
            .into_iter()
            .map(|(speed, angle, members)| {
                let each = |value: fn(&Summary) -> Option<f64>| {
                    Scatter::of(&members.iter().filter_map(|run| value(run)).collect::<Vec<_>>())
                };
                Group {
                    speed_m_per_s: speed,
                    angle_deg: angle,
                    n: members.len(),
                    depth_m: each(|run| Some(run.stop.depth_m)),
                    range_m: each(|run| Some(run.stop.range_m)),
                    stopping_time_s: each(|run| run.stop.stopping_time_s),
                    rest_time_s: each(|run| run.stop.rest_time_s),
                    closure: each(|run| run.energy.closure),
                }
            })
            .collect();
        Self {
            name: model.run.name.clone(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            model_hash: model.hash(),
            medium: model.medium.kind().to_owned(),
            groups,
            runs,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scatter_is_the_sample_standard_deviation() {
        let scatter = Scatter::of(&[1.0, 2.0, 3.0, 6.0]);
        assert_eq!(scatter.mean, Some(3.0));
        assert!((scatter.sd.unwrap() - (14.0_f64 / 3.0).sqrt()).abs() < 1e-15);
        assert_eq!(Scatter::of(&[]), Scatter { n: 0, mean: None, sd: None });
        assert_eq!(Scatter::of(&[4.0]), Scatter { n: 1, mean: Some(4.0), sd: None });
    }
}
