//! Mutants: wrong lines, one at a time, that some test has to notice.

/// Test programs and the tests of them that have to notice a mutant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Suite {
    pub(super) package: &'static str,
    /// A test by name, or the tests inside of the library where it is empty.
    pub(super) target: &'static str,
    /// Part of the names of the tests.
    pub(super) filter: &'static str,
}

/// What is changed in one file.
pub(super) struct Mutant {
    pub(super) number: u32,
    /// What it does, in words.
    pub(super) what: &'static str,
    pub(super) file: &'static str,
    /// What stands there once, and what in its place.
    pub(super) edits: &'static [(&'static str, &'static str)],
    pub(super) suites: &'static [Suite],
}

const fn lib(package: &'static str, filter: &'static str) -> Suite {
    Suite { package, target: "", filter }
}

const fn test(package: &'static str, target: &'static str, filter: &'static str) -> Suite {
    Suite { package, target, filter }
}

const LAWS: &[Suite] = &[lib("contact-laws", ""), test("contact-laws", "known_answers", "")];
const TWO_GRAINS: &[Suite] = &[test("contact-laws", "two_grains", "")];
const STATISTICS: &[Suite] = &[lib("diagnosis", ""), test("validation", "statistics", "")];

const LINEAR: &str = "contact-laws/src/linear_spring_dashpot.rs";
const HERTZ: &str = "contact-laws/src/hertz/constants.rs";
const PLANAR: &str = "engine/src/dimension/planar.rs";
const AT_WALLS: &str = "engine/src/at_walls.rs";

/// Numbers are not given twice: 1 to 25 are those that a reading of the code came up with.
pub(super) const MUTANTS: &[Mutant] = &[
    Mutant {
        number: 1,
        what: "tangential damping has the other sign",
        file: LINEAR,
        edits: &[(
            "let trial = -(stretched * k_t + viscous);",
            "let trial = viscous - stretched * k_t;",
        )],
        suites: LAWS,
    },
    Mutant {
        number: 2,
        what: "the spin of the second grain has the other sign in the slip",
        file: PLANAR,
        edits: &[
            ("(spin_i * arms[0] - spin_j * arms[1])", "(spin_i * arms[0] + spin_j * arms[1])"),
            (
                "(turns[0] * arms_half[0] - turns[1] * arms_half[1])",
                "(turns[0] * arms_half[0] + turns[1] * arms_half[1])",
            ),
        ],
        suites: TWO_GRAINS,
    },
    Mutant {
        number: 3,
        what: "the couple of rolling acts on one grain alone",
        file: PLANAR,
        edits: &[("-(frame.arms[1] * sheared) - response.couple[0]", "-(frame.arms[1] * sheared)")],
        suites: TWO_GRAINS,
    },
    Mutant {
        number: 4,
        what: "tangential damping is booked twice and taken from sliding",
        file: LINEAR,
        edits: &[(
            "energy.tangential_damping += half * (damped.tangential + viscous).dot(&contact.slip_step);",
            "let taken = half * (damped.tangential + viscous).dot(&contact.slip_step);\n        energy.tangential_damping += taken + taken;\n        energy.sliding -= taken;",
        )],
        suites: LAWS,
    },
    Mutant {
        number: 5,
        what: "the first cell of a periodic box does not see the last",
        file: "engine/src/neighbours.rs",
        edits: &[(
            "true if cell == 0 => [0..2, last..self.n]",
            "true if cell == 0 => [0..2, 0..0]",
        )],
        suites: TWO_GRAINS,
    },
    Mutant {
        number: 6,
        what: "a resumed run forgets what contacts of grains remember",
        file: "engine/src/contacts/mod.rs",
        edits: &[("block.pairs = saved.pairs;", "drop(saved.pairs);")],
        suites: &[test("intruders", "at_walls", "resumed")],
    },
    Mutant {
        number: 7,
        what: "the lack of fit is two-sided",
        file: "diagnosis/src/misfit/lack_of_fit.rs",
        edits: &[(
            "distribution.sf(chi2)",
            "2.0 * distribution.sf(chi2).min(1.0 - distribution.sf(chi2))",
        )],
        suites: STATISTICS,
    },
    Mutant {
        number: 8,
        what: "conditions that were held out take part in the fit",
        file: "diagnosis/src/observed/mod.rs",
        edits: &[(
            "condition.role == role && !observed",
            "(condition.role == role || role == Role::Fit) && !observed",
        )],
        suites: STATISTICS,
    },
    Mutant {
        number: 9,
        what: "Hertz's exponent is 1.375, with the energy of 1.5",
        file: HERTZ,
        edits: &[(
            "* a * overlap\n",
            "* a * overlap.map_lanes(|overlap| libm::pow(overlap, 0.875))\n",
        )],
        suites: LAWS,
    },
    Mutant {
        number: 10,
        what: "repeats weigh no more than one run",
        file: "diagnosis/src/noise/weights.rs",
        edits: &[("let runs = condition.runs.len().max(1) as f64;", "let runs = 1.0;")],
        suites: STATISTICS,
    },
    Mutant {
        number: 11,
        what: "all repeats fall on one bed",
        file: "diagnosis/src/beds/bed_model.rs",
        edits: &[("(first + at % beds) as u64", "(first + 0 * (at % beds)) as u64")],
        suites: &[test("validation", "beds", "campaign")],
    },
    Mutant {
        number: 12,
        what: "a log that cannot be written says nothing",
        file: "engine/src/record/file.rs",
        edits: &[
            (
                "self.with(|writer| writer.write_to_known_channel(&header, data))?;",
                "drop(self.with(|writer| writer.write_to_known_channel(&header, data)));",
            ),
            ("self.with(|writer| writer.flush())?;", "drop(self.with(|writer| writer.flush()));"),
            (
                "self.with(|writer| writer.finish().map(drop))?;",
                "drop(self.with(|writer| writer.finish().map(drop)));",
            ),
        ],
        suites: &[test("plunge", "runs", "kill::a_file_that_cannot_grow")],
    },
    Mutant {
        number: 13,
        what: "walls and intruder have the friction of grains",
        file: LINEAR,
        edits: &[("self.friction[partner.index()]", "self.friction[0 * partner.index()]")],
        suites: LAWS,
    },
    Mutant {
        number: 14,
        what: "Mindlin's stiffness is 7 G* a",
        file: HERTZ,
        edits: &[("R::splat(8.0 * self.shear_modulus)", "R::splat(7.0 * self.shear_modulus)")],
        suites: LAWS,
    },
    Mutant {
        number: 15,
        what: "the dashpot of rolling is half as strong",
        file: "contact-laws/src/rolling_resistance.rs",
        edits: &[(
            "R::splat(2.0 * pair.rolling_damping_ratio)",
            "R::splat(pair.rolling_damping_ratio)",
        )],
        suites: LAWS,
    },
    Mutant {
        number: 16,
        what: "rest begins at 6 % of the speed",
        file: "engine/src/stopping.rs",
        edits: &[("pub const REST_SPEED: f64 = 0.05;", "pub const REST_SPEED: f64 = 0.06;")],
        suites: &[lib("engine", "stopping")],
    },
    Mutant {
        number: 17,
        what: "tangential springs do not turn with their contact plane",
        file: "engine/src/contact/mod.rs",
        edits: &[(
            "if N == 1 {\n            return vector;",
            "if N <= 3 {\n            return vector;",
        )],
        suites: &[lib("engine", "contact::tests")],
    },
    Mutant {
        number: 18,
        what: "the resampled lack of fit is too improbable",
        file: "diagnosis/src/misfit/lack_of_fit.rs",
        edits: &[("rarest(sizes) <= own + 1", "rarest(sizes) < own")],
        suites: STATISTICS,
    },
    Mutant {
        number: 19,
        what: "the grains' energy of rotation is a tenth less",
        file: "engine/src/grain_pass.rs",
        edits: &[("sums.rotation *= 0.5;", "sums.rotation *= 0.45;")],
        suites: TWO_GRAINS,
    },
    Mutant {
        number: 20,
        what: "spheres turn as discs do",
        file: "engine/src/space.rs",
        edits: &[("Self::Spatial => 0.4,", "Self::Spatial => 0.5,")],
        suites: TWO_GRAINS,
    },
    Mutant {
        number: 21,
        what: "the error of held-out conditions is halved once an effect is named",
        file: "diagnosis/src/misfit/held_out.rs",
        edits: &[(
            "error(|(condition, _, after)| (*condition, after)),",
            "error(|(condition, _, after)| (*condition, after)).map(|error| 0.5 * error),",
        )],
        suites: STATISTICS,
    },
    Mutant {
        number: 22,
        what: "Coulomb's limit is 2 % higher",
        file: LINEAR,
        edits: &[("R::splat(pair.friction) * pressed", "R::splat(1.02 * pair.friction) * pressed")],
        suites: LAWS,
    },
    Mutant {
        number: 23,
        what: "closure is said to be 0.3 of what it is",
        file: "engine/src/simulation.rs",
        edits: &[(
            "self.world.books.ledger.closure(self.energy_scale())",
            "0.3 * self.world.books.ledger.closure(self.energy_scale())",
        )],
        suites: &[test("intruders", "at_walls", "closure")],
    },
    Mutant {
        number: 24,
        what: "the probability of naming any effect is that of naming the first",
        file: "diagnosis/src/ranking/significance.rs",
        edits: &[(
            "draw.iter().any(|score| score * score >= delta)",
            "draw.iter().take(1).any(|score| score * score >= delta)",
        )],
        suites: STATISTICS,
    },
    Mutant {
        number: 25,
        what: "probabilities of force errors are one-sided",
        file: "diagnosis/src/misfit/force_error/part.rs",
        edits: &[("{ libm::erfc((value / se)", "{ 0.5 * libm::erfc((value / se)")],
        suites: STATISTICS,
    },
    Mutant {
        number: 26,
        what: "what the intruder loses at walls is not booked",
        file: AT_WALLS,
        edits: &[("*sum += part;", "*sum += 0.0 * part;")],
        suites: &[test("intruders", "at_walls", "")],
    },
    Mutant {
        number: 27,
        what: "the intruder has the friction of grains at walls",
        file: AT_WALLS,
        edits: &[("evaluation.evaluate(Partner::Wall,", "evaluation.evaluate(Partner::Grain,")],
        suites: &[test("intruders", "at_walls", "")],
    },
    Mutant {
        number: 28,
        what: "a resumed run forgets what contacts at walls remember",
        file: AT_WALLS,
        edits: &[("self.table = table;", "drop(table);")],
        suites: &[test("intruders", "at_walls", "resumed")],
    },
    Mutant {
        number: 29,
        what: "energy that is missing does not count for closure, energy too much does",
        file: "engine/src/ledger.rs",
        edits: &[(
            "self.balance.worst.max(self.balance.unaccounted.abs())",
            "self.balance.worst.max(self.balance.unaccounted)",
        )],
        suites: &[test("intruders", "at_walls", "closure"), lib("engine", "ledger")],
    },
];
