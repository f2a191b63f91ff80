//! Arrays that NumPy reads in place, by its array interface (version 3).

use std::sync::{Arc, Mutex};

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

/// Memory of an array, read-only. `numpy.asarray` makes an array of it without a copy, and keeps it alive.
#[pyclass(frozen)]
pub struct Array {
    address: usize,
    shape: Vec<usize>,
    kind: &'static str,
    /// What the memory belongs to.
    _owner: Owner,
}

/// What keeps the memory of an array where it is.
pub enum Owner {
    /// Numbers of its own.
    Floats(#[allow(dead_code)] Vec<f64>),
    /// The mesh of a model.
    Mesh(#[allow(dead_code)] Arc<stickslip::mesh::Mesh>),
    /// A simulation, until it goes on; after that the numbers are here.
    Simulation(#[allow(dead_code)] Arc<Kept>, #[allow(dead_code)] Py<PyAny>),
}

/// Where numbers of a simulation are moved to when it goes on while somebody still looks at them.
#[derive(Default)]
pub struct Kept(pub Mutex<Vec<f64>>);

impl Array {
    /// Numbers of its own; `shape` has as many places as there are numbers.
    pub fn floats(values: Vec<f64>, shape: Vec<usize>) -> Self {
        Array::of(&values, shape, "<f8").with(Owner::Floats(values))
    }

    /// Memory of an owner that lets it be where it is.
    pub fn of<T>(values: &[T], shape: Vec<usize>, kind: &'static str) -> Unowned {
        Unowned {
            address: values.as_ptr() as usize,
            shape,
            kind,
        }
    }
}

/// An array that still needs its owner.
pub struct Unowned {
    address: usize,
    shape: Vec<usize>,
    kind: &'static str,
}

impl Unowned {
    /// Says who keeps the memory where it is.
    pub fn with(self, owner: Owner) -> Array {
        Array {
            address: self.address,
            shape: self.shape,
            kind: self.kind,
            _owner: owner,
        }
    }
}

#[pymethods]
impl Array {
    #[getter]
    fn __array_interface__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let interface = PyDict::new(py);
        interface.set_item("shape", PyTuple::new(py, &self.shape)?)?;
        interface.set_item("typestr", self.kind)?;
        // The second entry: read-only.
        interface.set_item("data", (self.address, true))?;
        interface.set_item("version", 3)?;
        Ok(interface)
    }
}
