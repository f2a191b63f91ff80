use std::ops::Range;
use std::sync::Arc;

use crate::body::loads::{Load, Spring};
use crate::body::{Elastic, Space};
use crate::contact::interface::Interface;
use crate::mesh::Mesh;
use crate::newton::Settings;
use crate::system::{Dofs, Schedule};
use crate::time::Increments;

/// Everything that is simulated.
pub struct Model {
    /// Title for reports.
    pub title: String,
    /// Kind of space.
    pub space: Space,
    /// All bodies in one mesh; bodies share no points.
    pub mesh: Arc<Mesh>,
    /// Numbering of the unknowns.
    pub dofs: Dofs,
    /// The bodies.
    pub bodies: Vec<Body>,
    /// Loads.
    pub loads: Vec<Load>,
    /// Springs to ground.
    pub springs: Vec<Spring>,
    /// Supports and prescribed displacements.
    pub supports: Vec<Support>,
    /// Interfaces.
    pub interfaces: Vec<Interface>,
    /// Steps, in order of time.
    pub steps: Vec<Step>,
    /// Quantities for the history.
    pub probes: Vec<Probe>,
    /// What is written when.
    pub output: OutputPlan,
    /// Settings of Newton's method.
    pub settings: Settings,
    /// Largest displacement increment relative to the size of the model.
    pub largest_change: f64,
}

/// A body: a range of points and blocks of the mesh.
pub struct Body {
    /// Name in the problem file.
    pub name: String,
    /// Its points.
    pub points: Range<usize>,
    /// Its blocks.
    pub blocks: Range<usize>,
    /// Its elasticity.
    pub elastic: Elastic,
}

/// Prescribed displacements of a set.
#[derive(Debug, Clone)]
pub struct Support {
    /// Name in the problem file.
    pub name: String,
    /// The dofs and their values at factor 1.
    pub entries: Vec<Prescribed>,
    /// When it acts and with which factor.
    pub schedule: Schedule,
    /// `true` if the factor multiplies the value; `false` if it leads from the displacement at the start of the first step in
    /// which it acts to the value.
    pub table: bool,
}

/// One prescribed dof.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prescribed {
    /// The dof.
    pub dof: usize,
    /// Displacement `[m]`.
    pub value: f64,
}

/// A step.
#[derive(Debug, Clone)]
pub struct Step {
    /// Name.
    pub name: String,
    /// Start.
    pub start: f64,
    /// End.
    pub end: f64,
    /// Size of increments.
    pub increments: Increments,
    /// Times that increments must land on.
    pub milestones: Vec<f64>,
}

/// A point whose displacement and stress go into the history.
#[derive(Debug, Clone)]
pub struct Probe {
    /// Name: the columns are `name.U1`, …
    pub name: String,
    /// The mesh point.
    pub point: usize,
}

/// What is written when.
#[derive(Debug, Clone, Default)]
pub struct OutputPlan {
    /// Fields after every so many increments; 0: only at `times` and at the end of steps.
    pub every: usize,
    /// Times of field output.
    pub times: Vec<f64>,
}
