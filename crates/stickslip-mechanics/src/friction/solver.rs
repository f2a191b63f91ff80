use super::problem::FrictionProblem;

/// Where a solver has come to.
#[derive(Debug, Clone, PartialEq)]
pub struct Iterate {
    /// The best forces it has seen.
    pub forces: Vec<f64>,
    /// Their [error](super::friction_error).
    pub error: f64,
    /// Iterations or sweeps it took.
    pub iterations: usize,
}

/// A method for friction problems. It may fail, but it always ends.
pub trait FrictionSolver {
    /// The name in the log.
    fn name(&self) -> &'static str;

    /// Whether it moves on without an eye on the error, so that its last forces are a new place to start from.
    fn wanders(&self) -> bool {
        false
    }

    /// Starts from forces and goes on until the error is below a tolerance, or it knows no better.
    fn solve(&self, problem: &FrictionProblem, start: &[f64], tolerance: f64) -> Iterate;
}

/// The best of the iterates seen.
#[derive(Debug)]
pub(super) struct Best {
    forces: Vec<f64>,
    error: f64,
}

impl Best {
    pub fn new(forces: &[f64], error: f64) -> Self {
        let error = if error.is_nan() { f64::INFINITY } else { error };
        Best {
            forces: forces.to_vec(),
            error,
        }
    }

    /// Takes forces with a smaller error.
    pub fn see(&mut self, forces: &[f64], error: f64) {
        if error < self.error {
            self.forces.copy_from_slice(forces);
            self.error = error;
        }
    }

    pub fn error(&self) -> f64 {
        self.error
    }

    pub fn after(self, iterations: usize) -> Iterate {
        Iterate {
            forces: self.forces,
            error: self.error,
            iterations,
        }
    }
}
