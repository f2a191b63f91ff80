//! What couplings know of accepted increments.

/// What couplings knew after an accepted increment.
#[derive(Debug, Clone, Default, PartialEq, crate::keep::Keep)]
pub struct CouplingsMemory {
    /// Multipliers of equations, by row `[N]`.
    pub(super) multipliers: Vec<f64>,
    /// Forces along the rows, those of springs as well `[N]`.
    pub(super) forces: Vec<f64>,
    /// What the sums of equations were when these began to act, by row `[m]`; of rows along the normal of a pretension their sum or their part of the
    /// force when the step began `[m, N]`.
    pub(super) start: Vec<f64>,
    /// What the sums of equations had to be, the stiffness of springs and the coefficient of dashpots, by row.
    pub(super) targets: Vec<f64>,
    /// By how much the sums of equations were off when springs took their place in an explicit step, by row; empty before one.
    pub(super) rest: Vec<f64>,
    /// Energy in springs `[J]`.
    pub(super) stored: f64,
    /// Work over the increment of equations whose value changes, and of springs whose stiffness does `[J]`.
    pub(super) work: f64,
    /// What dashpots took over the increment `[J]`.
    pub(super) damped: f64,
}

impl CouplingsMemory {
    /// The force that a row had at the last accepted state, so that its equation goes on holding `[N]`.
    pub fn exact_force(&self, i: usize) -> f64 {
        self.multipliers[i]
    }

    /// By how much a row was off when explicit increments began `[m]`.
    pub(super) fn rest(&self, i: usize) -> f64 {
        self.rest.get(i).copied().unwrap_or(0.0)
    }
}
