//! What acts at a time: supports, and loads with the fading forces of supports that let go.

use std::sync::Arc;

use super::contact::Contact;
use super::definition::{Model, Support};
use super::frame::Frame;
use crate::body::couplings::StepTimes;
use crate::model::thermal;
use crate::system::Constraints;

impl Frame {
    /// Begins the step that is set: exchanges the laws that change, and remembers from where supports that begin to act start, and with which
    /// force those that end let go.
    pub(crate) fn begin_step(&mut self, model: &Model, contact: &mut Contact) {
        let step = &model.steps[self.step];
        contact.change_laws(&self.contacts, step, |energy| self.ledger.initial += energy);
        contact.begin_law_states(&mut self.contacts, step);
        let middle = 0.5 * (step.start + step.end);
        let before = self.step.checked_sub(1).map(|i| {
            let s = &model.steps[i];
            0.5 * (s.start + s.end)
        });
        let was = |s: &Support| before.is_some_and(|t| s.schedule.active(t));
        let mut supported = vec![false; self.state.u.len()];
        for support in &model.actions.supports {
            if support.schedule.active(middle) {
                for e in &support.entries {
                    supported[e.dof] = true;
                }
                if !was(support) {
                    let entries = support.entries.iter();
                    let start = entries.map(|e| self.state.u[e.dof]).collect();
                    self.starts.insert(support.name.clone(), start);
                }
            }
        }
        self.course.forget();
        self.released.clear();
        let links = &model.links;
        let released = &mut self.released;
        let mut let_go = |dof: usize, force: f64| match links.row(dof) {
            None => released.push((dof, force)),
            Some(row) => released.extend(row.map(|(d, factor)| (d, factor * force))),
        };
        let times = StepTimes { before, middle };
        let memory = &mut Arc::make_mut(&mut self.contacts).couplings;
        (contact.couplings).begin_step(memory, times, &self.state.u, &mut let_go);
        if step.dynamic.is_some() {
            // In motion what lets go lets go at once.
            self.released.clear();
            return;
        }
        // What equations did, loads do from here on.
        for &(dof, force) in &self.released {
            self.load[dof] += force;
        }
        let mut seen = vec![false; self.state.u.len()];
        for support in model.actions.supports.iter().filter(|s| was(s)) {
            for e in &support.entries {
                if !supported[e.dof] && !seen[e.dof] {
                    seen[e.dof] = true;
                    self.released.push((e.dof, self.forces[e.dof]));
                }
            }
        }
    }

    /// Constraints at a time.
    pub(crate) fn constraints(&self, model: &Model, t: f64) -> Constraints {
        let mut constraints = Constraints::none(model.dofs);
        for support in &model.actions.supports {
            if !support.schedule.active(t) {
                continue;
            }
            let s = support.schedule.at(t);
            let held = self.starts.get(&support.name);
            for (i, e) in support.entries.iter().enumerate() {
                let start = held.and_then(|h| h.get(i)).copied().unwrap_or(0.0);
                let value = if e.hold {
                    start
                } else if support.table {
                    s * e.value
                } else {
                    start + s * (e.value - start)
                };
                constraints.prescribe(e.dof, value);
            }
        }
        for still in model.references.iter().flat_map(|r| r.still.get(self.step)) {
            for &dof in still {
                constraints.prescribe(dof, self.state.u[dof]);
            }
        }
        model.links.dependent(&mut constraints.fixed);
        constraints
    }

    /// Displacements at a time as far as they are known: what is prescribed, and `u`.
    fn expected(&self, model: &Model, t: f64, u: &[f64]) -> Vec<f64> {
        let mut u = u.to_vec();
        self.constraints(model, t).impose(&mut u);
        u
    }

    /// External forces at a time and what temperatures press with, which acts like them.
    pub(crate) fn external(&self, model: &Model, t: f64) -> Vec<f64> {
        self.external_at(model, t, &self.state.u)
    }

    /// The same where bodies that turn are where displacements have led them.
    pub(crate) fn external_at(&self, model: &Model, t: f64, u: &[f64]) -> Vec<f64> {
        let mut external = self.loads_at(model, t, u);
        self.add_thermal_forces(model, t, 1.0, &mut external);
        external
    }

    /// Adds so many times what temperatures at a time and second fields press with to `out` `[N]`, by dof.
    pub(crate) fn add_thermal_forces(&self, model: &Model, t: f64, times: f64, out: &mut [f64]) {
        thermal::add_thermal_forces(model, t, times, out);
        for (field, values) in model.actions.fields.iter().zip(&self.fields) {
            field.add_forces(values, times, out);
        }
    }

    /// External forces at a time, with the fading forces of supports that let go in this step; those on the points of rigid bodies act on
    /// the bodies. They move bodies as wholes: what temperatures press with has no resultant but rounding.
    pub(crate) fn loads(&self, model: &Model, t: f64) -> Vec<f64> {
        self.loads_at(model, t, &self.state.u)
    }

    fn loads_at(&self, model: &Model, t: f64, u: &[f64]) -> Vec<f64> {
        let mut external = vec![0.0; self.state.u.len()];
        for load in model.actions.loads.iter().filter(|l| !l.follows) {
            load.external(t, &mut external);
        }
        if !model.frames.is_empty() {
            let (points, u) = (&model.mesh.points, self.expected(model, t, u));
            model.frames.transfer(points, &u, &mut external);
        }
        let mut following = model.actions.loads.iter().filter(|l| l.follows).peekable();
        if model.corotations.is_empty() {
            let (mesh, space) = (&*model.mesh, model.space);
            following.for_each(|load| load.external_at(t, mesh, space, u, &mut external));
        } else if following.peek().is_some() {
            let mut own = vec![0.0; external.len()];
            following.for_each(|load| load.external(t, &mut own));
            (model.corotations).turn_out(&model.corotations.turns(u), &mut own);
            external.iter_mut().zip(own).for_each(|(e, own)| *e += own);
        }
        model.links.transfer(&mut external);
        let step = &model.steps[self.step];
        let left = (step.end - t) / (step.end - step.start);
        for &(dof, force) in &self.released {
            external[dof] += left * force;
        }
        external
    }
}

/// Work of loads and reactions over an increment by the trapezoidal rule: exact for forces that vary linearly. It begins with what held the last
/// accepted state in balance, not with what an amplitude says of its time: a load that is there at once, or changes from one step to the next, is
/// taken from one equilibrium to the other like any other, and a support that lets go has done its part until then.
pub(crate) fn work(
    frame: &Frame,
    fixed: &[bool],
    u: &[f64],
    forces: &[f64],
    external: &[f64],
) -> f64 {
    let mut work = 0.0;
    for (i, after) in external.iter().enumerate() {
        let before = frame.load[i] + frame.forces[i];
        let reaction = if fixed[i] { forces[i] } else { 0.0 };
        work += 0.5 * (before + after + reaction) * (u[i] - frame.state.u[i]);
    }
    work
}

/// Half of what loads and reactions have done on the frames of bodies that turn, whichever way: what some hand on others take. By the trapezoidal rule.
pub(crate) fn transmitted(
    frame: &Frame,
    model: &Model,
    u: &[f64],
    forces: &[f64],
    external: &[f64],
) -> f64 {
    let dofs = model.dofs;
    let frames = model.frames.all().iter();
    let carried = frames.filter_map(|f| f.hidden());
    let own = carried.flat_map(|h| dofs.of(h, 0)..dofs.of(h + 2, 0));
    let work = own.map(|i| {
        let sum = frame.load[i] + frame.forces[i] + external[i] + forces[i];
        0.5 * sum * (u[i] - frame.state.u[i])
    });
    0.5 * work.map(f64::abs).sum::<f64>()
}
