use super::newton::{Length, NewtonInForces, Step};
use super::problem::{FrictionProblem, PointLaw};
use super::solver::{Best, FrictionSolver, Iterate};

/// Tresca problems one after the other: the limits are those that the contact forces of the last solution allow. Each is the minimum of a convex function
/// ([Haslinger](stickslip_base::references::haslinger_1983)), and the limits are damped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LaggedTresca;

/// Part of the error to which a problem is solved.
const INNER: f64 = 0.1;

/// Most Tresca problems.
const MOST_LIMITS: usize = 40;

impl FrictionSolver for LaggedTresca {
    fn name(&self) -> &'static str {
        "lagged tresca"
    }

    fn solve(&self, problem: &FrictionProblem, start: &[f64], tolerance: f64) -> Iterate {
        let d = problem.dimension;
        let newton = NewtonInForces::new(Step::Proximal, Length::Falling);
        let mut best = Best::new(start, problem.error(start));
        let mut given = problem.clone();
        let mut forces = start.to_vec();
        let mut limits: Vec<f64> = (problem.laws.iter().enumerate())
            .map(|(k, law)| law.limit(forces[k * d].max(0.0)).0)
            .collect();
        let mut iterations = 0;
        for _ in 0..MOST_LIMITS {
            if best.error() <= tolerance {
                break;
            }
            for (law, &limit) in given.laws.iter_mut().zip(&limits) {
                *law = PointLaw::tresca(limit);
            }
            let wanted = (INNER * best.error()).min(INNER);
            let found = newton.solve(&given, &forces, wanted);
            iterations += found.iterations;
            forces = found.forces;
            best.see(&forces, problem.error(&forces));
            for (k, limit) in limits.iter_mut().enumerate() {
                // half of the way: where the limits answer each other, the whole of it goes to and fro
                let next = problem.laws[k].limit(forces[k * d].max(0.0)).0;
                *limit = 0.5 * (*limit + next);
            }
        }
        best.after(iterations)
    }
}
