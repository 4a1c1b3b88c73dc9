//! Logs as columns of bytes.

use std::path::PathBuf;

use exchange::read::{Keep, read_run};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyDict};

/// Doubles in the order of this machine.
pub(crate) fn numbers(
    py: Python<'_>,
    values: impl IntoIterator<Item = f64>,
) -> Bound<'_, PyByteArray> {
    let bytes: Vec<u8> = values.into_iter().flat_map(f64::to_ne_bytes).collect();
    PyByteArray::new(py, &bytes)
}

/// Metadata, bodies with their series, energies and whether it is finished, of the log `path`.
#[pyfunction]
pub(crate) fn read_log(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyDict>> {
    let read = py.detach(|| read_run(&path, Keep::All));
    let record = read.map_err(|error| PyValueError::new_err(error.to_string()))?;
    let bodies = PyDict::new(py);
    for body in &record.bodies {
        let series = PyDict::new(py);
        let states = &body.states;
        series.set_item("time", numbers(py, states.iter().map(|state| state.time)))?;
        series.set_item("depth", numbers(py, states.iter().map(|state| state.depth)))?;
        let position = states.iter().flat_map(|state| <[f64; 3]>::from(state.position));
        series.set_item("position", numbers(py, position))?;
        let velocity = states.iter().flat_map(|state| <[f64; 3]>::from(state.velocity));
        series.set_item("velocity", numbers(py, velocity))?;
        let load = record.loads.iter().find(|load| load.name == body.name);
        let times = load.iter().flat_map(|load| &load.time).copied();
        series.set_item("force_time", numbers(py, times))?;
        let force = load.iter().flat_map(|load| &load.force).copied().flat_map(<[f64; 3]>::from);
        series.set_item("force", numbers(py, force))?;
        bodies.set_item(&body.name, series)?;
    }
    let energy = PyDict::new(py);
    if let Some(budgets) = &record.energy {
        energy.set_item("time", numbers(py, budgets.time.iter().copied()))?;
        for (term, values) in budgets.terms.iter().zip(&budgets.values) {
            energy.set_item(term, numbers(py, values.iter().copied()))?;
        }
        if let Some(closing) = &budgets.closing {
            energy.set_item("unaccounted_J", numbers(py, closing.unaccounted.iter().copied()))?;
            energy.set_item("closure", numbers(py, closing.closure.iter().copied()))?;
        }
    }
    let log = PyDict::new(py);
    log.set_item("metadata", record.metadata)?;
    log.set_item("complete", record.complete)?;
    log.set_item("bodies", bodies)?;
    log.set_item("energy", energy)?;
    Ok(log)
}
