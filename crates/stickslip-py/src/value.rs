//! From Python objects to TOML: a dictionary becomes the text of a problem file.

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use toml::Value;

/// A dictionary as the text of a problem file. Entries that are `None` are left out, as in TOML there is nothing like it.
pub fn document(dict: &Bound<'_, PyAny>) -> PyResult<String> {
    match value(dict, "")? {
        Some(Value::Table(table)) => {
            toml::to_string(&table).map_err(|e| PyTypeError::new_err(e.to_string()))
        }
        _ => Err(PyTypeError::new_err("a problem is made of a dict")),
    }
}

/// A table as a dictionary.
pub fn dict<'py>(py: Python<'py>, table: &toml::Table) -> PyResult<Bound<'py, PyDict>> {
    let out = PyDict::new(py);
    for (key, value) in table {
        out.set_item(key, object(py, value)?)?;
    }
    Ok(out)
}

fn object<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    Ok(match value {
        Value::Boolean(yes) => PyBool::new(py, *yes).to_owned().into_any(),
        Value::Integer(number) => number.into_pyobject(py)?.into_any(),
        Value::Float(number) => PyFloat::new(py, *number).into_any(),
        Value::String(text) => PyString::new(py, text).into_any(),
        Value::Datetime(date) => PyString::new(py, &date.to_string()).into_any(),
        Value::Table(table) => dict(py, table)?.into_any(),
        Value::Array(list) => {
            let out = PyList::empty(py);
            for value in list {
                out.append(object(py, value)?)?;
            }
            out.into_any()
        }
    })
}

/// A value as it is written behind `path=`.
pub fn inline(object: &Bound<'_, PyAny>, path: &str) -> PyResult<String> {
    match value(object, path)? {
        Some(value) => Ok(value.to_string()),
        None => Err(PyTypeError::new_err(format!("{path}: None is no value"))),
    }
}

fn value(object: &Bound<'_, PyAny>, path: &str) -> PyResult<Option<Value>> {
    let below = |key: &str| match path {
        "" => key.to_string(),
        path => format!("{path}.{key}"),
    };
    if object.is_none() {
        return Ok(None);
    }
    if object.is_instance_of::<PyBool>() {
        return Ok(Some(Value::Boolean(object.extract()?)));
    }
    if object.is_instance_of::<PyInt>() {
        return Ok(Some(Value::Integer(object.extract()?)));
    }
    if object.is_instance_of::<PyFloat>() {
        return Ok(Some(Value::Float(object.extract()?)));
    }
    if object.is_instance_of::<PyString>() {
        return Ok(Some(Value::String(object.extract()?)));
    }
    if let Ok(dict) = object.cast::<PyDict>() {
        let mut table = toml::Table::new();
        for (key, entry) in dict.iter() {
            let key: String = key.extract().map_err(|_| {
                PyTypeError::new_err(format!("{path}: the keys of a dict have to be strings"))
            })?;
            if let Some(entry) = value(&entry, &below(&key))? {
                table.insert(key, entry);
            }
        }
        return Ok(Some(Value::Table(table)));
    }
    if object.is_instance_of::<PyList>() || object.is_instance_of::<PyTuple>() {
        let mut list = Vec::new();
        for (i, entry) in object.try_iter()?.enumerate() {
            let key = below(&i.to_string());
            let entry = value(&entry?, &key)?;
            list.push(entry.ok_or_else(|| PyTypeError::new_err(format!("{key}: None in a list")))?);
        }
        return Ok(Some(Value::Array(list)));
    }
    // Arrays and numbers of NumPy, then paths.
    for method in ["tolist", "__fspath__"] {
        if object.hasattr(method)? {
            return value(&object.call_method0(method)?, path);
        }
    }
    let kind = object.get_type().name()?;
    Err(PyTypeError::new_err(format!(
        "{path}: a problem has no place for values of type {kind}"
    )))
}
