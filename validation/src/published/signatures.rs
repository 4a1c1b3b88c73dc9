//! Trends that other groups published, and where plunge answers to each.

use super::row::Table;

/// A published trend.
struct Signature {
    /// What was dropped into what.
    system: &'static str,
    /// What was seen.
    trend: &'static str,
    /// Where.
    source: &'static str,
    /// Which row checks it, or why none does.
    answered: &'static str,
}

/// Every trend, and who answers to it.
#[must_use]
pub fn table() -> Table {
    let caption = "Published trends, and what here answers to them.";
    let mut table = Table::new(caption, &["system", "trend", "source", "answered by"]);
    table.rows = SIGNATURES
        .iter()
        .map(|one| [one.system, one.trend, one.source, one.answered].map(str::to_owned).to_vec())
        .collect();
    table
}

const fn signature(
    system: &'static str,
    trend: &'static str,
    source: &'static str,
    answered: &'static str,
) -> Signature {
    Signature { system, trend, source, answered }
}

/// What a bed of dry grains cannot show.
const NO_AIR: &str = "no row: plunge has no air between grains";
const NO_WATER: &str = "no row: plunge has no saturated grains";
const NO_NUMBERS: &str = "no row: its coefficients are not published";
const NOT_RUN: &str = "no row: plunge can run it, and it is not part of this table yet";

static SIGNATURES: &[Signature] = &[
    signature(
        "sphere into beads",
        "the stopping time falls with speed",
        "Katsuragi & Durian 2007",
        "E10",
    ),
    signature(
        "sphere into beads",
        "the deceleration jumps to zero at the stop",
        "Katsuragi & Durian 2007",
        "E10",
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
        "E9",
    ),
    signature("free link", "the stopping time falls with inclination", "Marghitu & Lee 2013", "E9"),
    signature(
        "two-link chain",
        "time falls and depth grows with speed",
        "article on the chain",
        "E9",
    ),
    signature(
        "disc, planar, oblique",
        "the stopping time falls to a plateau above 30°",
        "Wang, Ye & Zheng 2012",
        "E1, E5",
    ),
    signature(
        "disc, planar, oblique",
        "the stopping time rises linearly below 30°",
        "Wang, Ye & Zheng 2012",
        "E1, E5",
    ),
    signature(
        "disc, planar, oblique",
        "depth and range are linear in the speed",
        "Wang, Ye & Zheng 2012",
        "E2",
    ),
    signature(
        "cylinder, hemisphere, cone",
        "cylinder < hemisphere < cone in depth",
        "three-shape study",
        "E6",
    ),
    signature(
        "hemisphere",
        "friction of intruder and grains does not matter",
        "three-shape study",
        "E7",
    ),
    signature(
        "sphere near a side wall",
        "less deep, within a diameter",
        "Seguin et al. 2008",
        NOT_RUN,
    ),
    signature(
        "sphere near the floor",
        "less deep, within much less",
        "Seguin et al. 2008",
        NOT_RUN,
    ),
    signature(
        "cylinder near a wall",
        "moves away from it and turns",
        "Díaz-Melián et al. 2020",
        NOT_RUN,
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
        NOT_RUN,
    ),
    signature(
        "planar intruders into discs",
        "drag comes from intermittent collisions",
        "Clark et al. 2016",
        NOT_RUN,
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
        NOT_RUN,
    ),
    signature(
        "wheel, fast",
        "v² drag alone sinks the wrong way",
        "Agarwal et al. 2021",
        "no row: plunge has no wheels",
    ),
    signature("lifted plate", "drag grows with acceleration", "Athani & Rognon 2019", NOT_RUN),
    signature(
        "penetrometer on a beach",
        "drop height linear in depth squared",
        "Thiel et al. 2020",
        NO_NUMBERS,
    ),
];
