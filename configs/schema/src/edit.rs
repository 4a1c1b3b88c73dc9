//! Adds effects to the text of a model, with everything else left as its author wrote it.

mod candidates;

use contact_laws::ActsOn;
use engine::params::ParamSpec;
use engine::units::{self, Dimension, significant};
use resistive::Role;
use thiserror::Error;
use toml_edit::{Array, ArrayOfTables, DocumentMut, Item, Table, Value};

use crate::diagnostics::nearest;

/// Digits of a value that is written: more would be the round-off of units.
const DIGITS: usize = 9;

/// What becomes part of a model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Addition {
    /// The effects, in order.
    pub effects: Vec<AddedEffect>,
    /// New SI values of numbers that are there already, by their paths: `resistance.drag`,
    /// `resistance.drag_x@45`, `effect.janssen.q`.
    pub fitted: Vec<(String, f64)>,
    /// Candidates that the model gets first, each as the text of a table `[[candidate]]`; an effect of the same name makes
    /// it a part of the model.
    pub candidates: Vec<String>,
}

/// An effect with its parameters as text: TOML if it parses as TOML, else a string.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AddedEffect {
    /// kebab-case.
    pub name: String,
    /// Keys and values.
    pub values: Vec<(String, String)>,
}

/// Why a text cannot be edited.
#[derive(Clone, Debug, Error, PartialEq)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum EditError {
    #[error("the model is not valid TOML: {0}")]
    Toml(String),
    #[error("there is no effect `{name}` for a {medium} medium{}; there are: {}", hint(near.as_deref()), known.join(", "))]
    UnknownEffect {
        name: String,
        medium: &'static str,
        near: Option<String>,
        known: Vec<&'static str>,
    },
    #[error("`{name}` acts in a {its} medium, and this model has a {medium} one")]
    OtherMedium { name: String, its: &'static str, medium: &'static str },
    #[error("the model has the effect `{name}` already")]
    Twice { name: String },
    #[error("`{effect}` has no parameter `{key}`{}; it has: {}", hint(near.as_deref()), known.join(", "))]
    UnknownKey { effect: String, key: String, near: Option<String>, known: Vec<&'static str> },
    #[error("`{name}` needs an amplitude, a number in SI: q=0.4")]
    NoAmplitude { name: String },
    #[error("the model has no number `{path}` to give a fitted value")]
    UnknownNumber { path: String },
}

fn hint(near: Option<&str>) -> String {
    near.map_or(String::new(), |near| format!("; did you mean `{near}`?"))
}

/// Adds to the model file `text`; comments, order and units stay.
///
/// If the model says what a fit may change, the amplitudes of the new effects are among it.
///
/// # Errors
/// If the effect is unknown, of the other medium or there already, has no such parameter, or a fitted
/// number is not in the model. The values themselves are judged when the model is loaded.
pub fn add_effects(text: &str, addition: &Addition) -> Result<String, EditError> {
    let mut document: DocumentMut =
        text.parse().map_err(|error: toml_edit::TomlError| EditError::Toml(error.to_string()))?;
    for (path, value) in &addition.fitted {
        set_number(&mut document, path, *value)
            .ok_or_else(|| EditError::UnknownNumber { path: path.clone() })?;
    }
    for table in &addition.candidates {
        candidates::append(&mut document, table)?;
    }
    for effect in &addition.effects {
        add(&mut document, effect)?;
    }
    Ok(document.to_string())
}

fn add(document: &mut DocumentMut, effect: &AddedEffect) -> Result<(), EditError> {
    if candidates::adopt(document, effect)? {
        push_free(document, &effect.name);
        return Ok(());
    }
    let is_resistive = text_at(document.as_item(), &["medium", "kind"]) == Some("resistive-force");
    let params = match is_resistive {
        true => resistance_effect(&effect.name)?,
        false => contact_effect(&effect.name)?,
    };
    let present = effects(document).any(|table| name_of(table) == Some(&effect.name));
    if present {
        return Err(EditError::Twice { name: effect.name.clone() });
    }
    let mut table = Table::new();
    table.decor_mut().set_prefix("\n");
    table["name"] = toml_edit::value(&effect.name);
    for (key, raw) in &effect.values {
        let known: Vec<&'static str> = params.iter().map(|spec| spec.key).collect();
        if !known.contains(&key.as_str()) {
            return Err(EditError::UnknownKey {
                effect: effect.name.clone(),
                key: key.clone(),
                near: nearest(key, known.iter().copied()).map(str::to_owned),
                known,
            });
        }
        let value = raw.parse::<Value>().unwrap_or_else(|_| Value::from(raw.as_str()));
        table[key.as_str()] = Item::Value(value.decorated(" ", ""));
    }
    let list = document.entry("effect").or_insert(Item::ArrayOfTables(ArrayOfTables::new()));
    if let Some(list) = list.as_array_of_tables_mut() {
        list.push(table);
    } else if let Some(list) = list.as_array_mut() {
        list.push(table.into_inline_table());
    }
    if is_resistive {
        push_free(document, &effect.name);
    }
    Ok(())
}

/// Lets a fit change the amplitude of a new effect, if the model says what a fit may change.
fn push_free(document: &mut DocumentMut, effect: &str) {
    let free = document.get_mut("fit").and_then(|fit| fit.get_mut("free"));
    if let Some(free) = free.and_then(Item::as_array_mut) {
        push(free, &format!("effect.{effect}.q"));
    }
}

/// Appends to a list in the style of its last entry.
fn push(list: &mut Array, text: &str) {
    let prefix = list.iter().last().and_then(|last| last.decor().prefix()?.as_str());
    let prefix = prefix.filter(|prefix| !prefix.is_empty()).unwrap_or(" ").to_owned();
    list.push_formatted(Value::from(text).decorated(prefix, ""));
}

fn resistance_effect(name: &str) -> Result<&'static [ParamSpec], EditError> {
    let is_effect = |role: Role| matches!(role, Role::Effect(_));
    if let Some(entry) = resistive::find_resistance(name)
        && is_effect(entry.role)
    {
        return Ok(entry.params);
    }
    let all = resistive::RESISTANCE_LAWS.iter();
    let known = all.filter(|entry| is_effect(entry.role)).map(|entry| entry.name).collect();
    let other =
        contact_laws::find(name).is_some() || contact_laws::find_grain_force(name).is_some();
    Err(unknown(name, ["resistive-force", "grains"], known, other))
}

fn contact_effect(name: &str) -> Result<&'static [ParamSpec], EditError> {
    if let Some(entry) = contact_laws::find(name)
        && entry.acts_on == ActsOn::ContactEffect
    {
        return Ok(entry.params);
    }
    if let Some(entry) = contact_laws::find_grain_force(name) {
        return Ok(entry.params);
    }
    let effects = contact_laws::LAWS.iter().filter(|law| law.acts_on == ActsOn::ContactEffect);
    let forces = contact_laws::GRAIN_FORCES.iter().map(|force| force.name);
    let known = effects.map(|law| law.name).chain(forces).collect();
    let other = resistive::find_resistance(name).is_some();
    Err(unknown(name, ["grains", "resistive-force"], known, other))
}

fn unknown(
    name: &str,
    [medium, its]: [&'static str; 2],
    known: Vec<&'static str>,
    is_of_the_other: bool,
) -> EditError {
    let name = name.to_owned();
    match is_of_the_other {
        true => EditError::OtherMedium { name, its, medium },
        false => EditError::UnknownEffect {
            near: nearest(&name, known.iter().copied()).map(str::to_owned),
            name,
            medium,
            known,
        },
    }
}

fn text_at<'a>(item: &'a Item, path: &[&str]) -> Option<&'a str> {
    path.iter().try_fold(item, |item, key| item.get(key)).and_then(Item::as_str)
}

fn effects(document: &DocumentMut) -> impl Iterator<Item = &dyn toml_edit::TableLike> {
    let list = document.get("effect");
    let tables = list.and_then(Item::as_array_of_tables).into_iter().flatten();
    let inline = list.and_then(Item::as_array).into_iter().flatten();
    let inline = inline.filter_map(Value::as_inline_table);
    tables
        .map(|table| table as &dyn toml_edit::TableLike)
        .chain(inline.map(|table| table as &dyn toml_edit::TableLike))
}

/// What an effect is called: an own one by its `id`.
fn name_of(table: &dyn toml_edit::TableLike) -> Option<&str> {
    let text = |key| table.get(key).and_then(Item::as_str);
    text("name")
        .map(|name| if name == candidates::EXPRESSION { text("id").unwrap_or(name) } else { name })
}

/// Gives the number at `path` a new SI value, in the unit that it was written in; `None` if it is not
/// there.
fn set_number(document: &mut DocumentMut, path: &str, si: f64) -> Option<()> {
    let (table, key) = path.split_once('.')?;
    if table == "effect" {
        let (name, key) = key.split_once('.')?;
        let effect = effect_mut(document, name)?;
        if effect.contains_key("parameters") {
            return candidates::set_value(effect, key, si);
        }
        return replace(effect.get_mut(key)?.as_value_mut()?, None, si);
    }
    if table != "resistance" {
        return None;
    }
    let baseline = text_at(document.as_item(), &[table, "name"]).map(str::to_owned)?;
    let (key, node) = match key.split_once('@') {
        Some((key, node)) => (key, Some(node)),
        None => (key, None),
    };
    let entry = resistive::find_resistance(&baseline)?;
    let dimension = entry.params.iter().find(|spec| spec.key == key)?.dimension;
    let resistance = document.get_mut(table)?.as_table_like_mut()?;
    if node.is_none() && !resistance.contains_key(key) {
        // What was a default is written out once it is fitted.
        resistance.insert(key, toml_edit::value(in_si(si, dimension)));
        return Some(());
    }
    let item = resistance.get_mut(key)?;
    let Some(node) = node else {
        return replace(item.as_value_mut()?, Some(dimension), si);
    };
    let wanted: f64 = node.parse().ok()?;
    let angles = item.get("angle")?.as_array()?;
    let place = angles.iter().position(|angle| {
        let radians = angle.as_str().and_then(|text| units::parse(text, Dimension::ANGLE).ok());
        radians.is_some_and(|radians| (radians.to_degrees() - wanted).abs() < 1e-9)
    })?;
    let value = item.get_mut("value")?.as_array_mut()?.get_mut(place)?;
    replace(value, Some(dimension), si)
}

fn effect_mut<'a>(
    document: &'a mut DocumentMut,
    name: &str,
) -> Option<&'a mut dyn toml_edit::TableLike> {
    match document.get_mut("effect")? {
        Item::ArrayOfTables(list) => list
            .iter_mut()
            .find(|table| name_of(*table) == Some(name))
            .map(|table| table as &mut dyn toml_edit::TableLike),
        Item::Value(Value::Array(list)) => list
            .iter_mut()
            .filter_map(Value::as_inline_table_mut)
            .find(|table| name_of(*table) == Some(name))
            .map(|table| table as &mut dyn toml_edit::TableLike),
        _ => None,
    }
}

/// Replaces a number, or the number of a quantity, and keeps what stands around it.
fn replace(value: &mut Value, dimension: Option<Dimension>, si: f64) -> Option<()> {
    let decor = value.decor().clone();
    let new = match value {
        Value::Float(_) | Value::Integer(_) => Value::from(significant(si, DIGITS)),
        Value::String(text) => {
            let written = text.value().trim().to_owned();
            let unit = written.trim_start_matches(|c: char| "+-.0123456789".contains(c));
            let unit = exponent_free(unit);
            let one = units::parse(&format!("1 {unit}"), dimension?).ok()?;
            Value::from(format!("{} {unit}", significant(si / one, DIGITS)))
        }
        _ => return None,
    };
    *value = new;
    *value.decor_mut() = decor;
    Some(())
}

/// `si` as a model file says it.
fn in_si(si: f64, dimension: Dimension) -> Value {
    match dimension == Dimension::NONE {
        true => Value::from(significant(si, DIGITS)),
        false => Value::from(units::format_si(significant(si, DIGITS), dimension)),
    }
}

/// The unit behind what may be left of a number such as `1e4 1/s`.
fn exponent_free(rest: &str) -> &str {
    let digits = rest
        .strip_prefix(['e', 'E'])
        .map(|rest| rest.trim_start_matches(['+', '-']))
        .filter(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))
        .map(|rest| rest.trim_start_matches(|c: char| c.is_ascii_digit()));
    digits.unwrap_or(rest).trim_start()
}

#[cfg(test)]
mod tests {
    use super::*;

    const MODEL: &str = "# a model\n[medium]\nkind = \"resistive-force\"\n\n[resistance]\nname = \
                         \"two-term-components\" # by component\ndrag_x = { angle = [\"30 deg\", \"45 \
                         deg\"], value = [\"0.1 kg/m\", \"1.6 g/cm\"] } # fitted\nfriction_z = \"4 \
                         N/m\" # too\n\n[fit]\nfree = [\"resistance.friction_z\"]\n";

    fn janssen() -> AddedEffect {
        AddedEffect { name: "janssen".to_owned(), values: vec![("q".to_owned(), "0.4".to_owned())] }
    }

    #[test]
    fn an_effect_is_added_and_nothing_else_changes() {
        let addition = Addition { effects: vec![janssen()], ..Addition::default() };
        let text = add_effects(MODEL, &addition).unwrap();
        let expected = MODEL.replace(
            "[\"resistance.friction_z\"]",
            "[\"resistance.friction_z\", \"effect.janssen.q\"]",
        );
        assert_eq!(text, format!("{expected}\n[[effect]]\nname = \"janssen\"\nq = 0.4\n"));
    }

    #[test]
    fn fitted_values_keep_their_units_and_comments() {
        let fitted = vec![
            ("resistance.drag_x@45".to_owned(), 0.25),
            ("resistance.friction_z".to_owned(), 3.5),
        ];
        let text = add_effects(MODEL, &Addition { fitted, ..Addition::default() }).unwrap();
        let expected = MODEL.replace("1.6 g/cm", "2.5 g/cm").replace("\"4 N/m\"", "\"3.5 N/m\"");
        assert_eq!(text, expected);
    }

    #[test]
    fn a_default_that_is_fitted_is_written_out() {
        let link = "[resistance]\nname = \"link\"\ndrag = 3.0 # eta_d\n\n[run]\n";
        let fitted = vec![("resistance.plunging".to_owned(), 12.5)];
        let text = add_effects(link, &Addition { fitted, ..Addition::default() }).unwrap();
        assert_eq!(text, link.replace("# eta_d\n", "# eta_d\nplunging = 12.5\n"));
    }

    #[test]
    fn what_cannot_be_added_is_refused_with_what_could_be() {
        let one = |name: &str, key: &str| Addition {
            effects: vec![AddedEffect {
                name: name.to_owned(),
                values: vec![(key.to_owned(), "1".to_owned())],
            }],
            ..Addition::default()
        };
        let message = |addition| add_effects(MODEL, &addition).unwrap_err().to_string();
        assert!(message(one("jansen", "q")).contains("did you mean `janssen`?"));
        assert!(message(one("rolling-resistance", "q")).contains("acts in a grains medium"));
        assert!(message(one("janssen", "p")).contains("it has: q"));
        let twice = Addition { effects: vec![janssen(), janssen()], ..Addition::default() };
        assert!(message(twice).contains("already"));
        let lost =
            Addition { fitted: vec![("resistance.grag".to_owned(), 1.0)], ..Addition::default() };
        assert!(message(lost).contains("resistance.grag"));
    }

    #[test]
    fn numbers_with_exponents_keep_their_units() {
        for (written, unit) in [("1e4 1/s", "1/s"), ("-2.5E-3 N", "N"), ("3 m/s", "m/s")] {
            let rest = written.trim_start_matches(|c: char| "+-.0123456789".contains(c));
            assert_eq!(exponent_free(rest), unit, "{written}");
        }
    }
}
