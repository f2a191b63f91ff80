//! The stiffness matrix of one cell.

use super::geometry::{Nodal, Point, point};
use super::medium::Medium;
use super::operator::Term;
use super::scheme::Scheme;
use super::{Space, hourglass};

/// Workspace of [`stiffness`], one a task.
pub(super) struct Scratch<const N: usize> {
    /// `G[3 k + l][a][b]`
    local: [[[f64; N]; N]; 9],
    /// `Ḡ[3 k + l][a][b]`
    mean: [[[f64; N]; N]; 9],
    /// The entries `[3 i + j]` of the blocks of all pairs of nodes.
    entries: [[[f64; N]; N]; 9],
    /// Derivatives at the quadrature points.
    points: Vec<Point<N>>,
}

impl<const N: usize> Scratch<N> {
    /// On the heap: hex20 needs 60 KiB.
    pub fn new() -> Box<Self> {
        Box::new(Scratch {
            local: [[[0.0; N]; N]; 9],
            mean: [[[0.0; N]; N]; 9],
            entries: [[[0.0; N]; N]; 9],
            points: Vec::new(),
        })
    }
}

/// Writes the stiffness of the cell with nodes `x` to `out`, shape `(N dim, N dim)` row by row, exactly symmetric.
pub(super) fn stiffness<const N: usize>(
    of: &Medium<N>,
    x: &Nodal<N>,
    scratch: &mut Scratch<N>,
    out: &mut [f64],
) {
    let (space, operator) = (of.space, &of.operator);
    products(of, x, scratch);
    let dim = space.dim();
    for i in 0..dim {
        for j in i..dim {
            let entry = &mut scratch.entries[3 * i + j];
            *entry = [[0.0; N]; N];
            add(entry, &operator.local, i, j, &scratch.local);
            add(entry, &operator.mean, i, j, &scratch.mean);
            if i == j {
                for a in 0..N {
                    for b in 0..a {
                        entry[b][a] = entry[a][b];
                    }
                }
            }
        }
    }
    mirror(&mut scratch.entries, dim);
    match dim {
        2 => write::<N, 2>(&scratch.entries, out),
        _ => write::<N, 3>(&scratch.entries, out),
    }
    match of.scheme {
        Scheme::Uniform => {
            let mean = hourglass::mean(&scratch.points);
            let vectors = of
                .hourglass
                .vectors(x, &of.table, &scratch.points, &mean, of.modulus);
            for (v, directions) in vectors.iter().zip(of.hourglass.directions()) {
                add_square(v, directions, dim, out);
            }
        }
        Scheme::Incompatible => {
            of.modes
                .condense(x, &scratch.points, space, &operator.local, out);
        }
        Scheme::Plain | Scheme::MeanDilatation => {}
    }
}

/// Adds `v vᵀ` in some directions.
fn add_square<const N: usize>(
    v: &[f64; N],
    directions: std::ops::Range<usize>,
    dim: usize,
    out: &mut [f64],
) {
    let width = N * dim;
    for (a, va) in v.iter().enumerate() {
        for i in directions.clone() {
            let row = &mut out[(a * dim + i) * width..][..width];
            for (b, vb) in v.iter().enumerate() {
                row[b * dim + i] += va * vb;
            }
        }
    }
}

/// Puts the entries `(i, j)` of all blocks into one matrix of `D` rows and columns a node.
fn write<const N: usize, const D: usize>(entries: &[[[f64; N]; N]; 9], out: &mut [f64]) {
    for (a, rows) in out.chunks_exact_mut(N * D * D).enumerate() {
        for (i, row) in rows.chunks_exact_mut(N * D).enumerate() {
            for j in 0..D {
                let source = &entries[3 * i + j][a];
                for (target, value) in row.chunks_exact_mut(D).zip(source) {
                    target[j] = *value;
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
fn products<const N: usize>(of: &Medium<N>, x: &Nodal<N>, scratch: &mut Scratch<N>) {
    let (table, space): (_, Space) = (&of.table, of.space);
    let means = !of.operator.mean.is_empty();
    let used = space.derivatives();
    scratch.points.clear();
    scratch
        .points
        .extend((0..table.len()).map(|q| point(table, q, x, space)));
    for k in 0..used {
        for l in k..used {
            for (a, row) in scratch.local[3 * k + l].iter_mut().enumerate() {
                // Two sums at a time stay in a register while the points are run through.
                let mut b = 0;
                while b + 1 < N {
                    let mut sum = [0.0; 2];
                    for p in &scratch.points {
                        let factor = p.volume * p.d[k][a];
                        sum = [sum[0] + factor * p.d[l][b], sum[1] + factor * p.d[l][b + 1]];
                    }
                    (row[b], row[b + 1]) = (sum[0], sum[1]);
                    b += 2;
                }
                if b < N {
                    row[b] = scratch
                        .points
                        .iter()
                        .map(|p| p.volume * p.d[k][a] * p.d[l][b])
                        .sum();
                }
            }
        }
    }
    mirror(&mut scratch.local, used);
    if means {
        // V d̄_a d̄_b = (∫ d_a)(∫ d_b) / V
        let mut volume = 0.0;
        let mut sums = [[0.0; N]; 3];
        for p in &scratch.points {
            volume += p.volume;
            for (sum, d) in sums.iter_mut().zip(&p.d) {
                for (s, d) in sum.iter_mut().zip(d) {
                    *s += p.volume * d;
                }
            }
        }
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

/// `g[l][k]_ab = g[k][l]_ba`, for products of derivatives and blocks of the matrix alike.
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
