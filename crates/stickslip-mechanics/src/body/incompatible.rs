//! Modes inside quad4 and hex8 that let them bend: `1 - ξ²`, `1 - η²` and `1 - ζ²` in each direction, gone before the matrix
//! of the cell is handed out.
//!
//! Their gradients are made with the Jacobian `J₀` at the centre, `j₀/j J₀⁻ᵀ ∂M/∂ξ`
//! ([`taylor_1976`](stickslip_base::references::taylor_1976)), and then lose their mean over the cell
//! ([`ibrahimbegovic_1991`](stickslip_base::references::ibrahimbegovic_1991)), which is zero but around an axis, where hoop strains have one.
//! Gradients without mean do no work on constant stresses: patch tests are exact. With `K_uu`, `K_au` and `K_aa` between nodes and
//! modes, the matrix of the cell is `K_uu - K_uaᵀ K_aa⁻¹ K_au`.

use super::Space;
use super::geometry::{Nodal, Point};
use super::operator::Term;
use crate::math::{Mat3, inverse};
use crate::shape::{ElementKind, QuadraturePoint};

/// Most unknowns of the modes of a cell: hex8.
const MODE_UNKNOWNS: usize = 9;

/// The modes of a kind with `N` nodes.
#[derive(Debug, Clone)]
pub(super) struct Modes<const N: usize> {
    /// How many they are: 2 or 3.
    count: usize,
    /// Gradients of the shape functions at the centre.
    centre: [[f64; N]; 3],
    /// Reference coordinates of the points of the rule.
    xi: Vec<[f64; 3]>,
    /// Values of the shape functions there.
    values: Vec<[f64; N]>,
}

/// `[k][m]`: derivative `k` of mode `m` at a point.
type Gradients = [[f64; 3]; 3];

/// The matrix of the modes, factored: `L` of `K_aa = L Lᵀ`.
struct Factor {
    l: [[f64; MODE_UNKNOWNS]; MODE_UNKNOWNS],
    n: usize,
}

impl<const N: usize> Modes<N> {
    /// For quad4 and hex8 with the given rule.
    pub fn new(kind: ElementKind, rule: &[QuadraturePoint]) -> Self {
        let mut centre = [[0.0; N]; 3];
        let mut d = [[0.0; 3]; N];
        kind.reference().gradients(kind.centre(), &mut d);
        for (a, d) in d.iter().enumerate() {
            for k in 0..3 {
                centre[k][a] = d[k];
            }
        }
        let values = rule.iter().map(|q| {
            let mut n = [0.0; N];
            kind.reference().values(q.xi, &mut n);
            n
        });
        Modes {
            count: kind.dim(),
            centre,
            xi: rule.iter().map(|q| q.xi).collect(),
            values: values.collect(),
        }
    }

    /// Gradients at the points of the rule, whose mean over the cell is zero.
    fn gradients(&self, x: &Nodal<N>, points: &[Point<N>], space: Space) -> Vec<Gradients> {
        let dim = space.dim();
        let mut j: Mat3 = [[0.0; 3], [0.0; 3], [0.0, 0.0, 1.0]];
        for i in 0..dim {
            for m in 0..dim {
                j[i][m] = x[i].iter().zip(&self.centre[m]).map(|(x, d)| x * d).sum();
            }
        }
        // A cell that is sound at its points can be folded at its centre only if it is bent beyond use.
        let (inv, determinant) = inverse(&j).unwrap_or(([[0.0; 3]; 3], 0.0));
        let mut all: Vec<Gradients> = Vec::with_capacity(points.len());
        for (q, (p, xi)) in points.iter().zip(&self.xi).enumerate() {
            let mut g = [[0.0; 3]; 3];
            for m in 0..self.count {
                let slope = -2.0 * xi[m] * determinant / p.jacobian;
                for (k, row) in g.iter_mut().enumerate().take(dim) {
                    row[m] = slope * inv[m][k];
                }
                if space == Space::Axisymmetric {
                    let radius: f64 = self.values[q].iter().zip(&x[0]).map(|(n, x)| n * x).sum();
                    g[2][m] = (1.0 - xi[m] * xi[m]) / radius;
                }
            }
            all.push(g);
        }
        let volume: f64 = points.iter().map(|p| p.volume).sum();
        let mut mean = [[0.0; 3]; 3];
        for (g, p) in all.iter().zip(points) {
            for (mean, g) in mean.as_flattened_mut().iter_mut().zip(g.as_flattened()) {
                *mean += p.volume * g / volume;
            }
        }
        for g in &mut all {
            for (g, mean) in g.as_flattened_mut().iter_mut().zip(mean.as_flattened()) {
                *g -= mean;
            }
        }
        all
    }

    /// `K_aa`, factored.
    fn factor(
        &self,
        gradients: &[Gradients],
        points: &[Point<N>],
        terms: &[Term],
        dim: usize,
    ) -> Factor {
        let n = self.count * dim;
        let mut l = [[0.0; MODE_UNKNOWNS]; MODE_UNKNOWNS];
        for_pairs(terms, &mut |i, k, j, l_index, value| {
            for a in 0..self.count {
                for b in 0..self.count {
                    let sum: f64 = gradients
                        .iter()
                        .zip(points)
                        .map(|(g, p)| p.volume * g[k][a] * g[l_index][b])
                        .sum();
                    l[a * dim + i][b * dim + j] += value * sum;
                }
            }
        });
        for i in 0..n {
            for j in 0..=i {
                let s: f64 = (0..j).map(|k| l[i][k] * l[j][k]).sum();
                let rest = l[i][j] - s;
                l[i][j] = if i == j { rest.sqrt() } else { rest / l[j][j] };
            }
        }
        Factor { l, n }
    }

    /// Subtracts `K_uaᵀ K_aa⁻¹ K_au` from the matrix `out` of a cell, shape `(N dim, N dim)`, which stays exactly symmetric.
    pub fn condense(
        &self,
        x: &Nodal<N>,
        points: &[Point<N>],
        space: Space,
        terms: &[Term],
        out: &mut [f64],
    ) {
        let dim = space.dim();
        let width = N * dim;
        let gradients = self.gradients(x, points, space);
        let factor = self.factor(&gradients, points, terms, dim);
        let mut coupling = vec![0.0; factor.n * width];
        for_pairs(terms, &mut |i, k, j, l, value| {
            for m in 0..self.count {
                let row = &mut coupling[(m * dim + i) * width..][..width];
                for (g, p) in gradients.iter().zip(points) {
                    let part = value * p.volume * g[k][m];
                    for (a, d) in p.d[l].iter().enumerate() {
                        row[a * dim + j] += part * d;
                    }
                }
            }
        });
        for i in 0..factor.n {
            let (done, rest) = coupling.split_at_mut(i * width);
            for (j, row) in done.chunks_exact(width).enumerate() {
                for (r, d) in rest[..width].iter_mut().zip(row) {
                    *r -= factor.l[i][j] * d;
                }
            }
            for r in &mut rest[..width] {
                *r /= factor.l[i][i];
            }
        }
        for row in coupling.chunks_exact(width) {
            for (out, r) in out.chunks_exact_mut(width).zip(row) {
                for (o, c) in out.iter_mut().zip(row) {
                    *o -= r * c;
                }
            }
        }
    }

    /// Adds the strains of the modes, in equilibrium with the stresses of `strain` at the points, to `strain`.
    pub fn add_strains(
        &self,
        x: &Nodal<N>,
        points: &[Point<N>],
        space: Space,
        terms: &[Term],
        stress: &[[f64; 6]],
        strain: &mut [[f64; 6]],
    ) {
        let (dim, used) = (space.dim(), space.derivatives());
        let gradients = self.gradients(x, points, space);
        let factor = self.factor(&gradients, points, terms, dim);
        let mut amplitude = [0.0; MODE_UNKNOWNS];
        for ((g, p), stress) in gradients.iter().zip(points).zip(stress) {
            for m in 0..self.count {
                for i in 0..dim {
                    for k in 0..used {
                        if let Some(v) = space.component(i, k) {
                            amplitude[m * dim + i] -= p.volume * g[k][m] * stress[v];
                        }
                    }
                }
            }
        }
        factor.solve(&mut amplitude);
        for (g, strain) in gradients.iter().zip(strain) {
            for m in 0..self.count {
                for i in 0..dim {
                    for k in 0..used {
                        if let Some(v) = space.component(i, k) {
                            strain[v] += g[k][m] * amplitude[m * dim + i];
                        }
                    }
                }
            }
        }
    }
}

impl Factor {
    fn solve(&self, b: &mut [f64; MODE_UNKNOWNS]) {
        for i in 0..self.n {
            let s: f64 = (0..i).map(|k| self.l[i][k] * b[k]).sum();
            b[i] = (b[i] - s) / self.l[i][i];
        }
        for i in (0..self.n).rev() {
            let s: f64 = (i + 1..self.n).map(|k| self.l[k][i] * b[k]).sum();
            b[i] = (b[i] - s) / self.l[i][i];
        }
    }
}

/// Visits `(i, k, j, l, value)` of all terms, those below the diagonal that follow from symmetry included.
fn for_pairs(terms: &[Term], visit: &mut dyn FnMut(usize, usize, usize, usize, f64)) {
    for t in terms {
        let (k, l) = (t.kl / 3, t.kl % 3);
        visit(t.i, k, t.j, l, t.value);
        if t.i != t.j {
            visit(t.j, l, t.i, k, t.value);
        }
    }
}
