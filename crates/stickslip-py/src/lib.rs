//! The extension module `stickslip._core`: what the Python package needs of the library. The classes that people use are written in
//! Python, in `python/stickslip`.

mod array;
mod errors;
mod laws;
mod mesh;
mod problem;
mod results;
mod run;
mod value;

use std::ffi::OsString;
use std::path::PathBuf;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Runs the command line; returns its exit code.
#[pyfunction]
fn command(py: Python<'_>, arguments: Vec<String>) -> u8 {
    py.detach(|| stickslip_cli::number(stickslip_cli::main_with(arguments)))
}

/// Draws as `stickslip plot` does, from its options: the files that were written, and notes.
#[pyfunction]
fn pictures(py: Python<'_>, options: Vec<OsString>) -> PyResult<(Vec<PathBuf>, Vec<String>)> {
    let drawn = py.detach(|| stickslip_cli::pictures(options));
    drawn.map_err(|message| PyValueError::new_err(message.trim().to_string()))
}

/// The options of `stickslip plot`: name, what its value is called (`None`: a switch), whether it may be repeated, and its help.
#[pyfunction]
fn plot_options() -> Vec<(String, Option<String>, bool, String)> {
    let options = stickslip_cli::plot_options().into_iter();
    options
        .map(|o| (o.name, o.value, o.repeated, o.help))
        .collect()
}

/// The JSON schema of problem files.
#[pyfunction]
fn schema() -> String {
    serde_json::to_string(&stickslip::problem::schema()).unwrap_or_default()
}

/// Sets the number of threads; `False` if threads are in use already.
#[pyfunction]
fn set_threads(count: usize) -> bool {
    rayon::ThreadPoolBuilder::new()
        .num_threads(count)
        .build_global()
        .is_ok()
}

/// The compiled part of stickslip.
#[pymodule]
mod _core {
    #[pymodule_export]
    use super::array::Array;
    #[pymodule_export]
    use super::mesh::Mesh;
    #[pymodule_export]
    use super::problem::{Factors, Problem};
    #[pymodule_export]
    use super::results::Results;
    #[pymodule_export]
    use super::run::Simulation;
    #[pymodule_export]
    use super::{command, pictures, plot_options, schema, set_threads};

    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");
}
