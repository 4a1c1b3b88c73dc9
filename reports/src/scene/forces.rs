//! The force of the ground over time, averaged over what a figure can show.

use exchange::read::BodyLoads;

/// Spans of time that a run is cut into.
const SPANS: usize = 240;

/// The force of the ground on each body, averaged over spans of time: contacts with single grains make it change
/// within a few steps.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Forces {
    /// Middles of the spans (s).
    pub time: Vec<f64>,
    /// Length of a span (s).
    pub span: f64,
    /// By body: its name and its mean force in each span (N).
    pub bodies: Vec<(String, Vec<[f64; 3]>)>,
    /// By body: the force in the first step (N).
    starts: Vec<[f64; 3]>,
    /// By body: the least and the greatest magnitude in each span (N).
    pub ranges: Vec<Vec<[f64; 2]>>,
}

impl Forces {
    /// Of the loads of a log.
    pub fn of(loads: &[BodyLoads]) -> Self {
        let times =
            || loads.iter().flat_map(|load| [load.time.first(), load.time.last()]).flatten();
        let first = times().copied().fold(f64::INFINITY, f64::min);
        let last = times().copied().fold(f64::NEG_INFINITY, f64::max);
        let most = loads.iter().map(|load| load.time.len()).max().unwrap_or(0);
        if last <= first {
            return Self::default();
        }
        // A span holds two steps or more.
        let n = SPANS.min(most / 2).max(1);
        let span = (last - first) / n as f64;
        let mut forces = Self {
            time: (0..n).map(|at| first + (at as f64 + 0.5) * span).collect(),
            span,
            ..Self::default()
        };
        for load in loads {
            let (mean, range) = averaged(load, first, span, n);
            forces.bodies.push((load.name.clone(), mean));
            forces.ranges.push(range);
            let start = load.force.first().map_or([0.0; 3], |force| [force.x, force.y, force.z]);
            forces.starts.push(start);
        }
        forces
    }

    /// The mean force on a body in the span around `time` (N), in the first step that of this step: a body that just
    /// touches bears none. None if the log has no loads of it.
    pub fn on(&self, body: &str, time: f64) -> Option<[f64; 3]> {
        let at = self.bodies.iter().position(|(name, _)| name == body)?;
        let begins = self.time.first().is_some_and(|first| time <= first - 0.5 * self.span);
        if begins {
            self.starts.get(at).copied()
        } else {
            self.bodies[at].1.get(self.place(time)).copied()
        }
    }

    /// When the sum of all forces is greatest, and how great (s, N).
    pub fn greatest(&self) -> Option<(f64, f64)> {
        let sums = self.time.iter().enumerate().map(|(at, time)| {
            let sum = self.bodies.iter().fold([0.0; 3], |sum, (_, force)| {
                [0, 1, 2].map(|axis| sum[axis] + force[at][axis])
            });
            (*time, norm(sum))
        });
        sums.fold(None, |most: Option<(f64, f64)>, next| match most {
            Some(most) if most.1 >= next.1 => Some(most),
            _ => Some(next),
        })
    }

    /// The greatest magnitude of a mean force on one body (N).
    pub fn top(&self) -> f64 {
        let all = self.bodies.iter().flat_map(|(_, force)| force);
        all.fold(0.0_f64, |top, force| top.max(norm(*force)))
    }

    fn place(&self, time: f64) -> usize {
        let first = self.time.first().map_or(0.0, |first| first - 0.5 * self.span);
        // A cast of a negative number is 0.
        (((time - first) / self.span) as usize).min(self.time.len().saturating_sub(1))
    }
}

type Averages = (Vec<[f64; 3]>, Vec<[f64; 2]>);

fn averaged(load: &BodyLoads, first: f64, span: f64, n: usize) -> Averages {
    let (mut sums, mut counts) = (vec![[0.0; 3]; n], vec![0.0_f64; n]);
    let mut ranges = vec![[f64::INFINITY, 0.0_f64]; n];
    for (time, force) in load.time.iter().zip(&load.force) {
        let at = (((time - first) / span) as usize).min(n - 1);
        let force = [force.x, force.y, force.z];
        sums[at] = [0, 1, 2].map(|axis| sums[at][axis] + force[axis]);
        counts[at] += 1.0;
        let [low, high] = ranges[at];
        ranges[at] = [low.min(norm(force)), high.max(norm(force))];
    }
    let mean = |(sum, count): (&[f64; 3], &f64)| sum.map(|sum| sum / count.max(1.0));
    let ranges = ranges.into_iter().map(|[low, high]| [low.min(high), high]).collect();
    (sums.iter().zip(&counts).map(mean).collect(), ranges)
}

pub(super) fn norm(vector: [f64; 3]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn loads() -> BodyLoads {
        let time: Vec<f64> = (0..=4800).map(|step| 1e-5 * f64::from(step)).collect();
        // A pulse of 1 ms around 20 ms, on a steady push; both shake from step to step.
        let force = time.iter().enumerate().map(|(step, t)| {
            let pulse = if (t - 0.02).abs() < 5e-4 { 10.0 } else { 2.0 };
            let shake = if step % 2 == 0 { 1.0 } else { -1.0 };
            [0.0, 0.0, pulse + shake].into()
        });
        BodyLoads { name: "ball".to_owned(), force: force.collect(), time }
    }

    #[test]
    fn means_lose_the_shaking_and_keep_the_pulse_where_it_is() {
        let forces = Forces::of(&[loads()]);
        let (time, most) = forces.greatest().expect("a force");
        // Spans of 0.2 ms: one lies within the pulse, and the shaking of 20 steps cancels but for one.
        assert!((time - 0.02).abs() < 6e-4 && (most - 10.0).abs() < 0.06, "{time} {most}");
        assert!((forces.top() - most).abs() < 1e-12, "one body");
        let [_, _, early] = forces.on("ball", 0.001).expect("a force");
        assert!((early - 2.0).abs() < 0.06, "{early}");
        assert_eq!(forces.ranges[0][10].map(f64::to_bits), [1.0_f64, 3.0].map(f64::to_bits));
        assert_eq!(forces.on("ball", 0.0), Some([0.0, 0.0, 3.0]), "the first step alone");
        assert_eq!(forces.on("cone", 0.001), None);
    }

    #[test]
    fn a_log_without_loads_has_no_forces() {
        assert_eq!(Forces::of(&[]).greatest(), None);
        assert_eq!(Forces::of(&[BodyLoads::default()]), Forces::default());
    }
}
