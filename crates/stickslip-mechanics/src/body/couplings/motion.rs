//! The forces of equations at the start of motion.

use super::Couplings;
use super::all::{Act, moved_by};
use crate::linear::{GmresSettings, gmres};
use crate::system::{Links, StepFailure};

/// Relative residual to which the accelerations of equations are made to vanish.
const EXACT: f64 = 1e-12;

/// Accelerations under forces, both by dof.
type Accelerate<'a> = &'a mut dyn FnMut(&[f64]) -> Result<Vec<f64>, StepFailure>;

impl Couplings {
    /// Finds the multipliers with which accelerations `a` satisfy the equations that act at `t`, and adds their forces to the internal ones in `out` and what
    /// they do to `a`. Without that the trapezoidal rule would swing about them for ever.
    ///
    /// `accelerate` gives the accelerations that forces make, by dof. Rows with dofs that have no mass are left as they are.
    ///
    /// # Errors
    /// Those of `accelerate`.
    pub fn start_motion(
        &mut self,
        (t, links): (f64, &Links),
        massless: &[bool],
        accelerate: Accelerate<'_>,
        (a, out): (&mut [f64], &mut [f64]),
    ) -> Result<(), StepFailure> {
        let mut rows: Vec<(usize, Vec<(usize, f64)>)> = Vec::new();
        for (i, coupling, row) in self.rows() {
            if matches!(self.act(i, coupling, t), Act::Held(_)) {
                let terms = moved_by(row, links);
                if terms.iter().all(|(dof, _)| !massless[*dof]) {
                    rows.push((i, terms));
                }
            }
        }
        let sums = |x: &[f64]| -> Vec<f64> {
            let sum = |terms: &[(usize, f64)]| terms.iter().map(|(d, f)| f * x[*d]).sum();
            rows.iter().map(|(_, terms)| sum(terms)).collect()
        };
        let spread = |multipliers: &[f64]| -> Vec<f64> {
            let mut force = vec![0.0; massless.len()];
            for ((_, terms), m) in rows.iter().zip(multipliers) {
                terms.iter().for_each(|(d, f)| force[*d] += f * m);
            }
            force
        };
        let off = sums(a);
        if off.iter().all(|x| *x == 0.0) {
            return Ok(());
        }
        let mut failure = None;
        let mut multipliers = vec![0.0; rows.len()];
        gmres(
            &mut |m, result| match accelerate(&spread(m)) {
                Ok(a) => result.copy_from_slice(&sums(&a)),
                Err(e) => {
                    failure = Some(e);
                    result.fill(0.0);
                }
            },
            &mut |_| {},
            &off,
            &mut multipliers,
            GmresSettings {
                tolerance: EXACT,
                max_iterations: rows.len().clamp(10, 400),
                restart: 60,
            },
        );
        if let Some(failure) = failure {
            return Err(failure);
        }
        let force = spread(&multipliers);
        for (a, change) in a.iter_mut().zip(accelerate(&force)?) {
            *a -= change;
        }
        for (out, f) in out.iter_mut().zip(&force) {
            *out += f;
        }
        for ((i, _), m) in rows.iter().zip(&multipliers) {
            self.memory.multipliers[*i] += m;
            self.memory.forces[*i] = self.memory.multipliers[*i];
        }
        Ok(())
    }
}
