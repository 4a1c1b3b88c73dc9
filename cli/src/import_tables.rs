//! `plunge import` of tables: arguments in, what was understood out.

use std::path::{Path, PathBuf};

use exchange::tracking::{
    IMPORT_FILE, ImportFile, Options, Set, TrackingError, Understood, import,
};
use measurements::{ContradictionKind, Loaded, MeasurementSet};
use serde_json::json;

use crate::BEGINS_AGAIN;
use crate::control::stopped;
use crate::import_args::{Args, Tables};
use crate::output::{self, CommandError, CommandResult, stderr_color};
use crate::signals;
use crate::text::{lines, table};

impl Tables {
    fn options(&self) -> Result<Options, CommandError> {
        let bodies = self.bodies.as_ref().map(|path| path.display().to_string());
        let texts = [
            ("id", &self.id),
            ("shape", &self.shape),
            ("diameter", &self.diameter),
            ("mass", &self.mass),
            ("height", &self.height),
            ("apex", &self.apex),
            ("shaft_diameter", &self.shaft_diameter),
            ("bodies", &bodies),
            ("surface", &self.surface),
            ("tracked", &self.tracked),
            ("scale", &self.scale),
            ("rate", &self.rate),
            ("length_unit", &self.length_unit),
            ("time_unit", &self.time_unit),
            ("gravity", &self.gravity),
            ("drop_height", &self.drop_height),
            ("condition", &self.condition),
            ("leave_out", &self.leave_out),
            ("bed_depth", &self.bed_depth),
            ("bulk_density", &self.bulk_density),
            ("grain_diameter", &self.grain_diameter),
        ];
        let mut options = Options::default();
        for (key, text) in texts {
            if let Some(text) = text {
                options.set(key, text.as_str());
            }
        }
        for (key, is_set, word) in [
            ("counts", self.up, "up"),
            ("counts", self.down, "down"),
            ("trust_units", self.trust_units, "yes"),
        ] {
            if is_set {
                options.set(key, word);
            }
        }
        for column in &self.column {
            let known = |key: &str| ["t", "z", "x", "run"].contains(&key);
            match column.split_once('=').filter(|(key, name)| known(key) && !name.is_empty()) {
                Some((key, name)) => options.set(&format!("column_{key}"), name),
                None => {
                    return Err(CommandError::bad_input(format!(
                        "--column {column}: write t=NAME, z=NAME, x=NAME or run=NAME"
                    )));
                }
            }
        }
        Ok(options)
    }
}

pub(crate) fn run(args: &Args) -> CommandResult {
    let (files, options, written) = match import_file(args) {
        Some(path) => {
            let file = ImportFile::read(path).map_err(failed)?;
            file.refuse_changed().map_err(failed)?;
            // Options on the command line override those of the file.
            let mut options = file.options;
            options.take(args.tables.options()?);
            (file.files, options, path.parent().map(Path::to_owned))
        }
        None => (args.files.clone(), args.tables.options()?, None),
    };
    let Some(out) = args.out.clone().or(written) else {
        return Err(CommandError::bad_input(
            "where is the set to be written? add -o SET, the name of a new folder",
        ));
    };
    let out = if out.as_os_str().is_empty() { PathBuf::from(".") } else { out };
    let set = import(&files, &options, &out).map_err(failed)?;
    let is_there = out.join(IMPORT_FILE).exists() || out.join("measurement.toml").exists();
    if is_there && !args.force && !set.is_in(&out) {
        let out = out.display();
        return Err(CommandError::bad_input(format!(
            "{out} holds another set; --force replaces it"
        )));
    }
    if signals::is_asked_to_stop() {
        return Err(stopped(BEGINS_AGAIN));
    }
    let earlier = set.earlier(&out);
    let written = set.write(&out).map_err(failed);
    let loaded = written.and_then(|()| Ok(MeasurementSet::load(&out)?));
    let is_refused = loaded.as_ref().map_or(true, |loaded| !loaded.contradictions.is_empty());
    if is_refused {
        earlier.restore(&out);
    }
    let loaded = loaded?;
    if !args.quiet {
        output::to_stderr(&loaded.render_warnings(stderr_color()));
    }
    match (args.json, args.quiet) {
        (true, _) => output::json_to_stdout(&as_json(&set, &loaded, &out))?,
        (false, true) => {}
        (false, false) => output::to_stdout(&as_text(&set, &loaded, &out))?,
    }
    // As `check` does: what is there cannot be fitted to.
    match is_refused {
        false => Ok(()),
        true => Err(CommandError::BadInput(format!(
            "{}The set is refused, and nothing in its folder is changed. --surface states the level of the surface, --leave-out goes \
             on without runs.\n",
            loaded.render_contradictions(&ContradictionKind::ALL, stderr_color())
        ))),
    }
}

/// The import.toml to repeat, if the argument is one.
fn import_file(args: &Args) -> Option<&Path> {
    let is_toml = |path: &&PathBuf| path.extension().is_some_and(|ending| ending == "toml");
    match &args.files[..] {
        [only] => Some(only).filter(is_toml).map(PathBuf::as_path),
        _ => args.tables.from.as_deref(),
    }
}

fn as_text(set: &Set, loaded: &Loaded, out: &Path) -> String {
    let heads = [
        "file",
        "layout",
        "rows",
        "kept",
        "time",
        "axis",
        "run",
        "condition",
        "contact (ms)",
        "speed (m/s)",
    ];
    let mut found = table(&heads);
    for one in &set.understood {
        let Understood {
            file,
            layout,
            rows: [all, kept],
            time,
            axis,
            run,
            condition,
            contact,
            speed,
        } = one;
        found.add_row([
            file.clone(),
            layout.clone(),
            all.to_string(),
            kept.to_string(),
            time.clone(),
            axis.clone(),
            run.clone(),
            condition.clone(),
            format!("{:.2} ± {:.2}", 1e3 * contact.value, 1e3 * contact.se),
            match speed.se > 0.0 {
                true => format!("{:.4} ± {:.4}", speed.value, speed.se),
                false => format!("{:.4}", speed.value),
            },
        ]);
    }
    let mut text = lines(&found);
    text.push('\n');
    for note in &set.notes {
        text.push_str(&format!("{note}\n"));
    }
    if !loaded.contradictions.is_empty() {
        return text;
    }
    let (conditions, runs, id) =
        (loaded.set.conditions.len(), loaded.set.runs.len(), &loaded.set.id);
    let shown = out.display();
    text.push_str(&format!(
        "-> {shown}: the set {id}, {conditions} conditions, {runs} runs; next: plunge diagnose {shown}\n"
    ));
    text
}

fn as_json(set: &Set, loaded: &Loaded, out: &Path) -> serde_json::Value {
    let run = |one: &Understood| {
        json!({
            "file": one.file,
            "layout": one.layout,
            "rows": one.rows[0],
            "kept": one.rows[1],
            "time": one.time,
            "axis": one.axis,
            "run": one.run,
            "condition": one.condition,
            "contact_time_s": { "value": one.contact.value, "se": one.contact.se },
            "speed_m_per_s": { "value": one.speed.value, "se": one.speed.se },
        })
    };
    json!({
        "set": loaded.set.id,
        "folder": out.to_string_lossy(),
        // A set that contradicts itself is not left there.
        "written": loaded.contradictions.is_empty(),
        "conditions": loaded.set.conditions.len(),
        "runs": set.understood.iter().map(run).collect::<Vec<_>>(),
        "notes": set.notes,
        "contradictions": loaded.contradictions.len(),
    })
}

/// A set that cannot be written is a failure; everything else is the input's fault.
fn failed(error: TrackingError) -> CommandError {
    match error {
        TrackingError::Write { .. } => CommandError::Failed(error.into()),
        TrackingError::ImportFile(shown) => CommandError::BadInput(shown),
        TrackingError::Input(faults) => {
            let text = TrackingError::Input(faults).to_string();
            let lines =
                text.lines().map(configs::printable).map(|line| match line.starts_with(' ') {
                    true => format!("{line}\n"),
                    false => format!("error: {line}\n"),
                });
            CommandError::BadInput(lines.collect())
        }
    }
}
