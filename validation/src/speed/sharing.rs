//! What a second thread and a second rank add, from bed to bed: where ranks overtake threads.

use serde::Serialize;

use super::plan::Measured;
use super::spread::Spread;
use super::trial::Trial;

/// One bed on one core and on two, by wall time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Sharing {
    /// How large the bed is.
    pub grains: usize,
    /// Rate of plunge on two threads over twice that on one (–).
    pub threads: Option<f64>,
    /// The same of LAMMPS on two ranks.
    pub ranks: Option<f64>,
    /// Rate of plunge on two threads over that of LAMMPS on two ranks (–): of so many times the
    /// cores LAMMPS is as fast.
    pub threads_over_ranks: Option<f64>,
}

impl Sharing {
    /// Of the bed of `measured`; nothing if it was not stepped.
    pub(super) fn of(measured: &Measured) -> Option<Self> {
        let (peer_one, peer_two) =
            measured.first_peer().map_or((&[][..], &[][..]), |peer| (&peer.one, &peer.two));
        let [one, two, lammps_one, lammps_two] =
            [&measured.one[..], &measured.two[..], peer_one, peer_two]
                .map(|trials| Spread::of(trials.iter().map(Trial::per_wall_second)))
                .map(|rate| rate.map(|rate| rate.median));
        let share = |two: Option<f64>, one: Option<f64>| Some(two? / (2.0 * one?));
        Some(Self {
            grains: measured.one.first()?.grains,
            threads: share(two, one),
            ranks: share(lammps_two, lammps_one),
            threads_over_ranks: two.zip(lammps_two).map(|(threads, ranks)| threads / ranks),
        })
    }
}

/// From how many grains on two ranks are as fast as two threads.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case", tag = "ranks_overtake", content = "grains")]
pub enum Crossover {
    /// Already in the smallest bed.
    From(usize),
    /// In a bed of so many, between two that were measured: where a straight line over the
    /// logarithm of their sizes passes one.
    Near(usize),
    /// Not yet in the largest bed.
    NotUpTo(usize),
}

impl Crossover {
    /// From beds of one kind; nothing if ranks were not measured.
    pub(super) fn of(beds: &[Sharing]) -> Option<Self> {
        let mut ratios: Vec<(usize, f64)> =
            beds.iter().filter_map(|bed| Some((bed.grains, bed.threads_over_ranks?))).collect();
        ratios.sort_by_key(|(grains, _)| *grains);
        let (smallest, largest) = (ratios.first()?, ratios.last()?);
        if smallest.1 <= 1.0 {
            return Some(Self::From(smallest.0));
        }
        let passed = ratios.windows(2).find(|pair| pair[1].1 <= 1.0);
        let Some([(few, above), (many, below)]) = passed.and_then(|pair| pair.first_chunk()) else {
            return Some(Self::NotUpTo(largest.0));
        };
        let share = (above - 1.0) / (above - below);
        let [low, high] = [few, many].map(|grains| libm::log(*grains as f64));
        Some(Self::Near(libm::exp(low + share * (high - low)).round() as usize))
    }

    /// In words.
    pub(super) fn text(self) -> String {
        match self {
            Self::From(grains) => format!(
                "are faster than plunge's two threads from the smallest bed on, of {grains} grains"
            ),
            Self::Near(grains) => {
                format!("become faster than plunge's two threads near {grains} grains")
            }
            Self::NotUpTo(grains) => {
                format!("are slower than plunge's two threads up to {grains} grains")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bed(grains: usize, ratio: f64) -> Sharing {
        Sharing { grains, threads: None, ranks: None, threads_over_ranks: Some(ratio) }
    }

    #[test]
    fn ranks_overtake_where_the_ratio_of_rates_passes_one() {
        // Half of the way from 10^4 to 10^6 in the logarithm.
        let passing = [bed(10_000, 1.5), bed(1_000_000, 0.5)];
        assert_eq!(Crossover::of(&passing), Some(Crossover::Near(100_000)));
        let later = [bed(200_000, 1.2), bed(10_000, 2.0)];
        assert_eq!(Crossover::of(&later), Some(Crossover::NotUpTo(200_000)));
        assert_eq!(Crossover::of(&[bed(10_000, 0.9)]), Some(Crossover::From(10_000)));
    }

    #[test]
    fn without_ranks_nothing_is_said_of_them() {
        let alone = Sharing { threads_over_ranks: None, ..bed(10_000, 1.0) };
        assert_eq!(Crossover::of(&[alone]), None);
    }
}
