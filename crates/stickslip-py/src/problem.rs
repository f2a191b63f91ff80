//! Problems: text, checks, and the way to a simulation.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use stickslip::Error;
use stickslip::model::{Contact, Setup};
use stickslip::newton::condensed::Library;
use stickslip::problem::{Document, Meshes};
use stickslip_deck::{Deck, Translation};

use super::errors::{raise, raise_deck};
use super::laws::{Function, Raised};
use super::mesh::Mesh;
use super::run::Simulation;
use super::value;

/// Factors of bodies that simulations share.
#[pyclass(frozen)]
pub struct Factors {
    library: Arc<Library>,
}

#[pymethods]
impl Factors {
    #[new]
    fn new() -> Self {
        Factors {
            library: Arc::new(Library::new(Library::usual_limit())),
        }
    }
}

/// A problem that has been read and checked.
#[pyclass(frozen)]
pub struct Problem {
    document: Document,
    problem: stickslip::problem::Problem,
    meshes: Meshes,
    /// What it was translated from.
    deck: Option<Arc<Translation>>,
}

fn given(meshes: BTreeMap<String, PyRef<'_, Mesh>>) -> Meshes {
    let meshes = meshes.into_iter();
    meshes
        .map(|(name, mesh)| (PathBuf::from(name), Arc::clone(&mesh.mesh)))
        .collect()
}

impl Problem {
    fn read(py: Python<'_>, document: Document, meshes: Meshes) -> PyResult<Self> {
        Problem::translated(py, document, meshes, None)
    }

    fn translated(
        py: Python<'_>,
        document: Document,
        meshes: Meshes,
        deck: Option<Arc<Translation>>,
    ) -> PyResult<Self> {
        match document.problem() {
            Ok(problem) => Ok(Problem {
                document,
                problem,
                meshes,
                deck,
            }),
            Err(e) => Err(of_deck(py, deck.as_deref(), e.into())),
        }
    }

    fn setup(&self) -> Result<Setup, Error> {
        let folder = self.document.folder();
        let built = self.problem.build_with(&folder, &self.meshes);
        built.map_err(|error| match error {
            Error::Problem(e) if e.source.is_empty() => self.document.error(e.findings).into(),
            other => other,
        })
    }
}

#[pymethods]
impl Problem {
    /// From the text of a problem file; `file` is named in messages, and files are looked for beside it.
    #[staticmethod]
    fn from_text(
        py: Python<'_>,
        text: &str,
        file: Option<PathBuf>,
        meshes: BTreeMap<String, PyRef<'_, Mesh>>,
    ) -> PyResult<Self> {
        let document = Document::new(text, file.as_deref());
        Problem::read(py, document, given(meshes))
    }

    /// From a problem file.
    #[staticmethod]
    fn from_file(
        py: Python<'_>,
        file: PathBuf,
        meshes: BTreeMap<String, PyRef<'_, Mesh>>,
    ) -> PyResult<Self> {
        let document = Document::read(&file).map_err(|e| raise(py, e))?;
        Problem::read(py, document, given(meshes))
    }

    /// From a dictionary with the keys of a problem file; other files are looked for in `folder`.
    #[staticmethod]
    fn from_dict(
        py: Python<'_>,
        dict: &Bound<'_, PyAny>,
        folder: Option<PathBuf>,
        meshes: BTreeMap<String, PyRef<'_, Mesh>>,
    ) -> PyResult<Self> {
        let text = value::document(dict)?;
        let mut document = Document::new(text, None);
        // Only its folder counts: the name must not show in messages, as there is no such file.
        let place = folder.map(|f| f.join("problem"));
        let problem = document.problem().map_err(|e| raise(py, e.into()))?;
        document.file = place;
        Ok(Problem {
            document,
            problem,
            meshes: given(meshes),
            deck: None,
        })
    }

    /// From an input deck of Abaqus or CalculiX.
    #[staticmethod]
    fn from_inp(py: Python<'_>, file: PathBuf) -> PyResult<Self> {
        let translate = || Deck::read(&file)?.translate(&file);
        let deck = py.detach(translate).map_err(|e| raise_deck(py, &e))?;
        let document = deck.document(Vec::new());
        Problem::translated(py, document, deck.meshes(), Some(Arc::new(deck)))
    }

    /// What is to be said about the deck that it comes from.
    #[getter]
    fn notes(&self) -> Vec<String> {
        let notes = self.deck.iter().flat_map(|deck| &deck.notes);
        notes.map(ToString::to_string).collect()
    }

    /// The same problem with other values, by the paths of their keys.
    fn with_values(&self, py: Python<'_>, values: &Bound<'_, PyDict>) -> PyResult<Self> {
        let mut overrides = Vec::new();
        for (path, object) in values.iter() {
            let path: String = path.extract()?;
            overrides.push(format!("{path}={}", value::inline(&object, &path)?));
        }
        let document = self.document.clone().with_overrides(overrides);
        Problem::translated(py, document, self.meshes.clone(), self.deck.clone())
    }

    /// As the text of a problem file.
    fn to_toml(&self, py: Python<'_>) -> PyResult<String> {
        self.problem.to_toml().map_err(|e| raise(py, e.into()))
    }

    /// What the doctor says of the problem before it is run: as text, and as JSON.
    fn check(&self, py: Python<'_>) -> PyResult<(String, String)> {
        let checked = py.detach(|| {
            let mut simulation = stickslip::run::Simulation::new(self.setup()?)?;
            let report = simulation.check();
            let json = serde_json::to_string(&report).unwrap_or_default();
            Ok((report.to_string(), json))
        });
        checked.map_err(|e| of_deck(py, self.deck.as_deref(), e))
    }

    /// Makes a simulation.
    fn build(
        &self,
        py: Python<'_>,
        factors: Option<PyRef<'_, Factors>>,
        laws: BTreeMap<String, BTreeMap<String, Py<PyAny>>>,
    ) -> PyResult<Simulation> {
        let built = py.detach(|| self.setup());
        let mut setup = built.map_err(|e| of_deck(py, self.deck.as_deref(), e))?;
        let raised = Raised::default();
        bring(&mut setup.contact, laws, &raised)?;
        let library = match factors {
            Some(factors) => Arc::clone(&factors.library),
            None => Arc::new(Library::new(Library::small_limit())),
        };
        let made = py.detach(|| stickslip::run::Simulation::with_library(setup, library));
        let inputs = match &self.deck {
            Some(deck) => deck.files().to_vec(),
            None => self.document.inputs(&self.problem),
        };
        Ok(Simulation::new(
            made.map_err(|e| raise(py, e))?,
            inputs,
            raised,
        ))
    }

    /// The folder relative to which files are looked for.
    #[getter]
    fn folder(&self) -> PathBuf {
        self.document
            .file
            .as_deref()
            .and_then(Path::parent)
            .map_or_else(PathBuf::new, Path::to_path_buf)
    }
}

/// The exception for an error about a problem that may come from a deck, whose lines it then names.
fn of_deck(py: Python<'_>, deck: Option<&Translation>, error: Error) -> PyErr {
    match deck.map(|deck| deck.located(error.clone())) {
        Some(Ok(e)) => raise_deck(py, &e),
        _ => raise(py, error),
    }
}

/// Gives interfaces the laws that are functions.
fn bring(
    contact: &mut Contact,
    laws: BTreeMap<String, BTreeMap<String, Py<PyAny>>>,
    raised: &Raised,
) -> PyResult<()> {
    for (name, mut functions) in laws {
        let mut take = |key: &str| {
            functions.remove(key).map(|function| {
                Arc::new(Function {
                    function,
                    raised: Arc::clone(raised),
                })
            })
        };
        let normal = take("normal");
        let friction = take("friction");
        if let Some(key) = functions.keys().next() {
            return Err(PyValueError::new_err(format!(
                "laws of {name}: there is no `{key}`; allowed are normal and friction"
            )));
        }
        let known: Vec<String> = contact.interfaces.iter().map(|i| i.name.clone()).collect();
        let mut found = false;
        // Two-sided contact is two interfaces of one name.
        for interface in contact.interfaces.iter_mut().filter(|i| i.name == name) {
            found = true;
            interface.set_user_laws(
                normal.clone().map(|f| f as _),
                friction.clone().map(|f| f as _),
            );
        }
        if !found {
            return Err(PyValueError::new_err(format!(
                "there is no interface `{name}`; there are: {}",
                known.join(", ")
            )));
        }
    }
    Ok(())
}
