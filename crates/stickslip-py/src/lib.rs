//! The extension module `stickslip._core`: what the Python package needs of the library. The classes that people use are written in
//! Python, in `python/stickslip`.

mod array;
mod errors;
mod laws;
mod mesh;
mod problem;
mod run;
mod value;

use pyo3::prelude::*;

/// Runs the command line; returns its exit code.
#[pyfunction]
fn command(py: Python<'_>, arguments: Vec<String>) -> u8 {
    py.detach(|| stickslip_cli::number(stickslip_cli::main_with(arguments)))
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
    use super::run::Simulation;
    #[pymodule_export]
    use super::{command, schema, set_threads};

    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");
}
