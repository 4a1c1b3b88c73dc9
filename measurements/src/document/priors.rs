//! `[parameters]`: what is known of coefficients of a model before the measurements.

use configs::document::{Entry, Value};
use configs::reader::{Answer, TableReader};
use configs::{Diagnostic, toml_string};
use engine::units;

/// What the schema calls the table.
pub(crate) const PRIORS: &str = "priors";

/// What an entry looks like.
const EXAMPLE: &str = "drag = { prior = \"1.1 ± 0.1\" }";

/// What is known of one coefficient, such as a friction angle that was measured otherwise.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterPrior {
    /// The coefficient of the resistance law, or the whole path of a number of the model.
    pub name: String,
    /// Its mean (SI).
    pub mean: f64,
    /// Its standard deviation (SI).
    pub sigma: f64,
    /// The SI unit of what was written; empty where no unit was.
    pub unit: String,
}

impl ParameterPrior {
    /// Whether it is of the number at `path` of a model.
    pub fn is_of(&self, path: &str) -> bool {
        path == self.name || path.strip_prefix("resistance.") == Some(self.name.as_str())
    }

    /// As a line of `[parameters]`.
    pub(crate) fn line(&self) -> (String, String) {
        let Self { name, mean, sigma, unit } = self;
        let space = if unit.is_empty() { "" } else { " " };
        let prior = format!("{mean:?} ± {sigma:?}{space}{unit}");
        (toml_string(name), format!("{{ prior = {} }}", toml_string(&prior)))
    }
}

/// Reads the table below `root`; faults are reported.
pub(crate) fn read(root: &TableReader<'_>) -> Vec<ParameterPrior> {
    let what = "what is known of coefficients beforehand";
    root.asks("parameters", what, || Answer::Defined(PRIORS));
    let Some(node) = root.node("parameters") else { return Vec::new() };
    let Value::Table(table) = &node.value else {
        root.reader.report(
            Diagnostic::error("`parameters` is a table")
                .at(node.span, format!("this is {}", node.value.kind()))
                .help(format!("write [parameters], and below it {EXAMPLE}")),
        );
        return Vec::new();
    };
    table.entries.iter().filter_map(|entry| prior(root, entry)).collect()
}

fn prior(root: &TableReader<'_>, entry: &Entry) -> Option<ParameterPrior> {
    let fail = |span, label: String| {
        root.reader.report(
            Diagnostic::error(format!("`parameters.{}` is not understood", entry.key))
                .at(span, label)
                .help(format!("write a mean and a standard deviation: {EXAMPLE}")),
        );
    };
    let Value::Table(own) = &entry.node.value else {
        fail(entry.node.span, format!("this is {}; expected a table", entry.node.value.kind()));
        return None;
    };
    let [only] = own.entries.as_slice() else {
        fail(entry.node.span, "expected the key `prior`, and no other".to_owned());
        return None;
    };
    if only.key != "prior" {
        fail(only.node.span, format!("`{}` is not a key here; the only one is `prior`", only.key));
        return None;
    }
    let Value::Text(text) = &only.node.value else {
        fail(only.node.span, format!("this is {}; expected a string", only.node.value.kind()));
        return None;
    };
    let read = parse(text).map(|(mean, sigma, unit)| ParameterPrior {
        name: entry.key.clone(),
        mean,
        sigma,
        unit,
    });
    read.map_err(|why| fail(only.node.span, why)).ok()
}

/// Mean, standard deviation and SI unit of `1.1 ± 0.1 kg/m`.
fn parse(text: &str) -> Result<(f64, f64, String), String> {
    let (mean, rest) = text
        .split_once('±')
        .or_else(|| text.split_once("+-"))
        .ok_or("expected `±` between the mean and the standard deviation")?;
    let (mean, rest) = (mean.trim(), rest.trim());
    let (sigma, unit) = rest.split_once(char::is_whitespace).unwrap_or((rest, ""));
    let unit = unit.trim();
    let dimension = match unit {
        "" => units::Dimension::NONE,
        unit => units::dimension_of(&format!("1 {unit}"))
            .ok_or_else(|| format!("the unit `{unit}` is not known"))?,
    };
    let number = |text: &str| {
        let value = match unit {
            "" => text.parse().ok(),
            unit => units::parse(&format!("{text} {unit}"), dimension).ok(),
        };
        value.filter(|value: &f64| value.is_finite()).ok_or(format!("`{text}` is not a number"))
    };
    let (mean, sigma) = (number(mean)?, number(sigma)?);
    if sigma <= 0.0 {
        return Err("the standard deviation has to be above zero".to_owned());
    }
    Ok((mean, sigma, dimension.si_unit()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{MeasurementSet, SetError, TEMPLATE};

    fn read_with(lines: &str) -> Result<MeasurementSet, SetError> {
        let folder = tempfile::tempdir().expect("a folder for the test");
        for (name, text) in TEMPLATE {
            let more = if name == "measurement.toml" { lines } else { "" };
            std::fs::write(folder.path().join(name), format!("{text}\n{more}")).expect("a file");
        }
        MeasurementSet::load(folder.path()).map(|loaded| loaded.set)
    }

    #[test]
    fn numbers_are_si_once_they_are_read_and_survive_an_export() {
        let set = read_with("[parameters]\ndrag = { prior = \"11 ± 1 g/cm\" }\n\"effect.janssen.q\" = { prior = \"0.2 ± 0.05\" }")
            .expect("a set");
        let [drag, janssen] = set.priors.as_slice() else { panic!("{:?}", set.priors) };
        assert!((drag.mean - 1.1).abs() < 1e-12 && (drag.sigma - 0.1).abs() < 1e-12, "{drag:?}");
        assert_eq!(drag.unit, "kg/m");
        assert!(drag.is_of("resistance.drag") && !drag.is_of("effect.drag.q"));
        assert!(janssen.is_of("effect.janssen.q") && janssen.unit.is_empty());
        let folder = tempfile::tempdir().expect("a folder for the test");
        set.write(folder.path()).expect("a writable folder");
        let again = MeasurementSet::load(folder.path()).expect("what was written is a set");
        assert_eq!(again.set.priors, set.priors);
    }

    #[test]
    fn what_is_no_mean_with_a_standard_deviation_is_an_error_that_shows_one() {
        for wrong in [
            "1.1",
            "\"1.1\"",
            "{ prior = 1.1 }",
            "{ prior = \"1.1 ± 0\" }",
            "{ mean = \"1 ± 1\" }",
            "{ prior = \"1.1 ± 0.1 parsec\" }",
            "{ prior = \"much ± 0.1\" }",
        ] {
            let error = read_with(&format!("[parameters]\ndrag = {wrong}")).expect_err(wrong);
            assert!(error.to_string().contains(EXAMPLE), "{wrong}: {error}");
        }
    }
}
