//! What the kinematics share: the derivatives of a projection on a facet.
//!
//! Notation: `x_s` the secondary point, `x̄(ξ) = Σ N_j x_j` the facet, `a_α = x̄,α`, `r = x_s - x̄ = g n`. Differentiating
//! `r·a_β = 0` gives `A_βα δξ^α = (δx_s - δx̄)·a_β + g n·δx̄,β` with `A_βα = a_β·a_α - g n·x̄,αβ`.

use super::Pair;
use crate::contact::pairing::{FACET_NODES, invert2, pair_index, projection_matrix};
use crate::math::{Vec3, add_scaled, dot, scale, sub};

/// Most dofs of a stencil on a facet: a point on a face of eight nodes and a facet of eight.
pub(super) const MOST_DOFS: usize = 3 * (8 + FACET_NODES);

/// One number by dof of a stencil, of which the first are used.
pub(super) type Row = [f64; MOST_DOFS];

/// Derivatives of one projection.
pub(super) struct Projection<'a> {
    pub pair: &'a Pair<'a>,
    pub gap: f64,
    /// Inverse of `A_βα`.
    pub inverse: [[f64; 2]; 2],
    /// Gradients of the convective coordinates.
    pub xi: [Row; 2],
}

impl<'a> Projection<'a> {
    /// # Panics
    ///
    /// If the point hangs on more than eight nodes.
    pub fn new(pair: &'a Pair<'a>) -> Self {
        let foot = pair.foot;
        let d = pair.kind.dim();
        let gap = dot(sub(pair.point, foot.x), foot.normal);
        let matrix = projection_matrix(foot, scale(gap, foot.normal));
        // A point that was projected has an invertible matrix; on a caustic of a curved facet the metric stands in.
        let inverse = invert2(&matrix)
            .or_else(|| invert2(&projection_matrix(foot, [0.0; 3])))
            .unwrap_or([[0.0; 2]; 2]);
        let mut xi = [[0.0; MOST_DOFS]; 2];
        for (row, inverse) in xi.iter_mut().zip(&inverse).take(d) {
            let mut direction = [0.0; 3];
            let mut along = [0.0; FACET_NODES];
            for (beta, inverse) in inverse.iter().enumerate().take(d) {
                direction = add_scaled(direction, *inverse, foot.a[beta]);
                add_scaled_row(gap * inverse, &foot.dn[beta], &mut along);
            }
            add_relative(pair, direction, 1.0, row);
            add_facet(pair, &along, foot.normal, 1.0, row);
        }
        Projection {
            pair,
            gap,
            inverse,
            xi,
        }
    }

    /// Adds `w k_n + Σ_α t_α ∂²ξ^α`: the second derivatives of the gap and of the convective coordinates, weighted.
    ///
    /// Those of the coordinates follow from differentiating the first variation once more along a second direction Δ:
    /// `A_βα Δδξ^α = -δx̄,γ·a_β Δξ^γ + (δx_s - δx̄)·Δa_β + Δr·δx̄,β + r·δx̄,βγ Δξ^γ - ΔA_βα δξ^α`. With `λ_β = Σ_α A⁻¹_αβ t_α` the sum
    /// over both is
    ///
    /// `Σ_α (l_α δξ^αᵀ + δξ^α l_αᵀ) - Σ_αγ f_αγ δξ^α δξ^γᵀ + w g Σ_αβ m^αβ c_α c_βᵀ` and `w δ` terms that couple equal components,
    ///
    /// `l_α = Σ_β λ_β ((δx_s - δx̄)·a_αβ - δx̄,α·a_β - δx̄,β·a_α + r·δx̄,αβ) - w n·δx̄,α`, `c_α = n·(δx̄,α + a_αβ δξ^β)`,
    /// `f_αγ = w n·a_αγ + Σ_β λ_β (a_βγ·a_α + a_αγ·a_β + a_αβ·a_γ - r·a_αβγ)`.
    pub fn add_hessian(&self, w: f64, t: [f64; 2], out: &mut [f64]) {
        let pair = self.pair;
        let foot = pair.foot;
        let (n, d) = (pair.dofs(), pair.kind.dim());
        let normal = foot.normal;
        let r = scale(self.gap, normal);
        let lambda: [f64; 2] = std::array::from_fn(|beta| {
            (0..d)
                .map(|alpha| self.inverse[alpha][beta] * t[alpha])
                .sum()
        });
        let sliding = lambda != [0.0; 2];
        // Σ_β λ_β a_β and Σ_β λ_β N,β
        let mut a = [0.0; 3];
        let mut dn = [0.0; FACET_NODES];
        for (beta, lambda) in lambda.iter().enumerate().take(d) {
            a = add_scaled(a, *lambda, foot.a[beta]);
            add_scaled_row(*lambda, &foot.dn[beta], &mut dn);
        }
        // Σ_β λ_β a_βα
        let bent: [Vec3; 2] = std::array::from_fn(|alpha| {
            (0..d).fold([0.0; 3], |sum, beta| {
                add_scaled(sum, lambda[beta], foot.aa[pair_index(alpha, beta)])
            })
        });
        let third = if sliding {
            third_derivatives(pair)
        } else {
            [[0.0; 3]; 4]
        };
        let mut left = [[0.0; MOST_DOFS]; 2];
        for alpha in 0..d {
            let row = &mut left[alpha];
            // what goes with the normal: r·δx̄,αβ and - w n·δx̄,α
            let mut along = [0.0; FACET_NODES];
            add_scaled_row(-w, &foot.dn[alpha], &mut along);
            if sliding {
                for (beta, lambda) in lambda.iter().enumerate().take(d) {
                    let ddn = &foot.ddn[pair_index(alpha, beta)];
                    add_scaled_row(lambda * self.gap, ddn, &mut along);
                }
                add_facet(pair, &foot.dn[alpha], a, -1.0, row);
                add_facet(pair, &dn, foot.a[alpha], -1.0, row);
                if bent[alpha] != [0.0; 3] {
                    add_relative(pair, bent[alpha], 1.0, row);
                }
            }
            add_facet(pair, &along, normal, 1.0, row);
            for gamma in 0..d {
                let aa = foot.aa[pair_index(alpha, gamma)];
                let mut f = w * dot(normal, aa);
                f += dot(bent[gamma], foot.a[alpha]) + dot(aa, a) + dot(bent[alpha], foot.a[gamma]);
                for (beta, lambda) in lambda.iter().enumerate().take(d) {
                    f -= lambda * dot(r, third[alpha + beta + gamma]);
                }
                if f != 0.0 {
                    add_scaled_row(-0.5 * f, &self.xi[gamma][..n], row);
                }
            }
        }
        let mut change = [[0.0; MOST_DOFS]; 2];
        let mut raised = [[0.0; MOST_DOFS]; 2];
        let dual = invert2(&projection_matrix(foot, [0.0; 3]));
        if let (Some(dual), true) = (dual, w * self.gap != 0.0) {
            for (alpha, row) in change.iter_mut().enumerate().take(d) {
                add_facet(pair, &foot.dn[alpha], normal, 1.0, row);
                for gamma in 0..d {
                    let c = dot(foot.aa[pair_index(alpha, gamma)], normal);
                    if c != 0.0 {
                        add_scaled_row(c, &self.xi[gamma][..n], row);
                    }
                }
            }
            for alpha in 0..d {
                for beta in 0..d {
                    let g = w * self.gap * dual[alpha][beta];
                    add_scaled_row(g, &change[beta][..n], &mut raised[alpha]);
                }
            }
        }
        let [l0, l1] = [&left[0][..n], &left[1][..n]];
        let [x0, x1] = [&self.xi[0][..n], &self.xi[1][..n]];
        let [c0, c1] = [&change[0][..n], &change[1][..n]];
        let [r0, r1] = [&raised[0][..n], &raised[1][..n]];
        for (i, row) in out.chunks_exact_mut(n).enumerate() {
            let (li, xi, ci) = ([l0[i], l1[i]], [x0[i], x1[i]], [c0[i], c1[i]]);
            for j in 0..n {
                row[j] += (li[0] * x0[j] + xi[0] * l0[j])
                    + (li[1] * x1[j] + xi[1] * l1[j])
                    + (ci[0] * r0[j] + ci[1] * r1[j]);
            }
        }
        if sliding {
            // (δx_s - δx̄)·Δx̄,β + Δ(x_s - x̄)·δx̄,β
            let node = |k: usize| match k.checked_sub(pair.weights.len()) {
                None => (pair.weights[k], 0.0),
                Some(j) => (-foot.n[j], dn[j]),
            };
            let nodes = pair.weights.len() + pair.facet.len();
            for k in 0..nodes {
                let (wk, dk) = node(k);
                for l in 0..nodes {
                    let (wl, dl) = node(l);
                    let c = wk * dl + dk * wl;
                    for i in 0..pair.dim {
                        out[(k * pair.dim + i) * n + l * pair.dim + i] += c;
                    }
                }
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
                *o = add_scaled(*o, c, x);
            }
        }
    }
    out
}

/// Adds `s (δx_s - δx̄)·v`.
pub(super) fn add_relative(pair: &Pair, v: Vec3, s: f64, row: &mut [f64]) {
    let facet = pair.foot.n[..pair.facet.len()].iter().map(|n| -n);
    let weights = pair.weights.iter().copied().chain(facet);
    for (row, w) in row.chunks_exact_mut(pair.dim).zip(weights) {
        for (r, v) in row.iter_mut().zip(v) {
            *r += s * w * v;
        }
    }
}

/// Adds `s Σ_j c_j δx_j·v` over the nodes of the facet.
pub(super) fn add_facet(pair: &Pair, c: &[f64], v: Vec3, s: f64, row: &mut [f64]) {
    let offset = pair.weights.len() * pair.dim;
    let weights = c.iter().take(pair.facet.len());
    for (row, c) in row[offset..].chunks_exact_mut(pair.dim).zip(weights) {
        for (r, v) in row.iter_mut().zip(v) {
            *r += s * c * v;
        }
    }
}

/// `out += s row`
pub(super) fn add_scaled_row(s: f64, row: &[f64], out: &mut [f64]) {
    for (o, r) in out.iter_mut().zip(row) {
        *o += s * r;
    }
}
