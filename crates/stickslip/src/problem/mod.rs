//! The problem file: plain data ([`Problem`]), the TOML text it is read from ([`Document`]), and what can be wrong.
//!
//! The road is `text → Problem → Simulation`. The text is TOML with kebab-case keys; where one of several models is
//! chosen, the kind is a key: `friction.coulomb = { mu = 0.3 }`. stickslip knows no units: any consistent set will
//! do, and the units in the documentation of the keys say what is multiplied with what.
//!
//! Nothing is guessed: unknown keys are refused at their line and column with the nearest known name, and all
//! findings of a stage are reported at once (see [`Document::problem`]).

mod amplitude;
mod body;
mod build;
mod check;
mod coupling;
mod document;
mod dynamic;
mod families;
mod initial;
mod interface;
mod key;
mod load;
mod mass;
mod model;
mod nearest;
mod obstacle;
mod output;
mod overrides;
mod probe;
mod prose;
mod quality;
mod schema;
mod set;
mod solver;
mod step;
mod structure;
mod support;
mod tree;

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::error::{Diagnostic, Error, ProblemError};
use crate::material::Material;

pub use amplitude::AmplitudeTable;
pub use body::{Body, GmshFile, MeshSource, Rayleigh};
pub use build::Meshes;
pub use coupling::Coupling;
pub use document::Document;
pub use dynamic::Dynamic;
pub use families::{FamilyListing, ModelListing, families};
pub use initial::Initial;
pub use interface::{FacetShape, Interface, Roles};
pub use load::Load;
pub use mass::Mass;
pub use model::{Model, SpaceKind};
pub use nearest::nearest;
pub use obstacle::Obstacle;
pub use output::Output;
pub use probe::Probe;
pub use quality::Quality;
#[cfg(feature = "schema")]
pub use schema::derived as derived_schema;
pub use schema::schema;
pub use set::{BallRegion, BoxRegion, PlaneRegion, Select, Set};
pub use solver::{Linear, Solver};
pub use step::{Increments, Step};
pub use support::{Component, Support};

/// The format of the problem file that this version reads.
pub const FORMAT: u32 = 1;

/// A problem as plain data: bodies, what holds and loads them, interfaces, steps, solver, output.
///
/// It can be filled in by hand or read from TOML; [`Problem::check`] applies the same rules to both.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[cfg_attr(feature = "schema", schemars(title = "stickslip problem file"))]
pub struct Problem {
    /// The format of the file: 1.
    pub format: u32,
    /// A title for reports.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// The space in which the bodies live.
    pub model: Model,
    /// Elastic bodies, by name.
    pub body: BTreeMap<String, Body>,
    /// Materials, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub material: BTreeMap<String, Material>,
    /// Rigid obstacles, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub obstacle: BTreeMap<String, Obstacle>,
    /// Sets chosen by geometry, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub set: BTreeMap<String, Set>,
    /// Pairs of surfaces that may touch, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub interface: BTreeMap<String, Interface>,
    /// Prescribed displacements, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub support: BTreeMap<String, Support>,
    /// Forces and springs, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub load: BTreeMap<String, Load>,
    /// Masses at points, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub mass: BTreeMap<String, Mass>,
    /// Equations between displacements and springs between points, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub coupling: BTreeMap<String, Coupling>,
    /// Factors over time, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub amplitude: BTreeMap<String, AmplitudeTable>,
    /// Initial displacements and velocities, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub initial: BTreeMap<String, Initial>,
    /// The steps of the analysis, in order.
    #[cfg_attr(feature = "schema", schemars(length(min = 1)))]
    pub step: Vec<Step>,
    /// Tolerances and limits of the solution.
    #[serde(default)]
    pub solver: Solver,
    /// What counts as a good solution.
    #[serde(default)]
    pub quality: Quality,
    /// What is written, and when.
    #[serde(default)]
    pub output: Output,
    /// Quantities followed over the analysis, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub probe: BTreeMap<String, Probe>,
}

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

    /// As the text of a problem file, which gives the same problem again.
    ///
    /// # Errors
    /// If a value cannot be written as TOML: a whole number above `i64::MAX`.
    pub fn to_toml(&self) -> Result<String, ProblemError> {
        toml::to_string(self).map_err(|e| ProblemError {
            file: None,
            source: String::new(),
            findings: vec![Diagnostic::new(
                "",
                format!("cannot be written as TOML: {e}"),
            )],
        })
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
