//! How far supports, obstacles and initial velocities move the bodies, as long as nothing stands in their way.

use crate::contact::interface::{InterfaceDefinition, Primary};
use crate::math::{Vec3, add, distance, scale, sub};
use crate::model::definition::{Body, Model};
use crate::model::scene::Scene;
use crate::tolerance::NEGLIGIBLE;

/// What is prescribed for one component of a body at a time.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Component {
    /// How many dofs are prescribed.
    pub count: usize,
    /// The mean of their displacements `[m]`.
    pub mean: f64,
    /// Whether they differ, so that the body is strained by them.
    pub uneven: bool,
}

/// Which body a point belongs to, hidden points of rigid bodies included; `usize::MAX` for none.
pub(super) fn owners(model: &Model) -> Vec<usize> {
    let mut owners = vec![usize::MAX; model.dofs.points];
    for (b, body) in model.bodies.iter().enumerate() {
        owners[body.points.clone()].fill(b);
        if let Some(rigid) = body.rigid {
            let hidden = model.links.all()[rigid.link].hidden;
            owners[hidden..hidden + 2].fill(b);
        }
    }
    owners
}

/// Displacements that supports prescribe at time `t`, by body and component.
pub(super) fn prescribed(model: &Model, owners: &[usize], t: f64) -> Vec<[Component; 3]> {
    let mut all: Vec<[Vec<f64>; 3]> = vec![Default::default(); model.bodies.len()];
    for support in model
        .actions
        .supports
        .iter()
        .filter(|s| s.schedule.active(t))
    {
        let factor = support.schedule.at(t);
        for e in &support.entries {
            let (point, c) = model.dofs.locate(e.dof);
            if model.links.turns(point) || owners[point] == usize::MAX {
                continue;
            }
            let value = if e.hold { 0.0 } else { factor * e.value };
            all[owners[point]][c].push(value);
        }
    }
    let component = |values: &Vec<f64>| {
        let largest = values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let spread = values.iter().fold(f64::NEG_INFINITY, |m, v| m.max(*v))
            - values.iter().fold(f64::INFINITY, |m, v| m.min(*v));
        Component {
            count: values.len(),
            mean: values.iter().sum::<f64>() / values.len().max(1) as f64,
            uneven: spread > NEGLIGIBLE * largest,
        }
    };
    all.iter()
        .map(|c| std::array::from_fn(|i| component(&c[i])))
        .collect()
}

/// Indices of the bodies of the two sides, secondary first; `None` for an obstacle.
pub(super) fn pair(model: &Model, interface: &InterfaceDefinition) -> [Option<usize>; 2] {
    let of = |local: usize| {
        let point = interface.nodes[local];
        model.bodies.iter().position(|b| b.points.contains(&point))
    };
    let secondary = interface.points.first().and_then(|p| of(p.nodes[0]));
    let primary = match &interface.primary {
        Primary::Facets(facets) => facets.first().and_then(|f| of(f.nodes[0])),
        Primary::Rigid(..) => None,
    };
    [secondary, primary]
}

/// The mean initial velocity of a body `[m/s]`, zero if it has none, and when it begins.
pub(super) fn thrown(model: &Model, body: &Body) -> Option<(Vec3, f64)> {
    let (mut sum, mut count, mut from) = ([0.0; 3], [0_usize; 3], f64::INFINITY);
    for initial in &model.actions.initials {
        for &(dof, v) in &initial.velocities {
            let (point, c) = model.dofs.locate(dof);
            if body.points.contains(&point) {
                sum[c] += v;
                count[c] += 1;
                from = from.min(model.steps[initial.step].start);
            }
        }
    }
    let mean = std::array::from_fn(|c| sum[c] / count[c].max(1) as f64);
    (count != [0; 3]).then_some((mean, from))
}

/// How far the sides of an interface are moved towards each other over the analysis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Approach {
    /// The nearest that they come and the farthest that they go apart, both relative to the start `[m]`; positive is nearer.
    pub most: f64,
    pub least: f64,
    /// Whether both sides are moved by something that nothing stops: supports, obstacles.
    pub both: bool,
}

/// The approach of the sides of an interface along `normal` (out of the primary) at `x`; `None` where it does not follow from what is prescribed: a
/// body is moved by others or strained, or forces act.
pub(super) fn approach(
    scene: &Scene,
    interface: &InterfaceDefinition,
    x: Vec3,
    normal: Vec3,
) -> Option<Approach> {
    let model = scene.model;
    let owners = owners(model);
    let sides = pair(model, interface);
    let start = model.steps.first().map_or(0.0, |s| s.start);
    let mut out = Approach {
        most: f64::NEG_INFINITY,
        least: f64::INFINITY,
        both: true,
    };
    let along: Vec<usize> = (0..3).filter(|&c| normal[c].abs() > 1e-6).collect();
    for t in super::common::times(model) {
        if !interface.schedule.active(t) {
            continue;
        }
        let prescribed = prescribed(model, &owners, t);
        let mut moved = [[0.0; 3]; 2];
        for (moved, side) in moved.iter_mut().zip(sides) {
            let Some(b) = side else {
                if let Primary::Rigid(_, motion) = &interface.primary {
                    let there = motion.pose(start).inward(x);
                    *moved = sub(motion.pose(t).outward(there), x);
                }
                continue;
            };
            let body = &model.bodies[b];
            let thrown = thrown(model, body);
            for &c in &along {
                let component = prescribed[b][c];
                if component.uneven {
                    return None;
                }
                if component.count > 0 {
                    moved[c] = component.mean;
                    continue;
                }
                out.both = false;
                // An unconstrained body: it flies, or others push it.
                match thrown {
                    Some((v, from)) => moved[c] = v[c] * (t - from).max(0.0),
                    None if meets_others(scene, interface, b) => return None,
                    None => {}
                }
            }
        }
        let nearer = -crate::math::dot(sub(moved[0], moved[1]), normal);
        out.most = out.most.max(nearer);
        out.least = out.least.min(nearer);
    }
    (out.most.is_finite() && out.least.is_finite()).then_some(out)
}

/// Whether a body has something to do with others beside this interface.
pub(super) fn meets_others(scene: &Scene, interface: &InterfaceDefinition, body: usize) -> bool {
    let model = scene.model;
    let others = scene
        .contact
        .interfaces
        .iter()
        .filter(|i| i.name != interface.name);
    let meets = others
        .into_iter()
        .any(|i| pair(model, i).contains(&Some(body)));
    let t = model.steps.last().map_or(0.0, |s| s.end);
    meets || scene.couplings().acting(t).next().is_some()
}

/// How far a body that is moved at most gets in a dynamic analysis `[m]`, initial velocities only.
pub(super) fn flight(model: &Model) -> f64 {
    let mut farthest = 0.0_f64;
    let end = model.steps.last().map_or(0.0, |s| s.end);
    for initial in &model.actions.initials {
        let time = end - model.steps[initial.step].start;
        let mut speeds: std::collections::BTreeMap<usize, f64> = Default::default();
        for &(dof, v) in &initial.velocities {
            let (point, _) = model.dofs.locate(dof);
            *speeds.entry(point).or_default() += v * v;
        }
        let fastest = speeds.values().fold(0.0_f64, |m, v| m.max(*v)).sqrt();
        farthest = farthest.max(fastest * time);
    }
    farthest
}

/// The centre of a set of dofs in one direction: the mean place of their points.
pub(super) fn centre(model: &Model, points: &[usize]) -> Vec3 {
    let sum = points
        .iter()
        .fold([0.0; 3], |s, &p| add(s, model.mesh.points[p]));
    scale(1.0 / points.len().max(1) as f64, sum)
}

/// The distance between the centres of two sets of points `[m]`.
pub(super) fn apart(model: &Model, a: &[usize], b: &[usize]) -> f64 {
    distance(centre(model, a), centre(model, b))
}
