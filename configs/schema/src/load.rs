//! From a file, a shipped name or a text to a checked [`Model`].

use std::fmt;
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::diagnostics::{
    Color, Diagnostic, Severity, Sources, nearest, printable, render_all, shorten,
};
use crate::document::{self, Table};
use crate::model::Model;
use crate::read::DataFolder;
use crate::reader::{FileKind, Reader};
use crate::shipped::{self, SHIPPED, Shipped};
use crate::{checks, limits, paths, read, set};

/// Where a model comes from.
#[derive(Clone, Debug)]
pub enum ModelSource {
    /// A file.
    Path(PathBuf),
    /// One that comes with the program.
    Shipped(&'static Shipped),
    /// A text, whose data files are looked for below `folder`.
    Text {
        /// What messages call it.
        name: String,
        /// The TOML.
        text: String,
        /// Where relative paths start.
        folder: PathBuf,
    },
}

impl ModelSource {
    /// What a MODEL argument means: an existing file, else the name of a shipped model, else a
    /// file that [`Model::load`] will not find.
    pub fn from_argument(argument: impl AsRef<Path>) -> Self {
        let path = argument.as_ref();
        if path.exists() {
            return Self::Path(path.to_owned());
        }
        match path.to_str().and_then(shipped::find) {
            Some(shipped) => Self::Shipped(shipped),
            None => Self::Path(path.to_owned()),
        }
    }

    /// The same model as a text, read once.
    pub fn into_text(self) -> Result<Self, ConfigError> {
        let (name, text, folder) = self.open()?;
        Ok(Self::Text { name, text, folder })
    }

    /// Name for messages, text, and the folder that relative paths start from.
    pub fn open(self) -> Result<(String, String, PathBuf), ConfigError> {
        match self {
            Self::Shipped(shipped) => {
                let name = format!("{}.toml (shipped)", shipped.name);
                Ok((name, shipped.text.to_owned(), PathBuf::from(".")))
            }
            Self::Text { name, text, folder } => {
                if text.len() as u64 > limits::FILE_BYTES {
                    let reason = Reason::TooLarge(text.len() as u64).to_string();
                    return Err(ConfigError::Unreadable { name, reason });
                }
                Ok((name, text, folder))
            }
            Self::Path(path) => {
                let name = path.display().to_string();
                let unreadable =
                    |reason: String| ConfigError::Unreadable { name: name.clone(), reason };
                let bytes = paths::read_bounded(&path, &name, limits::FILE_BYTES)
                    .map_err(|error| unreadable(Reason::from(error, &path).to_string()))?;
                let text = String::from_utf8(bytes).map_err(|error| {
                    let at = error.utf8_error().valid_up_to();
                    let line = 1 + error.as_bytes()[..at].iter().filter(|b| **b == b'\n').count();
                    unreadable(format!("line {line} is not UTF-8; save the file as UTF-8"))
                })?;
                let folder = match path.parent() {
                    Some(folder) if folder != Path::new("") => folder.to_owned(),
                    _ => PathBuf::from("."),
                };
                Ok((name, text, folder))
            }
        }
    }
}

/// What the command line says about a model.
#[derive(Clone, Debug, Default)]
pub struct LoadOptions {
    /// `--set key.path=value`, in order; the last one wins.
    pub sets: Vec<String>,
    /// `--seed`, in place of `run.seed`.
    pub seed: Option<u64>,
    /// `--allow-path`: folders that data files may lie in, besides the project's own.
    pub allow_paths: Vec<PathBuf>,
}

/// A model and what came with it.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The model.
    pub model: Model,
    /// What its author should look at.
    pub warnings: Vec<Diagnostic>,
    /// The texts that diagnostics point into.
    pub sources: Sources,
    /// The file as it stands, without what the command line changed.
    pub original: String,
}

impl Loaded {
    /// All warnings as shown to the user.
    pub fn render_warnings(&self, color: Color) -> String {
        render_all(&self.warnings, &self.sources, color)
    }
}

/// Why there is no model.
#[derive(Clone, Debug, Error)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum ConfigError {
    #[error("error: {}: {}", printable(name), printable(reason))]
    Unreadable { name: String, reason: String },
    #[error("{}", render_all(diagnostics, sources, Color::Off))]
    Invalid { diagnostics: Vec<Diagnostic>, sources: Sources },
}

impl ConfigError {
    /// The error as shown to the user, ending in a line break.
    pub fn render(&self, color: Color) -> String {
        match self {
            Self::Unreadable { .. } => format!("{self}\n"),
            Self::Invalid { diagnostics, sources } => render_all(diagnostics, sources, color),
        }
    }
}

impl Model {
    /// Reads and checks a model, with what the command line changes in it.
    ///
    /// # Errors
    /// Everything that is wrong with it, at once.
    pub fn load(source: ModelSource, options: &LoadOptions) -> Result<Loaded, ConfigError> {
        let (name, text, folder) = source.open()?;
        let mut sources = Sources::default();
        let id = sources.add(name, text.as_str());
        let mut root = match document::parse(&sources, id) {
            Ok(root) => root,
            Err(diagnostic) => {
                return Err(ConfigError::Invalid { diagnostics: vec![*diagnostic], sources });
            }
        };
        let mut diagnostics = Vec::new();
        for set in &options.sets {
            diagnostics.extend(
                set::apply_set(&mut root, &mut sources, "--set", set).err().map(|one| *one),
            );
        }
        if let Some(seed) = options.seed.filter(|seed| i64::try_from(*seed).is_err()) {
            let largest = i64::MAX;
            let message = format!("--seed {seed} is too large; at most {largest} is accepted");
            diagnostics.push(Diagnostic::error(message));
        } else if let Some(seed) = options.seed {
            let set = format!("run.seed={seed}");
            diagnostics.extend(
                set::apply_set(&mut root, &mut sources, "--seed", &set).err().map(|one| *one),
            );
        }
        let data = DataFolder { folder: &folder, allow_paths: &options.allow_paths, known: None };
        let loaded = understood(&root, (sources, diagnostics), &data)?;
        Ok(Loaded { original: text, ..loaded })
    }
}

/// The model that `root` is, read and checked, where `diagnostics` were found already.
///
/// # Errors
/// Everything that is wrong with it, at once.
pub(crate) fn understood(
    root: &Table,
    (sources, diagnostics): (Sources, Vec<Diagnostic>),
    data: &DataFolder<'_>,
) -> Result<Loaded, ConfigError> {
    let reader = Reader::new(&sources, FileKind::Model);
    diagnostics.into_iter().for_each(|one| reader.report(one));
    let read = read::model(reader.root(root), data);
    if let Some((model, places)) = &read {
        checks::check(model, places, &reader);
    }
    let (diagnostics, resolved) = reader.finish();
    let failed = diagnostics.iter().any(|one| one.severity == Severity::Error);
    match read {
        Some((model, _)) if !failed => {
            let model = Model {
                resolved: resolved.text(),
                bed_key: resolved.bed_key_text(),
                hash: blake3::hash(resolved.hashed_text().as_bytes()).to_hex().to_string(),
                lines: resolved,
                ..model
            };
            Ok(Loaded { model, warnings: diagnostics, sources, original: String::new() })
        }
        _ => Err(ConfigError::Invalid { diagnostics, sources }),
    }
}

/// Why a model file cannot be read, in words that do not repeat its name.
enum Reason {
    NotFound(Option<&'static str>),
    NotRegular,
    TooLarge(u64),
    Other(String),
}

impl Reason {
    fn from(error: paths::PathError, path: &Path) -> Self {
        match error {
            paths::PathError::Io { source, .. }
                if source.kind() == std::io::ErrorKind::NotFound =>
            {
                let stem = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
                Self::NotFound(nearest(stem, SHIPPED.iter().map(|shipped| shipped.name)))
            }
            paths::PathError::Io { source, .. } => Self::Other(paths::in_words(&source)),
            paths::PathError::NotRegular(_) => Self::NotRegular,
            paths::PathError::TooLarge { size, .. } => Self::TooLarge(size),
            other => Self::Other(shorten(&other.to_string())),
        }
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFound(near) => {
                f.write_str("there is no such file, and no shipped model of that name")?;
                match near {
                    Some(near) => write!(f, "; did you mean `{near}`?"),
                    None => f.write_str("; `plunge new --list` lists the shipped ones"),
                }
            }
            Self::NotRegular => f.write_str("this is not a regular file"),
            Self::TooLarge(size) => {
                write!(f, "it has {size} bytes; at most {} are read", limits::FILE_BYTES)
            }
            Self::Other(reason) => f.write_str(reason),
        }
    }
}
