//! What becomes of a deck: a problem, its mesh, and what is printed.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use stickslip::error::{Diagnostic, Error, ProblemError};
use stickslip::mesh::Mesh;
use stickslip::problem::{Document, Meshes};
use stickslip::results::{Due, FrdPlan, Request};

use crate::card::Place;
use crate::deck::{Filed, Print, When};
use crate::finding::{DeckError, Finding, Severity};
use crate::numbering::Numbering;

/// A deck as a stickslip problem.
#[derive(Debug, Clone)]
pub struct Translation {
    /// The problem file.
    pub toml: String,
    /// The name under which it asks for its mesh: `job.msh`.
    pub mesh_name: PathBuf,
    /// The mesh of all bodies, with the numbers and sets of the deck.
    pub mesh: Arc<Mesh>,
    /// Warnings and notes, of reading and translation.
    pub notes: Vec<Finding>,
    /// What is most likely not meant, or would be refused by CalculiX; `stickslip check` shows it.
    pub lint: Vec<Finding>,
    /// What goes to the `.dat` file.
    pub plan: PrintPlan,
    /// What is written to the `.frd` file, by step.
    pub filed: Vec<Vec<Filed>>,
    /// Where elements are, for messages.
    pub(super) elements: BTreeMap<u64, Place>,
    /// The deck, for messages.
    pub(super) path: PathBuf,
    /// Where tables of the problem come from.
    pub(super) places: Vec<(String, Place)>,
    pub(super) files: Vec<PathBuf>,
}

/// What is printed of a deck, and of which of its sets.
#[derive(Debug, Clone)]
pub struct PrintPlan {
    /// What is printed, by step.
    pub prints: Vec<Vec<Print>>,
    /// Nodes of the printed sets, in the order of the deck.
    pub node_sets: BTreeMap<String, Vec<u64>>,
    /// Elements of the printed sets.
    pub element_sets: BTreeMap<String, Vec<u64>>,
    /// Faces of the surfaces whose forces are printed: element, and face of the cell from 0.
    pub surfaces: BTreeMap<String, Vec<(u64, usize)>>,
    /// Interfaces by slave and master, in the order of the deck: `(name, slave, master)`.
    pub pairs: Vec<(String, String, String)>,
    /// Names of pretensions by their nodes.
    pub(crate) drawn: BTreeMap<u64, String>,
    /// Nodes that are reference points, with the names of these, and whether their displacements are its rotations.
    pub references: BTreeMap<u64, (String, bool)>,
    /// How numbers of the mesh are written in the deck.
    pub numbering: Numbering,
    /// Times of `*TIME POINTS` in the time of the analysis.
    pub(crate) times: BTreeMap<String, Vec<f64>>,
    /// Local axes (rows) of nodes with a `*TRANSFORM`, and of elements with an `*ORIENTATION`.
    pub(crate) node_axes: BTreeMap<u64, [[f64; 3]; 3]>,
    pub(crate) element_axes: BTreeMap<u64, [[f64; 3]; 3]>,
}

impl Translation {
    /// The problem file as a document, with changes `path=value`.
    pub fn document(&self, overrides: Vec<String>) -> Document {
        Document::new(self.toml.clone(), Some(&self.path)).with_overrides(overrides)
    }

    /// The `.frd` file of a job of this name.
    pub fn frd(&self, job: &str) -> FrdPlan {
        let request = |filed: &Filed| Request {
            quantities: filed.quantities.clone(),
            due: match &filed.when {
                When::Every(n) => Due::Every(*n),
                When::Times(name) => {
                    Due::At(self.plan.times.get(name).cloned().unwrap_or_default())
                }
            },
        };
        let step = |filed: &Vec<Filed>| filed.iter().map(request).collect();
        FrdPlan {
            name: format!("{job}.frd"),
            steps: Some(self.filed.iter().map(step).collect()),
        }
    }

    /// The files that the deck was read from.
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// The mesh under its name.
    pub fn meshes(&self) -> Meshes {
        Meshes::from([(self.mesh_name.clone(), self.mesh.clone())])
    }

    /// Findings about the translated problem as findings about the deck.
    pub fn located(&self, error: Error) -> Result<DeckError, Error> {
        match error {
            Error::Problem(ProblemError { findings, .. }) => Ok(DeckError {
                findings: findings.iter().map(|d| self.locate(d)).collect(),
            }),
            Error::Mesh(e) => {
                // Messages about meshes name cells by their numbers.
                let number = |text: &str| -> Option<u64> {
                    let after = text.split("cell ").nth(1)?;
                    after.split(' ').next()?.parse().ok()
                };
                let cell = number(&e.message).filter(|n| self.elements.contains_key(n));
                let place = cell.map_or(Place::default(), |n| self.elements[&n]);
                let message = cell.map_or(e.message.clone(), |n| {
                    let written = format!("cell {}", self.plan.numbering.label(n));
                    e.message.replacen(&format!("cell {n}"), &written, 1)
                });
                let file = self.files.get(place.file).filter(|_| place.line > 0);
                Ok(DeckError {
                    findings: vec![Finding {
                        severity: Severity::Error,
                        file: file.unwrap_or(&self.path).clone(),
                        line: place.line,
                        message,
                        help: e.help,
                    }],
                })
            }
            other => Err(other),
        }
    }

    fn locate(&self, finding: &Diagnostic) -> Finding {
        // The longest table the key lies in.
        let within = |key: &str| {
            finding.key == key
                || finding
                    .key
                    .strip_prefix(key)
                    .is_some_and(|rest| rest.starts_with('.'))
        };
        let place = self
            .places
            .iter()
            .filter(|(key, _)| within(key))
            .max_by_key(|(key, _)| key.len());
        let place = place.map(|(_, place)| *place).unwrap_or_default();
        let file = self.files.get(place.file).filter(|_| place.line > 0);
        let key = match finding.key.is_empty() {
            true => String::new(),
            false => format!("{}: ", finding.key),
        };
        Finding {
            severity: Severity::Error,
            file: file.unwrap_or(&self.path).clone(),
            line: place.line,
            message: format!("{key}{}", finding.message),
            help: finding.help.clone(),
        }
    }
}
