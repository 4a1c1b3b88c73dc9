//! Own effects in the text of a model: a candidate becomes a part of it, amplitudes get new values.

use engine::units::{self, significant};
use toml_edit::{ArrayOfTables, DocumentMut, InlineTable, Item, Table, TableLike, Value};

use super::{AddedEffect, DIGITS, EditError, name_of, replace};

/// What says in `name` that an effect is a formula.
pub(super) const EXPRESSION: &str = "expression";

/// Where candidates stand, and where effects do.
const CANDIDATE: &str = "candidate";
const EFFECT: &str = "effect";

/// Adds the candidates of `text`, which is a model with nothing else, to those of the model.
pub(super) fn append(document: &mut DocumentMut, text: &str) -> Result<(), EditError> {
    let toml = |why: &dyn std::fmt::Display| EditError::Toml(why.to_string());
    let own: DocumentMut = text.parse().map_err(|why: toml_edit::TomlError| toml(&why))?;
    let tables = own.get(CANDIDATE).and_then(Item::as_array_of_tables).into_iter().flatten();
    let list = document.entry(CANDIDATE).or_insert(Item::ArrayOfTables(ArrayOfTables::new()));
    for table in tables {
        let mut table = table.clone();
        table.decor_mut().set_prefix("\n");
        table.set_position(None);
        match list {
            Item::ArrayOfTables(list) => list.push(table),
            Item::Value(Value::Array(list)) => list.push(table.into_inline_table()),
            _ => return Err(toml(&format!("`{CANDIDATE}` is no list of tables"))),
        }
    }
    Ok(())
}

/// Makes the candidate that `effect` names a part of the model, with its amplitude (SI): its table stays
/// where it is, under the header of an effect. False if the model has no such candidate.
pub(super) fn adopt(document: &mut DocumentMut, effect: &AddedEffect) -> Result<bool, EditError> {
    let Some(mut taken) = take(document, &effect.name) else { return Ok(false) };
    let unknown = effect.values.iter().find(|(key, _)| key != "q");
    if let Some((key, _)) = unknown {
        return Err(EditError::UnknownKey {
            effect: effect.name.clone(),
            key: key.clone(),
            near: None,
            known: vec!["q"],
        });
    }
    let q = effect.values.first().and_then(|(_, q)| q.trim().parse::<f64>().ok());
    let set = q.and_then(|q| match &mut taken {
        Taken::Table(table) => set_value(table, "q", q),
        Taken::Inline(table) => set_value(table, "q", q),
    });
    if set.is_none() {
        return Err(EditError::NoAmplitude { name: effect.name.clone() });
    }
    let list = document.entry(EFFECT).or_insert(Item::ArrayOfTables(ArrayOfTables::new()));
    match (list, taken) {
        (Item::ArrayOfTables(list), taken) => list.push(taken.into_table()),
        (Item::Value(Value::Array(list)), taken) => list.push(taken.into_inline()),
        _ => return Err(EditError::Toml(format!("`{EFFECT}` is no list of tables"))),
    }
    Ok(true)
}

/// Gives the parameter `key` of a user-defined effect a new SI value, in its own unit; `None` if it is not there.
pub(super) fn set_value(effect: &mut dyn TableLike, key: &str, si: f64) -> Option<()> {
    let parameters = effect.get_mut("parameters")?.as_table_like_mut()?;
    let parameter = parameters.get_mut(key)?;
    let own = parameter.as_table_like_mut()?;
    let unit = own.get("unit").and_then(Item::as_str).unwrap_or("1").to_owned();
    let one = units::parse(&format!("1 {unit}"), units::dimension_of(&unit)?).ok()?;
    let value = si / one;
    if let Some(there) = own.get_mut("value").and_then(Item::as_value_mut) {
        return replace(there, None, value);
    }
    own.insert("value", toml_edit::value(significant(value, DIGITS)));
    if let Some(inline) = parameter.as_inline_table_mut() {
        // The blank before the closing brace stood behind what was last.
        inline.fmt();
    }
    Some(())
}

/// A table on its way from one list to another.
enum Taken {
    Table(Table),
    Inline(InlineTable),
}

impl Taken {
    fn into_table(self) -> Table {
        match self {
            Self::Table(table) => table,
            Self::Inline(table) => table.into_table(),
        }
    }

    fn into_inline(self) -> InlineTable {
        match self {
            Self::Table(table) => table.into_inline_table(),
            Self::Inline(table) => table,
        }
    }
}

/// Takes the candidate called `name` out of the document.
fn take(document: &mut DocumentMut, name: &str) -> Option<Taken> {
    let (taken, is_last) = match document.get_mut(CANDIDATE)? {
        Item::ArrayOfTables(list) => {
            let index = list.iter().position(|table| name_of(table) == Some(name))?;
            let table = list.get(index)?.clone();
            list.remove(index);
            (Taken::Table(table), list.is_empty())
        }
        Item::Value(Value::Array(list)) => {
            let is_it = |value: &Value| {
                value.as_inline_table().is_some_and(|table| name_of(table) == Some(name))
            };
            let index = list.iter().position(is_it)?;
            let table = list.remove(index).as_inline_table()?.clone();
            (Taken::Inline(table), list.is_empty())
        }
        _ => return None,
    };
    if is_last {
        document.remove(CANDIDATE);
    }
    Some(taken)
}

#[cfg(test)]
mod tests {
    use super::super::{Addition, add_effects};
    use super::*;

    const MODEL: &str = "[medium]\nkind = \"resistive-force\"\n\n# my idea\n[[candidate]]\nname = \
                         \"expression\"\nid = \"late-drag\" # late\nforce = \"q * z\"\n\
                         [candidate.parameters.q]\nunit = \"N/mm\" # stiff\nrange = [0, 5]\n\n[fit]\nfree = \
                         [\"resistance.drag\"]\n";

    fn adopted(model: &str, key: &str) -> Result<String, EditError> {
        let values = vec![(key.to_owned(), "250".to_owned())];
        let effects = vec![AddedEffect { name: "late-drag".to_owned(), values }];
        add_effects(model, &Addition { effects, ..Addition::default() })
    }

    #[test]
    fn a_candidate_becomes_an_effect_in_its_place_with_its_comments_and_its_unit() {
        let expected = MODEL
            .replace("[[candidate]]", "[[effect]]")
            .replace("[candidate.parameters.q]", "[effect.parameters.q]")
            .replace("range = [0, 5]\n", "range = [0, 5]\nvalue = 0.25\n")
            .replace("drag\"]", "drag\", \"effect.late-drag.q\"]");
        assert_eq!(adopted(MODEL, "q").unwrap(), expected);
    }

    #[test]
    fn inline_parameters_and_a_second_fit_work_too() {
        let inline = MODEL.replace(
            "[candidate.parameters.q]\nunit = \"N/mm\" # stiff\nrange = [0, 5]",
            "parameters.q = { unit = \"N/mm\", range = [0, 5] }",
        );
        let text = adopted(&inline, "q").unwrap();
        assert!(text.contains("q = { unit = \"N/mm\", range = [0, 5], value = 0.25 }"), "{text}");
        let fitted = vec![("effect.late-drag.q".to_owned(), 1500.0)];
        let again = add_effects(&text, &Addition { fitted, ..Addition::default() }).unwrap();
        assert_eq!(again, text.replace("0.25", "1.5"));
    }

    #[test]
    fn an_amplitude_is_wanted_and_nothing_else() {
        let error = adopted(MODEL, "p").unwrap_err().to_string();
        assert!(error.contains("has no parameter `p`"), "{error}");
        let effects = vec![AddedEffect { name: "late-drag".to_owned(), values: Vec::new() }];
        let error = add_effects(MODEL, &Addition { effects, ..Addition::default() }).unwrap_err();
        assert!(error.to_string().contains("q=0.4"), "{error}");
    }
}
