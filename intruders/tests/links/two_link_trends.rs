//! What the two-link manuscript (`docs/validation.md`, Sources) states in words, for the chain of this crate.

use resistive::{Assembly, Ending, Recorder, State};

use super::common::{chain, down, into_sand, law};

/// Assumed: speeds (m/s) and pairs of angles (degrees). The first pair is that of equal angles.
const SPEEDS: [f64; 3] = [1.5, 2.0, 2.5];
const ANGLES: [[f64; 2]; 2] = [[30.0, -30.0], [20.0, -40.0]];

/// What may be assumed of η_d, η_h, η_v and λ: the ends of each range and a value between.
const PRIORS: [[f64; 3]; 4] =
    [[0.5, 3.0, 10.0], [1.0, 5.0, 20.0], [2.0, 10.0, 70.0], [0.8, 1.4, 1.8]];

/// The values between.
const MIDDLE: [f64; 4] = [3.0, 5.0, 10.0, 1.4];

/// Between samples (s).
const INTERVAL: f64 = 1e-4;

/// One link of a chain in an impact.
#[derive(Clone, Copy, Debug, Default)]
struct Link {
    /// Largest depth of its tip (m).
    depth: f64,
    /// From the first contact of its tip to its stop (s).
    time: f64,
    /// Energy given to the bed (J).
    given: f64,
    /// Mechanical energy lost (J).
    lost: f64,
    /// Since its contact, the time from which the static force is the greater one up to the stop (s).
    overtaken: f64,
    /// Share of the dynamic force in the sum of both magnitudes at first and at the stop.
    dynamic: [f64; 2],
}

#[derive(Clone, Copy, Debug)]
struct Outcome {
    links: [Link; 2],
    /// Largest ratio of kinetic to potential energy.
    ratio: f64,
}

impl Outcome {
    fn given(&self) -> f64 {
        self.links[0].given + self.links[1].given
    }

    fn lost(&self) -> f64 {
        self.links[0].lost + self.links[1].lost
    }
}

/// Kinetic and potential energy (J) of a link, the latter above the surface.
fn energies(assembly: &dyn Assembly, part: usize, state: &State) -> (f64, f64) {
    let [translation, rotation] = assembly.kinetic_energy(part, state);
    let (height, mass) = assembly.weight_at(part, state);
    (translation + rotation, mass * super::common::sand().gravity * height)
}

/// Nothing where the chain does not stop.
fn outcome(angles: [f64; 2], speed: f64, values: [f64; 4]) -> Option<Outcome> {
    let keys = ["drag", "horizontal", "plunging", "plunging_exponent"];
    let given: Vec<(&str, f64)> = keys.into_iter().zip(values).collect();
    let impact =
        into_sand(chain(angles.map(f64::to_radians), down(speed)), vec![law("link", &given)]);
    let assembly = impact.assembly();
    let mut samples = Vec::new();
    let mut ratio = 0.0_f64;
    let mut recorder = Recorder::new(&impact, INTERVAL, |sample| {
        let magnitudes = [0, 1].map(|part| {
            let part = &sample.parts[part];
            (part.dynamic.norm(), part.friction.norm())
        });
        let (kinetic, potential) = [0, 1]
            .map(|part| energies(assembly, part, sample.state))
            .into_iter()
            .fold((0.0, 0.0), |sum, link| (sum.0 + link.0, sum.1 + link.1));
        ratio = ratio.max(kinetic / potential.max(f64::MIN_POSITIVE));
        samples.push((sample.time, magnitudes));
    });
    let ending: Ending = impact.run(2.0, &mut recorder).expect("the impact can be followed");
    let given = *recorder.given();
    let mut links = [Link::default(); 2];
    for (part, link) in links.iter_mut().enumerate() {
        let stop = &ending.parts[part];
        let (contact, end) = (stop.contact?, stop.vertical?);
        let own: Vec<(f64, f64, f64)> = samples
            .iter()
            .filter(|(time, _)| *time > contact && *time <= end)
            .map(|(time, magnitudes)| (time - contact, magnitudes[part].0, magnitudes[part].1))
            .collect();
        let share = |(_, dynamic, friction): &(f64, f64, f64)| dynamic / (dynamic + friction);
        let before: f64 = {
            let (kinetic, potential) = energies(assembly, part, impact.start());
            kinetic + potential
        };
        let (kinetic, potential) = energies(assembly, part, &ending.state);
        *link = Link {
            depth: stop.depth,
            time: end - contact,
            given: given[part],
            lost: before - kinetic - potential,
            overtaken: own
                .iter()
                .rev()
                .find(|(_, dynamic, friction)| dynamic > friction)
                .map_or(0.0, |(time, ..)| *time),
            dynamic: [own.first().map_or(0.0, share), own.last().map_or(0.0, share)],
        };
    }
    Some(Outcome { links, ratio })
}

/// One impact per speed.
fn outcomes(angles: [f64; 2], values: [f64; 4]) -> Option<Vec<Outcome>> {
    SPEEDS.into_iter().map(|speed| outcome(angles, speed, values)).collect()
}

/// Whether what `of` says of both links rises from speed to speed.
fn rises(outcomes: &[Outcome], of: impl Fn(&Link) -> f64) -> bool {
    let links = |pair: &[Outcome]| [0, 1].map(|k| of(&pair[0].links[k]) < of(&pair[1].links[k]));
    outcomes.windows(2).all(|pair| links(pair) == [true; 2])
}

const N_TRENDS: usize = 9;

const TRENDS: [&str; N_TRENDS] = [
    "the depth of both tips rises with speed",
    "the stopping time of both tips falls with speed",
    "at equal angles each link gives half of the energy (to 1e-8)",
    "the energy given to the bed rises with speed",
    "the dynamic force is the greater one at first",
    "it stays so for a longer time at higher speed",
    "it stays so for a larger part of the stopping time at higher speed",
    "at the stop the dynamic force is below a tenth of the static one",
    "kinetic energy is at most ten times the potential energy",
];

/// Which of [`TRENDS`] hold over the speeds.
fn verdicts(angles: [f64; 2], outcomes: &[Outcome]) -> [bool; N_TRENDS] {
    let every =
        |of: &dyn Fn(&Link) -> bool| outcomes.iter().all(|outcome| outcome.links.iter().all(of));
    let equal = (angles[0] + angles[1]).abs() < 1e-12;
    let halves = |outcome: &Outcome| (outcome.links[0].given / outcome.given() - 0.5).abs() < 1e-8;
    [
        rises(outcomes, |link| link.depth),
        rises(outcomes, |link| -link.time),
        !equal || outcomes.iter().all(halves),
        outcomes.windows(2).all(|pair| pair[0].given() < pair[1].given()),
        every(&|link| link.dynamic[0] > 0.5),
        rises(outcomes, |link| link.overtaken),
        rises(outcomes, |link| link.overtaken / link.time),
        every(&|link| link.dynamic[1] < 1.0 / 11.0),
        outcomes.iter().all(|outcome| outcome.ratio <= 10.0),
    ]
}

/// Every combination of [`PRIORS`].
fn every_set() -> impl Iterator<Item = [f64; 4]> {
    (0..81_usize)
        .map(|k| std::array::from_fn(|axis| PRIORS[axis][k / 3_usize.pow(axis as u32) % 3]))
}

/// Of the 81 sets of coefficients, how many show each of [`TRENDS`], at equal and at unequal angles; `docs/validation.md`
/// has them.
const SHOW_TREND: [[usize; 2]; N_TRENDS] =
    [[81, 81], [81, 81], [81, 81], [81, 81], [81, 81], [29, 19], [81, 79], [61, 56], [74, 74]];

#[test]
fn the_middle_of_the_priors_shows_what_the_article_states_but_for_one_time() {
    for angles in ANGLES {
        let outcomes = outcomes(angles, MIDDLE).expect("the chain stops");
        for outcome in &outcomes {
            let unbalanced = outcome.given() / outcome.lost() - 1.0;
            assert!(unbalanced.abs() < 1e-8, "the links give what they lose: {unbalanced:e}");
        }
        let verdicts = verdicts(angles, &outcomes);
        for (trend, holds) in TRENDS.iter().zip(verdicts) {
            let expected = *trend != "it stays so for a longer time at higher speed";
            assert_eq!(holds, expected, "{angles:?}: {trend}: {outcomes:#?}");
        }
    }
}

#[test]
fn each_trend_holds_for_as_many_sets_of_coefficients_as_the_docs_say() {
    for (pair, angles) in ANGLES.into_iter().enumerate() {
        let mut counts = [0; N_TRENDS];
        for values in every_set() {
            let outcomes = outcomes(angles, values).expect("the chain stops");
            for (count, holds) in counts.iter_mut().zip(verdicts(angles, &outcomes)) {
                *count += usize::from(holds);
            }
        }
        assert_eq!(counts, SHOW_TREND.map(|show| show[pair]), "{angles:?}");
    }
}
