//! Which worlds are drawn, row by row of the benchmark.

use super::design::Design;
use super::hidden::Hidden;
use super::imperfection::Imperfection;

/// Strengths of the grid: relative shift of the resting points.
pub const STRENGTHS: [f64; 3] = [0.03, 0.06, 0.12];

/// Strength of the rows that vary something else.
const MIDDLE: f64 = 0.08;

/// The first seed of a release table, drawn at random for each.
const RELEASE: u64 = (1 << 60) + 0x10b9_a087_5580;

/// Strength of each effect of a pair.
const OF_PAIR: f64 = 0.09;

/// Error of one reading in the rows of the camera (m).
pub const CAMERAS: [f64; 4] = [3e-5, 1e-4, 3e-4, 1e-3];

/// What the rows that vary the instrument hide: some of every kind, the hard ones among them.
const SAMPLE: [Hidden; 12] = [
    Hidden::ViscousDrag,
    Hidden::YieldStress,
    Hidden::Janssen,
    Hidden::DepthExponent,
    Hidden::Buoyancy,
    Hidden::AddedMass,
    Hidden::RailFriction,
    Hidden::RateFriction,
    Hidden::AnisotropicFriction,
    Hidden::Magnus,
    Hidden::Packing,
    Hidden::Lift,
];

/// What straight or single-sphere impacts hardly tell apart.
const TWINS: [Hidden; 10] = [
    Hidden::ViscousDrag,
    Hidden::YieldStress,
    Hidden::Janssen,
    Hidden::DepthExponent,
    Hidden::Buoyancy,
    Hidden::AddedMass,
    Hidden::RateFriction,
    Hidden::RailFriction,
    Hidden::Immersion,
    Hidden::DepthDrag,
];

/// What is hidden before apparatus that is not as its file says: three of the list, and one outside.
const OF_APPARATUS: [Hidden; 4] =
    [Hidden::AddedMass, Hidden::YieldStress, Hidden::Magnus, Hidden::Layer];

/// Strength of these.
const STRONG: f64 = 0.12;

/// A row of the benchmark: one thing is varied in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Row {
    /// One listed effect, full data.
    Singles,
    /// Nothing hidden, full data.
    Nulls,
    /// One effect outside the list.
    Unlisted,
    /// Two listed effects.
    Pairs,
    /// One sphere without spin.
    OneIntruder,
    /// Everything straight down.
    Vertical,
    /// One listed effect, scalars alone.
    Scalars,
    /// Nothing hidden, scalars alone.
    ScalarNulls,
    /// Other cameras.
    Camera,
    /// Beds that scatter less, or more.
    Beds,
    /// Two runs of each condition.
    Repeats,
    /// Nothing, listed effects and one outside the list, before apparatus that is not as its file says.
    Apparatus,
    /// Sets that leave several effects, with two more conditions.
    Next,
    /// Nothing, listed effects and strong ones outside the list, in beds that scatter little.
    Beyond,
}

/// Which random numbers a benchmark is drawn with.
#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Seeds {
    /// For work on the diagnosis.
    Development,
    /// For the tables; never looked at while the diagnosis is worked on.
    Release,
}

/// How much is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Size {
    /// Worlds per effect and strength; the other rows grow with it.
    pub draws: usize,
    /// Rows to draw.
    pub rows: Vec<Row>,
}

/// One world to draw.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Its row.
    pub row: Row,
    /// Its own number.
    pub seed: u64,
    /// What is measured and how.
    pub design: Design,
    /// What is hidden.
    pub hidden: Vec<Hidden>,
    /// How strong each is.
    pub strength: f64,
}

impl Row {
    /// Every row of the tables.
    pub const TABLES: [Self; 12] = [
        Self::Singles,
        Self::Nulls,
        Self::Unlisted,
        Self::Pairs,
        Self::OneIntruder,
        Self::Vertical,
        Self::Scalars,
        Self::ScalarNulls,
        Self::Camera,
        Self::Beds,
        Self::Repeats,
        Self::Apparatus,
    ];

    /// Every row: those of the tables, and what is drawn only where it is asked for.
    pub fn all() -> impl Iterator<Item = Self> {
        Self::TABLES.into_iter().chain([Self::Next, Self::Beyond])
    }

    /// Name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Singles => "singles",
            Self::Nulls => "nulls",
            Self::Unlisted => "unlisted",
            Self::Pairs => "pairs",
            Self::OneIntruder => "one-intruder",
            Self::Vertical => "vertical",
            Self::Scalars => "scalars",
            Self::ScalarNulls => "scalar-nulls",
            Self::Camera => "camera",
            Self::Beds => "beds",
            Self::Repeats => "repeats",
            Self::Apparatus => "apparatus",
            Self::Next => "next",
            Self::Beyond => "beyond",
        }
    }
}

impl Size {
    /// The grid of the tables.
    pub fn full() -> Self {
        Self { draws: 3, rows: Row::TABLES.to_vec() }
    }

    /// A third of the main rows: a first impression in two minutes.
    pub fn quick() -> Self {
        Self { draws: 1, rows: vec![Row::Singles, Row::Nulls, Row::Unlisted] }
    }

    /// The worlds to draw. A world depends on its place in the grid, not on the size of it.
    pub fn plans(&self, seeds: Seeds) -> Vec<Plan> {
        self.rows.iter().flat_map(|&row| self.row(Drawer { row, seeds })).collect()
    }

    /// `many` of a grid of three draws, in a grid of as many as are asked for.
    fn share(&self, many: usize) -> usize {
        (many * self.draws).div_ceil(3)
    }

    fn row(&self, drawer: Drawer) -> Vec<Plan> {
        let full = Design::full();
        match drawer.row {
            Row::Singles => self.grid(drawer, &full, self.draws),
            Row::Scalars => self.grid(drawer, &Design::scalars(), self.share(1)),
            Row::Nulls => drawer.nothing(&full, self.share(100)),
            Row::ScalarNulls => drawer.nothing(&Design::scalars(), self.share(60)),
            Row::Unlisted => self.unlisted(drawer, &full),
            Row::Pairs => drawer.pairs(&full, self.share(40)),
            Row::OneIntruder => {
                let acts = |hidden: &Hidden| !hidden.needs_spin() && *hidden != Hidden::Packing;
                drawer.each(0, Hidden::listed().filter(acts), &Design::one_intruder())
            }
            Row::Vertical => {
                let acts = |hidden: &Hidden| !hidden.needs_spin() && !hidden.needs_oblique();
                drawer.each(0, Hidden::listed().filter(acts), &Design::vertical())
            }
            Row::Camera => {
                self.variants(drawer, CAMERAS.map(|camera| Design { camera, ..full.clone() }))
            }
            Row::Beds => {
                let bed = |coefficient_scatter, path_scatter| Design {
                    coefficient_scatter,
                    path_scatter,
                    ..full.clone()
                };
                self.variants(drawer, [bed(0.02, 0.05), bed(0.10, 0.25)])
            }
            Row::Repeats => {
                self.variants(drawer, [2, 5].map(|repeats| Design { repeats, ..full.clone() }))
            }
            Row::Apparatus => self.apparatus(drawer, &full),
            Row::Beyond => self.beyond(drawer, &full),
            Row::Next => {
                let designs = [Design::vertical(), Design::one_intruder()];
                // One in three of these leaves several effects: eighty sets to be extended.
                let draws = 0..self.share(13);
                // Every set is a world of its own, whichever design it is seen through.
                draws
                    .flat_map(|draw| designs.iter().enumerate().map(move |two| (draw, two)))
                    .flat_map(|(draw, (at, design))| {
                        drawer.each(2 * draw + at, TWINS.into_iter(), design)
                    })
                    .collect()
            }
        }
    }

    /// Every effect that no list has, at two strengths.
    fn unlisted(&self, drawer: Drawer, full: &Design) -> Vec<Plan> {
        let mut plans = Vec::new();
        for (kind, hidden) in drawer.unlisted().enumerate() {
            for (level, strength) in [0.06, 0.12].into_iter().enumerate() {
                for draw in 0..self.share(4) {
                    plans.push(drawer.plan([kind, level, draw], full, (&[hidden], strength)));
                }
            }
        }
        plans
    }

    /// Nothing and four effects before every apparatus that is not as its file says.
    fn apparatus(&self, drawer: Drawer, full: &Design) -> Vec<Plan> {
        let mut plans = Vec::new();
        for (at, imperfection) in Imperfection::ALL.into_iter().enumerate() {
            let design = Design {
                imperfection,
                coefficient_scatter: 0.03,
                path_scatter: 0.08,
                ..full.clone()
            };
            for draw in 0..self.share(10) {
                plans.push(drawer.plan([at, 0, draw], &design, (&[], 0.0)));
                for (kind, hidden) in OF_APPARATUS.into_iter().enumerate() {
                    let place = [at, kind + 1, draw];
                    plans.push(drawer.plan(place, &design, (&[hidden], STRONG)));
                }
            }
        }
        plans
    }

    /// Strong effects that no list has, nothing, and listed effects, in beds that scatter little.
    fn beyond(&self, drawer: Drawer, full: &Design) -> Vec<Plan> {
        let design = Design { coefficient_scatter: 0.02, path_scatter: 0.05, ..full.clone() };
        let mut plans = Vec::new();
        for draw in 0..self.share(3) {
            for (kind, hidden) in drawer.unlisted().enumerate() {
                for (level, strength) in BEYOND.into_iter().enumerate() {
                    let place = [kind, level, draw];
                    plans.push(drawer.plan(place, &design, (&[hidden], strength)));
                }
            }
            let none = (0..NOTHING).map(|at| [NONE, at, draw]);
            plans.extend(none.map(|place| drawer.plan(place, &design, (&[], 0.0))));
            let listed = Hidden::listed().filter(|hidden| !hidden.is_of_apparatus());
            plans.extend(listed.enumerate().map(|(at, hidden)| {
                drawer.plan([LISTED, at, draw], &design, (&[hidden], BEYOND[0]))
            }));
        }
        plans
    }

    /// Every listed effect at every strength.
    fn grid(&self, drawer: Drawer, design: &Design, draws: usize) -> Vec<Plan> {
        let mut plans = Vec::new();
        for (level, strength) in STRENGTHS.into_iter().enumerate() {
            for (kind, hidden) in Hidden::listed().enumerate() {
                for draw in 0..draws {
                    plans.push(drawer.plan([kind, level, draw], design, (&[hidden], strength)));
                }
            }
        }
        plans
    }

    /// The sample before each of `designs`; the worlds are the same before all of them.
    fn variants(&self, drawer: Drawer, designs: impl IntoIterator<Item = Design>) -> Vec<Plan> {
        let designs: Vec<Design> = designs.into_iter().collect();
        let draws = 0..self.share(1);
        let each = designs.iter();
        each.flat_map(|design| {
            draws.clone().flat_map(move |draw| drawer.each(draw, SAMPLE.into_iter(), design))
        })
        .collect()
    }
}

/// Strengths of what no list has, where a formula is asked for.
const BEYOND: [f64; 2] = [0.12, 0.24];

/// Sets without anything beside these, by draw; and places in the grid for them and for listed effects.
const NOTHING: usize = 12;
const NONE: usize = 100;
const LISTED: usize = 101;

/// Draws the worlds of one row.
#[derive(Clone, Copy)]
struct Drawer {
    row: Row,
    seeds: Seeds,
}

impl Drawer {
    /// The world at `place` of the grid of the row.
    fn plan(
        self,
        place: [usize; 3],
        design: &Design,
        (hidden, strength): (&[Hidden], f64),
    ) -> Plan {
        let seed = place
            .into_iter()
            .fold(self.row as u64 + 1, |number, index| 1000 * number + index as u64);
        let stream = match self.seeds {
            Seeds::Development => 0,
            Seeds::Release => RELEASE,
        };
        Plan {
            row: self.row,
            seed: stream + seed,
            design: design.clone(),
            hidden: hidden.to_vec(),
            strength,
        }
    }

    /// Effects outside the list that are drawn with these seeds.
    fn unlisted(self) -> impl Iterator<Item = Hidden> {
        let is_release = self.seeds == Seeds::Release;
        Hidden::unlisted().filter(move |hidden| is_release || !hidden.is_for_release())
    }

    fn nothing(self, design: &Design, count: usize) -> Vec<Plan> {
        (0..count).map(|draw| self.plan([0, 0, draw], design, (&[], 0.0))).collect()
    }

    fn each(
        self,
        draw: usize,
        effects: impl Iterator<Item = Hidden>,
        design: &Design,
    ) -> Vec<Plan> {
        effects
            .map(|hidden| self.plan([hidden as usize, 0, draw], design, (&[hidden], MIDDLE)))
            .collect()
    }

    /// Pairs of listed effects: every one is in about as many as any other.
    fn pairs(self, design: &Design, count: usize) -> Vec<Plan> {
        let listed: Vec<Hidden> = Hidden::listed().collect();
        let n = listed.len();
        (0..count)
            .map(|draw| {
                // Steps of 1, 2, 3, … around the circle of effects: no pair comes twice.
                let (first, step) = (draw % n, 1 + draw / n + 3 * (draw % 3));
                let both = [listed[first], listed[(first + step) % n]];
                self.plan([1, 0, draw], design, (&both, OF_PAIR))
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_worlds_of_a_row_share_their_numbers_but_those_before_several_designs() {
        for seeds in [Seeds::Development, Seeds::Release] {
            let plans = Size::full().plans(seeds);
            for (at, plan) in plans.iter().enumerate() {
                for other in &plans[..at] {
                    let same_world = plan.hidden == other.hidden && plan.design != other.design;
                    assert!(plan.seed != other.seed || same_world, "{plan:?} {other:?}");
                }
            }
        }
    }

    #[test]
    fn seeds_for_development_and_for_release_are_disjoint() {
        let of = |seeds| Size::full().plans(seeds).into_iter().map(|plan| plan.seed);
        let development: Vec<u64> = of(Seeds::Development).collect();
        assert!(of(Seeds::Release).all(|seed| !development.contains(&seed)));
    }

    #[test]
    fn a_smaller_grid_is_a_part_of_the_larger_one() {
        let full = Size::full().plans(Seeds::Development);
        let quick = Size::quick().plans(Seeds::Development);
        assert!(quick.iter().all(|plan| full.contains(plan)));
        assert!(quick.len() < full.len() && full.len() <= 1300, "{}", full.len());
    }

    #[test]
    fn sets_to_be_extended_are_drawn_only_where_they_are_asked_for() {
        let size = Size { draws: 3, rows: vec![Row::Next] };
        assert_eq!(size.plans(Seeds::Development).len(), 260);
        let tables = Size::full().plans(Seeds::Development);
        assert!(tables.iter().all(|plan| plan.row != Row::Next));
    }

    #[test]
    fn forty_pairs_are_forty_different_pairs_of_two_different_effects() {
        let size = Size { draws: 3, rows: vec![Row::Pairs] };
        let mut pairs: Vec<Vec<Hidden>> = size
            .plans(Seeds::Development)
            .into_iter()
            .map(|plan| {
                let mut pair = plan.hidden;
                pair.sort();
                pair
            })
            .collect();
        pairs.sort();
        pairs.dedup();
        assert_eq!(pairs.len(), 40);
        assert!(pairs.iter().all(|pair| pair[0] != pair[1]));
    }
}
