//! The stiffness matrix of one cell.

use super::Space;
use super::geometry::{Nodal, Table, point};
use super::operator::{Operator, Term};

/// Workspace of [`stiffness`], one a task.
pub(super) struct Scratch<const N: usize> {
    /// `G[3 k + l][a][b]`
    local: [[[f64; N]; N]; 9],
    /// `Ḡ[3 k + l][a][b]`
    mean: [[[f64; N]; N]; 9],
    /// The entries `(i, j)` of all blocks.
    entry: [[f64; N]; N],
}

impl<const N: usize> Scratch<N> {
    /// On the heap: hex20 needs 60 KiB.
    pub fn new() -> Box<Self> {
        Box::new(Scratch {
            local: [[[0.0; N]; N]; 9],
            mean: [[[0.0; N]; N]; 9],
            entry: [[0.0; N]; N],
        })
    }
}

/// Writes the stiffness of the cell with nodes `x` to `out`, shape `(N dim, N dim)` row by row, exactly symmetric.
pub(super) fn stiffness<const N: usize>(
    table: &Table<N>,
    x: &Nodal<N>,
    space: Space,
    operator: &Operator,
    scratch: &mut Scratch<N>,
    out: &mut [f64],
) {
    products(table, x, space, !operator.mean.is_empty(), scratch);
    let dim = space.dim();
    let width = N * dim;
    for i in 0..dim {
        for j in i..dim {
            scratch.entry = [[0.0; N]; N];
            add(&mut scratch.entry, &operator.local, i, j, &scratch.local);
            add(&mut scratch.entry, &operator.mean, i, j, &scratch.mean);
            if i == j {
                for a in 0..N {
                    for b in 0..=a {
                        let value = scratch.entry[a][b];
                        out[(a * dim + i) * width + b * dim + i] = value;
                        out[(b * dim + i) * width + a * dim + i] = value;
                    }
                }
            } else {
                for a in 0..N {
                    for b in 0..N {
                        let value = scratch.entry[a][b];
                        out[(a * dim + i) * width + b * dim + j] = value;
                        out[(b * dim + j) * width + a * dim + i] = value;
                    }
                }
            }
        }
    }
}

/// `entry += Σ value · g[kl]` over the terms of `(i, j)`.
#[inline]
fn add<const N: usize>(
    entry: &mut [[f64; N]; N],
    terms: &[Term],
    i: usize,
    j: usize,
    g: &[[[f64; N]; N]; 9],
) {
    for term in terms.iter().filter(|t| t.i == i && t.j == j) {
        for (row, source) in entry.iter_mut().zip(&g[term.kl]) {
            for (e, s) in row.iter_mut().zip(source) {
                *e += term.value * s;
            }
        }
    }
}

/// Fills `local` with `∫ ∂_k N_a ∂_l N_b`, and `mean` with the same of the cell's mean derivatives.
fn products<const N: usize>(
    table: &Table<N>,
    x: &Nodal<N>,
    space: Space,
    means: bool,
    scratch: &mut Scratch<N>,
) {
    let used = space.derivatives();
    for k in 0..used {
        for l in k..used {
            scratch.local[3 * k + l] = [[0.0; N]; N];
        }
    }
    let mut volume = 0.0;
    let mut sums = [[0.0; N]; 3];
    for q in 0..table.len() {
        let p = point(table, q, x, space);
        for k in 0..used {
            for l in k..used {
                for (row, &dk) in scratch.local[3 * k + l].iter_mut().zip(&p.d[k]) {
                    let factor = p.volume * dk;
                    for (g, dl) in row.iter_mut().zip(&p.d[l]) {
                        *g += factor * dl;
                    }
                }
            }
            if means {
                for (s, d) in sums[k].iter_mut().zip(&p.d[k]) {
                    *s += p.volume * d;
                }
            }
        }
        volume += p.volume;
    }
    mirror(&mut scratch.local, used);
    if means {
        // V d̄_a d̄_b = (∫ d_a)(∫ d_b) / V
        for k in 0..used {
            for l in k..used {
                for a in 0..N {
                    for b in 0..N {
                        scratch.mean[3 * k + l][a][b] = sums[k][a] * sums[l][b] / volume;
                    }
                }
            }
        }
        mirror(&mut scratch.mean, used);
    }
}

/// `G[l][k]_ab = G[k][l]_ba`
fn mirror<const N: usize>(g: &mut [[[f64; N]; N]; 9], used: usize) {
    for k in 0..used {
        for l in k + 1..used {
            for a in 0..N {
                for b in 0..N {
                    g[3 * l + k][a][b] = g[3 * k + l][b][a];
                }
            }
        }
    }
}
