//! Two unit vectors in the tangent plane of a facet, and how they change when the facet does.

use super::facet::{MOST_DOFS, Projection, Row, add_facet, add_relative, add_scaled_row};
use crate::contact::facet_point::{FACET_NODES, FacetPoint, pair_index};
use crate::math::{Vec3, add_scaled, cross, dot, norm, scale};

/// Orthonormal directions in a facet: `e_1` along `a_1`, `e_2 = n × e_1`.
pub(super) struct TangentFrame {
    pub directions: [Vec3; 2],
    /// `J_iα = e_i·a_α`, the components of the base vectors.
    pub jacobian: [[f64; 2]; 2],
    /// `b_i^β` with `e_i = b_i^β a_β`.
    inverse: [[f64; 2]; 2],
}

impl TangentFrame {
    /// The frame at a place of a facet of dimension `d`; on lines the second direction points out of the plane.
    pub fn new(at: &FacetPoint, d: usize) -> Self {
        let length = norm(at.a[0]);
        let e1 = scale(1.0 / length, at.a[0]);
        let e2 = cross(at.normal, e1);
        let (along, height) = match d {
            1 => (0.0, 1.0),
            _ => (dot(e1, at.a[1]), dot(e2, at.a[1])),
        };
        TangentFrame {
            directions: [e1, e2],
            jacobian: [[length, along], [0.0, height]],
            inverse: [
                [1.0 / length, 0.0],
                [-along / (length * height), 1.0 / height],
            ],
        }
    }
}

/// A frame at the foot of a point, with what its derivatives are made of.
pub(super) struct MovingFrame<'a> {
    frame: &'a TangentFrame,
    at: &'a Projection<'a>,
    /// `e_2·δe_1`: how the frame spins about the normal.
    spin: Row,
    /// `n·δa_α`
    bending: [Row; 2],
}

/// Most products of rows in the derivative of a row.
const PRODUCTS_OF_A_ROW: usize = 9;

/// A sum of products of rows, which is added in one pass over the matrix.
struct Products {
    left: [Row; PRODUCTS_OF_A_ROW],
    right: [Row; PRODUCTS_OF_A_ROW],
    count: usize,
}

impl Default for Products {
    fn default() -> Self {
        let none = [[0.0; MOST_DOFS]; PRODUCTS_OF_A_ROW];
        Products {
            left: none,
            right: none,
            count: 0,
        }
    }
}

impl Products {
    fn push(&mut self, left: &Row, right: &Row) {
        self.left[self.count] = *left;
        self.right[self.count] = *right;
        self.count += 1;
    }

    /// `out += Σ left rightᵀ`, of `n` rows.
    fn add_to(&self, out: &mut [f64], n: usize) {
        for (i, row) in out.chunks_exact_mut(n).enumerate() {
            let left: [f64; PRODUCTS_OF_A_ROW] = std::array::from_fn(|k| self.left[k][i]);
            for (j, out) in row.iter_mut().enumerate() {
                *out += (left.iter().zip(&self.right)).fold(0.0, |s, (l, right)| s + l * right[j]);
            }
        }
    }
}

impl<'a> MovingFrame<'a> {
    pub fn new(frame: &'a TangentFrame, at: &'a Projection<'a>) -> Self {
        let mut spin = [0.0; MOST_DOFS];
        let length = frame.jacobian[0][0];
        at.add_base(0, frame.directions[1], 1.0 / length, &mut spin);
        MovingFrame {
            frame,
            at,
            spin,
            bending: at.bending(),
        }
    }

    fn dim(&self) -> usize {
        self.at.pair.kind.dim()
    }

    /// Adds `s E·δn` for a tangent vector `E = B^β a_β`: `δn = -a^α (n·δa_α)`.
    fn add_tilt(&self, b: [f64; 2], s: f64, row: &mut Row) {
        for (b, bending) in b.iter().zip(&self.bending).take(self.dim()) {
            add_scaled_row(-s * b, bending, row);
        }
    }

    /// Adds `s v·δe_i`: `δe_1 = spin e_2 - (e_1·δn) n`, `δe_2 = -spin e_1 - (e_2·δn) n`.
    pub fn add_direction(&self, i: usize, v: Vec3, s: f64, row: &mut Row) {
        let [e1, e2] = self.frame.directions;
        let spin = if i == 0 { dot(v, e2) } else { -dot(v, e1) };
        add_scaled_row(s * spin, &self.spin, row);
        let normal = dot(v, self.at.pair.foot.normal);
        self.add_tilt(self.frame.inverse[i], -s * normal, row);
    }

    /// Adds `s δJ_iα`.
    pub fn add_jacobian(&self, i: usize, alpha: usize, s: f64, row: &mut Row) {
        let [e1, e2] = self.frame.directions;
        let [[_, along], [_, height]] = self.frame.jacobian;
        match (i, alpha) {
            (0, 0) => self.at.add_base(0, e1, s, row),
            (0, _) => {
                self.at.add_base(1, e1, s, row);
                add_scaled_row(s * height, &self.spin, row);
            }
            (_, 0) => {}
            _ => {
                self.at.add_base(1, e2, s, row);
                add_scaled_row(-s * along, &self.spin, row);
            }
        }
    }

    /// The change of `B^β = Σ w_i b_i^β`.
    fn coefficients(&self, weights: [f64; 2]) -> [Row; 2] {
        let mut out = [[0.0; MOST_DOFS]; 2];
        let [[length, along], [_, height]] = self.frame.jacobian;
        self.add_jacobian(0, 0, -weights[0] / (length * length), &mut out[0]);
        if self.dim() == 2 {
            let w = weights[1];
            self.add_jacobian(1, 1, -w / (height * height), &mut out[1]);
            self.add_jacobian(0, 1, -w / (length * height), &mut out[0]);
            let s = w * along / (length * height);
            self.add_jacobian(0, 0, s / length, &mut out[0]);
            self.add_jacobian(1, 1, s / height, &mut out[0]);
        }
        out
    }

    /// The row of a shear along `Σ w_i e_i`: `(δx_s - δx̄)·e + g n·δx̄,β b^β`. The second part is the moment of a force that acts at a distance from
    /// the facet.
    pub fn add_row(&self, weights: [f64; 2], row: &mut [f64]) {
        let (e, b) = self.combined(weights);
        let pair = self.at.pair;
        add_relative(pair, e, 1.0, row);
        let along = self.derivatives(b);
        add_facet(pair, &along, pair.foot.normal, self.at.gap, row);
    }

    /// `E = Σ w_i e_i` and its contravariant components.
    fn combined(&self, weights: [f64; 2]) -> (Vec3, [f64; 2]) {
        let [e1, e2] = self.frame.directions;
        let b = &self.frame.inverse;
        let d = self.dim();
        let w2 = if d == 2 { weights[1] } else { 0.0 };
        (
            add_scaled(scale(weights[0], e1), w2, e2),
            std::array::from_fn(|beta| weights[0] * b[0][beta] + w2 * b[1][beta]),
        )
    }

    /// `Σ_β b^β N,β`
    fn derivatives(&self, b: [f64; 2]) -> [f64; FACET_NODES] {
        let mut out = [0.0; FACET_NODES];
        for (beta, b) in b.iter().enumerate().take(self.dim()) {
            add_scaled_row(*b, &self.at.pair.foot.dn[beta], &mut out);
        }
        out
    }

    /// Adds the derivative of [`add_row`](Self::add_row). With `E = B^β a_β` the change of `(δx_s - δx̄)·E + g n·B^β δx̄,β` is a sum of products:
    ///
    /// `(δx_s - δx̄)·ΔE - E·δx̄,γ Δξ^γ + Δg n·B^β δx̄,β + g Δn·B^β δx̄,β + g n·(ΔB^β δx̄,β + B^β δx̄,βγ Δξ^γ)`.
    pub fn add_hessian(&self, weights: [f64; 2], out: &mut [f64]) {
        let pair = self.at.pair;
        let (foot, gap, d) = (pair.foot, self.at.gap, self.dim());
        let n = pair.dofs();
        let (e, b) = self.combined(weights);
        let along = self.derivatives(b);
        let [e1, e2] = self.frame.directions;
        let mut products = Products::default();
        let mut add = |left: &Row, right: &Row| products.push(left, right);
        let row = |f: &dyn Fn(&mut Row)| -> Row {
            let mut row = [0.0; MOST_DOFS];
            f(&mut row);
            row
        };
        if d == 2 {
            let across = add_scaled(scale(weights[0], e2), -weights[1], e1);
            add(&row(&|r| add_relative(pair, across, 1.0, r)), &self.spin);
        }
        let normal = row(&|r| add_relative(pair, foot.normal, 1.0, r));
        add(&normal, &row(&|r| self.add_tilt(b, -1.0, r)));
        let lever = row(&|r| add_facet(pair, &along, foot.normal, 1.0, r));
        add(&lever, &normal);
        let change = self.coefficients(weights);
        for alpha in 0..d {
            // a^α = Σ_i e_i b_i^α
            let dual = (self.frame.inverse.iter().zip([e1, e2]))
                .take(d)
                .fold([0.0; 3], |s, (b, e)| add_scaled(s, b[alpha], e));
            let tilted = row(&|r| add_facet(pair, &along, dual, -gap, r));
            add(&tilted, &self.bending[alpha]);
            let turned = row(&|r| add_facet(pair, &foot.dn[alpha], foot.normal, gap, r));
            add(&turned, &change[alpha]);
            let moved = row(&|r| {
                add_facet(pair, &foot.dn[alpha], e, -1.0, r);
                for (beta, b) in b.iter().enumerate().take(d) {
                    let bent = &foot.ddn[pair_index(beta, alpha)];
                    add_facet(pair, bent, foot.normal, gap * b, r);
                }
            });
            add(&moved, &self.at.xi[alpha]);
        }
        products.add_to(out, n);
    }
}
