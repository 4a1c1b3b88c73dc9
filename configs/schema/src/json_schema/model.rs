//! The schema of a model.

use std::path::Path;

use serde_json::{Map, Value, json};

use super::probes;
use super::{Format, Gathered, asked};
use crate::read::{self, DataFolder, KEYS_OF_PARAMETER, PARAMETERS};
use crate::reader::{Asked, FileKind, TableReader};

/// The schema of a model file.
pub fn model() -> Value {
    let (texts, whole) = probes::models();
    let mut gathered = Gathered::new(format());
    let is_whole = |key: &str| key == "parameters";
    let read = reading(Path::new("."));
    for (at, text) in texts.iter().enumerate() {
        let gaps: Option<&dyn Fn(&str) -> bool> = (at < whole).then_some(&is_whole);
        asked((FileKind::Model, &read), text, gaps).iter().for_each(|asked| gathered.add(asked));
    }
    gathered.schema()
}

/// What a reader asks of the model `text`, whose data files lie in `folder`; nothing where it is no TOML.
pub fn read_model(text: &str, folder: &Path) -> Asked {
    asked((FileKind::Model, &reading(folder)), text, None).pop().unwrap_or_default()
}

fn reading(folder: &Path) -> impl Fn(TableReader<'_>) {
    move |root| drop(read::model(root, &DataFolder { folder, allow_paths: &[], known: None }))
}

fn format() -> Format {
    let number = json!({ "type": "number" });
    let [value, unit, range] = KEYS_OF_PARAMETER;
    let parameter = json!({
        "type": "object",
        "properties": {
            value: { "type": "number", "description": "in the unit of the parameter" },
            unit: { "type": "string", "description": "the unit, such as N or kg/m; 1 for a pure number", "default": "1" },
            range: {
                "type": "array", "items": number, "minItems": 2, "maxItems": 2,
                "description": "between what a fit looks for it, in the unit of the parameter",
            },
        },
        "additionalProperties": false,
    });
    Format {
        title: "plunge model",
        description: "An impact into grains or into a medium with a resistive force.",
        takes_bare: false,
        own: &[
            ("contact_law", "name"),
            ("effect", "name"),
            ("bed.effect", "name"),
            ("resistance", "name"),
            ("intruder", "shape"),
            ("container", "shape"),
            ("bed", "source"),
            ("bed.grains", "distribution"),
        ],
        of_file: &[("medium", "kind"), ("medium", "dimension")],
        definitions: json!({
            PARAMETERS: { "type": "object", "additionalProperties": parameter },
        }),
    }
}

/// The schema of files that set any keys of a model: nothing is required, lists of tables take anything, and what
/// stands at a key is what `leaf` makes of the schema of its value.
pub fn loosened(model: &Value, leaf: &impl Fn(&Value) -> Value) -> Value {
    let is_table = |value: &Value| value.get("properties").is_some();
    let is_list_of_tables = |value: &Value| value.get("items").is_some_and(is_table);
    let Some(keys) = model.get("properties").and_then(Value::as_object) else { return leaf(model) };
    let properties: Map<String, Value> = keys
        .iter()
        .map(|(key, value)| {
            let loose = match (is_table(value), is_list_of_tables(value)) {
                (true, _) => loosened(value, leaf),
                (_, true) => json!({}),
                _ => leaf(value),
            };
            (key.clone(), loose)
        })
        .collect();
    json!({ "type": "object", "properties": properties, "additionalProperties": false })
}
