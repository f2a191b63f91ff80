//! Which points an interface looks at: those that may come into contact soon.

use super::candidates::{closest_of_all, update_candidates};
use super::conditions::{CandidatePoints, Conditions};
use super::definition::{InterfaceDefinition, Primary};
use super::parts::Interface;
use super::search::Search;
use super::view::ContactView;
use crate::contact::kinematics::mean_gap;
use crate::contact::response::Status;
use crate::contact::search::Tree;
use crate::contact::surface::ContactPoint;
use crate::math::{Vec3, distance, dot, sub};

/// How far contact may come before somebody has to look again.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CandidateRange {
    /// Distance from the primary up to which a point of the secondary takes part, beyond what cells call for `[m]`.
    pub distance: f64,
    /// How far points may move along the primary `[m]`.
    pub along: f64,
    /// The time span in which obstacles move `[s]`.
    pub span: [f64; 2],
}

/// Positions of an obstacle that are looked at.
const POSES: usize = 9;

/// Cells beyond the reach that take part all the same: those that carry what the last cell in contact gives to its neighbours. With 0.6 and 6 cells 33 short
/// cases (see [`tolerance`](crate::tolerance)) differ by less than 5e-6 of their largest values, as condensed bodies then have other candidates.
const CELLS_BEYOND_REACH: f64 = 2.0;

/// The points that take part because they are within reach at displacements `u`; marks their nodes and those they may meet among all
/// points of the mesh. What is marked already, and what has been in contact, takes part in any case.
pub fn restrict_to_candidates(
    interface: ContactView,
    u: &[f64],
    range: CandidateRange,
    kept: &mut [bool],
) -> CandidatePoints {
    let x = interface.coordinates(u);
    let distances = distances(interface, &x, range);
    let length = |nodes: &[usize]| distance(x[nodes[0]], x[nodes[1]]);
    let facets = interface.facets().iter().map(|f| length(&f.nodes));
    let size = facets.fold(0.0, f64::max);
    let near = facets_near(interface.definition, &x, &distances, range, size);
    let own = interface.points.iter().map(|p| p.size).fold(0.0, f64::max);
    let limit = range.distance + CELLS_BEYOND_REACH * size.max(own);
    let mut excluded = Vec::with_capacity(distances.len());
    let mut inner = Vec::with_capacity(distances.len());
    for (i, (point, &d)) in interface.points.iter().zip(&distances).enumerate() {
        let known = point.nodes.iter().all(|&n| kept[interface.nodes[n]]);
        let included = d <= limit || known || interface.state.points[i].status != Status::Open;
        excluded.push(!included);
        // Contact is expected to stay within half of the reach.
        inner.push(d <= 0.5 * limit || known);
        if included {
            mark(interface, i, near.get(i), kept);
        }
    }
    if excluded.iter().all(|excluded| !excluded) {
        excluded.clear();
    }
    CandidatePoints { excluded, inner }
}

/// Facets that points may meet which are within reach of the primary, by point; nothing of an obstacle.
fn facets_near(
    interface: &InterfaceDefinition,
    x: &[Vec3],
    distances: &[f64],
    range: CandidateRange,
    size: f64,
) -> Vec<Vec<usize>> {
    let Primary::Facets(facets) = &interface.primary else {
        return Vec::new();
    };
    let tree = Tree::build(facets.iter().map(|f| f.nodes.iter().map(|&n| x[n])));
    let faces = interface.mortar.iter().flat_map(|m| &m.faces);
    let own = faces.map(|f| distance(x[f.nodes[0]], x[f.nodes[1]]));
    let margin = range.along + size + own.fold(0.0, f64::max);
    (interface.points.iter().zip(distances))
        .map(|(point, &d)| {
            let mut near = Vec::new();
            if d <= range.distance + CELLS_BEYOND_REACH * size {
                tree.near(point.position(x), margin, &mut near);
            }
            near
        })
        .collect()
}

/// Marks the nodes of a point, and those of the facets that it may meet or met.
fn mark(interface: ContactView, i: usize, near: Option<&Vec<usize>>, kept: &mut [bool]) {
    let mut keep = |nodes: &[usize]| nodes.iter().for_each(|&n| kept[interface.nodes[n]] = true);
    keep(&interface.points[i].nodes);
    if let Some(mortar) = &interface.mortar {
        for &(f, _) in &mortar.around[i] {
            keep(&mortar.faces[f].nodes);
        }
    }
    if let (Primary::Facets(facets), Some(near)) = (&interface.primary, near) {
        for &f in near.iter().chain(&interface.state.points[i].facet) {
            keep(&facets[f].nodes);
        }
    }
}

/// Lets all points take part and marks all nodes.
pub fn include_all(interface: &InterfaceDefinition, kept: &mut [bool]) -> CandidatePoints {
    for &node in &interface.nodes {
        kept[node] = true;
    }
    CandidatePoints::default()
}

/// Whether contact has come so near to points that do not take part that they should.
pub fn spreads(interface: &Interface, conditions: &Conditions) -> bool {
    let CandidatePoints { excluded, inner } = &conditions.candidates;
    let mut points = interface.cache.last.points.iter().zip(inner);
    !excluded.is_empty() && points.any(|(e, &inner)| !inner && e.response.status != Status::Open)
}

/// Distances from the primary, whatever side of it.
fn distances(interface: ContactView, x: &[Vec3], range: CandidateRange) -> Vec<f64> {
    gaps(interface, x, range)
        .into_iter()
        .map(|g| g.max(0.0))
        .collect()
}

/// The smallest gaps over the span; infinite where a point does not face the primary.
pub(in crate::contact) fn gaps(
    contact: ContactView,
    x: &[Vec3],
    range: CandidateRange,
) -> Vec<f64> {
    let gaps = distances_to_primary(contact.definition, x, range);
    let end = range.span[1];
    let gaps = gaps.into_iter().enumerate();
    gaps.map(|(i, gap)| gap - contact.offset(i, end)).collect()
}

fn distances_to_primary(
    definition: &InterfaceDefinition,
    x: &[Vec3],
    range: CandidateRange,
) -> Vec<f64> {
    match &definition.primary {
        Primary::Rigid(shape, motion) => {
            let [from, to] = range.span;
            let poses: Vec<_> = (0..POSES)
                .map(|k| motion.pose(from + (to - from) * k as f64 / (POSES - 1) as f64))
                .collect();
            let gap = |p: &ContactPoint| {
                let gaps = poses
                    .iter()
                    .filter_map(|pose| mean_gap(shape.as_dyn(), pose, p, x));
                gaps.fold(f64::INFINITY, f64::min)
            };
            definition.points.iter().map(gap).collect()
        }
        Primary::Facets(_) => {
            // A search of its own: what is asked here must leave no trace in what is computed.
            let mut search = Search::default();
            update_candidates(definition, &mut search, x);
            let found = closest_of_all(definition, x, &search)
                .into_iter()
                .enumerate();
            found
                .map(|(i, found)| match found {
                    Ok((_, foot)) => {
                        let away = sub(definition.points[i].position(x), foot.x);
                        dot(away, foot.normal)
                    }
                    Err(distance) => distance,
                })
                .collect()
        }
    }
}
