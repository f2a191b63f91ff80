//! Displacements and loads that strain bodies more than small strains allow.

use super::super::finding::{DoctorCause, Finding};
use super::super::places::{body as whole, bounds};
use super::super::suspect::Suspect;
use super::driven::{apart, approach, pair};
use super::measured::Measured;
use crate::body::Space;
use crate::contact::interface::InterfaceDefinition;
use crate::math::sub;
use crate::model::definition::{Body, Model};
use crate::model::scene::Scene;
use crate::number::figure;

/// Strain of a whole body from which nothing of a linear body can be trusted; loads that are spread over it strain it by half of what is
/// counted. Small strains are wrong by half of themselves: by a tenth. With 0.06 sound examples are
/// blamed; tests of planted defects pass with 0.6. It decides what is said, and no result.
pub(super) const LARGE_STRAIN: f64 = 0.2;

fn finding(message: String) -> Finding {
    DoctorCause::LargeStrain.warning(message)
        .advise("check the value and its units: bodies are linear, with small strains, and results beyond are not to be trusted")
}

/// Supports and loads that strain one body.
pub(super) fn check(model: &Model) -> Vec<Finding> {
    let mut out = Vec::new();
    for body in model.elastic() {
        out.extend(pulled(model, body).or_else(|| loaded(model, body)));
    }
    out
}

/// Two supports of a body that move by different ways.
fn pulled(model: &Model, body: &Body) -> Option<Finding> {
    // Points, component and displacement at factor one of each support of the body.
    let mut held: Vec<(usize, usize, f64, Vec<usize>)> = Vec::new();
    for (k, support) in model.actions.supports.iter().enumerate() {
        for c in 0..model.dofs.dim {
            let entries = support.entries.iter().filter(|e| {
                let (point, component) = model.dofs.locate(e.dof);
                component == c && body.points.contains(&point)
            });
            let entries: Vec<_> = entries.collect();
            let points: Vec<usize> = entries.iter().map(|e| model.dofs.locate(e.dof).0).collect();
            if let Some(first) = entries.first() {
                let value = if first.hold { 0.0 } else { first.value };
                held.push((k, c, value, points));
            }
        }
    }
    for (i, (a, c, u, there)) in held.iter().enumerate() {
        for (b, d, v, here) in &held[..i] {
            if c != d || a == b {
                continue;
            }
            let length = apart(model, there, here);
            for t in super::common::times(model) {
                let (s, r) = (&model.actions.supports[*a], &model.actions.supports[*b]);
                if !(s.schedule.active(t) && r.schedule.active(t)) {
                    continue;
                }
                let strain = (s.schedule.at(t) * u - r.schedule.at(t) * v).abs() / length;
                if strain > LARGE_STRAIN && strain.is_finite() {
                    let (first, second) = (&r.name, &s.name);
                    return Some(
                        finding(format!(
                            "supports {first} and {second} strain body {} by {strain:.2}: their displacements in {} differ by {} over {length}",
                            body.name,
                            ["x", "y", "z"][*c],
                            figure(strain * length), length = figure(length)))
                        .blame(whole(model, &body.name, format!("strain {strain:.2}")))
                        .blame(Suspect::key(format!("support.{first}"), ""))
                        .blame(Suspect::key(format!("support.{second}"), "")),
                    );
                }
            }
        }
    }
    None
}

/// A load whose resultant over the cross-section of a body strains it too much.
fn loaded(model: &Model, body: &Body) -> Option<Finding> {
    let blocks = body.blocks.clone();
    let moduli = blocks.filter_map(|b| body.elastic.constrained_modulus(b));
    let modulus = moduli.reduce(f64::min)?;
    let (low, high) = bounds(&model.mesh.points[body.points.clone()]);
    let extent = sub(high, low);
    let section = |c: usize| match model.space {
        Space::PlaneStrain { thickness } | Space::PlaneStress { thickness } => {
            thickness * extent[1 - c]
        }
        Space::Axisymmetric if c == 0 => std::f64::consts::TAU * high[0] * extent[1],
        Space::Axisymmetric => std::f64::consts::PI * (high[0] * high[0] - low[0] * low[0]),
        Space::Solid => (0..3).filter(|&d| d != c).map(|d| extent[d]).product(),
    };
    for load in &model.actions.loads {
        let times = super::common::times(model);
        let factor = times
            .iter()
            .fold(0.0_f64, |m, &t| m.max(load.schedule.at(t).abs()));
        let mut force = [0.0; 3];
        for &(dof, f) in &load.entries {
            let (point, c) = model.dofs.locate(dof);
            if body.points.contains(&point) {
                force[c] += factor * f;
            }
        }
        for (c, force) in force.iter().enumerate().take(model.dofs.dim) {
            let strain = force.abs() / (modulus * section(c));
            if strain > LARGE_STRAIN && strain.is_finite() {
                return Some(
                    finding(format!(
                        "load {} strains body {} by about {strain:.2}: {} on a section of {} with a modulus of {modulus}",
                        load.name,
                        body.name,
                        figure(force.abs()),
                        figure(section(c)), modulus = figure(modulus)))
                    .blame(whole(model, &body.name, format!("strain {strain:.2}")))
                    .blame(Suspect::key(format!("load.{}", load.name), "")),
                );
            }
        }
    }
    None
}

/// Sides of an interface that are pressed into each other by a large part of their bodies.
pub(super) fn pressed(
    scene: &Scene,
    interface: &InterfaceDefinition,
    measured: &Measured,
) -> Option<Finding> {
    let model = scene.model;
    let gaps = measured.gaps.iter().enumerate().filter(|g| g.1.is_finite());
    let (i, &gap) = gaps.min_by(|a, b| a.1.total_cmp(b.1))?;
    let x = interface.points[i].position(&interface.reference);
    let normal = measured.nearest[i].as_ref()?.normal;
    let way = approach(scene, interface, x, normal).filter(|a| a.both)?;
    let depth = way.most - gap.max(0.0);
    // What of a body lies along the normal takes its part of the approach.
    let sides = pair(model, interface);
    let elastic = sides.iter().flatten().map(|&b| &model.bodies[b]);
    let elastic: Vec<&Body> = elastic.filter(|b| b.rigid.is_none()).collect();
    let length: f64 = elastic
        .iter()
        .map(|b| {
            let (low, high) = bounds(&model.mesh.points[b.points.clone()]);
            (0..3)
                .map(|c| normal[c].abs() * (high[c] - low[c]))
                .sum::<f64>()
        })
        .sum();
    let strain = depth / length;
    if !(strain > LARGE_STRAIN && strain.is_finite()) {
        return None;
    }
    let found = finding(format!(
        "interface {}: the prescribed displacements overlap its sides by {depth}, a strain of {strain:.2} in the bodies behind them",
        interface.name,
        depth = figure(depth),
    ))
    .blame(Suspect::interface(&interface.name, format!("pressed by {}", figure(depth))));
    let strained = |b: &&Body| whole(model, &b.name, format!("strain about {strain:.2}"));
    Some(found.blame_all(elastic.iter().map(strained)))
}
