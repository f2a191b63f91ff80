use serde::{Deserialize, Serialize};

use super::facet::{Projection, add_facet, add_relative};
use super::stencil::{Kinematics, Pair, Stencil};
use crate::math::{Mat3, Vec3, add, add_scaled, dot, identity, mat_vec, norm, scale, sub};
use crate::registry::Samples;

/// The tangential gaps of [Pop 1995](stickslip_base::references::pop_1995), eq. (29)-(30), as printed: `g_t = e·t - a_t°|a|`, `g_τ = e·τ - a_τ°|b|`
/// along two edges of the triangle `x_1 x_2 x_3`, with `e = x_s - x_1` and `a°` the values at the last accepted state.
///
/// Kept for comparison with the paper, not for work. Its known defects in 3D (in 2D there are none):
/// - the `a_t, a_τ` are orthogonal projections (covariant), not convective coordinates, although (29) calls them so;
/// - with edges at an angle β ≠ 90° they are used as force components (contravariant): sticking has stiffness `ω(1 ± cos β)` in
///   different directions and friction is not opposite to slip (at β = 60°, slip at 60° meets friction at 41°), though
///   its size is right: the quality figure `friction-law` says so;
/// - it is not objective: a point glued to a facet that shears has a spurious slip of first order.
///
/// Facets must be lines or triangles. No parameters.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Pop1995 {}

/// One edge of the facet: its vector from the first node, length, direction, and the frozen coordinate along it.
struct Edge {
    node: usize,
    length: f64,
    direction: Vec3,
    frozen: f64,
}

impl Edge {
    fn new(pair: &Pair, node: usize) -> Self {
        let a = sub(pair.facet[node], pair.facet[0]);
        let length = norm(a);
        // The first derivatives of a linear facet are half the edge (line) or the edge (triangle).
        let factor = if pair.kind.dim() == 1 { 2.0 } else { 1.0 };
        let before = scale(factor, pair.anchor.a[node - 1]);
        let first = first_node(pair.anchor.x, pair);
        let l = norm(before);
        Edge {
            node,
            length,
            direction: scale(1.0 / length, a),
            frozen: dot(sub(pair.point_before, first), before) / (l * l),
        }
    }

    fn gap(&self, e: Vec3) -> f64 {
        dot(e, self.direction) - self.frozen * self.length
    }

    /// `I - t ⊗ t`
    fn across(&self) -> Mat3 {
        let t = self.direction;
        let mut p = identity();
        for i in 0..3 {
            for j in 0..3 {
                p[i][j] -= t[i] * t[j];
            }
        }
        p
    }

    /// The gradient `(t; -t - w; w at the end of the edge)`, `w = P e/|a| - a° t`.
    fn add_row(&self, pair: &Pair, e: Vec3, row: &mut [f64]) {
        let t = self.direction;
        let w = sub(
            scale(1.0 / self.length, mat_vec(&self.across(), e)),
            scale(self.frozen, t),
        );
        add_secondary(pair, t, row);
        add_node(pair, 0, scale(-1.0, add(t, w)), row);
        add_node(pair, self.node, w, row);
    }

    /// Second derivative: `(BₑᵀPB_a + B_aᵀPBₑ)/|a| - B_aᵀ(t pᵀ + p tᵀ)B_a/|a|² - (e·t + a°|a|)/|a|² B_aᵀPB_a`.
    fn add_hessian(&self, pair: &Pair, e: Vec3, s: f64, out: &mut [f64]) {
        let (l, t) = (self.length, self.direction);
        let across = self.across();
        let p = mat_vec(&across, e);
        let c = (dot(e, t) + self.frozen * l) / (l * l);
        let n = pair.dofs();
        for i in 0..pair.dim {
            for j in 0..pair.dim {
                let mixed = s * across[i][j] / l;
                let edge = -s * ((t[i] * p[j] + p[i] * t[j]) / (l * l) + c * across[i][j]);
                for (k, bk) in edge_weights(pair, self.node) {
                    for (m, bm) in edge_weights(pair, self.node) {
                        out[(k * pair.dim + i) * n + m * pair.dim + j] += edge * bk * bm;
                    }
                    for (m, em) in arm_weights(pair) {
                        out[(k * pair.dim + i) * n + m * pair.dim + j] += mixed * bk * em;
                        out[(m * pair.dim + i) * n + k * pair.dim + j] += mixed * em * bk;
                    }
                }
            }
        }
    }
}

/// The first node of the facet at the last accepted state, from the anchor.
fn first_node(x: Vec3, pair: &Pair) -> Vec3 {
    let anchor = pair.anchor;
    let (xi, d) = (anchor.xi, pair.kind.dim());
    if d == 1 {
        add_scaled(x, -1.0 - xi[0], anchor.a[0])
    } else {
        add_scaled(add_scaled(x, -xi[0], anchor.a[0]), -xi[1], anchor.a[1])
    }
}

/// Weights of `a = x_node - x_1` by node of the stencil.
fn edge_weights(pair: &Pair, node: usize) -> [(usize, f64); 2] {
    let s = pair.weights.len();
    [(s, -1.0), (s + node, 1.0)]
}

/// Weights of `e = x_s - x_1`.
fn arm_weights(pair: &Pair) -> impl Iterator<Item = (usize, f64)> {
    let s = pair.weights.len();
    pair.weights
        .iter()
        .copied()
        .enumerate()
        .chain(std::iter::once((s, -1.0)))
}

fn add_secondary(pair: &Pair, v: Vec3, row: &mut [f64]) {
    for (k, w) in pair.weights.iter().enumerate() {
        for i in 0..pair.dim {
            row[k * pair.dim + i] += w * v[i];
        }
    }
}

fn add_node(pair: &Pair, node: usize, v: Vec3, row: &mut [f64]) {
    let mut c = [0.0; crate::contact::facet_point::FACET_NODES];
    c[node] = 1.0;
    add_facet(pair, &c, v, 1.0, row);
}

/// One edge of a line, two of a triangle.
fn edges(pair: &Pair) -> (Edge, Option<Edge>) {
    let second = (pair.kind.dim() == 2).then(|| Edge::new(pair, 2));
    (Edge::new(pair, 1), second)
}

impl Kinematics for Pop1995 {
    fn triangles(&self) -> bool {
        true
    }

    fn stencil(&self, pair: &Pair, out: &mut Stencil) {
        out.reset(pair.dofs());
        let foot = pair.foot;
        let e = sub(pair.point, pair.facet[0]);
        out.normal = foot.normal;
        out.normal_before = pair.anchor.normal;
        out.gap = dot(sub(pair.point, foot.x), foot.normal);
        add_relative(pair, foot.normal, 1.0, &mut out.rows[0]);
        out.slip = [0.0; 2];
        let (a, b) = edges(pair);
        for (i, edge) in std::iter::once(&a).chain(&b).enumerate() {
            out.slip[i] = edge.gap(e);
            out.frame[i] = edge.direction;
            out.frame_before[i] = scale(1.0 / norm(pair.anchor.a[i]), pair.anchor.a[i]);
            edge.add_row(pair, e, &mut out.rows[i + 1]);
        }
        match &b {
            Some(b) => {
                // ∇cosβ = B_aᵀ(τ - cosβ t)/|a| + B_bᵀ(t - cosβ τ)/|b|
                out.skew = dot(a.direction, b.direction);
                out.skew_row.resize(pair.dofs(), 0.0);
                for (edge, other) in [(&a, b), (b, &a)] {
                    let v = scale(
                        1.0 / edge.length,
                        add_scaled(other.direction, -out.skew, edge.direction),
                    );
                    add_node(pair, edge.node, v, &mut out.skew_row);
                    add_node(pair, 0, scale(-1.0, v), &mut out.skew_row);
                }
            }
            None => {
                out.frame[1] = [0.0, 0.0, 1.0];
                out.frame_before[1] = out.frame[1];
            }
        }
    }

    fn add_hessian(&self, pair: &Pair, weights: [f64; 3], out: &mut [f64]) {
        let e = sub(pair.point, pair.facet[0]);
        let (a, b) = edges(pair);
        for (i, edge) in std::iter::once(&a).chain(&b).enumerate() {
            edge.add_hessian(pair, e, weights[i + 1], out);
        }
        // k_n = -Σ (T^α N_αᵀ + N_α T^αᵀ) - g Σ m^αβ N_α N_βᵀ, the same for every kinematics
        Projection::new(pair).add_hessian(weights[0], out);
    }
}

impl Samples for Pop1995 {
    fn samples() -> Vec<Self> {
        vec![Pop1995 {}]
    }
}
