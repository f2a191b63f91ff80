use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::facet::{Projection, add_relative, add_scaled_row};
use super::{Kinematics, Pair, Stencil};
use crate::contact::pairing::FacetPoint;
use crate::math::{Vec3, cross, dot, norm, scale};
use crate::registry::Samples;

/// Large sliding in convective coordinates, the default: slip is the change of the projection's coordinates on the facet,
/// measured in an orthonormal frame of the last accepted state ([Laursen 2002](crate::references::laursen_2002),
/// [Wriggers 2006](crate::references::wriggers_2006)).
///
/// Slip is objective: a point that rides on a straining or rotating facet has none. Force and moment of a contact element add up
/// to zero. Works on lines, triangles and quadrilaterals, linear or quadratic. No parameters.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Convective {}

/// Orthonormal directions in a facet and the components of its base vectors along them.
pub(super) fn orthonormal(at: &FacetPoint) -> ([Vec3; 2], [[f64; 2]; 2]) {
    let e1 = scale(1.0 / norm(at.a[0]), at.a[0]);
    let e2 = cross(at.normal, e1);
    let frame = [e1, e2];
    let jacobian = frame.map(|e| [dot(e, at.a[0]), dot(e, at.a[1])]);
    (frame, jacobian)
}

impl Kinematics for Convective {
    fn stencil(&self, pair: &Pair, out: &mut Stencil) {
        let projection = Projection::new(pair);
        let d = pair.kind.dim();
        out.reset(pair.dofs());
        out.gap = projection.gap;
        out.normal = pair.foot.normal;
        add_relative(pair, pair.foot.normal, 1.0, &mut out.rows[0]);
        let (before, jacobian) = orthonormal(pair.anchor);
        out.frame_before = before;
        let moved = [
            pair.foot.xi[0] - pair.anchor.xi[0],
            if d == 2 {
                pair.foot.xi[1] - pair.anchor.xi[1]
            } else {
                0.0
            },
        ];
        // ∂ξ^α/∂x_s, the directions in which covariant tractions act
        let dual: [Vec3; 2] = std::array::from_fn(|alpha| {
            let a = &pair.foot.a;
            let i = &projection.inverse[alpha];
            std::array::from_fn(|c| i[0] * a[0][c] + if d == 2 { i[1] * a[1][c] } else { 0.0 })
        });
        for (i, row) in jacobian.iter().enumerate() {
            out.slip[i] = row[0] * moved[0] + row[1] * moved[1];
            out.frame[i] = [0.0; 3];
            for alpha in 0..d {
                add_scaled_row(row[alpha], &projection.xi[alpha], &mut out.rows[i + 1]);
                out.frame[i] = crate::math::add_scaled(out.frame[i], row[alpha], dual[alpha]);
            }
        }
    }

    fn add_hessian(&self, pair: &Pair, _stencil: &Stencil, weights: [f64; 3], out: &mut [f64]) {
        let (_, jacobian) = orthonormal(pair.anchor);
        let covariant =
            [0, 1].map(|alpha| jacobian[0][alpha] * weights[1] + jacobian[1][alpha] * weights[2]);
        Projection::new(pair).add_hessian(weights[0], covariant, out);
    }
}

impl Samples for Convective {
    fn samples() -> Vec<Self> {
        vec![Convective {}]
    }
}
