//! The files of one run, by the name of its folder or of its log.

use std::path::{Path, PathBuf};

use engine::record::{GRAIN_LOG, RUN_LOG};

/// The name of a summary in the folder of a run.
const SUMMARY: &str = "summary.json";

/// The name of a report in the folder of a run.
const REPORT: &str = "report.html";

/// What the name of a file ends with while its run goes on.
const PARTIAL: &str = ".partial";

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

    /// Likewise of a run that may not have ended. A log that is still written has another name; then the report
    /// has one too, so that it does not stand in the place of that of the whole run.
    pub fn so_far(run: &Path) -> Self {
        let whole = Self::of(run);
        let partial = whole.partial();
        let of = |whole: PathBuf, partial: PathBuf| {
            if !whole.is_file() && partial.is_file() { partial } else { whole }
        };
        let log = of(whole.log.clone(), partial.log);
        let report = if log == whole.log { whole.report } else { partial.report };
        let grains = of(whole.grains, partial.grains);
        Self { log, grains, report, summary: whole.summary }
    }

    /// The names of its files while it goes on; it has no summary then.
    pub fn partial(&self) -> Self {
        let of = |path: &Path| {
            let mut name = path.as_os_str().to_owned();
            name.push(PARTIAL);
            PathBuf::from(name)
        };
        let report = self.report.with_extension("partial.html");
        Self { log: of(&self.log), grains: of(&self.grains), summary: self.summary.clone(), report }
    }

    /// Whether the run goes on or was killed: there is a log without an end, and no whole one.
    pub fn are_unfinished(&self) -> bool {
        !self.log.is_file() && self.partial().log.is_file()
    }

    /// Whether a finished run is there: its log and its summary.
    pub fn are_there(&self) -> bool {
        self.log.is_file() && self.summary.is_file()
    }
}

/// Whether `path` is called like a log.
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

    #[test]
    fn a_run_that_goes_on_is_read_by_the_names_its_logs_have_until_it_ends() -> std::io::Result<()>
    {
        let here = tempfile::tempdir()?;
        let whole = RunFiles::of(here.path());
        assert_eq!(RunFiles::so_far(here.path()), whole);
        std::fs::write(here.path().join("run.mcap.partial"), "")?;
        assert!(whole.are_unfinished());
        let so_far = RunFiles::so_far(here.path());
        assert_eq!(so_far.log, here.path().join("run.mcap.partial"));
        assert_eq!(so_far.report, here.path().join("report.partial.html"));
        std::fs::write(here.path().join("run.mcap"), "")?;
        assert!(!whole.are_unfinished());
        assert_eq!(RunFiles::so_far(here.path()), whole);
        Ok(())
    }
}
