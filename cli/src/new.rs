//! `plunge new`: a commented starter model in the current folder.

use std::fs::{self, OpenOptions};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use anyhow::Context;
use configs::json_schema::header;
use configs::{SHIPPED, Shipped, find_shipped, nearest};
use serde_json::json;

use crate::new_schemas::{self, MODEL};
use crate::new_set;
use crate::output::{self, CommandError, CommandResult};
use crate::table_file;

/// Arguments of `plunge new`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// Name of the model and, with .toml, of the file: a-z, 0-9, - and _. The name `measurements` makes a
    /// folder of that name with a measurement set, the name `schemas` one with schemas for editors.
    #[arg(required_unless_present = "list")]
    name: Option<String>,
    /// The shipped model to start from: the one of that name if there is one, else vertical-2d.
    #[arg(long, value_name = "SHIPPED")]
    from: Option<String>,
    /// List the shipped models.
    #[arg(long)]
    list: bool,
    /// Print one JSON object to stdout.
    #[arg(long)]
    json: bool,
    /// Print nothing on success.
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
    if name == new_set::NAME {
        return new_set::run(args.json, args.quiet);
    }
    if name == new_schemas::NAME {
        return new_schemas::run(args.json, args.quiet);
    }
    let fits = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-' || c == '_';
    if name.is_empty() || name.len() > 64 || !name.chars().all(fits) {
        return Err(CommandError::bad_input(format!(
            "`{name}` is not a valid name: use 1 to 64 of a-z, 0-9, - and _"
        )));
    }
    let shipped = match &args.from {
        Some(from) => find_shipped(from).ok_or_else(|| unknown(from))?,
        None => find_shipped(name).unwrap_or(&SHIPPED[0]),
    };
    let file = PathBuf::from(format!("{name}.toml"));
    write_new(&file, &starter(shipped, name))?;
    match (args.json, args.quiet) {
        (true, _) => output::json_to_stdout(&json!({
            "file": file.display().to_string(),
            "from": shipped.name,
        })),
        (false, true) => Ok(()),
        (false, false) => output::to_stdout(&format!(
            "{0} written, from {1}\nplunge check {0}   shows what it means\nplunge run {0}     runs it\n",
            file.display(),
            shipped.name
        )),
    }
}

fn list(as_json: bool) -> CommandResult {
    if as_json {
        let models: Vec<_> = SHIPPED
            .iter()
            .map(|shipped| json!({ "name": shipped.name, "summary": shipped.summary }))
            .collect();
        return output::json_to_stdout(&json!({ "models": models }));
    }
    let lines: Vec<String> = SHIPPED
        .iter()
        .map(|shipped| format!("{:<21}{}\n", shipped.name, shipped.summary))
        .collect();
    output::to_stdout(&lines.concat())
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
    format!("{}{text}{more}", header(&format!("./{}/{MODEL}", new_schemas::NAME)))
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
