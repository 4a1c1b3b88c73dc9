//! Numbers as a report shows them.

use plots::rounded;
use serde_json::Value;

/// `value` with so many digits behind the point; a dash where there is none.
pub(crate) fn fixed(value: Option<f64>, digits: usize) -> String {
    value.map_or("\u{2013}".to_owned(), |value| format!("{value:.digits$}"))
}

/// A small share of a whole; a dash where it is not known.
pub(crate) fn share(value: Option<f64>) -> String {
    value.map_or("\u{2013}".to_owned(), |value| format!("{value:.1e}"))
}

/// `value` in three digits and a unit with a prefix: 0.0123 in J is 12.3 mJ.
pub(crate) fn with_prefix(value: f64, unit: &str) -> String {
    let (factor, prefix) = prefix_of(value.abs());
    format!("{} {prefix}{unit}", plots::short(factor * value))
}

/// What a quantity up to `most` is multiplied with, and the prefix of its unit then.
pub(crate) fn prefix_of(most: f64) -> (f64, &'static str) {
    let steps = [(1e-3, 1e3, "k"), (1.0, 1.0, ""), (1e3, 1e-3, "m"), (1e6, 1e-6, "\u{b5}")];
    let fitting = steps.into_iter().find(|(_, least, _)| most >= *least);
    match fitting {
        Some((factor, _, prefix)) => (factor, prefix),
        None if most > 0.0 => (1e9, "n"),
        None => (1.0, ""),
    }
}

/// A probability as one would write it.
pub(crate) fn probability(p: Option<f64>) -> String {
    match p {
        None => "\u{2013}".to_owned(),
        Some(p) if p < 1e-4 => "< 1e-4".to_owned(),
        Some(p) if p < 0.1 => format!("{p:.4}"),
        Some(p) => format!("{p:.2}"),
    }
}

/// A number of a JSON object, to four digits, with its sign if it has one.
pub(crate) fn four_digits(value: &Value) -> String {
    match value.as_f64() {
        Some(value) => {
            let value = rounded(value, 4);
            // Zeros before the first digit, or behind the last, are not read but counted.
            let is_plain = value == 0.0 || (1e-4..1e7).contains(&value.abs());
            if is_plain { value.to_string() } else { format!("{value:e}") }
        }
        None => "\u{2013}".to_owned(),
    }
}

/// The text of a JSON string; empty where it is none.
pub(crate) fn text(value: &Value) -> String {
    value.as_str().unwrap_or_default().to_owned()
}

/// The texts of a JSON list.
pub(crate) fn texts(value: &Value) -> Vec<String> {
    list(value).iter().filter_map(Value::as_str).map(str::to_owned).collect()
}

/// The members of a JSON list; none where it is none.
pub(crate) fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_prefix_keeps_a_number_between_one_and_a_thousand() {
        assert_eq!(with_prefix(0.0644, "J"), "64.4 mJ");
        assert_eq!(with_prefix(-2.5e-7, "J"), "-250 nJ");
        assert_eq!(with_prefix(1.5, "J"), "1.5 J");
        assert_eq!(with_prefix(0.0, "J"), "0 J");
        assert_eq!(prefix_of(2.0e4), (1e-3, "k"));
    }

    #[test]
    fn what_is_not_known_is_a_dash() {
        assert_eq!(fixed(None, 2), "\u{2013}");
        assert_eq!(probability(None), "\u{2013}");
        assert_eq!(four_digits(&Value::Null), "\u{2013}");
        assert_eq!(four_digits(&serde_json::json!(0.123456)), "0.1235");
    }
}
