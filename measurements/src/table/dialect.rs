//! How a table separates its columns and writes its decimals.

/// The separators of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Dialect {
    /// Between columns.
    pub(crate) delimiter: Delimiter,
    /// Between the whole part of a number and its fraction.
    pub(crate) decimal: Decimal,
}

/// What separates columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Delimiter {
    Comma,
    Semicolon,
    Tab,
}

impl Delimiter {
    pub(crate) const ALL: [Self; 3] = [Self::Comma, Self::Semicolon, Self::Tab];

    pub(crate) fn byte(self) -> u8 {
        match self {
            Self::Comma => b',',
            Self::Semicolon => b';',
            Self::Tab => b'\t',
        }
    }

    /// How `[files] delimiter` and messages write it.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Comma => ",",
            Self::Semicolon => ";",
            Self::Tab => "tab",
        }
    }

    /// What notes call it.
    pub(crate) fn noun(self) -> &'static str {
        match self {
            Self::Comma => "commas",
            Self::Semicolon => "semicolons",
            Self::Tab => "tabs",
        }
    }

    /// The one that a header uses; `None` when it holds several.
    pub(crate) fn of_header(header: &str) -> Option<Self> {
        let mut found = Self::ALL.into_iter().filter(|one| header.as_bytes().contains(&one.byte()));
        match (found.next(), found.next()) {
            (_, Some(_)) => None,
            (found, None) => Some(found.unwrap_or(Self::Comma)),
        }
    }
}

/// What stands before the fraction of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Decimal {
    Point,
    Comma,
}

impl Decimal {
    /// The one that numbers use; the error is a number that may be read in two ways.
    pub(crate) fn of_cells<'a>(cells: impl Iterator<Item = &'a str>) -> Result<Self, String> {
        let (mut point, mut comma, mut either) = (None, None, None);
        for cell in cells {
            let slot = match evidence(cell) {
                Evidence::None => continue,
                Evidence::Both => return Err(cell.to_owned()),
                Evidence::Point => &mut point,
                Evidence::Comma => &mut comma,
                Evidence::Either => &mut either,
            };
            slot.get_or_insert(cell);
        }
        match (point, comma, either) {
            (Some(_), Some(cell), _) | (_, None, Some(cell)) => Err(cell.to_owned()),
            (None, Some(_), _) => Ok(Self::Comma),
            (_, None, None) => Ok(Self::Point),
        }
    }
}

/// What one cell says about the decimals.
enum Evidence {
    None,
    Point,
    Comma,
    /// `1,234`: one and a quarter, or more than a thousand.
    Either,
    /// `1.234,5`
    Both,
}

fn evidence(cell: &str) -> Evidence {
    let digits = cell.trim_start_matches(['+', '-']);
    let numeric = |c: char| c.is_ascii_digit() || matches!(c, ',' | '.' | 'e' | 'E' | '+' | '-');
    if !digits.starts_with(|c: char| c.is_ascii_digit() || matches!(c, ',' | '.'))
        || !digits.chars().all(numeric)
    {
        return Evidence::None;
    }
    match (digits.contains('.'), digits.split_once(',')) {
        (false, None) => Evidence::None,
        (true, None) => Evidence::Point,
        (true, Some(_)) => Evidence::Both,
        (false, Some((_, after))) if after.contains(',') => Evidence::Both,
        (false, Some((before, after))) => {
            let grouped = (1..=3).contains(&before.len()) && !before.starts_with('0');
            match grouped && after.len() == 3 {
                true => Evidence::Either,
                false => Evidence::Comma,
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_comma_is_decimal_only_where_it_cannot_group_thousands() {
        let of = |cells: &[&str]| Decimal::of_cells(cells.iter().copied());
        assert_eq!(of(&["r1", "0.5", "12", "-1e-3"]), Ok(Decimal::Point));
        assert_eq!(of(&["0,5", "1,234"]), Ok(Decimal::Comma));
        assert_eq!(of(&["0,125"]), Ok(Decimal::Comma));
        assert_eq!(of(&["1,234", "5"]), Err("1,234".to_owned()));
        assert_eq!(of(&["0,5", "0.5"]), Err("0,5".to_owned()));
        assert_eq!(of(&["1.234,5"]), Err("1.234,5".to_owned()));
        assert_eq!(of(&["1,234", "0.5"]), Err("1,234".to_owned()));
    }

    #[test]
    fn a_header_tells_the_delimiter_unless_it_holds_two() {
        assert_eq!(Delimiter::of_header("run;t;z"), Some(Delimiter::Semicolon));
        assert_eq!(Delimiter::of_header("run\tt"), Some(Delimiter::Tab));
        assert_eq!(Delimiter::of_header("run"), Some(Delimiter::Comma));
        assert_eq!(Delimiter::of_header("run;t,ms;z"), None);
    }
}
