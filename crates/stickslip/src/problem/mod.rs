//! The problem file: plain data ([`Problem`]), the TOML text it is read from ([`Document`]), and what can be wrong.
//!
//! The road is `text → Problem → Simulation`. The text is TOML with kebab-case keys; where one of several models is
//! chosen, the kind is a key: `friction.coulomb = { mu = 0.3 }`. stickslip knows no units: any consistent set will
//! do, and the units in the documentation of the keys say what is multiplied with what.
//!
//! Nothing is guessed: unknown keys are refused at their line and column with the nearest known name, and all
//! findings of a stage are reported at once (see [`Document::problem`]).

mod advice;
mod amplitude;
mod body;
mod brief;
mod build;
pub mod changes;
mod check;
mod coupling;
mod data;
mod document;
mod dynamic;
mod expected;
mod families;
mod fatigue;
mod foreign;
mod harmonic;
mod initial;
mod interface;
mod key;
mod load;
mod mass;
mod material;
mod model;
mod modes;
mod nearest;
mod obstacle;
mod output;
mod overrides;
mod pretension;
mod probe;
mod prose;
mod quality;
mod reference;
mod roughness;
mod schema;
mod set;
mod solver;
mod step;
mod structure;
mod support;
mod temperature;
mod tree;

use std::collections::BTreeMap;
use std::path::Path;

use crate::error::{Diagnostic, Error, ProblemError};
use crate::model::Setup;

pub use amplitude::AmplitudeTable;
pub use body::{Body, BodyRotation, GmshFile, MeshSource, Rayleigh};
pub use brief::brief_toml;
pub use build::Meshes;
pub use changes::changed_keys;
pub use coupling::Coupling;
pub use data::{FORMAT, Problem};
pub use document::Document;
pub use dynamic::Dynamic;
pub use families::{FamilyListing, ModelListing, families};
pub use fatigue::Fatigue;
pub use harmonic::Harmonic;
pub use initial::Initial;
pub use interface::{FacetShape, Interface, Roles};
pub use load::Load;
pub use mass::Mass;
pub use material::{ConstantsAt, Material};
pub use model::{Model, SpaceKind};
pub use modes::{ComplexModes, FrictionRange, Kick, Modes, SteadySliding, Turning};
pub use nearest::nearest;
pub use obstacle::Obstacle;
pub use output::{CheckpointPlan, Frd, Output};
pub use pretension::{FacetSection, Pretension, Section, Tension};
pub use probe::Probe;
pub use quality::Quality;
pub use reference::Reference;
pub use roughness::Roughness;
#[cfg(feature = "schema")]
pub use schema::derived as derived_schema;
pub use schema::schema;
pub use set::{BallRegion, BoxRegion, PlaneRegion, Select, Set};
pub use solver::{Linear, Solver};
pub use step::{Cycles, Increments, Step};
pub use support::{Component, Support};
pub use temperature::Temperature;

impl Problem {
    /// A problem without bodies and steps.
    pub fn new(model: Model) -> Self {
        Problem {
            format: FORMAT,
            title: None,
            model,
            body: BTreeMap::new(),
            material: BTreeMap::new(),
            obstacle: BTreeMap::new(),
            set: BTreeMap::new(),
            reference: BTreeMap::new(),
            interface: BTreeMap::new(),
            support: BTreeMap::new(),
            load: BTreeMap::new(),
            temperature: BTreeMap::new(),
            mass: BTreeMap::new(),
            coupling: BTreeMap::new(),
            pretension: BTreeMap::new(),
            amplitude: BTreeMap::new(),
            initial: BTreeMap::new(),
            step: Vec::new(),
            solver: Solver::default(),
            quality: Quality::default(),
            output: Output::default(),
            probe: BTreeMap::new(),
        }
    }

    /// As the text of a problem file, which gives the same problem again.
    ///
    /// # Errors
    /// If a value cannot be written as TOML: a whole number above `i64::MAX`.
    pub fn to_toml(&self) -> Result<String, ProblemError> {
        data::to_toml(self)
    }

    /// Reads and checks the text of a problem file; `file` is named in messages.
    ///
    /// # Errors
    /// All findings of the first stage that has any, see [`Document::problem`].
    pub fn from_toml(text: &str, file: Option<&Path>) -> Result<Self, ProblemError> {
        Document::new(text, file).problem()
    }

    /// Reads and checks a problem file.
    ///
    /// # Errors
    /// [`Error::Io`] if it cannot be read, [`Error::Problem`] with the findings.
    pub fn from_file(file: &Path) -> Result<Self, Error> {
        Ok(Document::read(file)?.problem()?)
    }

    /// The rules for single values, and those that bind tables to each other: names that exist, vectors of the right
    /// length, times that increase. What only a mesh can tell (whether it has a set) is found when the problem is
    /// built.
    ///
    /// The findings carry keys but no places; [`Document::error`] adds them.
    pub fn check(&self) -> Vec<Diagnostic> {
        let mut findings = match data::to_toml(self) {
            Ok(text) => Document::new(text, None).departures(),
            Err(e) => e.findings,
        };
        findings.extend(check::check(self));
        findings
    }

    /// Builds what can be simulated. Mesh files are looked for relative to `folder`.
    ///
    /// # Errors
    /// [`Error::Problem`] with findings that carry keys but no places (see [`Document::error`]),
    /// [`Error::Mesh`] for a mesh that cannot be used, [`Error::Io`] for a file that cannot be read.
    pub fn build(&self, folder: &Path) -> Result<Setup, Error> {
        self.build_with(folder, &Meshes::default())
    }

    /// The same with meshes from memory: the name of a mesh file that is among them is not looked for on disk.
    ///
    /// # Errors
    /// Those of [`Problem::build`].
    pub fn build_with(&self, folder: &Path, meshes: &Meshes) -> Result<Setup, Error> {
        let findings = self.check();
        match findings.is_empty() {
            true => build::build(self, folder, meshes),
            false => Err(ProblemError::from(findings).into()),
        }
    }
}
