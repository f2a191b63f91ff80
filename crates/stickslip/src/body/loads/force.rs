use crate::linear::BlockCsr;
use crate::system::{Energy, Force, Schedule, Stage, StepFailure};

/// A load: forces by dof, scaled in time.
#[derive(Debug, Clone, PartialEq)]
pub struct Load {
    /// Name for messages and histories.
    pub name: String,
    /// Forces by dof [N] at factor 1.
    pub entries: Vec<(usize, f64)>,
    /// The factor in time.
    pub schedule: Schedule,
}

impl Force for Load {
    fn name(&self) -> &str {
        &self.name
    }

    fn external(&self, t: f64, out: &mut [f64]) {
        let factor = self.schedule.at(t);
        if factor != 0.0 {
            for &(dof, force) in &self.entries {
                out[dof] += factor * force;
            }
        }
    }
}

/// Springs to ground by dof. They are part of the matrix, which is assembled once, and so act throughout.
#[derive(Debug, Clone, PartialEq)]
pub struct Spring {
    name: String,
    entries: Vec<(usize, f64)>,
    stored: f64,
}

impl Spring {
    /// From stiffnesses by dof [N/m].
    pub fn new(name: impl Into<String>, entries: Vec<(usize, f64)>) -> Self {
        Spring {
            name: name.into(),
            entries,
            stored: 0.0,
        }
    }

    /// Stiffnesses by dof [N/m].
    pub fn entries(&self) -> &[(usize, f64)] {
        &self.entries
    }

    /// Adds the internal force at the displacements `u` [m] to `out` [N], by dof.
    pub fn internal_force(&self, u: &[f64], out: &mut [f64]) {
        for &(dof, k) in &self.entries {
            out[dof] += k * u[dof];
        }
    }
}

impl Force for Spring {
    fn name(&self) -> &str {
        &self.name
    }

    // No couplings: the diagonal of the matrix is always there.

    fn stiffness(&self, matrix: &mut BlockCsr) -> Result<(), StepFailure> {
        for &(dof, k) in &self.entries {
            matrix.add_diagonal(dof, k);
        }
        Ok(())
    }

    fn commit(&mut self, stage: &Stage) {
        let u = &stage.at.u;
        self.stored = self
            .entries
            .iter()
            .map(|&(dof, k)| 0.5 * k * u[dof] * u[dof])
            .sum();
    }

    fn energy(&self) -> Energy {
        Energy {
            stored: self.stored,
            ..Energy::default()
        }
    }
}
