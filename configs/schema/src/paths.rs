//! Which data files a model may read: regular files of bounded size, below its own project.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::limits;

/// Why a file is not read.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum PathError {
    #[error("`{path}`: {}", in_words(source))]
    Io { path: String, source: io::Error },
    #[error("`{0}`: ~ is not expanded; write a path relative to this file")]
    Home(String),
    #[error("`{0}` lies outside of the model's project; --allow-path DIR allows its folder")]
    Outside(String),
    #[error("`{0}` lies outside of the folder of this file")]
    OutsideFolder(String),
    #[error("`{0}` is not a regular file")]
    NotRegular(String),
    #[error("`{path}` has {size} bytes; at most {limit} are read")]
    TooLarge { path: String, size: u64, limit: u64 },
}

/// The folder of the project that `folder` belongs to: the nearest one upward that holds `.git` or
/// `Cargo.toml`, else `folder` itself.
fn project_root(folder: &Path) -> PathBuf {
    folder
        .ancestors()
        .find(|above| above.join(".git").exists() || above.join("Cargo.toml").exists())
        .unwrap_or(folder)
        .to_owned()
}

/// The file that a model in `folder` names `named`, without symbolic links, if it may be read.
///
/// # Errors
/// When it does not exist, is not a regular file, or lies outside of the allowed folders.
pub fn resolve(named: &str, folder: &Path, allow_paths: &[PathBuf]) -> Result<PathBuf, PathError> {
    let [folder, path] = canonical(named, folder)?;
    let root = project_root(&folder);
    let allowed = path.starts_with(&root)
        || allow_paths
            .iter()
            .filter_map(|folder| fs::canonicalize(folder).ok())
            .any(|folder| path.starts_with(folder));
    match allowed {
        true => Ok(path),
        false => Err(PathError::Outside(named.to_owned())),
    }
}

/// The file that a file in `folder` names `named`, without symbolic links, if it lies in `folder`
/// or below.
///
/// # Errors
/// When it does not exist or lies elsewhere.
pub fn resolve_below(named: &str, folder: &Path) -> Result<PathBuf, PathError> {
    let [folder, path] = canonical(named, folder)?;
    match path.starts_with(&folder) {
        true => Ok(path),
        false => Err(PathError::OutsideFolder(named.to_owned())),
    }
}

/// `folder`, and what a file in it names `named`, without symbolic links.
fn canonical(named: &str, folder: &Path) -> Result<[PathBuf; 2], PathError> {
    if named.starts_with('~') {
        return Err(PathError::Home(named.to_owned()));
    }
    let io = |source| PathError::Io { path: named.to_owned(), source };
    let folder = fs::canonicalize(folder).map_err(io)?;
    let path = fs::canonicalize(folder.join(named)).map_err(io)?;
    Ok([folder, path])
}

/// A regular file of any size, to be streamed; messages call it `named`.
pub fn open_regular(path: &Path, named: &str) -> Result<File, PathError> {
    let io = |source| PathError::Io { path: named.to_owned(), source };
    // Asked before opening: opening a pipe would wait for its writer.
    match fs::metadata(path).map_err(io)?.is_file() {
        true => File::open(path).map_err(io),
        false => Err(PathError::NotRegular(named.to_owned())),
    }
}

/// The content of a regular file of at most `limit` bytes; messages call it `named`.
pub fn read_bounded(path: &Path, named: &str, limit: u64) -> Result<Vec<u8>, PathError> {
    let io = |source| PathError::Io { path: named.to_owned(), source };
    let file = open_regular(path, named)?;
    let too_large = |size| PathError::TooLarge { path: named.to_owned(), size, limit };
    let size = file.metadata().map_err(io)?.len();
    if size > limit {
        return Err(too_large(size));
    }
    let mut bytes = Vec::new();
    file.take(limit + 1).read_to_end(&mut bytes).map_err(io)?;
    match bytes.len() as u64 > limit {
        true => Err(too_large(bytes.len() as u64)),
        false => Ok(bytes),
    }
}

/// The content of a data file.
pub(crate) fn read_data(path: &Path, named: &str) -> Result<Vec<u8>, PathError> {
    read_bounded(path, named, limits::DATA_FILE_BYTES)
}

/// The system's error, the usual ones without its number.
pub(crate) fn in_words(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "there is no such file".to_owned(),
        io::ErrorKind::PermissionDenied => "no permission to read it".to_owned(),
        _ => error.to_string(),
    }
}
