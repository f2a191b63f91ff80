//! What several rules look at.

use super::super::places::bounds;
use crate::body::couplings::Tie;
use crate::contact::interface::InterfaceDefinition;
use crate::math::Vec3;
use crate::model::definition::Model;
use crate::model::scene::Scene;
use crate::model::thermal;

/// The diagonal of the box around a body.
pub(super) fn diameter(points: &[Vec3]) -> f64 {
    let (low, high) = bounds(points);
    crate::math::distance(low, high)
}

/// Names of the bodies of the two sides, secondary first; `None` for an obstacle.
pub(super) fn sides(model: &Model, interface: &InterfaceDefinition) -> [Option<String>; 2] {
    use crate::contact::interface::Primary;
    let name = |local: usize| {
        let point = interface.nodes[local];
        let body = model.bodies.iter().find(|b| b.points.contains(&point));
        body.map(|b| b.name.clone())
    };
    let secondary = interface.points.first().and_then(|p| name(p.nodes[0]));
    let primary = match &interface.primary {
        Primary::Facets(facets) => facets.first().and_then(|f| name(f.nodes[0])),
        Primary::Rigid(..) => None,
    };
    [secondary, primary]
}

/// What the problem calls the side of the points and the side of the facets.
pub(super) fn roles(interface: &InterfaceDefinition) -> [&'static str; 2] {
    match interface.exchanged {
        true => ["primary", "secondary"],
        false => ["secondary", "primary"],
    }
}

/// The middle one of some numbers; NaN of none.
pub(super) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// How far supports, obstacles and belts move anything in the whole analysis, at most `[m]`.
pub(super) fn travel(scene: &Scene) -> f64 {
    let model = scene.model;
    use crate::contact::interface::Primary;
    let times = times(model);
    let mut largest = 0.0_f64;
    for support in &model.actions.supports {
        let value = support.entries.iter().filter(|e| !e.hold);
        let value = value.fold(0.0_f64, |m, e| m.max(e.value.abs()));
        for &t in &times {
            if support.schedule.active(t) {
                largest = largest.max(value * support.schedule.at(t).abs());
            }
        }
    }
    for interface in &scene.contact.interfaces {
        let Primary::Rigid(_, motion) = &interface.primary else {
            continue;
        };
        let start = model.steps.first().map_or(0.0, |s| s.start);
        for p in &interface.points {
            let x = p.position(&interface.reference);
            let there = motion.pose(start).inward(x);
            for &t in &times {
                let moved = crate::math::distance(motion.pose(t).outward(there), x);
                largest = largest.max(moved);
            }
        }
    }
    for coupling in scene.contact.couplings.all() {
        let Tie::Equation { value } = &coupling.tie else {
            continue;
        };
        for &t in times.iter().filter(|&&t| coupling.schedule.active(t)) {
            largest = largest.max((value * coupling.schedule.at(t)).abs());
        }
    }
    for initial in &model.actions.initials {
        let all = initial.displacements.iter();
        largest = all.fold(largest, |m, (_, u)| m.max(u.abs()));
    }
    largest
}

/// Starts, ends and milestones of the steps.
pub(super) fn times(model: &Model) -> Vec<f64> {
    let mut times: Vec<f64> = Vec::new();
    for step in &model.steps {
        times.extend([step.start, 0.5 * (step.start + step.end), step.end]);
        times.extend(&step.milestones);
    }
    times
}

/// Whether forces act in the analysis, inertia included.
pub(super) fn forced(scene: &Scene) -> bool {
    forced_by_loads(scene) || scene.model.moves()
}

/// Whether loads, pretensions or temperatures act in the analysis.
pub(super) fn forced_by_loads(scene: &Scene) -> bool {
    let model = scene.model;
    let couplings = scene.contact.couplings.all().iter();
    let draws = |tie: &Tie| matches!(tie, Tie::Pretension(p) if p.draws());
    if couplings.into_iter().any(|c| draws(&c.tie)) || thermal::is_heated(model) {
        return true;
    }
    model.actions.loads.iter().any(|l| {
        let any = l.entries.iter().any(|(_, f)| *f != 0.0);
        any && times(model).iter().any(|&t| l.schedule.at(t) != 0.0)
    })
}
