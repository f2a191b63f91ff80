//! What drives a motion that nothing holds: the loads, supports and obstacles behind it, by name.

use super::diagnosis;
use super::doctor::{self, DoctorCause, Finding, Guilty, Severity};
use super::run::Simulation;
use super::unheld::{Mode, NO_PART, Unheld, modes};
use crate::contact::interface::{Interface, Primary};
use crate::error::{Error, RunError};
use crate::system::StepFailure;
use crate::time::Trial;

/// Force along a motion, relative to the sum of its parts, that is rounding.
const NO_FORCE: f64 = 1e-8;

/// What to do about a body that has lost its hold, and about one that waits for contact.
const LOST: &str = "no equilibrium was found beyond this: lower what drives the body or raise friction, support the motion or hold it by weak \
     springs (`[load.NAME] spring = { stiffness = [...] }`), or make the step dynamic if the body is meant to slide or take off";
const WAITS: &str = "support these motions, hold them by weak springs (`[load.NAME] spring = { stiffness = [...] }`), move the bodies until \
     they touch, or prescribe a displacement instead of a force";

/// Most names in a sentence.
const MOST_NAMED: usize = 3;

/// A load, support or obstacle that drives a motion.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Driver {
    /// Its key in the problem: `load.weight`.
    pub key: String,
    /// What it does: `pushes with 1.0e3`.
    pub what: String,
}

/// Loads along one motion at a time: all together, the sum of the sizes of all forces, and each by name.
struct Push {
    total: f64,
    size: f64,
    each: Vec<(String, f64)>,
}

impl Simulation {
    /// Ends a quasi-static step before it begins, if a motion is free in it that nothing can hold, whatever touches.
    pub(super) fn refuse_unheld(&mut self) -> Result<(), Error> {
        let step = &self.model.steps[self.step];
        let middle = 0.5 * (step.start + step.end);
        let all = modes(&self.model);
        let mut refused = Vec::new();
        for motion in self.unheld(middle, &all, true) {
            let push = self.strongest(&all, &motion);
            let driven = push.total.abs() > NO_FORCE * push.size;
            // Anchors keep a body that nothing drives where it is.
            let mut parts = all
                .iter()
                .zip(&motion)
                .filter(|(_, part)| part.abs() > NO_PART);
            if driven || !parts.all(|(mode, _)| self.loose.knows(mode.body)) {
                refused.push((motion, push, driven));
            }
        }
        // What is driven says more than what is merely free.
        refused.sort_by_key(|(_, _, driven)| !driven);
        let Some((first, push, driven)) = refused.first() else {
            return Ok(());
        };
        let (body, what) = self.describe(&all, first);
        let step = self.step_name().to_string();
        let called = self.called();
        let by = match driven {
            true => format!(", and {} it", named(&push.drivers(), "drives", "drive")),
            false => String::new(),
        };
        let message = format!(
            "{called}: body {body} is free to move as a rigid body ({what}): neither supports nor springs nor contact can hold it{by}"
        );
        let mut finding = Finding::new(DoctorCause::FreeRigidMode, Severity::Error, message);
        let mut culprits = Vec::new();
        for (motion, push, driven) in &refused {
            let (body, what) = self.describe(&all, motion);
            let by: Vec<String> = match driven {
                true => push
                    .drivers()
                    .iter()
                    .map(|d| format!("{} {}", d.key, d.what))
                    .collect(),
                false => vec!["nothing drives it".into()],
            };
            let remark = format!(
                "{what} is held neither by supports nor by springs nor by contact; {}",
                by.join(", ")
            );
            culprits.push(format!("body {body}: {remark}"));
            finding = finding.blame(doctor::body_at(&self.model, &body, remark));
        }
        for driver in push.drivers().into_iter().filter(|_| *driven) {
            finding = finding.blame(Guilty::key(driver.key, driver.what));
        }
        let help = "support these motions, or hold them by weak springs (`[load.NAME] spring = { stiffness = [...] }`); \
             if the body is meant to fly or fall, make the step dynamic";
        finding = finding.advise(help);
        finding.step = Some(step);
        finding.time = Some(self.state.t);
        let error = RunError {
            message: finding.message.clone(),
            time: self.state.t,
            culprits,
            help: Some(help.into()),
        };
        doctor::note(&mut self.summary.findings, finding);
        Err(error.into())
    }

    /// The step at hand, for a sentence.
    pub(super) fn called(&self) -> String {
        match self.step_name() {
            name if name.starts_with("step") => name.to_string(),
            name => format!("step {name}"),
        }
    }

    /// Whether a body is in contact at the last accepted state.
    pub(super) fn touches(&self, body: usize) -> bool {
        let points = &self.model.bodies[body].points;
        let mut all = self.model.interfaces.iter();
        all.any(|i| i.touched() && i.nodes.iter().any(|n| points.contains(n)))
    }

    /// The error for a body that could not be brought to rest in an increment: what it does, and what drives it. `None` where no body is free.
    pub(super) fn explain_free(&self, failure: &StepFailure, trial: &Trial) -> Option<RunError> {
        let free = diagnosis::free_bodies(self, trial.to);
        let model = &self.model;
        // A body that has been in contact has lost its hold; others wait for theirs.
        let touching: Vec<_> = free.iter().filter(|f| self.touches(f.body)).collect();
        let lost = !touching.is_empty();
        let told: Vec<_> = match lost {
            true => touching,
            false => free.iter().collect(),
        };
        let first = told.first()?;
        let name = &model.bodies[first.body].name;
        let called = self.called();
        let drivers = self.drivers(first.body, trial.to);
        let by = match drivers.is_empty() {
            true => String::new(),
            false => format!(", {} it", named(&drivers, "drives", "drive")),
        };
        let message = match lost {
            true => format!(
                "{called}: body {name} slides, rolls or lifts off as a whole: contact and friction do not hold it{by}"
            ),
            false => format!(
                "{called}: body {name} is free to move as a rigid body: no contact holds it yet{by}"
            ),
        };
        let mut culprits = Vec::new();
        for f in &told {
            let motions: Vec<&str> = f.motions.iter().map(|(name, _)| name.as_str()).collect();
            let held = match lost {
                true => "held by contact alone",
                false => "held neither by supports nor by springs",
            };
            let name = &model.bodies[f.body].name;
            culprits.push(format!("body {name}: {} is {held}", motions.join(", ")));
        }
        culprits.extend(drivers.iter().map(|d| format!("{} {}", d.key, d.what)));
        if lost {
            culprits.extend(failure.culprits.iter().take(3).map(ToString::to_string));
        }
        Some(RunError {
            message,
            time: self.state.t,
            culprits,
            help: Some(match lost {
                true => LOST.into(),
                false => format!("{WAITS} ({})", self.smallest_gaps()),
            }),
        })
    }

    fn smallest_gaps(&self) -> String {
        let gaps = self.model.interfaces.iter().map(|i| {
            let smallest = i.initial_gaps().into_iter().fold(f64::INFINITY, f64::min);
            format!("{}: {smallest:.3e}", i.name)
        });
        match gaps.collect::<Vec<_>>().as_slice() {
            [] => "there are no interfaces".into(),
            gaps => format!("smallest gaps at the last state: {}", gaps.join(", ")),
        }
    }

    /// The loads along a motion at the time of the step at hand at which they push the most.
    fn strongest(&self, all: &[Mode], motion: &Unheld) -> Push {
        let step = &self.model.steps[self.step];
        let span = step.end - step.start;
        let mut times = vec![step.start + 1e-9 * span, step.start + 0.5 * span, step.end];
        times.extend(&step.milestones);
        let pushes = times.into_iter().map(|t| self.push(all, motion, t));
        let worst = pushes.max_by(|a, b| {
            let of = |p: &Push| {
                if p.total.abs() > NO_FORCE * p.size {
                    p.total.abs()
                } else {
                    0.0
                }
            };
            of(a).total_cmp(&of(b))
        });
        worst.unwrap_or(Push {
            total: 0.0,
            size: 0.0,
            each: Vec::new(),
        })
    }

    /// The loads along a motion at a time, with what supports that let go still carry.
    fn push(&self, all: &[Mode], motion: &Unheld, t: f64) -> Push {
        let model = &self.model;
        let parts: Vec<(&Mode, f64)> = all.iter().zip(motion.iter().copied()).collect();
        let parts: Vec<_> = parts
            .into_iter()
            .filter(|(_, c)| c.abs() > NO_PART)
            .collect();
        let mut push = Push {
            total: 0.0,
            size: 0.0,
            each: Vec::new(),
        };
        let mut of = |name: Option<&str>, entries: &[(usize, f64)], factor: f64| {
            let mut sum = 0.0;
            for &(dof, force) in entries {
                let along: f64 = parts.iter().map(|(m, c)| c * m.at(model, dof)).sum();
                sum += factor * force * along;
                push.size += (factor * force).abs();
            }
            push.total += sum;
            if let Some(name) = name.filter(|_| sum != 0.0) {
                push.each.push((format!("load.{name}"), sum));
            }
        };
        for load in &model.loads {
            let factor = load.schedule.at(t);
            if factor != 0.0 {
                of(Some(&load.name), &load.entries, factor);
            }
        }
        let step = &model.steps[self.step];
        let left = (step.end - t) / (step.end - step.start);
        of(None, &self.released, left);
        push
    }

    /// The body that takes the largest part in a motion, and what the motion is.
    fn describe(&self, all: &[Mode], motion: &Unheld) -> (String, String) {
        let each = || all.iter().zip(motion);
        let first = each().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
        let Some((first, _)) = first else {
            return Default::default();
        };
        let name = |body: usize| self.model.bodies[body].name.clone();
        let parts = each().filter(|(m, c)| m.body == first.body && c.abs() > 1e-3);
        let parts: Vec<&str> = parts.map(|(m, _)| m.name.as_str()).collect();
        let mut others: Vec<usize> = each()
            .filter(|(m, c)| m.body != first.body && c.abs() > 1e-3)
            .map(|(m, _)| m.body)
            .collect();
        others.dedup();
        let others: Vec<String> = others.into_iter().map(name).collect();
        let with = match others.as_slice() {
            [] => String::new(),
            _ => format!(", together with {}", others.join(", ")),
        };
        (name(first.body), format!("{}{with}", parts.join(" with ")))
    }

    /// What drives a body at time `t`: loads along motions that neither supports nor springs hold; where there are none, supports and obstacles
    /// that move in the step, of the body itself and of what it has an interface with.
    pub(super) fn drivers(&self, body: usize, t: f64) -> Vec<Driver> {
        let all = modes(&self.model);
        let mut found: Vec<(String, f64)> = Vec::new();
        for motion in self.unheld(t, &all, false) {
            if !all
                .iter()
                .zip(&motion)
                .any(|(m, c)| m.body == body && c.abs() > NO_PART)
            {
                continue;
            }
            let push = self.push(&all, &motion, t);
            for (name, force) in push.each {
                if force.abs() <= NO_FORCE * push.size {
                    continue;
                }
                match found.iter_mut().find(|(n, _)| *n == name) {
                    Some((_, f)) => *f = f.abs().max(force.abs()),
                    None => found.push((name, force.abs())),
                }
            }
        }
        found.sort_by(|a, b| b.1.total_cmp(&a.1));
        let loads = found.into_iter().map(|(key, force)| Driver {
            key,
            what: format!("pushes with {force:.3e}"),
        });
        let mut drivers: Vec<Driver> = loads.collect();
        if drivers.is_empty() {
            drivers = self.movers(body, t);
        }
        drivers.truncate(MOST_NAMED);
        drivers
    }

    /// Supports and obstacles that have moved in the step by `t`, of a body and of all that interfaces connect it with.
    fn movers(&self, body: usize, t: f64) -> Vec<Driver> {
        let model = &self.model;
        let start = model.steps[self.step].start;
        let within = |bodies: &[usize], local: usize, i: &Interface| {
            let point = i.nodes[local];
            bodies
                .iter()
                .any(|&b| model.bodies[b].points.contains(&point))
        };
        let mut near = vec![body];
        let mut obstacles = Vec::new();
        let acting = || model.interfaces.iter().filter(|i| i.schedule.active(t));
        for _ in 0..model.bodies.len() {
            let before = near.len();
            for i in acting() {
                if !(0..i.nodes.len()).any(|n| within(&near, n, i)) {
                    continue;
                }
                for (b, other) in model.bodies.iter().enumerate() {
                    let touches = i.nodes.iter().any(|n| other.points.contains(n));
                    if touches && !near.contains(&b) {
                        near.push(b);
                    }
                }
                if let Primary::Rigid(_, motion) = &i.primary
                    && motion.pose(start) != motion.pose(t)
                    && !obstacles.contains(&i.name)
                {
                    obstacles.push(i.name.clone());
                }
            }
            if near.len() == before {
                break;
            }
        }
        let mut out = Vec::new();
        for support in model.supports.iter().filter(|s| s.schedule.active(t)) {
            let (from, to) = (support.schedule.at(start), support.schedule.at(t));
            let moved = support.entries.iter().filter(|e| {
                let (point, _) = model.dofs.locate(e.dof);
                let of = |b: &usize| {
                    let body = &model.bodies[*b];
                    let link = body.rigid.map(|r| model.links.all()[r.link].hidden);
                    body.points.contains(&point)
                        || link.is_some_and(|h| (h..h + 2).contains(&point))
                };
                !e.hold && near.iter().any(of)
            });
            let way = moved.fold(0.0_f64, |m, e| m.max(((to - from) * e.value).abs()));
            if way > 0.0 {
                out.push((
                    way,
                    format!("support.{}", support.name),
                    format!("moves by {way:.3e}"),
                ));
            }
        }
        out.sort_by(|a, b| b.0.total_cmp(&a.0));
        let supports = out.into_iter().map(|(_, key, what)| Driver { key, what });
        let obstacles = obstacles.into_iter().map(|name| Driver {
            key: format!("interface.{name}.primary"),
            what: "moves".into(),
        });
        supports.chain(obstacles).collect()
    }
}

impl Push {
    /// The loads that push the way they do together, the largest first.
    fn drivers(&self) -> Vec<Driver> {
        let along = self.each.iter().filter(|(_, f)| f * self.total > 0.0);
        let mut each: Vec<_> = along.collect();
        each.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
        each.truncate(MOST_NAMED);
        let driver = |(key, force): &(String, f64)| Driver {
            key: key.clone(),
            what: format!("pushes with {:.3e}", force.abs()),
        };
        each.into_iter().map(driver).collect()
    }
}

/// `load.a and load.b drive`.
pub(super) fn named(drivers: &[Driver], one: &str, several: &str) -> String {
    let keys: Vec<&str> = drivers.iter().map(|d| d.key.as_str()).collect();
    match keys.as_slice() {
        [] => format!("what supports that let go still carried {one}"),
        [only] => format!("{only} {one}"),
        [rest @ .., last] => format!("{} and {last} {several}", rest.join(", ")),
    }
}
