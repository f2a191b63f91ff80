//! A simulation as Python sees it.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, Weak};
use std::time::{Duration, Instant};
use stickslip::contact::look;

use pyo3::exceptions::{PyKeyError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use stickslip::Error;
use stickslip::assess::doctor::Severity;
use stickslip::io::write_atomically;
use stickslip::results::{
    Analysis, Claim, Event, FolderClaim, Observer, ResultFiles, Row, Saved, Source, fields, seal,
    unseal,
};
use stickslip::run::Checkpoint;
use stickslip::system::Location;

use super::array::{Array, Kept, Owner};
use super::errors::raise;
use super::laws::{Raised, keep};
use super::results::no_interface;
use stickslip::number::digits;

/// How often Python is asked whether a signal has come.
const SIGNAL_INTERVAL: Duration = Duration::from_millis(50);

/// A number of the state, by degree of freedom.
#[derive(Clone, Copy, PartialEq)]
enum Quantity {
    Displacement,
    Velocity,
    Acceleration,
    Forces,
}

/// Rows of the history: those that Python has not taken yet, and all.
#[derive(Default, Clone, stickslip::keep::Keep)]
pub struct Rows {
    fresh: VecDeque<(String, Vec<f64>)>,
    names: Vec<String>,
    all: Vec<f64>,
    notes: Vec<String>,
}

impl Observer for Rows {
    fn see(&mut self, analysis: &Analysis, event: Event) -> Result<(), Error> {
        match event {
            Event::Increment(row) => {
                if self.names.is_empty() {
                    self.names.clone_from(&row.names);
                }
                let step = analysis.step_name().to_string();
                self.all.extend_from_slice(&row.values);
                self.fresh.push_back((step, row.values.clone()));
            }
            Event::Note(text) => self.notes.push(text.to_string()),
            _ => {}
        }
        Ok(())
    }
}

/// What is worth telling, for `logging`: how much it matters, by its numbers, and the sentence.
#[derive(Default)]
struct Messages(VecDeque<(u8, String)>);

const DETAIL: u8 = 10;
const NEWS: u8 = 20;
const WARNING: u8 = 30;

impl Observer for Messages {
    fn see(&mut self, analysis: &Analysis, event: Event) -> Result<(), Error> {
        let message = match event {
            Event::Accepted(a) => (
                DETAIL,
                format!(
                    "step {} increment {} to time {:.6}: {} iterations, residual {}; {} open, {} stick, {} slip",
                    analysis.step_name(),
                    a.increment,
                    a.time,
                    a.iterations,
                    digits(a.residual, 2),
                    a.tally.open,
                    a.tally.stick,
                    a.tally.slip
                ),
            ),
            Event::Cutback(trial, failure) => (
                NEWS,
                format!(
                    "cut back at time {:.6} to {:.6}: {}",
                    trial.from, trial.to, failure.message
                ),
            ),
            Event::Note(text) => (NEWS, text.to_string()),
            Event::Finding(finding) => (
                match finding.severity >= Severity::Warning {
                    true => WARNING,
                    false => NEWS,
                },
                finding.message.clone(),
            ),
            _ => return Ok(()),
        };
        self.0.push_back(message);
        Ok(())
    }
}

/// First and one past the last of a range.
type Bounds = (usize, usize);

/// A model being run.
#[pyclass]
pub struct Simulation {
    simulation: stickslip::run::Simulation,
    rows: Rows,
    messages: Messages,
    files: Option<ResultFiles>,
    /// The files that the problem was read from.
    inputs: Vec<PathBuf>,
    /// What checkpoints say of the run.
    source: Source,
    raised: Raised,
    /// Arrays that look at the state of the simulation.
    looked: Vec<(Quantity, Weak<Kept>)>,
}

impl Simulation {
    /// From a simulation, the files it was read from and what checkpoints say of it, and the place for exceptions of its laws.
    pub fn new(
        mut simulation: stickslip::run::Simulation,
        inputs: Vec<PathBuf>,
        source: Source,
        raised: Raised,
    ) -> Self {
        let slot = Arc::clone(&raised);
        let asked = Mutex::new(Instant::now());
        simulation.set_interrupt(Arc::new(move || {
            if slot.lock().is_ok_and(|raised| raised.is_some()) {
                return true;
            }
            let Ok(mut asked) = asked.lock() else {
                return false;
            };
            if asked.elapsed() < SIGNAL_INTERVAL {
                return false;
            }
            *asked = Instant::now();
            Python::attach(|py| match py.check_signals() {
                Ok(()) => false,
                Err(signal) => {
                    keep(&slot, signal);
                    true
                }
            })
        }));
        Simulation {
            simulation,
            rows: Rows::default(),
            messages: Messages::default(),
            files: None,
            inputs,
            source,
            raised,
            looked: Vec::new(),
        }
    }

    /// With these rows of its history.
    pub fn with_rows(self, rows: Rows) -> Self {
        Simulation { rows, ..self }
    }

    /// Checkpoint and rows of what [`Simulation::state`] returned.
    pub fn parts(state: &[u8]) -> PyResult<(Checkpoint, Rows)> {
        let parts: Result<(Vec<u8>, Rows), String> = unseal(state, "the simulation");
        let (bytes, rows) = parts.map_err(PyValueError::new_err)?;
        let checkpoint = Checkpoint::from_bytes(&bytes).ok_or_else(|| {
            PyValueError::new_err("the simulation is one of another build of stickslip")
        })?;
        Ok((checkpoint, rows))
    }

    /// One that goes on in a folder of results, with the history that is there.
    pub fn going_on_in(
        mut self,
        directory: &Path,
        held: FolderClaim,
        saved: &Saved,
        notes: Vec<String>,
    ) -> Result<Self, Error> {
        let claim = self.claim();
        self.files = Some(ResultFiles::resume(held, &claim, saved)?);
        let history = directory.join("history.csv");
        if history.is_file() {
            let table = stickslip::io::csv::read(&history)?;
            let rows = 0..table.rows();
            let columns = &table.columns;
            self.rows.all = rows
                .flat_map(|i| columns.iter().map(move |c| c[i]))
                .collect();
            self.rows.names = table.names;
        }
        self.rows.notes = notes;
        Ok(self)
    }

    fn claim(&self) -> Claim {
        Claim {
            inputs: self.inputs.clone(),
            source: Some(self.source.clone()),
            ..Claim::default()
        }
    }

    fn values(&mut self, quantity: Quantity) -> &mut Vec<f64> {
        let simulation = &mut self.simulation;
        match quantity {
            Quantity::Displacement => &mut simulation.run.frame.state.u,
            Quantity::Velocity => &mut simulation.run.frame.state.v,
            Quantity::Acceleration => &mut simulation.run.frame.state.a,
            Quantity::Forces => &mut simulation.run.frame.forces,
        }
    }

    /// Leaves the numbers that somebody still looks at where they are, and goes on with a copy.
    fn release(&mut self) {
        while let Some((quantity, kept)) = self.looked.pop() {
            if let Some(kept) = kept.upgrade()
                && let Ok(mut place) = kept.0.lock()
            {
                let values = self.values(quantity);
                let copy = values.clone();
                *place = std::mem::replace(values, copy);
            }
        }
    }

    /// An array over the numbers of the state, `(points, dim)`.
    fn look(slf: &Bound<'_, Self>, quantity: Quantity) -> Array {
        let mut this = slf.borrow_mut();
        let dim = this.simulation.model.dofs.dim;
        let points = this.simulation.model.mesh.points.len();
        if this.values(quantity).is_empty() {
            return Array::floats(vec![0.0; points * dim], vec![points, dim]);
        }
        let same = this.looked.iter().filter(|(q, _)| *q == quantity);
        let kept = same.filter_map(|(_, kept)| kept.upgrade()).next();
        let kept = kept.unwrap_or_else(|| {
            let kept = Arc::new(Kept::default());
            this.looked.push((quantity, Arc::downgrade(&kept)));
            kept
        });
        let values: &[f64] = this.values(quantity);
        Array::of(values, vec![points, dim], "<f8")
            .with(Owner::Simulation(kept, slf.clone().into_any().unbind()))
    }
}

#[pymethods]
impl Simulation {
    /// Goes on until something is reported or nothing is left; `False` at the end.
    fn advance(&mut self, py: Python<'_>) -> PyResult<bool> {
        self.release();
        let Simulation {
            simulation,
            rows,
            messages,
            files,
            raised,
            ..
        } = self;
        let outcome = py.detach(|| {
            loop {
                let mut observers: Vec<&mut dyn Observer> = vec![rows, messages];
                observers.extend(files.as_mut().map(|f| f as &mut dyn Observer));
                let more = simulation.advance(&mut observers)?;
                if !more || !rows.fresh.is_empty() {
                    return Ok(more);
                }
            }
        });
        if let Some(error) = raised.lock().ok().and_then(|mut raised| raised.take()) {
            return Err(error);
        }
        outcome.map_err(|e| raise(py, e))
    }

    /// The next row of the history that has not been taken yet: name of the step, and values by name.
    fn take<'py>(&mut self, py: Python<'py>) -> PyResult<Option<(String, Bound<'py, PyDict>)>> {
        let Some((step, values)) = self.rows.fresh.pop_front() else {
            return Ok(None);
        };
        let row = PyDict::new(py);
        for (name, value) in self.rows.names.iter().zip(values) {
            row.set_item(name, value)?;
        }
        Ok(Some((step, row)))
    }

    /// Names of the columns of the history and all rows, `(rows, columns)`.
    fn history(&self) -> (Vec<String>, Array) {
        let names = self.rows.names.clone();
        let rows = self.rows.all.len() / names.len().max(1);
        let shape = vec![rows, names.len()];
        (names, Array::floats(self.rows.all.clone(), shape))
    }

    /// Has results written into a directory from now on.
    fn write_to(&mut self, py: Python<'_>, directory: PathBuf) -> PyResult<()> {
        let claim = self.claim();
        // What this simulation has itself is given back first.
        self.files = None;
        self.files = Some(ResultFiles::new(&directory, &claim).map_err(|e| raise(py, e))?);
        Ok(())
    }

    /// Writes what there is now into a directory: the fields of the last increment, the history so far, tables, summary and problem.
    fn save(&self, py: Python<'_>, directory: PathBuf) -> PyResult<()> {
        let claim = Claim {
            inputs: self.inputs.clone(),
            ..Claim::default()
        };
        let analysis = self.simulation.analysis();
        let save = || -> Result<(), Error> {
            let mut files = ResultFiles::new(&directory, &claim)?;
            write_atomically(
                &directory.join("problem.toml"),
                self.source.problem.as_bytes(),
            )?;
            for values in self.rows.all.chunks(self.rows.names.len().max(1)) {
                let row = Row {
                    names: self.rows.names.clone(),
                    values: values.to_vec(),
                };
                files.see(&analysis, Event::Increment(&row))?;
            }
            files.see(&analysis, Event::Output)?;
            files.settle()?;
            files.see(&analysis, Event::End)
        };
        save().map_err(|e| raise(py, e))
    }

    /// The messages since they were last asked for.
    fn messages(&mut self) -> Vec<(u8, String)> {
        self.messages.0.drain(..).collect()
    }

    /// Where the steps begin and end.
    #[getter]
    fn span(&self) -> (f64, f64) {
        let steps = &self.simulation.model.steps;
        let ends = steps.first().zip(steps.last());
        ends.map_or((0.0, 0.0), |(first, last)| (first.start, last.end))
    }

    /// All of it as bytes, from which `Problem.go_on` makes it again; `None` before the first increment.
    fn state<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyBytes>> {
        let checkpoint = self.simulation.checkpoint()?;
        let parts = (checkpoint.to_bytes(), self.rows.clone());
        Some(PyBytes::new(py, &seal(&parts)))
    }

    #[getter]
    fn time(&self) -> f64 {
        self.simulation.frame.state.t
    }

    #[getter]
    fn dim(&self) -> usize {
        self.simulation.model.dofs.dim
    }

    #[getter]
    fn notes(&self) -> Vec<String> {
        self.rows.notes.clone()
    }

    #[getter]
    fn interfaces(&self) -> Vec<String> {
        let interfaces = self.simulation.contact.interfaces.iter();
        interfaces.map(|i| i.name.clone()).collect()
    }

    /// Ranges of points and of cells by body.
    #[getter]
    fn bodies(&self) -> Vec<(String, Bounds, Bounds)> {
        let model = &self.simulation.model;
        let cells = |blocks: std::ops::Range<usize>| -> usize {
            model.mesh.blocks[blocks]
                .iter()
                .map(|b| b.cell_ids.len())
                .sum()
        };
        let bodies = model.bodies.iter().map(|b| {
            let first = cells(0..b.blocks.start);
            let points = (b.points.start, b.points.end);
            (
                b.name.clone(),
                points,
                (first, first + cells(b.blocks.clone())),
            )
        });
        bodies.collect()
    }

    #[getter]
    fn summary(&self) -> String {
        serde_json::to_string(&self.simulation.summary).unwrap_or_default()
    }

    #[getter]
    fn points(&self) -> Array {
        let mesh = &self.simulation.model.mesh;
        Array::of(&mesh.points, vec![mesh.points.len(), 3], "<f8")
            .with(Owner::Mesh(Arc::clone(mesh)))
    }

    /// Kind and nodes of the cells of each block, `(cells, nodes)`.
    #[getter]
    fn cells(&self) -> Vec<(&'static str, Array)> {
        let mesh = &self.simulation.model.mesh;
        let blocks = mesh.blocks.iter();
        blocks
            .map(|block| {
                let shape = vec![block.cell_ids.len(), block.kind.node_count()];
                let array = Array::of(&block.connectivity, shape, "<u8");
                (block.kind.name(), array.with(Owner::Mesh(Arc::clone(mesh))))
            })
            .collect()
    }

    #[getter]
    fn displacement(slf: &Bound<'_, Self>) -> Array {
        Simulation::look(slf, Quantity::Displacement)
    }

    #[getter]
    fn velocity(slf: &Bound<'_, Self>) -> Array {
        Simulation::look(slf, Quantity::Velocity)
    }

    #[getter]
    fn acceleration(slf: &Bound<'_, Self>) -> Array {
        Simulation::look(slf, Quantity::Acceleration)
    }

    #[getter]
    fn forces(slf: &Bound<'_, Self>) -> Array {
        Simulation::look(slf, Quantity::Forces)
    }

    /// Columns of the table of an interface by name.
    fn contact(&self, name: &str) -> PyResult<Vec<(String, Array)>> {
        let Some(interface) = self.simulation.view().contacts().find(|i| i.name == name) else {
            return Err(PyKeyError::new_err(no_interface(name, &self.interfaces())));
        };
        let (names, columns) = look::table(interface, &self.simulation.frame.state.u);
        let columns = columns.into_iter().map(|c| {
            let shape = vec![c.len()];
            Array::floats(c, shape)
        });
        Ok(names.into_iter().zip(columns).collect())
    }

    /// All fields: name, whether at points, values `(points or cells, components)`.
    fn fields(&self, py: Python<'_>) -> Vec<(String, bool, Array)> {
        let fields = py.detach(|| fields(&self.simulation.view()));
        let fields = fields.all.into_iter();
        fields
            .map(|field| {
                let count = field.values.len() / field.components.max(1);
                let shape = match field.components {
                    1 => vec![count],
                    n => vec![count, n],
                };
                let at_points = field.location == Location::Point;
                (field.name, at_points, Array::floats(field.values, shape))
            })
            .collect()
    }
}
