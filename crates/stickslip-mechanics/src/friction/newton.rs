use faer::Mat;

use super::linear::{eliminate, least_squares};
use super::map::{project, residual, trial};
use super::problem::FrictionProblem;
use super::small::norm;
use super::solver::{Best, FrictionSolver, Iterate};

/// What Newton's method does where `W` is singular.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// The shortest of all steps that solve the linear problem best.
    LeastSquares,
    /// A compliance is added to every point that falls with the error: the first step of the proximal problem around the iterate
    /// ([Rockafellar](stickslip_base::references::rockafellar_1976)).
    Proximal,
}

/// How far a step of Newton's method goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Length {
    /// All the way, come what may: where the set of points in contact changes with every step, this finds new sets.
    Full,
    /// Halved until the residual falls.
    Falling,
}

/// Newton's method in the forces, for the natural map ([Alart and Curnier](stickslip_base::references::alart_curnier_1991)).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NewtonInForces {
    /// Where `W` is singular.
    pub step: Step,
    /// How far.
    pub length: Length,
    /// Most iterations.
    pub most: usize,
}

/// Most iterations unless somebody says otherwise. Where it succeeds it needs below 70 on all problems that were measured.
const MOST_NEWTON_ITERATIONS: usize = 100;

/// Iterations in which the error must fall to half of what it was, or the method gains nothing.
const NEWTON_PATIENCE: usize = 20;

/// Halvings of a step. More of them end where the norm has a minimum that is no zero.
const STEP_HALVINGS: usize = 6;

/// The largest compliance that a proximal step adds, relative to that of the point. It is the error where that is smaller: steps are then
/// fast in the end. Tuned: with 18 problems of the test set of Siconos and 410 random stacks.
const LARGEST_ADDED_COMPLIANCE: f64 = 1e-2;

impl NewtonInForces {
    /// With as many iterations as are worth it.
    pub fn new(step: Step, length: Length) -> Self {
        NewtonInForces {
            step,
            length,
            most: MOST_NEWTON_ITERATIONS,
        }
    }
}

/// The linear problem at an iterate.
struct Linearised<'a> {
    problem: &'a FrictionProblem,
    stiffness: &'a [f64],
    forces: &'a [f64],
    residual: &'a [f64],
    /// By point the derivative of the projection.
    derivatives: Vec<[f64; 9]>,
}

impl FrictionSolver for NewtonInForces {
    fn name(&self) -> &'static str {
        match (self.step, self.length) {
            (Step::LeastSquares, Length::Falling) => "newton",
            (Step::LeastSquares, Length::Full) => "newton, full steps",
            (Step::Proximal, Length::Falling) => "proximal newton",
            (Step::Proximal, Length::Full) => "proximal newton, full steps",
        }
    }

    fn solve(&self, problem: &FrictionProblem, start: &[f64], tolerance: f64) -> Iterate {
        let stiffness = problem.stiffness();
        let size = norm(&problem.free).max(f64::MIN_POSITIVE);
        let evaluate = |r: &[f64]| {
            let motion = problem.motion(r);
            let map = residual(problem, &stiffness, r, &motion);
            let error = norm(&map) / size;
            (motion, map, error)
        };
        let mut forces = start.to_vec();
        let (mut motion, mut map, mut error) = evaluate(&forces);
        let mut best = Best::new(&forces, error);
        let mut seen = vec![best.error()];
        let mut polished = false;
        for iteration in 0..self.most {
            // The last step doubles the digits, and costs no more than those before.
            if polished || error == 0.0 || !error.is_finite() {
                return best.after(iteration);
            }
            polished = error <= tolerance;
            let proximal = match self.step {
                Step::LeastSquares => 0.0,
                Step::Proximal => error.min(LARGEST_ADDED_COMPLIANCE),
            };
            let direction = Linearised::new(problem, &stiffness, &forces, &motion, &map)
                .direction(self.step, proximal);
            let mut part = 1.0;
            for halving in 0..=STEP_HALVINGS {
                let next: Vec<f64> = forces
                    .iter()
                    .zip(&direction)
                    .map(|(r, d)| r + part * d)
                    .collect();
                let found = evaluate(&next);
                let falls = found.2 < error;
                if falls || self.length == Length::Full || halving == STEP_HALVINGS {
                    forces = next;
                    (motion, map, error) = found;
                    break;
                }
                part *= 0.5;
            }
            best.see(&forces, error);
            seen.push(best.error());
            let before = seen.len().checked_sub(NEWTON_PATIENCE + 1);
            // The part to which the error must have fallen.
            if before.is_some_and(|before| best.error() > 0.5 * seen[before]) {
                return best.after(iteration + 1);
            }
        }
        best.after(self.most)
    }
}

impl<'a> Linearised<'a> {
    fn new(
        problem: &'a FrictionProblem,
        stiffness: &'a [f64],
        forces: &'a [f64],
        motion: &[f64],
        residual: &'a [f64],
    ) -> Self {
        let d = problem.dimension;
        let derivatives = problem.laws.iter().enumerate().map(|(k, law)| {
            let own = k * d..(k + 1) * d;
            let z = trial(&forces[own.clone()], &motion[own], stiffness[k]);
            project(d, law, &z).derivative
        });
        Linearised {
            problem,
            stiffness,
            forces,
            residual,
            derivatives: derivatives.collect(),
        }
    }

    /// Newton's step. Points whose forces shall vanish are eliminated; the others have the unknowns `dr / ρ`, which are motions:
    ///
    /// ```text
    /// ((I - A) + A W ρ + α A) (dr / ρ) = -F
    /// ```
    fn direction(&self, step: Step, proximal: f64) -> Vec<f64> {
        let d = self.problem.dimension;
        let n = self.problem.size();
        let holds = |k: &usize| self.derivatives[*k][..d * d].iter().any(|x| *x != 0.0);
        let active: Vec<usize> = (0..self.problem.points()).filter(holds).collect();
        let mut direction = vec![0.0; n];
        let mut vanishing: Vec<f64> = self.forces.iter().map(|r| -r).collect();
        for &k in &active {
            vanishing[k * d..(k + 1) * d].fill(0.0);
        }
        let known: Vec<f64> = active
            .iter()
            .flat_map(|&k| k * d..(k + 1) * d)
            .map(|i| {
                let row = &self.problem.operator[i * n..(i + 1) * n];
                row.iter().zip(&vanishing).map(|(w, r)| w * r).sum()
            })
            .collect();
        let mut right = vec![0.0; active.len() * d];
        let mut matrix = Mat::zeros(active.len() * d, active.len() * d);
        for (i, &k) in active.iter().enumerate() {
            let a = &self.derivatives[k];
            for row in 0..d {
                let at = i * d + row;
                right[at] = -self.residual[k * d + row];
                for c in 0..d {
                    right[at] -= a[row * d + c] * known[i * d + c];
                }
                self.fill_row(&mut matrix, &active, i, row, proximal);
            }
        }
        let scaled = match step {
            Step::LeastSquares => least_squares(&matrix, &right),
            Step::Proximal => eliminate(&matrix, &right),
        };
        direction.copy_from_slice(&vanishing);
        for (i, &k) in active.iter().enumerate() {
            for c in 0..d {
                direction[k * d + c] = scaled[i * d + c] * self.stiffness[k];
            }
        }
        direction
    }

    /// One row of the matrix: that of a component of an active point.
    fn fill_row(
        &self,
        matrix: &mut Mat<f64>,
        active: &[usize],
        i: usize,
        row: usize,
        proximal: f64,
    ) {
        let d = self.problem.dimension;
        let n = self.problem.size();
        let k = active[i];
        let a = &self.derivatives[k][row * d..(row + 1) * d];
        for (j, &other) in active.iter().enumerate() {
            for c in 0..d {
                let column = other * d + c;
                let product: f64 = a
                    .iter()
                    .enumerate()
                    .map(|(b, a)| a * self.problem.operator[(k * d + b) * n + column])
                    .sum();
                matrix[(i * d + row, j * d + c)] = product * self.stiffness[other];
            }
        }
        for c in 0..d {
            let unit = if c == row { 1.0 } else { 0.0 };
            matrix[(i * d + row, i * d + c)] += unit - a[c] + proximal * a[c];
        }
    }
}
