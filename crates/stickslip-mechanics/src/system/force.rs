use std::sync::Arc;

use super::body_frames::BodyFrames;
use super::{Assembler, StepFailure};
use crate::friction::PointLaw;

/// Displacement, velocity and acceleration of all dofs at a time.
#[derive(Debug, Clone, Default, PartialEq, crate::keep::Keep)]
pub struct State {
    /// Time.
    pub t: f64,
    /// Displacements, by dof.
    pub u: Vec<f64>,
    /// Velocities, by dof; empty in a quasi-static analysis.
    pub v: Vec<f64>,
    /// Accelerations, by dof; empty in a quasi-static analysis.
    pub a: Vec<f64>,
}

/// An evaluation: from the last accepted state to the state at which forces are wanted.
#[derive(Debug, Clone, Copy)]
pub struct Stage<'a> {
    /// Last accepted state.
    pub from: &'a State,
    /// State of evaluation.
    pub at: &'a State,
    /// `at.t - from.t`, positive.
    pub dt: f64,
    /// How the velocities at the end follow from the displacements; `None` where inertia plays no part.
    pub rate: Option<Rate<'a>>,
    /// The frames in which bodies that turn freely are seen; `None` where these are those of the model.
    pub frames: Option<&'a Arc<BodyFrames>>,
}

/// The velocity at the end of an increment as the integrator has it: `dt v = gain (u - u_from) + shift`, dof by dof.
///
/// Friction depends on velocity. In statics the mean velocity of the increment is all there is; in dynamics friction that looked at
/// the mean would fall behind by half a step, and a mass that sticks would swing about the velocity it sticks at.
#[derive(Debug, Clone, Copy)]
pub struct Rate<'a> {
    /// By dof `[-]`.
    pub gain: &'a [f64],
    /// By dof `[m]`.
    pub shift: &'a [f64],
}

/// The outcome of a multiplier update between two equilibrium solves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Augmentation {
    /// Nothing changed: the constraint holds to the stated error.
    Done,
    /// Multipliers changed; solve again. The worst error relative to its limit is given.
    Again(f64),
}

/// Energies of one force `[energy]`; `dissipated` and `work` are totals since the start of the analysis.
#[derive(Debug, Clone, Copy, Default, PartialEq, crate::keep::Keep)]
pub struct Energy {
    /// Recoverable energy stored now.
    pub stored: f64,
    /// Energy dissipated since the start, never falling.
    pub dissipated: f64,
    /// Work done by this force on the bodies since the start, for loads and moving obstacles or belts.
    pub work: f64,
    /// Dissipated by damping in normal direction since the start, never falling.
    pub damped: f64,
    /// Quasi-static increments since the start: work on the bodies by the trapezoidal rule less that along the path of pressure and shear, in
    /// which points open, close, and begin to slide within an increment. What drives them has done as much more than that rule says.
    pub path: f64,
    /// By how much the dissipated energy may be off at most, as it is not known when within an increment points began to slide.
    pub uncertain: f64,
    /// In motion: dissipated beyond the trapezoidal rule, where slip turned round within an increment and that rule would have friction give energy
    /// back. What the scheme enters as its own takes the rule for granted.
    pub excess: f64,
}

/// A force that is evaluated in every iteration: interfaces, couplings, anchors of floating bodies. Bodies, springs and loads are linear; they make up the
/// matrix and the right-hand side, and need no trait.
///
/// The equilibrium equation is `Σ residual = 0` with the residual counted as *internal minus external* force.
/// A force is evaluated from **committed** history only, to which it has a shared reference.
pub trait Force: Send {
    /// Search and pairing at a state of iteration.
    fn prepare(&mut self, _stage: &Stage) {}

    /// Starts an attempt: trial history := committed.
    fn begin(&mut self) {}

    /// Residual and tangent, from committed history.
    fn assemble(&mut self, stage: &Stage, out: &mut Assembler) -> Result<(), StepFailure>;

    /// Adds to the tangent of the last evaluation what there is of it beside the gradients of gaps and slips: how these change themselves.
    fn curve(&self, _out: &mut Assembler) {}

    /// Adds to the tangent of the last evaluation what holds a step back where forces `b` by dof `[N]`, out of balance, would lead farther than what the tangent knows.
    fn damp_step(&self, _b: &[f64], _out: &mut Assembler) {}

    /// The state of the last evaluation, a [tentative](Assembler::tentative) one with tangent, is the next iterate: as if it had been evaluated
    /// for good.
    fn settle(&mut self) {}

    /// Tells a force with unknowns of its own (multipliers) the Newton increment `step · du` that was accepted.
    fn update_internal(&mut self, _du: &[f64], _step: f64) {}

    /// Multiplier update between equilibrium solves.
    fn augment(&mut self, _stage: &Stage) -> Augmentation {
        Augmentation::Done
    }

    /// Rounds of updates that may be needed beyond those of multipliers.
    fn patience(&self) -> usize {
        0
    }

    /// By point what it would carry if it was pressed and stuck; `None` for a point that cannot carry anything, and for a force that has no such points.
    fn alone(&mut self, _stage: &Stage) -> Option<Vec<Option<StickTrial>>> {
        None
    }

    /// Takes forces by point, normal and two of shear, for those at the state of the last evaluation.
    fn adopt(&mut self, _forces: &[Option<[f64; 3]>]) {}

    /// How many points changed status between the last two assemblies, and a short tally for the log.
    fn tally(&self) -> Option<Tally> {
        None
    }

    /// Which points are difficult, and what they did.
    fn diagnose(&self) -> Vec<super::Culprit> {
        Vec::new()
    }

    /// One of its points as a place to look at, and what it does.
    fn place(&self, _point: usize) -> Option<super::Culprit> {
        None
    }

    /// The points that change status, of a force that has such.
    fn active_set(&mut self) -> Option<&mut dyn ActiveSet> {
        None
    }
}

/// A point of contact as a friction problem knows it: normal, and two directions of shear.
#[derive(Debug, Clone, PartialEq)]
pub struct StickTrial {
    /// Dofs on which its forces act.
    pub dofs: Vec<usize>,
    /// Gradients of the gap and of the two components of slip, row by row, shape `(3, n)`.
    pub rows: Vec<f64>,
    /// Area it stands for `[m²]`.
    pub area: f64,
    /// Stiffness of the body beneath `[N/m]`.
    pub body: f64,
    /// By how much its forces fall with gap and slip while it is pressed and sticks `[N/m]`.
    pub stiffness: [f64; 3],
    /// The forces that it would then have at the state of evaluation `[N]`.
    pub forces: [f64; 3],
    /// Whether there is friction at all.
    pub rubs: bool,
    /// The limit of its shear.
    pub law: PointLaw,
}

/// Points that change status from iteration to iteration.
pub trait ActiveSet {
    /// The points that have changed status or the direction of slip several times in this attempt.
    fn chattering(&self) -> Vec<usize>;

    /// At an equilibrium: points that were lost on the way get another chance, once. Returns how many there were.
    fn put_back(&mut self) -> usize;

    /// Whether a tentative evaluation has points beyond an outer edge that the iterate before it has not, or the other way round. Each point has a few such
    /// passages in an attempt, then it stays where it is.
    fn passes_edges(&self) -> bool;
}

/// Counts of contact points by status.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize, crate::keep::Keep)]
pub struct Tally {
    /// Not in contact.
    pub open: usize,
    /// In contact without slip.
    pub stick: usize,
    /// In contact and sliding.
    pub slip: usize,
    /// Points whose status differs from the evaluation before.
    pub changed: usize,
}

impl std::iter::Sum for Tally {
    fn sum<I: Iterator<Item = Tally>>(all: I) -> Tally {
        all.fold(Tally::default(), |a, b| Tally {
            open: a.open + b.open,
            stick: a.stick + b.stick,
            slip: a.slip + b.slip,
            changed: a.changed + b.changed,
        })
    }
}
