//! The page of a run while it goes on, and who looks at the run.

use std::cell::Cell;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use exchange::run_files::RunFiles;

/// Its name on the server.
pub(super) const PAGE: &str = "/";

/// How often a browser asks for the page anew.
pub(super) const EVERY: Duration = Duration::from_secs(5);

/// The page of a run as it stands now, made when somebody asks for it and the logs have grown.
#[derive(Debug)]
pub(super) struct LivePage {
    /// The folder of a run or of a list of runs, or a log.
    run: PathBuf,
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    made: Option<(Stand, Page)>,
    /// When somebody asked last.
    asked: Option<Instant>,
    /// Whether somebody has the page of the run that has ended.
    is_handed_over: bool,
    /// Streams that have not told all of the run.
    behind: usize,
}

/// A stream of the messages of a run, as long as it has not told all of it.
pub(super) struct Streaming<'a> {
    page: &'a LivePage,
    is_behind: Cell<bool>,
}

/// A page, and whether it is that of a run that has ended.
#[derive(Clone, Debug)]
pub(super) struct Page {
    pub(super) html: Arc<str>,
    pub(super) is_last: bool,
}

/// What a page is made of: the folder, and how long its logs are (bytes).
#[derive(Clone, Debug, PartialEq, Eq)]
struct Stand {
    run: PathBuf,
    lengths: [u64; 2],
    has_ended: bool,
}

impl LivePage {
    pub(super) fn of(run: &Path) -> Self {
        Self { run: run.to_owned(), state: Mutex::default() }
    }

    /// The page; one that says so while there is nothing to see.
    pub(super) fn now(&self) -> Page {
        // One at a time: they would be the same, and cost memory.
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        state.asked = Some(Instant::now());
        let stand = Stand::of(&self.run);
        if let Some((_, page)) = state.made.as_ref().filter(|(of, _)| *of == stand) {
            return page.clone();
        }
        // A log may get its last name in this moment; then the next request finds it.
        match reports::of_folder(&stand.run) {
            Ok(html) => {
                let page = Page { html: html.into(), is_last: stand.has_ended };
                state.made = Some((stand, page.clone()));
                page
            }
            Err(why) => {
                let html = reports::run::page_of_none(&why, EVERY).unwrap_or_default();
                Page { html: html.into(), is_last: false }
            }
        }
    }

    /// The folder of the run; of a list of runs, the one in progress.
    pub(super) fn run(&self) -> PathBuf {
        Stand::of(&self.run).run
    }

    /// Begins a stream.
    pub(super) fn streams(&self) -> Streaming<'_> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner).behind += 1;
        Streaming { page: self, is_behind: Cell::new(true) }
    }

    /// Says that a client has read the last page.
    pub(super) fn hand_over(&self) {
        self.state.lock().unwrap_or_else(PoisonError::into_inner).is_handed_over = true;
    }

    /// Waits until a browser that follows the run has its last page, and a viewer its last message, at most for two
    /// turns of a browser.
    pub(super) fn let_it_end(&self) {
        let start = Instant::now();
        while start.elapsed() < 2 * EVERY {
            let state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
            let follows = state.asked.is_some_and(|asked| asked.elapsed() < 2 * EVERY);
            let is_seen = (!follows || state.is_handed_over) && state.behind == 0;
            drop(state);
            if is_seen || crate::signals::is_asked_to_stop() {
                return;
            }
            std::thread::sleep(Duration::from_millis(50));
        }
    }
}

impl Streaming<'_> {
    /// Says that all has been told.
    pub(super) fn finish(&self) {
        if self.is_behind.replace(false) {
            self.page.state.lock().unwrap_or_else(PoisonError::into_inner).behind -= 1;
        }
    }
}

impl Drop for Streaming<'_> {
    fn drop(&mut self) {
        self.finish();
    }
}

impl Stand {
    fn of(run: &Path) -> Self {
        let has_ended = RunFiles::of(run).summary.is_file();
        let run = if has_ended { run.to_owned() } else { going_on(run) };
        let files = RunFiles::so_far(&run);
        let length = |path: &Path| fs::metadata(path).map_or(0, |file| file.len());
        Self { lengths: [length(&files.log), length(&files.grains)], run, has_ended }
    }
}

/// The run of a list that goes on, if `run` is the folder of one.
fn going_on(run: &Path) -> PathBuf {
    let members = fs::read_dir(run).into_iter().flatten().flatten().map(|entry| entry.path());
    let going_on =
        members.filter(|member| member.is_dir() && RunFiles::of(member).are_unfinished());
    going_on.max().unwrap_or_else(|| run.to_owned())
}
