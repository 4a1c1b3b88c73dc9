//! Sessions of runs, from a column, a field of the name, or a date in the name.

use super::names::OF_SESSION;
use super::run::Run;

/// The session of each run. `None` if a run has none.
pub(super) fn sessions(runs: &[Run]) -> Option<Vec<String>> {
    labels(runs).or_else(|| days(runs))
}

/// A note that sessions come from dates in names.
pub(super) fn told(runs: &[Run]) -> Option<String> {
    let mut days = days(runs).filter(|_| labels(runs).is_none())?;
    days.sort();
    days.dedup();
    Some(format!("Sessions: by the {} dates in the names of runs.", days.len()))
}

fn labels(runs: &[Run]) -> Option<Vec<String>> {
    runs.iter().map(|run| labelled(run).map(str::to_owned)).collect()
}

fn labelled(run: &Run) -> Option<&str> {
    let known = |name: &String| OF_SESSION.contains(&name.as_str());
    run.labels.iter().find(|(name, _)| known(name)).map(|(_, value)| value.as_str())
}

/// The date in the name of each run. `None` if a name has no date, or if all dates are the same.
fn days(runs: &[Run]) -> Option<Vec<String>> {
    let all: Option<Vec<String>> = runs.iter().map(|run| date_in(&run.name)).collect();
    all.filter(|all| all.iter().any(|one| *one != all[0]))
}

/// The date in `name`, written year first. It reads `2024-05-06`, `2024_05_06`, `20240506` and `06.05.2024`.
fn date_in(name: &str) -> Option<String> {
    let numbers: Vec<&str> = name.split(|c: char| !c.is_ascii_digit()).collect();
    let is_year =
        |text: &str| text.len() == 4 && (text.starts_with("19") || text.starts_with("20"));
    let is_part = |text: &str, most: u32| {
        text.len() == 2 && text.parse().is_ok_and(|number: u32| (1..=most).contains(&number))
    };
    let whole = numbers.iter().find_map(|text| {
        let parts = (text.get(..4)?, text.get(4..6)?, text.get(6..8)?);
        let is_date =
            text.len() == 8 && is_year(parts.0) && is_part(parts.1, 12) && is_part(parts.2, 31);
        is_date.then_some(parts)
    });
    let in_parts = || {
        numbers.windows(3).find_map(|three| {
            let (first, month, last) = (three[0], three[1], three[2]);
            let (year, day) = if is_year(first) { (first, last) } else { (last, first) };
            (is_year(year) && is_part(month, 12) && is_part(day, 31)).then_some((year, month, day))
        })
    };
    whole.or_else(in_parts).map(|(year, month, day)| format!("{year}-{month}-{day}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_are_read_in_their_usual_forms_and_other_numbers_are_none() {
        for name in
            ["c60_2024-05-06_r1", "20240506 drop 2", "h12_06.05.2024", "IMG_20240506_101500"]
        {
            assert_eq!(date_in(name).as_deref(), Some("2024-05-06"), "{name}");
        }
        for name in ["h20_1", "2000fps_10_20", "drop 20", "2024-15-06", "12345678", "h0.2"] {
            assert_eq!(date_in(name), None, "{name}");
        }
    }
}
