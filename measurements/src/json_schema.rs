//! The schema of `measurement.toml`, for editors: made of what its reader asks.

use configs::json_schema::{Format, Gathered, asked};
use configs::reader::{Asked, FileKind, TableReader};
use serde_json::{Value, json};

use crate::document;
use crate::document::priors::PRIORS;
use crate::table::columns::{Content, RUNS, TRAJECTORIES};
use crate::{Kind, TEMPLATE};

/// What is read, and by what.
const READER: (FileKind, &dyn Fn(TableReader<'_>)) =
    (FileKind::MeasurementSet, &|root| drop(document::read(root)));

/// The schema.
pub fn set() -> Value {
    let mut gathered = Gathered::new(format());
    for text in probes() {
        let asked = asked(READER, &text, Some(&|key| key == "parameters"));
        asked.iter().for_each(|asked| gathered.add(asked));
    }
    gathered.schema()
}

/// What a reader asks of the text of a set; nothing where it is no TOML.
pub fn read_set(text: &str) -> Asked {
    asked(READER, text, None).pop().unwrap_or_default()
}

fn format() -> Format {
    let prior = json!({
        "type": "string",
        "pattern": "(±|\\+-)",
        "description": "a mean and a standard deviation, as in 1.1 ± 0.1 kg/m",
    });
    let one = json!({
        "type": "object", "properties": { "prior": prior }, "required": ["prior"],
        "additionalProperties": false,
    });
    Format {
        title: "plunge measurement set",
        description: "What was dropped onto what, and where the tables of what came of it are.",
        takes_bare: true,
        own: &[],
        of_file: &[("measurement", "kind"), ("bed", "geometry")],
        definitions: json!({ PRIORS: { "type": "object", "additionalProperties": one } }),
    }
}

/// Texts that make the reader ask everything, for sets of every kind in space and in a plane.
fn probes() -> Vec<String> {
    let [(_, template), ..] = TEMPLATE;
    let mut texts = vec![template.to_owned()];
    for word in Kind::words() {
        let curve = Kind::of_curve(word).and_then(Kind::curve);
        let readings = curve.map_or(&TRAJECTORIES[..], |curve| &curve.columns[0][..]);
        let columns: String = RUNS
            .iter()
            .chain(&readings[1..])
            .map(|column| {
                let unit = match column.content {
                    Content::Quantity(dimension) => format!(", unit = '{}'", dimension.si_unit()),
                    Content::Name | Content::Count => String::new(),
                };
                format!("{0} = {{ name = '{0}'{unit} }}\n", column.key)
            })
            .collect();
        let files = curve.map_or("trajectories", |curve| curve.files);
        for (geometry, tables) in [("3d", "'a.csv'"), ("2d", "['a.csv', 'b.csv']")] {
            let readings = match word {
                "scalar" => String::new(),
                _ => format!("{files} = {tables}\n"),
            };
            texts.push(format!(
                "schema = 1\n\
                 [measurement]\nid = 'a'\nkind = '{word}'\nsource = 'a'\nframe = 'a'\nphase = 'a'\n\
                 stop_definition = 'component-zero'\nfinal = 'deepest'\nsurface_definition = 'mean'\n\
                 [bed]\ngeometry = '{geometry}'\n\
                 [model]\nbaseline = 'a'\n\
                 [files]\nruns = 'runs.csv'\n{readings}missing = 'drop'\ndelimiter = ','\ndecimal = '.'\n\
                 [columns]\n{columns}\
                 [feasible]\nspeed = [1, 2]\ncost = {{ run = 1 }}\n\
                 [[condition]]\nid = 'a'\nrole = 'fit'\nspeed = 1\nangle_deg = 90\nshape = 'sphere'\n\
                 diameter = 0.01\nmass = 0.01\n"
            ));
        }
    }
    texts.push(
        "[[bed]]\nname = 'a'\n[[bed]]\nname = 'b'\n[[condition]]\nid = 'a'\nbed = 'a'\nshape = 'sphere'\n"
            .to_owned(),
    );
    texts
}
