//! What the kinematics share: the derivatives of a projection on a facet.
//!
//! Notation: `x_s` the secondary point, `x̄(ξ) = Σ N_j x_j` the facet, `a_α = x̄,α`, `r = x_s - x̄ = g n`. Differentiating
//! `r·a_β = 0` gives `A_βα δξ^α = (δx_s - δx̄)·a_β + g n·δx̄,β` with `A_βα = a_β·a_α - g n·x̄,αβ`.

use super::stencil::Pair;
use crate::contact::facet_point::{FACET_NODES, pair_index, projection_matrix};
use crate::contact::projection::invert2;
use crate::math::{Vec3, add_scaled, dot, scale, sub};

/// Most dofs of a stencil on a facet: a point on a face of eight nodes and a facet of eight.
pub(super) const MOST_DOFS: usize = 3 * (8 + FACET_NODES);

/// One number by dof of a stencil, of which the first are used.
pub(super) type Row = [f64; MOST_DOFS];

/// Derivatives of one projection.
pub(super) struct Projection<'a> {
    pub pair: &'a Pair<'a>,
    pub gap: f64,
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
        Projection { pair, gap, xi }
    }

    /// Gradient of the components `n·δa_α` along the normal by which base vectors change where the projection goes.
    pub fn bending(&self) -> [Row; 2] {
        let foot = self.pair.foot;
        std::array::from_fn(|alpha| {
            let mut row = [0.0; MOST_DOFS];
            if alpha < self.pair.kind.dim() {
                self.add_base(alpha, foot.normal, 1.0, &mut row);
            }
            row
        })
    }

    /// Adds `s v·δa_α`: how a base vector changes along `v` where the projection goes, `δa_α = δx̄,α + a_αγ δξ^γ`.
    pub fn add_base(&self, alpha: usize, v: Vec3, s: f64, row: &mut Row) {
        let (pair, foot) = (self.pair, self.pair.foot);
        add_facet(pair, &foot.dn[alpha], v, s, row);
        for gamma in 0..pair.kind.dim() {
            let c = dot(foot.aa[pair_index(alpha, gamma)], v);
            if c != 0.0 {
                add_scaled_row(s * c, &self.xi[gamma], row);
            }
        }
    }

    /// Adds `w k_n`, the second derivatives of the gap:
    ///
    /// `-w Σ_α (n·δx̄,α δξ^αᵀ + δξ^α n·δx̄,αᵀ) - w Σ_αγ n·a_αγ δξ^α δξ^γᵀ + w g Σ_αβ m^αβ c_α c_βᵀ`, `c_α = n·(δx̄,α + a_αβ δξ^β)`.
    pub fn add_hessian(&self, w: f64, out: &mut [f64]) {
        let pair = self.pair;
        let foot = pair.foot;
        let (n, d) = (pair.dofs(), pair.kind.dim());
        let normal = foot.normal;
        let mut left = [[0.0; MOST_DOFS]; 2];
        for (alpha, row) in left.iter_mut().enumerate().take(d) {
            add_facet(pair, &foot.dn[alpha], normal, -w, row);
            for gamma in 0..d {
                let f = w * dot(normal, foot.aa[pair_index(alpha, gamma)]);
                if f != 0.0 {
                    add_scaled_row(-0.5 * f, &self.xi[gamma][..n], row);
                }
            }
        }
        let mut change = [[0.0; MOST_DOFS]; 2];
        let mut raised = [[0.0; MOST_DOFS]; 2];
        let dual = invert2(&projection_matrix(foot, [0.0; 3]));
        if let (Some(dual), true) = (dual, w * self.gap != 0.0) {
            change = self.bending();
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
    }
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
