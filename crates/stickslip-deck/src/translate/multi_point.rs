//! `*MPC`: what is not linear is taken about the start.

use std::collections::BTreeSet;

use stickslip::math::{Vec3, cross, dot, norm, normalize, scale, sub};

use super::bodies::Bodies;
use super::job::Job;
use super::links::{Term, equation};
use super::names::problem_name;
use super::references::follow;
use super::sets::Sets;
use crate::deck::MultiPoint;

pub(super) fn write(job: &mut Job, bodies: &Bodies, sets: &mut Sets) {
    for c in &job.deck.connectors.constraints {
        let (least, what) = match c.kind.as_str() {
            "PLANE" => (4, "three nodes that span the plane, and those in it"),
            "STRAIGHT" => (3, "two nodes that span the line, and those on it"),
            "MEANROT" => (2, "each node three times, and the node of the axis"),
            "DIST" => (
                7,
                "two nodes three times each, and the node of the distance",
            ),
            _ => (2, "two nodes"),
        };
        if c.nodes.len() < least {
            let message = format!("*MPC {} has {} nodes", c.kind, c.nodes.len());
            job.error(c.place, message, &format!("it wants {what}"));
            continue;
        }
        let done = match c.kind.as_str() {
            "BEAM" => beam(job, bodies, sets, c),
            "PIN" | "TIE" => same(job, bodies, sets, c),
            "LINK" => distance(job, bodies, sets, c, None),
            "DIST" => distance(job, bodies, sets, c, Some(c.nodes[6])),
            "PLANE" => plane(job, bodies, sets, c),
            "STRAIGHT" => straight(job, bodies, sets, c),
            _ => mean_rotation(job, bodies, sets, c),
        };
        if let Err(why) = done {
            job.error(
                c.place,
                format!("*MPC {}: {why}", c.kind),
                "move the nodes apart",
            );
        }
    }
}

/// What is wrong with the places of nodes.
type Done = Result<(), String>;

fn place(job: &Job, node: u64) -> Vec3 {
    job.deck.nodes[&node]
}

/// A direction in the factors of a term.
fn along(direction: Vec3, factor: f64) -> [f64; 6] {
    let d = scale(factor, direction);
    [d[0], d[1], d[2], 0.0, 0.0, 0.0]
}

fn say(job: &mut Job, bodies: &Bodies, sets: &mut Sets, c: &MultiPoint, terms: &[Term]) {
    let name = format!("mpc-{}", c.kind.to_lowercase());
    equation(job, bodies, sets, &name, c.place, terms);
}

/// The first node follows the second, which may turn.
fn beam(job: &mut Job, bodies: &Bodies, sets: &mut Sets, c: &MultiPoint) -> Done {
    let (end, start) = (c.nodes[0], c.nodes[1]);
    if end == start || place(job, end) == place(job, start) {
        return same(job, bodies, sets, c);
    }
    if bodies.refers(end) {
        return Err("both nodes are without a body".into());
    }
    let label = problem_name(&format!("node-{}", job.deck.label(end)));
    let set = sets.points(bodies, &label, &[end]);
    let reference = bodies.references[&start].clone();
    follow(job, "mpc-beam", c.place, set, &reference);
    Ok(())
}

/// Both nodes move alike; where both can turn and it is no pin, they turn alike.
fn same(job: &mut Job, bodies: &Bodies, sets: &mut Sets, c: &MultiPoint) -> Done {
    let (a, b) = (c.nodes[0], c.nodes[1]);
    let turn = c.kind != "PIN" && bodies.refers(a) && bodies.refers(b);
    let plane = bodies.dim() == 2;
    for i in 0..6 {
        let there = match plane {
            true => i < 2 || i == 5 && turn,
            false => i < 3 || turn,
        };
        if there {
            let unit = |f: f64| std::array::from_fn(|k| if k == i { f } else { 0.0 });
            say(job, bodies, sets, c, &[(a, unit(1.0)), (b, unit(-1.0))]);
        }
    }
    Ok(())
}

/// The distance of two nodes grows by what the first displacement of a third node is, or not at all.
fn distance(
    job: &mut Job,
    bodies: &Bodies,
    sets: &mut Sets,
    c: &MultiPoint,
    measure: Option<u64>,
) -> Done {
    let (a, b) = match measure {
        Some(_) => (c.nodes[0], c.nodes[3]),
        None => (c.nodes[0], c.nodes[1]),
    };
    let axis = normalize(sub(place(job, b), place(job, a)));
    let axis = axis.ok_or("the nodes lie at the same place")?;
    let mut terms = vec![(a, along(axis, -1.0)), (b, along(axis, 1.0))];
    terms.extend(measure.map(|n| (n, along([1.0, 0.0, 0.0], -1.0))));
    say(job, bodies, sets, c, &terms);
    Ok(())
}

/// Nodes stay in the plane of the first three.
fn plane(job: &mut Job, bodies: &Bodies, sets: &mut Sets, c: &MultiPoint) -> Done {
    let [a, b, d] = [c.nodes[0], c.nodes[1], c.nodes[2]];
    let x = place(job, a);
    let (p, q) = (sub(place(job, b), x), sub(place(job, d), x));
    let area = cross(p, q);
    if norm(area) <= 1e-9 * norm(p) * norm(q) {
        return Err("its first three nodes lie on one line".into());
    }
    let normal = scale(1.0 / norm(area), area);
    let squared = dot(area, area);
    for &n in &c.nodes[3..] {
        let r = sub(place(job, n), x);
        let (s, t) = (
            dot(cross(r, q), area) / squared,
            dot(cross(p, r), area) / squared,
        );
        let terms = [
            (n, along(normal, 1.0)),
            (a, along(normal, s + t - 1.0)),
            (b, along(normal, -s)),
            (d, along(normal, -t)),
        ];
        say(job, bodies, sets, c, &terms);
    }
    Ok(())
}

/// Nodes stay on the line through the first two.
fn straight(job: &mut Job, bodies: &Bodies, sets: &mut Sets, c: &MultiPoint) -> Done {
    let (a, b) = (c.nodes[0], c.nodes[1]);
    let x = place(job, a);
    let line = sub(place(job, b), x);
    let axis = normalize(line).ok_or("its first two nodes lie at the same place")?;
    let mut across = vec![];
    if bodies.dim() == 2 {
        across.push([-axis[1], axis[0], 0.0]);
    } else {
        let least = (0..3).min_by(|i, j| axis[*i].abs().total_cmp(&axis[*j].abs()));
        let mut other = [0.0; 3];
        other[least.unwrap_or(0)] = 1.0;
        let one = normalize(cross(axis, other)).unwrap_or(other);
        across.extend([one, cross(axis, one)]);
    }
    for &n in &c.nodes[2..] {
        let s = dot(sub(place(job, n), x), line) / dot(line, line);
        for &d in &across {
            let terms = [
                (n, along(d, 1.0)),
                (a, along(d, s - 1.0)),
                (b, along(d, -s)),
            ];
            say(job, bodies, sets, c, &terms);
        }
    }
    Ok(())
}

/// The mean of the angles by which nodes turn about an axis through their centre is the first displacement of the last node, which lies where the axis points.
fn mean_rotation(job: &mut Job, bodies: &Bodies, sets: &mut Sets, c: &MultiPoint) -> Done {
    let (last, nodes) = c.nodes.split_last().ok_or("it has no nodes")?;
    let nodes: BTreeSet<u64> = nodes.iter().copied().collect();
    let count = nodes.len() as f64;
    let axis = normalize(place(job, *last)).ok_or("the node of the axis lies at the origin")?;
    let sum = nodes.iter().fold([0.0; 3], |s, n| {
        stickslip::math::add(s, scale(1.0 / count, place(job, *n)))
    });
    let mut terms = vec![(*last, along([1.0, 0.0, 0.0], -1.0))];
    for n in nodes {
        let turned = cross(axis, sub(place(job, n), sum));
        let squared = dot(turned, turned);
        if squared > 0.0 {
            terms.push((n, along(turned, 1.0 / (count * squared))));
        }
    }
    say(job, bodies, sets, c, &terms);
    Ok(())
}
