//! `import.toml`: what makes the same set again.

use std::path::{Component, Path, PathBuf};

use configs::reader::{FileKind, Reader};
use configs::{Color, Diagnostic, Sources, document, limits, paths, render_all, toml_string};

use super::fault::{Fault, TrackingError};
use super::inputs;
use super::options::Options;

/// Its name.
pub const IMPORT_FILE: &str = "import.toml";

/// An import that was written down.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ImportFile {
    /// The tables.
    pub files: Vec<PathBuf>,
    /// What stood in them.
    hashes: Vec<String>,
    /// What was said beside them.
    pub options: Options,
}

impl ImportFile {
    /// Reads the file at `path`; paths in it count from its folder.
    ///
    /// # Errors
    /// What is wrong with it, or that a table has changed since.
    pub fn read(path: &Path) -> Result<Self, TrackingError> {
        let name = path.display().to_string();
        let refused = |what: String| TrackingError::ImportFile(format!("error: {what}\n"));
        let bytes = paths::read_bounded(path, &name, limits::FILE_BYTES)
            .map_err(|error| refused(error.to_string()))?;
        let text = String::from_utf8(bytes).map_err(|_| refused(format!("{name} is not UTF-8")))?;
        let mut sources = Sources::default();
        let id = sources.add(name, text);
        let shown =
            |all: &[Diagnostic]| TrackingError::ImportFile(render_all(all, &sources, Color::Off));
        let parsed = document::parse(&sources, id).map_err(|error| shown(&[*error]))?;
        let reader = Reader::new(&sources, FileKind::Import);
        let root = reader.root(&parsed);
        let example = "files = [\"drop-1.csv\"]\nblake3 = [\"…\"]";
        let table = root.table("import", Some(example));
        let (files, hashes) = (table.texts("files"), table.texts("blake3"));
        table.finish();
        let given = root.table("options", None);
        let mut options = Options::default();
        for (key, meaning) in Options::KEYS {
            if given.has(key)
                && let Some(found) = given.text(key, None, "…", meaning)
            {
                options.set(key, found.value);
            }
        }
        given.finish();
        root.finish();
        let diagnostics = reader.into_diagnostics();
        let (Some(files), Some(hashes)) = (files, hashes) else {
            let missing = Diagnostic::error("[import] lists `files` and their `blake3`");
            return Err(shown(if diagnostics.is_empty() {
                std::slice::from_ref(&missing)
            } else {
                &diagnostics
            }));
        };
        if !diagnostics.is_empty() {
            return Err(shown(&diagnostics));
        }
        let folder = path.parent().unwrap_or(Path::new(""));
        let there = |file: &String| plain(&folder.join(file));
        if let Some(bodies) = options.get("bodies") {
            let bodies = plain(&folder.join(bodies)).display().to_string();
            options.set("bodies", bodies);
        }
        Ok(Self { files: files.iter().map(there).collect(), hashes, options })
    }

    /// Refuses tables that are not what they were.
    ///
    /// # Errors
    /// Those that changed, or cannot be read.
    pub fn refuse_changed(&self) -> Result<(), TrackingError> {
        let mut faults = Vec::new();
        for (at, path) in self.files.iter().enumerate() {
            match inputs::bytes(path) {
                Ok(bytes) => {
                    let hash = blake3::hash(&bytes).to_hex().to_string();
                    if self.hashes.get(at) != Some(&hash) {
                        let right = "import the tables anew, by their names";
                        let what = "it is not what it was when import.toml was written";
                        faults.push(Fault::new(&path.display().to_string(), what, right));
                    }
                }
                Err(fault) => faults.push(fault),
            }
        }
        if faults.is_empty() { Ok(()) } else { Err(faults.into()) }
    }
}

/// The text of `import.toml` in the folder `out`.
pub(super) fn text(files: &[PathBuf], hashes: &[String], options: &Options, out: &Path) -> String {
    let list = |values: &mut dyn Iterator<Item = String>| {
        values.map(|value| format!("    {},\n", toml_string(&value))).collect::<String>()
    };
    let files = list(&mut files.iter().map(|file| relative(file, out)));
    let hashes = list(&mut hashes.iter().cloned());
    let mut text = format!(
        "# `plunge import import.toml -o SET` makes this set again, byte for byte, from the same tables.\n\n\
         [import]\nfiles = [\n{files}]\nblake3 = [\n{hashes}]\n\n[options]\n"
    );
    for (key, value) in options.given() {
        let value = match key {
            "bodies" => relative(Path::new(value), out),
            _ => value.to_owned(),
        };
        text.push_str(&format!("{key} = {}\n", toml_string(&value)));
    }
    text
}

/// `path` relative to `folder`, with `/` between its parts.
fn relative(path: &Path, folder: &Path) -> String {
    let absolute =
        |path: &Path| plain(&std::path::absolute(path).unwrap_or_else(|_| path.to_owned()));
    let (path, folder) = (absolute(path), absolute(folder));
    let parts = |path: &Path| -> Vec<String> {
        path.components().map(|part| part.as_os_str().to_string_lossy().into_owned()).collect()
    };
    let (own, other) = (parts(&path), parts(&folder));
    let shared = own.iter().zip(&other).take_while(|(a, b)| a == b).count();
    let up = std::iter::repeat_n("..".to_owned(), other.len() - shared);
    up.chain(own[shared..].iter().cloned()).collect::<Vec<_>>().join("/")
}

/// A path without `.` and without a folder that is left again.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        let leaves = matches!(part, Component::ParentDir)
            && matches!(plain.components().next_back(), Some(Component::Normal(_)));
        match part {
            Component::CurDir => {}
            _ if leaves => {
                plain.pop();
            }
            part => plain.push(part),
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_count_from_the_folder_of_the_set() {
        assert_eq!(
            relative(Path::new("a/drops/1.csv"), Path::new("a/sets/my")),
            "../../drops/1.csv"
        );
        assert_eq!(relative(Path::new("./1.csv"), Path::new("my")), "../1.csv");
        assert_eq!(plain(Path::new("my/../drops/./1.csv")), Path::new("drops/1.csv"));
        assert_eq!(plain(Path::new("../1.csv")), Path::new("../1.csv"));
    }
}
