//! Trends that other groups published, and where plunge answers to each.

use super::check::{Check, Verdict};
use super::row::Table;

/// A published trend.
struct Signature {
    /// What was dropped into what.
    system: &'static str,
    /// What was seen.
    trend: &'static str,
    /// Where.
    source: &'static str,
    /// Who answers to it.
    answer: Answer,
}

/// Who answers to a trend.
enum Answer {
    /// These rows.
    Rows(&'static str),
    /// No row, of what kind that is, and why.
    None(Verdict, &'static str),
}

/// Trends that rows answer to.
pub fn table() -> Table {
    let caption = "Published trends that rows answer to.";
    let mut table = Table::new(caption, &["system", "trend", "source", "answered by"]);
    let row = |one: &Signature| match one.answer {
        Answer::Rows(rows) => {
            Some([one.system, one.trend, one.source, rows].map(str::to_owned).to_vec())
        }
        Answer::None(..) => None,
    };
    table.rows = SIGNATURES.iter().filter_map(row).collect();
    table
}

/// Trends that no row answers to, each with the reason.
pub fn unanswered() -> Vec<Check> {
    let check = |one: &Signature| match one.answer {
        Answer::None(verdict, why) => {
            let what = format!("{}: {}", one.system, one.trend);
            Some(Check::unanswered(what, one.source, verdict, why))
        }
        Answer::Rows(_) => None,
    };
    SIGNATURES.iter().filter_map(check).collect()
}

const fn signature(
    system: &'static str,
    trend: &'static str,
    source: &'static str,
    answer: Answer,
) -> Signature {
    Signature { system, trend, source, answer }
}

const NO_AIR: Answer = Answer::None(Verdict::NotModelled, "plunge has no air flow between grains");
const NO_WATER: Answer = Answer::None(Verdict::NotModelled, "plunge has no saturated grains");
const NO_LIFT: Answer =
    Answer::None(Verdict::NotModelled, "plunge drives an intruder at a constant speed alone");
const NO_WHEELS: Answer = Answer::None(Verdict::NotModelled, "plunge has no wheels");
const NO_NUMBERS: Answer =
    Answer::None(Verdict::NotPublished, "its coefficients are not published");
const NO_MEASURE: Answer =
    Answer::None(Verdict::NotPublished, "no number says how intermittent a force has to be");
const NOT_RUN: Answer = Answer::None(Verdict::NotRun, "plunge can run it, and no row does yet");

const E1_E5: Answer = Answer::Rows("E1, E5");
const E2: Answer = Answer::Rows("E2");
const E6: Answer = Answer::Rows("E6");
const E7: Answer = Answer::Rows("E7");
const E9: Answer = Answer::Rows("E9");
const E10: Answer = Answer::Rows("E10");
const E12: Answer = Answer::Rows("E12");

static SIGNATURES: &[Signature] = &[
    signature(
        "sphere into beads",
        "the stopping time falls with speed",
        "Katsuragi & Durian 2007",
        E10,
    ),
    signature(
        "sphere into beads",
        "the deceleration jumps to zero at the stop",
        "Katsuragi & Durian 2007",
        E10,
    ),
    signature(
        "wooden sphere into beads",
        "deceleration falls through the impact; stopping time 3 d/v₀",
        "Ambroso, Kamien & Durian 2005",
        NO_NUMBERS,
    ),
    signature(
        "free link",
        "the stopping time falls with speed at 0°, 32°, 55°",
        "Marghitu & Lee 2013",
        E9,
    ),
    signature("free link", "the stopping time falls with inclination", "Marghitu & Lee 2013", E9),
    signature("two-link chain", "time falls and depth grows with speed", "two-link manuscript", E9),
    signature(
        "disc, planar, oblique",
        "the stopping time falls to a plateau above 30°",
        "Wang, Ye & Zheng 2012",
        E1_E5,
    ),
    signature(
        "disc, planar, oblique",
        "the stopping time rises linearly below 30°",
        "Wang, Ye & Zheng 2012",
        E1_E5,
    ),
    signature(
        "disc, planar, oblique",
        "depth and range are linear in the speed",
        "Wang, Ye & Zheng 2012",
        E2,
    ),
    signature(
        "cylinder, hemisphere, cone",
        "cylinder < hemisphere < cone in depth",
        "three-shape manuscript",
        E6,
    ),
    signature(
        "hemisphere",
        "friction of intruder and grains does not matter",
        "three-shape manuscript",
        E7,
    ),
    signature("sphere near a side wall", "less deep, within a diameter", "Seguin et al. 2008", E10),
    signature("sphere near the floor", "less deep, within much less", "Seguin et al. 2008", E10),
    signature(
        "cylinder near a wall",
        "moves away from it and turns",
        "Díaz-Melián et al. 2020",
        E10,
    ),
    signature("spinning sphere", "deeper with spin", "Carvalho et al. 2024", NOT_RUN),
    signature(
        "sphere into a fine loose bed",
        "air changes the impact",
        "Royer et al. 2007",
        NO_AIR,
    ),
    signature(
        "sphere into a fine bed",
        "air helps in loose beds and hinders in dense ones",
        "Royer et al. 2010",
        NO_AIR,
    ),
    signature(
        "sphere into a saturated bed",
        "less deep, same scaling",
        "arXiv:1403.8124",
        NO_WATER,
    ),
    signature(
        "sphere into a damp bed",
        "depth is no simple function of the liquid",
        "arXiv:1403.8124",
        NO_NUMBERS,
    ),
    signature(
        "sphere at 0.2–1 m/s²",
        "depth linear in speed, independent of gravity",
        "Murdoch et al. 2017",
        NOT_RUN,
    ),
    signature(
        "sphere at 0.2–1 m/s²",
        "duration independent of speed and gravity",
        "Murdoch et al. 2017",
        NOT_RUN,
    ),
    signature(
        "intruder at constant speed",
        "no depth dependence before a crossover time",
        "Roth et al. 2019",
        NOT_RUN,
    ),
    signature(
        "disc into discs, fast",
        "early peaks beyond Poncelet's law",
        "Krizou & Clark 2019",
        E12,
    ),
    signature(
        "planar intruders into discs",
        "drag comes from intermittent collisions",
        "Clark et al. 2016",
        NO_MEASURE,
    ),
    signature(
        "intruder, upward air flow",
        "friction follows the remaining load",
        "Brzinski et al. 2013",
        NO_AIR,
    ),
    signature(
        "convex intruder, slow",
        "force not linear in depth, then linear",
        "Kang et al. 2018",
        NOT_RUN,
    ),
    signature(
        "marble grazing sand",
        "friction a quarter of the sand's; rolls last",
        "Wright et al. 2020",
        NO_NUMBERS,
    ),
    signature(
        "cones",
        "blunt: peak quadratic in speed; sharp: later",
        "Williams, preprint",
        NOT_RUN,
    ),
    signature(
        "sphere, planar, no friction",
        "depth and time scale likewise",
        "Seguin et al. 2009",
        E10,
    ),
    signature("wheel, fast", "v² drag alone sinks the wrong way", "Agarwal et al. 2021", NO_WHEELS),
    signature("lifted plate", "drag grows with acceleration", "Athani & Rognon 2019", NO_LIFT),
    signature(
        "penetrometer on a beach",
        "drop height linear in depth squared",
        "Thiel et al. 2020",
        NO_NUMBERS,
    ),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_plunge_cannot_do_is_not_laid_on_the_source() {
        let verdict = |system: &str| {
            let found = unanswered().into_iter().find(|check| check.what.starts_with(system));
            found.map(|check| check.verdict)
        };
        assert_eq!(verdict("wheel, fast"), Some(Verdict::NotModelled));
        assert_eq!(verdict("spinning sphere"), Some(Verdict::NotRun));
        assert_eq!(verdict("wooden sphere into beads"), Some(Verdict::NotPublished));
    }
}
