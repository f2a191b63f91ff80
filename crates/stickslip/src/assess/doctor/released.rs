//! Steps that leave out what held a body or pressed it in the step before.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use super::finding::{DoctorCause, Finding};
use super::places::body;
use super::suspect::Suspect;
use crate::assess::view::View;
use crate::model::definition::{Body, Model, Step};
use crate::model::rigid::held;
use crate::model::rigid::modes::{Mode, modes};
use crate::system::{Course, Schedule};
use crate::tolerance::NEGLIGIBLE;

/// What a step leaves out: its kind, its name, and the body.
struct Dropped<'a> {
    table: &'static str,
    name: &'a str,
    body: usize,
}

/// A support that held a body until the step at hand.
pub(crate) struct Gone {
    /// Its key.
    pub key: String,
    /// What it did.
    pub what: String,
    /// What to do.
    pub advice: String,
}

/// Supports of some bodies that the step at hand leaves out and the one before had. Two bodies that move together may have hung on what held one of them.
pub(crate) fn let_go(view: &View, bodies: &[String]) -> Vec<Gone> {
    let model = view.model;
    let at = view.frame.step;
    let (Some(before), Some(step)) = (at.checked_sub(1).map(|i| &model.steps[i]), view.step())
    else {
        return Vec::new();
    };
    let gone = supports(model, before, step).into_iter();
    let own = gone.filter(|d| bodies.contains(&model.bodies[d.body].name));
    own.map(|d| Gone {
        key: format!("support.{}", d.name),
        what: format!(
            "held body {} in step {}, and step {} leaves it out",
            model.bodies[d.body].name, before.name, step.name
        ),
        advice: format!(
            "add \"{}\" to `supports` of step {} if it is to hold on: a step with a list has nothing else",
            d.name, step.name
        ),
    })
    .collect()
}

pub(super) fn check(view: &View) -> Vec<Finding> {
    let model = view.model;
    let mut out = Vec::new();
    if !dropped_any(model) {
        return out;
    }
    let modes = modes(model);
    for pair in model.steps.windows(2) {
        let [before, step] = pair else { continue };
        // In motion letting go is how things begin.
        if step.dynamic.is_some() || before.dynamic.is_some() {
            continue;
        }
        let was = free(view, &modes, before.end);
        let free = free(view, &modes, step.end);
        let mut told = BTreeSet::new();
        for dropped in supports(model, before, step) {
            let of = |all: &BTreeMap<usize, Motions>| {
                all.get(&dropped.body).cloned().unwrap_or_default()
            };
            let (before_it, now) = (of(&was), of(&free));
            let new = now.names.difference(&before_it.names).cloned();
            let new: Vec<String> = new.collect();
            let led = loaded(model, dropped.body, step) && !loaded(model, dropped.body, before);
            // The same motions, but more of them: what turned about a support moves by itself.
            if (!new.is_empty() || now.count > before_it.count) && !led {
                told.insert(dropped.body);
                let what = match new.is_empty() {
                    false => format!("held against {}", new.join(" and ")),
                    true => format!(
                        "held by it against {}",
                        now.names.iter().cloned().collect::<Vec<_>>().join(" and ")
                    ),
                };
                out.push(finding(model, &dropped, step, &what));
            }
        }
        for dropped in loads(model, before, step) {
            let only_contact = free.contains_key(&dropped.body);
            if only_contact && !loaded(model, dropped.body, step) && !told.contains(&dropped.body) {
                out.push(finding(model, &dropped, step, "loaded"));
            }
        }
    }
    out
}

/// Whether any step leaves out what the one before had.
fn dropped_any(model: &Model) -> bool {
    model.steps.windows(2).any(|w| {
        let mut supports = model.actions.supports.iter().map(|s| &s.schedule);
        let mut loads = model.actions.loads.iter().map(|l| &l.schedule);
        supports.any(|s| s.active(w[0].end) && !s.active(w[1].end))
            || loads.any(|l| left_out(l, &w[0], &w[1]))
    })
}

/// Whether something acts at the end of a step.
fn acts(schedule: &Schedule, step: &Step) -> bool {
    schedule.active(step.end) && schedule.at(step.end) != 0.0
}

/// Whether a load acts at the end of a step and the next one does not list it: it falls to zero over that one. One that an amplitude takes away is meant to go.
fn left_out(schedule: &Schedule, before: &Step, step: &Step) -> bool {
    let piece = schedule.pieces.iter().find(|p| p.end == step.end);
    let table = piece.is_some_and(|p| matches!(p.course, Course::Table(_)));
    acts(schedule, before) && !acts(schedule, step) && !table
}

/// Motions of a body: those that have a part in them, and how many there are.
#[derive(Debug, Clone, Default)]
struct Motions {
    names: BTreeSet<String>,
    count: usize,
}

/// Motions as a whole that nothing but contact resists, by body.
fn free(view: &View, modes: &[Mode], t: f64) -> BTreeMap<usize, Motions> {
    let mut out: BTreeMap<usize, Motions> = BTreeMap::new();
    for unheld in held::unheld(view, t, modes, false) {
        let mut moved = BTreeSet::new();
        for (mode, part) in modes.iter().zip(unheld) {
            if part.abs() > NEGLIGIBLE {
                let motions = out.entry(mode.body).or_default();
                motions.names.insert(mode.name.clone());
                if moved.insert(mode.body) {
                    motions.count += 1;
                }
            }
        }
    }
    out
}

/// The bodies of some dofs.
fn bodies(model: &Model, dofs: impl Iterator<Item = usize>) -> BTreeSet<usize> {
    let points: BTreeSet<usize> = dofs.map(|dof| model.dofs.locate(dof).0).collect();
    let touches =
        |points: &BTreeSet<usize>, range: Range<usize>| points.range(range).next().is_some();
    let of = |b: &Body| {
        let hidden = b.rigid.map(|r| model.links.all()[r.link].hidden);
        touches(&points, b.points.clone()) || hidden.is_some_and(|h| touches(&points, h..h + 2))
    };
    let all = model.bodies.iter().enumerate();
    all.filter(|(_, b)| of(b)).map(|(i, _)| i).collect()
}

fn supports<'a>(model: &'a Model, before: &Step, step: &Step) -> Vec<Dropped<'a>> {
    let gone = model.actions.supports.iter();
    let gone = gone.filter(|s| s.schedule.active(before.end) && !s.schedule.active(step.end));
    gone.flat_map(|s| {
        let held = bodies(model, s.entries.iter().map(|e| e.dof));
        held.into_iter().map(|body| Dropped {
            table: "support",
            name: &s.name,
            body,
        })
    })
    .collect()
}

fn loads<'a>(model: &'a Model, before: &Step, step: &Step) -> Vec<Dropped<'a>> {
    let gone = model.actions.loads.iter();
    let gone = gone.filter(|l| left_out(&l.schedule, before, step));
    gone.flat_map(|l| {
        let pressed = l.entries.iter().filter(|e| e.1 != 0.0);
        let pressed = bodies(model, pressed.map(|e| e.0));
        pressed.into_iter().map(|body| Dropped {
            table: "load",
            name: &l.name,
            body,
        })
    })
    .collect()
}

/// Whether a load acts on a body at the end of a step.
fn loaded(model: &Model, body: usize, step: &Step) -> bool {
    let acting = model
        .actions
        .loads
        .iter()
        .filter(|l| acts(&l.schedule, step));
    let mut dofs = acting.flat_map(|l| l.entries.iter().filter(|e| e.1 != 0.0).map(|e| e.0));
    let points = &model.bodies[body];
    let hidden = points.rigid.map(|r| model.links.all()[r.link].hidden);
    dofs.any(|dof| {
        let point = model.dofs.locate(dof).0;
        points.points.contains(&point) || hidden.is_some_and(|h| (h..h + 2).contains(&point))
    })
}

fn finding(model: &Model, dropped: &Dropped, step: &Step, what: &str) -> Finding {
    let Dropped { table, name, .. } = dropped;
    let of = &model.bodies[dropped.body].name;
    DoctorCause::LetGo.note(format!(
        "step {} leaves out {table} {name}: body {of} is no longer {what}, and nothing but contact holds it there",
        step.name
    ))
    .blame(Suspect::key(format!("{table}.{name}"), format!("not in `{table}s` of step {}", step.name)))
    .blame(body(model, of, ""))
    .advise(format!("if that is not meant, add \"{name}\" to `{table}s` of step {}: a step with a list has nothing else", step.name))
}
