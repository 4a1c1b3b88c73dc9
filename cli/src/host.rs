//! A program that this library is part of: it calls commands, takes what they say, and may stop them.
//!
//! A command speaks and asks from many places. Those on its own thread find the host by the thread, as they would
//! find the streams of the process; what works on other threads keeps the handle.

use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use configs::ModelSource;

/// How far a command is.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// What it is at, in words.
    pub words: String,
    /// How much of it is done at least (–), where that is known.
    pub share: Option<f64>,
}

/// Whoever calls a command from within a process, in place of its streams and signals. One call has one host.
#[derive(Debug, Default)]
pub struct Host {
    models: Vec<(String, String)>,
    is_stopped: AtomicBool,
    printed: Mutex<String>,
    told: Mutex<String>,
    progress: Mutex<Option<Progress>>,
}

thread_local! {
    static HOST: RefCell<Option<Arc<Host>>> = const { RefCell::new(None) };
}

impl Host {
    /// One that has `models` besides those in files: names as arguments give them, and their TOML. Files that these
    /// name lie in the working folder.
    pub fn new(models: Vec<(String, String)>) -> Self {
        Self { models, ..Self::default() }
    }

    /// Asks the command to end.
    pub fn stop(&self) {
        self.is_stopped.store(true, Ordering::Relaxed);
    }

    /// Whether it has been asked to.
    pub(crate) fn is_stopped(&self) -> bool {
        self.is_stopped.load(Ordering::Relaxed)
    }

    /// How far the command is, as far as it has said.
    pub fn progress(&self) -> Option<Progress> {
        self.progress.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Warnings and notes of the command, one or more lines each, since they were taken last.
    pub fn take_told(&self) -> String {
        std::mem::take(&mut *self.told.lock().unwrap_or_else(PoisonError::into_inner))
    }

    pub(crate) fn take_printed(&self) -> String {
        std::mem::take(&mut *self.printed.lock().unwrap_or_else(PoisonError::into_inner))
    }

    pub(crate) fn print(&self, text: &str) {
        self.printed.lock().unwrap_or_else(PoisonError::into_inner).push_str(text);
    }

    pub(crate) fn tell(&self, text: &str) {
        self.told.lock().unwrap_or_else(PoisonError::into_inner).push_str(text);
    }

    pub(crate) fn is_at(&self, progress: Progress) {
        *self.progress.lock().unwrap_or_else(PoisonError::into_inner) = Some(progress);
    }

    /// Does `work` on this thread for this host.
    pub(crate) fn during<R>(self: &Arc<Self>, work: impl FnOnce() -> R) -> R {
        /// Gives the thread back, also where `work` panics.
        struct Before(Option<Arc<Host>>);
        impl Drop for Before {
            fn drop(&mut self) {
                HOST.set(self.0.take());
            }
        }
        let _before = Before(HOST.replace(Some(Arc::clone(self))));
        work()
    }

    fn model(&self, name: &Path) -> Option<ModelSource> {
        let (name, text) = self.models.iter().find(|(known, _)| Path::new(known) == name)?;
        let (name, text) = (name.clone(), text.clone());
        Some(ModelSource::Text { name, text, folder: PathBuf::from(".") })
    }
}

/// The host of the command on this thread; none of the command line.
pub(crate) fn current() -> Option<Arc<Host>> {
    HOST.with_borrow(Option::clone)
}

/// What an argument that names a model means.
pub(crate) fn model_source(argument: &Path) -> ModelSource {
    let of_host = current().and_then(|host| host.model(argument));
    of_host.unwrap_or_else(|| ModelSource::from_argument(argument))
}
