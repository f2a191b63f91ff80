//! What drives an unconstrained motion: the loads, supports and obstacles behind it, by name.

use super::super::scene::Scene;
use super::held::Unheld;
use super::modes::{Mode, modes};
use crate::contact::interface::{Interface, Primary};
use crate::model::rigid::held;
use crate::number::figure;
use crate::tolerance::{NEGLIGIBLE, SAME};

/// Most names in a sentence.
const NAMES_A_SENTENCE: usize = 3;

/// A load, pretension, support or obstacle that drives a motion.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Driver {
    /// Its key in the problem: `load.weight`.
    pub key: String,
    /// What it does: `pushes with 1.0e3`.
    pub what: String,
}

/// Loads along one motion at a time.
pub(crate) struct Push {
    /// All together `[N]`.
    pub total: f64,
    /// Sum of the sizes of all forces `[N]`.
    size: f64,
    /// Each by name.
    each: Vec<(String, f64)>,
}

/// The loads along a motion at the time of the step at hand at which they push the most.
pub(crate) fn strongest(scene: &Scene, all: &[Mode], motion: &Unheld) -> Push {
    let step = &scene.model.steps[scene.frame.step];
    let span = step.end - step.start;
    let mut times = vec![step.start + 1e-9 * span, step.start + 0.5 * span, step.end];
    times.extend(&step.milestones);
    let pushes = times.into_iter().map(|t| push(scene, all, motion, t));
    let worst = pushes.max_by(|a, b| {
        let of = |p: &Push| {
            if p.is_felt() { p.total.abs() } else { 0.0 }
        };
        of(a).total_cmp(&of(b))
    });
    worst.unwrap_or(Push {
        total: 0.0,
        size: 0.0,
        each: Vec::new(),
    })
}

/// The loads and pretensions along a motion at a time, with what supports that let go still carry.
pub(crate) fn push(scene: &Scene, all: &[Mode], motion: &Unheld, t: f64) -> Push {
    let model = scene.model;
    let parts: Vec<(&Mode, f64)> = all.iter().zip(motion.iter().copied()).collect();
    let parts: Vec<_> = parts
        .into_iter()
        .filter(|(_, c)| c.abs() > NEGLIGIBLE)
        .collect();
    let mut push = Push {
        total: 0.0,
        size: 0.0,
        each: Vec::new(),
    };
    let mut of = |key: Option<String>, entries: &[(usize, f64)], factor: f64| {
        let mut sum = 0.0;
        for &(dof, force) in entries {
            let along: f64 = parts.iter().map(|(m, c)| c * m.at(model, dof)).sum();
            sum += factor * force * along;
            push.size += (factor * force).abs();
        }
        push.total += sum;
        if let Some(key) = key.filter(|_| sum != 0.0) {
            push.each.push((key, sum));
        }
    };
    for load in &model.actions.loads {
        let factor = load.schedule.at(t);
        if factor != 0.0 {
            of(Some(format!("load.{}", load.name)), &load.entries, factor);
        }
    }
    // A pair of forces inside a body pushes what only one of them acts on.
    for (name, forces) in scene.couplings().pulls(t) {
        of(Some(format!("pretension.{name}")), &forces, 1.0);
    }
    let step = &model.steps[scene.frame.step];
    let left = (step.end - t) / (step.end - step.start);
    of(None, &scene.frame.released, left);
    push
}

/// The body that takes the largest part in a motion, and what the motion is.
pub(crate) fn describe(scene: &Scene, all: &[Mode], motion: &Unheld) -> (String, String) {
    let each = || all.iter().zip(motion);
    let first = each().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
    let Some((first, _)) = first else {
        return Default::default();
    };
    let name = |body: usize| scene.model.bodies[body].name.clone();
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
pub(crate) fn drivers(scene: &Scene, body: usize, t: f64) -> Vec<Driver> {
    let all = modes(scene.model);
    let mut found: Vec<(String, f64)> = Vec::new();
    for motion in held::unheld(scene, t, &all, false) {
        if !all
            .iter()
            .zip(&motion)
            .any(|(m, c)| m.body == body && c.abs() > NEGLIGIBLE)
        {
            continue;
        }
        let push = push(scene, &all, &motion, t);
        for (name, force) in push.each {
            if force.abs() <= SAME * push.size {
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
        what: format!("pushes with {}", figure(force)),
    });
    let mut drivers: Vec<Driver> = loads.collect();
    if drivers.is_empty() {
        drivers = movers(scene, body, t);
    }
    drivers.truncate(NAMES_A_SENTENCE);
    drivers
}

/// Supports and obstacles that have moved in the step by `t`, of a body and of all that interfaces connect it with.
fn movers(scene: &Scene, body: usize, t: f64) -> Vec<Driver> {
    let model = scene.model;
    let start = model.steps[scene.frame.step].start;
    let within = |bodies: &[usize], local: usize, i: &Interface| {
        let point = i.nodes[local];
        bodies
            .iter()
            .any(|&b| model.bodies[b].points.contains(&point))
    };
    let mut near = vec![body];
    let mut obstacles = Vec::new();
    let acting = || {
        scene
            .contact
            .interfaces
            .iter()
            .filter(|i| i.schedule.active(t))
    };
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
    for support in model
        .actions
        .supports
        .iter()
        .filter(|s| s.schedule.active(t))
    {
        let (from, to) = (support.schedule.at(start), support.schedule.at(t));
        let moved = support.entries.iter().filter(|e| {
            let (point, _) = model.dofs.locate(e.dof);
            let of = |b: &usize| {
                let body = &model.bodies[*b];
                let link = body.rigid.map(|r| model.links.all()[r.link].hidden);
                body.points.contains(&point) || link.is_some_and(|h| (h..h + 2).contains(&point))
            };
            !e.hold && near.iter().any(of)
        });
        let way = moved.fold(0.0_f64, |m, e| m.max(((to - from) * e.value).abs()));
        if way > 0.0 {
            out.push((
                way,
                format!("support.{}", support.name),
                format!("moves by {}", figure(way)),
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

impl Push {
    /// Whether it is more than rounding.
    pub fn is_felt(&self) -> bool {
        self.total.abs() > SAME * self.size
    }

    /// The loads that push the way they do together, the largest first.
    pub fn drivers(&self) -> Vec<Driver> {
        let along = self.each.iter().filter(|(_, f)| f * self.total > 0.0);
        let mut each: Vec<_> = along.collect();
        each.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
        each.truncate(NAMES_A_SENTENCE);
        let driver = |(key, force): &(String, f64)| Driver {
            key: key.clone(),
            what: format!("pushes with {}", figure(force.abs())),
        };
        each.into_iter().map(driver).collect()
    }
}

/// `load.a and load.b drive`.
pub(crate) fn named(drivers: &[Driver], one: &str, several: &str) -> String {
    let keys: Vec<&str> = drivers.iter().map(|d| d.key.as_str()).collect();
    match keys.as_slice() {
        [] => format!("what supports that let go still carried {one}"),
        [only] => format!("{only} {one}"),
        [rest @ .., last] => format!("{} and {last} {several}", rest.join(", ")),
    }
}
