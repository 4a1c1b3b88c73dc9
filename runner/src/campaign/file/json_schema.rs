//! The schema of a campaign file, for editors: made of what its reader asks, and of the schema of a model.

use std::path::Path;

use configs::json_schema::{Format, Gathered, asked, loosened, model};
use configs::reader::{Asked, FileKind, TableReader};
use serde_json::{Value, json};

use super::read::{self, AXES, POINTS_ONE_BY_ONE, RANGES, SETTINGS};

/// What is read, and by what.
const READER: (FileKind, &dyn Fn(TableReader<'_>)) =
    (FileKind::Campaign, &|root| drop(read::campaign(root, Path::new("."), &[])));

/// A campaign with all that one can have.
const PROBE: &str = "
[campaign]
name = 'a'
models = ['two-term-vector']
seeds = [1]
keep_logs = false
[set]
[product]
[[point]]
[sample]
method = 'sobol'
count = 1
seed = 1
[sample.ranges]
";

/// The schema.
pub fn campaign() -> Value {
    let model = model();
    let mut gathered = Gathered::new(format(&model));
    asked(READER, PROBE, Some(&|_| false)).iter().for_each(|asked| gathered.add(asked));
    gathered.schema()
}

/// What a reader asks of the text of a campaign; nothing where it is no TOML.
pub fn read_campaign(text: &str) -> Asked {
    asked(READER, text, None).pop().unwrap_or_default()
}

fn format(model: &Value) -> Format {
    let settings = loosened(model, &Value::clone);
    let axes = loosened(model, &|value| json!({ "type": "array", "items": value, "minItems": 1 }));
    let ranges = loosened(model, &range);
    let reference = json!({ "$ref": format!("#/definitions/{SETTINGS}") });
    let mut definitions = model["definitions"].clone();
    definitions[SETTINGS] = settings;
    definitions[AXES] = axes;
    definitions[RANGES] = ranges;
    definitions[POINTS_ONE_BY_ONE] = json!({ "type": "array", "items": reference });
    Format {
        title: "plunge campaign",
        description: "Many impacts: models, and what is set and varied in them.",
        takes_bare: false,
        own: &[],
        of_file: &[],
        definitions,
    }
}

/// Two ends, or two ends with a scale.
fn range(end: &Value) -> Value {
    json!({ "anyOf": [
        { "type": "array", "items": end, "minItems": 2, "maxItems": 2 },
        {
            "type": "object",
            "properties": {
                "from": end,
                "to": end,
                "scale": { "type": "string", "enum": ["linear", "logarithmic"] },
            },
            "required": ["from", "to"],
            "additionalProperties": false,
        },
    ] })
}
