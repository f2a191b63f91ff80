//! The beginning of a step: conditions, masses, candidates, and who makes its increments.

use std::sync::Arc;

use super::failures::refuse_unbalanced;
use super::modes::find_kick;
use super::parts::{Run, view};
use super::position::Increments;
use crate::assess::{doctor, unsupported};
use crate::contact::interface::mass_per_area;
use crate::error::Error;
use crate::integrate::explicit::Explicit;
use crate::integrate::onset;
use crate::integrate::quasi_static::QuasiStatic;
use crate::modal::linear::fault;
use crate::model::capability::Feature;
use crate::model::cycling::{Block, Jump};
use crate::model::frame::Motion;
use crate::solve::condensed::{candidates, condensing};
use crate::solve::follow;
use crate::time::scheme::Method;

/// Begins a step.
pub(super) fn begin_step(run: &mut Run, step: usize) -> Result<(), Error> {
    let jumps = run.model.steps[step].cycles;
    if jumps.is_some_and(|c| c.jump != Jump::Fixed(1))
        && let Some(message) = run.contact.refusal(Feature::CycleJumps)
    {
        return Err(fault(&run.frame, message).into());
    }
    let kick = find_kick(run, step)?;
    run.frame.kick = kick;
    let Run {
        model,
        contact,
        frame,
        solver,
        summary,
        ..
    } = run;
    frame.step = step;
    for (interface, conditions) in contact.interfaces.iter().zip(&mut solver.conditions) {
        conditions.steady = model.sliding(step, &interface.name);
        conditions.impulses = false;
    }
    frame.block = Block::default();
    frame.begin_step(model, contact);
    let contacts = Arc::make_mut(&mut frame.contacts);
    contact.begin_acting(
        contacts,
        &solver.conditions,
        &model.steps[step],
        &frame.state,
    );
    if model.steps[step].modal.is_some() {
        return Ok(());
    }
    let Some(dynamic) = model.steps[step].dynamic else {
        return begin_static(run);
    };
    solver.condenser.drop_at_rest();
    // What keeps unconstrained bodies in place at rest has no part in motion, where their masses do.
    solver.floating.forget_all();
    let contacts = Arc::make_mut(&mut frame.contacts);
    contact.use_springs(contacts, false, |energy| frame.ledger.initial += energy);
    run.integrator = match dynamic.method {
        Method::Implicit(alphas) => Box::new(onset::begin(
            model, frame, contact, solver, dynamic, alphas,
        )?),
        Method::Explicit { .. } => {
            candidates::keep_all_points(solver, model, contact);
            let explicit = Explicit::begin(model, frame, contact, &solver.conditions, &dynamic)?;
            summary.explicit.mass_added = explicit.begun.mass_added;
            summary.explicit.stable_increment = explicit.begun.stable;
            Box::new(explicit)
        }
    };
    Ok(())
}

/// Begins a quasi-static step: it knows no velocities, what motion there was ends.
fn begin_static(run: &mut Run) -> Result<(), Error> {
    let Run {
        model,
        contact,
        frame,
        solver,
        ..
    } = run;
    let energy = &mut frame.ledger;
    energy.numerical += energy.kinetic;
    energy.kinetic = 0.0;
    frame.state.v.clear();
    frame.state.a.clear();
    frame.motion = Motion::default();
    solver.end_dynamics();
    for (interface, conditions) in contact.interfaces.iter().zip(&mut solver.conditions) {
        conditions.inertia = mass_per_area(interface, &[]);
    }
    let contacts = Arc::make_mut(&mut frame.contacts);
    contact.use_springs(contacts, false, |energy| frame.ledger.initial += energy);
    run.integrator = Box::new(QuasiStatic);
    follow::find_floating_bodies(solver, model, frame, contact);
    if let Some((finding, error)) = unsupported::refuse_rigid_modes(&view!(run)) {
        doctor::note(&mut run.summary.findings, finding);
        return Err(error.into());
    }
    let first = Increments::of(run.step()).stepper.next();
    if let Some(error) = first.and_then(|trial| refuse_unbalanced(run, trial)) {
        return Err(error);
    }
    let (model, frame) = (&run.model, &run.frame);
    candidates::choose_candidates(&mut run.solver, model, frame, &run.contact);
    condensing::condense(&mut run.solver, model, frame, &run.contact);
    Ok(())
}
