//! From displacements back to strains, stresses, forces and energy.

use super::geometry::{Nodal, Point, Table, by_nodes, coordinates, point};
use super::waves::in_order;
use super::{Elastic, Formulation, Space};
use crate::material::Stiffness;
use crate::mesh::{Block, CellRef};
use crate::system::Dofs;

/// The state of one quadrature point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StressPoint {
    /// The cell.
    pub cell: CellRef,
    /// Place in space [m].
    pub x: [f64; 3],
    /// Volume it stands for [m³].
    pub volume: f64,
    /// Strain xx yy zz xy yz xz, shear strains as engineering strains; in plane stress zz is not filled in.
    pub strain: [f64; 6],
    /// Stress xx yy zz xy yz xz [Pa].
    pub stress: [f64; 6],
}

/// Most quadrature points a cell has: hex20.
const MAX_POINTS: usize = 27;

/// Strain, stress and derivatives at the quadrature points of one cell.
struct Recovered<const N: usize> {
    points: Vec<Point<N>>,
    strain: [[f64; 6]; MAX_POINTS],
    stress: [[f64; 6]; MAX_POINTS],
}

impl<const N: usize> Recovered<N> {
    fn new() -> Self {
        Recovered {
            points: Vec::with_capacity(MAX_POINTS),
            strain: [[0.0; 6]; MAX_POINTS],
            stress: [[0.0; 6]; MAX_POINTS],
        }
    }

    /// Fills it for the cell with nodes `x` displaced by `u`.
    fn compute(&mut self, of: &Medium<N>, x: &Nodal<N>, u: &Nodal<N>) {
        let space = of.space;
        let (dim, used) = (space.dim(), space.derivatives());
        self.points.clear();
        let (mut volume, mut dilatation) = (0.0, 0.0);
        for q in 0..of.table.len() {
            let p = point(&of.table, q, x, space);
            let mut strain = [0.0; 6];
            for (i, ui) in u.iter().enumerate().take(dim) {
                for (k, dk) in p.d.iter().enumerate().take(used) {
                    if let Some(v) = space.component(i, k) {
                        strain[v] += ui.iter().zip(dk).map(|(u, d)| u * d).sum::<f64>();
                    }
                }
            }
            volume += p.volume;
            dilatation += p.volume * trace(&strain);
            self.strain[q] = strain;
            self.points.push(p);
        }
        for (strain, stress) in self
            .strain
            .iter_mut()
            .zip(&mut self.stress)
            .take(of.table.len())
        {
            if of.formulation == Formulation::MeanDilatation {
                let shift = (dilatation / volume - trace(strain)) / 3.0;
                for e in &mut strain[..3] {
                    *e += shift;
                }
            }
            *stress = std::array::from_fn(|v| {
                of.acting[v].iter().zip(&*strain).map(|(c, e)| c * e).sum()
            });
        }
    }

    /// Strain energy of the cell.
    fn energy(&self) -> f64 {
        self.points
            .iter()
            .zip(self.strain.iter().zip(&self.stress))
            .map(|(p, (e, s))| 0.5 * p.volume * e.iter().zip(s).map(|(e, s)| e * s).sum::<f64>())
            .sum()
    }

    /// Internal force of the cell, `dim` components a node. With mean dilatation `B̄ᵀ σ` amounts to replacing the
    /// mean stress at each point by its mean over the cell.
    fn force(&self, of: &Medium<N>, out: &mut [f64]) {
        let (dim, used) = (of.space.dim(), of.space.derivatives());
        let volume: f64 = self.points.iter().map(|p| p.volume).sum();
        let mean: f64 = self
            .points
            .iter()
            .zip(&self.stress)
            .map(|(p, s)| p.volume * trace(s))
            .sum::<f64>()
            / volume;
        out.fill(0.0);
        for (p, stress) in self.points.iter().zip(&self.stress) {
            let mut stress = *stress;
            if of.formulation == Formulation::MeanDilatation {
                let shift = (mean - trace(&stress)) / 3.0;
                for s in &mut stress[..3] {
                    *s += shift;
                }
            }
            for i in 0..dim {
                for (k, dk) in p.d.iter().enumerate().take(used) {
                    if let Some(v) = of.space.component(i, k) {
                        let factor = p.volume * stress[v];
                        for (a, d) in dk.iter().enumerate() {
                            out[a * dim + i] += factor * d;
                        }
                    }
                }
            }
        }
    }
}

fn trace(v: &[f64; 6]) -> f64 {
    v[0] + v[1] + v[2]
}

/// What all cells of a part share.
struct Medium<'a, const N: usize> {
    table: Table<N>,
    space: Space,
    formulation: Formulation,
    acting: &'a Stiffness,
}

/// The values of the cell's points in a dof vector, component by component.
fn gather<const N: usize>(u: &[f64], dofs: Dofs, block: &Block, cell: usize) -> Nodal<N> {
    let mut out = [[0.0; N]; 3];
    for (a, &p) in block.connectivity[cell * N..(cell + 1) * N]
        .iter()
        .enumerate()
    {
        for (i, row) in out.iter_mut().enumerate().take(dofs.dim) {
            row[a] = u[dofs.of(p, i)];
        }
    }
    out
}

impl Elastic {
    fn dofs(&self) -> Dofs {
        Dofs {
            dim: self.space.dim(),
            points: self.mesh.points.len(),
        }
    }

    fn medium<const N: usize>(&self, part: usize) -> Medium<'_, N> {
        let block = &self.mesh.blocks[self.parts[part].block];
        Medium {
            table: Table::new(block.kind, self.space),
            space: self.space,
            formulation: self.formulation,
            acting: &self.acting[part],
        }
    }

    /// Runs `extract` on every cell of a part in parallel and `consume` on its `width` results in order.
    fn each_cell<const N: usize>(
        &self,
        part: usize,
        u: &[f64],
        width: usize,
        extract: impl Fn(&Medium<N>, &Nodal<N>, &Recovered<N>, &mut [f64]) + Sync,
        consume: impl FnMut(usize, &[f64]) + Send,
    ) {
        let block = &self.mesh.blocks[self.parts[part].block];
        let medium = self.medium::<N>(part);
        let dofs = self.dofs();
        in_order(
            block.connectivity.len() / N,
            width,
            |first, values| {
                let mut recovered = Recovered::new();
                for (c, out) in values.chunks_exact_mut(width).enumerate() {
                    let x = coordinates(&self.mesh.points, block, first + c);
                    let v = gather(u, dofs, block, first + c);
                    recovered.compute(&medium, &x, &v);
                    extract(&medium, &x, &recovered, out);
                }
            },
            consume,
        );
    }

    /// Adds the internal force at the displacements `u` [m] to `out` [N], both by dof of the whole mesh.
    pub fn internal_force(&self, u: &[f64], out: &mut [f64]) {
        for (part, p) in self.parts.iter().enumerate() {
            by_nodes!(
                self.mesh.blocks[p.block].kind,
                Elastic::part_force(self, part, u, out)
            );
        }
    }

    fn part_force<const N: usize>(&self, part: usize, u: &[f64], out: &mut [f64]) {
        let block = &self.mesh.blocks[self.parts[part].block];
        let dofs = self.dofs();
        self.each_cell::<N>(
            part,
            u,
            N * dofs.dim,
            |medium, _, recovered, values| recovered.force(medium, values),
            |cell, values| {
                let points = &block.connectivity[cell * N..(cell + 1) * N];
                for (&p, f) in points.iter().zip(values.chunks_exact(dofs.dim)) {
                    for (i, f) in f.iter().enumerate() {
                        out[dofs.of(p, i)] += f;
                    }
                }
            },
        );
    }

    /// Strain energy and volume of every cell of a part, in order.
    pub(super) fn cell_energies(&self, part: usize, u: &[f64]) -> Vec<[f64; 2]> {
        let kind = self.mesh.blocks[self.parts[part].block].kind;
        by_nodes!(kind, Elastic::part_energies(self, part, u))
    }

    fn part_energies<const N: usize>(&self, part: usize, u: &[f64]) -> Vec<[f64; 2]> {
        let mut all = Vec::new();
        self.each_cell::<N>(
            part,
            u,
            2,
            |_, _, recovered, values| {
                values[0] = recovered.energy();
                values[1] = recovered.points.iter().map(|p| p.volume).sum();
            },
            |_, values| all.push([values[0], values[1]]),
        );
        all
    }

    /// The strain energy at the displacements `u` [m], by dof of the whole mesh [J].
    pub fn strain_energy(&self, u: &[f64]) -> f64 {
        (0..self.parts.len())
            .map(|part| {
                self.cell_energies(part, u)
                    .iter()
                    .map(|e| e[0])
                    .sum::<f64>()
            })
            .sum()
    }

    /// The volume of the body [m³], with its thickness or all around its axis.
    pub fn volume(&self) -> f64 {
        let rest = vec![0.0; self.dofs().count()];
        (0..self.parts.len())
            .map(|part| {
                self.cell_energies(part, &rest)
                    .iter()
                    .map(|e| e[1])
                    .sum::<f64>()
            })
            .sum()
    }

    /// Stress and strain at every quadrature point at the displacements `u` [m]; parts, cells and points in order.
    pub fn stress_at_quadrature(&self, u: &[f64]) -> Vec<StressPoint> {
        let mut all = Vec::new();
        for (part, p) in self.parts.iter().enumerate() {
            let kind = self.mesh.blocks[p.block].kind;
            by_nodes!(
                kind,
                Elastic::part_stress(self, part, u, &mut |point| all.push(point))
            );
        }
        all
    }

    /// Visits the quadrature points of a part in order.
    pub(super) fn visit_stress(
        &self,
        part: usize,
        u: &[f64],
        visit: &mut (dyn FnMut(StressPoint) + Send),
    ) {
        let kind = self.mesh.blocks[self.parts[part].block].kind;
        by_nodes!(kind, Elastic::part_stress(self, part, u, visit));
    }

    fn part_stress<const N: usize>(
        &self,
        part: usize,
        u: &[f64],
        visit: &mut (dyn FnMut(StressPoint) + Send),
    ) {
        const WIDTH: usize = 16;
        let block = self.parts[part].block;
        let points = Table::<N>::new(self.mesh.blocks[block].kind, self.space).len();
        self.each_cell::<N>(
            part,
            u,
            points * WIDTH,
            |medium, x, recovered, values| {
                for (q, out) in values.chunks_exact_mut(WIDTH).enumerate() {
                    let n = &medium.table.values[q];
                    for (o, row) in out.iter_mut().zip(x) {
                        *o = n.iter().zip(row).map(|(n, x)| n * x).sum();
                    }
                    out[3] = recovered.points[q].volume;
                    out[4..10].copy_from_slice(&recovered.strain[q]);
                    out[10..16].copy_from_slice(&recovered.stress[q]);
                }
            },
            |cell, values| {
                for v in values.chunks_exact(WIDTH) {
                    visit(StressPoint {
                        cell: CellRef { block, cell },
                        x: [v[0], v[1], v[2]],
                        volume: v[3],
                        strain: std::array::from_fn(|i| v[4 + i]),
                        stress: std::array::from_fn(|i| v[10 + i]),
                    });
                }
            },
        );
    }
}
