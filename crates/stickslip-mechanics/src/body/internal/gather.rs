//! From the forces of the chunks to those of the points of the mesh.

use super::chunk::Chunks;
use super::sweep::Padded;
use crate::system::Dofs;

/// Where the forces on every point are found, in a fixed order.
#[derive(Debug, Clone)]
pub struct Incidence {
    /// Where the entries of each point begin, and where the last ones end.
    starts: Vec<u32>,
    /// Places in the buffer of forces, ascending for each point.
    entries: Vec<u32>,
}

impl Incidence {
    /// For a buffer with `stride` places a chunk.
    pub fn new(points: usize, chunks: &Chunks, stride: usize) -> Self {
        let mut starts = vec![0_u32; points + 1];
        for &p in &chunks.points {
            starts[p as usize + 1] += 1;
        }
        for p in 0..points {
            starts[p + 1] += starts[p];
        }
        let mut next = starts.clone();
        let mut entries = vec![0; chunks.points.len()];
        for (i, chunk) in chunks.chunks.iter().enumerate() {
            let [begin, end] = chunk.points;
            for (number, &p) in chunks.points[begin..end].iter().enumerate() {
                entries[next[p as usize] as usize] = (i * stride + number) as u32;
                next[p as usize] += 1;
            }
        }
        Incidence { starts, entries }
    }

    /// Writes the sums of the points from `first` on to `out`, as many as fit.
    pub fn sum(&self, dofs: Dofs, first: usize, forces: &[Padded], out: &mut [f64]) {
        match dofs.dim {
            2 => self.sum_components::<2>(first, forces, out),
            _ => self.sum_components::<3>(first, forces, out),
        }
    }

    fn sum_components<const D: usize>(&self, first: usize, forces: &[Padded], out: &mut [f64]) {
        for (i, target) in out.as_chunks_mut::<D>().0.iter_mut().enumerate() {
            let [begin, end] = [self.starts[first + i], self.starts[first + i + 1]];
            let mut sum = [0.0; D];
            for &entry in &self.entries[begin as usize..end as usize] {
                for (s, f) in sum.iter_mut().zip(&forces[entry as usize]) {
                    *s += f;
                }
            }
            *target = sum;
        }
    }
}
