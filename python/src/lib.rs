//! The compiled part of the Python package: calls of commands, logs as bytes of numbers, and TOML.
//!
//! A command runs on a thread of its own while Python waits a moment at a time, so that Python hears of signals
//! between two of them. What users see is written in Python, in `python/plunge`.

mod call;
mod log;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// The model that `json` holds, as TOML.
#[pyfunction]
fn toml_of_model(json: &str) -> PyResult<String> {
    let model: toml::Table = serde_json::from_str(json).map_err(unwritable)?;
    toml::to_string(&model).map_err(unwritable)
}

/// The value that `json` holds, as it stands behind `=` in TOML.
#[pyfunction]
fn toml_of_value(json: &str) -> PyResult<String> {
    let value: toml::Value = serde_json::from_str(json).map_err(unwritable)?;
    Ok(value.to_string())
}

fn unwritable(error: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(format!("TOML cannot express this: {error}"))
}

/// The module `plunge._plunge`.
#[pymodule]
fn _plunge(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<call::Call>()?;
    module.add_function(wrap_pyfunction!(log::read_log, module)?)?;
    module.add_function(wrap_pyfunction!(toml_of_model, module)?)?;
    module.add_function(wrap_pyfunction!(toml_of_value, module)?)?;
    Ok(())
}
