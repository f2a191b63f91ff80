//! Where an analysis stands.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::course::Course;
use super::cycling::Block;
use super::kick::Kick;
use super::ledger::EnergyLedger;
use crate::body::couplings::CouplingsMemory;
use crate::contact::interface::History;
use crate::fatigue::Record;
use crate::system::State;

/// Where an analysis stands after an accepted increment: all that follows, follows from this and the model.
#[derive(Debug, Clone, Default, crate::keep::Keep)]
pub struct Frame {
    /// Index of the step.
    pub step: usize,
    /// Displacements, velocities and accelerations at their time.
    pub state: State,
    /// Internal minus external forces `[N]`: reactions where supported.
    pub forces: Vec<f64>,
    /// What interfaces and couplings know after this increment.
    pub contacts: Arc<ContactMemory>,
    /// What interfaces and couplings add to the residual `[N]`.
    pub contact: Vec<f64>,
    /// External forces `[N]`.
    pub load: Vec<f64>,
    /// Energy in couplings `[J]`.
    pub coupled: f64,
    /// Displacements from which supports started `[m]`, by the name of the support.
    pub starts: BTreeMap<String, Vec<f64>>,
    /// Forces of supports and equations that let go when the step began, by dof `[N]`: they fade over the step.
    pub released: Vec<(usize, f64)>,
    /// Displacements over the last increments of a quasi-static step `[m]`.
    pub course: Course,
    /// What an implicit step knows beside the state.
    pub motion: Motion,
    /// The cycle at hand, where jumps over cycles are chosen.
    pub block: Block,
    /// Stress over the cycle at hand, and what criteria of fatigue said of the last, where they are asked.
    pub fatigue: Record,
    /// Values of the fields beside the displacements, by field and dof.
    pub fields: Vec<Vec<f64>>,
    /// The mode along which the last motion began.
    pub kick: Option<Kick>,
    /// Energies: what there is, and where it came from and went.
    pub ledger: EnergyLedger,
}

/// What interfaces and couplings have been through.
#[derive(Debug, Clone, Default, crate::keep::Keep)]
pub struct ContactMemory {
    /// By interface.
    pub interfaces: Vec<History>,
    /// Of all couplings.
    pub couplings: CouplingsMemory,
}

/// What an implicit step knows beside the state; empty in other steps.
#[derive(Debug, Clone, Default, crate::keep::Keep)]
pub struct Motion {
    /// Elastic forces `K u` `[N]`.
    pub internal: Vec<f64>,
    /// Displacements at the start of the step `[m]`.
    pub start: Vec<f64>,
    /// The farthest the bodies have been from there, in the norm of the mass `[m √kg]`.
    pub travel: f64,
}
