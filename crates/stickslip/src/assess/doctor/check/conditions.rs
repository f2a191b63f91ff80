//! Supports that contradict each other, and models in which nothing acts.

use std::collections::BTreeMap;

use super::super::finding::{DoctorCause, Finding};
use super::super::places::node;
use super::super::suspect::Suspect;
use super::common::{forced, travel};
use super::measured::Measured;
use crate::assess::view::View;
use crate::model::definition::{Model, Prescribed};
use crate::number::digits;
use crate::tolerance::SAME;

pub(super) fn check(view: &View, measured: &[Measured]) -> Vec<Finding> {
    let model = view.model;
    let mut out: Vec<Finding> = contradictions(model);
    out.extend(inert(model));
    let belts = view.contact.interfaces.iter().any(|i| !i.belt.is_empty());
    let overlaps = view.contact.interfaces.iter().zip(measured).any(|(i, m)| {
        let points = i.points.iter().zip(&m.gaps);
        points.into_iter().any(|(p, g)| *g < -1e-6 * p.size)
    });
    let moves = model.steps.iter().any(|step| step.modal.is_none());
    if moves
        && travel(view) == 0.0
        && !forced(view)
        && !belts
        && !overlaps
        && model.actions.initials.is_empty()
    {
        out.push(
            DoctorCause::NothingActs.warning(
                "nothing acts: no load, no prescribed displacement, no motion of an obstacle, no overlap"
            )
            .blame(Suspect::key("step", "every step leaves the model as it is"))
            .advise("check that values are not zero and that steps list the loads and supports that act"),
        );
    }
    out
}

/// Temperatures of bodies that do not expand.
fn inert(model: &Model) -> Vec<Finding> {
    let expands = |p: &usize| {
        let mut bodies = model.elastic().filter(|b| b.points.contains(p));
        bodies.any(|b| b.elastic.parts().iter().any(|part| part.dilation.is_some()))
    };
    let fields = model
        .actions
        .heat
        .iter()
        .flat_map(|h| &h.temperatures.fields);
    let idle = fields.filter(|f| !f.entries.iter().any(|(p, _)| expands(p)));
    let finding = |name: &String| {
        let message =
            format!("temperature {name} changes nothing: no material of its bodies expands");
        DoctorCause::NothingActs
            .warning(message)
            .blame(Suspect::key(format!("temperature.{name}"), ""))
            .advise("give their materials an `expansion`, the coefficient of thermal expansion")
    };
    idle.map(|field| finding(&field.name)).collect()
}

fn contradictions(model: &Model) -> Vec<Finding> {
    let mut seen: Vec<(usize, usize)> = Vec::new();
    let mut out = Vec::new();
    // In between, supports start from where they find the points; at the end of a step they are where they should be.
    for t in model.steps.iter().map(|step| step.end) {
        let mut first: BTreeMap<usize, (usize, f64)> = BTreeMap::new();
        for (k, support) in model.actions.supports.iter().enumerate() {
            if !support.schedule.active(t) {
                continue;
            }
            let factor = support.schedule.at(t);
            for e in support.entries.iter().filter(|e| !e.hold) {
                let value = factor * e.value;
                let &mut (other, was) = first.entry(e.dof).or_insert((k, value));
                let apart = (value - was).abs() > SAME * value.abs().max(was.abs());
                if other != k && apart && !seen.contains(&(other, k)) {
                    seen.push((other, k));
                    out.push(contradiction(model, other, k, was, value, e, t));
                }
            }
        }
    }
    out
}

fn contradiction(
    model: &Model,
    a: usize,
    b: usize,
    was: f64,
    value: f64,
    entry: &Prescribed,
    t: f64,
) -> Finding {
    let (first, second) = (
        &model.actions.supports[a].name,
        &model.actions.supports[b].name,
    );
    let (point, component) = model.dofs.locate(entry.dof);
    let direction = ["x", "y", "z"][component];
    let mut finding = DoctorCause::ContradictingSupports.warning(format!(
        "supports {first} and {second} prescribe different displacements in {direction} for one point: {was} and {value} at time {t}; \
         the second counts",
        was = digits(was, 5),
        value = digits(value, 5),
        t = digits(t, 5),
    ));
    if point < model.mesh.points.len() {
        finding = finding.blame(node(model, point, format!("direction {direction}")));
    }
    finding
        .blame(Suspect::key(format!("support.{first}"), ""))
        .blame(Suspect::key(format!("support.{second}"), ""))
        .advise("leave the common points out of one of the two sets, or let the supports act in different steps")
}
