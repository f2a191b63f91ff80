//! Newton's method with a bulk of two springs and a force that is no contact of the library: what it asks of forces, and what becomes of their answers.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::{Linearised, Newton, Settings, SparseBulk, System};
use crate::linear::BlockCsr;
use crate::system::{
    Assembler, Augmentation, Cause, Constraints, Dofs, Force, Links, Stage, State, StepFailure,
    Tangent,
};

/// Stiffness of the springs `[N/m]`.
const SPRING: f64 = 100.0;
/// Where the wall stands `[m]`.
const GAP: f64 = 0.02;

/// A wall behind the first point, along its first dof: `λ + penalty (u - gap)` where that is positive.
struct Wall {
    penalty: f64,
    /// Multiplier, and the gap error to which it is updated; none where it stays zero.
    multiplier: f64,
    error: Option<f64>,
    updates: usize,
    begun: usize,
    fails: Option<Cause>,
}

impl Wall {
    fn new(penalty: f64) -> Self {
        Wall {
            penalty,
            multiplier: 0.0,
            error: None,
            updates: 0,
            begun: 0,
            fails: None,
        }
    }

    fn pressure(&self, u: f64) -> f64 {
        (self.multiplier + self.penalty * (u - GAP)).max(0.0)
    }
}

impl Force for Wall {
    fn begin(&mut self) {
        self.begun += 1;
    }

    fn assemble(&mut self, stage: &Stage, out: &mut Assembler) -> Result<(), StepFailure> {
        if let Some(cause) = self.fails.clone() {
            return Err(StepFailure::new(cause, "the wall gave way"));
        }
        let pressure = self.pressure(stage.at.u[0]);
        out.residual[0] += pressure;
        let dofs = [0, 1];
        out.add_coupling(&dofs);
        if out.wants_tangent && pressure > 0.0 {
            let tangent = Tangent {
                rows: &[1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
                change: &[self.penalty, 0.0, 0.0, 0.0, 0.0, 0.0],
                area: 1.0,
                hessian: &[],
                surrogate: &[self.penalty, 0.0, 0.0, 0.0],
            };
            out.add_tangent(&dofs, tangent);
        }
        Ok(())
    }

    fn augment(&mut self, stage: &Stage) -> Augmentation {
        let through = stage.at.u[0] - GAP;
        match self.error {
            Some(error) if through > error => {
                self.multiplier = self.pressure(stage.at.u[0]);
                self.updates += 1;
                Augmentation::Again(through / error)
            }
            _ => Augmentation::Done,
        }
    }
}

/// Two springs to ground in the plane, of which a force pulls the first.
struct Springs {
    matrix: BlockCsr,
    diagonal: Vec<f64>,
    pull: f64,
}

const DOFS: Dofs = Dofs { dim: 2, points: 2 };

impl Springs {
    fn new(pull: f64) -> Self {
        let mut matrix = BlockCsr::from_couplings(2, 2, &mut |visit| {
            visit(&[0]);
            visit(&[1]);
        });
        let own = [SPRING, 0.0, 0.0, SPRING];
        (0..2).for_each(|p| matrix.add_group(&[p], &own));
        Springs {
            diagonal: matrix.diagonal(),
            matrix,
            pull,
        }
    }

    /// Solves with a wall; displacements and what Newton's method says.
    fn solve(
        &self,
        newton: &mut Newton,
        wall: &mut Wall,
    ) -> (Vec<f64>, Result<super::Converged, StepFailure>) {
        let external = vec![self.pull, 0.0, 0.0, 0.0];
        let mut factor = Linearised::default();
        let fixed = vec![false; 4];
        let (matrix, diagonal) = (&self.matrix, &self.diagonal);
        let mut bulk = SparseBulk::new(matrix, diagonal, external, fixed, None, &mut factor);
        let links = Links::new(DOFS, Vec::new());
        let mut system = System {
            dofs: DOFS,
            bulk: &mut bulk,
            contact: vec![wall],
            rate: None,
            frames: None,
            constraints: Constraints::none(DOFS),
            links: &links,
            stoppable: true,
        };
        let from = State {
            u: vec![0.0; 4],
            ..State::default()
        };
        let mut at = State {
            t: 1.0,
            ..from.clone()
        };
        let outcome = newton.solve(&mut system, &from, &mut at, &mut |_| ());
        (at.u, outcome)
    }
}

#[test]
fn a_wall_is_met_or_not() {
    let wall = &mut Wall::new(3.0 * SPRING);
    let mut newton = Newton::new(Settings::default());
    let (u, outcome) = Springs::new(0.5 * SPRING * GAP).solve(&mut newton, wall);
    assert!((u[0] - 0.5 * GAP).abs() < 1e-14 && outcome.is_ok(), "{u:?}");
    // Springs in parallel behind the gap.
    let pull = 2.0 * SPRING * GAP;
    let (u, outcome) = Springs::new(pull).solve(&mut newton, wall);
    let expected = (pull + wall.penalty * GAP) / (SPRING + wall.penalty);
    assert!((u[0] - expected).abs() < 1e-12, "{u:?} {expected}");
    assert_eq!(&u[1..], [0.0; 3]);
    let converged = outcome.expect("an equilibrium");
    assert!((converged.contact[0] - wall.pressure(u[0])).abs() < 1e-12);
    // The guess, a step that goes through the wall, and one back from there.
    assert!(converged.iterations <= 3, "{}", converged.iterations);
    assert_eq!((converged.rounds, wall.begun), (0, 2));
}

#[test]
fn multipliers_are_updated_until_the_force_is_content() {
    let wall = &mut Wall::new(SPRING);
    wall.error = Some(1e-6 * GAP);
    let pull = 3.0 * SPRING * GAP;
    let mut newton = Newton::new(Settings::default());
    let (u, outcome) = Springs::new(pull).solve(&mut newton, wall);
    let converged = outcome.expect("an equilibrium");
    assert!((u[0] - GAP).abs() <= 1e-6 * GAP, "{}", u[0]);
    assert!((converged.contact[0] - 2.0 * SPRING * GAP).abs() < 1e-5 * SPRING * GAP);
    // Uzawa's method divides the error by 1 + penalty/stiffness each time, and GAP / 2²⁰ < 1e-6 GAP.
    assert_eq!((converged.rounds, wall.updates), (20, 20));
}

#[test]
fn updates_that_do_not_settle_end_with_the_error_that_is_left() {
    let wall = &mut Wall::new(0.1 * SPRING);
    wall.error = Some(1e-9 * GAP);
    let mut newton = Newton::new(Settings::default());
    let (_, outcome) = Springs::new(3.0 * SPRING * GAP).solve(&mut newton, wall);
    let failure = outcome.expect_err("no end");
    assert_eq!(failure.cause, Cause::NotConverged);
    assert!(
        failure.message.contains("did not settle"),
        "{}",
        failure.message
    );
    assert!(failure.help.is_some());
}

#[test]
fn a_force_that_fails_ends_the_solution_with_its_cause() {
    let wall = &mut Wall::new(SPRING);
    wall.fails = Some(Cause::Reach);
    let mut newton = Newton::new(Settings::default());
    let (_, outcome) = Springs::new(SPRING).solve(&mut newton, wall);
    let failure = outcome.expect_err("the wall fails");
    assert_eq!(failure.cause, Cause::Reach);
    assert_eq!(failure.message, "the wall gave way");
    assert!(newton.fallbacks.is_empty(), "nothing else is tried");
}

#[test]
fn an_interrupt_is_asked_in_every_iteration() {
    let asked = Arc::new(AtomicUsize::new(0));
    let count = Arc::clone(&asked);
    let mut newton = Newton::new(Settings::default());
    newton.interrupt = Some(Arc::new(move || count.fetch_add(1, Ordering::Relaxed) == 1));
    let wall = &mut Wall::new(3.0 * SPRING);
    let (_, outcome) = Springs::new(2.0 * SPRING * GAP).solve(&mut newton, wall);
    assert_eq!(outcome.expect_err("stopped").cause, Cause::Interrupted);
    assert_eq!(asked.load(Ordering::Relaxed), 2);
}
