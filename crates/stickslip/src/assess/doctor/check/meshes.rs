//! Meshes: bodies in pieces, sides whose cells differ much in size or stiffness.

use std::collections::BTreeMap;

use super::super::finding::{DoctorCause, Finding};
use super::super::places::{body as whole, node};
use super::super::suspect::Suspect;
use super::common::{median, roles, sides};
use super::measured::Measured;
use crate::assess::view::View;
use crate::contact::interface::InterfaceDefinition;
use crate::model::definition::Model;

/// Bodies whose cells do not hang together, one finding each.
pub(crate) fn disconnected(model: &Model) -> Vec<Finding> {
    let mut out = Vec::new();
    for body in &model.bodies {
        let pieces = pieces(model, body);
        let Some(small) = pieces.iter().min_by_key(|p| p.len()) else {
            continue;
        };
        // A cut through a bolt is meant to part it.
        if pieces.len() < 2 || !body.pieces.is_empty() {
            continue;
        }
        let finding = DoctorCause::DisconnectedBody
            .warning(format!(
                "body {} consists of {} pieces that share no nodes, the smallest with {} nodes",
                body.name,
                pieces.len(),
                small.len()
            ))
            .blame(whole(model, &body.name, "in pieces"));
        let small = small.iter().take(4);
        out.push(
            finding
                .blame_all(small.map(|&point| node(model, point, "of the smallest piece")))
                .advise("merge coincident nodes where the mesh was made, or make bodies of the pieces and an interface between them"),
        );
    }
    out
}

/// The points of a body that cells connect, piece by piece; points that no cell uses are left out.
fn pieces(model: &Model, body: &crate::model::Body) -> Vec<Vec<usize>> {
    let first = body.points.start;
    let mut parent: Vec<usize> = (0..body.points.len()).collect();
    let mut used = vec![false; body.points.len()];
    fn root(parent: &mut [usize], mut i: usize) -> usize {
        while parent[i] != i {
            parent[i] = parent[parent[i]];
            i = parent[i];
        }
        i
    }
    for block in &model.mesh.blocks[body.blocks.clone()] {
        for cell in block.connectivity.chunks_exact(block.kind.node_count()) {
            let a = root(&mut parent, cell[0] - first);
            for &node in cell {
                used[node - first] = true;
                let b = root(&mut parent, node - first);
                parent[b] = a;
            }
        }
    }
    let mut pieces: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for i in (0..parent.len()).filter(|&i| used[i]) {
        let r = root(&mut parent, i);
        pieces.entry(r).or_default().push(first + i);
    }
    pieces.into_values().collect()
}

pub(super) fn check(
    view: &View,
    interface: &InterfaceDefinition,
    measured: &Measured,
) -> Vec<Finding> {
    let model = view.model;
    let [Some(ours), Some(theirs)] = sides(model, interface) else {
        return Vec::new();
    };
    let dim = interface.dofs.dim;
    // The places that are nearest to each other: elsewhere meshes may differ.
    let mut near: Vec<(f64, f64)> = Vec::new();
    for ((point, &gap), beside) in interface
        .points
        .iter()
        .zip(&measured.gaps)
        .zip(&measured.nearest)
    {
        let Some(size) = beside.and_then(|b| b.facet).filter(|_| gap.is_finite()) else {
            continue;
        };
        let extent = match dim {
            2 => model.space.extent(point.position(&interface.reference)),
            _ => 1.0,
        };
        let area = point.area / extent;
        let own = match dim {
            2 => area,
            _ => area.sqrt(),
        };
        if own.is_finite() && own > 0.0 {
            near.push((gap, size / own));
        }
    }
    near.sort_by(|a, b| a.0.total_cmp(&b.0));
    near.truncate((near.len() / 4).max(4));
    let size = median(near.iter().map(|n| n.1).collect());
    let mut out = Vec::new();
    let [own, other] = roles(interface);
    let swap = format!(
        "swap `secondary` and `primary` of interface {}",
        interface.name
    );
    // Primary facets below a third of the size of the secondary are worth a warning.
    if size < 1.0 / 3.0 {
        out.push(
            DoctorCause::MeshMismatch.warning(format!(
                "interface {}: the primary (body {theirs}) is {:.1} times finer than the secondary (body {ours})",
                interface.name,
                1.0 / size
            ))
            .blame(Suspect::interface(&interface.name, format!("cells 1 : {:.1}", 1.0 / size)))
            .blame(whole(model, &theirs, "finer"))
            .advise(format!("{swap}: contact is checked at the secondary, which should be the finer side")),
        );
    } else if size > 8.0 {
        // So are those of more than eight times the size.
        out.push(
            DoctorCause::MeshMismatch.warning(format!(
                "interface {}: the cells of the {other} (body {theirs}) are {size:.1} times as large as those of the {own} (body {ours})",
                interface.name
            ))
            .blame(Suspect::interface(&interface.name, format!("cells {size:.1} : 1")))
            .blame(whole(model, &theirs, "coarse"))
            .advise(format!("refine body {theirs} where it is touched: its facets bend pressures and its cells cannot follow them")),
        );
    }
    if let Some(ratio) = softer(model, &ours, &theirs)
        // A primary with a smaller modulus relative to that of the secondary is much softer.
        && ratio < 0.05
        && !interface.exchanged
        && size < 1.5
    {
        out.push(
            DoctorCause::SofterPrimary.note(format!(
                "interface {}: the primary (body {theirs}) is {:.0} times softer than the secondary (body {ours}) and not coarser",
                interface.name,
                1.0 / ratio
            ))
            .blame(Suspect::interface(&interface.name, ""))
            .blame(whole(model, &theirs, "softer"))
            .advise(format!("{swap}: the stiffer side is the better primary")),
        );
    }
    out
}

/// Largest modulus of the primary over that of the secondary; `None` where one of them is rigid.
fn softer(model: &Model, secondary: &str, primary: &str) -> Option<f64> {
    let modulus = |name: &str| {
        let body = model.bodies.iter().find(|b| b.name == name)?;
        if body.rigid.is_some() {
            return None;
        }
        let blocks = body.blocks.clone();
        let all = blocks.filter_map(|b| body.elastic.constrained_modulus(b));
        all.reduce(f64::max)
    };
    Some(modulus(primary)? / modulus(secondary)?)
}
