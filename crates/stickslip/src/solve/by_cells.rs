//! The stiffness of a model whose entries are not kept.

use std::ops::Range;
use std::sync::OnceLock;

use crate::body::{CellVisitor, Elastic, portion};
use crate::linear::{BlockCsr, Cells, Matrix, Summands};
use crate::model::definition::{Model, Step};
use crate::newton::condensed::Identity;
use crate::system::{Dofs, Links};

/// The stiffness of bodies, rigid links and springs as the sum over them: those of the cells are made anew whenever they are asked for.
///
/// A product takes the work of an assembly. An engine that factors elsewhere needs every entry once, and a quasi-static analysis on contact candidates a
/// product for each pattern of loads and for each sweep over sixteen increments: this is what the entries would take, 0.7 kB a dof in a solid, saved in this process.
#[derive(Debug)]
pub(super) struct ByCells {
    dofs: Dofs,
    bodies: Vec<(Range<usize>, Elastic)>,
    links: Links,
    /// Dofs and stiffness `[N/m]`.
    springs: Vec<(usize, f64)>,
    identity: Identity,
    /// The blocks of the diagonal, row by row.
    blocks: OnceLock<Vec<f64>>,
}

impl ByCells {
    /// That of a model, without its bodies where all steps are explicit: they need no matrix.
    pub fn new(model: &Model, identity: Identity) -> ByCells {
        let springs = model.actions.springs.iter().flat_map(|s| s.entries());
        ByCells {
            dofs: model.dofs,
            bodies: stiff(model)
                .map(|body| (body.points.clone(), body.elastic.clone()))
                .collect(),
            links: model.links.clone(),
            springs: springs.copied().collect(),
            identity,
            blocks: OnceLock::new(),
        }
    }

    /// The blocks of the diagonal, `dim` numbers a dof.
    fn blocks(&self) -> &[f64] {
        self.blocks.get_or_init(|| {
            let dim = self.dofs.dim;
            let mut blocks = vec![0.0; dim * self.dofs.count()];
            self.summands(0..self.dofs.points, &mut |row, column, value| {
                if row / dim == column / dim {
                    blocks[row * dim + column % dim] += value;
                }
            });
            blocks
        })
    }

    /// The bodies that have some of these points.
    fn within(&self, within: Range<usize>) -> impl Iterator<Item = &Elastic> {
        let some = self
            .bodies
            .iter()
            .filter(move |(points, _)| points.start < within.end && within.start < points.end);
        some.map(|(_, elastic)| elastic)
    }

    /// Hands out dense matrices, row by row, and their points.
    fn groups(&self, within: Range<usize>, visit: &mut CellVisitor) {
        (self.within(within)).for_each(|elastic| elastic.element_matrices(visit));
        self.spring_groups(visit);
    }

    fn spring_groups(&self, visit: &mut CellVisitor) {
        for &(dof, stiffness) in &self.springs {
            let (points, dense) = self.links.spring(dof, stiffness);
            visit(&points, &dense);
        }
    }
}

impl Matrix for ByCells {
    fn points(&self) -> usize {
        self.dofs.points
    }

    fn block_size(&self) -> usize {
        self.dofs.dim
    }

    fn mul_all(&self, all: &[&[f64]]) -> Vec<Vec<f64>> {
        let dim = self.dofs.dim;
        let mut out = vec![vec![0.0; self.dofs.count()]; all.len()];
        let mut own = Vec::new();
        self.groups(0..self.dofs.points, &mut |points, dense| {
            let width = points.len() * dim;
            let dofs = || points.iter().flat_map(|p| p * dim..(p + 1) * dim);
            for (x, out) in all.iter().zip(&mut out) {
                own.clear();
                own.extend(dofs().map(|dof| x[dof]));
                for (dof, row) in dofs().zip(dense.chunks_exact(width)) {
                    out[dof] += row.iter().zip(&own).map(|(k, x)| k * x).sum::<f64>();
                }
            }
        });
        out
    }

    fn diagonal(&self) -> Vec<f64> {
        let dim = self.dofs.dim;
        let own = |dof: usize| self.blocks()[dof * dim + dof % dim];
        (0..self.dofs.count()).map(own).collect()
    }

    /// Within a point, of which many are asked for, from the blocks of the diagonal.
    fn at(&self, row: usize, column: usize) -> f64 {
        let dim = self.dofs.dim;
        if row / dim == column / dim {
            return self.blocks()[row * dim + column % dim];
        }
        let mut sum = 0.0;
        self.summands(row / dim..row / dim + 1, &mut |i, j, value| {
            sum += if (i, j) == (row, column) { value } else { 0.0 };
        });
        sum
    }

    fn summands(&self, points: Range<usize>, visit: &mut Summands) {
        let dim = self.dofs.dim;
        self.groups(points, &mut |points, dense| {
            each_entry(dim, points, dense, visit)
        });
    }

    fn cells(&self, points: Range<usize>) -> Option<Box<dyn Cells + '_>> {
        Some(Box::new(CellsOf {
            all: self,
            bodies: self.within(points).collect(),
        }))
    }

    fn kept(&self) -> Result<&BlockCsr, [u64; 2]> {
        Err(self.identity.words())
    }

    fn make(&self) -> BlockCsr {
        let Dofs { points, dim } = self.dofs;
        let mut stiffness = BlockCsr::from_couplings(points, dim, &mut |visit| {
            (self.bodies.iter()).for_each(|(_, elastic)| elastic.couplings(visit));
            for link in self.links.all() {
                visit(&[link.hidden, link.hidden + 1]);
            }
        });
        (self.bodies.iter()).for_each(|(_, elastic)| elastic.stiffness(&mut stiffness));
        for &(dof, k) in &self.springs {
            self.links.add_spring(&mut stiffness, dof, k);
        }
        stiffness
    }
}

/// Cells that ranks of an engine may compute.
struct CellsOf<'a> {
    all: &'a ByCells,
    bodies: Vec<&'a Elastic>,
}

impl Cells for CellsOf<'_> {
    fn couplings(&self, visit: &mut dyn FnMut(&[usize])) {
        self.bodies.iter().for_each(|body| body.couplings(visit));
    }

    fn portions(&self, cells: &[u32]) -> Vec<(Vec<usize>, Vec<u8>)> {
        let (mut left, mut first) = (cells, 0);
        let of_body = |body: &&Elastic| {
            let behind = first + body.cells() as u32;
            let (own, rest) = left.split_at(left.partition_point(|&cell| cell < behind));
            let own: Vec<u32> = own.iter().map(|cell| cell - first).collect();
            (left, first) = (rest, behind);
            let (points, portion) = portion::portion(body, &own);
            (points, portion.to_bytes())
        };
        self.bodies.iter().map(of_body).collect()
    }

    fn others(&self, visit: &mut Summands) {
        let dim = self.all.dofs.dim;
        (self.all).spring_groups(&mut |points, dense| each_entry(dim, points, dense, visit));
    }
}

/// Hands out the entries of a dense matrix over points.
fn each_entry(dim: usize, points: &[usize], dense: &[f64], visit: &mut Summands) {
    let dof = |k: usize| points[k / dim] * dim + k % dim;
    let width = points.len() * dim;
    for (i, row) in dense.chunks_exact(width).enumerate() {
        for (j, &value) in row.iter().enumerate() {
            visit(dof(i), dof(j), value);
        }
    }
}

/// The stiffness of all that is linear, with the pattern of the whole: without bodies that turn cell by cell.
pub(super) fn linear_part(model: &Model, whole: &BlockCsr) -> BlockCsr {
    let mut rest = whole.zeros_like();
    let bodies = model.elastic().filter(|b| !b.elastic.is_corotational());
    bodies.for_each(|body| body.elastic.stiffness(&mut rest));
    for &(dof, k) in model.actions.springs.iter().flat_map(|s| s.entries()) {
        model.links.add_spring(&mut rest, dof, k);
    }
    rest
}

/// The bodies whose matrix is needed: an explicit analysis needs none.
pub(super) fn stiff(model: &Model) -> impl Iterator<Item = &crate::model::definition::Body> {
    let needed = !model.steps.iter().all(Step::is_explicit);
    model.elastic().filter(move |_| needed)
}

/// Whether an analysis does without the entries: factors are elsewhere, and nothing moves.
pub(super) fn suffices(model: &Model) -> bool {
    let at_rest = |step: &Step| step.dynamic.is_none() && step.modal.is_none();
    // What turns freely or cell by cell is not condensed at rest.
    let turns = model.turns_freely() || model.is_corotational();
    model.solution.engine.as_dyn().condenses() && !turns && model.steps.iter().all(at_rest)
}
