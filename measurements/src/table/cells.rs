//! What stands in one cell.

use configs::shorten;
use engine::units::{self, Dimension};

use crate::table::dialect::Decimal;

/// A cell of a column of numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Cell {
    /// A number (SI).
    Value(f64),
    /// Nothing.
    Empty,
    /// A mark for nothing: NaN, `-`, `n/a`, `#N/A`.
    Missing,
    /// Something else, which was reported.
    Wrong,
}

/// The number in `text`, which is in SI or in the given unit.
pub(crate) fn number(
    text: &str,
    decimal: Decimal,
    unit: Option<(&str, Dimension)>,
) -> Result<Cell, String> {
    if text.is_empty() {
        return Ok(Cell::Empty);
    }
    if ["nan", "-", "n/a", "na", "#n/a"].contains(&text.to_ascii_lowercase().as_str()) {
        return Ok(Cell::Missing);
    }
    let not_a_number = || format!("\"{}\" is not a number", shorten(text));
    let point = match decimal {
        Decimal::Point => text.to_owned(),
        Decimal::Comma if text.contains('.') => return Err(not_a_number()),
        Decimal::Comma => text.replace(',', "."),
    };
    let plain: f64 = point.parse().map_err(|_| not_a_number())?;
    let value = match unit {
        None => plain,
        // Read together with its unit, 12.5 mm is the number nearest to 0.0125.
        Some((unit, dimension)) => {
            units::parse(&format!("{point} {unit}"), dimension).map_err(|_| not_a_number())?
        }
    };
    match value.is_finite() {
        true => Ok(Cell::Value(value)),
        false => Err(format!("\"{}\" is not a finite number", shorten(text))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_costs_no_rounding() {
        let mm = Some(("mm", Dimension::LENGTH));
        assert_eq!(number("12.5", Decimal::Point, mm), Ok(Cell::Value(0.0125)));
        assert_eq!(number("-0,3", Decimal::Comma, mm), Ok(Cell::Value(-0.0003)));
        assert_eq!(number("1e-3", Decimal::Point, None), Ok(Cell::Value(1e-3)));
    }

    #[test]
    fn marks_for_nothing_are_no_numbers_and_no_faults() {
        for text in ["NaN", "nan", "-", "n/a", "N/A", "#N/A", "NA"] {
            assert_eq!(number(text, Decimal::Point, None), Ok(Cell::Missing), "{text}");
        }
        assert_eq!(number("", Decimal::Point, None), Ok(Cell::Empty));
        for text in ["inf", "1e999", "12 mm", "1,5", "0x10"] {
            assert!(number(text, Decimal::Point, None).is_err(), "{text}");
        }
        assert!(number("1.5", Decimal::Comma, None).is_err());
    }
}
