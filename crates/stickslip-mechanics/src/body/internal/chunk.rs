//! Cells in chunks of fixed size, each with points of its own, so that a chunk works in the cache next to the processor
//! and writes each of its points once.

use super::lane::GROUP;
use super::sweep::Padded;
use crate::math::Vec3;
use crate::mesh::Block;

/// Most cells of a chunk.
const CHUNK_CELLS: usize = 1024;

/// Most points of a chunk: places, displacements and forces are 16 KiB each.
pub const CHUNK_POINTS: usize = 512;

/// Cells that one task computes.
#[derive(Debug, Clone)]
pub struct Chunk {
    /// Which kernel.
    pub kernel: usize,
    /// Number of cells.
    pub cells: usize,
    /// Where its numbers begin in [`Chunks::nodes`], and where they end.
    pub nodes: [usize; 2],
    /// Where its points begin in [`Chunks::points`], and where they end.
    pub points: [usize; 2],
}

/// All chunks.
#[derive(Debug, Clone, Default)]
pub struct Chunks {
    /// The chunks.
    pub chunks: Vec<Chunk>,
    /// Local numbers of the nodes of the cells, see [`Cells::nodes`](super::sweep::Cells::nodes).
    pub nodes: Vec<u16>,
    /// Points of the mesh by local number, ascending within a chunk.
    pub points: Vec<u32>,
    /// Their places `[m]`.
    pub places: Vec<Padded>,
    /// Number of cells.
    pub cells: usize,
}

/// By point of the mesh: the last chunk that has it, and its local number there.
pub struct Local(Vec<(u32, u16)>);

impl Local {
    /// For a mesh of `points` points.
    pub fn new(points: usize) -> Self {
        Local(vec![(u32::MAX, 0); points])
    }
}

impl Chunks {
    /// Adds cells of a block, which `kernel` computes, in their order.
    pub fn push(
        &mut self,
        kernel: usize,
        places: &[Vec3],
        block: &Block,
        cells: &[u32],
        local: &mut Local,
    ) {
        let n = block.kind.node_count();
        let nodes_of = |cell: u32| &block.connectivity[cell as usize * n..][..n];
        self.cells += cells.len();
        let mut rest = cells;
        while !rest.is_empty() {
            let name = self.chunks.len() as u32;
            let first_point = self.points.len();
            let mut count = 0;
            while count < rest.len().min(CHUNK_CELLS)
                && self.points.len() - first_point + n <= CHUNK_POINTS
            {
                for &p in nodes_of(rest[count]) {
                    if local.0[p].0 != name {
                        local.0[p].0 = name;
                        self.points.push(p as u32);
                    }
                }
                count += 1;
            }
            self.points[first_point..].sort_unstable();
            for (number, &p) in self.points[first_point..].iter().enumerate() {
                local.0[p as usize].1 = number as u16;
                let [x, y, z] = places[p as usize];
                self.places.push([x, y, z, 0.0]);
            }
            let first_node = self.nodes.len();
            for group in rest[..count].chunks(GROUP) {
                for a in 0..n {
                    for lane in 0..GROUP {
                        let cell = group[lane.min(group.len() - 1)];
                        self.nodes.push(local.0[nodes_of(cell)[a]].1);
                    }
                }
            }
            self.chunks.push(Chunk {
                kernel,
                cells: count,
                nodes: [first_node, self.nodes.len()],
                points: [first_point, self.points.len()],
            });
            rest = &rest[count..];
        }
    }
}
