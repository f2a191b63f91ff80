//! What the kinematics share: the derivatives of a projection on a facet.
//!
//! Notation: `x_s` the secondary point, `x̄(ξ) = Σ N_j x_j` the facet, `a_α = x̄,α`, `r = x_s - x̄ = g n`. Differentiating
//! `r·a_β = 0` gives `A_βα δξ^α = (δx_s - δx̄)·a_β + g n·δx̄,β` with `A_βα = a_β·a_α - g n·x̄,αβ`.

use super::Pair;
use crate::contact::pairing::{invert2, pair_index, projection_matrix};
use crate::math::{Vec3, dot, scale, sub};

/// Derivatives of one projection.
pub(super) struct Projection<'a> {
    pub pair: &'a Pair<'a>,
    pub gap: f64,
    /// Inverse of `A_βα`.
    pub inverse: [[f64; 2]; 2],
    /// Gradients of the convective coordinates.
    pub xi: [Vec<f64>; 2],
}

impl<'a> Projection<'a> {
    pub fn new(pair: &'a Pair<'a>) -> Self {
        let foot = pair.foot;
        let gap = dot(sub(pair.point, foot.x), foot.normal);
        let matrix = projection_matrix(foot, scale(gap, foot.normal));
        // A point that was projected has an invertible matrix; on a caustic of a curved facet the metric stands in.
        let inverse = invert2(&matrix)
            .or_else(|| invert2(&projection_matrix(foot, [0.0; 3])))
            .unwrap_or([[0.0; 2]; 2]);
        let n = pair.dofs();
        let mut raw = [vec![0.0; n], vec![0.0; n]];
        for (beta, row) in raw.iter_mut().enumerate() {
            add_relative(pair, foot.a[beta], 1.0, row);
            if pair.kind.dim() > beta {
                add_facet(pair, &foot.dn[beta], foot.normal, gap, row);
            }
        }
        let mut xi = [vec![0.0; n], vec![0.0; n]];
        for alpha in 0..pair.kind.dim() {
            for (k, x) in xi[alpha].iter_mut().enumerate() {
                *x = inverse[alpha][0] * raw[0][k];
                if pair.kind.dim() == 2 {
                    *x += inverse[alpha][1] * raw[1][k];
                }
            }
        }
        Projection {
            pair,
            gap,
            inverse,
            xi,
        }
    }

    /// `v · (δx̄,β + x̄,βγ δξ^γ)`, the change of a base vector along `v`.
    pub fn base_change(&self, beta: usize, v: Vec3) -> Vec<f64> {
        let foot = self.pair.foot;
        let mut row = vec![0.0; self.pair.dofs()];
        add_facet(self.pair, &foot.dn[beta], v, 1.0, &mut row);
        for gamma in 0..self.pair.kind.dim() {
            let c = dot(foot.aa[pair_index(beta, gamma)], v);
            if c != 0.0 {
                add_scaled_row(c, &self.xi[gamma], &mut row);
            }
        }
        row
    }

    /// Adds `w k_n`, the second derivative of the gap.
    pub fn add_gap_hessian(&self, w: f64, out: &mut [f64]) {
        let foot = self.pair.foot;
        let d = self.pair.kind.dim();
        let metric = projection_matrix(foot, [0.0; 3]);
        let Some(dual) = invert2(&metric) else {
            return;
        };
        let change: Vec<Vec<f64>> = (0..d).map(|b| self.base_change(b, foot.normal)).collect();
        for alpha in 0..d {
            let mut facet = vec![0.0; self.pair.dofs()];
            add_facet(self.pair, &foot.dn[alpha], foot.normal, 1.0, &mut facet);
            add_outer(-w, &facet, &self.xi[alpha], out);
            add_outer(-w, &self.xi[alpha], &facet, out);
            for beta in 0..d {
                let c = dot(foot.aa[pair_index(alpha, beta)], foot.normal);
                if c != 0.0 {
                    add_outer(-w * c, &self.xi[alpha], &self.xi[beta], out);
                }
                let g = w * self.gap * dual[alpha][beta];
                add_outer(g, &change[alpha], &change[beta], out);
            }
        }
    }

    /// Adds `Σ_α t_α ∂²ξ^α`: the second derivatives of the convective coordinates, weighted.
    ///
    /// From differentiating the first variation once more along a second direction Δ:
    /// `A_βα Δδξ^α = -δx̄,γ·a_β Δξ^γ + (δx_s - δx̄)·Δa_β + Δr·δx̄,β + r·δx̄,βγ Δξ^γ - ΔA_βα δξ^α`.
    pub fn add_xi_hessian(&self, t: [f64; 2], out: &mut [f64]) {
        let pair = self.pair;
        let foot = pair.foot;
        let (n, d) = (pair.dofs(), pair.kind.dim());
        let r = scale(self.gap, foot.normal);
        let third = third_derivatives(pair);
        for beta in 0..d {
            let lambda: f64 = (0..d)
                .map(|alpha| self.inverse[alpha][beta] * t[alpha])
                .sum();
            if lambda == 0.0 {
                continue;
            }
            // Wᵀ ⊗ N,β + N,βᵀ ⊗ W on equal components: (δx_s - δx̄)·Δx̄,β + Δ(x_s - x̄)·δx̄,β
            let w = relative_weights(pair);
            let dn = facet_weights(pair, &foot.dn[beta]);
            for (k, (&wk, &dk)) in w.iter().zip(&dn).enumerate() {
                for (l, (&wl, &dl)) in w.iter().zip(&dn).enumerate() {
                    let c = lambda * (wk * dl + dk * wl);
                    if c != 0.0 {
                        for i in 0..pair.dim {
                            out[(k * pair.dim + i) * n + l * pair.dim + i] += c;
                        }
                    }
                }
            }
            for gamma in 0..d {
                let bg = pair_index(beta, gamma);
                let mut left = vec![0.0; n];
                add_facet(pair, &foot.dn[gamma], foot.a[beta], -1.0, &mut left);
                add_relative(pair, foot.aa[bg], 1.0, &mut left);
                add_facet(pair, &foot.dn[beta], foot.a[gamma], -1.0, &mut left);
                add_facet(pair, &foot.ddn[bg], r, 1.0, &mut left);
                add_outer(lambda, &left, &self.xi[gamma], out);
            }
            for alpha in 0..d {
                let ab = pair_index(alpha, beta);
                let mut right = self.base_change(beta, foot.a[alpha]);
                add_scaled_row(1.0, &self.base_change(alpha, foot.a[beta]), &mut right);
                add_relative(pair, foot.aa[ab], -1.0, &mut right);
                for gamma in 0..d {
                    let mut c = dot(foot.aa[ab], foot.a[gamma]);
                    c -= dot(r, third[alpha + beta + gamma]);
                    if c != 0.0 {
                        add_scaled_row(c, &self.xi[gamma], &mut right);
                    }
                }
                add_facet(pair, &foot.ddn[ab], r, -1.0, &mut right);
                add_outer(-lambda, &self.xi[alpha], &right, out);
            }
        }
    }
}

/// `x̄,αβγ` by the number of second directions among its indices: 111, 112, 122, 222.
fn third_derivatives(pair: &Pair) -> [Vec3; 4] {
    let mut out = [[0.0; 3]; 4];
    if pair.kind == crate::shape::ElementKind::Quad8 {
        let mut d = [[0.0; 4]; 8];
        let xi = pair.foot.xi;
        pair.kind
            .reference()
            .third_derivatives([xi[0], xi[1], 0.0], &mut d);
        for (dk, &x) in d.iter().zip(pair.facet) {
            for (o, &c) in out.iter_mut().zip(dk) {
                *o = crate::math::add_scaled(*o, c, x);
            }
        }
    }
    out
}

fn relative_weights(pair: &Pair) -> Vec<f64> {
    let facet = pair.foot.n[..pair.facet.len()].iter().map(|n| -n);
    pair.weights.iter().copied().chain(facet).collect()
}

fn facet_weights(pair: &Pair, weights: &[f64]) -> Vec<f64> {
    let mut all = vec![0.0; pair.weights.len()];
    all.extend_from_slice(&weights[..pair.facet.len()]);
    all
}

/// Adds `s (δx_s - δx̄)·v`.
pub(super) fn add_relative(pair: &Pair, v: Vec3, s: f64, row: &mut [f64]) {
    let facet = pair.foot.n[..pair.facet.len()].iter().map(|n| -n);
    for (k, w) in pair.weights.iter().copied().chain(facet).enumerate() {
        for i in 0..pair.dim {
            row[k * pair.dim + i] += s * w * v[i];
        }
    }
}

/// Adds `s Σ_j c_j δx_j·v` over the nodes of the facet.
pub(super) fn add_facet(pair: &Pair, c: &[f64], v: Vec3, s: f64, row: &mut [f64]) {
    let offset = pair.weights.len() * pair.dim;
    for j in 0..pair.facet.len() {
        for i in 0..pair.dim {
            row[offset + j * pair.dim + i] += s * c[j] * v[i];
        }
    }
}

/// `out += s row`
pub(super) fn add_scaled_row(s: f64, row: &[f64], out: &mut [f64]) {
    for (o, r) in out.iter_mut().zip(row) {
        *o += s * r;
    }
}

/// `out += s a ⊗ b`, row by row.
pub(super) fn add_outer(s: f64, a: &[f64], b: &[f64], out: &mut [f64]) {
    let n = a.len();
    for (i, &ai) in a.iter().enumerate() {
        if ai != 0.0 {
            add_scaled_row(s * ai, b, &mut out[i * n..(i + 1) * n]);
        }
    }
}
