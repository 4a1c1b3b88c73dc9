//! States on disk: whole or not there, and never trusted unread.
//!
//! A file is a magic word, a format number, the key of what it belongs to, and a payload with its
//! checksum. It is written under a temporary name, forced to disk and renamed; the one before is
//! kept beside it.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde::de::DeserializeOwned;
use thiserror::Error;

const MAGIC: &[u8; 8] = b"plunge\0\x01";

/// Number of the layout of the payloads; a change of any saved type raises it.
pub const FORMAT: u32 = 12;

const HEADER: usize = 8 + 4 + 32 + 32;

/// What was to be written or read.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum CheckpointError {
    #[error("cannot {action} {path}: {source}")]
    Io { action: &'static str, path: PathBuf, source: io::Error },
    #[error("{path} is damaged: {what}")]
    Damaged { path: PathBuf, what: &'static str },
    #[error("{path} has format {found}, this version reads format {FORMAT}")]
    Format { path: PathBuf, found: u32 },
    #[error("{path} belongs to other inputs")]
    OtherInputs { path: PathBuf },
}

/// Writes `state`, which belongs to inputs with hash `key`, to `path`; the file that was there
/// becomes `path` + `.prev`.
///
/// # Errors
/// If the system refuses; the file that was there is then still there, under one of the two names.
pub fn save<T: Serialize>(path: &Path, key: &[u8; 32], state: &T) -> Result<(), CheckpointError> {
    let fail = |action, path: &Path| {
        let path = path.to_owned();
        move |source| CheckpointError::Io { action, path, source }
    };
    let payload = postcard::to_stdvec(state).map_err(|error| CheckpointError::Io {
        action: "encode",
        path: path.to_owned(),
        source: io::Error::other(error),
    })?;
    let partial = with_suffix(path, ".partial");
    let mut file = File::create(&partial).map_err(fail("create", &partial))?;
    let checksum = blake3::hash(&payload);
    for bytes in [&MAGIC[..], &FORMAT.to_le_bytes(), key, checksum.as_bytes(), &payload] {
        file.write_all(bytes).map_err(fail("write", &partial))?;
    }
    file.sync_all().map_err(fail("write", &partial))?;
    drop(file);
    if path.exists() {
        fs::rename(path, with_suffix(path, ".prev")).map_err(fail("rename", path))?;
    }
    fs::rename(&partial, path).map_err(fail("rename", &partial))?;
    sync_folder_of(path).map_err(fail("sync the folder of", path))
}

/// Reads what [`save`] wrote for the same `key`.
///
/// # Errors
/// If it cannot be read, is damaged, of another format, or of other inputs.
pub fn load<T: DeserializeOwned>(path: &Path, key: &[u8; 32]) -> Result<T, CheckpointError> {
    let bytes = fs::read(path).map_err(|source| CheckpointError::Io {
        action: "read",
        path: path.to_owned(),
        source,
    })?;
    let damaged = |what| CheckpointError::Damaged { path: path.to_owned(), what };
    if bytes.len() < HEADER || !bytes.starts_with(MAGIC) {
        return Err(damaged("it does not begin as a checkpoint of plunge"));
    }
    let (header, payload) = bytes.split_at(HEADER);
    let mut number = [0; 4];
    number.copy_from_slice(&header[8..12]);
    let found = u32::from_le_bytes(number);
    if found != FORMAT {
        return Err(CheckpointError::Format { path: path.to_owned(), found });
    }
    if header[44..] != blake3::hash(payload).as_bytes()[..] {
        return Err(damaged("its checksum is wrong"));
    }
    if header[12..44] != key[..] {
        return Err(CheckpointError::OtherInputs { path: path.to_owned() });
    }
    postcard::from_bytes(payload).map_err(|_| damaged("its payload cannot be decoded"))
}

/// Reads `path`, or the one before it where `path` is missing or damaged; says in the second value
/// why the first choice was not taken.
///
/// # Errors
/// If neither can be used: the error of the first, or of the one before where the first is missing.
pub fn load_latest<T: DeserializeOwned>(
    path: &Path,
    key: &[u8; 32],
) -> Result<(T, Option<CheckpointError>), CheckpointError> {
    match load(path, key) {
        Ok(state) => Ok((state, None)),
        Err(first) => match load(&with_suffix(path, ".prev"), key) {
            Ok(state) => Ok((state, Some(first))),
            Err(second) => Err(if first.is_missing() { second } else { first }),
        },
    }
}

impl CheckpointError {
    /// Whether there is no such file.
    pub fn is_missing(&self) -> bool {
        matches!(self, Self::Io { source, .. } if source.kind() == io::ErrorKind::NotFound)
    }
}

/// Writes the file `path` whole or not at all, and brings its name to the disk.
///
/// # Errors
/// If the system refuses: then what was there is there still, and nothing else.
pub fn write_whole(path: &Path, content: &[u8]) -> io::Result<()> {
    let partial = with_suffix(path, ".partial");
    File::create(&partial)
        .and_then(|mut file| file.write_all(content).and_then(|()| file.sync_all()))
        .and_then(|()| fs::rename(&partial, path))
        // What is there of it is worth nothing, and takes room.
        .inspect_err(|_| drop(fs::remove_file(&partial)))
        .and_then(|()| sync_folder_of(path))
}

/// `path` with `suffix` behind its name.
pub fn with_suffix(path: &Path, suffix: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(suffix);
    name.into()
}

/// Forces the names in the folder of `path` to disk.
pub(crate) fn sync_folder_of(path: &Path) -> io::Result<()> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    File::open(folder.unwrap_or(Path::new(".")))?.sync_all()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_damaged_file_is_refused_and_the_one_before_taken() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state");
        save(&path, &[1; 32], &vec![1.0, 2.0]).unwrap();
        save(&path, &[1; 32], &vec![3.0]).unwrap();
        assert_eq!(load::<Vec<f64>>(&path, &[1; 32]).unwrap(), [3.0]);
        let whole = fs::read(&path).unwrap();
        for cut in 0..whole.len() {
            fs::write(&path, &whole[..cut]).unwrap();
            let (state, why) = load_latest::<Vec<f64>>(&path, &[1; 32]).unwrap();
            assert_eq!(state, [1.0, 2.0], "cut at {cut}");
            assert!(matches!(why, Some(CheckpointError::Damaged { .. })), "cut at {cut}: {why:?}");
        }
        for bit in 0..8 * whole.len() {
            let mut flipped = whole.clone();
            flipped[bit / 8] ^= 1 << (bit % 8);
            fs::write(&path, &flipped).unwrap();
            assert!(load::<Vec<f64>>(&path, &[1; 32]).is_err(), "bit {bit}");
        }
    }

    #[test]
    fn a_damaged_file_before_a_missing_one_is_not_taken_for_a_missing_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state");
        assert!(load_latest::<u32>(&path, &[1; 32]).unwrap_err().is_missing());
        fs::write(with_suffix(&path, ".prev"), b"not ours").unwrap();
        let error = load_latest::<u32>(&path, &[1; 32]).unwrap_err();
        assert!(matches!(error, CheckpointError::Damaged { .. }));
    }

    #[test]
    fn a_state_of_other_inputs_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state");
        save(&path, &[1; 32], &7_u32).unwrap();
        let error = load::<u32>(&path, &[2; 32]).unwrap_err();
        assert!(matches!(error, CheckpointError::OtherInputs { .. }));
    }
}
