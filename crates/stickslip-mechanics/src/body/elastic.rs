//! The force of elastic bodies.

use std::sync::Arc;

use rayon::prelude::*;

use super::cell_frame::CellFrame;
use super::geometry::gather;
use super::geometry::{Table, by_nodes, coordinates, point};
use super::kernel::{self, Scratch};
use super::medium::Medium;
use super::scheme::stiffness_rule;
use super::waves::in_order;
use super::{Formulation, Space, Temperatures, extrapolate};
use crate::error::Diagnostic;
use crate::linear::{BlockCsr, Digest};
use crate::material::{Dilation, Stiffness, constrained_modulus, plane_stress};
use crate::mesh::{Block, Mesh};
use crate::number::figure;
use crate::system::Dofs;

/// A block of cells and what it is made of.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Part {
    /// Index into [`Mesh::blocks`].
    pub block: usize,
    /// Stiffness in space `[Pa]`, checked (see [`Elasticity::stiffness`](crate::material::Elasticity::stiffness)).
    pub stiffness: Stiffness,
    /// Mass per volume `[kg/m³]`.
    pub density: f64,
    /// How it expands when it is heated, if it does.
    pub dilation: Option<Arc<Dilation>>,
    /// Stiffness of each cell `[Pa]`, where they differ; `stiffness` is that of one of them then.
    pub cells: Option<Arc<Vec<Stiffness>>>,
}

/// A linear elastic body: some blocks of a mesh, each with a material.
#[derive(Debug, Clone)]
pub struct Elastic {
    pub(super) name: String,
    pub(super) mesh: Arc<Mesh>,
    pub(super) space: Space,
    pub(super) formulation: Formulation,
    pub(super) parts: Vec<Part>,
    /// Stiffness as it acts in the space (condensed for plane stress), by part.
    pub(super) acting: Vec<Stiffness>,
    /// What takes values at quadrature points to the nodes of a cell, by part.
    pub(super) to_nodes: Vec<Vec<Vec<f64>>>,
    pub(super) points: Vec<usize>,
    pub(super) temperatures: Option<Arc<Temperatures>>,
    pub(super) corotational: bool,
}

/// Takes dense matrices, row by row, and their points.
pub type CellVisitor<'a> = dyn FnMut(&[usize], &[f64]) + Send + 'a;

/// Makes further matrices of a cell, behind its stiffness.
type CellMatrices<'a> = dyn Fn(usize, &mut [f64]) + Sync + 'a;

impl Elastic {
    /// A body of the given parts, which must be different blocks.
    ///
    /// # Errors
    /// The space does not suit the mesh, the formulation not the space, a part names a block that does not exist or
    /// has lines in it, or a cell is inverted or collapsed at a quadrature point. The key of the finding is
    /// `space`, `thickness`, `formulation` or empty.
    pub fn new(
        name: impl Into<String>,
        mesh: Arc<Mesh>,
        space: Space,
        formulation: Formulation,
        parts: Vec<Part>,
    ) -> Result<Self, Diagnostic> {
        let name = name.into();
        let blocks: Vec<usize> = parts.iter().map(|p| p.block).collect();
        space.check(&mesh, &blocks).map_err(|mut e| {
            e.message = format!("body {name}: {}", e.message);
            e
        })?;
        let in_plane_stress = matches!(space, Space::PlaneStress { .. });
        if in_plane_stress && formulation == Formulation::MeanDilatation {
            return Err(Diagnostic::new(
                "formulation",
                "mean dilatation does not go with plane stress",
            )
            .help("use the standard formulation: in plane stress the thickness is free to change and nothing locks"));
        }
        for (i, part) in parts.iter().enumerate() {
            let Some(block) = mesh.blocks.get(part.block) else {
                return Err(Diagnostic::new(
                    "",
                    format!(
                        "body {name} names block {}, the mesh has {}",
                        part.block,
                        mesh.blocks.len()
                    ),
                ));
            };
            if block.kind.dim() != space.dim() {
                return Err(Diagnostic::new(
                    "",
                    format!(
                        "body {name} has {} cells, which do not fill the space",
                        block.kind.name()
                    ),
                ));
            }
            if parts[..i].iter().any(|p| p.block == part.block) {
                return Err(Diagnostic::new(
                    "",
                    format!("body {name} names block {} twice", part.block),
                ));
            }
            by_nodes!(block.kind, check_cells(&mesh, block, space, formulation))?;
        }
        let mut points: Vec<usize> = parts
            .iter()
            .flat_map(|p| mesh.blocks[p.block].connectivity.iter().copied())
            .collect();
        points.sort_unstable();
        points.dedup();
        let acting = acting_stiffness(space, &parts);
        let to_nodes = to_nodes(&mesh, &parts, space, formulation);
        Ok(Elastic {
            name,
            mesh,
            space,
            formulation,
            parts,
            acting,
            to_nodes,
            points,
            temperatures: None,
            corotational: false,
        })
    }

    /// The body with a frame for each of its cells, in which the cell is linear: it may turn and bend by any angle
    /// ([`nour_omid_rankin_1991`](stickslip_base::references::nour_omid_rankin_1991)). Not for axial symmetry, where the frame of a cell is not free to turn.
    pub fn corotational(self) -> Self {
        Elastic {
            corotational: self.space != Space::Axisymmetric,
            ..self
        }
    }

    /// Whether each of its cells has a frame of its own.
    pub fn is_corotational(&self) -> bool {
        self.corotational
    }

    /// The body with temperatures at its points.
    pub fn heated(self, temperatures: Arc<Temperatures>) -> Self {
        Elastic {
            temperatures: Some(temperatures),
            ..self
        }
    }

    /// The stiffness of a cell as it acts in the space.
    pub(super) fn acting_in(&self, part: usize, cell: usize) -> Stiffness {
        let in_plane_stress = matches!(self.space, Space::PlaneStress { .. });
        match &self.parts[part].cells {
            None => self.acting[part],
            Some(cells) if in_plane_stress => plane_stress(&cells[cell]),
            Some(cells) => cells[cell],
        }
    }

    /// The mesh it is part of.
    pub fn mesh(&self) -> &Arc<Mesh> {
        &self.mesh
    }

    /// The space it is in.
    pub fn space(&self) -> Space {
        self.space
    }

    /// Its parts.
    pub fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// Its points, ascending.
    pub fn points(&self) -> &[usize] {
        &self.points
    }

    pub(super) fn dofs(&self) -> Dofs {
        Dofs {
            dim: self.space.dim(),
            points: self.mesh.points.len(),
        }
    }

    /// The largest stiffness against strain in one direction alone `[Pa]` in the cells of `block`, as the material acts
    /// in the body's space; `None` if the block is not part of this body. Penalties are multiples of it over a length.
    pub fn constrained_modulus(&self, block: usize) -> Option<f64> {
        let i = self.parts.iter().position(|p| p.block == block)?;
        Some(constrained_modulus(&self.acting[i]))
    }

    /// How its elements make strains of displacements.
    pub fn formulation(&self) -> Formulation {
        self.formulation
    }

    /// Hands out the stiffness matrix of every cell, shape `(n dim, n dim)` row by row, with the cell's points; parts
    /// and cells in order.
    pub fn element_matrices(&self, visit: &mut CellVisitor) {
        for (part, p) in self.parts.iter().enumerate() {
            by_nodes!(
                self.mesh.blocks[p.block].kind,
                Elastic::part_matrices(self, part, 1, &|_, _| {}, visit)
            );
        }
    }

    /// Adds the derivative of the internal force by displacements, at displacements `u` `[m]` by dof of the whole mesh, to `exact`, and what of it is stiffness alone to
    /// `stiff` `[N/m]`. Both are symmetric; the second is positive wherever the body is held.
    pub fn tangents(&self, u: &[f64], exact: &mut BlockCsr, stiff: &mut BlockCsr) {
        for (part, p) in self.parts.iter().enumerate() {
            by_nodes!(
                self.mesh.blocks[p.block].kind,
                Elastic::part_tangents(self, part, u, [exact, stiff])
            );
        }
    }

    fn part_tangents<const N: usize>(&self, part: usize, u: &[f64], out: [&mut BlockCsr; 2]) {
        let block = &self.mesh.blocks[self.parts[part].block];
        let dofs = self.dofs();
        let width = (N * dofs.dim).pow(2);
        let turn = |cell: usize, values: &mut [f64]| {
            let (k, both) = values.split_at_mut(width);
            let (exact, stiff) = both.split_at_mut(width);
            if !self.corotational {
                exact.copy_from_slice(k);
                stiff.copy_from_slice(k);
                return;
            }
            let x = coordinates::<N>(&self.mesh.points, block, cell);
            let u = gather(u, dofs, block, cell);
            CellFrame::new(dofs.dim, &x, &u).tangents(k, exact, stiff);
        };
        let [exact, stiff] = out;
        self.part_matrices::<N>(part, 3, &turn, &mut |points, values| {
            exact.add_group(points, &values[width..2 * width]);
            stiff.add_group(points, &values[2 * width..]);
        });
    }

    /// Hands out so many matrices a cell: the first its stiffness, the others what `more` makes of it.
    fn part_matrices<const N: usize>(
        &self,
        part: usize,
        count: usize,
        more: &CellMatrices,
        visit: &mut CellVisitor,
    ) {
        let block = &self.mesh.blocks[self.parts[part].block];
        let (space, acting) = (self.space, &self.acting[part]);
        let medium = Medium::<N>::new(block.kind, space, self.formulation, acting);
        let width = (N * space.dim()).pow(2);
        in_order(
            block.connectivity.len() / N,
            count * width,
            |first, values| {
                let mut scratch = Scratch::<N>::new();
                let mut graded = self.parts[part].cells.as_ref().map(|_| medium.clone());
                for (c, out) in values.chunks_exact_mut(count * width).enumerate() {
                    let x = coordinates(&self.mesh.points, block, first + c);
                    if let Some(medium) = &mut graded {
                        medium.set_stiffness(&self.acting_in(part, first + c));
                    }
                    let medium = graded.as_ref().unwrap_or(&medium);
                    kernel::stiffness(medium, &x, &mut scratch, &mut out[..width]);
                    more(first + c, out);
                }
            },
            |cell, dense| visit(&block.connectivity[cell * N..(cell + 1) * N], dense),
        );
    }
}

/// What takes values at quadrature points to the nodes of the cells, by part.
pub(super) fn to_nodes(
    mesh: &Mesh,
    parts: &[Part],
    space: Space,
    formulation: Formulation,
) -> Vec<Vec<Vec<f64>>> {
    let kinds = parts.iter().map(|part| mesh.blocks[part.block].kind);
    kinds
        .map(|kind| extrapolate::matrix(kind, space, formulation))
        .collect()
}

/// The stiffness of parts as it acts in the space: condensed for plane stress.
pub(super) fn acting_stiffness(space: Space, parts: &[Part]) -> Vec<Stiffness> {
    let in_plane_stress = matches!(space, Space::PlaneStress { .. });
    let acting = |part: &Part| match in_plane_stress {
        true => plane_stress(&part.stiffness),
        false => part.stiffness,
    };
    parts.iter().map(acting).collect()
}

/// The first cell whose volume is not positive at a quadrature point.
fn check_cells<const N: usize>(
    mesh: &Mesh,
    block: &Block,
    space: Space,
    formulation: Formulation,
) -> Result<(), Diagnostic> {
    let rule = stiffness_rule(block.kind, space, formulation);
    let table = Table::<N>::with_rule(block.kind, rule);
    let bad = (0..block.connectivity.len() / N)
        .into_par_iter()
        .find_map_first(|cell| {
            let x = coordinates(&mesh.points, block, cell);
            (0..table.len())
                .map(|q| point(&table, q, &x, space))
                .find(|p| !(p.volume > 0.0 && p.volume.is_finite()))
                .map(|p| (cell, p.jacobian))
        });
    match bad {
        None => Ok(()),
        Some((cell, jacobian)) => Err(Diagnostic::new(
            "",
            format!(
                "cell {} ({}) is inverted or collapsed: its Jacobian is {jacobian}",
                block.cell_ids.get(cell).copied().unwrap_or(cell as u64),
                block.kind.name(),
                jacobian = figure(jacobian)
            ),
        )
        .help("check the coordinates of its nodes and their order")),
    }
}

impl Elastic {
    /// Number of cells.
    pub fn cells(&self) -> usize {
        let of_block = |block: &Block| block.connectivity.len() / block.kind.node_count();
        let blocks = self.parts.iter().map(|part| &self.mesh.blocks[part.block]);
        blocks.map(of_block).sum()
    }

    /// Points whose dofs the body couples, cell by cell.
    pub fn couplings(&self, visit: &mut dyn FnMut(&[usize])) {
        for part in &self.parts {
            let block = &self.mesh.blocks[part.block];
            for cell in block.connectivity.chunks_exact(block.kind.node_count()) {
                visit(cell);
            }
        }
    }

    /// Mixes all that decides what the stiffness is, but for the places of the points.
    pub fn mix(&self, digest: &mut Digest) {
        let made_of = (self.space, self.formulation, &self.acting);
        digest.bytes(format!("{made_of:?}").as_bytes());
        for part in &self.parts {
            let block = &self.mesh.blocks[part.block];
            digest.bytes(block.kind.name().as_bytes());
            digest.word(block.connectivity.len() as u64);
            (block.connectivity.iter()).for_each(|&point| digest.word(point as u64));
            for stiffness in part.cells.iter().flat_map(|cells| cells.iter()) {
                digest.floats(stiffness.as_flattened());
            }
        }
    }

    /// Adds the stiffness of all cells `[N/m]`.
    pub fn stiffness(&self, matrix: &mut BlockCsr) {
        self.element_matrices(&mut |points, dense| matrix.add_group(points, dense));
    }
}
