//! From errors of the library to exceptions of `stickslip._errors`.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use stickslip::Error;
use stickslip::error::{ProblemError, line_column, shown};
use stickslip_deck::DeckError;

/// The exception for an error.
pub fn raise(py: Python<'_>, error: Error) -> PyErr {
    exception(py, error).unwrap_or_else(|e| e)
}

fn exception(py: Python<'_>, error: Error) -> PyResult<PyErr> {
    let message = shown(&error.to_string()).into_owned();
    let fields = PyDict::new(py);
    let name = match error {
        Error::Problem(e) => {
            fields.set_item("findings", findings(py, &e)?)?;
            "ProblemError"
        }
        Error::Mesh(e) => {
            fields.set_item("help", e.help)?;
            "MeshError"
        }
        Error::Run(e) => {
            fields.set_item("time", e.time)?;
            fields.set_item("culprits", e.culprits)?;
            fields.set_item("help", e.help)?;
            "RunError"
        }
        Error::Io(e) => {
            fields.set_item("file", e.file)?;
            "FileError"
        }
        Error::Interrupted(time) => {
            fields.set_item("time", time)?;
            "Interrupted"
        }
    };
    let class = py.import("stickslip._errors")?.getattr(name)?;
    Ok(PyErr::from_value(class.call((message,), Some(&fields))?))
}

/// The exception for what is wrong with a deck.
pub fn raise_deck(py: Python<'_>, error: &DeckError) -> PyErr {
    let exception = || -> PyResult<PyErr> {
        let list = PyList::empty(py);
        let mut lines = Vec::new();
        for finding in &error.findings {
            let entry = PyDict::new(py);
            entry.set_item("key", "")?;
            entry.set_item("message", &finding.message)?;
            entry.set_item("help", &finding.help)?;
            entry.set_item("file", &finding.file)?;
            entry.set_item("line", (finding.line > 0).then_some(finding.line))?;
            entry.set_item("column", None::<usize>)?;
            list.append(entry)?;
            lines.push(shown(&finding.to_string()).into_owned());
        }
        let class = py.import("stickslip._errors")?.getattr("ProblemError")?;
        Ok(PyErr::from_value(class.call1((lines.join("\n"), list))?))
    };
    exception().unwrap_or_else(|e| e)
}

fn findings<'py>(py: Python<'py>, error: &ProblemError) -> PyResult<Bound<'py, PyList>> {
    let list = PyList::empty(py);
    for finding in &error.findings {
        let entry = PyDict::new(py);
        entry.set_item("key", &finding.key)?;
        entry.set_item("message", &finding.message)?;
        entry.set_item("help", &finding.help)?;
        let place = finding.span.as_ref();
        let place = place.map(|span| line_column(&error.source, span.start));
        entry.set_item("line", place.map(|p| p.0))?;
        entry.set_item("column", place.map(|p| p.1))?;
        list.append(entry)?;
    }
    Ok(list)
}
