//! Folders of results as Python sees them.

use std::path::PathBuf;

use pyo3::exceptions::{PyIndexError, PyKeyError};
use pyo3::prelude::*;
use stickslip::io::csv;
use stickslip::io::vtu::PointArray;
use stickslip::results::compare::near;
use stickslip_report::{Limits, report};

use super::array::Array;
use super::errors::raise;

/// What a run has left in a folder. Files of fields and tables are read when they are asked for.
#[pyclass(frozen)]
pub struct Results {
    results: stickslip_report::Results,
}

/// The grid of a file of fields: points, data on points, `(types, offsets, connectivity)` of cells, data on cells.
type Grid = (
    Array,
    Vec<(String, Array)>,
    (Vec<u8>, Vec<usize>, Vec<usize>),
    Vec<(String, Array)>,
);

#[pymethods]
impl Results {
    #[new]
    fn new(py: Python<'_>, directory: PathBuf) -> PyResult<Self> {
        let results = stickslip_report::Results::open(&directory).map_err(|e| raise(py, e))?;
        Ok(Results { results })
    }

    #[getter]
    fn title(&self) -> String {
        self.results.title()
    }

    /// What is missing, a sentence each.
    #[getter]
    fn missing(&self) -> Vec<String> {
        self.results.missing.clone()
    }

    /// `summary.json`; `null` where there is none.
    #[getter]
    fn summary(&self) -> String {
        self.results.summary.to_string()
    }

    /// The problem as it was run; empty where it is not there.
    #[getter]
    fn problem(&self) -> String {
        self.results.problem_text.clone()
    }

    /// Its tables as JSON.
    fn tables(&self) -> String {
        serde_json::to_string(&self.results.problem).unwrap_or_default()
    }

    /// Columns of the history by name.
    fn history(&self) -> Vec<(String, Array)> {
        columns(&self.results.history)
    }

    /// Times at which fields were written.
    #[getter]
    fn times(&self) -> Vec<f64> {
        self.results.frames.iter().map(|f| f.time).collect()
    }

    /// What was written at one of these times.
    fn grid(&self, py: Python<'_>, index: usize) -> PyResult<Grid> {
        let count = self.results.frames.len();
        if index >= count {
            return Err(PyIndexError::new_err(format!(
                "there is no time {index}: fields were written at {count} times"
            )));
        }
        let grid = py.detach(|| self.results.grid(index));
        let grid = grid.map_err(|e| raise(py, e))?;
        let count = grid.points.points.len();
        let points = grid.points.points.into_iter().flatten().collect();
        let arrays = |all: std::collections::BTreeMap<String, PointArray>| {
            let arrays = all.into_iter();
            arrays.map(|(name, array)| (name, numbers(array))).collect()
        };
        Ok((
            Array::floats(points, vec![count, 3]),
            arrays(grid.points.arrays),
            (grid.types, grid.offsets, grid.connectivity),
            arrays(grid.cell_arrays),
        ))
    }

    /// Names of the interfaces that have a table.
    #[getter]
    fn interfaces(&self) -> Vec<String> {
        let folder = std::fs::read_dir(self.results.directory.join("interfaces"));
        let files = folder.into_iter().flatten().flatten();
        let tables = files.map(|file| file.path());
        let tables = tables.filter(|path| path.extension().is_some_and(|e| e == "csv"));
        let names = tables.filter_map(|path| Some(path.file_stem()?.to_str()?.to_string()));
        let mut names: Vec<String> = names.collect();
        names.sort();
        names
    }

    /// The table of an interface at the last time.
    fn table(&self, py: Python<'_>, name: &str) -> PyResult<Vec<(String, Array)>> {
        let known = self.interfaces();
        if !known.iter().any(|k| k == name) {
            return Err(PyKeyError::new_err(no_interface(name, &known)));
        }
        let folder = self.results.directory.join("interfaces");
        let table = csv::read(&folder.join(format!("{name}.csv")));
        Ok(columns(&table.map_err(|e| raise(py, e))?))
    }

    /// Writes the report, `report.html` in the folder if no file is named.
    fn report(&self, py: Python<'_>, file: Option<PathBuf>) -> PyResult<PathBuf> {
        let directory = &self.results.directory;
        let written = py.detach(|| report(directory, file.as_deref(), Limits::default()));
        Ok(written.map_err(|e| raise(py, e))?.file)
    }
}

/// What is said where an interface is asked for that is not there.
pub fn no_interface(name: &str, known: &[String]) -> String {
    let near = near(name, known.iter().map(String::as_str));
    format!("there is no interface `{name}`{near}")
}

fn columns(table: &csv::Table) -> Vec<(String, Array)> {
    let columns = table.names.iter().zip(&table.columns);
    let array = |values: &Vec<f64>| Array::floats(values.clone(), vec![values.len()]);
    columns
        .map(|(name, values)| (name.clone(), array(values)))
        .collect()
}

fn numbers(array: PointArray) -> Array {
    let count = array.values.len() / array.components.max(1);
    let shape = match array.components {
        1 => vec![count],
        n => vec![count, n],
    };
    Array::floats(array.values, shape)
}
