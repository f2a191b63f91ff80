//! Explicit increments: central differences with lumped masses, no matrix and no equations.
//!
//! ```text
//! v½ = v₀ + dt/2 a₀,   u₁ = u₀ + dt v½,   a₁ = (F₁ - f(u₁) - C v½ - R(u₁)) / m,   v₁ = v½ + dt/2 a₁
//! ```

use std::any::Any;
use std::sync::Arc;

use super::exact::{Exact, Mobility};
use super::integrator::Integrator;
use super::onset::{JUST_AFTER, initial_contact, look_at_contact};
use crate::body::couplings::explicit;
use crate::body::internal::{InternalForce, largest_eigenvalue};
use crate::contact::interface::{Conditions, History, Interface, use_springs};
use crate::contact::look;
use crate::error::{Error, RunError};
use crate::math::vector::dot;
use crate::model::contact::Contact;
use crate::model::definition::{Dynamic, Model};
use crate::model::frame::Frame;
use crate::number::digits;
use crate::solve::inertia::lumped;
use crate::solve::spin::{Spin, mobility};
use crate::system::{Assembler, Constraints, IncrementalRotation};
use crate::time::scheme::Method;

/// How fast interfaces and couplings let masses swing.
#[derive(Clone, Copy, Default)]
pub(crate) struct ContactFrequency {
    /// Sum of the highest squared frequencies `[1/s²]`.
    pub squared: f64,
    /// Sum of the rates at which they take velocity away `[1/s]`.
    pub rate: f64,
}

/// Rayleigh damping.
pub(crate) struct RayleighDamping {
    /// Factors by dof; empty without damping.
    pub(crate) factors: Vec<[f64; 2]>,
    /// Forces now, and at the last accepted state.
    pub(crate) forces: Vec<f64>,
    pub(crate) before: Vec<f64>,
}

/// What is said of explicit increments when they begin.
#[derive(Debug, Clone, Copy, Default, crate::keep::Keep)]
pub(crate) struct Begun {
    /// Mass added by mass scaling, relative to the mass there is.
    pub mass_added: f64,
    /// Longest stable increment, with its safety; 0 where any is stable.
    pub stable: f64,
}

/// What explicit increments need beside the state.
pub(crate) struct Explicit {
    pub(crate) internal: InternalForce,
    /// Masses and their inverses by dof; the inverse is zero where there is none, and at the points of rigid bodies what
    /// [`mobility`] says.
    pub(crate) mass: Vec<f64>,
    pub(crate) inverse: Vec<f64>,
    /// Rotations of rigid bodies, which have no mass among those by dof.
    pub(crate) spins: Vec<Spin>,
    pub(crate) damping: RayleighDamping,
    pub(crate) springs: Vec<(usize, f64)>,
    /// Square of the highest frequency of the bodies.
    pub(crate) frequency: f64,
    pub(crate) safety: f64,
    pub(crate) out: Assembler,
    pub(crate) force: Vec<f64>,
    /// Twice the strain energy, where bodies have frames of their own: it is no product of forces and displacements.
    pub(crate) stored: Option<f64>,
    /// Supports, if they do not move in this step.
    pub(crate) still: Option<Arc<Constraints>>,
    /// What is said of it when it begins.
    pub begun: Begun,
    /// Whether any load acts.
    pub(crate) loaded: bool,
    /// What is held exactly, at the last accepted state and after the attempt.
    pub(super) exact: Exact,
    pub(super) exact_after: Exact,
}

/// What explicit increments need, where an integrator makes these.
pub(crate) fn explicit(integrator: &dyn Integrator) -> Option<&Explicit> {
    (integrator as &dyn Any).downcast_ref()
}

impl Explicit {
    pub fn new(model: &Model, method: Method) -> Self {
        let Method::Explicit {
            safety,
            mass_scaling,
        } = method
        else {
            unreachable!("an implicit method");
        };
        let dofs = model.dofs;
        let bodies: Vec<_> = model.elastic().map(|b| &b.elastic).collect();
        let mut internal = InternalForce::new(&bodies, dofs);
        let mut mass: Vec<f64> = masses(model)
            .into_iter()
            .flat_map(|m| std::iter::repeat_n(m, dofs.dim))
            .collect();
        if let Some(step) = mass_scaling {
            scale_masses(model, &mut mass, step / (2.0 * safety));
        }
        let mut rayleigh = Vec::new();
        if model.bodies.iter().any(|b| b.rayleigh != [0.0; 2]) {
            rayleigh = vec![[0.0; 2]; dofs.count()];
            for body in &model.bodies {
                for point in body.points.clone() {
                    for i in 0..dofs.dim {
                        rayleigh[dofs.of(point, i)] = body.rayleigh;
                    }
                }
            }
        }
        let springs: Vec<(usize, f64)> = model
            .actions
            .springs
            .iter()
            .flat_map(|s| s.entries().iter().copied())
            .collect();
        let none = vec![false; dofs.count()];
        let mut inverse: Vec<f64> = mass
            .iter()
            .map(|&m| if m > 0.0 { 1.0 / m } else { 0.0 })
            .collect();
        for (inverses, m) in inverse.chunks_exact_mut(dofs.dim).zip(mobility(model)) {
            if m > 0.0 {
                inverses.fill(m);
            }
        }
        let stiffest = stiffest(model, &springs, &inverse);
        let frequency = largest_eigenvalue(&mut internal, &mass, &none) + stiffest;
        Explicit {
            inverse,
            spins: Spin::all(model),
            internal,
            damping: RayleighDamping {
                factors: rayleigh,
                forces: vec![0.0; dofs.count()],
                before: vec![0.0; dofs.count()],
            },
            springs,
            frequency,
            safety,
            out: Assembler::new(dofs.count()),
            force: vec![0.0; dofs.count()],
            stored: None,
            still: None,
            begun: Begun::default(),
            loaded: true,
            exact: Exact::default(),
            exact_after: Exact::default(),
            mass,
        }
    }

    /// Works out the forces of Rayleigh damping at these velocities.
    pub(crate) fn damp(&mut self, model: &Model, u: &[f64], v: &[f64]) {
        let RayleighDamping {
            factors, forces, ..
        } = &mut self.damping;
        if factors.is_empty() {
            return;
        }
        let (internal, mass) = (&mut self.internal, &self.mass);
        let matrix = |v: &[f64], forces: &mut [f64]| {
            let scaled: Vec<f64> = factors.iter().zip(v).map(|(r, v)| r[1] * v).collect();
            internal.apply(&scaled, forces);
            for (i, d) in forces.iter_mut().enumerate() {
                *d += factors[i][0] * mass[i] * v[i];
            }
        };
        model.corotations.damping(u, v, matrix, forces);
    }

    /// Works out the forces of bodies and springs at these displacements.
    pub(crate) fn resist(&mut self, model: &Model, u: &[f64]) {
        let bodies = &model.corotations;
        if bodies.is_empty() {
            self.internal.apply(u, &mut self.force);
        } else {
            let springs = self.springs.iter().map(|&(dof, k)| k * u[dof] * u[dof]);
            let springs: f64 = springs.sum();
            let (internal, stored) = (&mut self.internal, &mut self.stored);
            let apply = |local: &[f64], forces: &mut [f64]| {
                internal.apply(local, forces);
                *stored = Some(dot(local, forces) + springs);
            };
            bodies.forces(u, apply, &mut self.force);
        }
        for &(dof, k) in &self.springs {
            self.force[dof] += k * u[dof];
        }
    }

    /// The longest stable increment with interfaces of this squared frequency that take velocity away at this rate.
    pub(crate) fn stable(&self, contact: ContactFrequency) -> f64 {
        let ContactFrequency { squared, rate } = contact;
        let omega = (self.frequency + squared).sqrt();
        if omega == 0.0 {
            // rigid bodies in free flight
            return match rate > 0.0 {
                true => 2.0 / rate,
                false => f64::INFINITY,
            };
        }
        let stiffness = self
            .damping
            .factors
            .iter()
            .fold(0.0_f64, |m, r| m.max(r[1]));
        let mass = self
            .damping
            .factors
            .iter()
            .fold(0.0_f64, |m, r| m.max(r[0]));
        // damping lags by half an increment
        let ratio = 0.5 * (stiffness * omega + (mass + rate) / omega);
        2.0 / omega / ((1.0 + ratio * ratio).sqrt() + ratio)
    }

    /// Angular momenta by dof of rigid bodies with spins `v`, along the axes of the bodies.
    pub(crate) fn angular(&self, v: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; v.len()];
        for spin in &self.spins {
            let range = spin.range();
            let own = spin.force(spin.of(v));
            let size = range.len();
            out[range].copy_from_slice(&own[..size]);
        }
        out
    }

    pub fn kinetic_energy(&self, v: &[f64]) -> f64 {
        let moved: f64 = self.mass.iter().zip(v).map(|(m, v)| m * v * v).sum();
        let turned: f64 = self.spins.iter().map(|s| s.square(s.of(v))).sum();
        0.5 * (moved + turned)
    }
}

/// Lumped masses of elastic bodies and those of rigid ones, by point.
fn masses(model: &Model) -> Vec<f64> {
    let mut masses = lumped(model);
    for rigid in model.rigid() {
        masses[model.links.all()[rigid.link].hidden] += rigid.mass;
    }
    masses
}

/// The highest squared frequency of springs to ground: of each on its own, and of all on a rigid body together.
fn stiffest(model: &Model, springs: &[(usize, f64)], inverse: &[f64]) -> f64 {
    let mut highest = 0.0_f64;
    let mut rigid = vec![0.0; model.links.all().len()];
    for &(dof, k) in springs {
        match model.links.of_point(model.dofs.locate(dof).0) {
            None => highest = highest.max(k * inverse[dof]),
            Some(body) => rigid[body] += k * inverse[dof],
        }
    }
    rigid.into_iter().fold(highest, f64::max)
}

/// Raises masses until the frequency of every dof, by the sum of its row of the stiffness, allows increments of `2 half`.
fn scale_masses(model: &Model, mass: &mut [f64], half: f64) {
    let dim = model.dofs.dim;
    let mut rows = vec![0.0; mass.len()];
    for body in model.elastic() {
        body.elastic.element_matrices(&mut |points, dense| {
            let width = points.len() * dim;
            for (a, row) in dense.chunks_exact(width).enumerate() {
                let dof = points[a / dim] * dim + a % dim;
                rows[dof] += row.iter().map(|k| k.abs()).sum::<f64>();
            }
        });
    }
    for (masses, rows) in mass.chunks_exact_mut(dim).zip(rows.chunks_exact(dim)) {
        let largest = rows.iter().copied().fold(0.0, f64::max);
        for m in masses {
            *m = m.max(half * half * largest);
        }
    }
}

impl Explicit {
    /// Begins an explicit step: masses, frequencies and the acceleration at the start.
    pub fn begin(
        model: &Model,
        frame: &mut Frame,
        contact: &mut Contact,
        conditions: &[Conditions],
        dynamic: &Dynamic,
    ) -> Result<Self, Error> {
        let n = frame.state.u.len();
        if frame.state.v.is_empty() {
            frame.state.v = vec![0.0; n];
        }
        let mut explicit = Explicit::new(model, dynamic.method);
        let plain: f64 = masses(model).iter().sum();
        let scaled: f64 = explicit.mass.iter().step_by(model.dofs.dim).sum();
        explicit.begun.mass_added = (scaled - plain) / plain.max(f64::MIN_POSITIVE);
        let before = frame.ledger.kinetic;
        model.apply_initial_velocities(frame.step, &mut frame.state.v);
        let energy = &mut frame.ledger;
        energy.kinetic = explicit.kinetic_energy(&frame.state.v);
        energy.initial += energy.kinetic - before;
        let step = &model.steps[frame.step];
        let soon = step.start + JUST_AFTER * (step.end - step.start);
        let still = model.actions.supports.iter().all(|s| {
            !s.schedule.active(soon) || s.entries.iter().all(|e| e.hold || e.value == 0.0)
        });
        let constraints = frame.constraints(model, soon);
        explicit.loaded = !model.actions.loads.is_empty() || model.actions.heat.is_some();
        let contacts = Arc::make_mut(&mut frame.contacts);
        for (interface, history) in contact.interfaces.iter_mut().zip(&mut contacts.interfaces) {
            frame.ledger.initial += use_springs(interface, history, true);
        }
        let (couplings, memory) = (&mut contact.couplings, &mut contacts.couplings);
        explicit::use_springs(couplings, memory, true);
        explicit::start_explicit(couplings, memory, frame.state.t, &frame.state.u);
        explicit::fit_springs(
            couplings,
            soon,
            explicit.frequency,
            &explicit.inverse,
            &model.links,
        );
        // What is in contact already bounds the first increment, too: the last evaluation, if there was one, was of other laws and multipliers.
        let alone = explicit.stable_alone().min(step.increments.largest);
        look_at_contact(model, frame, contact, conditions, soon, alone);
        let stable = explicit.stable_increment(model, frame, contact);
        let dt = stable.min(step.increments.largest);
        let limit = explicit.stable(explicit.contact_frequency(model, frame, contact));
        let given = step.increments.initial;
        if step.fixed && given > limit {
            let t = frame.state.t;
            return Err(unstable(&step.name, t, given, limit, step.end - step.start).into());
        }
        explicit.begun.stable = if stable.is_finite() { stable } else { 0.0 };
        frame.load = frame.external(model, soon);
        frame.contact =
            initial_contact(model, frame, contact, conditions, soon, dt).map_err(|e| e.at(soon))?;
        explicit.start_forces(model, frame, contact);
        explicit.start_acceleration(model, frame, &constraints);
        explicit.start_exactly(model, frame, contact, &constraints)?;
        let RayleighDamping { forces, before, .. } = &mut explicit.damping;
        before.clone_from(forces);
        explicit.still = still.then(|| Arc::new(constraints));
        Ok(explicit)
    }

    /// Elastic and damping forces at the start, and the strain energy there.
    fn start_forces(&mut self, model: &Model, frame: &mut Frame, contact: &Contact) {
        let u = &frame.state.u;
        self.resist(model, u);
        // Without a matrix the energy of initial displacements is known only now.
        let both = self.force.iter().zip(u);
        let strain: f64 = both.map(|(f, u)| f * u).sum();
        let strain = 0.5 * self.stored.unwrap_or(strain);
        let energy = &mut frame.ledger;
        let strain = strain
            + contact.couplings.view(&frame.contacts.couplings).stored()
            + energy.entered.thermal;
        energy.initial += strain - energy.strain;
        energy.strain = strain;
        model.links.transfer(&mut self.force);
        self.damp(model, &frame.state.u, &frame.state.v);
    }

    /// Accelerations at the start, and what holds the dofs that have none.
    fn start_acceleration(&self, model: &Model, frame: &mut Frame, constraints: &Constraints) {
        let (load, contact) = (&frame.load, &frame.contact);
        let balance = |i: usize| load[i] - (self.force[i] + self.damping.forces[i]) - contact[i];
        let fixed = constraints.fixed.iter().enumerate();
        let (mut a, forces): (Vec<f64>, Vec<f64>) = fixed
            .map(|(i, fixed)| match fixed {
                true => (0.0, -balance(i)),
                false => (self.inverse[i] * balance(i), 0.0),
            })
            .unzip();
        let spinning = IncrementalRotation::new(&model.frames, &frame.state.u);
        let mut moments: Vec<f64> = (0..load.len())
            .map(|i| load[i] - self.force[i] - contact[i])
            .collect();
        spinning.to_body_axes(&mut moments);
        if !spinning.is_empty() {
            let v = &frame.state.v;
            spinning.add_steady(-1.0, (v, &self.angular(v)), &mut moments);
        }
        for spin in &self.spins {
            let range = spin.range();
            let moment = spin.of(&moments);
            let turn = spin.acceleration(moment, &constraints.fixed, [0.0; 3]);
            let dim = range.len();
            a[range].copy_from_slice(&turn[..dim]);
        }
        model.links.impose(&mut a);
        frame.state.a = a;
        frame.forces = forces;
    }

    /// Lets all that is held exactly go along with the accelerations at the start.
    fn start_exactly(
        &mut self,
        model: &Model,
        frame: &mut Frame,
        contact: &mut Contact,
        constraints: &Constraints,
    ) -> Result<(), Error> {
        let step = &model.steps[frame.step];
        let soon = step.start + JUST_AFTER * (step.end - step.start);
        let gathered = Exact::gather(model, frame, contact, soon, &Exact::default());
        if gathered.is_empty() {
            return Ok(());
        }
        let (mut exact, acting) = gathered.begin();
        let found = exact.balance(&self.mobility(constraints), &frame.state.a);
        found.map_err(|e| e.at(soon))?;
        let mut more = Assembler::new(frame.contact.len());
        exact.act(&Exact::default(), &[], contact, &model.links, &mut more);
        let none = vec![0.0; more.residual.len()];
        IncrementalRotation::new(&model.frames, &frame.state.u).outward(&none, &mut more.residual);
        for (contact, f) in frame.contact.iter_mut().zip(&more.residual) {
            *contact += f;
        }
        exact.add_forces(&acting);
        exact.act(&Exact::default(), &[], contact, &model.links, &mut more);
        let memory = &mut Arc::make_mut(&mut frame.contacts).couplings;
        explicit::start_exactly(&contact.couplings, memory);
        self.start_acceleration(model, frame, constraints);
        self.exact = exact;
        Ok(())
    }

    /// How dofs give way where supports are these.
    pub(super) fn mobility<'a>(&'a self, constraints: &'a Constraints) -> Mobility<'a> {
        Mobility {
            inverse: &self.inverse,
            fixed: &constraints.fixed,
            spins: &self.spins,
        }
    }

    /// Sums of the highest squared frequencies of interfaces and couplings now, and of the rates at which interfaces take velocity away.
    pub fn contact_frequency(
        &self,
        model: &Model,
        frame: &Frame,
        contact: &Contact,
    ) -> ContactFrequency {
        let step = &model.steps[frame.step];
        let all = contact.interfaces.iter().zip(&frame.contacts.interfaces);
        let links = &model.links;
        let of = |(i, history): (&Interface, &History)| {
            let squared = look::highest_frequency(i, history, &self.inverse, links);
            (squared, look::highest_rate(i, &self.inverse, links))
        };
        let (squared, rate) = all.map(of).fold((0.0, 0.0), |s, i| (s.0 + i.0, s.1 + i.1));
        let t = frame.state.t + JUST_AFTER * (step.end - step.start);
        let couplings = explicit::highest_frequency(&contact.couplings, t, &self.inverse, links);
        let dashpots = explicit::highest_rate(&contact.couplings, t, &self.inverse, links);
        ContactFrequency {
            squared: squared + couplings,
            rate: rate + dashpots,
        }
    }

    /// The longest increment that is stable where nothing touches, with its safety.
    pub fn stable_alone(&self) -> f64 {
        self.safety * self.stable(ContactFrequency::default())
    }

    /// The longest increment that is stable now, with its safety.
    pub fn stable_increment(&self, model: &Model, frame: &Frame, contact: &Contact) -> f64 {
        self.safety * self.stable(self.contact_frequency(model, frame, contact))
    }
}

pub(crate) fn unstable(step: &str, time: f64, dt: f64, stable: f64, duration: f64) -> RunError {
    RunError {
        message: format!(
            "step {step}: the increment {dt} is above the stable one, {stable}",
            dt = digits(dt, 5),
            stable = digits(stable, 5)
        ),
        time,
        culprits: Vec::new(),
        help: Some(format!(
            "use increments.fixed = {} or more, or leave `increments` out for automatic ones",
            (duration / (0.95 * stable)).ceil()
        )),
    }
}

/// What explicit increments take along.
#[derive(Debug, Clone, crate::keep::Keep)]
pub(crate) struct ExplicitState {
    damped: Vec<f64>,
    damped_before: Vec<f64>,
    still: Option<Arc<Constraints>>,
    begun: Begun,
    loaded: bool,
    exact: Exact,
}

impl Explicit {
    /// What it takes along.
    pub fn state(&self) -> ExplicitState {
        ExplicitState {
            damped: self.damping.forces.clone(),
            damped_before: self.damping.before.clone(),
            still: self.still.clone(),
            begun: self.begun,
            loaded: self.loaded,
            exact: self.exact.clone(),
        }
    }

    /// Goes on with that.
    pub fn again(model: &Model, method: Method, state: ExplicitState) -> Self {
        let explicit = Explicit::new(model, method);
        Explicit {
            damping: RayleighDamping {
                forces: state.damped,
                before: state.damped_before,
                ..explicit.damping
            },
            still: state.still,
            begun: state.begun,
            loaded: state.loaded,
            exact: state.exact,
            ..explicit
        }
    }
}
