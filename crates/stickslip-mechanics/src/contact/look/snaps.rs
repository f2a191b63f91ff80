//! Where points of the secondary are moved before anything is computed, so that they lie on the primary.

use std::sync::Arc;

use crate::contact::interface::search::Search;
use crate::contact::interface::{CLOSE, InterfaceDefinition, InterfaceMesh, Primary, Within};
use crate::contact::surface::{ContactPoint, skin};
use crate::math::{Vec3, add_scaled, dot, normalize, scale, sub};

use crate::contact::interface::candidates::{closest_of_all, update_candidates};

/// How the points of the secondary have to move to lie on the primary, where they are within the tolerance of it at time `t`.
pub fn snaps(definition: &InterfaceDefinition, t: f64) -> Vec<(usize, Vec3)> {
    let points = nodal_points(definition);
    let facets = definition.skin.iter().map(|s| s.facet.clone()).collect();
    let mesh = InterfaceMesh {
        // Faces know their points by number.
        skin: skin(facets, &points, None),
        points,
        ..InterfaceMesh::clone(definition)
    };
    let nodal = InterfaceDefinition {
        mesh: Arc::new(mesh),
        ..definition.clone()
    };
    let x = nodal.reference.clone();
    let feet = feet(&nodal, &x, t);
    let within = definition.initial.within.unwrap_or(CLOSE);
    let near = |i: usize, gap: f64| {
        let size = nodal.points[i].size;
        // A distance is one of the gap: what overlaps is moved out, unless it lies beneath the whole cell and faces something else.
        let deepest = match within {
            Within::Fraction(_) => within.of(size),
            Within::Distance(d) => d.max(size),
        };
        gap != 0.0 && gap <= within.of(size) && -gap <= deepest
    };
    let chosen = |node: usize| {
        let only = definition.initial.only.as_ref();
        only.is_none_or(|only| only.binary_search(&node).is_ok())
    };
    let feet = feet.into_iter().enumerate();
    feet.filter_map(|(i, foot)| Some((i, foot?)))
        .filter(|(i, (gap, _))| near(*i, *gap))
        .map(|(i, (gap, normal))| {
            let node = nodal.nodes[nodal.points[i].nodes[0]];
            (node, scale(-gap, normal))
        })
        .filter(|(node, _)| chosen(*node))
        .collect()
}

/// A point for every node of the secondary, whether contact is checked there or not.
fn nodal_points(definition: &InterfaceDefinition) -> Vec<ContactPoint> {
    let mut of = vec![None; definition.nodes.len()];
    let mut out: Vec<ContactPoint> = Vec::new();
    for point in &definition.points {
        for &node in &point.nodes {
            let k = *of[node].get_or_insert_with(|| {
                out.push(ContactPoint {
                    nodes: vec![node],
                    weights: vec![1.0],
                    normal: [0.0; 3],
                    ..point.clone()
                });
                out.len() - 1
            });
            out[k].normal = add_scaled(out[k].normal, 1.0, point.normal);
        }
    }
    for point in &mut out {
        point.normal = normalize(point.normal).unwrap_or_default();
    }
    out
}

/// Gap and normal of every point at coordinates `x` of the nodes and time `t`; `None` where nothing lies opposite.
fn feet(definition: &InterfaceDefinition, x: &[Vec3], t: f64) -> Vec<Option<(f64, Vec3)>> {
    match &definition.primary {
        Primary::Rigid(shape, motion) => {
            let pose = motion.pose(t);
            let foot = |p: &ContactPoint| {
                let foot = shape.as_dyn().foot(pose.inward(p.position(x)))?;
                Some((foot.gap, pose.turn(foot.normal)))
            };
            definition.points.iter().map(foot).collect()
        }
        Primary::Facets(_) => {
            let mut search = Search::default();
            update_candidates(definition, &mut search, x);
            let feet = closest_of_all(definition, x, &search)
                .into_iter()
                .enumerate();
            feet.map(|(i, found)| {
                let (_, foot) = found.ok()?;
                let away = sub(definition.points[i].position(x), foot.x);
                Some((dot(away, foot.normal), foot.normal))
            })
            .collect()
        }
    }
}
