use super::gauss_seidel::GaussSeidel;
use super::newton::{Length, NewtonInForces, Step};
use super::problem::FrictionProblem;
use super::proximal::ProximalPoint;
use super::solver::FrictionSolver;
use crate::friction::map;

/// One solver that was tried.
#[derive(Debug, Clone, PartialEq)]
pub struct Tried {
    /// Its name, and where it started if that was not the guess.
    pub solver: String,
    /// Iterations or sweeps.
    pub iterations: usize,
    /// The error after it.
    pub error: f64,
}

/// Forces and motion of a friction problem.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// `r`, of shape `(n,)`.
    pub forces: Vec<f64>,
    /// `u = W r + q`, of shape `(n,)`.
    pub motion: Vec<f64>,
    /// The [error](super::friction_error) of the forces.
    pub error: f64,
    /// Whether it is within the tolerance.
    pub solved: bool,
    /// What was tried, in this order; the last one ended it. Empty where the first guess is the solution.
    pub tried: Vec<Tried>,
}

/// Iterations of Newton's method from a solution: they double its digits, and cost little next to what has found it. Other measures of the error weigh forces
/// and motions in another way, and hold as well.
const POLISH: usize = 2;

/// Where a member of the portfolio starts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Start {
    /// The guess, or no forces.
    Guess,
    /// Where the last sweeps have come to, good or bad: sweeps wander, and what comes after them profits from a place of its own.
    Swept,
    /// The smallest error so far.
    Best,
}

/// Solves a problem to an error: methods that fail on different problems, one after the other in a fixed order. `guess` is where to start, no forces if
/// `None`.
pub fn solve(problem: &FrictionProblem, guess: Option<&[f64]>, tolerance: f64) -> Solution {
    let guess = guess.map_or_else(|| vec![0.0; problem.size()], <[f64]>::to_vec);
    let mut swept = guess.clone();
    let mut best = guess.clone();
    let mut error = map::friction_error(problem, &best);
    let mut tried = Vec::new();
    for (solver, start) in members() {
        if error <= tolerance {
            break;
        }
        let from = match start {
            Start::Guess => &guess,
            Start::Swept => &swept,
            Start::Best => &best,
        };
        let found = solver.solve(problem, from, tolerance);
        tried.push(Tried {
            solver: called(solver.as_ref(), start),
            iterations: found.iterations,
            error: found.error,
        });
        if solver.wanders() {
            swept.clone_from(&found.forces);
        }
        if found.error < error {
            (best, error) = (found.forces, found.error);
        }
    }
    if error <= tolerance && error > 0.0 {
        let polish = NewtonInForces {
            most: POLISH,
            ..NewtonInForces::new(Step::Proximal, Length::Falling)
        };
        let found = polish.solve(problem, &best, 0.0);
        if found.error < error {
            (best, error) = (found.forces, found.error);
        }
    }
    Solution {
        motion: problem.motion(&best),
        forces: best,
        error,
        solved: error <= tolerance,
        tried,
    }
}

/// The solvers in their order, and where they start.
///
/// What is cheap and often enough comes first, what always gets somewhere last. Of 428 problems (18 of Siconos' test set, 410 random stacks of boxes, heaps of
/// balls and walls with friction up to 1.5) each member ends some that those before it do not, and the proximal point iteration
/// ends what is left. A block that is dragged between two others and held by nothing else was left even so: sweeps gain a little there each time, and get to the end.
fn members() -> Vec<(Box<dyn FrictionSolver>, Start)> {
    let newton = |step, length| Box::new(NewtonInForces::new(step, length));
    vec![
        (newton(Step::Proximal, Length::Falling), Start::Guess),
        (Box::new(GaussSeidel { sweeps: 100 }), Start::Guess),
        (newton(Step::Proximal, Length::Falling), Start::Swept),
        (newton(Step::LeastSquares, Length::Full), Start::Swept),
        (newton(Step::Proximal, Length::Full), Start::Guess),
        (Box::new(ProximalPoint), Start::Best),
        (Box::new(GaussSeidel { sweeps: 10_000 }), Start::Best),
    ]
}

/// A member of the portfolio by name: two may be the same solver with another start.
fn called(solver: &dyn FrictionSolver, start: Start) -> String {
    match start {
        Start::Guess => solver.name().into(),
        Start::Best => format!("{} from the best", solver.name()),
        Start::Swept => format!("{} after sweeps", solver.name()),
    }
}

#[cfg(test)]
mod tests {
    use super::{called, members};
    use std::collections::BTreeSet;

    /// Increments are counted by these names.
    #[test]
    fn no_two_members_have_one_name() {
        let all = members();
        let names: BTreeSet<String> = all
            .iter()
            .map(|(s, from)| called(s.as_ref(), *from))
            .collect();
        assert_eq!(names.len(), all.len(), "{names:?}");
    }
}
