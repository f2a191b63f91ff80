//! From displacements back to strains, stresses, forces and energy.

use super::geometry::{Nodal, Point, by_nodes, coordinates, point};
use super::hourglass::MODES;
use super::medium::Medium;
use super::scheme::Scheme;
use super::waves::in_order;
use super::{Elastic, Space, hourglass};
use crate::material::Stiffness;
use crate::mesh::{Block, CellRef};
use crate::system::Dofs;

/// The state of one quadrature point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StressPoint {
    /// The cell.
    pub cell: CellRef,
    /// Place in space `[m]`.
    pub x: [f64; 3],
    /// Volume it stands for `[m³]`.
    pub volume: f64,
    /// Strain xx yy zz xy yz xz, shear strains as engineering strains; in plane stress zz is not filled in.
    pub strain: [f64; 6],
    /// Stress xx yy zz xy yz xz `[Pa]`.
    pub stress: [f64; 6],
}

/// Most quadrature points a cell has: hex20.
const MAX_POINTS: usize = 27;

/// Strain, stress and derivatives at the points of one cell that have stresses.
pub(super) struct Recovered<const N: usize> {
    /// Derivatives and volumes there; with uniform strain the means.
    pub points: Vec<Point<N>>,
    pub strain: [[f64; 6]; MAX_POINTS],
    pub stress: [[f64; 6]; MAX_POINTS],
    /// The mean dilatation of the cell.
    dilatation: f64,
    /// `√κ γ` of the motions without strain.
    vectors: [[f64; N]; MODES],
    /// How much of them there is, a direction each.
    amplitudes: [[f64; 3]; MODES],
}

/// Strain at a point of a cell displaced by `u`, as the displacements give it.
pub(super) fn strain_of<const N: usize>(p: &Point<N>, u: &Nodal<N>, space: Space) -> [f64; 6] {
    let (dim, used) = (space.dim(), space.derivatives());
    let mut strain = [0.0; 6];
    for (i, ui) in u.iter().enumerate().take(dim) {
        for (k, dk) in p.d.iter().enumerate().take(used) {
            if let Some(v) = space.component(i, k) {
                strain[v] += ui.iter().zip(dk).map(|(u, d)| u * d).sum::<f64>();
            }
        }
    }
    strain
}

/// `C ε`.
pub(super) fn stress_of(c: &Stiffness, strain: &[f64; 6]) -> [f64; 6] {
    std::array::from_fn(|v| c[v].iter().zip(strain).map(|(c, e)| c * e).sum())
}

impl<const N: usize> Recovered<N> {
    pub fn new() -> Self {
        Recovered {
            points: Vec::with_capacity(MAX_POINTS),
            strain: [[0.0; 6]; MAX_POINTS],
            stress: [[0.0; 6]; MAX_POINTS],
            dilatation: 0.0,
            vectors: [[0.0; N]; MODES],
            amplitudes: [[0.0; 3]; MODES],
        }
    }

    /// Fills it for the cell with nodes `x` displaced by `u`.
    pub fn compute(&mut self, of: &Medium<N>, x: &Nodal<N>, u: &Nodal<N>) {
        let space = of.space;
        self.points.clear();
        self.points
            .extend((0..of.table.len()).map(|q| point(&of.table, q, x, space)));
        if of.scheme == Scheme::Uniform {
            let mean = hourglass::mean(&self.points);
            self.vectors = of
                .hourglass
                .vectors(x, &of.table, &self.points, &mean, of.modulus);
            let each = self.amplitudes.iter_mut().zip(&self.vectors);
            for ((amplitude, v), directions) in each.zip(of.hourglass.directions()) {
                for i in directions {
                    amplitude[i] = v.iter().zip(&u[i]).map(|(v, u)| v * u).sum();
                }
            }
            self.points.clear();
            self.points.push(mean);
        }
        let count = self.points.len();
        let (mut volume, mut dilatation) = (0.0, 0.0);
        for (p, strain) in self.points.iter().zip(&mut self.strain) {
            *strain = strain_of(p, u, space);
            volume += p.volume;
            dilatation += p.volume * trace(strain);
        }
        self.dilatation = dilatation / volume;
        if of.scheme == Scheme::MeanDilatation {
            for strain in &mut self.strain[..count] {
                shift(strain, self.dilatation);
            }
        }
        self.set_stress(of);
        if of.scheme == Scheme::Incompatible {
            of.modes.add_strains(
                x,
                &self.points,
                space,
                &of.operator.local,
                &self.stress[..count],
                &mut self.strain[..count],
            );
            self.set_stress(of);
        }
    }

    fn set_stress(&mut self, of: &Medium<N>) {
        for (strain, stress) in self
            .strain
            .iter()
            .zip(&mut self.stress)
            .take(self.points.len())
        {
            *stress = stress_of(&of.acting, strain);
        }
    }

    /// The strain at another point of the cell last computed, whose strains are those of its displacements `u` but for the
    /// dilatation.
    pub fn strain_at(&self, of: &Medium<N>, p: &Point<N>, u: &Nodal<N>) -> [f64; 6] {
        let mut strain = strain_of(p, u, of.space);
        if of.scheme == Scheme::MeanDilatation {
            shift(&mut strain, self.dilatation);
        }
        strain
    }

    /// Strain energy of the cell.
    pub fn energy(&self) -> f64 {
        let inside: f64 = self
            .points
            .iter()
            .zip(self.strain.iter().zip(&self.stress))
            .map(|(p, (e, s))| 0.5 * p.volume * e.iter().zip(s).map(|(e, s)| e * s).sum::<f64>())
            .sum();
        inside + self.hourglass()
    }

    /// What of it is energy of the motions without strain.
    pub fn hourglass(&self) -> f64 {
        let squares = self.amplitudes.as_flattened().iter().map(|a| a * a);
        0.5 * squares.sum::<f64>()
    }

    /// Volume of the cell.
    pub fn volume(&self) -> f64 {
        self.points.iter().map(|p| p.volume).sum()
    }

    /// Internal force of the cell, `dim` components a node. With mean dilatation `B̄ᵀ σ` amounts to replacing the
    /// mean stress at each point by its mean over the cell. Modes inside the cell add nothing: they are in equilibrium.
    pub fn force(&self, of: &Medium<N>, out: &mut [f64]) {
        let (dim, used) = (of.space.dim(), of.space.derivatives());
        let mean: f64 = self
            .points
            .iter()
            .zip(&self.stress)
            .map(|(p, s)| p.volume * trace(s))
            .sum::<f64>()
            / self.volume();
        out.fill(0.0);
        for (p, stress) in self.points.iter().zip(&self.stress) {
            let mut stress = *stress;
            if of.scheme == Scheme::MeanDilatation {
                shift(&mut stress, mean);
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
        if of.scheme == Scheme::Uniform {
            for (vector, amplitude) in self.vectors.iter().zip(&self.amplitudes) {
                for (v, out) in vector.iter().zip(out.chunks_exact_mut(dim)) {
                    for (o, a) in out.iter_mut().zip(amplitude) {
                        *o += v * a;
                    }
                }
            }
        }
    }
}

fn trace(v: &[f64; 6]) -> f64 {
    v[0] + v[1] + v[2]
}

/// Gives a tensor the trace `to`.
fn shift(v: &mut [f64; 6], to: f64) {
    let by = (to - trace(v)) / 3.0;
    for v in &mut v[..3] {
        *v += by;
    }
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

    fn medium<const N: usize>(&self, part: usize) -> Medium<N> {
        let kind = self.mesh.blocks[self.parts[part].block].kind;
        Medium::new(kind, self.space, self.formulation, &self.acting[part])
    }

    /// Runs `extract` (with the nodes of the cell and their displacements) on every cell of a part in parallel and `consume` on its `width` results in order.
    pub(super) fn each_cell<const N: usize>(
        &self,
        part: usize,
        u: &[f64],
        width: usize,
        extract: impl Fn(&Medium<N>, [&Nodal<N>; 2], &Recovered<N>, &mut [f64]) + Sync,
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
                    extract(&medium, [&x, &v], &recovered, out);
                }
            },
            consume,
        );
    }

    /// Adds the internal force at the displacements `u` `[m]` to `out` `[N]`, both by dof of the whole mesh.
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
                values[1] = recovered.volume();
            },
            |_, values| all.push([values[0], values[1]]),
        );
        all
    }

    /// The strain energy at the displacements `u` `[m]`, by dof of the whole mesh `[J]`.
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

    /// The volume of the body `[m³]`, with its thickness or all around its axis.
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

    /// Stress and strain at every quadrature point at the displacements `u` `[m]`; parts, cells and points in order. A cell with the
    /// mean of all strains has one point, its centre.
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

    fn part_stress<const N: usize>(
        &self,
        part: usize,
        u: &[f64],
        visit: &mut (dyn FnMut(StressPoint) + Send),
    ) {
        const WIDTH: usize = 16;
        let block = self.parts[part].block;
        let points = self.medium::<N>(part).stations();
        self.each_cell::<N>(
            part,
            u,
            points * WIDTH,
            |medium, [x, _], recovered, values| {
                for (q, out) in values.chunks_exact_mut(WIDTH).enumerate() {
                    let n = medium.values(q);
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
