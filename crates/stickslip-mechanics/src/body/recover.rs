//! From displacements back to strains, stresses, forces and energy.

use super::cell_frame::CellFrame;
use super::geometry::{Nodal, Point, by_nodes, coordinates, gather, point};
use super::hourglass::CELL_MODES;
use super::medium::Medium;
use super::scheme::Scheme;
use super::warmth::Warmth;
use super::waves::in_order;
use super::{Elastic, Space, hourglass};
use crate::material::Stiffness;
use crate::mesh::CellRef;
use crate::system::State;

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
    /// What of it is thermal.
    pub thermal: [f64; 6],
    /// Stress xx yy zz xy yz xz `[Pa]`.
    pub stress: [f64; 6],
}

/// Displacements `[m]` by dof of the whole mesh, and how warm bodies are with them.
#[derive(Debug, Clone, Copy)]
pub struct At<'a> {
    /// Displacements.
    pub u: &'a [f64],
    /// Which temperatures there are.
    pub warm: Warm<'a>,
}

/// Which temperatures bodies have.
#[derive(Debug, Clone, Copy)]
pub enum Warm<'a> {
    /// Those of the start: nothing has expanded.
    AtStart,
    /// Those of a time.
    AtTime(f64),
    /// Those with factors and shares of the fields.
    Weighted(&'a [[f64; 2]]),
}

impl<'a> From<&'a State> for At<'a> {
    fn from(state: &'a State) -> Self {
        At {
            u: &state.u,
            warm: Warm::AtTime(state.t),
        }
    }
}

impl<'a> From<&'a [f64]> for At<'a> {
    fn from(u: &'a [f64]) -> Self {
        At {
            u,
            warm: Warm::AtStart,
        }
    }
}

impl<'a> From<&'a Vec<f64>> for At<'a> {
    fn from(u: &'a Vec<f64>) -> Self {
        At::from(u.as_slice())
    }
}

/// Most quadrature points a cell has: hex20.
const MAX_POINTS: usize = 27;

/// Strain, stress and derivatives at the points of one cell that have stresses.
pub(super) struct Recovered<const N: usize> {
    /// Derivatives and volumes there; with uniform strain the means.
    pub points: Vec<Point<N>>,
    pub strain: [[f64; 6]; MAX_POINTS],
    /// Thermal strain there.
    pub thermal: [[f64; 6]; MAX_POINTS],
    pub stress: [[f64; 6]; MAX_POINTS],
    /// The mean dilatation of the cell.
    dilatation: f64,
    /// `√κ γ` of the motions without strain.
    vectors: [[f64; N]; CELL_MODES],
    /// How much of them there is, a direction each.
    amplitudes: [[f64; 3]; CELL_MODES],
    /// The frame of the cell, in which all of this is, where it has one.
    frame: Option<CellFrame<N>>,
}

/// Strain, thermal strain and stress at a point.
pub(super) type Strained = [[f64; 6]; 3];

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
            thermal: [[0.0; 6]; MAX_POINTS],
            stress: [[0.0; 6]; MAX_POINTS],
            dilatation: 0.0,
            vectors: [[0.0; N]; CELL_MODES],
            amplitudes: [[0.0; 3]; CELL_MODES],
            frame: None,
        }
    }

    /// Strain, thermal strain and stress of the cell, along the axes of space.
    pub fn in_space(&self, all: Strained) -> Strained {
        let [strain, thermal, stress] = all;
        match &self.frame {
            None => all,
            Some(frame) => [
                frame.turn_strain(strain),
                frame.turn_strain(thermal),
                frame.turn_stress(stress),
            ],
        }
    }

    /// Those at one of its points.
    pub fn at(&self, q: usize) -> Strained {
        self.in_space([self.strain[q], self.thermal[q], self.stress[q]])
    }

    /// Fills it for the cell with nodes `x` displaced by `u`, as warm as at the start where nothing is said of it.
    pub fn compute(
        &mut self,
        of: &Medium<N>,
        x: &Nodal<N>,
        u: &Nodal<N>,
        warmth: Option<&Warmth<N>>,
    ) {
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
        if let Some(warmth) = warmth {
            self.set_thermal(of, warmth);
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

    /// Thermal strains at the points; with mean dilatation the cell has the mean of theirs, too.
    fn set_thermal(&mut self, of: &Medium<N>, warmth: &Warmth<N>) {
        let each = self.points.iter().zip(&mut self.thermal).zip(&of.warmth);
        let (mut volume, mut dilatation) = (0.0, 0.0);
        for ((p, thermal), weights) in each {
            *thermal = warmth.strain(weights);
            volume += p.volume;
            dilatation += p.volume * trace(thermal);
        }
        if of.scheme == Scheme::MeanDilatation {
            for thermal in &mut self.thermal[..self.points.len()] {
                shift(thermal, dilatation / volume);
            }
        }
    }

    fn set_stress(&mut self, of: &Medium<N>) {
        for q in 0..self.points.len() {
            self.stress[q] = stress_of(&of.acting, &self.elastic(q));
        }
    }

    /// Strain without its thermal part at a point.
    pub fn elastic(&self, q: usize) -> [f64; 6] {
        std::array::from_fn(|v| self.strain[q][v] - self.thermal[q][v])
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
        let at = |(q, p): (usize, &Point<N>)| {
            let both = self.elastic(q).into_iter().zip(self.stress[q]);
            0.5 * p.volume * both.map(|(e, s)| e * s).sum::<f64>()
        };
        self.points.iter().enumerate().map(at).sum::<f64>() + self.hourglass()
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
        if let Some(frame) = &self.frame {
            frame.outward(out);
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

pub(super) fn medium<const N: usize>(body: &Elastic, part: usize) -> Medium<N> {
    let kind = body.mesh.blocks[body.parts[part].block].kind;
    Medium::new(kind, body.space, body.formulation, &body.acting[part])
}

/// Runs `extract` (with the nodes of the cell and their displacements, in its frame if it has one) on every cell of a part in parallel and `consume` on its `width` results in order.
pub(super) fn each_cell<const N: usize>(
    body: &Elastic,
    part: usize,
    at: At,
    width: usize,
    extract: impl Fn(&Medium<N>, [&Nodal<N>; 2], &Recovered<N>, &mut [f64]) + Sync,
    consume: impl FnMut(usize, &[f64]) + Send,
) {
    let own = &body.parts[part];
    let block = &body.mesh.blocks[own.block];
    let medium = medium::<N>(body, part);
    let dofs = body.dofs();
    let heat = body.temperatures.as_ref().zip(own.dilation.as_ref());
    let heat = heat.and_then(|(temperatures, dilation)| {
        let rises = match at.warm {
            Warm::AtStart => return None,
            Warm::AtTime(t) => temperatures.rises(t),
            Warm::Weighted(weights) => temperatures.weighted(weights),
        };
        Some((temperatures, dilation, rises))
    });
    in_order(
        block.connectivity.len() / N,
        width,
        |first, values| {
            let mut recovered = Recovered::new();
            let mut graded = own.cells.as_ref().map(|_| medium.clone());
            for (c, out) in values.chunks_exact_mut(width).enumerate() {
                let cell = first + c;
                let x = coordinates(&body.mesh.points, block, cell);
                let mut v = gather(at.u, dofs, block, cell);
                if body.corotational {
                    let frame = CellFrame::new(dofs.dim, &x, &v);
                    v = frame.local();
                    recovered.frame = Some(frame);
                }
                let nodes = &block.connectivity[cell * N..(cell + 1) * N];
                let warmth = heat.as_ref().map(|(temperatures, dilation, rises)| Warmth {
                    dilation,
                    start: std::array::from_fn(|a| temperatures.start[nodes[a]]),
                    rise: std::array::from_fn(|a| rises[nodes[a]]),
                });
                if let Some(medium) = &mut graded {
                    medium.set_stiffness(&body.acting_in(part, cell));
                }
                let medium = graded.as_ref().unwrap_or(&medium);
                recovered.compute(medium, &x, &v, warmth.as_ref());
                extract(medium, [&x, &v], &recovered, out);
            }
        },
        consume,
    );
}

/// Adds the internal force at displacements to `out` `[N]`, by dof of the whole mesh: without any, and at a time, what temperatures press
/// with against what holds the body.
pub fn internal_force<'a>(body: &Elastic, at: impl Into<At<'a>>, out: &mut [f64]) {
    let at = at.into();
    for (part, p) in body.parts.iter().enumerate() {
        by_nodes!(
            body.mesh.blocks[p.block].kind,
            part_force(body, part, at, out)
        );
    }
}

fn part_force<const N: usize>(body: &Elastic, part: usize, at: At, out: &mut [f64]) {
    let block = &body.mesh.blocks[body.parts[part].block];
    let dofs = body.dofs();
    each_cell::<N>(
        body,
        part,
        at,
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
pub(super) fn cell_energies(body: &Elastic, part: usize, at: At) -> Vec<[f64; 2]> {
    let kind = body.mesh.blocks[body.parts[part].block].kind;
    by_nodes!(kind, part_energies(body, part, at))
}

fn part_energies<const N: usize>(body: &Elastic, part: usize, at: At) -> Vec<[f64; 2]> {
    let mut all = Vec::new();
    each_cell::<N>(
        body,
        part,
        at,
        2,
        |_, _, recovered, values| {
            values[0] = recovered.energy();
            values[1] = recovered.volume();
        },
        |_, values| all.push([values[0], values[1]]),
    );
    all
}

/// The strain energy at displacements `[J]`.
pub fn strain_energy<'a>(body: &Elastic, at: impl Into<At<'a>>) -> f64 {
    let at = at.into();
    (0..body.parts.len())
        .map(|part| {
            cell_energies(body, part, at)
                .iter()
                .map(|e| e[0])
                .sum::<f64>()
        })
        .sum()
}

/// The volume of the body `[m³]`, with its thickness or all around its axis.
pub fn volume(body: &Elastic) -> f64 {
    let rest = vec![0.0; body.dofs().count()];
    (0..body.parts.len())
        .map(|part| {
            cell_energies(body, part, At::from(&rest))
                .iter()
                .map(|e| e[1])
                .sum::<f64>()
        })
        .sum()
}
