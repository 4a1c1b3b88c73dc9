//! Files and patterns of files as sheets.

use std::path::{Path, PathBuf};

use configs::paths::read_bounded;

use super::fault::Fault;
use super::sheet::Sheet;
use super::{spreadsheet, text};

/// Most bytes of one table.
const MOST: u64 = 512_000_000;

/// The files that `paths` name, without the table of bodies. Files of one pattern or folder are sorted, and no file is listed
/// twice.
///
/// # Errors
/// If a pattern fits nothing or a folder holds no table.
pub(super) fn expand(paths: &[PathBuf], bodies: Option<&Path>) -> Result<Vec<PathBuf>, Fault> {
    let is_drop = is_not(bodies);
    let mut all: Vec<PathBuf> = Vec::new();
    for path in paths {
        let shown = path.display().to_string();
        let found = match () {
            () if path.is_dir() => tables_in(path, bodies)?,
            () if !path.exists() && shown.contains(['*', '?', '[']) => fitting(&shown)?,
            () => vec![path.clone()],
        };
        for one in found {
            if is_drop(&one) && !all.contains(&one) {
                all.push(one);
            }
        }
    }
    match all.is_empty() {
        true => Err(Fault::new(
            "plunge import",
            "no table is named",
            "name tables: plunge import *.csv -o SET",
        )),
        false => Ok(all),
    }
}

/// Endings of tables that a folder is searched for.
const TABLES: [&str; 7] = ["csv", "tsv", "txt", "dat", "lvm", "tab", "itx"];

/// How deep folders are searched.
const DEPTH: usize = 3;

/// A test whether a path is a different file from `bodies`.
fn is_not(bodies: Option<&Path>) -> impl Fn(&Path) -> bool {
    let bodies = bodies.and_then(|path| std::fs::canonicalize(path).ok());
    move |path| bodies.is_none() || std::fs::canonicalize(path).ok() != bodies
}

/// The tables in a folder, sorted, without the table of bodies. If the folder itself holds none, its subfolders are searched.
///
/// # Errors
/// If the folder cannot be read or holds no table.
pub(super) fn tables_in(folder: &Path, bodies: Option<&Path>) -> Result<Vec<PathBuf>, Fault> {
    let found = tables_within(folder, bodies, DEPTH)?;
    match found.is_empty() {
        true => {
            let right = "a table ends in .csv, .tsv, .txt, .dat, .lvm, .xlsx or .ods";
            Err(Fault::new(&folder.display().to_string(), "no table is in this folder", right))
        }
        false => Ok(found),
    }
}

fn tables_within(
    folder: &Path,
    bodies: Option<&Path>,
    depth: usize,
) -> Result<Vec<PathBuf>, Fault> {
    let mut found = directly_in(folder)?;
    let is_drop = is_not(bodies);
    found.retain(|path| is_drop(path));
    if !found.is_empty() || depth == 0 {
        return Ok(found);
    }
    let mut within: Vec<PathBuf> = entries_of(folder)?.filter(|path| path.is_dir()).collect();
    within.sort();
    let each = within.iter().map(|one| tables_within(one, bodies, depth - 1));
    Ok(each.collect::<Result<Vec<_>, _>>()?.concat())
}

fn entries_of(folder: &Path) -> Result<impl Iterator<Item = PathBuf>, Fault> {
    let entries = std::fs::read_dir(folder).map_err(|error| {
        let shown = folder.display().to_string();
        Fault::new(&shown, error.to_string(), "name tables, or a folder of tables")
    })?;
    Ok(entries.filter_map(|entry| Some(entry.ok()?.path())))
}

/// The tables in a folder, sorted, and nothing that is in folders within it.
fn directly_in(folder: &Path) -> Result<Vec<PathBuf>, Fault> {
    let is_table = |path: &PathBuf| {
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
        let ending = ending.to_ascii_lowercase();
        TABLES.contains(&ending.as_str()) || spreadsheet::ENDINGS.contains(&ending.as_str())
    };
    let mut found: Vec<PathBuf> = entries_of(folder)?.filter(is_table).collect();
    found.sort();
    Ok(found)
}

fn fitting(pattern: &str) -> Result<Vec<PathBuf>, Fault> {
    let paths = glob::glob(pattern).map_err(|error| {
        Fault::new(
            pattern,
            format!("this is not a pattern: {}", error.msg),
            "`*` is any text, `?` one character",
        )
    })?;
    let found: Vec<PathBuf> = paths.filter_map(Result::ok).filter(|path| path.is_file()).collect();
    match found.is_empty() {
        true => Err(Fault::new(
            pattern,
            "no file fits this pattern",
            "`*` is any text, `?` one character",
        )),
        false => Ok(found),
    }
}

/// The content of a file.
pub(super) fn bytes(path: &Path) -> Result<Vec<u8>, Fault> {
    let shown = path.display().to_string();
    read_bounded(path, &shown, MOST).map_err(|error| {
        let text = error.to_string();
        let what = text.strip_prefix(&format!("`{shown}`: ")).unwrap_or(&text).to_owned();
        Fault::new(
            &shown,
            what,
            "name tables, patterns such as \"drops/*.csv\", or a folder of tables",
        )
    })
}

/// Endings of what programs save their own work in, with the name of the program.
const PROJECTS: [(&str, &str); 8] = [
    ("trk", "Tracker"),
    ("cmbl", "Logger Pro"),
    ("cap", "Capstone"),
    ("kva", "Kinovea"),
    ("xml", "TrackMate or Kinovea"),
    ("tdms", "LabVIEW"),
    ("mat", "MATLAB"),
    ("pxp", "Igor"),
];

/// The largest number of lines in a table; a set holds no more readings.
const MOST_LINES: usize = measurements::MOST_READINGS;

/// Refuses a table with too many lines before parsing it.
fn refuse_long(file: &str, bytes: &[u8]) -> Result<(), Fault> {
    let lines = bytes.iter().filter(|byte| **byte == b'\n').count();
    match lines > MOST_LINES {
        true => Err(Fault::new(
            file,
            format!("it has {lines} lines, and a set holds {MOST_LINES} readings at most"),
            "export the frames around the impacts, or every n-th",
        )),
        false => Ok(()),
    }
}

/// The sheets of the file `path` with this content.
///
/// # Errors
/// If it holds no table.
pub(super) fn sheets(path: &Path, bytes: &[u8]) -> Result<Vec<Sheet>, Fault> {
    let file = path.display().to_string();
    let part = |part: Option<&std::ffi::OsStr>| {
        part.map_or(String::new(), |part| part.to_string_lossy().into_owned())
    };
    let (stem, ending) = (part(path.file_stem()), part(path.extension()).to_ascii_lowercase());
    if let Some((_, program)) = PROJECTS.iter().find(|(own, _)| *own == ending) {
        let what = format!("it is a file of {program}, and no table");
        return Err(Fault::new(
            &file,
            what,
            "export the track as a table of text, and import that",
        ));
    }
    // ImageJ saves text under the name of a spreadsheet.
    let is_text = ending == "xls" && spreadsheet::is_text(bytes);
    let is_book = spreadsheet::ENDINGS.contains(&ending.as_str()) && !is_text;
    let sheets = match is_book {
        true => spreadsheet::read(&file, &stem, bytes)?,
        false => {
            refuse_long(&file, bytes)?;
            vec![text::read(&file, &stem, bytes)?]
        }
    };
    match sheets.iter().all(|sheet| sheet.rows.is_empty()) {
        true => Err(Fault::new(&file, "it is empty", "a line of names, then rows of numbers")),
        false => Ok(sheets),
    }
}
