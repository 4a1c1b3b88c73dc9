//! What the columns of a table count in.

use engine::units::{Dimension, dimension_of, parse};

/// The unit of a column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Unit {
    /// A unit of length or time that is known.
    Known(String),
    /// Pixels of a camera.
    Pixel,
    /// Frames of a camera.
    Frame,
    /// `h:mm:ss:cc` that was read as seconds.
    Clock,
    /// It is not said.
    Unstated,
    /// A word that no unit has.
    Unknown(String),
}

/// Other spellings.
const SPELLINGS: [(&str, &[&str]); 10] = [
    ("s", &["sec", "secs", "second", "seconds", "sek", "seg"]),
    ("ms", &["msec", "millisecond", "milliseconds"]),
    ("us", &["µs", "μs", "microsecond", "microseconds"]),
    ("m", &["meter", "meters", "metre", "metres"]),
    ("cm", &["centimeter", "centimeters", "centimetre", "centimetres"]),
    ("mm", &["millimeter", "millimeters", "millimetre", "millimetres"]),
    ("um", &["µm", "μm", "micron", "microns", "micrometer", "micrometers"]),
    ("inch", &["inches", "in.", "\""]),
    ("ft", &["feet", "foot"]),
    ("min", &["minute", "minutes"]),
];

/// `text` without brackets and the word `in` before a unit.
fn bare(text: &str) -> &str {
    let text = text.trim().trim_matches(['(', ')', '[', ']']).trim();
    text.strip_prefix("in ").unwrap_or(text)
}

impl Unit {
    /// The unit that `text` names; nothing is unstated.
    pub(super) fn of(text: &str) -> Self {
        let text = bare(text);
        let lower = text.to_lowercase();
        if text.is_empty() {
            return Self::Unstated;
        }
        if ["px", "pixel", "pixels", "pix"].contains(&lower.as_str()) {
            return Self::Pixel;
        }
        if ["frame", "frames", "fr", "slice", "slices"].contains(&lower.as_str()) {
            return Self::Frame;
        }
        let spelt = SPELLINGS.iter().find(|(_, others)| others.contains(&lower.as_str()));
        let name = spelt.map_or(text, |(name, _)| name);
        match dimension_of(name) {
            Some(Dimension::LENGTH | Dimension::TIME) => Self::Known(name.to_owned()),
            _ => Self::Unknown(text.to_owned()),
        }
    }

    /// The same where `text` may be something else than a unit.
    pub(super) fn maybe(text: &str) -> Option<Self> {
        match Self::of(text) {
            Self::Unknown(_) | Self::Unstated => None,
            unit => Some(unit),
        }
    }

    /// Whether `text` may be the unit of another quantity than length or time, or a mark for no unit.
    pub(super) fn is_of_others(text: &str) -> bool {
        const OTHERS: [&str; 22] = [
            "-", "1", "%", "v", "mv", "volt", "volts", "a", "ma", "hz", "khz", "deg", "°", "°c",
            "counts", "bit", "gf", "kgf", "newton", "a.u.", "adc", "g",
        ];
        let text = bare(text);
        let is_known = dimension_of(text).is_some() && !matches!(text, "t" | "T");
        is_known || text.contains(['/', '²', '^']) || OTHERS.contains(&text.to_lowercase().as_str())
    }

    /// How many of the SI unit it is, if it is a unit of `dimension`.
    pub(super) fn si(&self, dimension: Dimension) -> Option<f64> {
        match self {
            Self::Known(name) => parse(&format!("1 {name}"), dimension).ok(),
            Self::Clock if dimension == Dimension::TIME => Some(1.0),
            _ => None,
        }
    }

    /// How tables show it.
    pub(super) fn word(&self) -> &str {
        match self {
            Self::Known(name) | Self::Unknown(name) => name,
            Self::Pixel => "px",
            Self::Frame => "frames",
            Self::Clock => "h:mm:ss:cc",
            Self::Unstated => "not said",
        }
    }
}
