//! Coefficients of a force law: numbers, tables over the impact angle, expressions.

use engine::params::ParamSpec;
use resistive::Expression;

use super::{Answer, Found, TableReader};
use crate::diagnostics::Diagnostic;
use crate::document::Value;
use crate::model::{AngleTable, Coefficient};
use crate::read::formula_fault;
use crate::specs;

impl TableReader<'_> {
    /// A coefficient as its specification says; an expression may use `variables`.
    pub(crate) fn coefficient(
        &self,
        spec: &'static ParamSpec,
        variables: &[&str],
    ) -> Option<Coefficient> {
        self.asks_number(spec, Answer::Coefficient);
        let is_table =
            self.entry(spec.key).is_some_and(|entry| matches!(entry.node.value, Value::Table(_)));
        if !is_table {
            return self.plain_number(spec).map(|found| Coefficient::Number(found.value));
        }
        let table = self.below(spec.key, None);
        let [formula, angle, value] = ["expression", "angle", "value"].map(|key| table.has(key));
        let read = match (formula, angle || value) {
            (true, true) => {
                self.reader.report(
                    Diagnostic::error(format!(
                        "`{}` is both an expression and a table over the impact angle",
                        spec.key
                    ))
                    .at(table.span_of("expression"), "the expression")
                    .with(table.span_of("angle").or_else(|| table.span_of("value")), "the table")
                    .help("keep one of the two; an expression may use `angle`"),
                );
                None
            }
            (true, false) => table.expression(variables).map(Coefficient::Expression),
            (false, _) => table.angle_table(spec).map(Coefficient::Table),
        };
        table.finish();
        read
    }

    fn expression(&self, variables: &[&str]) -> Option<Expression> {
        let example = "2 * density / 1500";
        let text = self.text("expression", None, example, "a formula in SI")?;
        match Expression::parse(&text.value, variables) {
            Ok(expression) => Some(expression),
            Err(error) => {
                let fault = formula_fault(self, &text, &error);
                let help = format!("it may use {}, in SI", variables.join(", "));
                self.reader.report(fault.help(help));
                None
            }
        }
    }

    fn angle_table(&self, spec: &ParamSpec) -> Option<AngleTable> {
        let nodes = ParamSpec { key: "angle", ..specs::ANGLE };
        let values = ParamSpec { key: "value", ..*spec };
        let (angles, values) = (self.numbers(&nodes), self.numbers(&values));
        let (Some(angles), Some(values)) = (angles?, values?) else {
            self.reader.report(
                Diagnostic::error("a table over the impact angle needs `angle` and `value`")
                    .at(self.header(), "expected a list of each")
                    .help(format!(
                        "write {{ angle = [\"30 deg\", \"90 deg\"], value = [{0}, {0}] }}",
                        self.example(spec)
                    )),
            );
            return None;
        };
        if angles.len() != values.len() {
            self.reader.report(
                Diagnostic::error(format!("{} angles have {} values", angles.len(), values.len()))
                    .at(self.span_of("value"), "expected one value per angle")
                    .with(self.span_of("angle"), "the angles"),
            );
            return None;
        }
        if let Some(pair) = angles.windows(2).find(|pair| pair[1].value <= pair[0].value) {
            self.reader.report(
                Diagnostic::error("the angles of the table do not rise")
                    .at(pair[1].span, "not above the one before")
                    .with(pair[0].span, "the one before"),
            );
            return None;
        }
        let numbers = |list: Vec<Found<f64>>| list.into_iter().map(|found| found.value).collect();
        Some(AngleTable { angles_rad: numbers(angles), values: numbers(values) })
    }
}
