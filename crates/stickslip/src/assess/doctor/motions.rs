//! Unconstrained rigid-body motions.

use super::places;
use super::surfaces::Opposite;
use super::suspect::Suspect;
use crate::assess::view::View;
use crate::contact::facet_point::evaluate;
use crate::contact::interface::{InterfaceDefinition, Primary};
use crate::contact::response::Status;
use crate::math::Vec3;
use crate::model::definition::Model;
use crate::model::rigid::held::NO_RESISTANCE;
use crate::model::rigid::modes::{Mode, modes};
use crate::model::rigid::null_space;

/// Something that resists a motion: a linear function of the displacements by dof.
pub(super) type Row = Vec<(usize, f64)>;

/// Most modes that are looked at together.
const MOST_MODES: usize = 90;

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
    let model = view.model;
    let mut held = view.supported(t);
    for spring in &model.actions.springs {
        for &(dof, stiffness) in spring.entries() {
            held[dof] |= stiffness > 0.0;
        }
    }
    let modes = modes(model);
    if modes.len() > MOST_MODES {
        return Vec::new();
    }
    let along = |mode: &Mode, row: &Row| -> f64 {
        row.iter().map(|&(dof, w)| w * mode.at(model, dof)).sum()
    };
    let coupled = view.couplings().acting(t);
    let coupled: Vec<Row> = coupled.map(|row| row.terms().collect()).collect();
    let at_rows = modes.iter().map(|m| {
        let all = rows.iter().chain(&coupled);
        all.map(|row| along(m, row)).collect::<Vec<f64>>()
    });
    let at_rows: Vec<Vec<f64>> = at_rows.collect();
    let kept: Vec<usize> = (0..held.len()).filter(|&dof| held[dof]).collect();
    let at_held = modes
        .iter()
        .map(|m| kept.iter().map(|&dof| m.at(model, dof)).collect());
    let at_held: Vec<Vec<f64>> = at_held.collect();
    let product = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
    let count = modes.len();
    let gram: Vec<Vec<f64>> = (0..count)
        .map(|i| {
            let entry =
                |j: usize| product(&at_rows[i], &at_rows[j]) + product(&at_held[i], &at_held[j]);
            (0..count).map(entry).collect()
        })
        .collect();
    let mut out = Vec::new();
    for motion in null_space(&gram, NO_RESISTANCE).0 {
        let share = |i: usize| motion[i].abs();
        let Some(first) = (0..count).max_by(|&i, &j| share(i).total_cmp(&share(j))) else {
            continue;
        };
        let body = modes[first].body;
        let parts: Vec<&str> = (0..count)
            .filter(|&i| modes[i].body == body && share(i) > 0.1)
            .map(|i| modes[i].name.as_str())
            .collect();
        out.push(FloatingBody {
            body: model.bodies[body].name.clone(),
            motion: parts.join(" with "),
        });
    }
    out
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
