//! Reads a number with a unit.

use thiserror::Error;

use super::Dimension;

/// A unit that has a symbol of its own: `coefficient · 10^exponent` in SI.
pub(super) struct Atom {
    pub(super) symbol: &'static str,
    pub(super) dimension: Dimension,
    coefficient: f64,
    exponent: i32,
    /// Prefixes that it takes, in their ASCII spelling.
    pub(super) prefixes: &'static str,
}

const fn atom(
    symbol: &'static str,
    dimension: Dimension,
    coefficient: f64,
    exponent: i32,
    prefixes: &'static str,
) -> Atom {
    Atom { symbol, dimension, coefficient, exponent, prefixes }
}

const TURN_PER_MINUTE: f64 = std::f64::consts::TAU / 60.0;
const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// Whole symbols come before prefixed ones, so `min` is the minute.
pub(super) const ATOMS: &[Atom] = &[
    atom("m", Dimension::LENGTH, 1.0, 0, "numck"),
    atom("in", Dimension::LENGTH, 0.0254, 0, ""),
    atom("inch", Dimension::LENGTH, 0.0254, 0, ""),
    atom("ft", Dimension::LENGTH, 0.3048, 0, ""),
    atom("cc", Dimension::VOLUME, 1.0, -6, ""),
    atom("g", Dimension::MASS, 1.0, -3, "umk"),
    atom("t", Dimension::MASS, 1.0, 3, ""),
    atom("lb", Dimension::MASS, 0.453_592_37, 0, ""),
    atom("oz", Dimension::MASS, 0.028_349_523_125, 0, ""),
    atom("gn", Dimension::ACCELERATION, 9.80665, 0, "m"),
    atom("s", Dimension::TIME, 1.0, 0, "num"),
    atom("min", Dimension::TIME, 60.0, 0, ""),
    atom("h", Dimension::TIME, 3600.0, 0, ""),
    atom("Hz", Dimension::RATE, 1.0, 0, "kM"),
    atom("rad", Dimension::ANGLE, 1.0, 0, "m"),
    atom("deg", Dimension::ANGLE, DEGREE, 0, ""),
    atom("°", Dimension::ANGLE, DEGREE, 0, ""),
    atom("rpm", Dimension::SPIN, TURN_PER_MINUTE, 0, ""),
    atom("N", Dimension::FORCE, 1.0, 0, "numkM"),
    atom("Pa", Dimension::PRESSURE, 1.0, 0, "umkMG"),
    atom("J", Dimension::ENERGY, 1.0, 0, "numk"),
];

/// Names of a length that depends on a camera.
const PIXELS: [&str; 4] = ["px", "pixel", "pixels", "pix"];

/// As written, in ASCII, and the power of ten.
pub(super) const PREFIXES: &[(char, char, i32)] = &[
    ('n', 'n', -9),
    ('u', 'u', -6),
    ('µ', 'u', -6),
    ('μ', 'u', -6),
    ('m', 'm', -3),
    ('c', 'c', -2),
    ('k', 'k', 3),
    ('M', 'M', 6),
    ('G', 'G', 9),
];

/// Why a text is not the quantity that is wanted.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{}, expected {}; {}", self.reason(), self.wanted.name(), self.advice())]
pub struct UnitError {
    /// The text, shortened when it is long.
    pub found: String,
    /// What is wrong with it.
    pub fault: UnitFault,
    /// The dimension that is wanted.
    pub wanted: Dimension,
    number: String,
}

/// What is wrong with a text that should be a quantity.
#[derive(Clone, Debug, PartialEq)]
pub enum UnitFault {
    /// It does not begin with a number.
    NoNumber,
    /// Its decimals stand behind a comma.
    DecimalComma,
    /// There is no unit after the number.
    NoUnit,
    /// This part of the unit is not known.
    UnknownUnit(String),
    /// It has another dimension.
    Dimension(Dimension),
    /// The number is too large or too small to be represented.
    OutOfRange,
}

impl UnitError {
    /// What is wrong, as a clause.
    pub fn reason(&self) -> String {
        let found = &self.found;
        match &self.fault {
            UnitFault::NoNumber => format!("\"{found}\" does not begin with a number"),
            UnitFault::DecimalComma => format!("\"{found}\" has a decimal comma"),
            UnitFault::NoUnit => format!("\"{found}\" has no unit"),
            UnitFault::UnknownUnit(unit) => {
                format!("the unit `{unit}` in \"{found}\" is not known")
            }
            UnitFault::Dimension(other) => format!("\"{found}\" is {}", other.name()),
            UnitFault::OutOfRange => format!("\"{found}\" is out of range"),
        }
    }

    /// What to write instead, as a clause.
    pub fn advice(&self) -> String {
        match &self.fault {
            UnitFault::OutOfRange => "in SI units, 1e-307 to 1e308 is possible".to_owned(),
            UnitFault::DecimalComma => {
                format!("write \"{}\", with a decimal point", self.found.replacen(',', ".", 1))
            }
            UnitFault::UnknownUnit(unit) if PIXELS.contains(&unit.as_str()) => {
                "a pixel is as long as the scale of the camera says: multiply by that, and write mm or m"
                    .to_owned()
            }
            _ => format!("write {}", self.wanted.examples(&self.number)),
        }
    }
}

/// The SI value of `text`, a number and a unit of dimension `wanted`.
///
/// Decimal units shift the exponent of the number and are read in one rounding: `"4.46 cm"` is the
/// double nearest to 0.0446.
///
/// # Errors
/// When `text` is no finite quantity of that dimension.
pub fn parse(text: &str, wanted: Dimension) -> Result<f64, UnitError> {
    let trimmed = text.trim();
    let (digits, exponent, unit_text) = split_number(trimmed);
    let number = &trimmed[..trimmed.len() - unit_text.len()];
    let error = |fault| UnitError {
        found: shorten(trimmed),
        fault,
        wanted,
        number: match digits.is_empty() || number.len() > 24 {
            true => "3".to_owned(),
            false => number.to_owned(),
        },
    };
    if digits.is_empty() {
        return Err(error(UnitFault::NoNumber));
    }
    let unit_text = unit_text.trim();
    let comma = unit_text.strip_prefix(',').unwrap_or_default();
    if comma.starts_with(|c: char| c.is_ascii_digit()) && !comma.contains(',') {
        return Err(error(UnitFault::DecimalComma));
    }
    if unit_text.is_empty() && wanted != Dimension::NONE {
        return Err(error(UnitFault::NoUnit));
    }
    let unit =
        Unit::parse(unit_text).map_err(|part| error(UnitFault::UnknownUnit(shorten(&part))))?;
    let dimension =
        unit.dimension().ok_or_else(|| error(UnitFault::UnknownUnit(shorten(unit_text))))?;
    if dimension != wanted {
        return Err(error(UnitFault::Dimension(dimension)));
    }
    let shift = i64::from(unit.exponent_2.div_euclid(2));
    let scaled: f64 = format!("{digits}e{}", exponent.saturating_add(shift))
        .parse()
        .map_err(|_| error(UnitFault::NoNumber))?;
    let half = if unit.exponent_2.rem_euclid(2) == 1 { 10f64.sqrt() } else { 1.0 };
    let value = scaled * (unit.coefficient * half);
    let vanished = value == 0.0 && digits.bytes().any(|digit| (b'1'..=b'9').contains(&digit));
    if !value.is_finite() || vanished {
        return Err(error(UnitFault::OutOfRange));
    }
    Ok(value)
}

/// The dimension of the unit `text`, such as `kg/m`; `1` is that of a pure number. Nothing if it is no
/// unit.
pub fn dimension_of(text: &str) -> Option<Dimension> {
    let text = text.trim();
    match text.is_empty() {
        true => None,
        false => Unit::parse(text).ok()?.dimension(),
    }
}

/// Splits off the leading decimal number: its digits without exponent, the exponent, the rest.
fn split_number(text: &str) -> (&str, i64, &str) {
    let bytes = text.as_bytes();
    let run = |from: usize| bytes[from..].iter().take_while(|byte| byte.is_ascii_digit()).count();
    let sign = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
    let whole = run(sign);
    let mut end = sign + whole;
    let mut fraction = 0;
    if bytes.get(end) == Some(&b'.') {
        fraction = run(end + 1);
        end += 1 + fraction;
    }
    if whole + fraction == 0 {
        return ("", 0, text);
    }
    let digits = &text[..end];
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let length = run(end + 1 + sign);
        if length > 0 {
            let stop = end + 1 + sign + length;
            let limit = if bytes[end + 1] == b'-' { -1_000_000 } else { 1_000_000 };
            let exponent = text[end + 1..stop].parse().unwrap_or(limit);
            return (digits, exponent.clamp(-1_000_000, 1_000_000), &text[stop..]);
        }
    }
    (digits, 0, &text[end..])
}

/// A product of powers of atoms; powers are doubled as in [`Dimension`].
struct Unit {
    powers_2: [i32; 4],
    coefficient: f64,
    exponent_2: i32,
}

impl Unit {
    /// Reads `kg/m^3`, `N/m^1.5`, `N s/m`, `m/s²`, …; the error is the part that is not known.
    fn parse(text: &str) -> Result<Self, String> {
        let mut unit = Self { powers_2: [0; 4], coefficient: 1.0, exponent_2: 0 };
        let mut sign = 1;
        let mut rest = text;
        for _ in 0..16 {
            if rest.is_empty() {
                return Ok(unit);
            }
            let end = rest.find(['/', '*', '·', ' ']).unwrap_or(rest.len());
            unit.multiply(&rest[..end], sign).ok_or_else(|| rest[..end].to_owned())?;
            rest = rest[end..].trim_start();
            sign = if rest.starts_with('/') { -1 } else { 1 };
            if let Some(after) = rest.strip_prefix(['/', '*', '·']) {
                rest = after.trim_start();
                if rest.is_empty() {
                    return Err(text.to_owned());
                }
            }
        }
        Err(text.to_owned())
    }

    fn multiply(&mut self, factor: &str, sign: i32) -> Option<()> {
        let (symbol, power_2) = match factor.split_once('^') {
            Some((symbol, power)) => {
                let twice = power.parse::<f64>().ok()? * 2.0;
                let whole = twice.fract().abs() < f64::EPSILON && twice.abs() <= 16.0;
                (symbol, whole.then_some(twice as i32)?)
            }
            None => match (factor.strip_suffix('²'), factor.strip_suffix('³')) {
                (Some(symbol), _) => (symbol, 4),
                (_, Some(symbol)) => (symbol, 6),
                _ => (factor, 2),
            },
        };
        if symbol == "1" {
            return Some(());
        }
        let (atom, prefix) = find_atom(symbol)?;
        let power_2 = sign * power_2;
        let of = atom.dimension;
        let base = [of.kilogram_2, of.metre_2, of.second_2, of.radian_2];
        for (power, base) in self.powers_2.iter_mut().zip(base) {
            *power += i32::from(base) * power_2 / 2;
        }
        self.exponent_2 += (atom.exponent + prefix) * power_2;
        self.coefficient *= atom.coefficient.powi(power_2.div_euclid(2));
        if power_2.rem_euclid(2) == 1 {
            self.coefficient *= atom.coefficient.sqrt();
        }
        Some(())
    }

    fn dimension(&self) -> Option<Dimension> {
        let [kilogram, metre, second, radian] = self.powers_2;
        Some(Dimension {
            kilogram_2: kilogram.try_into().ok()?,
            metre_2: metre.try_into().ok()?,
            second_2: second.try_into().ok()?,
            radian_2: radian.try_into().ok()?,
        })
    }
}

fn find_atom(symbol: &str) -> Option<(&'static Atom, i32)> {
    if let Some(whole) = ATOMS.iter().find(|atom| atom.symbol == symbol) {
        return Some((whole, 0));
    }
    let first = symbol.chars().next()?;
    let (_, ascii, exponent) = PREFIXES.iter().find(|(spelling, ..)| *spelling == first)?;
    let stem = &symbol[first.len_utf8()..];
    let atom = ATOMS.iter().find(|atom| atom.symbol == stem && atom.prefixes.contains(*ascii))?;
    Some((atom, *exponent))
}

fn shorten(text: &str) -> String {
    match text.char_indices().nth(40) {
        Some((cut, _)) => format!("{}…", &text[..cut]),
        None => text.to_owned(),
    }
}
