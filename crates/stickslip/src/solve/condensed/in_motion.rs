//! Increments in motion on the contact candidates.

use std::time::Instant;

use crate::math::vector::dot;
use crate::model::contact::Contact;
use crate::model::definition::Model;
use crate::model::frame::Frame;
use crate::newton::condensed::{CondensedBulk, ReducedSystem};
use crate::newton::{Converged, describe};
use crate::solve::checks::Recovered;
use crate::solve::condensed::condensing;
use crate::solve::condenser::{Moving, Which};
use crate::solve::inertia::in_motion;
use crate::solve::iteration::{Iteration, Load, Task};
use crate::solve::solver::Solver;
use crate::system::{State, StepFailure};

/// Most step lengths whose condensed bodies are kept.
const MOST_CONDENSED: usize = 4;

/// Makes the bodies with the matrix of increments that was made ready last known without their interiors; `false` where the increment is solved with
/// the sparse matrix.
pub fn condense_in_motion(
    solver: &mut Solver,
    model: &Model,
    frame: &Frame,
    contact: &Contact,
    held: &[bool],
) -> bool {
    let (_, _, key) = in_motion(&solver.inertia).matrix();
    let mut known = solver.condenser.moving.iter();
    let last = match known.position(|m| m.key == key && m.condensation.held == held) {
        Some(i) => solver.condenser.moving.remove(i),
        None => {
            if !solver.method.condenses() {
                return false;
            }
            let made =
                condensing::condense_bodies(solver, model, frame, contact, held, Which::Increment);
            let Some(condensation) = made else {
                return false;
            };
            Moving {
                key,
                kept: solver.condenser.kept.clone().unwrap_or_default(),
                condensation,
                reduced: ReducedSystem::default(),
            }
        }
    };
    let moving = &mut solver.condenser.moving;
    // Those of a matrix that is gone cannot be asked for again.
    let inertia = in_motion(&solver.inertia);
    moving.retain(|m| inertia.matrix_of(m.key).is_some());
    if moving.len() == MOST_CONDENSED {
        moving.remove(0);
    }
    moving.push(last);
    true
}

/// Solves an increment in motion on the contact candidates of the bodies condensed last, and finds the interior. The forces that come out are those of the
/// candidates.
pub fn solve_condensed(
    solver: &mut Solver,
    model: &Model,
    contact: &mut Contact,
    task: Task,
    at: &mut State,
) -> Result<Converged, StepFailure> {
    let Load::Known(origin) = &task.load else {
        unreachable!("the forces of an increment in motion are known at the guess");
    };
    let (_, diagonal, _) = in_motion(&solver.inertia).matrix();
    let Moving {
        condensation,
        reduced,
        ..
    } = (solver.condenser.moving.last_mut()).expect("the matrix of this length was condensed");
    let newton = &mut solver.newton;
    let started = Instant::now();
    let opposite: Vec<f64> = origin.forces.iter().map(|f| -f).collect();
    let (load, interior) = condensation.sweep(&opposite).map_err(describe)?;
    newton.statistics.seconds.solve += started.elapsed().as_secs_f64();
    let base = condensation.gather(&origin.at);
    let still = vec![0.0; base.len()];
    let mut bulk = CondensedBulk::new(
        condensation,
        reduced,
        diagonal,
        load,
        base.clone(),
        still,
        origin.scale,
    );
    let fixed = task.constraints.fixed.clone();
    let mut forces = contact.forces(task.contacts, &solver.conditions);
    let converged = Iteration {
        newton,
        seen: &mut solver.seen,
        model,
        forces: forces.all(),
        bulk: &mut bulk,
        rate: task.rate,
        frames: task.frames,
        stoppable: task.stoppable,
    }
    .solve(task.constraints, task.from, at)?;
    let started = Instant::now();
    let mut moved = condensation.gather(&at.u);
    moved.iter_mut().zip(&base).for_each(|(m, b)| *m -= b);
    let mut all = vec![0.0; origin.at.len()];
    condensation
        .recover(vec![interior], &[moved], &mut [&mut all])
        .map_err(describe)?;
    let moved = all;
    for i in 0..moved.len() {
        if !fixed[i] {
            at.u[i] = origin.at[i] + moved[i];
        }
    }
    solver.newton.statistics.seconds.recover += started.elapsed().as_secs_f64();
    Ok(converged)
}

/// Checks the interior of an increment in motion, in which forces of the size `scale` balance beside those of interfaces.
pub fn check_in_motion(
    solver: &mut Solver,
    model: &Model,
    converged: &Converged,
    scale: f64,
    u: &[f64],
    fixed: &[bool],
) -> Result<(), StepFailure> {
    let recovered = Recovered {
        forces: &converged.forces,
        u,
        diagonal: in_motion(&solver.inertia).matrix().1,
        fixed,
        contact: dot(&converged.contact, &converged.contact),
        others: scale * scale,
    };
    let largest = &mut solver.condenser.largest_forces;
    recovered.check(model.solution.settings.tolerance, largest)
}
