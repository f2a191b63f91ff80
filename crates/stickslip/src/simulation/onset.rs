//! The start of a dynamic step: masses, velocities, and the forces and accelerations from which the first increment goes on.

use super::dynamic::{Motion, difference};
use super::inertia::{Inertia, times};
use super::model::{ContactAt, Dynamic};
use super::run::Simulation;

use crate::body::couplings::Couplings;
use crate::error::Error;
use crate::math::vector::dot;
use crate::system::{Stage, State};
use crate::time::Trial;
use crate::time::scheme::Alphas;

/// Fraction of the duration of a step after its start at which loads that begin with the step are read.
pub(super) const AFTER: f64 = 1e-9;

/// Lengths of the trial increments that find the forces of contact at the start, in first increments.
const TRIALS: [f64; 2] = [0.1, 0.5];

/// Part of themselves by which these forces may differ between the two: those of an impact, which take the same momentum out of bodies in any
/// time, differ by four fifths.
const SUDDEN: f64 = 0.5;

/// The backward Euler method: no force of the start has a part in it.
const BACKWARD: Alphas = Alphas {
    alpha_m: 0.0,
    alpha_f: 0.0,
    beta: 1.0,
    gamma: 1.0,
};

impl Simulation {
    /// Makes masses and initial velocities of a dynamic step ready.
    pub(super) fn start_motion(&mut self, dynamic: &Dynamic) {
        let n = self.state.u.len();
        if self.state.v.is_empty() {
            self.state.v = vec![0.0; n];
        }
        self.state.a = vec![0.0; n];
        let suits = self
            .motion
            .as_ref()
            .is_some_and(|m| m.inertia.suits(&self.model, dynamic));
        let inertia = match self.motion.take() {
            Some(motion) if suits => motion.inertia,
            old => {
                let keys = old.map_or(0, |m| m.inertia.keys());
                Inertia::new(&self.model, &self.matrix, dynamic, keys)
            }
        };
        let masses = inertia.at_points(&self.model);
        for interface in &mut self.model.interfaces {
            interface.set_masses(&masses);
        }
        let before = inertia.kinetic_energy(&self.state.v);
        self.model
            .apply_initial_velocities(self.step, &mut self.state.v);
        let energy = &mut self.summary.energy;
        energy.kinetic = inertia.kinetic_energy(&self.state.v);
        energy.initial += energy.kinetic - before;
        self.motion = Some(Motion {
            inertia,
            internal: times(&self.matrix, &self.state.u),
            start: self.state.u.clone(),
            reach: 0.0,
        });
    }

    /// Finds the forces of the interfaces and the accelerations at the start of a dynamic step.
    pub(super) fn start_forces(&mut self, dynamic: &Dynamic, alphas: Alphas) -> Result<(), Error> {
        let step = &self.model.steps[self.step];
        let (t, dt) = (
            step.start + AFTER * (step.end - step.start),
            step.increments.initial,
        );
        self.load = self.external(t);
        let evaluated = self.initial_contact(t, dt)?;
        let before = std::mem::replace(&mut self.contact, evaluated);
        match self.tried_contact(dynamic, dt) {
            Some(contact) => self.contact = contact,
            None => self.keep_light(t, &before),
        }
        self.initial_acceleration(t, alphas.lag() * dt)
    }

    /// Forces of the interfaces at the start as the laws have them, slip at the velocities of the start. Where pressure or stick are multipliers the
    /// laws say nothing of them.
    pub(super) fn initial_contact(&mut self, t: f64, dt: f64) -> Result<Vec<f64>, Error> {
        let State { u, v, .. } = &self.state;
        let before = State {
            t: t - dt,
            u: u.iter().zip(v).map(|(u, v)| u - dt * v).collect(),
            ..State::default()
        };
        let at = State {
            t,
            u: u.clone(),
            ..State::default()
        };
        let stage = Stage {
            from: &before,
            at: &at,
            dt,
            rate: None,
        };
        let mut contact = vec![0.0; u.len()];
        for interface in &mut self.model.interfaces {
            interface
                .add_initial(&stage, &mut contact)
                .map_err(|e| e.at(t))?;
        }
        (self.model.couplings).add_initial(t, &self.state.u, &mut contact);
        self.model.links.transfer(&mut contact);
        Ok(contact)
    }

    /// Whether points with mass touch where the laws alone do not tell the forces: a multiplier presses them, or they are those of a rigid body and
    /// may stick.
    fn forces_are_sought(&self, t: f64) -> bool {
        let Some(motion) = &self.motion else {
            return false;
        };
        let links = &self.model.links;
        self.model.interfaces.iter().any(|interface| {
            let first = |node: &usize| self.model.dofs.of(*node, 0);
            let rigid = || interface.nodes.iter().any(|n| links.of_point(*n).is_some());
            let heavy = || {
                interface
                    .nodes
                    .iter()
                    .any(|n| !motion.inertia.light[first(n)])
            };
            let laws = &interface.laws;
            let sought = laws.needs_normal_stiffness() && heavy()
                || laws.friction_law().frictional() && rigid();
            interface.schedule.active(t) && sought && interface.touches()
        })
    }

    /// The forces of the interfaces at the end of a short increment with the method of Euler: pressure holds what would go through, points stick that
    /// the limit holds and others carry it. `None` where nothing touches, where no equilibrium is found, and at an impact, whose force is not that of
    /// an instant.
    fn tried_contact(&mut self, dynamic: &Dynamic, dt: f64) -> Option<Vec<f64>> {
        let t = self.state.t;
        if !self.forces_are_sought(t + AFTER * dt) {
            return None;
        }
        let quiet = Dynamic {
            contact_at: ContactAt::End,
            error: None,
            events: None,
            ..*dynamic
        };
        let couplings = self.model.couplings.memory.clone();
        let tried = TRIALS.map(|part| {
            let trial = Trial {
                from: t,
                to: t + part * dt,
            };
            let tried = self.attempt_implicit(trial, &quiet, BACKWARD, &mut []);
            let tried = tried.map(|accepted| {
                let (to, u) = (trial.to, &accepted.state.u);
                let coupled = self.coupling_forces(|c, out| c.add_tried(to, u, out));
                difference(&accepted.contact, &coupled)
            });
            self.model.couplings.memory = couplings.clone();
            let interfaces = self.model.interfaces.iter();
            let after: Vec<_> = interfaces.map(|i| i.tried()).collect();
            tried.map(|contact| (contact, after))
        });
        let [Ok((short, after)), Ok((long, _))] = tried else {
            return None;
        };
        let change = difference(&short, &long);
        if dot(&change, &change) > SUDDEN * SUDDEN * dot(&short, &short) {
            return None;
        }
        for (interface, tried) in self.model.interfaces.iter_mut().zip(&after) {
            interface.adopt(tried);
        }
        let (u, at) = (&self.state.u, t + AFTER * dt);
        let known = self.coupling_forces(|c, out| c.add_initial(at, u, out));
        Some(short.iter().zip(known).map(|(a, b)| a + b).collect())
    }

    /// Forces of couplings by dof, those at rigid bodies where they move them.
    fn coupling_forces(&self, add: impl Fn(&Couplings, &mut [f64])) -> Vec<f64> {
        let mut out = vec![0.0; self.state.u.len()];
        add(&self.model.couplings, &mut out);
        self.model.links.transfer(&mut out);
        out
    }

    /// Points without mass go on with the forces that they had at rest.
    fn keep_light(&mut self, t: f64, before: &[f64]) {
        let Some(motion) = &self.motion else {
            return;
        };
        if before.len() != self.contact.len() {
            return;
        }
        let acting = self
            .model
            .interfaces
            .iter()
            .filter(|i| i.schedule.active(t));
        for node in acting.flat_map(|i| &i.nodes) {
            for i in 0..self.model.dofs.dim {
                let dof = self.model.dofs.of(*node, i);
                if motion.inertia.light[dof] {
                    self.contact[dof] = before[dof];
                }
            }
        }
    }

    /// `(M + h C) a₀ = f(u₀, v₀)`, with the time `h` over which damping may have acted.
    fn initial_acceleration(&mut self, t: f64, lag: f64) -> Result<(), Error> {
        let Some(motion) = &self.motion else {
            return Ok(());
        };
        let inertia = &motion.inertia;
        let internal = &motion.internal;
        let damping = inertia.damping_force(&self.state.v);
        let force: Vec<f64> = (0..internal.len())
            .map(|i| self.load[i] - internal[i] - damping[i] - self.contact[i])
            .collect();
        let fixed = self.constraints(t).fixed;
        let mut accelerate = inertia.accelerator(&fixed, lag);
        self.state.a = accelerate(&force).map_err(|e| e.at(t))?;
        // Prescribed dofs have no acceleration, which is as good as known; those of light points follow from the interfaces.
        self.model
            .couplings
            .start_motion(
                (t, &self.model.links),
                &inertia.light,
                &mut accelerate,
                (&mut self.state.a, &mut self.contact),
            )
            .map_err(|e| e.at(t))?;
        self.model.links.impose(&mut self.state.a);
        Ok(())
    }
}
