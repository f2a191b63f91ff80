use super::map::trial;
use super::point::{local, projected};
use super::problem::FrictionProblem;
use super::solver::{Best, FrictionSolver, Iterate};
use crate::friction::map;

/// Nonsmooth Gauss-Seidel: point by point, each solved alone under the forces of all others, in the order in which they stand
/// ([Jean and Moreau](stickslip_base::references::jean_moreau_1992), [Jourdan, Alart and Jean](stickslip_base::references::jourdan_1998)).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct GaussSeidel {
    /// Most sweeps.
    pub sweeps: usize,
}

/// Sweeps between two looks at the error, which costs as much as a sweep.
const SWEEPS_A_LOOK: usize = 10;

/// Looks after which the error must have fallen to 0.9 of what it was, or the sweeps gain nothing; where there are more sweeps, a tenth of
/// them.
const LOOK_PATIENCE: usize = 10;

impl FrictionSolver for GaussSeidel {
    fn name(&self) -> &'static str {
        "gauss-seidel"
    }

    fn wanders(&self) -> bool {
        true
    }

    fn solve(&self, problem: &FrictionProblem, start: &[f64], tolerance: f64) -> Iterate {
        let stiffness = problem.stiffness();
        let own: Vec<[f64; 9]> = (0..problem.points()).map(|k| problem.own(k)).collect();
        let mut forces = start.to_vec();
        let mut best = Best::new(&forces, map::friction_error(problem, &forces));
        let patience = LOOK_PATIENCE.max(self.sweeps / (10 * SWEEPS_A_LOOK));
        let mut seen = vec![best.error()];
        for sweep in 1..=self.sweeps {
            for (k, block) in own.iter().enumerate() {
                visit(problem, k, block, stiffness[k], &mut forces);
            }
            if sweep % SWEEPS_A_LOOK != 0 && sweep != self.sweeps {
                continue;
            }
            best.see(&forces, map::friction_error(problem, &forces));
            seen.push(best.error());
            let gains = match seen.len().checked_sub(patience + 1) {
                // The part to which the error must have fallen.
                Some(before) => best.error() <= 0.9 * seen[before],
                None => true,
            };
            if best.error() <= tolerance || !gains {
                return best.after(sweep);
            }
        }
        best.after(self.sweeps)
    }
}

/// Solves one point.
fn visit(problem: &FrictionProblem, k: usize, own: &[f64; 9], rho: f64, forces: &mut [f64]) {
    let d = problem.dimension;
    let mut now = [0.0; 3];
    now[..d].copy_from_slice(&forces[k * d..(k + 1) * d]);
    let mut motion = [0.0; 3];
    let mut free = [0.0; 3];
    for a in 0..d {
        motion[a] = problem.motion_at(k * d + a, forces);
        let mine: f64 = (0..d).map(|b| own[a * d + b] * now[b]).sum();
        free[a] = motion[a] - mine;
    }
    let law = &problem.laws[k];
    let next = local(d, law, own, &free)
        .filter(|r| r.iter().all(|r| r.is_finite()))
        .unwrap_or_else(|| projected(d, law, &trial(&now[..d], &motion[..d], rho)));
    forces[k * d..(k + 1) * d].copy_from_slice(&next[..d]);
}
