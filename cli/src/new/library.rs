//! What comes with the program and can be written: models, measurement sets, starters, and files for other programs.

use std::borrow::Cow;

use configs::json_schema::header;
use configs::{SHIPPED, Shipped};
use measurements::{SHIPPED_SETS, TEMPLATE, find_shipped_set};

use super::pages::PAGES;
use super::schemas;
use crate::output::CommandError;

/// Name and text of a file.
pub(super) type Text = (&'static str, Cow<'static, str>);

/// Items that are listed together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Group {
    Models,
    Sets,
    Starters,
    Tools,
}

impl Group {
    /// All of them with their headings, in the order of the list.
    pub(super) const ALL: [(Self, &'static str, &'static str); 4] = [
        (Self::Models, "models", "Models, each a file"),
        (Self::Sets, "sets", "Measurement sets, each a folder"),
        (Self::Starters, "starters", "To fill in"),
        (Self::Tools, "tools", "For readers, editors, viewers and Python, each a folder"),
    ];
}

/// One thing that `plunge new` writes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item {
    pub(super) name: &'static str,
    pub(super) summary: &'static str,
    pub(super) group: Group,
}

/// What an item is written as.
pub(super) enum Content {
    /// A file with the name of the item and the ending `toml`.
    File(Cow<'static, str>),
    /// A folder with the name of the item.
    Folder(Vec<Text>),
}

/// The template of a set.
pub(super) const MEASUREMENTS: &str = "measurements";
const CAMPAIGN: &str = "campaign";
const EFFECT: &str = "effect";
const VIEWERS: &str = "viewers";
const SCRIPTS: &str = "scripts";
const DOCS: &str = "docs";

const OTHERS: [Item; 7] = [
    Item {
        name: MEASUREMENTS,
        summary: "A folder with a commented set of invented numbers.",
        group: Group::Starters,
    },
    Item {
        name: CAMPAIGN,
        summary: "A file with many impacts: lists, ranges and draws.",
        group: Group::Starters,
    },
    Item {
        name: EFFECT,
        summary: "A model with an effect of your own, as a formula.",
        group: Group::Starters,
    },
    Item {
        name: schemas::FOLDER,
        summary: "JSON schemas: editors complete and check TOML by them.",
        group: Group::Tools,
    },
    Item {
        name: VIEWERS,
        summary: "Layouts for Foxglove and Lichtblick, and a script for Rerun.",
        group: Group::Tools,
    },
    Item {
        name: SCRIPTS,
        summary: "Scripts and a notebook that read logs in Python.",
        group: Group::Tools,
    },
    Item { name: DOCS, summary: "The documentation.", group: Group::Tools },
];

/// Everything, group by group.
pub(super) fn items() -> Vec<Item> {
    let model = |one: &Shipped| Item { name: one.name, summary: one.summary, group: Group::Models };
    let sets = SHIPPED_SETS.iter();
    let sets = sets.map(|set| Item { name: set.name, summary: set.summary, group: Group::Sets });
    SHIPPED.iter().map(model).chain(sets).chain(OTHERS).collect()
}

/// What is written for `name`, if it is no model.
pub(super) fn content(name: &str) -> Result<Option<Content>, CommandError> {
    let plain = |files: &[(&'static str, &'static str)]| {
        Content::Folder(files.iter().map(|(name, text)| (*name, Cow::Borrowed(*text))).collect())
    };
    let found = match name {
        MEASUREMENTS => Content::Folder(set(&TEMPLATE)),
        CAMPAIGN => Content::File(with_header(
            &format!("./{}/{}", schemas::FOLDER, schemas::CAMPAIGN),
            CAMPAIGN_TEXT,
        )),
        EFFECT => Content::File(with_header(&model_schema(), EFFECT_TEXT)),
        schemas::FOLDER => {
            let files = schemas::files()?.into_iter();
            Content::Folder(files.map(|(name, text)| (name, text.into())).collect())
        }
        VIEWERS => plain(&VIEWER_FILES),
        SCRIPTS => plain(&SCRIPT_FILES),
        DOCS => plain(&PAGES),
        name => match find_shipped_set(name) {
            Some(shipped) => Content::Folder(set(shipped.files)),
            None => return Ok(None),
        },
    };
    Ok(Some(found))
}

/// Where models that are written find their schema.
pub(super) fn model_schema() -> String {
    format!("./{}/{}", schemas::FOLDER, schemas::MODEL)
}

fn with_header(schema: &str, text: &str) -> Cow<'static, str> {
    format!("{}{text}", header(schema)).into()
}

fn set(files: &[(&'static str, &'static str)]) -> Vec<Text> {
    let schema = format!("../{}/{}", schemas::FOLDER, schemas::SET);
    let text = |(name, text): &(&'static str, &'static str)| match name.ends_with(".toml") {
        true => (*name, with_header(&schema, text)),
        false => (*name, Cow::Borrowed(*text)),
    };
    files.iter().map(text).collect()
}

/// What to do with what was written.
pub(super) fn advice(name: &str) -> String {
    match name {
        MEASUREMENTS => format!(
            "plunge check {name} --out seen   shows and draws what is understood\n\
             plunge compare {name}            holds its baseline against it\n"
        ),
        CAMPAIGN => format!(
            "plunge sweep {name}.toml --plan   lists its points\n\
             plunge sweep {name}.toml          runs them\n"
        ),
        EFFECT => format!(
            "plunge check {name}.toml   says whether the formula is a force\n\
             plunge run {name}.toml     runs it\n"
        ),
        schemas::FOLDER => "What plunge new writes names them in its first line. An editor with a TOML language server \
                            completes\nand checks keys, units and ranges by them: in VS Code, the extension Even Better \
                            TOML.\n"
            .to_owned(),
        VIEWERS => "Import a layout into Foxglove or Lichtblick beside run.mcap and grains.mcap; \
                    plunge view RUN serves them.\n"
            .to_owned(),
        DOCS => "docs/tour.md goes through an impact and its diagnosis; models and messages name the other pages.\n"
            .to_owned(),
        SCRIPTS => "They read run.mcap and grains.mcap; the head of each says what it needs.\n".to_owned(),
        name => format!(
            "plunge check {name}      shows and draws what is understood\n\
             plunge diagnose {name}   names the effect that its baseline lacks\n"
        ),
    }
}

const CAMPAIGN_TEXT: &str = include_str!("../../../examples/campaign.toml");
const EFFECT_TEXT: &str = include_str!("../../templates/effect.toml");

/// The layouts of Foxglove and Lichtblick: of runs on beds of grains, and of resistive forces.
pub(crate) const LAYOUTS: [(&str, &str); 2] = [
    ("foxglove_grains.json", include_str!("../../../viewers/foxglove_grains.json")),
    ("foxglove_resistive.json", include_str!("../../../viewers/foxglove_resistive.json")),
];

const VIEWER_FILES: [(&str, &str); 3] =
    [LAYOUTS[0], LAYOUTS[1], ("rerun_impact.py", include_str!("../../../viewers/rerun_impact.py"))];

const SCRIPT_FILES: [(&str, &str); 3] = [
    ("draw_impact.py", include_str!("../../../examples/draw_impact.py")),
    ("read_log.py", include_str!("../../../examples/read_log.py")),
    ("redraw_report.ipynb", include_str!("../../../examples/redraw_report.ipynb")),
];
