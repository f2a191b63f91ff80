//! The loop over the cells of a chunk: gather, compute in lanes, scatter.

use pulp::{Arch, Simd, WithSimd};

use super::lane::{GROUP, Nodes, Row};

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
    pub x: &'a [[f64; 3]],
    /// Their displacements.
    pub u: &'a [[f64; 3]],
}

/// A way to compute the forces of a chunk: what is chosen once a part.
pub trait Kernel: Send + Sync {
    /// Adds the forces of the cells to those of the local points `f`.
    fn add(&self, arch: Arch, cells: Cells, f: &mut [[f64; 3]]);
}

/// A [`CellForce`] as a [`Kernel`].
pub struct Swept<K, const N: usize, const D: usize>(pub K);

impl<K: CellForce<N, D>, const N: usize, const D: usize> Kernel for Swept<K, N, D> {
    fn add(&self, arch: Arch, cells: Cells, f: &mut [[f64; 3]]) {
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
    f: &'a mut [[f64; 3]],
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
            gather(nodes, cells.x, &mut x);
            gather(nodes, cells.u, &mut u);
            for part in 0..GROUP / S::F64_LANES {
                force.force(simd, part, &x, &u, &mut forces);
            }
            let count = (cells.count - group * GROUP).min(GROUP);
            scatter(nodes, count, &forces, f);
        }
    }
}

#[inline(always)]
fn gather<const N: usize, const D: usize>(
    nodes: &[[u16; GROUP]; N],
    from: &[[f64; 3]],
    to: &mut Nodes<N, D>,
) {
    for (numbers, rows) in nodes.iter().zip(to) {
        for (lane, &p) in numbers.iter().enumerate() {
            let value = from[usize::from(p)];
            for i in 0..D {
                rows[i].0[lane] = value[i];
            }
        }
    }
}

/// Adds the forces of the first `count` cells, in a fixed order.
#[inline(always)]
fn scatter<const N: usize, const D: usize>(
    nodes: &[[u16; GROUP]; N],
    count: usize,
    from: &Nodes<N, D>,
    to: &mut [[f64; 3]],
) {
    for (numbers, rows) in nodes.iter().zip(from) {
        for (lane, &p) in numbers.iter().enumerate().take(count) {
            let value = &mut to[usize::from(p)];
            for i in 0..D {
                value[i] += rows[i].0[lane];
            }
        }
    }
}
