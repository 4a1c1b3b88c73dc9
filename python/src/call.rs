//! A command on a thread of its own.

use std::ffi::OsString;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use plunge::{Failure, Host};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyByteArray;

use crate::log::numbers;

/// Stack of the thread (bytes): what the main thread of a program has.
const STACK: usize = 8 << 20;

/// What a command gives.
struct Given {
    /// What it prints, one JSON object for each run.
    printed: Vec<String>,
    /// Of a bed: x, y, z and radius of each grain (m).
    grains: Vec<f64>,
}

/// Exit status, the words of a failure, JSON objects, and grains.
type Ended<'py> = (u8, String, Vec<String>, Bound<'py, PyByteArray>);

/// A command that runs.
#[pyclass(frozen)]
pub(crate) struct Call {
    host: Arc<Host>,
    given: Mutex<Receiver<Result<Given, Failure>>>,
}

#[pymethods]
impl Call {
    /// The command that `words` name; `models` are names and TOML of models in no file.
    #[staticmethod]
    fn command(words: Vec<OsString>, models: Vec<(String, String)>) -> PyResult<Self> {
        Self::start(models, move |host| {
            let printed = vec![plunge::call(host, &words)?];
            Ok(Given { printed, grains: Vec::new() })
        })
    }

    /// One run for each of `variants`, lists of `key.path=value`.
    #[staticmethod]
    fn many(
        words: Vec<OsString>,
        models: Vec<(String, String)>,
        variants: Vec<Vec<String>>,
    ) -> PyResult<Self> {
        Self::start(models, move |host| {
            let summaries = plunge::run_many(host, &words, &variants)?;
            let printed = summaries.iter().map(ToString::to_string).collect();
            Ok(Given { printed, grains: Vec::new() })
        })
    }

    /// A bed, with its grains.
    #[staticmethod]
    fn bed(words: Vec<OsString>, models: Vec<(String, String)>) -> PyResult<Self> {
        Self::start(models, move |host| {
            let (printed, grains) = plunge::bed(host, &words)?;
            let of_grain = |grain: &plunge::Grain| {
                let at = grain.position;
                [at.x, at.y, at.z, grain.radius]
            };
            Ok(Given { printed: vec![printed], grains: grains.iter().flat_map(of_grain).collect() })
        })
    }

    /// What came of it; `None` if it has not ended within `seconds`. To be asked until it has.
    fn wait<'py>(&self, py: Python<'py>, seconds: f64) -> PyResult<Option<Ended<'py>>> {
        let most = Duration::try_from_secs_f64(seconds)
            .map_err(|fault| PyValueError::new_err(fault.to_string()))?;
        let given = py.detach(|| {
            let given = self.given.lock().unwrap_or_else(PoisonError::into_inner);
            given.recv_timeout(most)
        });
        let none = PyByteArray::new(py, &[]);
        Ok(match given {
            Ok(Ok(Given { printed, grains })) => {
                Some((0, String::new(), printed, numbers(py, grains)))
            }
            Ok(Err(Failure { status, message })) => Some((status, message, Vec::new(), none)),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => {
                let words = "error: the command has ended by a fault of the program, told above\n";
                Some((1, words.to_owned(), Vec::new(), none))
            }
        })
    }

    /// Asks it to end.
    fn stop(&self) {
        self.host.stop();
    }

    /// What it is at, in words, and the share that is done (–) or `None`; `None` before it has said.
    fn progress(&self) -> Option<(String, Option<f64>)> {
        self.host.progress().map(|progress| (progress.words, progress.share))
    }

    /// Warnings and notes since they were taken last.
    fn take_told(&self) -> String {
        self.host.take_told()
    }
}

impl Call {
    fn start(
        models: Vec<(String, String)>,
        work: impl FnOnce(&Arc<Host>) -> Result<Given, Failure> + Send + 'static,
    ) -> PyResult<Self> {
        let host = Arc::new(Host::new(models));
        let (sender, given) = channel();
        let of_thread = Arc::clone(&host);
        thread::Builder::new().name("plunge".to_owned()).stack_size(STACK).spawn(move || {
            // Whoever has stopped waiting needs no answer.
            let _ = sender.send(work(&of_thread));
        })?;
        Ok(Self { host, given: Mutex::new(given) })
    }
}
