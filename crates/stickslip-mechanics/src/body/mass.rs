//! Masses of the cells.

use super::geometry::{Table, by_nodes, coordinates, point};
use super::redistribution::{Cell, factors};
use super::{Elastic, Space};
use crate::keep::Keep;
use crate::linear::BlockCsr;
use crate::mesh::{Block, Mesh};
use crate::shape::mass_rule;

/// How the mass of a cell is given to its nodes.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize, Keep,
)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum MassKind {
    /// Consistent: `∫ ρ N_a N_b`.
    #[default]
    Consistent,
    /// Diagonal: that of the consistent matrix, scaled to the mass of the cell
    /// ([`hinton_1976`](stickslip_base::references::hinton_1976)). Positive for all cells; on undistorted linear ones equal shares.
    Lumped,
}

/// Mass `[kg]` (in a plane body of its thickness, around an axis of the full ring).
pub fn total_mass(body: &Elastic) -> f64 {
    let mut total = 0.0;
    cell_masses(body, MassKind::Consistent, None, &mut |_, m| {
        total += m.iter().sum::<f64>();
    });
    total
}

/// Adds the lumped masses, by point.
pub fn add_lumped_mass(body: &Elastic, by_point: &mut [f64]) {
    add_lumped(body, None, by_point);
}

/// Adds the volumes around the points `[m³]`, in the proportions of lumped masses.
pub fn add_lumped_volume(body: &Elastic, by_point: &mut [f64]) {
    add_lumped(body, Some(1.0), by_point);
}

fn add_lumped(body: &Elastic, density: Option<f64>, by_point: &mut [f64]) {
    cell_masses(body, MassKind::Lumped, density, &mut |points, m| {
        let n = points.len();
        for (a, &p) in points.iter().enumerate() {
            by_point[p] += m[a * n + a];
        }
    });
}

/// Adds the mass to a matrix with the pattern of the stiffness. Points that are `light` get none, and the rest of the body has it
/// instead; `false` if there is no rest that could, and they have theirs.
pub fn add_mass(body: &Elastic, kind: MassKind, light: &[bool], matrix: &mut BlockCsr) -> bool {
    let dim = body.space.dim();
    if !body.points().iter().any(|&p| light[p]) {
        cell_masses(body, kind, None, &mut |points, m| {
            spread(points, m, dim, matrix)
        });
        return true;
    }
    let mut cells = Vec::new();
    cell_masses(body, kind, None, &mut |points, m| {
        cells.push(Cell {
            points: points.to_vec(),
            mass: m.to_vec(),
        });
    });
    let factors = factors(&cells, &body.mesh.points, light, dim);
    for (i, cell) in cells.iter_mut().enumerate() {
        if let Some(factors) = &factors {
            let n = cell.points.len();
            for (k, m) in cell.mass.iter_mut().enumerate() {
                let gone = light[cell.points[k / n]] || light[cell.points[k % n]];
                *m *= if gone { 0.0 } else { factors[i] };
            }
        }
        spread(&cell.points, &cell.mass, dim, matrix);
    }
    factors.is_some()
}

/// Hands out the mass matrix of every cell in one direction, shape `(n, n)` row by row, with the cell's points.
/// Visits the masses of the cells, of another density where one is given.
fn cell_masses(
    body: &Elastic,
    kind: MassKind,
    density: Option<f64>,
    visit: &mut dyn FnMut(&[usize], &[f64]),
) {
    for part in &body.parts {
        let block = &body.mesh.blocks[part.block];
        let density = density.unwrap_or(part.density);
        by_nodes!(
            block.kind,
            masses(&body.mesh, block, body.space, density, kind, visit)
        );
    }
}

/// Adds the same matrix in every direction.
fn spread(points: &[usize], mass: &[f64], dim: usize, matrix: &mut BlockCsr) {
    let n = points.len();
    let width = n * dim;
    let mut dense = vec![0.0; width * width];
    for a in 0..n {
        for b in 0..n {
            for i in 0..dim {
                dense[(a * dim + i) * width + b * dim + i] = mass[a * n + b];
            }
        }
    }
    matrix.add_group(points, &dense);
}

fn masses<const N: usize>(
    mesh: &Mesh,
    block: &Block,
    space: Space,
    density: f64,
    kind: MassKind,
    visit: &mut dyn FnMut(&[usize], &[f64]),
) {
    let table = Table::<N>::with_rule(block.kind, &mass_rule(block.kind));
    for cell in 0..block.connectivity.len() / N {
        let x = coordinates(&mesh.points, block, cell);
        let mut m = [[0.0; N]; N];
        let mut total = 0.0;
        for (q, n) in table.values.iter().enumerate() {
            let mass = density * point(&table, q, &x, space).volume;
            total += mass;
            for (row, na) in m.iter_mut().zip(n) {
                for (m, nb) in row.iter_mut().zip(n) {
                    *m += mass * na * nb;
                }
            }
        }
        if kind == MassKind::Lumped {
            let trace: f64 = (0..N).map(|a| m[a][a]).sum();
            for (a, row) in m.iter_mut().enumerate() {
                let own = row[a] / trace * total;
                *row = [0.0; N];
                row[a] = own;
            }
        }
        visit(
            &block.connectivity[cell * N..(cell + 1) * N],
            m.as_flattened(),
        );
    }
}
