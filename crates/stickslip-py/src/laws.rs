//! Laws of contact that are functions in Python.

use std::sync::{Arc, Mutex};

use pyo3::prelude::*;
use pyo3::types::PyBytes;
use stickslip::contact::law::user::{LimitFunction, PressureFunction};

use super::array::Array;
use super::mesh::doubles;

/// The first exception of a function or a signal; it stops the run and is raised when that has stopped.
pub type Raised = Arc<Mutex<Option<PyErr>>>;

/// Keeps an exception unless there is one already.
pub fn keep(raised: &Raised, error: PyErr) {
    if let Ok(mut raised) = raised.lock() {
        raised.get_or_insert(error);
    }
}

/// A function in Python and where its exceptions go.
pub struct Function {
    pub function: Py<PyAny>,
    pub raised: Raised,
}

impl Function {
    /// Calls `stickslip._laws.<how>` with the function and the arguments, which returns bytes of doubles.
    fn call(&self, how: &str, arguments: &[&[f64]]) -> Vec<Vec<f64>> {
        Python::attach(|py| {
            let called = || -> PyResult<Vec<Vec<f64>>> {
                let arrays: Vec<Array> = arguments
                    .iter()
                    .map(|a| Array::floats(a.to_vec(), vec![a.len()]))
                    .collect();
                let how = py.import("stickslip._laws")?.getattr(how)?;
                let answer = how.call1((self.function.bind(py), arrays))?;
                let answer: Vec<Bound<'_, PyBytes>> = answer.extract()?;
                Ok(answer.iter().map(|b| doubles(b.as_bytes())).collect())
            };
            called().unwrap_or_else(|e| {
                keep(&self.raised, e);
                Vec::new()
            })
        })
    }
}

impl PressureFunction for Function {
    fn pressures(&self, gaps: &[f64]) -> (Vec<f64>, Option<Vec<f64>>) {
        let mut answer = self.call("pressures", &[gaps]).into_iter();
        (answer.next().unwrap_or_default(), answer.next())
    }
}

impl LimitFunction for Function {
    fn limits(&self, pressures: &[f64], speeds: &[f64]) -> (Vec<f64>, Option<[Vec<f64>; 2]>) {
        let mut answer = self.call("limits", &[pressures, speeds]).into_iter();
        let value = answer.next().unwrap_or_default();
        match (answer.next(), answer.next()) {
            (Some(by_pressure), Some(by_speed)) => (value, Some([by_pressure, by_speed])),
            _ => (value, None),
        }
    }
}
