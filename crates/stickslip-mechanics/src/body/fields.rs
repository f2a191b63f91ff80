//! Output fields of a body.

use super::{Elastic, extrapolate};
use crate::system::{Fields, Location, State};

/// The von Mises stress of a stress xx yy zz xy yz xz, in its unit.
fn von_mises(s: &[f64]) -> f64 {
    let normal = (s[0] - s[1]).powi(2) + (s[1] - s[2]).powi(2) + (s[2] - s[0]).powi(2);
    let shear = s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
    (0.5 * normal + 3.0 * shear).sqrt()
}

impl Elastic {
    /// Stress at the body's points `[Pa]`, six components each, in the order of [`points`](Elastic::points): taken from
    /// the quadrature points to the nodes of each cell by a least-squares fit of the order of the linear element, then
    /// averaged over the cells of this body that meet at the point. Different materials that share points are averaged
    /// too.
    pub fn nodal_stress(&self, u: &[f64]) -> Vec<[f64; 6]> {
        // By point of the mesh; points of other bodies stay unused.
        let count = self.mesh.points.len();
        let mut sum = vec![[0.0; 6]; count];
        let mut cells = vec![0.0; count];
        for (part, p) in self.parts.iter().enumerate() {
            let block = &self.mesh.blocks[p.block];
            let nodes = block.kind.node_count();
            let fit = extrapolate::matrix(block.kind, self.space, self.formulation);
            let per_cell = fit[0].len();
            let mut q = 0;
            self.visit_stress(part, u, &mut |point| {
                let connectivity = &block.connectivity[point.cell.cell * nodes..][..nodes];
                for (&p, row) in connectivity.iter().zip(&fit) {
                    for (s, value) in sum[p].iter_mut().zip(point.stress) {
                        *s += row[q] * value;
                    }
                    if q == 0 {
                        cells[p] += 1.0;
                    }
                }
                q = (q + 1) % per_cell;
            });
        }
        self.points()
            .iter()
            .map(|&p| sum[p].map(|s| s / cells[p]))
            .collect()
    }

    /// Adds `S` (points, six components, `[Pa]`), `MISES` (points, `[Pa]`), `SENER` (cells, strain energy per volume
    /// `[J/m³]`) and `ELSE` (cells, strain energy `[J]`).
    ///
    /// `MISES` is that of the averaged stress. Other bodies' points and cells keep what is there, zero at first.
    pub(super) fn add_fields(&self, state: &State, out: &mut Fields) {
        let stress = self.nodal_stress(&state.u);
        let count = self.mesh.points.len();
        let s = out.shared("S", Location::Point, 6, count, 0.0);
        for (&p, stress) in self.points().iter().zip(&stress) {
            s.values[6 * p..6 * p + 6].copy_from_slice(stress);
        }
        let mises = out.shared("MISES", Location::Point, 1, count, 0.0);
        for (&p, stress) in self.points().iter().zip(&stress) {
            mises.values[p] = von_mises(stress);
        }
        let starts = block_starts(self);
        let cells = starts[self.mesh.blocks.len()];
        for (part, p) in self.parts.iter().enumerate() {
            let energies = self.cell_energies(part, &state.u);
            let density = out.shared("SENER", Location::Cell, 1, cells, 0.0);
            for (v, [energy, volume]) in density.values[starts[p.block]..].iter_mut().zip(&energies)
            {
                *v = energy / volume;
            }
            let whole = out.shared("ELSE", Location::Cell, 1, cells, 0.0);
            for (v, [energy, _]) in whole.values[starts[p.block]..].iter_mut().zip(&energies) {
                *v = *energy;
            }
        }
    }
}

/// The index of the first cell of each block among all cells, and the number of cells at the end.
fn block_starts(body: &Elastic) -> Vec<usize> {
    let mut starts = vec![0];
    for block in &body.mesh.blocks {
        let cells = block.connectivity.len() / block.kind.node_count();
        starts.push(starts[starts.len() - 1] + cells);
    }
    starts
}
