//! Unconstrained rigid-body motions.

use super::places;
use super::suspect::Suspect;
use crate::assess::view::View;
use crate::contact::facet_point::evaluate;
use crate::contact::interface::{InterfaceDefinition, Primary};
use crate::contact::look::Opposite;
use crate::contact::response::Status;
use crate::math::Vec3;
use crate::model::definition::Model;
use crate::model::rigid::modes::modes;
use crate::model::rigid::{drivers, held};

/// Something that resists a motion: a linear function of the displacements by dof.
pub(super) type Row = Vec<(usize, f64)>;

/// An unconstrained rigid-body motion.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FloatingBody {
    /// The body that takes the largest part in it.
    pub body: String,
    /// What it is: `translation x with rotation about z`.
    pub motion: String,
}

impl FloatingBody {
    /// The body as a place, with what is said of the motion.
    pub fn place(&self, model: &Model, how: &str) -> Suspect {
        places::body(model, &self.body, format!("{} {how}", self.motion))
    }
}

/// Motions that neither the supports, springs and couplings at `t` nor `rows` hold.
pub(super) fn floating(view: &View, t: f64, rows: &[Row]) -> Vec<FloatingBody> {
    let all = modes(view.model);
    let free = held::unheld_beside(view, t, &all, rows).into_iter();
    let described = free.map(|motion| drivers::describe(view, &all, &motion));
    let each = described.map(|(body, motion)| FloatingBody { body, motion });
    each.collect()
}

/// What a point of an interface resists: the motion along its normal, and all of it where it sticks.
pub(super) fn rows(
    interface: &InterfaceDefinition,
    opposite: &mut Opposite,
    i: usize,
    normal: Vec3,
    status: Status,
    out: &mut Vec<Row>,
) {
    let dim = interface.dofs.dim;
    let directions: Vec<Vec3> = match status {
        Status::Open => return,
        Status::Slip => vec![normal],
        Status::Stick => (0..dim)
            .map(|c| std::array::from_fn(|d| if c == d { 1.0 } else { 0.0 }))
            .collect(),
    };
    let point = &interface.points[i];
    let nearest = opposite.nearest(point.position(&interface.reference));
    for direction in directions {
        let mut row = Row::new();
        let mut add = |local: usize, w: f64| {
            for (c, d) in direction.iter().enumerate().take(dim) {
                row.push((interface.dofs.of(interface.nodes[local], c), w * d));
            }
        };
        for (&node, &w) in point.nodes.iter().zip(&point.weights) {
            add(node, w);
        }
        if let Primary::Facets(facets) = &interface.primary
            && let Some(nearest) = nearest
        {
            let facet = &facets[nearest.facet];
            let x: Vec<Vec3> = facet
                .nodes
                .iter()
                .map(|&n| interface.reference[n])
                .collect();
            let n = evaluate(facet.kind, &x, nearest.xi).n;
            for (&node, w) in facet.nodes.iter().zip(n) {
                add(node, -w);
            }
        }
        out.push(row);
    }
}
