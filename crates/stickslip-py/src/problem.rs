//! Problems: text, checks, and the way to a simulation.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use stickslip::Error;
use stickslip::contact::interface::with_user_laws;
use stickslip::mesh::Mesh as Points;
use stickslip::model::{Contact, Setup};
use stickslip::newton::condensed::Library;
use stickslip::problem::{Document, Meshes, changes};
use stickslip::results::{FolderClaim, Lent, Saved, Source, digest_of_state, seal, unseal};
use stickslip::run::Checkpoint;
use stickslip_deck::Translation;

use super::errors::{raise, raise_deck};
use super::laws::{Function, Raised};
use super::mesh::Mesh;
use super::results::no_interface;
use super::run::Simulation;
use super::value;

/// Factors of bodies that simulations share.
#[pyclass(frozen, module = "stickslip._core")]
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
    /// What was said about a deck whose translation is gone.
    notes: Vec<String>,
}

/// A problem as bytes: its text, the file that names are relative to, notes about its deck, and meshes that no file has.
type Parts = (
    String,
    Option<String>,
    (Vec<String>, Vec<(String, Arc<Points>)>),
);

/// Functions that are laws of interfaces, by interface and kind.
type Functions = BTreeMap<String, BTreeMap<String, Py<PyAny>>>;

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
                notes: Vec::new(),
            }),
            Err(e) => Err(of_deck(py, deck.as_deref(), e.into())),
        }
    }

    fn of_tables(
        py: Python<'_>,
        dict: &Bound<'_, PyAny>,
        folder: Option<PathBuf>,
        meshes: Meshes,
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
            meshes,
            deck: None,
            notes: Vec::new(),
        })
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
        Problem::of_tables(py, dict, folder, given(meshes))
    }

    /// The same problem with other tables, and more meshes.
    fn with_tables(
        &self,
        py: Python<'_>,
        dict: &Bound<'_, PyAny>,
        meshes: BTreeMap<String, PyRef<'_, Mesh>>,
    ) -> PyResult<Self> {
        let mut all = self.meshes.clone();
        all.extend(given(meshes));
        let folder = self.document.file.as_ref().map(|_| self.document.folder());
        let problem = Problem::of_tables(py, dict, folder, all)?;
        Ok(Problem {
            notes: self.notes(),
            ..problem
        })
    }

    /// The names of the meshes that it was given.
    #[getter]
    fn meshes(&self) -> Vec<String> {
        self.meshes.keys().map(|name| text(name)).collect()
    }

    /// From an input deck of Abaqus or CalculiX.
    #[staticmethod]
    fn from_inp(py: Python<'_>, file: PathBuf) -> PyResult<Self> {
        let translate = || stickslip_deck::translate(&stickslip_deck::read(&file)?, &file);
        let deck = py.detach(translate).map_err(|e| raise_deck(py, &e))?;
        let document = deck.document(Vec::new());
        Problem::translated(py, document, deck.meshes(), Some(Arc::new(deck)))
    }

    /// What is to be said about the deck that it comes from.
    #[getter]
    fn notes(&self) -> Vec<String> {
        let notes = self.deck.iter().flat_map(|deck| &deck.notes);
        let notes = notes.map(ToString::to_string);
        notes.chain(self.notes.iter().cloned()).collect()
    }

    /// All of it as bytes, from which [`Problem::restore`] makes it again. Of a deck the translation is kept, not the deck.
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let meshes = self.meshes.iter();
        let meshes = meshes.map(|(name, mesh)| (text(name), Arc::clone(mesh)));
        let parts: Parts = (
            self.to_toml(py)?,
            Some(text(&self.place())),
            (self.notes(), meshes.collect()),
        );
        Ok(PyBytes::new(py, &seal(&parts)))
    }

    /// From what [`Problem::state`] returned.
    #[staticmethod]
    fn restore(py: Python<'_>, state: &[u8]) -> PyResult<Self> {
        let parts: Parts = unseal(state, "the problem").map_err(PyValueError::new_err)?;
        let (text, file, (notes, meshes)) = parts;
        let mut document = Document::new(text, None);
        let problem = document.problem().map_err(|e| raise(py, e.into()))?;
        document.file = file.map(PathBuf::from);
        let meshes = meshes.into_iter();
        Ok(Problem {
            document,
            problem,
            meshes: meshes.map(|(name, mesh)| (name.into(), mesh)).collect(),
            deck: None,
            notes,
        })
    }

    /// The problem with which the run in a folder of results goes on.
    #[staticmethod]
    fn of_results(py: Python<'_>, directory: PathBuf) -> PyResult<Self> {
        let read = || -> Result<(Document, stickslip::problem::Problem), Error> {
            let (saved, _) = Saved::find(&directory, None)?;
            let mut document = changes::of_results(&directory, &saved.source)?;
            let problem = document.problem()?;
            // Names of meshes are relative to where the problem was.
            document.file = Some(PathBuf::from(&saved.source.file));
            Ok((document, problem))
        };
        let (document, problem) = read().map_err(|e| raise(py, e))?;
        Ok(Problem {
            document,
            problem,
            meshes: Meshes::default(),
            deck: None,
            notes: Vec::new(),
        })
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

    /// Its tables as dictionaries, with the values that hold where nothing is said.
    fn tables<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let table = toml::Table::try_from(&self.problem);
        let table = table.map_err(|e| PyValueError::new_err(e.to_string()))?;
        value::dict(py, &table)
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
        laws: Functions,
    ) -> PyResult<Simulation> {
        let library = library(factors);
        let (setup, source, raised) = self.prepare(py, laws)?;
        let made = py.detach(|| stickslip::run::Simulation::with_library(setup, library));
        let made = made.map_err(|e| raise(py, e))?;
        Ok(Simulation::new(made, self.inputs(), source, raised))
    }

    /// Makes a simulation that goes on from what [`Simulation::state`] returned.
    fn go_on(
        &self,
        py: Python<'_>,
        factors: Option<PyRef<'_, Factors>>,
        laws: Functions,
        state: &[u8],
    ) -> PyResult<Simulation> {
        let library = library(factors);
        let (setup, source, raised) = self.prepare(py, laws)?;
        let (checkpoint, rows) = Simulation::parts(state)?;
        let made = py.detach(|| stickslip::run::Simulation::resume(setup, library, checkpoint));
        let made = made.map_err(|e| raise(py, e))?;
        Ok(Simulation::new(made, self.inputs(), source, raised).with_rows(rows))
    }

    /// Makes a simulation that goes on in a folder of results, from the last checkpoint or that after so many increments.
    fn resume(
        &self,
        py: Python<'_>,
        factors: Option<PyRef<'_, Factors>>,
        laws: Functions,
        directory: PathBuf,
        increments: Option<usize>,
    ) -> PyResult<Simulation> {
        let library = library(factors);
        let lent = self.lent(&laws);
        let find = || -> Result<(FolderClaim, Saved, Vec<String>), Error> {
            let held = FolderClaim::take(&directory)?;
            let (saved, notes) = Saved::find(&directory, increments)?;
            saved.check_lent(&directory, &lent)?;
            saved.check_inputs()?;
            changes::check_changes(&self.document, &self.problem, &saved)?;
            Ok((held, saved, notes))
        };
        let (held, saved, notes) = py.detach(find).map_err(|e| raise(py, e))?;
        if saved.has_prints() {
            return Err(PyValueError::new_err(format!(
                "{}: this run writes the .dat and .sta files of a deck: go on with `stickslip resume`",
                directory.display()
            )));
        }
        let (setup, source, raised) = self.prepare(py, laws)?;
        let go_on = || -> Result<_, Error> {
            let checkpoint = Checkpoint::of(&saved, &directory)?;
            let simulation = stickslip::run::Simulation::resume(setup, library, checkpoint)?;
            Ok((simulation, held))
        };
        let (made, held) = py.detach(go_on).map_err(|e| raise(py, e))?;
        let simulation = Simulation::new(made, self.inputs(), source, raised);
        simulation
            .going_on_in(&directory, held, &saved, notes)
            .map_err(|e| raise(py, e))
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

impl Problem {
    /// The files that the problem is read from.
    fn inputs(&self) -> Vec<PathBuf> {
        match &self.deck {
            Some(deck) => deck.files().to_vec(),
            None => self.document.inputs(&self.problem),
        }
    }

    /// The file that names are relative to, wherever this process is; it need not be there.
    fn place(&self) -> PathBuf {
        let file = self.document.file.clone();
        let file = file.unwrap_or_else(|| PathBuf::from("problem"));
        std::path::absolute(&file).unwrap_or(file)
    }

    /// What no file has.
    fn lent(&self, laws: &Functions) -> Lent {
        let functions = laws.iter().flat_map(|(name, kinds)| {
            let kinds = kinds.keys();
            kinds.map(move |kind| format!("{name}.{kind}"))
        });
        let meshes = self.meshes.iter();
        Lent {
            laws: functions.collect(),
            meshes: meshes
                .map(|(name, mesh)| (text(name), digest_of_state(mesh)))
                .collect(),
        }
    }

    /// What a simulation is made of: the model with its functions, what checkpoints say of the run, and the place for exceptions.
    fn prepare(&self, py: Python<'_>, laws: Functions) -> PyResult<(Setup, Source, Raised)> {
        let built = py.detach(|| self.setup());
        let mut setup = built.map_err(|e| of_deck(py, self.deck.as_deref(), e))?;
        let raised = Raised::default();
        let lent = self.lent(&laws);
        bring(&mut setup.contact, laws, &raised)?;
        let mut source = Source {
            problem: self.to_toml(py)?,
            file: text(&self.place()),
            lent,
            ..Source::default()
        };
        for file in self.inputs() {
            // A problem from a dictionary has a place, and no file there.
            if let Ok(digest) = stickslip::results::digest_of(&file) {
                let file = std::path::absolute(&file).unwrap_or(file);
                source.inputs.push((text(&file), digest));
            }
        }
        Ok((setup, source, raised))
    }
}

/// The factors that were given, or some of its own.
fn library(factors: Option<PyRef<'_, Factors>>) -> Arc<Library> {
    match factors {
        Some(factors) => Arc::clone(&factors.library),
        None => Arc::new(Library::new(Library::small_limit())),
    }
}

fn text(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}

/// The exception for an error about a problem that may come from a deck, whose lines it then names.
fn of_deck(py: Python<'_>, deck: Option<&Translation>, error: Error) -> PyErr {
    match deck.map(|deck| deck.located(error.clone())) {
        Some(Ok(e)) => raise_deck(py, &e),
        _ => raise(py, error),
    }
}

/// Gives interfaces the laws that are functions.
fn bring(contact: &mut Contact, laws: Functions, raised: &Raised) -> PyResult<()> {
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
            interface.definition = with_user_laws(
                interface,
                normal.clone().map(|f| f as _),
                friction.clone().map(|f| f as _),
            );
        }
        if !found {
            return Err(PyValueError::new_err(no_interface(&name, &known)));
        }
    }
    Ok(())
}
