//! The smoothed prolongation: what a coarse node does to the nodes of its aggregate and around it.

use super::aggregate::OUTSIDE;
use super::blocks::{Block, Blocks, Rows, add_product, zero};

/// What a level knows of its nodes besides the matrix.
#[derive(Debug, Clone)]
pub(super) struct Nodes<const B: usize, const M: usize> {
    /// Rigid modes: the values of the `M` modes at the dofs of each node.
    pub modes: Vec<Block<f64, B, M>>,
    /// Coordinates.
    pub places: Vec<[f64; 3]>,
    /// Aggregates never cross groups; [`OUTSIDE`] has no dof at all.
    pub groups: Vec<u32>,
    /// Whether the node carries gap variables.
    pub gaps: Vec<bool>,
}

/// A direction for every node whose modes are to be split.
pub(super) type Normals = [Option<[f64; 3]>];

/// The tentative prolongation, whose columns are orthonormal and contain the rigid modes, and the coarse nodes.
///
/// The aggregates of nodes with a normal become two coarse nodes, one that moves along the normals and one across:
/// a stiffness on one of the two leaves the other alone. Where modes depend on each other, columns are zero.
pub(super) fn tentative<const B: usize, const M: usize>(
    nodes: &Nodes<B, M>,
    normals: &Normals,
    of: &[u32],
    count: usize,
) -> (Blocks<f64, B, M>, Nodes<M, M>) {
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); count];
    for (node, &aggregate) in of.iter().enumerate() {
        if aggregate != OUTSIDE {
            members[aggregate as usize].push(node);
        }
    }
    let mut coarse = Nodes {
        modes: Vec::new(),
        places: Vec::new(),
        groups: Vec::new(),
        gaps: Vec::new(),
    };
    let mut parts: Vec<Vec<(u32, Block<f64, B, M>)>> = vec![Vec::new(); of.len()];
    for members in &members {
        let first = members[0];
        let mut centre = [0.0; 3];
        for &node in members {
            for (c, x) in centre.iter_mut().zip(nodes.places[node]) {
                *c += x / members.len() as f64;
            }
        }
        let mut add = |values: Vec<Block<f64, B, M>>, group: u32| {
            let (columns, modes) = orthonormal(&values, centre);
            // Nothing moves: all members are fixed, or normal to what is asked for.
            if modes.as_flattened().iter().all(|&v| v == 0.0) {
                return;
            }
            let index = coarse.modes.len() as u32;
            for (&node, column) in members.iter().zip(columns) {
                parts[node].push((index, column));
            }
            coarse.modes.push(modes);
            coarse.places.push(centre);
            coarse.groups.push(group);
            coarse.gaps.push(nodes.gaps[first]);
        };
        let group = nodes.groups[first];
        if normals[first].is_some() {
            let split = |along: bool| -> Vec<Block<f64, B, M>> {
                let values = members.iter().map(|&node| {
                    let normal = normals[node].unwrap_or_default();
                    project(&nodes.modes[node], &normal, along)
                });
                values.collect()
            };
            add(split(true), group);
            add(split(false), group + 1);
        } else {
            add(
                members.iter().map(|&node| nodes.modes[node]).collect(),
                group,
            );
        }
    }
    let matrix = Blocks::build(of.len(), coarse.modes.len(), |node, out| {
        for (column, value) in &parts[node] {
            *out.block(*column) = *value;
        }
    });
    (matrix, coarse)
}

/// The part of the modes of a node along its normal, or across.
fn project<const B: usize, const M: usize>(
    modes: &Block<f64, B, M>,
    normal: &[f64; 3],
    along: bool,
) -> Block<f64, B, M> {
    let mut out = if along { zero() } else { *modes };
    let sign = if along { 1.0 } else { -1.0 };
    for m in 0..M {
        let component: f64 = (0..B).map(|c| normal[c] * modes[c][m]).sum();
        for (out, n) in out.iter_mut().zip(normal) {
            out[m] += sign * component * n;
        }
    }
    out
}

/// Orthonormal columns that span the modes of an aggregate, and the modes in terms of them.
fn orthonormal<const B: usize, const M: usize>(
    modes: &[Block<f64, B, M>],
    centre: [f64; 3],
) -> (Vec<Block<f64, B, M>>, Block<f64, M, M>) {
    // Rotations about the centre, so that they do not look like translations far from the origin.
    let shift = centring::<M>(centre);
    let mut columns: Vec<Block<f64, B, M>> = modes
        .iter()
        .map(|mode| {
            let mut out = zero();
            add_product(&mut out, mode, &shift);
            out
        })
        .collect();
    let dot = |columns: &[Block<f64, B, M>], i: usize, j: usize| -> f64 {
        let rows = columns.iter().flatten();
        rows.map(|row| row[i] * row[j]).sum()
    };
    let scale = (0..M).map(|m| {
        let rows = modes.iter().flatten();
        rows.map(|row| row[m] * row[m]).sum::<f64>().sqrt()
    });
    let scales: Vec<f64> = scale.collect();
    for m in 0..M {
        let before = dot(&columns, m, m).sqrt();
        for _ in 0..2 {
            for k in 0..m {
                let component = dot(&columns, k, m);
                for row in columns.iter_mut().flatten() {
                    row[m] -= component * row[k];
                }
            }
        }
        let after = dot(&columns, m, m).sqrt();
        // A mode depends on those before it if less than 1e-3 of its remainder is left, or less of the modes of the whole aggregate than
        // rounding leaves.
        let keep = after > 1e-3 * before && after > 1e-10 * scales[m];
        let factor = if keep { 1.0 / after } else { 0.0 };
        for row in columns.iter_mut().flatten() {
            row[m] *= factor;
        }
    }
    let mut coarse = zero();
    for (column, mode) in columns.iter().zip(modes) {
        super::blocks::add_transposed(&mut coarse, column, mode);
    }
    (columns, coarse)
}

/// The matrix that turns rigid modes about the origin into those about a centre.
fn centring<const M: usize>(centre: [f64; 3]) -> Block<f64, M, M> {
    let mut shift = zero();
    for (m, row) in shift.iter_mut().enumerate() {
        row[m] = 1.0;
    }
    let dimension = if M == 6 { 3 } else { 2 };
    for (m, row) in rigid_modes::<3, M>(centre)
        .iter()
        .take(dimension)
        .enumerate()
    {
        for rotation in dimension..M {
            shift[m][rotation] = -row[rotation];
        }
    }
    shift
}

/// The rigid modes at a place: translations, then rotations about the origin, one about z in 2D.
pub(super) fn rigid_modes<const B: usize, const M: usize>(place: [f64; 3]) -> Block<f64, B, M> {
    let [x, y, z] = place;
    let mut modes = zero();
    let rotations: &[[f64; 3]] = if M == 6 {
        &[[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]]
    } else {
        &[[-y, x, 0.0]]
    };
    let dimension = M - rotations.len();
    for (c, row) in modes.iter_mut().enumerate().take(dimension) {
        row[c] = 1.0;
        for (k, rotation) in rotations.iter().enumerate() {
            row[dimension + k] = rotation[c];
        }
    }
    modes
}

/// `(1 - ω D⁻¹ A) P` in the rows of nodes without gap variables; `inverse` is `D⁻¹`.
///
/// Rows of gap variables are not smoothed. So a coarse function that moves a body leaves the gaps alone, whatever
/// stiffness comes to act on them later, and that stiffness stays block-diagonal on every level.
pub(super) fn smoothed<const B: usize, const M: usize>(
    matrix: &impl Rows<B>,
    inverse: &[Block<f64, B, B>],
    damping: f64,
    nodes: &Nodes<B, M>,
    tentative: &Blocks<f64, B, M>,
    coarse: usize,
) -> Blocks<f32, B, M> {
    Blocks::build(matrix.count(), coarse, |row, out| {
        if !nodes.gaps[row] && nodes.groups[row] != OUTSIDE {
            let (columns, blocks) = matrix.row(row);
            for (&j, a) in columns.iter().zip(blocks) {
                let (parts, values) = tentative.row(j as usize);
                for (&node, p) in parts.iter().zip(values) {
                    add_product(out.block(node), a, p);
                }
            }
            for value in &mut out.values {
                let mut step = zero();
                add_product(&mut step, &inverse[row], value);
                *value = step.map(|row| row.map(|v| -damping * v));
            }
        }
        let (parts, values) = tentative.row(row);
        for (&node, p) in parts.iter().zip(values) {
            let target = out.block(node).iter_mut().flatten();
            for (t, p) in target.zip(p.as_flattened()) {
                *t += p;
            }
        }
    })
}
