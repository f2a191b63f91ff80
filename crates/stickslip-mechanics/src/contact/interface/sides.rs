//! The two sides of an interface: which nodes a point hangs on, for what area it stands, and what sliding leaves on them.

use super::definition::InterfaceDefinition;
use super::evaluation::Evaluations;
use super::history::{History, Opposite};
use super::view::ContactView;
use crate::contact::kinematics::Part;

/// Nodes that take part in a point and their weights at the last evaluation.
fn met(last: &Evaluations, i: usize) -> &[(usize, f64)] {
    let e = last.points.get(i).filter(|e| e.over);
    e.map_or(&[], |e| last.batch(i).sides(e))
}

/// Nodes of the primary that a point lies over at the last evaluation and its weights there; nothing where it lies over none.
pub(super) fn facet_weights(
    primary_nodes: usize,
    last: &Evaluations,
    i: usize,
) -> impl Iterator<Item = (usize, f64)> {
    let met = met(last, i).iter();
    met.filter(move |(node, _)| *node < primary_nodes)
        .map(|&(node, w)| (node, -w))
}

/// The same of all points.
pub(super) fn opposite(definition: &InterfaceDefinition, last: &Evaluations) -> Opposite {
    let mut opposite = Opposite::default();
    for i in 0..definition.points.len() {
        opposite.push(facet_weights(definition.primary_nodes, last, i));
    }
    opposite
}

/// Nodes of both sides with the share of the force of a point that each receives: positive on the secondary (but for corners of
/// quadratic faces), negative on the primary.
pub(in crate::contact) fn weights_of(
    definition: &InterfaceDefinition,
    last: &Evaluations,
    i: usize,
) -> impl Iterator<Item = (usize, f64)> {
    let met = met(last, i);
    let alone = met.is_empty();
    let own = definition.own_weights(i).filter(move |_| alone);
    met.iter().copied().chain(own)
}

/// Adds what the last increment dissipated per area at each point to the nodes of the primary that it met: the mean of the
/// points over a node, weighted by their areas there. What slides over the primary so leaves its trace where it was.
pub(super) fn leave_traces(
    definition: &InterfaceDefinition,
    last: &Evaluations,
    traces: &[f64],
    next: &mut History,
) {
    if definition.rigid() || traces.iter().all(|t| *t == 0.0) {
        return;
    }
    let mut sums = vec![[0.0; 2]; definition.nodes.len()];
    let view = ContactView {
        definition,
        state: next,
    };
    for (i, trace) in traces.iter().enumerate() {
        let area = view.area_of(i);
        for (node, w) in facet_weights(definition.primary_nodes, last, i) {
            let share = area * w.max(0.0);
            sums[node][0] += share * trace;
            sums[node][1] += share;
        }
    }
    let all = &mut next.dissipated;
    all.resize(definition.nodes.len(), 0.0);
    for (total, [dissipated, share]) in all.iter_mut().zip(sums) {
        if share > 0.0 {
            *total += dissipated / share;
        }
    }
}

/// The corners of the faces around a point of a mortar.
pub(super) fn faces_around(
    interface: &InterfaceDefinition,
    i: usize,
) -> impl Iterator<Item = Part<'_>> + Clone {
    let faces =
        (interface.mortar.iter()).flat_map(move |m| m.around[i].iter().map(|&(f, _)| &m.faces[f]));
    faces.map(|face| (&face.nodes[..face.kind.corner_count()], 1.0))
}
