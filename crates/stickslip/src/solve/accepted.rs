//! Increments that are accepted: what an attempt hands over, and how it becomes the state.

use crate::model::ledger::Flow;
use crate::newton::Converged;
use crate::system::{Rate, Stage, State, Tally};
use crate::time::Trial;

/// What an increment took.
#[derive(Debug, Clone, Copy, Default, PartialEq, crate::keep::Keep)]
pub struct Effort {
    /// Newton iterations.
    pub iterations: usize,
    /// Multiplier updates.
    pub rounds: usize,
    /// Final residual relative to the scale of forces.
    pub residual: f64,
    /// Points by status.
    pub tally: Tally,
}

/// An increment that may be accepted.
#[derive(Default, Clone, crate::keep::Keep)]
pub(crate) struct Accepted {
    pub state: State,
    /// Out-of-balance forces: reactions at fixed dofs.
    pub forces: Vec<f64>,
    pub contact: Vec<f64>,
    pub external: Vec<f64>,
    pub flow: Flow,
    /// How velocities followed from displacements, gain and shift, in motion.
    pub rate: Option<(Vec<f64>, Vec<f64>)>,
    /// Energies of the bodies `[J]`; of condensed ones at rest when the interior is known.
    pub kinetic: f64,
    pub strain: f64,
    /// `K u`, in implicit steps.
    pub internal: Option<Vec<f64>>,
    /// The farthest the bodies have been from where an implicit step began, in the norm of the mass.
    pub travel: f64,
    pub effort: Effort,
    /// The solver of friction problems that it took; `None` of plain iteration and explicit increments.
    pub solver: Option<String>,
    /// Bodies were followed to where contact holds them.
    pub followed: bool,
    /// The increment must not grow.
    pub hard: bool,
}

impl Accepted {
    pub(crate) fn from_newton(converged: &Converged) -> Self {
        Accepted {
            effort: Effort {
                iterations: converged.iterations,
                rounds: converged.rounds,
                residual: converged.residual,
                tally: converged.tally,
            },
            solver: converged.solver.clone(),
            ..Accepted::default()
        }
    }
}

impl Accepted {
    /// The increment as interfaces see it when it is accepted.
    pub fn stage<'a>(&'a self, from: &'a State, trial: Trial) -> Stage<'a> {
        let rate = self.rate.as_ref();
        Stage {
            from,
            at: &self.state,
            dt: trial.to - trial.from,
            rate: rate.map(|(gain, shift)| Rate { gain, shift }),
            frames: None,
        }
    }
}
