//! `f = K u` without a matrix: the internal force cell by cell, for explicit dynamics.
//!
//! A matrix in memory is read once a product, and that is as fast as it gets. Here little is read, and the rest is
//! arithmetic in registers that hold one number of several cells each (`lane.rs`):
//!
//! ```text
//! part     kernel       what computes its cells: hexahedra, tetrahedra, any cell       kernels.rs
//! order    chunks       cells near each other, with points of their own                order.rs, chunk.rs
//! apply    sweep        gather points, compute in lanes, scatter to the chunk          sweep.rs
//!          gather       sum over the chunks that share a point, in fixed order         gather.rs
//! ```
//!
//! Chunks and the order of every sum are fixed, so that the bits do not depend on the number of threads.

mod cellwise;
mod chunk;
mod gather;
mod generic;
mod hex8;
mod kernels;
mod lane;
mod law;
mod order;
mod spectrum;
mod sweep;
mod tensor;
#[cfg(test)]
mod tests;
mod tet4;
mod trilinear;
mod uniform;

use pulp::Arch;
use rayon::prelude::*;

use super::Elastic;
use crate::system::Dofs;
use chunk::{Chunk, Chunks, Local};
use gather::Incidence;
pub use spectrum::largest_eigenvalue;
use sweep::{Cells, Kernel, Padded};

/// Least number of cells that are worth the threads: some 20 µs of work.
const CELLS_FOR_THREADS: usize = 1000;

/// Points that one task sums up.
const POINTS_PER_TASK: usize = 2048;

/// The internal force of linear elastic bodies.
pub struct InternalForce {
    dofs: Dofs,
    arch: Arch,
    kernels: Vec<Box<dyn Kernel>>,
    chunks: Chunks,
    incidence: Incidence,
    /// Places of a chunk in `forces`.
    stride: usize,
    /// Forces on the points of the chunks, `stride` a chunk.
    forces: Vec<Padded>,
}

impl std::fmt::Debug for InternalForce {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.debug_struct("InternalForce")
            .field("dofs", &self.dofs)
            .field("cells", &self.cells())
            .field("chunks", &self.chunks.chunks.len())
            .finish_non_exhaustive()
    }
}

impl InternalForce {
    /// For bodies of one mesh, whose dofs are `dofs`.
    ///
    /// Keeps what it needs of them: a number of two bytes a node of a cell, and some fifty bytes a point of a chunk.
    ///
    /// # Panics
    /// If a body has another dimension than `dofs`, or more points: dofs may follow those of the mesh.
    pub fn new(bodies: &[&Elastic], dofs: Dofs) -> Self {
        let mut chunks = Chunks::default();
        let mut all = Vec::new();
        let mut local = Local::new(dofs.points);
        for body in bodies {
            assert_eq!(body.space.dim(), dofs.dim, "dimension of {}", body.name);
            let points = &body.mesh.points;
            assert!(points.len() <= dofs.points, "points of {}", body.name);
            for (part, p) in body.parts.iter().enumerate() {
                let block = &body.mesh.blocks[p.block];
                for (kernel, mut cells) in kernels::of_part(body, part) {
                    order::along_curve(points, block, &mut cells);
                    chunks.push(all.len(), points, block, &cells, &mut local);
                    all.push(kernel);
                }
            }
        }
        let points_of = |c: &Chunk| c.points[1] - c.points[0];
        let stride = chunks.chunks.iter().map(points_of).max().unwrap_or(0);
        InternalForce {
            dofs,
            arch: Arch::new(),
            kernels: all,
            incidence: Incidence::new(dofs.points, &chunks, stride),
            // The chunk size of a parallel loop must not be zero.
            stride: stride.max(1),
            forces: vec![[0.0; 4]; stride * chunks.chunks.len()],
            chunks,
        }
    }

    /// Writes the internal force `[N]` at the displacements `u` `[m]` to `out`, both by dof of the whole mesh; zero at
    /// the points of no body. The same bits for any number of threads.
    ///
    /// Runs in the thread pool of the caller; a loop of many calls is best run inside it.
    ///
    /// # Panics
    /// If `u` or `out` has another length than the number of dofs.
    pub fn apply(&mut self, u: &[f64], out: &mut [f64]) {
        assert_eq!(u.len(), self.dofs.count(), "length of u");
        assert_eq!(out.len(), self.dofs.count(), "length of out");
        let InternalForce {
            dofs,
            arch,
            kernels,
            chunks,
            incidence,
            stride,
            forces,
        } = self;
        let (dofs, arch, chunks) = (*dofs, *arch, &*chunks);
        let task = |(f, chunk): (&mut [Padded], &Chunk)| {
            run_chunk(&*kernels[chunk.kernel], arch, dofs, chunks, chunk, u, f);
        };
        let width = POINTS_PER_TASK * dofs.dim;
        if chunks.cells < CELLS_FOR_THREADS {
            forces
                .chunks_mut(*stride)
                .zip(&chunks.chunks)
                .for_each(task);
            incidence.sum(dofs, 0, forces, out);
        } else {
            forces
                .par_chunks_mut(*stride)
                .zip(&chunks.chunks)
                .for_each(task);
            out.par_chunks_mut(width)
                .enumerate()
                .for_each(|(i, part)| incidence.sum(dofs, i * POINTS_PER_TASK, forces, part));
        }
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.chunks.cells
    }
}

/// Writes the forces on the points of a chunk to the beginning of `f`.
fn run_chunk(
    kernel: &dyn Kernel,
    arch: Arch,
    dofs: Dofs,
    chunks: &Chunks,
    chunk: &Chunk,
    u: &[f64],
    f: &mut [Padded],
) {
    let [begin, end] = chunk.points;
    let count = end - begin;
    let mut displacements = [[0.0; 4]; chunk::CHUNK_POINTS];
    let points = &chunks.points[begin..end];
    match dofs.dim {
        2 => take::<2>(u, points, &mut displacements),
        _ => take::<3>(u, points, &mut displacements),
    }
    let f = &mut f[..count];
    f.fill([0.0; 4]);
    let cells = Cells {
        count: chunk.cells,
        nodes: &chunks.nodes[chunk.nodes[0]..chunk.nodes[1]],
        x: &chunks.places[begin..end],
        u: &displacements[..count],
    };
    kernel.add(arch, cells, f);
}

/// The displacements of some points.
fn take<const D: usize>(u: &[f64], points: &[u32], out: &mut [Padded]) {
    let u = u.as_chunks::<D>().0;
    for (value, &p) in out.iter_mut().zip(points) {
        for (to, from) in value.iter_mut().zip(u[p as usize]) {
            *to = from;
        }
    }
}
