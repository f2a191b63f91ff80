//! The problem as a whole: its tables.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::amplitude::AmplitudeTable;
use super::body::Body;
use super::coupling::Coupling;
use super::initial::Initial;
use super::interface::Interface;
use super::load::Load;
use super::mass::Mass;
use super::material::Material;
use super::model::Model;
use super::obstacle::Obstacle;
use super::output::Output;
use super::pretension::Pretension;
use super::probe::Probe;
use super::quality::Quality;
use super::reference::Reference;
use super::set::Set;
use super::solver::Solver;
use super::step::Step;
use super::support::Support;
use super::temperature::Temperature;
use crate::error::{Diagnostic, ProblemError};

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
    /// Points that belong to no mesh, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub reference: BTreeMap<String, Reference>,
    /// Pairs of surfaces that may touch, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub interface: BTreeMap<String, Interface>,
    /// Prescribed displacements, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub support: BTreeMap<String, Support>,
    /// Forces and springs, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub load: BTreeMap<String, Load>,
    /// Temperatures of sets, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub temperature: BTreeMap<String, Temperature>,
    /// Masses at points, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub mass: BTreeMap<String, Mass>,
    /// Equations between displacements, springs between points and ties to reference points, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub coupling: BTreeMap<String, Coupling>,
    /// Cuts through bolts that are tightened, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub pretension: BTreeMap<String, Pretension>,
    /// Factors over time, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub amplitude: BTreeMap<String, AmplitudeTable>,
    /// Initial displacements, velocities and temperatures, by name.
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

/// As the text of a problem file, which gives the same problem again.
///
/// # Errors
/// If a value cannot be written as TOML: a whole number above `i64::MAX`.
pub(super) fn to_toml(problem: &Problem) -> Result<String, ProblemError> {
    toml::to_string(problem).map_err(|e| {
        vec![Diagnostic::new(
            "",
            format!("cannot be written as TOML: {e}"),
        )]
        .into()
    })
}
