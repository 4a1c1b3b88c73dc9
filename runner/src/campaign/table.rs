//! The results of a campaign as one table, a row per point.

use engine::units::significant;
use std::collections::{BTreeMap, BTreeSet};

use super::done::Headline;
use super::plan::split;
use super::results::{Outcome, Results};

/// Name of the table in the folder of a campaign.
pub const FILE: &str = "results.parquet";

/// A column under its name, which has its unit.
#[derive(Clone, Debug, PartialEq)]
pub struct TableColumn {
    /// Its name.
    pub name: String,
    /// Its cells, as many as every other column has.
    pub cells: Cells,
}

/// What a column holds; a cell without a value is empty.
#[derive(Clone, Debug, PartialEq)]
pub enum Cells {
    /// Quantities.
    Numbers(Vec<Option<f64>>),
    /// Whole numbers.
    Counts(Vec<Option<i64>>),
    /// Texts.
    Texts(Vec<Option<String>>),
    /// Yes or no.
    Flags(Vec<Option<bool>>),
}

/// A key of the models that is not the same at all points, and its values.
#[derive(Clone, Debug, PartialEq)]
pub struct Varied {
    /// The key with its tables.
    pub key: String,
    /// The unit of all values, as written; none of pure numbers and of words.
    pub unit: Option<String>,
    /// The values of all points, in the order of the plan.
    pub values: Values,
}

/// The values of a key.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Numbers in one unit; none where a point leaves the model's own.
    Numbers(Vec<Option<f64>>),
    /// Whatever else, as TOML.
    Texts(Vec<Option<String>>),
}

/// The keys that differ between points, in the order in which points set them.
pub fn varied(results: &Results) -> Vec<Varied> {
    let points = &results.plan.points;
    let mut keys: Vec<&str> = Vec::new();
    let mut known = BTreeSet::new();
    for assignment in points.iter().flat_map(|point| &point.set) {
        let key = split(assignment).0;
        if known.insert(key) {
            keys.push(key);
        }
    }
    let by_point: Vec<BTreeMap<&str, &str>> = points
        .iter()
        .map(|point| point.set.iter().map(|assignment| split(assignment)).collect())
        .collect();
    let column = |key: &&str| {
        let values: Vec<Option<&str>> = by_point.iter().map(|set| set.get(key).copied()).collect();
        let differs = values.iter().any(|value| *value != values[0]);
        differs.then(|| Varied::of(key, &values))
    };
    keys.iter().filter_map(column).collect()
}

/// The table: which point it is, what was varied, how it ended, and its numbers.
pub fn columns(results: &Results) -> Vec<TableColumn> {
    let points = &results.plan.points;
    let texts =
        |of: &dyn Fn(usize) -> Option<String>| Cells::Texts((0..points.len()).map(of).collect());
    let mut columns = vec![
        column("point", Cells::Counts(points.iter().map(|one| Some(one.point as i64)).collect())),
        column("model", texts(&|at| Some(points[at].model.clone()))),
    ];
    for varied in varied(results) {
        let name = varied.column();
        columns.push(match varied.values {
            Values::Numbers(numbers) => column(&name, Cells::Numbers(numbers)),
            Values::Texts(words) => column(&name, Cells::Texts(words)),
        });
    }
    columns.push(column("status", texts(&|at| Some(results.outcomes[at].word().to_owned()))));
    columns.extend(headlines(&results.outcomes));
    columns.push(column("error", texts(&|at| results.outcomes[at].error().map(str::to_owned))));
    columns.push(column("hash", texts(&|at| Some(points[at].hash.clone()))));
    columns
}

/// The numbers of the points that are done.
fn headlines(outcomes: &[Outcome]) -> Vec<TableColumn> {
    type Of = fn(&Headline) -> Option<f64>;
    const NUMBERS: [(&str, Of); 9] = [
        ("speed_m_per_s", |one| Some(one.speed_m_per_s)),
        ("angle_deg", |one| Some(one.angle_deg)),
        ("depth_m", |one| Some(one.depth_m)),
        ("range_m", |one| Some(one.range_m)),
        ("stopping_time_s", |one| one.stopping_time_s),
        ("rest_time_s", |one| one.rest_time_s),
        ("impact_energy_J", |one| Some(one.impact_energy)),
        ("closure", |one| one.closure),
        ("packing_fraction", |one| one.packing_fraction),
    ];
    let stopped = outcomes.iter().map(|one| one.headline().map(|one| one.stopped)).collect();
    let mut columns = vec![column("stopped", Cells::Flags(stopped))];
    let numbers = |of: &dyn Fn(&Headline) -> Option<f64>| {
        Cells::Numbers(outcomes.iter().map(|one| one.headline().and_then(of)).collect())
    };
    columns.extend(NUMBERS.iter().map(|(name, of)| column(name, numbers(of))));
    let done = outcomes.iter().filter_map(Outcome::headline);
    let channels: BTreeSet<&String> = done.flat_map(|one| one.dissipated.keys()).collect();
    columns.extend(channels.into_iter().map(|channel| {
        let of = numbers(&|one: &Headline| one.dissipated.get(channel).copied());
        column(&format!("dissipated_{channel}_J"), of)
    }));
    columns
}

fn column(name: &str, cells: Cells) -> TableColumn {
    TableColumn { name: name.to_owned(), cells }
}

impl Varied {
    fn of(key: &str, values: &[Option<&str>]) -> Self {
        let read: Vec<Option<(f64, Option<&str>)>> =
            values.iter().map(|value| value.and_then(quantity)).collect();
        let mut units = read.iter().flatten().map(|(_, unit)| *unit);
        let unit = units.next().flatten();
        let all = read.iter().zip(values).all(|(read, value)| read.is_some() == value.is_some());
        let key = key.to_owned();
        if !all || units.any(|other| other != unit) {
            let words = values.iter().map(|value| value.map(str::to_owned)).collect();
            return Self { key, unit: None, values: Values::Texts(words) };
        }
        let numbers = read.iter().map(|read| read.map(|(number, _)| number)).collect();
        Self { key, unit: unit.map(str::to_owned), values: Values::Numbers(numbers) }
    }

    /// The value at the point `index` of the plan, as a reader wants it.
    pub fn shown(&self, index: usize) -> String {
        let number = |number: f64| match &self.unit {
            Some(unit) => format!("{} {unit}", six_digits(number)),
            None => six_digits(number),
        };
        let shown = match &self.values {
            Values::Numbers(numbers) => numbers[index].map(number),
            Values::Texts(words) => words[index].clone(),
        };
        shown.unwrap_or_else(|| "\u{2013}".to_owned())
    }

    /// The name of its column, with the unit as other names have theirs.
    fn column(&self) -> String {
        match &self.unit {
            Some(unit) => {
                let suffix = unit.replace('/', "_per_").replace(['^', ' ', '*'], "");
                format!("{}_{}", self.key, suffix.replace("1_per", "per"))
            }
            None => self.key.clone(),
        }
    }
}

/// `number` to six digits, for a table: what is drawn from a range has all of its sixteen.
fn six_digits(number: f64) -> String {
    significant(number, 6).to_string()
}

/// The number, and the unit if there is one, of a value in TOML.
fn quantity(value: &str) -> Option<(f64, Option<&str>)> {
    let plain = value.trim().trim_matches('"');
    let (number, unit) = match plain.split_once(char::is_whitespace) {
        Some((number, unit)) => (number, Some(unit.trim())),
        None => (plain, None),
    };
    let number = number.replace('_', "").parse::<f64>().ok().filter(|number| number.is_finite());
    Some((number?, unit))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn column_of(values: &[Option<&str>]) -> (String, Values) {
        let varied = Varied::of("impact.speed", values);
        (varied.column(), varied.values)
    }

    #[test]
    fn a_reader_is_shown_six_digits_with_the_unit() {
        let values = ["\"1.2345678901234567 m/s\"", "\"0.5 m/s\"", "\"123456.789 m/s\""].map(Some);
        let varied = Varied::of("impact.speed", &values);
        let shown = [0, 1, 2].map(|index| varied.shown(index));
        assert_eq!(shown, ["1.23457 m/s", "0.5 m/s", "123457 m/s"]);
    }

    #[test]
    fn values_of_one_unit_are_numbers_and_others_are_words() {
        let (name, values) = column_of(&[Some("\"1 m/s\""), None, Some("\"2.5 m/s\"")]);
        assert_eq!(name, "impact.speed_m_per_s");
        assert_eq!(values, Values::Numbers(vec![Some(1.0), None, Some(2.5)]));
        let (name, values) = column_of(&[Some("0.1"), Some("1_000")]);
        assert_eq!(
            (name.as_str(), values),
            ("impact.speed", Values::Numbers(vec![Some(0.1), Some(1e3)]))
        );
        for mixed in [["\"1 m/s\"", "\"10 cm/s\""], ["\"wall\"", "\"absorbing\""], ["0.1", "true"]]
        {
            let (name, values) = column_of(&mixed.map(Some));
            assert_eq!(name, "impact.speed");
            assert!(matches!(values, Values::Texts(_)), "{mixed:?}");
        }
        assert_eq!(column_of(&[Some("\"1 1/s\""), Some("\"2 1/s\"")]).0, "impact.speed_per_s");
    }
}
