//! Explicit increments: central differences with lumped masses, no matrix and no equations.
//!
//! ```text
//! v½ = v₀ + dt/2 a₀,   u₁ = u₀ + dt v½,   a₁ = (F₁ - f(u₁) - C v½ - R(u₁)) / m,   v₁ = v½ + dt/2 a₁
//! ```

use std::sync::Arc;

use rayon::prelude::*;

use super::inertia::lumped;
use super::model::{Dynamic, Model};
use super::run::{Accepted, Flow, Simulation};
use super::spin::{Spin, mobility};
use crate::body::internal::{InternalForce, largest_eigenvalue};
use crate::error::{Error, RunError};
use crate::system::{Assembler, Cause, Constraints, Force, Stage, State, StepFailure, Tally};
use crate::time::Trial;
use crate::time::scheme::Method;

/// What explicit increments need beside the state.
pub(super) struct Explicit {
    internal: InternalForce,
    /// Masses and their inverses by dof; the inverse is zero where there is none, and at the points of rigid bodies what
    /// [`mobility`] says.
    mass: Vec<f64>,
    inverse: Vec<f64>,
    /// Rotations of rigid bodies, which have no mass among those by dof.
    spins: Vec<Spin>,
    /// Rayleigh factors by dof; empty without damping.
    rayleigh: Vec<[f64; 2]>,
    springs: Vec<(usize, f64)>,
    /// Square of the highest frequency of the bodies.
    frequency: f64,
    safety: f64,
    out: Assembler,
    force: Vec<f64>,
    /// Forces of Rayleigh damping, now and at the last accepted state; empty without damping.
    damped: Vec<f64>,
    damped_before: Vec<f64>,
    /// Supports, if they do not move in this step.
    still: Option<Arc<Constraints>>,
    /// Whether any load acts.
    loaded: bool,
}

/// Dofs that one task updates; fixed, so that sums do not depend on the number of threads.
const CHUNK: usize = 4096;

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
            rayleigh,
            springs,
            frequency,
            safety,
            out: Assembler::new(dofs.count()),
            force: vec![0.0; dofs.count()],
            damped: vec![0.0; dofs.count()],
            damped_before: vec![0.0; dofs.count()],
            still: None,
            loaded: true,
            mass,
        }
    }

    /// Works out the forces of Rayleigh damping at these velocities; those before are kept.
    fn damp(&mut self, v: &[f64]) {
        if self.rayleigh.is_empty() {
            return;
        }
        std::mem::swap(&mut self.damped, &mut self.damped_before);
        let scaled: Vec<f64> = self.rayleigh.iter().zip(v).map(|(r, v)| r[1] * v).collect();
        self.internal.apply(&scaled, &mut self.damped);
        for (i, d) in self.damped.iter_mut().enumerate() {
            *d += self.rayleigh[i][0] * self.mass[i] * v[i];
        }
    }

    /// The longest stable increment with interfaces of this squared frequency.
    fn stable(&self, contact: f64) -> f64 {
        let omega = (self.frequency + contact).sqrt();
        if omega == 0.0 {
            // rigid bodies in free flight
            return f64::INFINITY;
        }
        let stiffness = self.rayleigh.iter().fold(0.0_f64, |m, r| m.max(r[1]));
        let mass = self.rayleigh.iter().fold(0.0_f64, |m, r| m.max(r[0]));
        // damping lags by half an increment
        let ratio = 0.5 * (stiffness * omega + mass / omega);
        2.0 / omega * ((1.0 + ratio * ratio).sqrt() - ratio)
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
    for rigid in model.bodies.iter().filter_map(|b| b.rigid) {
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

impl Simulation {
    /// Masses, frequencies and the acceleration at the start of an explicit step.
    pub(super) fn start_explicit(&mut self, dynamic: &Dynamic) -> Result<(), Error> {
        let n = self.state.u.len();
        if self.state.v.is_empty() {
            self.state.v = vec![0.0; n];
        }
        let mut explicit = Explicit::new(&self.model, dynamic.method);
        let plain: f64 = masses(&self.model).iter().sum();
        let dim = self.model.dofs.dim;
        let scaled: f64 = explicit.mass.iter().step_by(dim).sum();
        self.summary.mass_added = (scaled - plain) / plain.max(f64::MIN_POSITIVE);
        let before = self.summary.energy.kinetic;
        self.model
            .apply_initial_velocities(self.step, &mut self.state.v);
        let energy = &mut self.summary.energy;
        energy.kinetic = explicit.kinetic_energy(&self.state.v);
        energy.initial += energy.kinetic - before;
        let step = self.model.steps[self.step].clone();
        let soon = step.start + super::dynamic::AFTER * (step.end - step.start);
        let still = self.model.supports.iter().all(|s| {
            !s.schedule.active(soon) || s.entries.iter().all(|e| e.hold || e.value == 0.0)
        });
        let constraints = self.constraints(soon);
        explicit.loaded = !self.model.loads.is_empty();
        for interface in &mut self.model.interfaces {
            self.summary.energy.initial += interface.use_springs(true);
        }
        let dt = self
            .stable_increment(&explicit)
            .min(step.increments.largest);
        if step.fixed
            && step.increments.initial > explicit.stable(self.contact_frequency(&explicit))
        {
            return Err(unstable(
                &step.name,
                self.state.t,
                step.increments.initial,
                explicit.stable(self.contact_frequency(&explicit)),
                step.end - step.start,
            )
            .into());
        }
        let stable = self.stable_increment(&explicit);
        self.summary.stable_increment = if stable.is_finite() { stable } else { 0.0 };
        self.load = self.external(soon);
        self.contact = self.initial_contact(soon, dt)?;
        explicit.internal.apply(&self.state.u, &mut explicit.force);
        let u = &self.state.u;
        for &(dof, k) in &explicit.springs {
            explicit.force[dof] += k * u[dof];
        }
        // Without a matrix the energy of initial displacements is known only now.
        let strain: f64 = 0.5
            * explicit
                .force
                .iter()
                .zip(u)
                .map(|(f, u)| f * u)
                .sum::<f64>();
        let energy = &mut self.summary.energy;
        energy.initial += strain - energy.strain;
        energy.strain = strain;
        self.model.links.transfer(&mut explicit.force);
        explicit.damp(&self.state.v);
        self.state.a = (0..n)
            .map(|i| match constraints.fixed[i] {
                true => 0.0,
                false => {
                    let internal = explicit.force[i] + explicit.damped[i];
                    explicit.inverse[i] * (self.load[i] - internal - self.contact[i])
                }
            })
            .collect();
        for spin in &explicit.spins {
            let range = spin.range();
            let mut moment = [0.0; 3];
            for (m, i) in moment.iter_mut().zip(range.clone()) {
                *m = self.load[i] - explicit.force[i] - self.contact[i];
            }
            let turn = spin.acceleration(moment, &constraints.fixed, [0.0; 3]);
            let dim = range.len();
            self.state.a[range].copy_from_slice(&turn[..dim]);
        }
        self.model.links.impose(&mut self.state.a);
        explicit.still = still.then(|| Arc::new(constraints));
        self.explicit = Some(explicit);
        Ok(())
    }

    fn contact_frequency(&self, explicit: &Explicit) -> f64 {
        let all = self.model.interfaces.iter();
        let links = &self.model.links;
        all.map(|i| i.highest_frequency(&explicit.inverse, links))
            .sum()
    }

    fn stable_increment(&self, explicit: &Explicit) -> f64 {
        explicit.safety * explicit.stable(self.contact_frequency(explicit))
    }

    /// The longest increment that is stable now, with its safety; `None` in a step that is not explicit or of given increments.
    pub(super) fn bound(&self) -> Option<f64> {
        let explicit = self.explicit.as_ref()?;
        (!self.model.steps[self.step].fixed).then(|| self.stable_increment(explicit))
    }

    /// One explicit increment.
    pub(super) fn attempt_explicit(&mut self, trial: Trial) -> Result<Accepted, StepFailure> {
        let Some(mut explicit) = self.explicit.take() else {
            return Err(StepFailure::new(Cause::NotFinite, "motion was not started"));
        };
        let outcome = self.leap(&mut explicit, trial);
        self.explicit = Some(explicit);
        outcome
    }

    fn leap(&mut self, explicit: &mut Explicit, trial: Trial) -> Result<Accepted, StepFailure> {
        let dt = trial.to - trial.from;
        let step = &self.model.steps[self.step];
        if step.fixed {
            let stable = explicit.stable(self.contact_frequency(explicit));
            if dt > stable * (1.0 + 1e-9) {
                let e = unstable(&step.name, trial.from, dt, stable, step.end - step.start);
                return Err(StepFailure {
                    help: e.help,
                    ..StepFailure::new(Cause::NotConverged, e.message)
                });
            }
        }
        let constraints = match &explicit.still {
            Some(still) => Arc::clone(still),
            None => Arc::new(self.constraints(trial.to)),
        };
        let from = &self.state;
        let n = from.u.len();
        let mut at = State {
            t: trial.to,
            u: vec![0.0; n],
            v: vec![0.0; n],
            a: vec![0.0; n],
        };
        at.u.par_chunks_mut(CHUNK)
            .zip(at.v.par_chunks_mut(CHUNK))
            .enumerate()
            .for_each(|(c, (u, v))| {
                let first = c * CHUNK;
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
        self.model.links.impose(&mut at.u);
        self.model.links.impose(&mut at.v);
        explicit.internal.apply(&at.u, &mut explicit.force);
        for &(dof, k) in &explicit.springs {
            explicit.force[dof] += k * at.u[dof];
        }
        self.model.links.transfer(&mut explicit.force);
        explicit.damp(&at.v);
        explicit.out.reset(false);
        let stage = Stage {
            from,
            at: &at,
            dt,
            rate: None,
        };
        for interface in &mut self.model.interfaces {
            interface.begin();
            interface.prepare(&stage)?;
            interface.assemble(&stage, &mut explicit.out)?;
        }
        self.model.links.transfer(&mut explicit.out.residual);
        let external = if explicit.loaded {
            self.external(trial.to)
        } else {
            std::mem::take(&mut self.load)
        };
        let load_before: &[f64] = if explicit.loaded {
            &self.load
        } else {
            &external
        };
        let mut forces = vec![0.0; n];
        let State { u, v, a, .. } = &mut at;
        let u: &[f64] = u;
        let Explicit {
            mass,
            inverse,
            force,
            damped,
            damped_before,
            out,
            ..
        } = &*explicit;
        let sums: Vec<Sums> = v
            .par_chunks_mut(CHUNK)
            .zip(a.par_chunks_mut(CHUNK))
            .zip(forces.par_chunks_mut(CHUNK))
            .enumerate()
            .map(|(c, ((v, a), r))| {
                let first = c * CHUNK;
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
                        sums.work += *r * moved;
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
        for spin in &explicit.spins {
            let range = spin.range();
            let mut moment = [0.0; 3];
            for (m, i) in moment.iter_mut().zip(range.clone()) {
                *m = external[i] - force[i] - out.residual[i];
            }
            let turn = spin.acceleration(moment, &constraints.fixed, spin.of(a));
            let inertial = spin.force(turn);
            let mut free = [spin.of(&from.a), turn];
            for (k, i) in range.enumerate() {
                if constraints.fixed[i] {
                    forces[i] += inertial[k];
                    total.work += inertial[k] * (u[i] - from.u[i]);
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
        total.finite &= total.kinetic.is_finite();
        self.model.links.impose(v);
        self.model.links.impose(a);
        if !total.finite {
            return Err(StepFailure::new(
                Cause::NotFinite,
                "the motion has grown beyond all numbers: the increment was not stable",
            )
            .help("lower `safety` of the scheme, or give a penalty that is less stiff"));
        }
        let mut tally = Tally::default();
        for t in self.model.interfaces.iter().filter_map(Force::tally) {
            tally.open += t.open;
            tally.stick += t.stick;
            tally.slip += t.slip;
        }
        Ok(Accepted {
            tally,
            contact: explicit.out.residual.clone(),
            forces,
            external,
            flow: Flow {
                work: total.work,
                damped: total.damped,
                // ΔT = Δuᵀ m ā + dt²/8 Δ(aᵀ m a)
                numerical: -dt * dt / 8.0 * (total.turned[1] - total.turned[0]),
            },
            kinetic: Some(0.5 * total.kinetic),
            strain: Some(0.5 * total.strain),
            state: at,
            ..Accepted::default()
        })
    }
}

fn unstable(step: &str, time: f64, dt: f64, stable: f64, duration: f64) -> RunError {
    RunError {
        message: format!(
            "step {step}: the increment {dt:.4e} is above the stable one, {stable:.4e}"
        ),
        time,
        culprits: Vec::new(),
        help: Some(format!(
            "use increments.fixed = {} or more, or leave `increments` out for automatic ones",
            (duration / (0.95 * stable)).ceil()
        )),
    }
}
