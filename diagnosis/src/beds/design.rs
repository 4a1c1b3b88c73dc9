//! Which effects are on in which run of a screening: the designs of Plackett & Burman (1946, Biometrika 33,
//! 305), folded, so that no main effect is mixed up with what two effects do together.

/// First rows of the designs of so many runs; the others are its cyclic shifts, and one row of nothing.
const GENERATORS: [&str; 6] = [
    "++-",
    "+++-+--",
    "++-+++---+-",
    "++++-+-++--+---",
    "++--++++-+-+----++-",
    "+++++-+-++--++--+-+----",
];

/// For `factors` effects, which of them are on in each run: every run is followed by its mirror, in
/// which what was on is off. None for no effects, or more than 23.
pub(super) fn folded(factors: usize) -> Vec<Vec<bool>> {
    let generator = GENERATORS.iter().find(|row| factors > 0 && row.len() >= factors);
    let Some(generator) = generator.map(|row| row.as_bytes()) else { return Vec::new() };
    let n = generator.len();
    let shifted = |by: usize| -> Vec<bool> {
        (0..factors).map(|column| generator[(column + n - by) % n] == b'+').collect()
    };
    let rows = (0..n).map(shifted).chain([vec![false; factors]]);
    rows.flat_map(|row| {
        let mirror = row.iter().map(|on| !on).collect();
        [row, mirror]
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOST: usize = 23;

    #[test]
    fn main_effects_are_free_of_each_other_and_of_what_two_effects_do_together() {
        for factors in 1..=MOST {
            let runs = folded(factors);
            let sign = |run: &Vec<bool>, k: usize| if run[k] { 1 } else { -1 };
            for k in 0..factors {
                assert_eq!(runs.iter().map(|run| sign(run, k)).sum::<i32>(), 0);
                for l in 0..k {
                    let both: i32 = runs.iter().map(|run| sign(run, k) * sign(run, l)).sum();
                    assert_eq!(both, 0, "{factors} factors, {k} and {l}");
                    for m in 0..l {
                        let three = |run| sign(run, k) * sign(run, l) * sign(run, m);
                        assert_eq!(runs.iter().map(three).sum::<i32>(), 0);
                    }
                }
            }
        }
        assert!(folded(0).is_empty() && folded(MOST + 1).is_empty());
    }
}
