use super::Dofs;

/// Which dofs are prescribed at an increment, and to what.
#[derive(Debug, Clone, PartialEq, crate::keep::Keep)]
pub struct Constraints {
    /// `true` where the displacement is prescribed, by dof.
    pub fixed: Vec<bool>,
    /// Prescribed displacement, by dof; meaningless where free.
    pub values: Vec<f64>,
}

impl Constraints {
    /// No constraints.
    pub fn none(dofs: Dofs) -> Self {
        Constraints {
            fixed: vec![false; dofs.count()],
            values: vec![0.0; dofs.count()],
        }
    }

    /// Prescribes one dof; a later call overrides an earlier one.
    pub fn prescribe(&mut self, dof: usize, value: f64) {
        self.fixed[dof] = true;
        self.values[dof] = value;
    }

    /// Writes the prescribed values into `u`.
    pub fn impose(&self, u: &mut [f64]) {
        for ((u, &fixed), &value) in u.iter_mut().zip(&self.fixed).zip(&self.values) {
            if fixed {
                *u = value;
            }
        }
    }
}
