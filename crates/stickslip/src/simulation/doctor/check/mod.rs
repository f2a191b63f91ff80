//! What can be told of a model before it runs.

mod cells;
mod conditions;
mod curved;
mod driven;
mod friction;
mod gaps;
mod laws;
mod locking;
mod meshes;
mod motions;
mod normals;
mod released;
mod schedules;
mod speeds;
mod strains;
mod surfaces;
mod units;
mod unmoved;
mod unused;

pub(super) use meshes::disconnected;

use super::finding::{Finding, Guilty, What};
use super::surfaces::Opposite;
use super::unjoined::Unjoined;
use crate::body::couplings::Tie;
use crate::contact::interface::Interface;
use crate::math::Vec3;
use crate::simulation::model::Model;
use crate::simulation::scene::Scene;
use crate::simulation::view::View;

/// What is measured once for all rules, by interface.
struct Measured {
    /// Gaps at the start, infinite where nothing lies opposite.
    gaps: Vec<f64>,
    /// What lies nearest to each point, whichever way it faces: distance, outward normal, length of the facet.
    nearest: Vec<Option<Beside>>,
}

/// What lies nearest to a point of the secondary.
#[derive(Debug, Clone, Copy)]
struct Beside {
    distance: f64,
    normal: Vec3,
    /// Spacing of the nodes of the facet `[m]`; none of an obstacle.
    facet: Option<f64>,
}

/// All findings about a model, given the gaps at its start by interface; worst first.
pub(in crate::simulation) fn examine(
    view: &View,
    unjoined: &Unjoined,
    gaps: &[Vec<f64>],
) -> Vec<Finding> {
    let t = view.frame.state.t;
    let interfaces = view.contact.interfaces.iter().zip(gaps);
    let measured: Vec<Measured> = interfaces
        .map(|(interface, gaps)| measure(interface, gaps, t))
        .collect();
    let model = view.model;
    let mut out = roots(view);
    out.extend(disconnected(model));
    out.extend(motions::check(view, &measured));
    for (interface, measured) in view.contact.interfaces.iter().zip(&measured) {
        match normals::check(view, interface, measured) {
            // Gaps to a surface that looks the other way mean nothing.
            Some(finding) => out.push(finding),
            None => {
                let apart = speeds::apart(view, interface, measured);
                match apart {
                    // What is never in contact rubs on nothing and closes no gap.
                    Some(finding) => out.push(finding),
                    None => {
                        out.extend(gaps::check(view, interface, measured));
                        out.extend(friction::pressureless(view, interface, measured));
                    }
                }
                out.extend(strains::pressed(view, interface, measured));
                out.extend(meshes::check(view, interface, measured));
                out.extend(surfaces::check(model, interface));
                out.extend(curved::check(model, interface, t));
            }
        }
        out.extend(friction::check(view, interface, measured));
    }
    out.extend(conditions::check(view, &measured));
    out.extend(schedules::check(view));
    out.extend(released::check(view));
    out.extend(unmoved::check(view));
    out.extend(unused::check(model));
    out.extend(unjoined.check(view));
    out.extend(strains::check(model));
    out.extend(locking::check(model));
    out.extend(units::check(model));
    out.sort_by_key(|f| std::cmp::Reverse(f.severity));
    out
}

/// The first interface whose sides do not face each other, as far as the state of the run shows.
pub(super) fn opposed(view: &View) -> Option<Finding> {
    let interfaces = view.contact.interfaces.iter();
    let mut found = interfaces.filter_map(|i| {
        let measured = measure(i, &i.initial_gaps(), view.frame.state.t);
        normals::check(view, i, &measured)
    });
    found.next()
}

/// Mistakes that may be why the iteration does not converge: sizes and numbers of single bodies that are those of no body, strains that are not small.
pub(super) fn suspects(model: &Model) -> Vec<Finding> {
    let mut out = units::impossible(model);
    out.extend(strains::check(model));
    out
}

/// Mistakes that keep a system from being solved, whatever is done to solve it: cells, laws, surfaces that are joined twice, units of velocities.
pub(super) fn roots(scene: &Scene) -> Vec<Finding> {
    let model = scene.model;
    let mut out = cells::slivers(model);
    out.extend(laws::check(scene));
    out.extend(surfaces::doubled(scene));
    out.extend(speeds::fast(scene));
    out
}

fn measure(interface: &Interface, gaps: &[f64], t: f64) -> Measured {
    use crate::contact::interface::Primary;
    let mut opposite = Opposite::new(interface, t);
    let nearest = interface.points.iter().map(|p| {
        let nearest = opposite.nearest(p.position(&interface.reference))?;
        let facet = match &interface.primary {
            Primary::Facets(facets) => {
                Some(super::surfaces::spacing(interface, &facets[nearest.facet]))
            }
            Primary::Rigid(..) => None,
        };
        Some(Beside {
            distance: nearest.distance,
            normal: nearest.normal,
            facet,
        })
    });
    Measured {
        nearest: nearest.collect(),
        gaps: gaps.to_vec(),
    }
}

/// A body as a place: the centre of its box.
pub(in crate::simulation) fn body(model: &Model, name: &str, remark: String) -> Guilty {
    let guilty = Guilty::body(name, remark);
    match model.bodies.iter().find(|b| b.name == name) {
        Some(body) => {
            let (low, high) = bounds(&model.mesh.points[body.points.clone()]);
            guilty.at(std::array::from_fn(|c| 0.5 * (low[c] + high[c])))
        }
        None => guilty,
    }
}

/// A point of the secondary as a place.
fn secondary(interface: &Interface, i: usize, remark: String) -> Guilty {
    let point = &interface.points[i];
    Guilty {
        what: What::Node,
        name: interface.name.clone(),
        id: point.node().map(|one| interface.node_ids[one]),
        interface: Some(interface.name.clone()),
        remark,
        ..Guilty::default()
    }
    .at(interface.place(point))
}

/// Lowest and highest coordinates.
pub(super) fn bounds(points: &[Vec3]) -> (Vec3, Vec3) {
    let start = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    points.iter().fold(start, |(low, high), p| {
        (
            std::array::from_fn(|i| low[i].min(p[i])),
            std::array::from_fn(|i| high[i].max(p[i])),
        )
    })
}

/// The diagonal of the box around a body.
fn diameter(points: &[Vec3]) -> f64 {
    let (low, high) = bounds(points);
    crate::math::distance(low, high)
}

/// Names of the bodies of the two sides, secondary first; `None` for an obstacle.
fn sides(model: &Model, interface: &Interface) -> [Option<String>; 2] {
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
fn roles(interface: &Interface) -> [&'static str; 2] {
    match interface.exchanged {
        true => ["primary", "secondary"],
        false => ["secondary", "primary"],
    }
}

/// The middle one of some numbers; NaN of none.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// How far supports, obstacles and belts move anything in the whole analysis, at most `[m]`.
fn travel(scene: &Scene) -> f64 {
    let model = scene.model;
    use crate::contact::interface::Primary;
    let times = times(model);
    let mut largest = 0.0_f64;
    for support in &model.supports {
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
        let Tie::Equation { value } = coupling.tie else {
            continue;
        };
        for &t in times.iter().filter(|&&t| coupling.schedule.active(t)) {
            largest = largest.max((value * coupling.schedule.at(t)).abs());
        }
    }
    for initial in &model.initials {
        let all = initial.displacements.iter();
        largest = all.fold(largest, |m, (_, u)| m.max(u.abs()));
    }
    largest
}

/// Starts, ends and milestones of the steps.
fn times(model: &Model) -> Vec<f64> {
    let mut times: Vec<f64> = Vec::new();
    for step in &model.steps {
        times.extend([step.start, 0.5 * (step.start + step.end), step.end]);
        times.extend(&step.milestones);
    }
    times
}

/// Whether forces act in the analysis, inertia included.
fn forced(model: &Model) -> bool {
    forced_by_loads(model) || model.moves()
}

/// Whether loads act in the analysis.
fn forced_by_loads(model: &Model) -> bool {
    model.loads.iter().any(|l| {
        let any = l.entries.iter().any(|(_, f)| *f != 0.0);
        any && times(model).iter().any(|&t| l.schedule.at(t) != 0.0)
    })
}
