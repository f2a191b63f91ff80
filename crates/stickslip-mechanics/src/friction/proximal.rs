use super::gauss_seidel::GaussSeidel;
use super::newton::{Length, NewtonInForces, Step};
use super::problem::FrictionProblem;
use super::solver::{Best, FrictionSolver, Iterate};
use crate::friction::map;

/// Proximal point iteration: every point is given an artificial compliance around the forces it has, which makes the problem regular, and each solution is
/// the centre of the next ([Rockafellar](stickslip_base::references::rockafellar_1976); for friction
/// [Acary, Brémond and Huber](stickslip_base::references::acary_2018), 4.5).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ProximalPoint;

/// Most problems.
const MOST_PROBLEMS: usize = 200;

/// Sweeps where Newton's method fails on a problem.
const SWEEPS: usize = 100;

impl FrictionSolver for ProximalPoint {
    fn name(&self) -> &'static str {
        "proximal point"
    }

    fn solve(&self, problem: &FrictionProblem, start: &[f64], tolerance: f64) -> Iterate {
        let stiffness = problem.stiffness();
        let (d, n) = (problem.dimension, problem.size());
        let inner = NewtonInForces::new(Step::Proximal, Length::Falling);
        let mut forces = start.to_vec();
        let mut best = Best::new(&forces, map::friction_error(problem, &forces));
        // The artificial compliance, relative to that of the point.
        let mut added = 1.0;
        let mut iterations = 0;
        let mut near = problem.clone();
        for _ in 0..MOST_PROBLEMS {
            if best.error() <= tolerance || added > 100.0 {
                break;
            }
            for i in 0..n {
                let own = added / stiffness[i / d];
                near.operator[i * (n + 1)] = problem.operator[i * (n + 1)] + own;
                near.free[i] = problem.free[i] - own * forces[i];
            }
            // Each problem is solved to a tenth of the error.
            let wanted = 0.1 * best.error().min(1.0);
            let mut found = inner.solve(&near, &forces, wanted);
            iterations += found.iterations;
            if found.error > wanted {
                // with enough compliance of its own every point is nearly alone
                let sweeps = GaussSeidel { sweeps: SWEEPS };
                found = sweeps.solve(&near, &forces, wanted);
                iterations += found.iterations;
            }
            if found.error <= wanted {
                forces = found.forces;
                best.see(&forces, map::friction_error(problem, &forces));
                // The next problem is nearer to the given one after one that was solved, and farther from it after one that was not.
                added = (added * 0.3).max(1e-8);
            } else {
                added *= 5.0;
            }
        }
        best.after(iterations)
    }
}
