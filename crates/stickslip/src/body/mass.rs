//! Masses of the cells.

use super::geometry::{Table, by_nodes, coordinates, point};
use super::{Elastic, Space};
use crate::linear::BlockCsr;
use crate::mesh::{Block, Mesh};
use crate::shape::{ElementKind, mass_rule};

/// How the mass of a cell is given to its nodes.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Default,
    serde::Serialize,
    serde::Deserialize,
    schemars::JsonSchema,
)]
#[serde(rename_all = "kebab-case")]
pub enum MassKind {
    /// `∫ ρ N_a N_b`: what the shape functions say.
    #[default]
    Consistent,
    /// Diagonal: that of the consistent matrix, scaled to the mass of the cell
    /// ([`hinton_1976`](crate::references::hinton_1976)). Positive for all cells; on undistorted linear ones equal shares.
    Lumped,
}

/// Masses of one cell.
struct CellMass<const N: usize> {
    /// `∫ ρ N_a N_b dV`.
    m: [[f64; N]; N],
    /// `∫ ρ dV`.
    total: f64,
}

impl<const N: usize> CellMass<N> {
    /// Shares of the nodes in a diagonal matrix.
    fn lumped(&self) -> [f64; N] {
        let trace: f64 = (0..N).map(|a| self.m[a][a]).sum();
        std::array::from_fn(|a| self.m[a][a] / trace * self.total)
    }
}

impl Elastic {
    /// Mass `[kg]` (in a plane body of its thickness, around an axis of the full ring).
    pub fn total_mass(&self) -> f64 {
        let mut total = 0.0;
        self.each_mass(&mut |_, _, m| total += m);
        total
    }

    /// Adds the masses to the diagonal, by point.
    pub fn add_lumped_mass(&self, by_point: &mut [f64]) {
        self.each_mass(&mut |points, m, _| {
            for (&p, m) in points.iter().zip(m) {
                by_point[p] += m;
            }
        });
    }

    /// Adds `∫ ρ N_a N_b` in every direction to a matrix with the pattern of the stiffness.
    pub fn add_consistent_mass(&self, matrix: &mut BlockCsr) {
        let dim = self.space.dim();
        for part in &self.parts {
            let block = &self.mesh.blocks[part.block];
            by_nodes!(
                block.kind,
                consistent(&self.mesh, block, self.space, part.density, dim, matrix)
            );
        }
    }

    /// Hands out the nodes of every cell, its lumped masses and its mass.
    fn each_mass(&self, visit: &mut dyn FnMut(&[usize], &[f64], f64)) {
        for part in &self.parts {
            let block = &self.mesh.blocks[part.block];
            by_nodes!(
                block.kind,
                lumped(&self.mesh, block, self.space, part.density, visit)
            );
        }
    }
}

fn table<const N: usize>(kind: ElementKind) -> Table<N> {
    Table::with_rule(kind, &mass_rule(kind))
}

fn cell_mass<const N: usize>(
    table: &Table<N>,
    mesh: &Mesh,
    block: &Block,
    cell: usize,
    space: Space,
    density: f64,
) -> CellMass<N> {
    let x = coordinates(&mesh.points, block, cell);
    let mut out = CellMass {
        m: [[0.0; N]; N],
        total: 0.0,
    };
    for (q, n) in table.values.iter().enumerate() {
        let mass = density * point(table, q, &x, space).volume;
        out.total += mass;
        for (row, na) in out.m.iter_mut().zip(n) {
            for (m, nb) in row.iter_mut().zip(n) {
                *m += mass * na * nb;
            }
        }
    }
    out
}

fn consistent<const N: usize>(
    mesh: &Mesh,
    block: &Block,
    space: Space,
    density: f64,
    dim: usize,
    matrix: &mut BlockCsr,
) {
    let table = table::<N>(block.kind);
    let width = N * dim;
    let mut dense = vec![0.0; width * width];
    for cell in 0..block.connectivity.len() / N {
        let mass = cell_mass(&table, mesh, block, cell, space, density);
        for a in 0..N {
            for b in 0..N {
                for i in 0..dim {
                    dense[(a * dim + i) * width + b * dim + i] = mass.m[a][b];
                }
            }
        }
        matrix.add_group(&block.connectivity[cell * N..(cell + 1) * N], &dense);
    }
}

fn lumped<const N: usize>(
    mesh: &Mesh,
    block: &Block,
    space: Space,
    density: f64,
    visit: &mut dyn FnMut(&[usize], &[f64], f64),
) {
    let table = table::<N>(block.kind);
    for cell in 0..block.connectivity.len() / N {
        let mass = cell_mass(&table, mesh, block, cell, space, density);
        let points = &block.connectivity[cell * N..(cell + 1) * N];
        visit(points, &mass.lumped(), mass.total);
    }
}
