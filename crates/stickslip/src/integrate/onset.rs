//! The start of a dynamic step: masses, velocities, and the forces and accelerations from which the first increment goes on.

use std::sync::Arc;

use super::implicit::{Implicit, Purpose};
use super::integrator::Integrator;
use super::sight::frames_here;
use crate::body::couplings::{Couplings, MotionStart, motion};
use crate::contact::interface::{
    Conditions, add_initial_forces, adopt_light_tractions, adopt_tractions, evaluate_laws,
    mass_per_area, presses_light_points, tried_tractions,
};
use crate::contact::look;
use crate::error::Error;
use crate::math::vector::{difference, dot};
use crate::model::contact::Contact;
use crate::model::definition::{ContactAt, Dynamic, Model};
use crate::model::frame::{Frame, Motion};
use crate::solve::condensed::candidates;
use crate::solve::inertia::{Inertia, in_motion};
use crate::solve::solver::{Solver, entries};
use crate::system::{Deformed, IncrementalRotation, Links, Stage, State, StepFailure};
use crate::time::Trial;
use crate::time::scheme::Alphas;

/// The backward Euler method: no force of the start has a part in it.
const BACKWARD: Alphas = Alphas {
    alpha_m: 0.0,
    alpha_f: 0.0,
    beta: 1.0,
    gamma: 1.0,
};

/// Fraction of the duration of a step after its start at which loads that begin with the step are read. It is more than rounding of times.
pub(crate) const JUST_AFTER: f64 = 1e-9;

/// Lengths of the trial increments that find the forces of contact at the start, in first increments.
const TRIALS: [f64; 2] = [0.1, 0.5];

/// Part of themselves by which these forces may differ between the two: those of an impact, which take the same momentum out of bodies in any
/// time, differ by four fifths.
const SUDDEN_CHANGE: f64 = 0.5;

/// Begins an implicit step: masses, initial velocities, candidates, and the forces and accelerations at the start.
pub fn begin(
    model: &Model,
    frame: &mut Frame,
    contact: &mut Contact,
    solver: &mut Solver,
    dynamic: Dynamic,
    alphas: Alphas,
) -> Result<Implicit, Error> {
    let implicit = Implicit::new(dynamic, alphas);
    start_motion(model, frame, contact, solver, &dynamic);
    candidates::choose_candidates(solver, model, frame, contact);
    start_forces(&implicit, model, frame, contact, solver)?;
    Ok(implicit)
}

/// Finds the forces of the interfaces and the accelerations at the start of a dynamic step.
fn start_forces(
    implicit: &Implicit,
    model: &Model,
    frame: &mut Frame,
    contact: &mut Contact,
    solver: &mut Solver,
) -> Result<(), Error> {
    let step = &model.steps[frame.step];
    let (t, dt) = (
        step.start + JUST_AFTER * (step.end - step.start),
        step.increments.initial,
    );
    frame.load = frame.external(model, t);
    let pressed = equilibrate_massless(implicit, model, frame, contact, solver, t, dt);
    let evaluated =
        initial_contact(model, frame, contact, &solver.conditions, t, dt).map_err(|e| e.at(t))?;
    let before = std::mem::replace(&mut frame.contact, evaluated);
    match tried_contact(implicit, model, frame, contact, solver, dt) {
        Some(forces) => frame.contact = forces,
        None => keep_massless_forces(model, frame, contact, solver, t, &pressed.unwrap_or(before)),
    }
    let lag = implicit.alphas.lag() * dt;
    initial_acceleration(model, frame, contact, solver, t, lag).map_err(|e| e.at(t).into())
}

/// Lets points without mass go where overlap presses them, which takes them no time, with the forces there; `None` where none overlap, and where no equilibrium
/// is found. What that strains bodies by is work of the overlap. Damping has no part in it: it would make any work of what takes no time.
fn equilibrate_massless(
    implicit: &Implicit,
    model: &Model,
    frame: &mut Frame,
    contact: &mut Contact,
    solver: &mut Solver,
    t: f64,
    dt: f64,
) -> Option<Vec<f64>> {
    let (before, at) = at_start(model, frame, t, dt);
    let stage = Stage {
        from: &before,
        at: &at,
        dt,
        rate: None,
        frames: None,
    };
    let mut forces = contact.forces(&frame.contacts, &solver.conditions);
    let mut interfaces = forces.interfaces.iter_mut();
    if !interfaces.any(|i| presses_light_points(i, &stage)) {
        return None;
    }
    let trial = Trial {
        from: frame.state.t,
        // Length of the trial increment, in first increments: none to speak of.
        to: frame.state.t + 1e-3 * dt,
    };
    let tried = euler(implicit, false).attempt(model, frame, contact, solver, trial);
    solver.seen.clear();
    let accepted = tried.ok()?;
    let inertia = in_motion(&solver.inertia);
    let contacts = Arc::make_mut(&mut frame.contacts);
    let all = contact.interfaces.iter().zip(&mut contacts.interfaces);
    for ((interface, history), conditions) in all.zip(&solver.conditions) {
        adopt_light_tractions(history, conditions, &tried_tractions(interface));
    }
    let moved = frame.state.u.iter_mut().zip(&accepted.state.u);
    for ((u, to), _) in moved.zip(&inertia.light).filter(|(_, light)| **light) {
        *u = *to;
    }
    let internal = solver.bodies.forces(&frame.state.u);
    let strain = solver.bodies.energy(Deformed {
        u: &frame.state.u,
        forces: &internal,
    });
    let energy = &mut frame.ledger;
    let strain = strain + energy.entered.thermal;
    energy.belt_work += strain - energy.strain;
    energy.strain = strain;
    frame.motion.internal = internal;
    frame.motion.start.clone_from(&frame.state.u);
    Some(accepted.contact)
}

/// The method of Euler with what else is chosen.
fn euler(implicit: &Implicit, damped: bool) -> Implicit {
    Implicit {
        dynamic: Dynamic {
            contact_at: ContactAt::End,
            error: None,
            events: None,
            ..implicit.dynamic
        },
        alphas: BACKWARD,
        purpose: Purpose::Onset { damped },
    }
}

/// The forces of the interfaces at the end of a short increment with the method of Euler: pressure holds what would go through, points stick that
/// the limit holds and others carry it. `None` where nothing touches, where no equilibrium is found, and at an impact, whose force is not that of
/// an instant.
fn tried_contact(
    implicit: &Implicit,
    model: &Model,
    frame: &mut Frame,
    contact: &mut Contact,
    solver: &mut Solver,
    dt: f64,
) -> Option<Vec<f64>> {
    let t = frame.state.t;
    let inertia = in_motion(&solver.inertia);
    if !forces_are_sought(model, contact, inertia, t + JUST_AFTER * dt) {
        return None;
    }
    let mut euler = euler(implicit, true);
    let tried = TRIALS.map(|part| {
        let trial = Trial {
            from: t,
            to: t + part * dt,
        };
        let tried = euler.attempt(model, frame, contact, solver, trial);
        // They are not reported.
        solver.seen.clear();
        let tried = tried.map(|accepted| {
            let (to, u) = (trial.to, &accepted.state.u);
            let memory = &frame.contacts.couplings;
            let add = |out: &mut [f64]| contact.couplings.add_tried(memory, to, u, out);
            let coupled = coupling_forces(&model.links, u.len(), add);
            difference(&accepted.contact, &coupled)
        });
        let interfaces = contact.interfaces.iter();
        let after: Vec<_> = interfaces.map(tried_tractions).collect();
        tried.map(|contact| (contact, after))
    });
    let [Ok((short, after)), Ok((long, _))] = tried else {
        return None;
    };
    let change = difference(&short, &long);
    if dot(&change, &change) > SUDDEN_CHANGE * SUDDEN_CHANGE * dot(&short, &short) {
        return None;
    }
    let contacts = Arc::make_mut(&mut frame.contacts);
    for (history, tried) in contacts.interfaces.iter_mut().zip(&after) {
        adopt_tractions(history, tried);
    }
    let at = State {
        t: t + JUST_AFTER * dt,
        ..frame.state.clone()
    };
    let add = |out: &mut [f64]| contact.couplings.add_initial(&contacts.couplings, &at, out);
    let known = coupling_forces(&model.links, at.u.len(), add);
    Some(short.iter().zip(known).map(|(a, b)| a + b).collect())
}

/// Makes masses and initial velocities of a dynamic step ready.
fn start_motion(
    model: &Model,
    frame: &mut Frame,
    contact: &Contact,
    solver: &mut Solver,
    dynamic: &Dynamic,
) {
    let n = frame.state.u.len();
    if frame.state.v.is_empty() {
        frame.state.v = vec![0.0; n];
    }
    frame.state.a = vec![0.0; n];
    let inertia = match solver.inertia.take() {
        Some(inertia) if inertia.suits(contact, dynamic) => inertia,
        old => {
            let keys = old.map_or(solver.keys, |inertia| inertia.keys());
            Inertia::new(model, contact, entries(&solver.stiffness), dynamic, keys)
        }
    };
    let masses = inertia.at_points(model);
    for (interface, conditions) in contact.interfaces.iter().zip(&mut solver.conditions) {
        conditions.inertia = mass_per_area(interface, &masses);
    }
    let before = inertia.kinetic_energy(&frame.state.v);
    model.apply_initial_velocities(frame.step, &mut frame.state.v);
    begin_along_mode(model, frame, &contact.couplings, &inertia, solver);
    let energy = &mut frame.ledger;
    energy.kinetic = inertia.kinetic_energy(&frame.state.v);
    energy.initial += energy.kinetic - before;
    frame.motion = Motion {
        internal: solver.bodies.forces(&frame.state.u),
        start: frame.state.u.clone(),
        travel: 0.0,
    };
    solver.inertia = Some(inertia);
}

/// Displaces the bodies along the mode with which the step begins. What that stores is brought in from outside.
fn begin_along_mode(
    model: &Model,
    frame: &mut Frame,
    couplings: &Couplings,
    inertia: &Inertia,
    solver: &Solver,
) {
    let Some(kick) = &mut frame.kick else {
        return;
    };
    let memory = &frame.contacts.couplings;
    kick.images = [0, 1].map(|k| inertia.mass_times(&kick.shape[k]));
    let (t, n) = (frame.state.t, frame.state.u.len());
    // Bodies and springs are linear: the trapezoidal rule is exact.
    let forces = |u: &[f64]| -> Vec<f64> {
        let at = State {
            t,
            u: u.to_vec(),
            v: vec![0.0; n],
            ..State::default()
        };
        let add = |out: &mut [f64]| couplings.add_initial(memory, &at, out);
        let coupled = coupling_forces(&model.links, n, add);
        let both = (solver.stiffness.times(u).into_iter()).zip(coupled);
        both.map(|(a, b)| a + b).collect()
    };
    let before = frame.state.u.clone();
    kick.apply(&mut frame.state);
    let (from, to) = (forces(&before), forces(&frame.state.u));
    let moved = difference(&frame.state.u, &before);
    let stored = 0.5 * (dot(&from, &moved) + dot(&to, &moved));
    frame.ledger.strain += stored;
    frame.ledger.initial += stored;
}

/// Where bodies are at the start of a motion, and where they were `dt` before with the velocities that they have.
fn at_start(model: &Model, frame: &Frame, t: f64, dt: f64) -> (State, State) {
    let v = &frame.state.v;
    let mut u = frame.state.u.clone();
    IncrementalRotation::new(&model.frames, &frame.state.u).enter(&mut u);
    let before = State {
        t: t - dt,
        u: u.iter().zip(v).map(|(u, v)| u - dt * v).collect(),
        ..State::default()
    };
    let at = State {
        t,
        u,
        ..State::default()
    };
    (before, at)
}

/// Forces of the interfaces at the start as the laws have them, slip at the velocities of the start. Where pressure or stick are multipliers the
/// laws say nothing of them. What overlap stores enters the ledger.
pub(crate) fn initial_contact(
    model: &Model,
    frame: &mut Frame,
    contact: &mut Contact,
    conditions: &[Conditions],
    t: f64,
    dt: f64,
) -> Result<Vec<f64>, StepFailure> {
    let (before, at) = at_start(model, frame, t, dt);
    let u = &frame.state.u;
    let frames = frames_here(model, u);
    let stage = Stage {
        from: &before,
        at: &at,
        dt,
        rate: None,
        frames: frames.as_ref(),
    };
    let mut forces = vec![0.0; u.len()];
    let contacts = Arc::make_mut(&mut frame.contacts);
    let interfaces = contact.interfaces.iter_mut().zip(&mut contacts.interfaces);
    let stored: Result<f64, StepFailure> = (interfaces.zip(conditions))
        .map(|((i, history), c)| add_initial_forces(i, history, c, &stage, &mut forces))
        .sum();
    let stored = stored?;
    frame.ledger.initial += stored;
    frame.ledger.contact += stored;
    IncrementalRotation::new(&model.frames, u).outward(&vec![0.0; u.len()], &mut forces);
    let (couplings, memory) = (&contact.couplings, &mut contacts.couplings);
    couplings.begin_motion(memory, t, &frame.state.v);
    let at = State {
        t,
        ..frame.state.clone()
    };
    couplings.add_initial(memory, &at, &mut forces);
    model.links.transfer(&mut forces);
    Ok(forces)
}

/// Lets the interfaces see where they stand at the start of an explicit step: the stiffness and viscosity of what is in contact bound its increments.
pub(crate) fn look_at_contact(
    model: &Model,
    frame: &Frame,
    contact: &mut Contact,
    conditions: &[Conditions],
    t: f64,
    dt: f64,
) {
    let (before, at) = at_start(model, frame, t, dt);
    let frames = frames_here(model, &frame.state.u);
    let stage = Stage {
        from: &before,
        at: &at,
        dt,
        rate: None,
        frames: frames.as_ref(),
    };
    let mut forces = contact.forces(&frame.contacts, conditions);
    let interfaces = forces.interfaces.iter_mut();
    interfaces.for_each(|i| evaluate_laws(i, &stage));
}

/// Whether points with mass touch where the laws alone do not tell the forces: a multiplier presses them, or they are those of a rigid body and
/// may stick.
fn forces_are_sought(model: &Model, contact: &Contact, inertia: &Inertia, t: f64) -> bool {
    let links = &model.links;
    contact.interfaces.iter().any(|interface| {
        let first = |node: &usize| model.dofs.of(*node, 0);
        let mut nodes = interface.nodes.iter();
        let rigid = || interface.nodes.iter().any(|n| links.of_point(*n).is_some());
        let mut heavy = || nodes.any(|n| !inertia.light[first(n)]);
        let laws = &interface.laws;
        let sought =
            laws.needs_normal_stiffness() && heavy() || laws.friction_law().frictional() && rigid();
        interface.schedule.active(t) && sought && look::touches(interface)
    })
}

/// Forces of couplings by dof, those at rigid bodies where they move them.
fn coupling_forces(links: &Links, count: usize, add: impl Fn(&mut [f64])) -> Vec<f64> {
    let mut out = vec![0.0; count];
    add(&mut out);
    links.transfer(&mut out);
    out
}

/// Points without mass go on with the forces that they had at rest.
fn keep_massless_forces(
    model: &Model,
    frame: &mut Frame,
    contact: &Contact,
    solver: &Solver,
    t: f64,
    before: &[f64],
) {
    if before.len() != frame.contact.len() {
        return;
    }
    let light = &in_motion(&solver.inertia).light;
    let interfaces = contact.interfaces.iter();
    let acting = interfaces.filter(|i| i.schedule.active(t));
    for node in acting.flat_map(|i| &i.nodes) {
        for i in 0..model.dofs.dim {
            let dof = model.dofs.of(*node, i);
            if light[dof] {
                frame.contact[dof] = before[dof];
            }
        }
    }
}

/// `(M + h C) a₀ = f(u₀, v₀)` at time `t`, with the time `h` over which damping may have acted.
fn initial_acceleration(
    model: &Model,
    frame: &mut Frame,
    contact: &mut Contact,
    solver: &Solver,
    t: f64,
    lag: f64,
) -> Result<(), StepFailure> {
    let inertia = in_motion(&solver.inertia);
    let internal = &frame.motion.internal;
    let damping = solver.damping_force(true, &frame.state.u, &frame.state.v);
    let mut force: Vec<f64> = (0..internal.len())
        .map(|i| frame.load[i] - internal[i] - damping[i] - frame.contact[i])
        .collect();
    let spinning = IncrementalRotation::new(&model.frames, &frame.state.u);
    if !spinning.is_empty() {
        spinning.to_body_axes(&mut force);
        let v = &frame.state.v;
        spinning.add_steady(-1.0, (v, &inertia.mass_times(v)), &mut force);
    }
    let fixed = frame.constraints(model, t).fixed;
    let mut accelerate = inertia.accelerator(&fixed, lag);
    frame.state.a = accelerate(&force)?;
    // Prescribed dofs have no acceleration, which is as good as known; those of light points follow from the interfaces.
    let free: Vec<bool> = (inertia.bare.iter().zip(&fixed))
        .map(|(b, f)| *b && !f)
        .collect();
    let memory = &mut Arc::make_mut(&mut frame.contacts).couplings;
    motion::start_motion(
        &contact.couplings,
        memory,
        &MotionStart {
            t,
            links: &model.links,
            massless: &inertia.light,
            bare: &free,
            force: &force,
        },
        &mut accelerate,
        &mut frame.state.a,
        &mut frame.contact,
    )?;
    inertia.lead(model, contact, t, &fixed, &mut frame.state.v);
    model.links.impose(&mut frame.state.a);
    Ok(())
}
