//! The files of one run, by the name of its folder or of its log.

use std::path::{Path, PathBuf};

use engine::record::{GRAIN_LOG, RUN_LOG};

/// The name of a summary in the folder of a run.
const SUMMARY: &str = "summary.json";

/// The name of a report in the folder of a run.
const REPORT: &str = "report.html";

/// Where the files of a run are, whether or not they are there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RunFiles {
    /// The log of scalars, events and frames.
    pub log: PathBuf,
    /// The log of grains.
    pub grains: PathBuf,
    /// The summary.
    pub summary: PathBuf,
    /// The report.
    pub report: PathBuf,
}

impl RunFiles {
    /// Of `run`: a log, or else a folder that holds `run.mcap`. What belongs to a log of that name is
    /// called as in the folder of a run, and what belongs to `name.mcap` is called `name.grains.mcap`
    /// and so on, so that several may lie side by side.
    #[must_use]
    pub fn of(run: &Path) -> Self {
        if !is_log(run) {
            return Self::of(&run.join(RUN_LOG));
        }
        let beside = |name: &str| {
            let stem = run.file_stem().filter(|_| run.file_name() != Some(RUN_LOG.as_ref()));
            match stem {
                Some(stem) => {
                    let mut whole = stem.to_owned();
                    whole.push(".");
                    whole.push(name);
                    run.with_file_name(whole)
                }
                None => run.with_file_name(name),
            }
        };
        Self {
            log: run.to_owned(),
            grains: beside(GRAIN_LOG),
            summary: beside(SUMMARY),
            report: beside(REPORT),
        }
    }

    /// Whether a finished run is there: its log and its summary.
    #[must_use]
    pub fn are_there(&self) -> bool {
        self.log.is_file() && self.summary.is_file()
    }
}

/// Whether `path` is called like a log.
#[must_use]
pub fn is_log(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "mcap")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_beside_a_log_are_called_after_it_unless_it_is_the_one_of_its_folder() {
        let of_folder = RunFiles::of(Path::new("runs/one"));
        assert_eq!(of_folder, RunFiles::of(Path::new("runs/one/run.mcap")));
        assert_eq!(of_folder.grains, Path::new("runs/one/grains.mcap"));
        let of_log = RunFiles::of(Path::new("lmp.mcap"));
        assert_eq!(of_log.log, Path::new("lmp.mcap"));
        assert_eq!(of_log.grains, Path::new("lmp.grains.mcap"));
        assert_eq!(of_log.summary, Path::new("lmp.summary.json"));
        assert_eq!(of_log.report, Path::new("lmp.report.html"));
    }
}
