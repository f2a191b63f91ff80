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

use std::path::Path;

use crate::error::{Diagnostic, Error, ProblemError};

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
        let mut findings = match self.to_toml() {
            Ok(text) => Document::new(text, None).departures(),
            Err(e) => e.findings,
        };
        findings.extend(check::check(self));
        findings
    }
}
