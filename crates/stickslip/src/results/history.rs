//! One row of numbers an increment: what happened, energies, interfaces, supports, probes.

use super::free_bodies;
use crate::assess::view::View;
use crate::body::Around;
use crate::contact::look;
use crate::contact::look::Resultant;
use crate::model::definition::{Reference, Support};
use crate::model::kick::Share;
use crate::solve::accepted::Effort;
use crate::system::Motion;
use crate::time::Trial;

/// Columns of interfaces under laws that keep their speed: the largest speed and slip, and the integral of slip over the surface.
pub(super) const FASTEST: &str = "VMAX";
pub(super) const FARTHEST: &str = "SLIPMAX";
pub(super) const POTENCY: &str = "POTENCY";

/// Columns of the mode along which a motion began.
pub(super) const AMPLITUDE: &str = "MODE.A";
pub(super) const PHASE: &str = "MODE.PHASE";
pub(super) const REST: &str = "MODE.REST";

/// A row of the history: names and values.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Row {
    /// Column names.
    pub names: Vec<String>,
    /// Values.
    pub values: Vec<f64>,
}

impl Row {
    pub(super) fn push(&mut self, name: impl Into<String>, value: f64) {
        self.names.push(name.into());
        self.values.push(value);
    }

    /// The value of a column.
    pub fn get(&self, name: &str) -> Option<f64> {
        let i = self.names.iter().position(|n| n == name)?;
        Some(self.values[i])
    }
}

pub(crate) fn row(
    view: &View,
    around: &[Option<Around>],
    trial: Trial,
    effort: Effort,
    increment: usize,
    attempt: usize,
) -> Row {
    let mut row = Row::default();
    // the first columns as in the .sta file of Abaqus and CalculiX
    row.push("STEP", view.step_index() as f64 + 1.0);
    row.push("INC", increment as f64);
    row.push("ATT", attempt as f64);
    row.push("ITRS", effort.iterations as f64);
    row.push("TIME", trial.to);
    row.push("DT", trial.to - trial.from);
    if view.model.steps.iter().any(|s| s.cycles.is_some()) {
        row.push("CYCLES", cycles(view, trial.to));
    }
    row.push("AUGMENTATIONS", effort.rounds as f64);
    row.push("RESIDUAL", effort.residual);
    row.push("OPEN", effort.tally.open as f64);
    row.push("STICK", effort.tally.stick as f64);
    row.push("SLIP", effort.tally.slip as f64);
    let e = &view.frame.ledger;
    row.push("ALLSE", e.strain);
    row.push("ALLCE", e.contact);
    row.push("ALLFD", e.friction);
    row.push("ALLWK", e.external_work + e.belt_work);
    row.push("ALLAE", e.artificial);
    row.push("ERESIDUAL", e.residual);
    if view.model.moves() {
        row.push("ALLKE", e.kinetic);
        row.push("ALLVD", e.rayleigh_damping);
        row.push("ALLCD", e.contact_damping);
        row.push("ALLND", e.numerical);
        row.push("EINITIAL", e.initial);
    }
    if view.model.steps.iter().any(|s| s.kick.is_some()) {
        let share = match &view.frame.kick {
            Some(kick) => kick.last,
            None => Share::default(),
        };
        row.push(AMPLITUDE, share.amplitude);
        row.push(PHASE, share.phase);
        row.push(REST, share.rest);
    }
    let dim = view.model.dofs.dim;
    for interface in view.contacts() {
        let r = look::resultant(interface, &view.frame.state.u);
        push_resultant(&mut row, &interface.name, &r, dim);
        // Tied surfaces pull as well as they press, and do not slide.
        let (name, tied) = (&interface.name, interface.laws.tied);
        row.push(
            format!("{name}.{}", if tied { "TMAX" } else { "CPRESSMAX" }),
            r.peak,
        );
        if !tied {
            row.push(format!("{name}.ALLFD"), look::energy(interface).dissipated);
        }
        if let Some(sliding) = look::sliding(interface) {
            row.push(format!("{name}.{FASTEST}"), sliding.fastest);
            row.push(format!("{name}.{FARTHEST}"), sliding.farthest);
            row.push(format!("{name}.{POTENCY}"), sliding.potency);
        }
        if let Some(wear) = look::wear(interface) {
            let [own, other] = wear.depth;
            row.push(format!("{}.CWEARMAX", interface.name), own.max(other));
            let volume = wear.volume[0] + wear.volume[1];
            row.push(format!("{}.CWEARVOL", interface.name), volume);
        }
    }
    for (name, force, sum) in view.couplings().report(&view.frame.state.u) {
        row.push(format!("{name}.F"), force);
        row.push(format!("{name}.U"), sum);
    }
    for support in &view.model.actions.supports {
        push_reaction(&mut row, &support.name, view, support);
    }
    for reference in &view.model.references {
        push_reference(&mut row, view, reference);
    }
    for (name, value) in free_bodies::columns(view) {
        row.push(name, value);
    }
    push_probes(&mut row, view, around);
    for support in &view.model.actions.supports {
        push_motion(&mut row, view, support);
    }
    row
}

/// Cycles that are over at a time, those of steps before included.
fn cycles(view: &View, t: f64) -> f64 {
    let now = view.step_index();
    let steps = view.model.steps[..=now].iter().enumerate();
    let of = steps.filter_map(|(i, s)| Some((i, s, s.cycles?)));
    of.map(|(i, s, c)| match i == now {
        true => c.done(t - s.start, view.frame.block),
        false => c.count as f64,
    })
    .sum()
}

fn push_reaction(row: &mut Row, name: &str, view: &View, support: &Support) {
    let dofs = view.model.dofs;
    let mut sum = [0.0; 3];
    if support.schedule.active(view.frame.state.t) {
        let swinging = view.swinging();
        for e in &support.entries {
            let (point, component) = dofs.locate(e.dof);
            // the moments that hold a rigid body are no forces
            if !view.model.links.turns(point) {
                let own = swinging.iter().filter(|(dof, _)| *dof == e.dof);
                sum[component] += view.frame.forces[e.dof] + own.map(|(_, f)| f).sum::<f64>();
            }
        }
    }
    for (c, s) in sum.iter().enumerate().take(dofs.dim) {
        row.push(format!("{name}.RF{}", c + 1), *s);
    }
}

/// Mean displacement of the points of a support, and their rotation, in each direction that it prescribes, whether it acts at the time or not. A column that a
/// probe, a reference point or a body of the same name has stays as it is.
fn push_motion(row: &mut Row, view: &View, support: &Support) {
    let (dofs, links) = (view.model.dofs, &view.model.links);
    let mut means = [(0.0, 0.0); 6];
    for e in &support.entries {
        let (point, component) = dofs.locate(e.dof);
        let hidden = links.of_hidden(point).filter(|_| links.turns(point));
        let (direction, length) = match hidden.map(|link| links.all()[link].length) {
            // In the plane the only rotation is about z.
            Some(length) if dofs.dim == 2 => (5, length),
            Some(length) => (3 + component, length),
            None => (component, 1.0),
        };
        let (sum, count) = &mut means[direction];
        *sum += view.frame.state.u[e.dof] / length;
        *count += 1.0;
    }
    let names = ["U1", "U2", "U3", "UR1", "UR2", "UR3"];
    for (name, (sum, count)) in names.into_iter().zip(means) {
        let name = format!("{}.{name}", support.name);
        if count > 0.0 && !row.names.contains(&name) {
            row.push(name, sum / count);
        }
    }
}

/// Displacement and rotation of a reference point, and force and moment of the supports that hold it.
fn push_reference(row: &mut Row, view: &View, reference: &Reference) {
    let dofs = view.model.dofs;
    let link = &view.model.links.all()[reference.link];
    let held = view.supported(view.frame.state.t);
    let swinging = view.swinging();
    for (letters, forces) in [(["U", "UR"], false), (["RF", "RM"], true)] {
        for (dof, motion) in link.motions(dofs) {
            let value = match forces {
                false => view.frame.state.u[dof],
                true if held[dof] => {
                    let own = swinging.iter().filter(|(d, _)| *d == dof);
                    view.frame.forces[dof] + own.map(|(_, f)| f).sum::<f64>()
                }
                true => 0.0,
            };
            // Unknowns are lengths and what acts on them forces.
            let (letter, axis, value) = match (motion, forces) {
                (Motion::Translation(axis), _) => (letters[0], axis, value),
                (Motion::Rotation(axis), false) => (letters[1], axis, value / link.length),
                (Motion::Rotation(axis), true) => (letters[1], axis, value * link.length),
            };
            row.push(format!("{}.{letter}{}", reference.name, axis + 1), value);
        }
    }
}

fn push_resultant(row: &mut Row, name: &str, r: &Resultant, dim: usize) {
    for c in 0..dim {
        row.push(format!("{name}.CFN{}", c + 1), r.normal[c]);
    }
    for c in 0..dim {
        row.push(format!("{name}.CFS{}", c + 1), r.shear[c]);
    }
    for c in 0..dim {
        row.push(format!("{name}.XN{}", c + 1), r.centre[c]);
    }
    row.push(format!("{name}.CAREA"), r.area);
}

fn push_probes(row: &mut Row, view: &View, around: &[Option<Around>]) {
    let model = view.model;
    let dim = model.dofs.dim;
    let displacements = view.displacements();
    for (probe, around) in model.reports.probes.iter().zip(around) {
        let point = probe.point;
        let u = model.dofs.vector(&displacements, point);
        for (c, u) in u.iter().enumerate().take(dim) {
            row.push(format!("{}.U{}", probe.name, c + 1), *u);
        }
        if model.moves() {
            for (letter, values) in ["V", "A"].into_iter().zip(view.velocities()) {
                let x = match values.is_empty() {
                    true => [0.0; 3],
                    false => model.dofs.vector(&values, point),
                };
                for (c, x) in x.iter().enumerate().take(dim) {
                    row.push(format!("{}.{letter}{}", probe.name, c + 1), *x);
                }
            }
        }
        // Only the cells that meet there are looked at: in an explicit step there is a row for every increment.
        let mut stress = match around {
            Some(around) if model.corotations.of_point(point).is_some() => {
                around.stress(model.dofs, &*view.strained())
            }
            Some(around) => around.stress(model.dofs, &view.frame.state),
            None => [0.0; 6],
        };
        if let Some(body) = model.frames.of_point(point) {
            model.frames.poses(&view.frame.state.u)[body].turn_tensor(&mut stress);
        }
        if let Some(body) = model.corotations.of_point(point) {
            let turns = model.corotations.turns(&view.frame.state.u);
            turns[body].pose().turn_tensor(&mut stress);
        }
        for (k, name) in ["11", "22", "33", "12", "23", "13"].into_iter().enumerate() {
            if dim == 2 && k >= 4 {
                continue;
            }
            row.push(format!("{}.S{name}", probe.name), stress[k]);
        }
    }
}
