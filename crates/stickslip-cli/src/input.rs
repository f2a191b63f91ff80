//! What a command is given: a problem file, or a deck of Abaqus or CalculiX.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use stickslip::Error;
use stickslip::io::gmsh;
use stickslip::model::Setup;
use stickslip::problem::{Document, MeshSource, Meshes, Problem};
use stickslip_deck::{Severity, Translation};

use crate::failure::{Failure, located};
use crate::given::{self, is_deck};

/// A problem with where it comes from.
pub struct Input {
    /// Its text; for a deck the one it was translated to.
    pub document: Document,
    /// The problem.
    pub problem: Problem,
    /// The deck.
    pub deck: Option<Arc<Translation>>,
    meshes: Meshes,
    /// The folder that names of files are relative to.
    folder: PathBuf,
}

/// Reads and translates a deck.
pub fn translate(file: &Path) -> Result<Translation, Failure> {
    let translate = || stickslip_deck::translate(&stickslip_deck::read(file)?, file);
    translate().map_err(Failure::Deck)
}

/// A file as it was read, before values are changed: what a sweep runs again and again.
pub struct Case {
    /// Its text; for a deck the one it was translated to.
    pub document: Document,
    /// The deck.
    deck: Option<Arc<Translation>>,
    /// The meshes that the last problem read from files, if those that follow shall have them.
    kept: Option<Mutex<Meshes>>,
}

impl Case {
    /// Reads a problem file, or a deck if the name ends in `.inp`.
    pub fn read(file: &Path) -> Result<Case, Failure> {
        given::file(file, &["toml", "inp"])?;
        let deck = match is_deck(file) {
            true => Some(Arc::new(translate(file)?)),
            false => None,
        };
        let document = match &deck {
            Some(deck) => deck.document(Vec::new()),
            None => Document::read(file)?,
        };
        Ok(Case {
            document,
            deck,
            kept: None,
        })
    }

    /// Reads files of meshes once for problems that follow each other.
    pub fn keeping_meshes(mut self) -> Case {
        self.kept = Some(Mutex::default());
        self
    }

    /// The meshes of a problem that are not read again. What is wrong with a file is said by who builds the model.
    fn meshes(&self, problem: &Problem, folder: &Path) -> Meshes {
        let mut all = self
            .deck
            .as_ref()
            .map_or_else(Meshes::default, |d| d.meshes());
        let Some(kept) = &self.kept else {
            return all;
        };
        let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
        let mut now = Meshes::default();
        for body in problem.body.values() {
            let MeshSource::Gmsh(mesh) = &body.mesh else {
                continue;
            };
            let name = PathBuf::from(&mesh.file);
            if all.contains_key(&name) || now.contains_key(&name) {
                continue;
            }
            let known = kept.get(&name).map(Arc::clone);
            let read = || gmsh::read(&folder.join(&name)).ok().map(Arc::new);
            now.extend(known.or_else(read).map(|mesh| (name, mesh)));
        }
        all.extend(now.clone());
        *kept = now;
        all
    }

    /// With values changed.
    pub fn input(&self, overrides: &[String]) -> Result<Input, Failure> {
        let document = self.document.clone().with_overrides(overrides.to_vec());
        let problem = document.problem();
        let problem = problem.map_err(|e| self.failure(e.into()))?;
        let folder = document.folder();
        Ok(Input {
            meshes: self.meshes(&problem, &folder),
            problem,
            folder,
            document,
            deck: self.deck.clone(),
        })
    }

    /// All files of a sweep whose problems read these.
    pub fn files(&self, read: BTreeSet<PathBuf>) -> Vec<PathBuf> {
        let files = match &self.deck {
            Some(deck) => deck.files().to_vec(),
            None => read.into_iter().collect(),
        };
        // What is not there is said of each of the runs that want it.
        files.into_iter().filter(|file| file.is_file()).collect()
    }

    /// Findings about the problem as findings about the deck, if it is one.
    pub fn failure(&self, error: Error) -> Failure {
        match &self.deck {
            Some(deck) => of_deck(deck, error),
            None => error.into(),
        }
    }
}

impl Input {
    /// Reads a problem file, or a deck if the name ends in `.inp`.
    pub fn open(file: &Path, overrides: &[String]) -> Result<Input, Failure> {
        Case::read(file)?.input(overrides)
    }

    /// A problem whose names of files are relative to another folder than its own.
    pub fn of(document: Document, folder: PathBuf) -> Result<Input, Failure> {
        Ok(Input {
            problem: document.problem()?,
            document,
            deck: None,
            meshes: Meshes::default(),
            folder,
        })
    }

    /// All files that are read for it.
    pub fn files(&self) -> Vec<PathBuf> {
        match &self.deck {
            Some(deck) => deck.files().to_vec(),
            None => self.document.inputs(&self.problem),
        }
    }

    /// The model.
    pub fn build(&self) -> Result<Setup, Failure> {
        let built = self.problem.build_with(&self.folder, &self.meshes);
        built.map_err(|e| match &self.deck {
            Some(deck) => of_deck(deck, e),
            None => located(&self.document, e).into(),
        })
    }

    /// What is to be said about a deck: its warnings, and its notes if `all`.
    pub fn notes(&self, all: bool) -> Vec<String> {
        let notes = self.deck.iter().flat_map(|d| &d.notes);
        notes
            .filter(|n| all || n.severity != Severity::Note)
            .map(ToString::to_string)
            .collect()
    }
}

fn of_deck(deck: &Translation, error: Error) -> Failure {
    match deck.located(error) {
        Ok(e) => Failure::Deck(e),
        Err(e) => e.into(),
    }
}
