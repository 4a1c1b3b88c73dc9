//! From a folder to a checked [`MeasurementSet`].

pub(crate) mod curve_table;
pub(crate) mod order;
pub(crate) mod runs;
pub(crate) mod several;
pub(crate) mod speeds;
pub(crate) mod trajectories;

use std::collections::BTreeSet;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use configs::paths::{self, PathError};
use configs::reader::{FileKind, Reader};
use configs::{Color, Diagnostic, Sources, document as toml, limits, nearest, render_all, shorten};
use thiserror::Error;

use crate::checks;
use crate::checks::agreement::Agreement;
use crate::checks::contradictions;
use crate::contradiction::{Contradiction, ContradictionKind};
use crate::document::{self, Document, FileName, Missing};
use crate::load::trajectories::Source;
use crate::table::Format;
use crate::table::findings::Findings;
use crate::table::row::file_name;
use crate::{Kind, MeasurementSet, Run, SurfaceDefinition};

/// A set and what came with it.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The set.
    pub set: MeasurementSet,
    /// The frame of reference in the words of the set; nothing is done with them.
    pub frame: Option<String>,
    /// The part of the motion that was analysed, in the words of the set.
    pub phase: Option<String>,
    /// The columns that were understood, one line for each table.
    pub tables: Vec<String>,
    /// What its author should look at; it stands in [`MeasurementSet::notes`] too.
    pub warnings: Vec<Diagnostic>,
    /// What the frames say of zeros, speeds and definitions.
    pub agreement: Agreement,
    /// Where the set contradicts itself beyond its noise: nothing should be fitted to it as it is.
    pub contradictions: Vec<Contradiction>,
    /// The texts that diagnostics point into.
    pub sources: Sources,
}

impl Loaded {
    /// The contradictions of these kinds as shown to the user.
    pub fn render_contradictions(&self, kinds: &[ContradictionKind], color: Color) -> String {
        let all = self.contradictions.iter().filter(|one| kinds.contains(&one.kind));
        let diagnostics: Vec<Diagnostic> = all.map(|one| one.diagnostic.clone()).collect();
        render_all(&diagnostics, &self.sources, color)
    }

    /// All warnings as shown to the user.
    pub fn render_warnings(&self, color: Color) -> String {
        render_all(&self.warnings, &self.sources, color)
    }
}

/// Why there is no set: everything that is wrong with it, at once.
#[derive(Clone, Debug, Error)]
#[error("{}", self.render(Color::Off))]
pub struct SetError {
    /// Every error, and the warnings.
    pub diagnostics: Vec<Diagnostic>,
    /// The texts that they point into.
    pub sources: Sources,
}

impl SetError {
    /// The error as shown to the user.
    pub fn render(&self, color: Color) -> String {
        render_all(&self.diagnostics, &self.sources, color)
    }
}

impl From<Findings> for SetError {
    fn from(findings: Findings) -> Self {
        Self { diagnostics: findings.diagnostics, sources: findings.sources }
    }
}

/// Reports names in `keep` that are not runs.
fn refuse_unknown_kept(set: &MeasurementSet, findings: &mut Findings) {
    let names: BTreeSet<&str> = set.runs.iter().map(|run| run.name.as_str()).collect();
    for name in set.keep.iter().filter(|name| !names.contains(name.as_str())) {
        let near = nearest(name, names.iter().copied());
        let help = near.map(|near| format!("did you mean `{near}`?"));
        let message =
            format!("`keep` names the run `{}`, which the set does not have", shorten(name));
        findings.report(
            Diagnostic::error(message)
                .help(help.unwrap_or_else(|| "write names from the column `run`".to_owned())),
        );
    }
}

impl MeasurementSet {
    /// Reads and checks the set in the folder `path`, or whose `measurement.toml` is `path`.
    ///
    /// # Errors
    /// Everything that is wrong with `measurement.toml`; if nothing is, everything that is wrong
    /// with its tables.
    pub fn load(path: &Path) -> Result<Loaded, SetError> {
        Self::load_over_grains(path, 0.0)
    }

    /// The same for a set whose zeros are checked with `grains`, the largest grain diameter (m), if it states no grain size: the
    /// first grain that a body meets may lie above or below the mean surface.
    ///
    /// # Errors
    /// As [`MeasurementSet::load`].
    pub fn load_over_grains(path: &Path, grains: f64) -> Result<Loaded, SetError> {
        let mut findings = Findings::default();
        let file = match path.is_dir() {
            true => path.join("measurement.toml"),
            false => path.to_owned(),
        };
        let document = match read_document(&file, &mut findings) {
            Some(document) if findings.errors() == 0 => document,
            _ => return Err(findings.into()),
        };
        let folder = match file.parent() {
            Some(folder) if folder != Path::new("") => folder,
            _ => Path::new("."),
        };
        let mut set = document.set.clone();
        let warnings: Vec<String> =
            findings.diagnostics.iter().map(|one| format!("{}.", one.message)).collect();
        std::mem::take(&mut set.notes)
            .into_iter()
            .chain(warnings)
            .for_each(|one| findings.note(one));
        let tables = read_tables(&mut set, &document, folder, &mut findings);
        if findings.errors() > 0 {
            return Err(findings.into());
        }
        refuse_unknown_kept(&set, &mut findings);
        order::sort(&mut set.runs);
        speeds::fill(&mut set, &document.places, &mut findings);
        if findings.errors() > 0 {
            return Err(findings.into());
        }
        if !document.states_surface {
            set.surface = SurfaceDefinition::shown_by(&set, set.coarsest_grains().max(grains));
        }
        if !document.states_surface && set.surface == SurfaceDefinition::Mean {
            findings.note(
                "Assumed, because depths at first contact differ between runs: measurement.surface_definition = \"mean\"."
                    .to_owned(),
            );
        }
        let contradictions = checks::check(&set, &document, &mut findings);
        if findings.errors() > 0 {
            return Err(findings.into());
        }
        let agreement = Agreement::of(&set, grains, &document);
        let contradictions =
            contradictions::find(&set, &agreement, (&document, contradictions, &mut findings));
        set.notes = findings.notes;
        Ok(Loaded {
            set,
            frame: document.frame,
            phase: document.phase,
            tables,
            warnings: findings.diagnostics,
            agreement,
            contradictions,
            sources: findings.sources,
        })
    }
}

fn read_document(file: &Path, findings: &mut Findings) -> Option<Document> {
    let name = file.display().to_string();
    let bytes = paths::read_bounded(file, &name, limits::FILE_BYTES)
        .map_err(|error| findings.report(Diagnostic::error(error.to_string())))
        .ok()?;
    let text = String::from_utf8(bytes)
        .map_err(|error| {
            let valid = &error.as_bytes()[..error.utf8_error().valid_up_to()];
            let line = 1 + valid.iter().filter(|byte| **byte == b'\n').count();
            let what = format!("{name}: line {line} is not UTF-8; save the file as UTF-8");
            findings.report(Diagnostic::error(what));
        })
        .ok()?;
    let id = findings.sources.add(name, text);
    let root = match toml::parse(&findings.sources, id) {
        Ok(root) => root,
        Err(diagnostic) => {
            findings.report(*diagnostic);
            return None;
        }
    };
    let reader = Reader::new(&findings.sources, FileKind::MeasurementSet);
    let document = document::read(reader.root(&root));
    findings.diagnostics = reader.into_diagnostics();
    document
}

/// Reads the tables into `set`, and gives what is understood of each.
fn read_tables(
    set: &mut MeasurementSet,
    document: &Document,
    folder: &Path,
    findings: &mut Findings,
) -> Vec<String> {
    let files = &document.files;
    let mut tables = Vec::new();
    let Some((name, file)) = open(&files.runs, folder, findings) else { return tables };
    let (format, missing) = (&files.format, files.missing);
    let read = runs::read((&name, file), &set.conditions, format, missing, findings);
    findings.point_at(files.runs.span, "this table");
    let Some(read) = read else { return tables };
    set.runs = read.runs;
    tables.push(format!("{}: {}", file_name(&name), read.columns));
    if findings.errors() == 0 && !files.readings.is_empty() {
        let names = several::expand(&files.readings, folder, findings);
        let is_vertical = set.conditions.iter().all(|one| one.angle_deg >= 90.0);
        let mut rows = 0;
        for named in &names {
            let Some((name, file)) = open(named, folder, findings) else { break };
            let source = Source { name: &name, reader: file, is_one_of: names.len(), is_vertical };
            let (how, so_far) = ((format, missing), (&mut rows, &mut *findings));
            let columns = match set.kind.curve() {
                Some(curve) => curve_table::read(curve, source, &mut set.runs, how, so_far),
                None => trajectories::read(source, &mut set.runs, how, so_far),
            };
            tables.extend(columns.map(|columns| format!("{}: {columns}", file_name(&name))));
            findings.point_at(named.span, "this table");
            if findings.errors() > 0 {
                break;
            }
        }
        shift(set, &read.zeros, format);
        if findings.errors() == 0 {
            settle_empty_runs(set, missing, findings);
        }
        findings.point_at(files.readings[0].span, "this table");
    }
    if findings.errors() == 0 {
        find_empty_conditions(set, document, findings);
    }
    tables
}

/// Counts the frames of every run from its own zeros.
fn shift(set: &mut MeasurementSet, zeros: &[[f64; 2]], format: &Format) {
    let sign = |key: &str| format.columns.of(key).map_or(1.0, |column| column.sign);
    let (clock, depth) = (sign("t"), sign("z"));
    let is_over_depth = set.kind == Kind::ForceDepth;
    for (run, [t, z]) in set.runs.iter_mut().zip(zeros) {
        for frame in &mut run.frames {
            frame.t -= clock * t;
            frame.z -= depth * z;
        }
        for sample in &mut run.samples {
            sample.at -= if is_over_depth { depth * z } else { clock * t };
        }
    }
}

/// A table of the set, and what messages call it.
fn open(
    named: &FileName,
    folder: &Path,
    findings: &mut Findings,
) -> Option<(String, BufReader<File>)> {
    let open = || -> Result<_, PathError> {
        let path = paths::resolve_below(&named.name, folder)?;
        paths::open_regular(&path, &named.name)
    };
    match open() {
        Ok(file) => {
            let name = folder.join(&named.name).display().to_string();
            Some((name, BufReader::with_capacity(1 << 16, file)))
        }
        Err(error) => {
            let diagnostic = Diagnostic::error(error.to_string()).at(named.span, "cannot be read");
            findings.report(diagnostic);
            None
        }
    }
}

/// Refuses or drops runs that the trajectories do not have.
fn settle_empty_runs(set: &mut MeasurementSet, missing: Missing, findings: &mut Findings) {
    let empty = || set.runs.iter().filter(|run| !run.has_readings());
    let n = empty().count();
    if n == 0 {
        return;
    }
    let names: Vec<String> =
        empty().take(10).map(|run| format!("`{}`", shorten(&run.name))).collect();
    let more = if n > names.len() { ", …" } else { "" };
    let names = format!("{}{more}", names.join(", "));
    let what = set.kind.curve().map_or("trajectory", |_| "reading");
    match missing {
        Missing::Error => findings.report(
            Diagnostic::error(format!("there is no {what} of the runs {names}"))
                .help("remove them from the table of runs, or write missing = \"drop\""),
        ),
        Missing::Drop => {
            findings.note(format!("Runs without a {what} were dropped: {names}."));
            set.runs.retain(Run::has_readings);
        }
    }
}

/// Refuses conditions without a run.
fn find_empty_conditions(set: &MeasurementSet, document: &Document, findings: &mut Findings) {
    let mut measured = vec![false; set.conditions.len()];
    set.runs.iter().for_each(|run| measured[run.condition] = true);
    for (index, condition) in set.conditions.iter().enumerate() {
        if !measured[index] && !findings.full() {
            let id = shorten(&condition.id);
            findings.report(
                Diagnostic::error(format!("the condition `{id}` has no run"))
                    .at(document.places[index].id, "nothing was measured under it")
                    .help("add its runs to the table, or remove the condition"),
            );
        }
    }
}
