//! What the texts of a dimension look like, for editors that know regular expressions and no units.

use super::Dimension;
use super::parse::{ATOMS, PREFIXES};

/// A number as [`super::parse`] takes it.
const NUMBER: &str = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?";

/// Before a unit: what begins with 1 would be read as a digit otherwise.
const BEFORE: &str = " *";
const BEFORE_ONE: &str = " +1";

/// Between two factors of a unit.
const TIMES: &str = r"(?: *[*·] *| +)";
const OVER: &str = " */ *";

/// Powers that units are written with, doubled, and how.
const POWERS: [(i8, &str); 8] = [
    (2, ""),
    (4, r"(?:\^2|²)"),
    (6, r"(?:\^3|³)"),
    (3, r"\^1\.5"),
    (1, r"\^0\.5"),
    (-2, r"\^-1"),
    (-4, r"\^-2"),
    (-6, r"\^-3"),
];

/// What is written in units of its own: others, such as the joule per newton for a length, are nobody's.
const SIMPLE: [Dimension; 4] =
    [Dimension::LENGTH, Dimension::MASS, Dimension::TIME, Dimension::ANGLE];

/// A regular expression that fits quantities of `dimension`.
///
/// It fits everything that [`super::parse`] takes as one where units are written as usual. Units of one or two
/// factors of another dimension do not fit; in a unit of more factors, the dimension is not looked at.
pub fn pattern(dimension: Dimension) -> String {
    let mut units = single(dimension);
    if !SIMPLE.contains(&dimension) {
        units.extend(pairs(dimension));
        units.push(more());
    }
    format!("^ *{NUMBER}(?:{}) *$", units.join("|"))
}

/// Units of one factor.
fn single(dimension: Dimension) -> Vec<String> {
    let fits = |(atoms, power, text): (Dimension, i8, &str)| {
        (raised(atoms, power) == Some(dimension))
            .then(|| format!("{BEFORE}{}{text}", symbols(Some(atoms))))
    };
    factors().filter_map(fits).collect()
}

/// Units of two factors, of which the first is 1 or has no power.
fn pairs(dimension: Dimension) -> Vec<String> {
    let second = |first: Dimension, before: &str| -> Option<String> {
        let mut after: Vec<String> = Vec::new();
        for (sign, between) in [(1, TIMES), (-1, OVER)] {
            let fits = factors().filter(|(atoms, power, _)| {
                *atoms != first
                    && raised(*atoms, sign * power).and_then(|two| sum(first, two))
                        == Some(dimension)
            });
            after.extend(
                fits.map(|(atoms, _, text)| format!("{between}{}{text}", symbols(Some(atoms)))),
            );
        }
        (!after.is_empty()).then(|| format!("{before}(?:{})", after.join("|")))
    };
    let first = factors().filter(|(_, power, _)| *power == 2);
    let first = first.map(|(atoms, ..)| (atoms, format!("{BEFORE}{}", symbols(Some(atoms)))));
    let one = (Dimension::NONE, BEFORE_ONE.to_owned());
    std::iter::once(one).chain(first).filter_map(|(first, text)| second(first, &text)).collect()
}

/// Units of more factors, whatever they are.
fn more() -> String {
    let factor = |one: &str, symbol: &str| format!(r"(?:{one}|{symbol})(?:\^-?[0-9.]+|²|³)?");
    let all = symbols(None);
    let first = factor(BEFORE_ONE, &format!("{BEFORE}{all}"));
    format!("{first}(?:(?:{TIMES}|{OVER}){}){{2,15}}", factor("1", &all))
}

/// Every dimension that has symbols, to every power.
fn factors() -> impl Iterator<Item = (Dimension, i8, &'static str)> {
    let mut dimensions: Vec<Dimension> = Vec::new();
    for atom in ATOMS {
        if !dimensions.contains(&atom.dimension) {
            dimensions.push(atom.dimension);
        }
    }
    dimensions
        .into_iter()
        .flat_map(|atoms| POWERS.into_iter().map(move |(power, text)| (atoms, power, text)))
}

/// The symbols of a dimension, or all of them, as one alternative.
fn symbols(dimension: Option<Dimension>) -> String {
    let wanted = ATOMS.iter().filter(|atom| dimension.is_none_or(|only| atom.dimension == only));
    let symbols: Vec<String> = wanted
        .map(|atom| {
            let prefixes: String = PREFIXES
                .iter()
                .filter(|(_, ascii, _)| atom.prefixes.contains(*ascii))
                .map(|(spelling, ..)| *spelling)
                .collect();
            match prefixes.is_empty() {
                true => atom.symbol.to_owned(),
                false => format!("[{prefixes}]?{}", atom.symbol),
            }
        })
        .collect();
    match symbols.as_slice() {
        [only] => only.clone(),
        several => format!("(?:{})", several.join("|")),
    }
}

/// `dimension` to half of `power_2`.
fn raised(dimension: Dimension, power_2: i8) -> Option<Dimension> {
    each(dimension, dimension, |own, _| {
        let doubled = own.checked_mul(power_2)?;
        (doubled % 2 == 0).then_some(doubled / 2)
    })
}

fn sum(one: Dimension, other: Dimension) -> Option<Dimension> {
    each(one, other, i8::checked_add)
}

fn each(one: Dimension, other: Dimension, of: impl Fn(i8, i8) -> Option<i8>) -> Option<Dimension> {
    Some(Dimension {
        kilogram_2: of(one.kilogram_2, other.kilogram_2)?,
        metre_2: of(one.metre_2, other.metre_2)?,
        second_2: of(one.second_2, other.second_2)?,
        radian_2: of(one.radian_2, other.radian_2)?,
    })
}
