//! What a load acts on, and what it says.

use super::super::Space;
use super::super::facets::{FacetPoint, combine, visit_facet};
use super::super::geometry::{Table, by_nodes, coordinates, point};
use crate::error::Diagnostic;
use crate::math::Vec3;
use crate::mesh::{Block, CellRef, FacetRef, Mesh};
use crate::system::{Dofs, Links};

/// What a load kind acts on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Region {
    /// Points.
    Points,
    /// Boundary facets.
    Facets,
    /// Cells.
    Cells,
}

/// A set of the mesh, resolved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Target<'a> {
    /// Points, those of the mesh or a reference point.
    Points(&'a [usize]),
    /// Boundary facets.
    Facets(&'a [FacetRef]),
    /// Cells.
    Cells(&'a [CellRef]),
}

/// Where loads act.
#[derive(Debug, Clone, Copy)]
pub struct Domain<'a> {
    /// The mesh of all bodies.
    pub mesh: &'a Mesh,
    /// Its space.
    pub space: Space,
    /// Mass per volume of each block `[kg/m³]`.
    pub densities: &'a [f64],
    /// Masses at points beside those of the cells, ascending, each once `[kg]`.
    pub masses: &'a [(usize, f64)],
    /// Rigid bodies and reference points.
    pub links: &'a Links,
}

/// What a load kind comes down to; dofs ascending, each once.
#[derive(Debug, Clone, PartialEq)]
pub enum Action {
    /// Forces by dof `[N]`, to be scaled by a schedule.
    Forces(Vec<(usize, f64)>),
    /// Stiffnesses to ground by dof `[N/m]`.
    Springs(Vec<(usize, f64)>),
}

/// A kind of load.
pub trait LoadModel {
    /// What it acts on; the set of the problem file is resolved to that.
    fn region(&self) -> Region;

    /// The forces or springs on `target`.
    ///
    /// # Errors
    /// A value with the wrong number of components or not finite, or a target of another kind than
    /// [`region`](LoadModel::region) says. The key of the finding is that of the parameter, or empty.
    fn action(&self, target: &Target, domain: &Domain) -> Result<Action, Diagnostic>;
}

impl Domain<'_> {
    pub(super) fn dofs(&self) -> Dofs {
        Dofs {
            dim: self.space.dim(),
            points: self.mesh.points.len(),
        }
    }

    /// Point masses at the points of cells.
    pub(super) fn masses_at(&self, cells: &[CellRef]) -> Vec<(usize, f64)> {
        if self.masses.is_empty() {
            return Vec::new();
        }
        let points = self.mesh.points_of_cells(cells);
        let mut marked = vec![false; self.mesh.points.len()];
        points.into_iter().for_each(|p| marked[p] = true);
        let masses = self.masses.iter().filter(|(p, _)| marked[*p]);
        masses.copied().collect()
    }

    /// Refuses cells without density.
    pub(super) fn heavy(&self, target: &Target, what: &str) -> Result<(), Diagnostic> {
        let Target::Cells(cells) = target else {
            return Ok(());
        };
        let light = |c: &CellRef| !(self.densities.get(c.block).is_some_and(|&rho| rho > 0.0));
        if cells.iter().any(light) {
            let message = format!("{what} acts on a body without density");
            return Err(Diagnostic::new("", message).help("give the density of its material"));
        }
        Ok(())
    }

    /// A vector parameter, checked and padded with zeros.
    pub(super) fn vector(&self, key: &str, value: &[f64]) -> Result<Vec3, Diagnostic> {
        let dim = self.space.dim();
        if value.len() != dim {
            return Err(Diagnostic::new(
                key,
                format!("{key} has {} components, the space has {dim}", value.len()),
            )
            .help(if dim == 2 {
                "give two components, [x, y]"
            } else {
                "give three components, [x, y, z]"
            }));
        }
        if value.iter().any(|v| !v.is_finite()) {
            return Err(Diagnostic::new(
                key,
                format!("{key} = {value:?} is not finite"),
            ));
        }
        let mut v = [0.0; 3];
        v[..dim].copy_from_slice(value);
        Ok(v)
    }

    /// `∫ N t dA` by dof, with the traction `t` `[Pa]` given by the quadrature point.
    pub(super) fn over_facets(
        &self,
        target: &Target,
        traction: &dyn Fn(&FacetPoint) -> Vec3,
    ) -> Result<Action, Diagnostic> {
        let Target::Facets(facets) = target else {
            return Err(mismatch(Region::Facets));
        };
        let dofs = self.dofs();
        let mut entries = Vec::new();
        for &facet in *facets {
            visit_facet(self.mesh, self.space, facet, &mut |q| {
                let t = traction(&q);
                for (&p, n) in q.points.iter().zip(q.values) {
                    entries.extend((0..dofs.dim).map(|i| (dofs.of(p, i), n * q.area * t[i])));
                }
            });
        }
        Ok(Action::Forces(combine(entries)))
    }

    /// `∫ N f dV` by dof, with the force per volume `f` `[N/m³]` given by the block.
    pub(super) fn over_cells(
        &self,
        target: &Target,
        force: &dyn Fn(usize) -> Vec3,
    ) -> Result<Action, Diagnostic> {
        let Target::Cells(cells) = target else {
            return Err(mismatch(Region::Cells));
        };
        let dofs = self.dofs();
        let mut entries = Vec::new();
        for (index, block) in self.mesh.blocks.iter().enumerate() {
            let chosen = cells.iter().filter(|c| c.block == index).map(|c| c.cell);
            let f = force(index);
            let mut add = |p: usize, weight: f64| {
                entries.extend((0..dofs.dim).map(|i| (dofs.of(p, i), weight * f[i])));
            };
            by_nodes!(
                block.kind,
                cell_weights(
                    self.mesh,
                    block,
                    self.space,
                    &mut chosen.into_iter(),
                    &mut add
                )
            );
        }
        Ok(Action::Forces(combine(entries)))
    }

    /// The same value at each point of the target.
    pub(super) fn at_points(
        &self,
        target: &Target,
        value: Vec3,
    ) -> Result<Vec<(usize, f64)>, Diagnostic> {
        let Target::Points(points) = target else {
            return Err(mismatch(Region::Points));
        };
        let dofs = self.dofs();
        let entries = points
            .iter()
            .flat_map(|&p| (0..dofs.dim).map(move |i| (dofs.of(p, i), value[i])))
            .filter(|e| e.1 != 0.0)
            .collect();
        Ok(combine(entries))
    }
}

pub(super) fn mismatch(wanted: Region) -> Diagnostic {
    let what = match wanted {
        Region::Points => "points",
        Region::Facets => "boundary facets",
        Region::Cells => "cells",
    };
    Diagnostic::new("", format!("this kind of load acts on a set of {what}"))
        .help(format!("name a set of {what}"))
}

/// Visits `∫ N_i dV` of every node of the chosen cells of a block.
pub(super) fn cell_weights<const N: usize>(
    mesh: &Mesh,
    block: &Block,
    space: Space,
    cells: &mut dyn Iterator<Item = usize>,
    add: &mut dyn FnMut(usize, f64),
) {
    let table = Table::<N>::new(block.kind, space);
    for cell in cells {
        let x = coordinates(&mesh.points, block, cell);
        let mut weights = [0.0; N];
        for (q, n) in table.values.iter().enumerate() {
            let volume = point(&table, q, &x, space).volume;
            for (w, n) in weights.iter_mut().zip(n) {
                *w += n * volume;
            }
        }
        for (&p, &w) in block.connectivity[cell * N..(cell + 1) * N]
            .iter()
            .zip(&weights)
        {
            add(p, w);
        }
    }
}
