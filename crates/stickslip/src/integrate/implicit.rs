//! Implicit increments in motion: balance of inertia, damping, elasticity, loads and interfaces at the stage of the scheme.

use super::impulse::{is_impulse, kicked, stop};
use super::integrator::Integrator;
use super::quasi_static::pairs;
use super::sight::{Acting, Ended, InertialFrame, in_space};
use std::borrow::Cow;
use std::sync::Arc;

use crate::body::couplings::fit;
use crate::contact::look;
use crate::math::vector::{difference, dot, weighted_mean};
use crate::model::contact::Contact;
use crate::model::definition::{ContactAt, Dynamic, Model};
use crate::model::frame::Frame;
use crate::model::ledger::Flow;
use crate::newton::{Converged, Origin};
use crate::number::digits;
use crate::solve::accepted::Accepted;
use crate::solve::checks::{check_candidates, check_change};
use crate::solve::condensed::in_motion;
use crate::solve::inertia::{IncrementMatrix, Inertia, in_motion};
use crate::solve::iteration::{Load, Task};
use crate::solve::solver::{Solver, entries};
use crate::system::{
    BodyFrames, Cause, Constraints, Deformed, IncrementalRotation, Rate, Stage, State, StepFailure,
};
use crate::time::Trial;
use crate::time::newmark::{Increment, error_factor};
use crate::time::scheme::Alphas;

/// Makes increments of a step in motion, each an equilibrium at the stage of a scheme.
#[derive(Clone)]
pub(crate) struct Implicit {
    /// How the step is integrated.
    pub dynamic: Dynamic,
    /// The scheme.
    pub alphas: Alphas,
    /// What its increments are for.
    pub purpose: Purpose,
}

/// What increments are for.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Purpose {
    /// To be accepted.
    Analysis,
    /// To find forces at the start of a step: they are not handed on, and cannot be tried again once the analysis is asked to stop.
    Onset {
        /// Whether Rayleigh damping acts.
        damped: bool,
    },
}

/// One increment that has converged.
struct Solved {
    state: State,
    /// Out-of-balance force at the stage: reactions at fixed dofs.
    reactions: Vec<f64>,
    contact: Vec<f64>,
    external: Vec<f64>,
    /// Elastic forces.
    internal: Vec<f64>,
    /// Those of the scheme over the increment, less what was stored `[J]`.
    elastic: f64,
}

/// The forces of the bulk at the guess of an increment.
struct Guess {
    /// Displacements.
    u: Vec<f64>,
    /// Elastic forces.
    internal: Vec<f64>,
    /// Forces over the weight of the interfaces, without those of the interfaces at the end.
    forces: Vec<f64>,
    /// Size of what balances in them.
    scale: f64,
}

impl Solved {
    fn deformed(&self) -> Deformed<'_> {
        Deformed {
            u: &self.state.u,
            forces: &self.internal,
        }
    }

    /// What of it an accepted increment hands on.
    fn accepted(self, converged: &Converged) -> Accepted {
        Accepted {
            forces: self.reactions,
            contact: self.contact,
            external: self.external,
            internal: Some(self.internal),
            state: self.state,
            ..Accepted::from_newton(converged)
        }
    }
}

/// The state from which an increment starts: where masses meet, with the accelerations of the impulse that is there already.
fn impulse_start(
    model: &Model,
    frame: &Frame,
    contact: &Contact,
    inertia: &Inertia,
    fixed: &[bool],
    impulse: bool,
) -> Result<State, StepFailure> {
    let mut from = frame.state.clone();
    if impulse && !frame.contact.is_empty() {
        let kick = kicked(model, inertia, fixed, &frame.contact)?;
        from.a.iter_mut().zip(kick).for_each(|(a, k)| *a += k);
        inertia.lead(model, contact, from.t, fixed, &mut from.a);
    }
    Ok(from)
}

/// Where an increment is expected to end.
fn predicted(
    model: &Model,
    increment: &Increment,
    constraints: &Constraints,
    sight: Option<&InertialFrame>,
) -> Vec<f64> {
    let mut u = increment.predict();
    if let Some(sight) = sight {
        sight.expect(model, increment.from, increment.dt, &mut u);
    }
    constraints.impose(&mut u);
    model.links.impose(&mut u);
    u
}

/// How velocities follow from displacements along the axes of space, where contact is: gain and shift by dof.
fn rate_in_space(
    model: &Model,
    increment: &Increment,
    fixed: &[bool],
    sight: Option<&InertialFrame>,
) -> (Vec<f64>, Vec<f64>) {
    let (mut gain, mut shift) = increment.rate();
    if let Some(sight) = sight {
        sight.turn_out(&mut shift);
        sight.rate(model, increment, fixed, &mut gain, &mut shift);
    }
    (gain, shift)
}

/// What an increment starts from.
#[derive(Clone, Copy)]
struct IncrementStart<'a> {
    frame: &'a Frame,
    solver: &'a Solver,
}

impl<'a> IncrementStart<'a> {
    fn deformed(self) -> Deformed<'a> {
        Deformed {
            u: &self.frame.state.u,
            forces: &self.frame.motion.internal,
        }
    }
}

/// How bodies move in an increment, and what the forces of the interfaces at its start and end count.
#[derive(Clone, Copy)]
struct IncrementScheme<'a> {
    increment: &'a Increment<'a>,
    weights: [f64; 2],
    spinning: &'a IncrementalRotation,
}

/// How an increment ends in which masses meet.
struct ImpulseEnd<'a> {
    fixed: &'a [bool],
    dt: f64,
    rate: Rate<'a>,
    frames: Option<&'a Arc<BodyFrames>>,
}

/// What holds in all passes in which the equilibrium of an increment is sought.
#[derive(Clone, Copy)]
struct Sought<'a> {
    model: &'a Model,
    frame: &'a Frame,
    trial: Trial,
    constraints: &'a Constraints,
    rate: Rate<'a>,
    /// How bodies that turn freely are seen.
    sight: Option<&'a InertialFrame<'a>>,
    scheme: IncrementScheme<'a>,
}

/// What the equilibrium at the stage is sought with.
struct Balance<'a> {
    guess: &'a Guess,
    constraints: Constraints,
    rate: Rate<'a>,
    /// The frames in which bodies that turn freely are seen.
    frames: Option<&'a Arc<BodyFrames>>,
}

impl Integrator for Implicit {
    fn attempt(
        &mut self,
        model: &Model,
        frame: &Frame,
        contact: &mut Contact,
        solver: &mut Solver,
        trial: Trial,
    ) -> Result<Accepted, StepFailure> {
        match model.corotations.is_empty() && !model.frames.any_rigid() {
            true => {
                let acting = Acting::new(model, frame, trial.to);
                self.increment(model, frame, acting, contact, solver, trial)
            }
            false => self.turning(model, frame, contact, solver, trial),
        }
    }
}

impl Implicit {
    /// Makes increments of the analysis.
    pub fn new(dynamic: Dynamic, alphas: Alphas) -> Self {
        Implicit {
            dynamic,
            alphas,
            purpose: Purpose::Analysis,
        }
    }

    /// Tries an increment in which bodies turn freely.
    fn turning(
        &self,
        model: &Model,
        frame: &Frame,
        contact: &mut Contact,
        solver: &mut Solver,
        trial: Trial,
    ) -> Result<Accepted, StepFailure> {
        let way = (1.0 - self.alphas.alpha_f) * (trial.to - trial.from);
        let sight = InertialFrame::new(model, frame, way);
        let inside = sight.inside(model);
        let mut external = Vec::new();
        sight.load(model, &inside.state.u, trial.to, &mut external);
        let constraints = sight.constraints(model, trial.to);
        let outlook = sight.outlook();
        let acting = Acting {
            constraints,
            external,
            sight: Some(sight),
        };
        let found = self.increment(model, &inside, acting, contact, solver, trial);
        found.map(|accepted| in_space(model, &outlook, accepted))
    }

    /// Tries an increment between states along the same axes.
    pub(super) fn increment(
        &self,
        model: &Model,
        frame: &Frame,
        acting: Acting,
        contact: &mut Contact,
        solver: &mut Solver,
        trial: Trial,
    ) -> Result<Accepted, StepFailure> {
        let Acting {
            constraints,
            mut external,
            sight,
        } = acting;
        let fixed = constraints.fixed.clone();
        let inertia =
            (solver.inertia.as_mut()).expect("a step in motion has begun with its masses");
        let length = trial.to - trial.from;
        let times = [trial.from, trial.to];
        let impulse = self.purpose == Purpose::Analysis
            && is_impulse(model, frame, &self.dynamic, contact, inertia, times);
        let scheme = self.meeting(impulse);
        let weights = scheme.weights(impulse);
        let conditions = solver.conditions.iter_mut();
        conditions.for_each(|c| c.impulses = impulse);
        let dt = inertia.ready(
            entries(&solver.stiffness),
            scheme.matrix(length, weights[1]),
        );
        let plain = inertia.plain(&fixed, &model.links, self.damped());
        let from = impulse_start(model, frame, contact, inertia, &fixed, impulse)?;
        let increment = Increment {
            alphas: scheme.alphas,
            dt,
            from: &from,
            plain: &plain,
        };
        let u = predicted(model, &increment, &constraints, sight.as_ref());
        let still = IncrementalRotation::default();
        let spinning = sight.as_ref().map_or(&still, |sight| &sight.spinning);
        let now = IncrementScheme {
            increment: &increment,
            weights,
            spinning,
        };
        let start = IncrementStart { frame, solver };
        let guess = scheme.guess(start, now, u, &external);
        let (gain, shift) = rate_in_space(model, &increment, &fixed, sight.as_ref());
        let rate = Rate {
            gain: &gain,
            shift: &shift,
        };
        let mut at = State {
            t: trial.to,
            u: guess.u.clone(),
            ..State::default()
        };
        let frames = sight.as_ref().map(|sight| &sight.all);
        let sought = Sought {
            model,
            frame,
            trial,
            constraints: &constraints,
            rate,
            sight: sight.as_ref(),
            scheme: now,
        };
        let (converged, internal) =
            scheme.balanced(sought, contact, solver, guess, &mut external, &mut at)?;
        let start = IncrementStart { frame, solver };
        let mut solved = scheme.solved(model, start, now, &converged, internal, at);
        solved.external = external;
        let inertia = in_motion(&solver.inertia);
        check_candidates(contact, &solver.conditions)?;
        let (easy, travel) = scheme.judge(model, frame, inertia, dt, &solved)?;
        scheme.locate(model, frame, contact, trial)?;
        let mut flow = scheme.flow(start, now, &fixed, impulse, &solved);
        if impulse {
            let end = ImpulseEnd {
                fixed: &fixed,
                dt,
                rate,
                frames,
            };
            flow.impact = scheme.end_impulse(model, frame, contact, solver, end, &mut solved)?;
        }
        let inertia = in_motion(&solver.inertia);
        Ok(Accepted {
            flow,
            rate: Some((gain, shift)),
            kinetic: inertia.kinetic_energy(&solved.state.v),
            strain: solver.bodies.energy(solved.deformed()),
            travel,
            hard: !easy,
            ..solved.accepted(&converged)
        })
    }

    /// An equilibrium as the end of an increment, with velocities and accelerations; without the loads.
    fn solved(
        &self,
        model: &Model,
        start: IncrementStart,
        scheme: IncrementScheme,
        converged: &Converged,
        internal: Vec<f64>,
        mut at: State,
    ) -> Solved {
        let IncrementStart { solver, .. } = start;
        let light = &in_motion(&solver.inertia).light;
        (at.v, at.a) = scheme.increment.motion(&at.u);
        for (a, _) in at.a.iter_mut().zip(light).filter(|(_, l)| **l) {
            *a = 0.0;
        }
        model.links.impose(&mut at.v);
        model.links.impose(&mut at.a);
        let [_, weight] = scheme.weights;
        let mut solved = Solved {
            reactions: converged.forces.iter().map(|f| weight * f).collect(),
            contact: converged.contact.clone(),
            external: Vec::new(),
            elastic: 0.0,
            internal,
            state: at,
        };
        let ends = [start.deformed(), solved.deformed()];
        solved.elastic = (solver.bodies).unstored_work(self.alphas.alpha_f, ends);
        solved
    }

    /// Finds the equilibrium at the stage, in passes where bodies turn freely: the forces there, and elastic ones at the end.
    fn balanced(
        &self,
        sought: Sought,
        contact: &mut Contact,
        solver: &mut Solver,
        mut guess: Guess,
        external: &mut Vec<f64>,
        at: &mut State,
    ) -> Result<(Converged, Vec<f64>), StepFailure> {
        let Sought {
            model,
            frame,
            trial,
            constraints,
            ..
        } = sought;
        for passes in 1.. {
            let balance = Balance {
                guess: &guess,
                constraints: constraints.clone(),
                rate: sought.rate,
                frames: sought.sight.map(|sight| &sight.all),
            };
            let found = self.solve(model, frame, contact, solver, balance, at)?;
            let Some(sight) = sought.sight else {
                return Ok(found);
            };
            sight.load(model, &at.u, trial.to, external);
            let start = IncrementStart { frame, solver };
            let next = self.guess(start, sought.scheme, at.u.clone(), external);
            let (_, diagonal, _) = in_motion(&solver.inertia).matrix();
            let end = Ended {
                forces: &next.forces,
                size: next.scale,
            };
            match sight.met(model, &found.0, end, &constraints.fixed, diagonal, passes)? {
                Some(converged) => return Ok((converged, next.internal)),
                None => guess = next,
            }
        }
        unreachable!("passes end")
    }

    /// Ends an increment in which masses meet: accelerations without the impulse, and velocities after it. What the impact takes `[J]`.
    fn end_impulse(
        &self,
        model: &Model,
        frame: &Frame,
        contact: &mut Contact,
        solver: &Solver,
        end: ImpulseEnd,
        solved: &mut Solved,
    ) -> Result<f64, StepFailure> {
        let inertia = in_motion(&solver.inertia);
        let (fixed, t) = (end.fixed, solved.state.t);
        let kick = kicked(model, inertia, fixed, &solved.contact)?;
        let part = 0.5 / self.alphas.beta - 1.0;
        let accelerations = solved.state.a.iter_mut().zip(&kick);
        accelerations.for_each(|(a, k)| *a += part * k);
        inertia.lead(model, contact, t, fixed, &mut solved.state.a);
        let at = solved.state.clone();
        let stage = Stage {
            from: &frame.state,
            at: &at,
            dt: end.dt,
            rate: Some(end.rate),
            frames: end.frames,
        };
        let mut forces = contact.forces(&frame.contacts, &solver.conditions);
        let (interfaces, v) = (&mut forces.interfaces, &mut solved.state.v);
        let impact = stop(model, inertia, fixed, interfaces, &stage, v)?;
        inertia.lead(model, contact, t, fixed, &mut solved.state.v);
        Ok(impact)
    }

    /// Whether Rayleigh damping acts.
    fn damped(&self) -> bool {
        self.purpose != Purpose::Onset { damped: false }
    }

    /// The matrix of an increment of this length.
    fn matrix(&self, dt: f64, weight: f64) -> IncrementMatrix {
        IncrementMatrix {
            alphas: self.alphas,
            dt,
            weight,
            damped: self.damped(),
        }
    }

    /// The scheme of an increment: that of masses that meet has `β = γ/2`, see [`super::impulse`].
    fn meeting(&self, impulse: bool) -> Implicit {
        let mut scheme = self.clone();
        if impulse {
            scheme.alphas.beta = 0.5 * scheme.alphas.gamma;
        }
        scheme
    }

    /// The weights that the forces of the interfaces at the start and at the end have in the balance at the stage. Of an impulse see [`super::impulse`].
    fn weights(&self, impulse: bool) -> [f64; 2] {
        let Alphas {
            alpha_m,
            alpha_f,
            beta,
            ..
        } = self.alphas;
        match self.dynamic.contact_at {
            _ if impulse => [0.0, (1.0 - alpha_m) / (2.0 * beta)],
            ContactAt::End => [0.0, 1.0],
            ContactAt::Stage => [1.0 - (1.0 - alpha_f), 1.0 - alpha_f],
        }
    }

    /// The forces where the increment is expected to end.
    fn guess(
        &self,
        start: IncrementStart,
        scheme: IncrementScheme,
        u: Vec<f64>,
        external: &[f64],
    ) -> Guess {
        let bodies = &start.solver.bodies;
        let internal = bodies.forces(&u);
        let end = Deformed {
            u: &u,
            forces: &internal,
        };
        let stage = bodies.stage_forces(self.alphas.alpha_f, [start.deformed(), end]);
        let (mut forces, scale) = self.balance(start, scheme, &u, &stage, external);
        let weight = scheme.weights[1];
        forces.iter_mut().for_each(|f| *f /= weight);
        Guess {
            u,
            internal,
            forces,
            scale: scale / weight,
        }
    }

    /// Finds the equilibrium at the stage; the forces there, and `K u` at the end.
    fn solve(
        &self,
        model: &Model,
        frame: &Frame,
        contact: &mut Contact,
        solver: &mut Solver,
        balance: Balance,
        at: &mut State,
    ) -> Result<(Converged, Vec<f64>), StepFailure> {
        let Balance {
            guess,
            constraints,
            rate,
            frames,
        } = balance;
        let fixed = constraints.fixed.clone();
        let condensed = in_motion::condense_in_motion(solver, model, frame, contact, &fixed);
        if let Some(broken) = solver.condenser.broken() {
            return Err(broken.clone());
        }
        let (_, diagonal, _) = in_motion(&solver.inertia).matrix();
        fit::fit(&mut contact.couplings, diagonal, &fixed, &model.links);
        let origin = Origin {
            at: guess.u.clone(),
            forces: guess.forces.clone(),
            scale: guess.scale,
        };
        let task = |load| Task {
            load,
            constraints,
            rate: Some(rate),
            frames,
            from: &frame.state,
            contacts: &frame.contacts,
            stoppable: self.purpose == Purpose::Analysis,
        };
        let mut converged = match condensed {
            true => {
                in_motion::solve_condensed(solver, model, contact, task(Load::Known(origin)), at)?
            }
            false => solver.solve_sparse(model, contact, task(Load::Known(origin)), at)?,
        };
        let moved = difference(&at.u, &guess.u);
        let change = solver.stiffness.times(&moved);
        if condensed {
            let stage = in_motion(&solver.inertia).stage_times(&moved, &change);
            converged.forces = (0..moved.len())
                .map(|i| guess.forces[i] + stage[i] + converged.contact[i])
                .collect();
            in_motion::check_in_motion(solver, model, &converged, guess.scale, &at.u, &fixed)?;
        }
        let both = guess.internal.iter().zip(&change);
        Ok((converged, both.map(|(a, b)| a + b).collect()))
    }

    /// Whether the increment is small enough for the errors that are to be resolved, `false` if only just, and the farthest the bodies have been.
    fn judge(
        &self,
        model: &Model,
        frame: &Frame,
        inertia: &Inertia,
        dt: f64,
        solved: &Solved,
    ) -> Result<(bool, f64), StepFailure> {
        check_change(model, pairs(&solved.state.u, &frame.state.u))?;
        let Some(limit) = self.dynamic.error else {
            return Ok((true, 0.0));
        };
        let norm = |x: &[f64]| dot(x, &inertia.mass_times(x)).max(0.0).sqrt();
        let moved = norm(&difference(&solved.state.u, &frame.motion.start));
        let travel = frame.motion.travel.max(moved);
        let turn = difference(&solved.state.a, &frame.state.a);
        let error = error_factor(self.alphas.beta) * dt * dt * norm(&turn);
        let relative = error / travel.max(f64::MIN_POSITIVE);
        if relative > limit && 0.5 * dt >= model.steps[frame.step].increments.smallest {
            return Err(StepFailure::new(
                Cause::TooFar,
                format!(
                    "local error {relative} of the motion, more than `error` allows",
                    relative = digits(relative, 2)
                ),
            ));
        }
        // It grows with the square of the increment: twice the length would be too much.
        Ok((relative <= 0.25 * limit, travel))
    }

    /// Rejects an increment over which points change status until it is as short as `events` asks for.
    fn locate(
        &self,
        model: &Model,
        frame: &Frame,
        contact: &Contact,
        trial: Trial,
    ) -> Result<(), StepFailure> {
        let Some(tolerance) = self.dynamic.events else {
            return Ok(());
        };
        let dt = trial.to - trial.from;
        let smallest = model.steps[frame.step].increments.smallest;
        let interfaces = contact.interfaces.iter().zip(&frame.contacts.interfaces);
        let switched: usize = interfaces.map(|(i, h)| look::switched(i, h)).sum();
        if switched > 0 && dt > tolerance && 0.5 * dt >= smallest {
            return Err(StepFailure::new(
                Cause::Event,
                format!("{switched} points open, close, stick or slip: the time is being located"),
            ));
        }
        Ok(())
    }

    /// The balance at the stage without the interfaces' forces at the end: forces with displacements `u` at the end and elastic forces `internal` at the
    /// stage, and the size of what balances in them.
    fn balance(
        &self,
        start: IncrementStart,
        scheme: IncrementScheme,
        u: &[f64],
        internal: &[f64],
        external: &[f64],
    ) -> (Vec<f64>, f64) {
        let IncrementStart { frame, solver } = start;
        let IncrementScheme {
            increment,
            weights: [old, _],
            spinning,
        } = scheme;
        let Alphas {
            alpha_m, alpha_f, ..
        } = self.alphas;
        let inertia = in_motion(&solver.inertia);
        let from = increment.from;
        let (v, a) = increment.motion(u);
        let mut a = weighted_mean(alpha_m, &from.a, &a);
        for (a, _) in a.iter_mut().zip(&inertia.light).filter(|(_, l)| **l) {
            *a = 0.0;
        }
        let mut inertial = inertia.mass_times(&a);
        let mut start = (Cow::Borrowed(&frame.load), Cow::Borrowed(&frame.contact));
        if !spinning.is_empty() {
            let momenta = [&from.v, &v].map(|v| inertia.mass_times(v));
            let ends = [(&from.v[..], &momenta[0][..]), (&v, &momenta[1])];
            spinning.add_gyroscopic(u, increment.dt, alpha_f, ends, &mut inertial);
            spinning.lean(u, start.0.to_mut());
            spinning.lean(u, start.1.to_mut());
        }
        let (load, contact) = start;
        let stage = weighted_mean(alpha_f, &from.u, u);
        let damping =
            solver.damping_force(self.damped(), &stage, &weighted_mean(alpha_f, &from.v, &v));
        let load = weighted_mean(alpha_f, &load, external);
        let forces = (0..u.len())
            .map(|i| inertial[i] + internal[i] + damping[i] - load[i] + old * contact[i])
            .collect();
        let size = |x: &[f64]| dot(x, x).sqrt();
        let scale = size(&inertial).max(size(&load)).max(size(internal));
        (forces, scale)
    }

    /// What flows in and out over the increment. With `Δ` for differences and bars for means of the two ends,
    ///
    /// ```text
    /// ΔT + ΔU = v̄ᵀ M Δv + ūᵀ K Δu
    /// ```
    ///
    /// and the balance at the stage times `Δu` gives what the scheme itself takes:
    ///
    /// ```text
    /// D = Δuᵀ M a_m - v̄ᵀ M Δv + (½ - α_f) (Δuᵀ K Δu + Δvᵀ C Δu) + (w - ½) ΔRᵀ Δu - (½ - α_f) ΔFᵀ Δu
    /// ```
    ///
    /// `w` is the weight of the interfaces' forces `R` at the end. For the trapezoidal rule it vanishes but for the last residual.
    fn flow(
        &self,
        start: IncrementStart,
        scheme: IncrementScheme,
        fixed: &[bool],
        impulse: bool,
        solved: &Solved,
    ) -> Flow {
        let IncrementStart { frame, solver } = start;
        let IncrementScheme {
            increment,
            weights: [_, weight],
            spinning,
        } = scheme;
        let alphas = self.alphas;
        let inertia = in_motion(&solver.inertia);
        let (from, to) = (&frame.state, &solved.state);
        let du = difference(&to.u, &from.u);
        let dv = difference(&to.v, &from.v);
        let mean_v: Vec<f64> = weighted_mean(0.5, &from.v, &to.v);
        let stage_a = weighted_mean(alphas.alpha_m, &increment.from.a, &to.a);
        let half = 0.5 - alphas.alpha_f;
        let mean_f = weighted_mean(0.5, &frame.load, &solved.external);
        let mut work = dot(&mean_f, &du);
        for (i, _) in fixed.iter().enumerate().filter(|(_, f)| **f) {
            work += solved.reactions[i] * du[i];
        }
        // Interfaces enter their work by the trapezoidal rule; all of that of an impulse is one mean force.
        let contact = match impulse {
            false => (weight - 0.5) * dot(&difference(&solved.contact, &frame.contact), &du),
            true => (weight - 1.0) * dot(&solved.contact, &du),
        };
        let load = difference(&solved.external, &frame.load);
        let mut inertial = inertia.mass_times(&stage_a);
        if !spinning.is_empty() {
            let momenta = [&from.v, &to.v].map(|v| inertia.mass_times(v));
            let ends = [(&from.v[..], &momenta[0][..]), (&to.v, &momenta[1])];
            let dt = to.t - from.t;
            spinning.add_gyroscopic(&to.u, dt, alphas.alpha_f, ends, &mut inertial);
        }
        let mut numerical =
            dot(&du, &inertial) - dot(&mean_v, &inertia.mass_times(&dv)) + solved.elastic + contact
                - half * dot(&load, &du);
        // As bodies lie at the stage.
        let stage = weighted_mean(alphas.alpha_f, &from.u, &to.u);
        let damped = dot(&du, &solver.damping_force(self.damped(), &stage, &mean_v));
        numerical += half * dot(&dv, &solver.damping_force(self.damped(), &stage, &du));
        Flow {
            work,
            damped,
            numerical,
            ..Flow::default()
        }
    }
}
