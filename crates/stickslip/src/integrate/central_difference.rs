//! One explicit increment.

use std::borrow::Cow;
use std::sync::Arc;

use rayon::prelude::*;

use super::drift::Drift;
use super::exact::Exact;
use super::explicit::{Explicit, RayleighDamping, unstable};
use super::integrator::Integrator;
use super::sight::frames_here;
use crate::contact::look;
use crate::model::contact::{Contact, ContactForces};
use crate::model::definition::Model;
use crate::model::frame::Frame;
use crate::model::ledger::Flow;
use crate::solve::accepted::{Accepted, Effort};
use crate::solve::solver::Solver;
use crate::system::{Cause, Constraints, Force, IncrementalRotation, Stage, State, StepFailure};
use crate::time::Trial;

/// Dofs that one task updates; fixed, so that sums do not depend on the number of threads.
const DOFS_PER_TASK: usize = 4096;

/// Sums over one chunk.
#[derive(Clone, Copy, Default)]
struct Sums {
    kinetic: f64,
    strain: f64,
    work: f64,
    damped: f64,
    /// `aᵀ m a` before and after.
    turned: [f64; 2],
    finite: bool,
}

impl Integrator for Explicit {
    fn attempt(
        &mut self,
        model: &Model,
        frame: &Frame,
        contact: &mut Contact,
        solver: &mut Solver,
        trial: Trial,
    ) -> Result<Accepted, StepFailure> {
        check_length(self, model, frame, contact, trial)?;
        let dt = trial.to - trial.from;
        let constraints = match &self.still {
            Some(still) => Arc::clone(still),
            None => Arc::new(frame.constraints(model, trial.to)),
        };
        let mut at = predict(model, frame, &constraints, trial);
        let mut drift = Drift::new(model, frame, &constraints);
        drift.predict(self, &constraints.fixed, dt, &mut at);
        let more = correct(
            self,
            model,
            &*contact,
            &constraints,
            &mut drift,
            &mut at,
            dt,
        )?;
        let u = drift.place(&at.u);
        let forces = contact.forces(&frame.contacts, &solver.conditions);
        evaluate(self, model, frame, forces, &at, dt, &u)?;
        let external = if !self.loaded {
            frame.load.clone()
        } else if model.frames.any_rigid() {
            frame.external_at(model, trial.to, &u)
        } else {
            frame.external(model, trial.to)
        };
        let there = IncrementalRotation::new(&model.frames, &u);
        let mut acting = Cow::Borrowed(&external);
        if !there.is_empty() {
            there.to_body_axes(acting.to_mut());
        }
        let end = End {
            from: drift.from(),
            constraints: &constraints,
            external: &acting,
            dt,
        };
        hold(self, model, contact, &end, &drift, &more, &at)?;
        let mut forces = vec![0.0; external.len()];
        let mut total = accelerate(self, &end, &mut at, &mut forces);
        turn(self, &end, &mut at, &mut forces, &drift, &mut total);
        (self.exact_after).show(&more, &constraints.fixed, contact, &mut forces);
        let none = vec![0.0; u.len()];
        there.outward(&none, &mut forces);
        let mut acted = self.out.residual.clone();
        there.outward(&none, &mut acted);
        at.u = u;
        total.finite &= total.kinetic.is_finite();
        model.links.impose(&mut at.v);
        model.links.impose(&mut at.a);
        if !total.finite {
            return Err(StepFailure::new(
                Cause::NotFinite,
                "the motion has grown beyond all numbers: the increment was not stable",
            )
            .help("lower `safety` of the scheme, or give a penalty that is less stiff"));
        }
        Ok(Accepted {
            effort: Effort {
                tally: contact.interfaces.iter().map(look::tally).sum(),
                ..Effort::default()
            },
            forces,
            contact: acted,
            external,
            flow: Flow {
                work: total.work,
                damped: total.damped,
                // ΔT = Δuᵀ m ā + dt²/8 Δ(aᵀ m a)
                numerical: -dt * dt / 8.0 * (total.turned[1] - total.turned[0]),
                ..Flow::default()
            },
            kinetic: 0.5 * total.kinetic,
            strain: 0.5 * self.stored.unwrap_or(total.strain),
            state: at,
            ..Accepted::default()
        })
    }

    fn accept(&mut self) {
        // Damping as it is now is what it was before the next increment.
        let RayleighDamping { forces, before, .. } = &mut self.damping;
        std::mem::swap(forces, before);
        self.exact = std::mem::take(&mut self.exact_after);
    }

    fn bound(&self, model: &Model, frame: &Frame, contact: &Contact) -> Option<f64> {
        let fixed = model.steps[frame.step].fixed;
        (!fixed).then(|| self.stable_increment(model, frame, contact))
    }
}

/// What acts at the end of an increment, and where it began.
struct End<'a> {
    from: &'a Frame,
    constraints: &'a Constraints,
    /// External forces at the end `[N]`.
    external: &'a [f64],
    /// Length of the increment `[s]`.
    dt: f64,
}

impl End<'_> {
    /// What held a dof at the start, but for its inertia `[N]`.
    fn held(&self, i: usize, inertia: f64) -> f64 {
        self.from.forces.get(i).map_or(0.0, |r| r - inertia)
    }
}

/// Displacements at the end, and velocities in the middle of the increment.
fn predict(model: &Model, frame: &Frame, constraints: &Constraints, trial: Trial) -> State {
    let dt = trial.to - trial.from;
    let from = &frame.state;
    let n = from.u.len();
    let mut at = State {
        t: trial.to,
        u: vec![0.0; n],
        v: vec![0.0; n],
        a: vec![0.0; n],
    };
    at.u.par_chunks_mut(DOFS_PER_TASK)
        .zip(at.v.par_chunks_mut(DOFS_PER_TASK))
        .enumerate()
        .for_each(|(c, (u, v))| {
            let first = c * DOFS_PER_TASK;
            for (k, (u, v)) in u.iter_mut().zip(v).enumerate() {
                let i = first + k;
                if constraints.fixed[i] {
                    *u = constraints.values[i];
                    *v = (*u - from.u[i]) / dt;
                } else {
                    *v = from.v[i] + 0.5 * dt * from.a[i];
                    *u = from.u[i] + dt * *v;
                }
            }
        });
    model.links.impose(&mut at.u);
    model.links.impose(&mut at.v);
    at
}

/// Refuses an increment of given length that is not stable.
fn check_length(
    explicit: &Explicit,
    model: &Model,
    frame: &Frame,
    contact: &Contact,
    trial: Trial,
) -> Result<(), StepFailure> {
    let step = &model.steps[frame.step];
    if !step.fixed {
        return Ok(());
    }
    let dt = trial.to - trial.from;
    let stable = explicit.stable(explicit.contact_frequency(model, frame, contact));
    if dt > stable * (1.0 + 1e-9) {
        let e = unstable(&step.name, trial.from, dt, stable, step.end - step.start);
        return Err(StepFailure {
            help: e.help,
            ..StepFailure::new(Cause::NotConverged, e.message)
        });
    }
    Ok(())
}

/// Forces of bodies, damping and interfaces at the end.
fn evaluate(
    explicit: &mut Explicit,
    model: &Model,
    frame: &Frame,
    mut forces: ContactForces,
    at: &State,
    dt: f64,
    u: &[f64],
) -> Result<(), StepFailure> {
    explicit.resist(model, u);
    model.links.transfer(&mut explicit.force);
    explicit.damp(model, u, &at.v);
    explicit.out.reset(false);
    let frames = frames_here(model, u);
    let there = IncrementalRotation::new(&model.frames, u);
    let (mut from, mut seen) = (Cow::Borrowed(&frame.state), Cow::Borrowed(at));
    if !there.is_empty() {
        there.enter(&mut from.to_mut().u);
        seen.to_mut().u = u.to_vec();
        there.enter(&mut seen.to_mut().u);
    }
    let stage = Stage {
        from: &from,
        at: &seen,
        dt,
        rate: None,
        frames: frames.as_ref(),
    };
    for interface in &mut forces.interfaces {
        interface.begin();
        interface.prepare(&stage);
        interface.assemble(&stage, &mut explicit.out)?;
    }
    forces.couplings.assemble(&stage, &mut explicit.out)?;
    model.links.transfer(&mut explicit.out.residual);
    Ok(())
}

/// Leads what is held exactly to where it holds at the end of the increment; the forces that rows had more for that, from the start on.
fn correct(
    explicit: &mut Explicit,
    model: &Model,
    contact: &Contact,
    constraints: &Constraints,
    drift: &mut Drift,
    at: &mut State,
    dt: f64,
) -> Result<Vec<f64>, StepFailure> {
    (explicit.exact).lead(&model.links, contact, drift.from(), at.t);
    if explicit.exact.is_empty() {
        return Ok(Vec::new());
    }
    let mobility = explicit.mobility(constraints);
    let placed = drift.place(&at.u);
    let from = &drift.from().state.u;
    let more = (explicit.exact).correct(&mobility, &model.links, dt, from, &placed, at)?;
    explicit.exact.restart(&mobility, &more, drift.start());
    Ok(more)
}

/// Lets what is held exactly go on holding: finds its forces, which balance those of all else at the end of the increment.
fn hold(
    explicit: &mut Explicit,
    model: &Model,
    contact: &mut Contact,
    end: &End,
    drift: &Drift,
    more: &[f64],
    at: &State,
) -> Result<(), StepFailure> {
    let End {
        from,
        constraints,
        external,
        ..
    } = *end;
    let mut exact = Exact::gather(model, from, contact, at.t, &explicit.exact);
    if !exact.is_empty() {
        let mobility = explicit.mobility(constraints);
        let balance = |i: usize| external[i] - explicit.force[i] - explicit.out.residual[i];
        let mut forces: Vec<f64> = (0..external.len()).map(balance).collect();
        forces
            .iter_mut()
            .zip(&explicit.damping.forces)
            .for_each(|(f, d)| *f -= d);
        for spin in &explicit.spins {
            let turning = drift.turning(spin, &at.v);
            spin.range().zip(turning).for_each(|(i, m)| forces[i] -= m);
        }
        let a = exact.accelerations(&mobility, &forces);
        exact.balance(&mobility, &a)?;
        exact.act(
            &explicit.exact,
            more,
            contact,
            &model.links,
            &mut explicit.out,
        );
    }
    explicit.exact_after = exact;
    Ok(())
}

/// Accelerations, velocities and reactions at the end, and sums over all dofs in a fixed order.
fn accelerate(explicit: &Explicit, end: &End, at: &mut State, forces: &mut [f64]) -> Sums {
    let End {
        from: frame,
        constraints,
        external,
        dt,
    } = *end;
    let (from, load_before) = (&frame.state, &frame.load);
    let State { u, v, a, .. } = at;
    let u: &[f64] = u;
    let Explicit {
        mass,
        inverse,
        force,
        damping:
            RayleighDamping {
                forces: damped,
                before: damped_before,
                ..
            },
        out,
        ..
    } = explicit;
    let sums: Vec<Sums> = v
        .par_chunks_mut(DOFS_PER_TASK)
        .zip(a.par_chunks_mut(DOFS_PER_TASK))
        .zip(forces.par_chunks_mut(DOFS_PER_TASK))
        .enumerate()
        .map(|(c, ((v, a), r))| {
            let first = c * DOFS_PER_TASK;
            let mut sums = Sums {
                finite: true,
                ..Sums::default()
            };
            for (k, ((v, a), r)) in v.iter_mut().zip(a).zip(r).enumerate() {
                let i = first + k;
                let moved = u[i] - from.u[i];
                let balance = external[i] - force[i] - damped[i] - out.residual[i];
                if constraints.fixed[i] {
                    *a = (*v - from.v[i]) / dt;
                    *r = mass[i] * *a - balance;
                    // What is not inertia acts as everywhere, by its mean; inertia takes what the mass has more of, however sudden.
                    let held = end.held(i, mass[i] * from.a[i]);
                    sums.work += 0.5 * (held - balance) * moved
                        + 0.5 * mass[i] * (*v * *v - from.v[i] * from.v[i]);
                } else {
                    *a = inverse[i] * balance;
                    *v += 0.5 * dt * *a;
                    sums.turned[0] += mass[i] * from.a[i] * from.a[i];
                    sums.turned[1] += mass[i] * *a * *a;
                }
                sums.work += 0.5 * (load_before[i] + external[i]) * moved;
                sums.damped += 0.5 * (damped_before[i] + damped[i]) * moved;
                sums.kinetic += mass[i] * *v * *v;
                sums.strain += force[i] * u[i];
            }
            sums.finite = sums.kinetic.is_finite();
            sums
        })
        .collect();
    let mut total = Sums {
        finite: true,
        ..Sums::default()
    };
    for s in sums {
        total.kinetic += s.kinetic;
        total.strain += s.strain;
        total.work += s.work;
        total.damped += s.damped;
        total.turned[0] += s.turned[0];
        total.turned[1] += s.turned[1];
        total.finite &= s.finite;
    }
    total
}

/// The same for rotations of rigid bodies, whose inertia is no diagonal.
fn turn(
    explicit: &Explicit,
    end: &End,
    at: &mut State,
    forces: &mut [f64],
    drift: &Drift,
    total: &mut Sums,
) {
    let (constraints, dt) = (end.constraints, end.dt);
    let from = &end.from.state;
    for spin in &explicit.spins {
        let range = spin.range();
        let mut moment = [0.0; 3];
        for (m, i) in moment.iter_mut().zip(range.clone()) {
            *m = end.external[i] - explicit.force[i] - explicit.out.residual[i];
        }
        if drift.has(spin) {
            let gained = drift.kick(spin, end.from, dt, moment, at);
            total.turned[1] += 8.0 / (dt * dt) * gained;
            total.kinetic += spin.square(spin.of(&at.v));
            continue;
        }
        let State { v, a, .. } = at;
        let turn = spin.acceleration(moment, &constraints.fixed, spin.of(a));
        let inertial = spin.force(turn);
        let mut free = [spin.of(&from.a), turn];
        for (k, i) in range.enumerate() {
            if constraints.fixed[i] {
                forces[i] += inertial[k];
                total.work += 0.5 * dt * inertial[k] * (from.v[i] + v[i]);
                free.iter_mut().for_each(|a| a[k] = 0.0);
            } else {
                a[i] = turn[k];
                v[i] += 0.5 * dt * turn[k];
            }
        }
        for (sum, a) in total.turned.iter_mut().zip(free) {
            *sum += spin.square(a);
        }
        total.kinetic += spin.square(spin.of(v));
    }
}
