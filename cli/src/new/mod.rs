//! `plunge new`: files to start from in the current folder: models, measurement sets and what else comes with the
//! program.

mod library;
mod pages;
mod schemas;

use std::fs::{self, OpenOptions};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use anyhow::Context;
use configs::json_schema::header;
use configs::{SHIPPED, Shipped, find_shipped, nearest};
use serde_json::{Map, Value, json};

pub(crate) use self::library::LAYOUTS;
use self::library::{Content, Group, Text, model_schema};
use crate::output::{self, CommandError, CommandResult};
use crate::table_file;
use crate::workbench::write_whole;

/// Arguments of `plunge new`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// What to write: a name that --list shows, or any other for a model: a-z, 0-9, - and _. A model becomes a file
    /// with .toml behind its name.
    #[arg(required_unless_present = "list")]
    name: Option<String>,
    /// The shipped model to start from: the one of that name if there is one, else vertical-2d.
    #[arg(long, value_name = "SHIPPED")]
    from: Option<String>,
    /// List everything that can be written.
    #[arg(long)]
    list: bool,
    /// Print one JSON object to stdout.
    #[arg(long)]
    json: bool,
    /// Say nothing when it went well.
    #[arg(long)]
    quiet: bool,
}

pub(crate) fn run(args: &Args) -> CommandResult {
    if let Some(from) = &args.from {
        table_file::refuse(Path::new(from))?;
    }
    let name = match (&args.name, args.list) {
        (Some(name), false) => name,
        _ => return list(args.json),
    };
    let known = if args.from.is_none() { library::content(name)? } else { None };
    let written = match known {
        Some(Content::Folder(files)) => folder(name, &files)?,
        Some(Content::File(text)) => {
            let file = PathBuf::from(format!("{name}.toml"));
            write_new(&file, &text)?;
            json!({ "file": file.display().to_string() })
        }
        None => model(name, args.from.as_deref())?,
    };
    match (args.json, args.quiet) {
        (true, _) => output::json_to_stdout(&written),
        (false, true) => Ok(()),
        (false, false) => output::to_stdout(&said(name, &written)),
    }
}

/// What was written, and what to do with it.
fn said(name: &str, written: &Value) -> String {
    if let Some(from) = written["from"].as_str() {
        let file = written["file"].as_str().unwrap_or_default();
        return format!(
            "{file} written, from {from}\nplunge check {file}   shows what it means\nplunge run {file}     runs it\n"
        );
    }
    let invented = if name == library::MEASUREMENTS { ", with invented numbers" } else { "" };
    let files: Vec<&str> =
        written["files"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
    let what = match written["file"].as_str() {
        Some(file) => format!("{file} written"),
        None => format!("{name}/ written{invented}: {}", files.join(", ")),
    };
    format!("{what}\n{}", library::advice(name))
}

/// Writes a model under its name, from the shipped one that `from` names.
fn model(name: &str, from: Option<&str>) -> Result<Value, CommandError> {
    let fits = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-' || c == '_';
    if name.is_empty() || name.len() > 64 || !name.chars().all(fits) {
        return Err(CommandError::bad_input(format!(
            "`{name}` is not a valid name: use 1 to 64 of a-z, 0-9, - and _"
        )));
    }
    let shipped = match from {
        Some(from) => find_shipped(from).ok_or_else(|| unknown(from))?,
        None => find_shipped(name).unwrap_or(&SHIPPED[0]),
    };
    let file = PathBuf::from(format!("{name}.toml"));
    write_new(&file, &starter(shipped, name))?;
    Ok(json!({ "file": file.display().to_string(), "from": shipped.name }))
}

/// Writes `files` into a folder that must not exist yet.
fn folder(name: &str, files: &[Text]) -> Result<Value, CommandError> {
    match fs::create_dir(name) {
        Err(error) if error.kind() == ErrorKind::AlreadyExists => {
            return Err(CommandError::bad_input(format!(
                "{name} exists already; rename it, or start in another folder"
            )));
        }
        made => made.with_context(|| format!("cannot make {name}"))?,
    }
    for (file, text) in files {
        write_whole(&Path::new(name).join(file), text)?;
    }
    let names: Vec<&str> = files.iter().map(|(file, _)| *file).collect();
    Ok(json!({ "folder": name, "files": names }))
}

fn list(as_json: bool) -> CommandResult {
    let items = library::items();
    if as_json {
        let of = |group: Group| {
            let items = items.iter().filter(|item| item.group == group);
            items.map(|item| json!({ "name": item.name, "summary": item.summary })).collect()
        };
        let groups: Map<String, Value> =
            Group::ALL.map(|(group, key, _)| (key.to_owned(), of(group))).into_iter().collect();
        return output::json_to_stdout(&Value::Object(groups));
    }
    let width = items.iter().map(|item| item.name.len()).max().unwrap_or_default();
    let of = |group: Group| -> String {
        let items = items.iter().filter(|item| item.group == group);
        items.map(|item| format!("  {:<width$}  {}\n", item.name, item.summary)).collect()
    };
    let groups = Group::ALL.map(|(group, _, heading)| format!("{heading}:\n{}", of(group)));
    output::to_stdout(&format!("{}\nplunge new NAME writes it here.\n", groups.join("\n")))
}

fn unknown(name: &str) -> CommandError {
    let names: Vec<&str> = SHIPPED.iter().map(|shipped| shipped.name).collect();
    let hint = match nearest(name, names.iter().copied()) {
        Some(near) => format!("did you mean `{near}`? "),
        None => String::new(),
    };
    CommandError::bad_input(format!(
        "there is no shipped model `{name}`; {hint}there are: {}",
        names.join(", ")
    ))
}

/// The shipped text under a new name, with what else could be written as comments.
fn starter(shipped: &Shipped, name: &str) -> String {
    let old = format!("name = \"{}\"", shipped.name);
    let text = shipped.text.replacen(&old, &format!("name = \"{name}\""), 1);
    let more = match text.contains("kind = \"resistive-force\"") {
        true => MORE_ON_RESISTANCE,
        false => MORE_ON_GRAINS,
    };
    format!("{}{text}{more}", header(&model_schema()))
}

const MORE_ON_GRAINS: &str = "
# Several impacts in one run: the product of these lists replaces the values above.
# [conditions]
# speed = [\"1 m/s\", \"2 m/s\", \"3 m/s\"]
# angle = [\"90 deg\", \"45 deg\"]
# positions = 6                 # drawn from the seed

# Effects are added to the contact law; `plunge effects` describes them.
# [[effect]]
# name = \"rolling-resistance\"
# rolling_friction = 0.05
";

const MORE_ON_RESISTANCE: &str = "
# Several impacts in one run: the product of these lists replaces the values above.
# [conditions]
# speed = [\"1 m/s\", \"2 m/s\", \"3 m/s\"]
# angle = [\"90 deg\", \"45 deg\"]

# A coefficient may be a number, a table over the impact angle or an expression in SI:
# friction = { angle = [\"45 deg\", \"90 deg\"], value = [12.0, 9.5] }
# friction = { expression = \"9.5 * (density / 1520)^0.5\" }

# Effects are added to the resistance law, each with one amplitude; `plunge effects` describes them.
# [[effect]]
# name = \"janssen\"
# q = 0.2
";

/// Writes a file that must not exist yet; it appears whole or not at all.
fn write_new(file: &Path, text: &str) -> CommandResult {
    let exists = || {
        CommandError::bad_input(format!(
            "{} exists already; choose another name or remove it",
            file.display()
        ))
    };
    if file.symlink_metadata().is_ok() {
        return Err(exists());
    }
    let draft = PathBuf::from(format!(".{}.{}", file.display(), std::process::id()));
    let written = OpenOptions::new()
        .write(true)
        .create_new(true)
        .open(&draft)
        .and_then(|mut out| out.write_all(text.as_bytes()).and_then(|()| out.sync_all()))
        // Unlike a rename, a link never replaces a file that came in between.
        .and_then(|()| match fs::hard_link(&draft, file) {
            Err(error) if error.kind() != ErrorKind::AlreadyExists => fs::rename(&draft, file),
            linked => linked,
        });
    // After a rename there is no draft left, and a draft that stays harms nobody.
    let _ = fs::remove_file(&draft);
    match written {
        Err(error) if error.kind() == ErrorKind::AlreadyExists => Err(exists()),
        other => Ok(other.with_context(|| format!("cannot write {}", file.display()))?),
    }
}
