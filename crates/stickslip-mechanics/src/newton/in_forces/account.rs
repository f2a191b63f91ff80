//! What has come of the friction problems of an increment: who solved them, and where they led to nothing.

use super::place::{At, Found};
use crate::friction::{FrictionProblem, Solution, Tried, natural_map};
use crate::math::vector;
use crate::number::digits;
use crate::system::{Culprit, Otherwise, StepFailure};

/// Error to which friction problems are solved. It is the default of `solver.tolerance`.
pub(super) const FRICTION_ERROR: f64 = 1e-8;

/// Most points that a failure names.
const NAMED_POINTS: usize = 5;

/// What stands for a solver where none was needed.
const FIRST_GUESS: &str = "first guess";

/// What has come of the friction problems of an increment.
#[derive(Default)]
pub(in crate::newton) struct Account {
    /// The last of them.
    pub last: Option<FrictionProblem>,
    /// How many there were, and points of the last.
    count: usize,
    points: usize,
    /// The solver that one of them took and that comes last in the portfolio: its place there, from 1, and its name.
    taken: (usize, String),
    /// Lengths of the steps to the first and the last solution.
    steps: Option<[f64; 2]>,
    end: End,
}

/// How the last of them ended; points with their parts, the largest first.
#[derive(Default)]
enum End {
    /// The forces are those of the problem before.
    #[default]
    Settled,
    /// It was solved, but the forces go on changing, by so much of the largest.
    Restless(Vec<(At, f64)>),
    /// It was not solved; parts of the error.
    Unsolved(Vec<Tried>, Vec<(At, f64)>),
}

impl Account {
    /// The solver without which one of the problems would not have been solved, and which comes last in the portfolio.
    pub fn solver(&self) -> String {
        match self.taken.0 {
            0 => FIRST_GUESS.into(),
            _ => self.taken.1.clone(),
        }
    }

    /// Takes note of a problem of these points and its solution.
    pub fn note(&mut self, problem: FrictionProblem, points: &[At], solution: &Solution) {
        if let Some(tried) = solution.tried.last()
            && solution.tried.len() > self.taken.0
        {
            self.taken = (solution.tried.len(), tried.solver.clone());
        }
        if !solution.solved {
            let map = natural_map(&problem, &problem.stiffness(), &solution.forces);
            let size = vector::norm(&problem.free).max(f64::MIN_POSITIVE);
            let parts = map.chunks(problem.dimension);
            let parts = points.iter().copied().zip(parts);
            let parts = parts.map(|(at, own)| (at, vector::norm(own) / size));
            self.end = End::Unsolved(solution.tried.clone(), largest(parts.collect()));
        }
        self.count += 1;
        self.points = points.len();
        self.last = Some(problem);
    }

    /// Takes note of a step to a solution.
    pub fn step(&mut self, length: f64) {
        let first = self.steps.map_or(length, |[first, _]| first);
        self.steps = Some([first, length]);
    }

    /// Takes note of the last two of a row of problems, which settled or not. One alone shows nothing.
    pub fn row(&mut self, settled: bool, before: &[Found], last: &[Found]) {
        if settled || before.is_empty() {
            self.end = End::Settled;
            return;
        }
        let size = last.iter().map(|(_, f)| vector::norm(f));
        let size = size.fold(f64::MIN_POSITIVE, f64::max);
        let changes = last.iter().map(|(at, f)| {
            let then = before.iter().find(|(other, _)| other == at);
            let then = then.map_or([0.0; 3], |(_, f)| *f);
            let change = [0, 1, 2].map(|q| f[q] - then[q]);
            (*at, vector::norm(&change) / size)
        });
        self.end = End::Restless(largest(changes.collect()));
    }

    /// What to say of them where the increment was not solved for some failure; `place` describes a point.
    pub fn otherwise(
        &self,
        failure: &StepFailure,
        place: impl Fn(At) -> Option<Culprit>,
    ) -> Otherwise {
        let named = |points: &[(At, f64)], what: &dyn Fn(f64) -> String| -> Vec<Culprit> {
            let named = points.iter().filter_map(|&(at, part)| {
                let found = place(at)?;
                let what = format!("{}, {}", what(part), found.what);
                Some(Culprit { what, ..found })
            });
            named.collect()
        };
        let points = self.points;
        let several = match self.count {
            1 => String::new(),
            n => format!(", the last of {n},"),
        };
        match &self.end {
            End::Unsolved(tried, parts) => {
                let each = tried.iter().map(|t| format!("{} {}", t.solver, digits(t.error, 2)));
                Otherwise {
                    message: format!(
                        "as a friction problem of {points} points{several} it is not solved either; errors where {} is wanted: {}",
                        digits(FRICTION_ERROR, 1),
                        each.collect::<Vec<_>>().join(", ")
                    ),
                    culprits: named(parts, &|part| format!("{} of the friction problem's error", digits(part, 2))),
                    help: "to report this: `run --dump-failures DIR` saves the contact problem of this increment, and `stickslip friction FILE` repeats it without the bodies".into(),
                }
            }
            End::Restless(changes) => {
                let change = changes.first().map_or(0.0, |c| c.1);
                // Bodies go on moving if the last step is more than half of the first.
                let moving = self.steps.filter(|[first, last]| *last > 0.5 * *first);
                let moves = moving.map_or(String::new(), |[first, last]| {
                    format!("; from one to the next the bodies still move, by {} after {} at first: there may be no equilibrium", digits(last, 2), digits(first, 2))
                });
                Otherwise {
                    message: format!(
                        "as {} friction problems one after the other, of {points} points and all solved, it does not settle: forces still change by {} of the largest{moves}",
                        self.count,
                        digits(change, 2)
                    ),
                    culprits: named(changes, &|change| {
                        format!("its force changes by {} of the largest between friction problems", digits(change, 2))
                    }),
                    help: match moving {
                        Some(_) => "lower what drives the bodies, raise friction or support the motion, if they can slide or roll off",
                        None => "a smoother law, or a finer mesh on both sides: at these points laws and gradients change from one friction problem to the next",
                    }
                    .into(),
                }
            }
            End::Settled => Otherwise {
                message: format!(
                    "the friction problem of {points} points{several} is solved, by {}, but Newton's method does not come to an end there: {}",
                    self.solver(),
                    failure.message
                ),
                culprits: failure.culprits.clone(),
                help: "use a smoother law, or a finer mesh on both sides: the curvature of laws and surfaces at these points prevents convergence".into(),
            },
        }
    }
}

/// The largest few.
fn largest(mut parts: Vec<(At, f64)>) -> Vec<(At, f64)> {
    parts.sort_by(|a, b| b.1.total_cmp(&a.1));
    parts.truncate(NAMED_POINTS);
    parts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::friction::{PointLaw, solve};
    use crate::system::Cause;

    fn place((force, point): At) -> Option<Culprit> {
        Some(Culprit {
            place: format!("interface {force}, node {point} at (0, 0, 0)"),
            what: "gap 0".into(),
            evidence: None,
        })
    }

    fn failure() -> StepFailure {
        StepFailure::new(Cause::NotConverged, "no equilibrium in 30 iterations")
    }

    #[test]
    fn where_no_solver_ends_it_each_is_named_with_its_error_and_the_worst_point_first() {
        // The second point is pushed in, and no force of its own moves it.
        let mut operator = vec![0.0; 16];
        (operator[0], operator[5]) = (1.0, 1.0);
        let problem = FrictionProblem {
            dimension: 2,
            operator,
            free: vec![-1.0, 0.1, -1.0, 0.0],
            laws: vec![PointLaw::coulomb(0.3); 2],
        };
        let solution = solve(&problem, None, FRICTION_ERROR);
        assert!(!solution.solved);
        let mut account = Account::default();
        account.note(problem, &[(0, 4), (2, 7)], &solution);
        let said = account.otherwise(&failure(), place);
        for tried in &solution.tried {
            let words = format!("{} {}", tried.solver, digits(tried.error, 2));
            assert!(said.message.contains(&words), "{}", said.message);
        }
        assert_eq!(said.culprits[0].place, "interface 2, node 7 at (0, 0, 0)");
        assert!(said.culprits[0].what.contains("error, gap 0"));
        assert!(said.help.contains("--dump-failures"));
    }

    #[test]
    fn forces_that_do_not_settle_are_named_and_bodies_that_go_on_moving_are_told() {
        let before: Vec<Found> = vec![((0, 1), [2.0, 0.0, 0.0]), ((0, 2), [1.0, 0.0, 0.0])];
        let last: Vec<Found> = vec![((0, 1), [2.0, 0.0, 0.0]), ((0, 2), [1.0, 0.5, 0.0])];
        let mut account = Account::default();
        account.row(false, &before, &last);
        account.step(1.0);
        account.step(0.1);
        let said = account.otherwise(&failure(), place);
        assert!(said.message.contains("change by 0.25"), "{}", said.message);
        assert!(!said.message.contains("no equilibrium"));
        assert!(said.culprits[0].place.contains("node 2"));
        account.step(0.9);
        let said = account.otherwise(&failure(), place);
        assert!(said.message.contains("there may be no equilibrium"));
        assert!(said.help.contains("support the motion"));
    }

    #[test]
    fn what_newtons_method_says_is_repeated_where_the_forces_have_settled() {
        let mut account = Account::default();
        account.row(true, &[], &[]);
        let said = account.otherwise(&failure(), place);
        assert!(said.message.contains("by first guess"));
        assert!(said.message.contains("no equilibrium in 30 iterations"));
    }
}
