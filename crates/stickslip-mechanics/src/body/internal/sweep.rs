//! The loop over the cells of a chunk: gather, compute in lanes, scatter.

use pulp::{Arch, Simd, WithSimd};

use super::lane::{GROUP, Nodes, Row};

/// A vector of the width that registers have.
pub type Padded = [f64; 4];

/// Forces of the cells of one register, from places and displacements of their `N` nodes in `D` dimensions.
pub trait CellForce<const N: usize, const D: usize>: Send + Sync {
    /// Writes part `part` of `f`.
    fn force<S: Simd>(
        &self,
        simd: S,
        part: usize,
        x: &Nodes<N, D>,
        u: &Nodes<N, D>,
        f: &mut Nodes<N, D>,
    );
}

/// What a chunk hands to its kernel.
#[derive(Clone, Copy)]
pub struct Cells<'a> {
    /// Number of cells.
    pub count: usize,
    /// Local numbers of their nodes, `GROUP` cells side by side for every node, group after group. The last group
    /// repeats its last cell.
    pub nodes: &'a [u16],
    /// Places of the local points.
    pub x: &'a [Padded],
    /// Their displacements.
    pub u: &'a [Padded],
}

/// A way to compute the forces of a chunk: what is chosen once a part.
pub trait Kernel: Send + Sync {
    /// Adds the forces of the cells to those of the local points `f`.
    fn add(&self, arch: Arch, cells: Cells, f: &mut [Padded]);
}

/// A [`CellForce`] as a [`Kernel`].
pub struct Swept<K, const N: usize, const D: usize>(pub K);

impl<K: CellForce<N, D>, const N: usize, const D: usize> Kernel for Swept<K, N, D> {
    fn add(&self, arch: Arch, cells: Cells, f: &mut [Padded]) {
        arch.dispatch(Sweep::<K, N, D> {
            force: &self.0,
            cells,
            f,
        });
    }
}

struct Sweep<'a, K, const N: usize, const D: usize> {
    force: &'a K,
    cells: Cells<'a>,
    f: &'a mut [Padded],
}

impl<K: CellForce<N, D>, const N: usize, const D: usize> WithSimd for Sweep<'_, K, N, D> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Sweep { force, cells, f } = self;
        let empty = [[Row([0.0; GROUP]); D]; N];
        let (mut x, mut u, mut forces) = (empty, empty, empty);
        let rows = cells.nodes.as_chunks::<GROUP>().0;
        for (group, nodes) in rows.as_chunks::<N>().0.iter().enumerate() {
            gather(simd, nodes, cells.x, &mut x);
            gather(simd, nodes, cells.u, &mut u);
            for part in 0..GROUP / S::F64_LANES {
                force.force(simd, part, &x, &u, &mut forces);
            }
            let count = (cells.count - group * GROUP).min(GROUP);
            scatter(simd, nodes, count, &forces, f);
        }
    }
}

/// Puts the vectors of a group side by side, component by component.
#[inline(always)]
fn gather<S: Simd, const N: usize, const D: usize>(
    simd: S,
    nodes: &[[u16; GROUP]; N],
    from: &[Padded],
    to: &mut Nodes<N, D>,
) {
    for (numbers, rows) in nodes.iter().zip(to) {
        let mut points = [[0.0; 4]; GROUP];
        for lane in 0..GROUP {
            points[lane] = from[usize::from(numbers[lane])];
        }
        let registers = S::as_simd_f64s(points.as_flattened()).0;
        let to_components = registers.as_chunks::<4>().0;
        for part in 0..GROUP / S::F64_LANES {
            // Exchanges rows and columns, with cells in an order that `interleave` undoes.
            let components = simd.deinterleave_shfl_f64s(to_components[part]);
            for i in 0..D {
                S::as_mut_simd_f64s(&mut rows[i].0).0[part] = components[i];
            }
        }
    }
}

/// Adds the forces of the first `count` cells, in a fixed order.
#[inline(always)]
fn scatter<S: Simd, const N: usize, const D: usize>(
    simd: S,
    nodes: &[[u16; GROUP]; N],
    count: usize,
    from: &Nodes<N, D>,
    to: &mut [Padded],
) {
    for (numbers, rows) in nodes.iter().zip(from) {
        let mut points = [[0.0; 4]; GROUP];
        let registers = S::as_mut_simd_f64s(points.as_flattened_mut()).0;
        let by_point = registers.as_chunks_mut::<4>().0;
        for part in 0..GROUP / S::F64_LANES {
            let mut components = [simd.splat_f64s(0.0); 4];
            for i in 0..D {
                components[i] = S::as_simd_f64s(&rows[i].0).0[part];
            }
            by_point[part] = simd.interleave_shfl_f64s(components);
        }
        // Two loops, so that the one of nearly all groups is of fixed length.
        if count == GROUP {
            for lane in 0..GROUP {
                add(&mut to[usize::from(numbers[lane])], &points[lane]);
            }
        } else {
            for lane in 0..count {
                add(&mut to[usize::from(numbers[lane])], &points[lane]);
            }
        }
    }
}

#[inline(always)]
fn add(to: &mut Padded, by: &Padded) {
    for i in 0..4 {
        to[i] += by[i];
    }
}
