//! Output fields of a body.

use super::geometry::by_nodes;
use super::{Elastic, extrapolate};
use crate::system::{Fields, Location, State};

/// The von Mises stress of a stress xx yy zz xy yz xz, in its unit.
fn von_mises(s: &[f64]) -> f64 {
    let normal = (s[0] - s[1]).powi(2) + (s[1] - s[2]).powi(2) + (s[2] - s[0]).powi(2);
    let shear = s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
    (0.5 * normal + 3.0 * shear).sqrt()
}

/// What the output of a body is made of.
struct Recovery {
    /// Stress by point of the body, in the order of [`Elastic::points`].
    stress: Vec<[f64; 6]>,
    /// Strain energy and volume of every cell, part by part.
    cells: Vec<Vec<[f64; 2]>>,
}

/// Stress at the points of a mesh summed over cells, and how many there are.
struct Sums {
    stress: Vec<[f64; 6]>,
    cells: Vec<f64>,
}

impl Elastic {
    /// Stress at the body's points `[Pa]`, six components each, in the order of [`points`](Elastic::points): taken from
    /// the quadrature points to the nodes of each cell by a least-squares fit of the order of the linear element, then
    /// averaged over the cells of this body that meet at the point. Different materials that share points are averaged
    /// too.
    pub fn nodal_stress(&self, u: &[f64]) -> Vec<[f64; 6]> {
        self.recovery(u).stress
    }

    /// Visits every cell once.
    fn recovery(&self, u: &[f64]) -> Recovery {
        // By point of the mesh; points of other bodies stay unused.
        let count = self.mesh.points.len();
        let mut sums = Sums {
            stress: vec![[0.0; 6]; count],
            cells: vec![0.0; count],
        };
        let cells = (self.parts.iter().enumerate())
            .map(|(part, p)| {
                by_nodes!(
                    self.mesh.blocks[p.block].kind,
                    Elastic::part_recovery(self, part, u, &mut sums)
                )
            })
            .collect();
        let mean = |&p: &usize| sums.stress[p].map(|s| s / sums.cells[p]);
        Recovery {
            stress: self.points().iter().map(mean).collect(),
            cells,
        }
    }

    fn part_recovery<const N: usize>(
        &self,
        part: usize,
        u: &[f64],
        sums: &mut Sums,
    ) -> Vec<[f64; 2]> {
        let block = &self.mesh.blocks[self.parts[part].block];
        let fit = extrapolate::matrix(block.kind, self.space, self.formulation);
        let mut energies = Vec::with_capacity(block.connectivity.len() / N);
        self.each_cell::<N>(
            part,
            u,
            6 * N + 2,
            |_, _, recovered, values| {
                let (at_nodes, cell) = values.split_at_mut(6 * N);
                for (out, row) in at_nodes.chunks_exact_mut(6).zip(&fit) {
                    out.fill(0.0);
                    for (weight, stress) in row.iter().zip(&recovered.stress) {
                        for (o, s) in out.iter_mut().zip(stress) {
                            *o += weight * s;
                        }
                    }
                }
                cell.copy_from_slice(&[recovered.energy(), recovered.volume()]);
            },
            |cell, values| {
                let (at_nodes, own) = values.split_at(6 * N);
                let points = &block.connectivity[cell * N..(cell + 1) * N];
                for (&p, stress) in points.iter().zip(at_nodes.chunks_exact(6)) {
                    for (sum, s) in sums.stress[p].iter_mut().zip(stress) {
                        *sum += s;
                    }
                    sums.cells[p] += 1.0;
                }
                energies.push([own[0], own[1]]);
            },
        );
        energies
    }

    /// Adds `S` (points, six components, `[Pa]`), `MISES` (points, `[Pa]`), `SENER` (cells, strain energy per volume
    /// `[J/m³]`) and `ELSE` (cells, strain energy `[J]`).
    ///
    /// `MISES` is that of the averaged stress. Other bodies' points and cells keep what is there, zero at first.
    pub(super) fn add_fields(&self, state: &State, out: &mut Fields) {
        let Recovery { stress, cells } = self.recovery(&state.u);
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
        let count = starts[self.mesh.blocks.len()];
        for (p, energies) in self.parts.iter().zip(&cells) {
            let density = out.shared("SENER", Location::Cell, 1, count, 0.0);
            for (v, [energy, volume]) in density.values[starts[p.block]..].iter_mut().zip(energies)
            {
                *v = energy / volume;
            }
            let whole = out.shared("ELSE", Location::Cell, 1, count, 0.0);
            for (v, [energy, _]) in whole.values[starts[p.block]..].iter_mut().zip(energies) {
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
