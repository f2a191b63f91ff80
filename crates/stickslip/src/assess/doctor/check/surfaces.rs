//! Surfaces in contact that something else claims as well: a support, a load, another interface.

use std::collections::{BTreeMap, BTreeSet};

use super::super::finding::{DoctorCause, Finding};
use super::super::places;
use super::super::suspect::Suspect;
use super::common::{roles, sides};
use crate::body::couplings::Row;
use crate::contact::facet_point::evaluate;
use crate::contact::interface::{InterfaceDefinition, Primary};
use crate::math::Vec3;
use crate::model::definition::{Body, Model};
use crate::model::scene::Scene;
use crate::system::Schedule;

/// Part of the points of a surface that is most of it.
const MOST_OF_SURFACE: f64 = 0.5;

/// A surface of an interface: its side in words, its body, the points of the mesh on it and a normal at each.
struct Surface<'a> {
    side: &'static str,
    body: &'a Body,
    points: Vec<(usize, Vec3)>,
}

/// The surfaces of elastic bodies, that of the points first.
fn surfaces<'a>(model: &'a Model, interface: &InterfaceDefinition) -> Vec<Surface<'a>> {
    let names = sides(model, interface);
    let [own, other] = roles(interface);
    let mut normals: BTreeMap<usize, Vec3> = Default::default();
    for p in &interface.points {
        for &n in &p.nodes {
            normals.entry(interface.nodes[n]).or_insert(p.normal);
        }
    }
    let mut all = vec![(own, &names[0], normals)];
    if let Primary::Facets(facets) = &interface.primary {
        let mut normals: BTreeMap<usize, Vec3> = Default::default();
        for facet in facets {
            let x = crate::contact::look::coordinates(interface, facet);
            let normal = evaluate(facet.kind, &x, [0.0; 2]).normal;
            for &n in &facet.nodes {
                normals.entry(interface.nodes[n]).or_insert(normal);
            }
        }
        all.push((other, &names[1], normals));
    }
    let surface =
        |(side, name, normals): (&'static str, &Option<String>, BTreeMap<usize, Vec3>)| {
            let body = model
                .bodies
                .iter()
                .find(|b| Some(&b.name) == name.as_ref())?;
            body.rigid.is_none().then(|| Surface {
                side,
                body,
                points: normals.into_iter().collect(),
            })
        };
    all.into_iter().filter_map(surface).collect()
}

pub(super) fn check(scene: &Scene, interface: &InterfaceDefinition) -> Vec<Finding> {
    let model = scene.model;
    if interface.laws.tied {
        return Vec::new();
    }
    let mut out = Vec::new();
    for surface in surfaces(model, interface) {
        out.extend(held(model, interface, &surface));
        out.extend(loaded(model, interface, &surface));
        out.extend(stiffened(scene, interface, &surface));
    }
    out
}

/// A support that holds the surface itself along its normal, although the body behind it could move.
fn held(model: &Model, interface: &InterfaceDefinition, surface: &Surface) -> Option<Finding> {
    let on: BTreeSet<usize> = surface.points.iter().map(|p| p.0).collect();
    for support in &model.actions.supports {
        let mut held: BTreeSet<(usize, usize)> = BTreeSet::new();
        for e in &support.entries {
            held.insert(model.dofs.locate(e.dof));
        }
        let along = |(point, normal): &&(usize, Vec3)| {
            // A support holds a point along a normal that has a larger component along it.
            (0..3).any(|c| normal[c].abs() > 0.7 && held.contains(&(*point, c)))
        };
        let count = surface.points.iter().filter(along).count();
        if (count as f64) <= MOST_OF_SURFACE * surface.points.len() as f64 {
            continue;
        }
        // A body that is held everywhere stands for a rigid one.
        let beyond = surface.body.points.clone();
        let elsewhere = held
            .iter()
            .any(|(p, _)| beyond.contains(p) && !on.contains(p));
        if elsewhere || !together(model, &support.schedule, &interface.schedule) {
            continue;
        }
        let (name, ours) = (&interface.name, &surface.body.name);
        let node = surface.points.iter().find(along).map(|p| p.0);
        let finding = DoctorCause::SupportOnContact.warning(format!(
            "support {} holds the {} of interface {name} itself, on body {ours}: contact there moves nothing, and the body behind it feels nothing",
            support.name, surface.side
        ))
        .blame(Suspect::key(format!("support.{}.set", support.name), format!("{count} of {} points of the surface", surface.points.len())))
        .blame(Suspect::interface(name, format!("its {}", surface.side)));
        return Some(
            finding
                .blame_all(node.map(|p| places::node(model, p, "")))
                .advise("support the body where it is really held, away from the contact, or make it `rigid = true`"),
        );
    }
    None
}

/// A kinematic coupling that makes the surface itself rigid, although the body behind it could give way.
fn stiffened(scene: &Scene, interface: &InterfaceDefinition, surface: &Surface) -> Option<Finding> {
    let model = scene.model;
    let meshed = model.mesh.points.len();
    let on: BTreeSet<usize> = surface.points.iter().map(|p| p.0).collect();
    let all = scene.contact.couplings.all().iter();
    for coupling in all.filter(|c| c.referred && c.tie.firm()) {
        // Each row of a kinematic one leads a point of its own; one that distributes has all points in each.
        let own = |row: &Row| {
            let points = row.dofs.iter().map(|&d| model.dofs.locate(d).0);
            let points: BTreeSet<usize> = points.filter(|&p| p < meshed).collect();
            (points.len() == 1).then(|| points.first().copied())?
        };
        let led: BTreeSet<usize> = coupling.rows.iter().filter_map(own).collect();
        let count = led.intersection(&on).count();
        let beyond = surface.body.points.clone();
        // A body that is led everywhere stands for a rigid one.
        let elsewhere = led.iter().any(|p| beyond.contains(p) && !on.contains(p));
        let both = together(model, &coupling.schedule, &interface.schedule);
        if (count as f64) <= MOST_OF_SURFACE * on.len() as f64 || elsewhere || !both {
            continue;
        }
        let (name, ours) = (&interface.name, &surface.body.name);
        return Some(
            DoctorCause::SupportOnContact.warning(format!(
                "coupling {} makes the {} of interface {name} rigid, on body {ours}: contact cannot deform it, and pressures are those of a rigid face",
                coupling.name, surface.side
            ))
            .blame(Suspect::key(format!("coupling.{}", coupling.name), format!("{count} of {} points of the surface", on.len())))
            .blame(Suspect::interface(name, format!("its {}", surface.side)))
            .advise("let the reference point lead the face where the body is really held, away from the contact, or make the body `rigid = true`"),
        );
    }
    None
}

/// A load that acts on the surface of contact and nowhere else.
fn loaded(model: &Model, interface: &InterfaceDefinition, surface: &Surface) -> Option<Finding> {
    let on: BTreeSet<usize> = surface.points.iter().map(|p| p.0).collect();
    for load in &model.actions.loads {
        let acted: BTreeSet<usize> = load
            .entries
            .iter()
            .filter(|e| e.1 != 0.0)
            .map(|e| model.dofs.locate(e.0).0)
            .collect();
        let inside = acted.iter().filter(|p| on.contains(p)).count();
        // A surface that is the whole of a body, or one point of it, may well be loaded.
        let all = acted.len() < inside + 1 && on.len() < surface.body.points.len();
        if inside < 2 || !all || (inside as f64) <= MOST_OF_SURFACE * on.len() as f64 {
            continue;
        }
        let (name, ours) = (&interface.name, &surface.body.name);
        return Some(
            DoctorCause::LoadOnContact.warning(format!(
                "load {} acts on the {} of interface {name} itself, on body {ours}: it pushes on the surface that contact pushes on",
                load.name, surface.side
            ))
            .blame(Suspect::key(format!("load.{}.set", load.name), format!("{inside} points of the surface")))
            .blame(Suspect::interface(name, format!("its {}", surface.side)))
            .advise("load the surface that the force comes from; the force of contact follows from balance"),
        );
    }
    None
}

/// Whether two things act at the end of a step.
fn together(model: &Model, a: &Schedule, b: &Schedule) -> bool {
    (model.steps.iter()).any(|s| a.active(s.end) && b.active(s.end))
}

/// Two interfaces between the same surfaces that act at the same time.
pub(crate) fn doubled(scene: &Scene) -> Option<Finding> {
    let model = scene.model;
    let sets: Vec<[BTreeSet<usize>; 2]> = scene.contacts().map(|i| nodes(&i)).collect();
    for (b, second) in scene.contact.interfaces.iter().enumerate() {
        for (a, first) in scene.contact.interfaces.iter().enumerate().take(b) {
            // The two halves of two-sided contact are one interface of the problem.
            if first.name == second.name || first.share < 1.0 || second.share < 1.0 {
                continue;
            }
            let common = |x: usize, y: usize| {
                let both = sets[a][x].intersection(&sets[b][y]).count();
                both as f64 > MOST_OF_SURFACE * sets[a][x].len().min(sets[b][y].len()) as f64
                    && both > 0
            };
            let opposite = match (&first.primary, &second.primary) {
                (Primary::Rigid(s, m), Primary::Rigid(t, n)) => (s == t && m == n) && common(0, 0),
                (Primary::Facets(_), Primary::Facets(_)) => {
                    common(0, 0) && common(1, 1) || common(0, 1) && common(1, 0)
                }
                _ => false,
            };
            if opposite && together(model, &first.schedule, &second.schedule) {
                return Some(twice(first, second));
            }
        }
    }
    None
}

fn twice(first: &InterfaceDefinition, second: &InterfaceDefinition) -> Finding {
    DoctorCause::DoubledInterface.warning(format!(
        "interfaces {} and {} join the same surfaces at the same time: each closes the gap for itself, and friction counts twice",
        first.name, second.name
    ))
    .blame(Suspect::interface(&first.name, ""))
    .blame(Suspect::interface(&second.name, "the same surfaces"))
    .advise("remove one of the two, or list them in different steps (`step.interfaces`); `step.change` changes the laws of one interface")
}

/// Points of the mesh on the secondary and on the primary.
fn nodes(interface: &InterfaceDefinition) -> [BTreeSet<usize>; 2] {
    let primary = interface.nodes[..interface.primary_nodes].iter();
    let secondary = interface.points.iter().flat_map(|p| &p.nodes);
    [
        secondary.map(|&n| interface.nodes[n]).collect(),
        primary.copied().collect(),
    ]
}
