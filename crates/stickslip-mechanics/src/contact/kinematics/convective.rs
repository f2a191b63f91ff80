use serde::{Deserialize, Serialize};

use super::facet::{MOST_DOFS, Projection, add_relative, add_scaled_row};
use super::frame::{MovingFrame, TangentFrame};
use super::stencil::{Kinematics, Pair, Stencil};
use crate::registry::Samples;

/// Large sliding in convective coordinates, the default: slip is the change of the projection's coordinates on the facet, measured in
/// orthonormal frames that go with it ([Laursen 2002](stickslip_base::references::laursen_2002),
/// [Wriggers 2006](stickslip_base::references::wriggers_2006)). Shear acts in the tangent plane where the point is.
///
/// Slip is objective: a point that rides on a straining or rotating facet has none. Force and moment of a contact element add up
/// to zero. Works on lines, triangles and quadrilaterals, linear or quadratic. No parameters.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Convective {}

impl Kinematics for Convective {
    fn stencil(&self, pair: &Pair, out: &mut Stencil) {
        let projection = Projection::new(pair);
        let d = pair.kind.dim();
        let n = pair.dofs();
        out.reset(n);
        out.gap = projection.gap;
        out.normal = pair.foot.normal;
        out.normal_before = pair.anchor.normal;
        add_relative(pair, pair.foot.normal, 1.0, &mut out.rows[0]);
        let before = TangentFrame::new(pair.anchor, d);
        let frame = TangentFrame::new(pair.foot, d);
        out.frame_before = before.directions;
        out.frame = frame.directions;
        out.slip = [0.0; 2];
        let moving = MovingFrame::new(&frame, &projection);
        for i in 0..d {
            let mut weights = [0.0; 2];
            weights[i] = 1.0;
            moving.add_row(weights, &mut out.rows[i + 1]);
            // s_i = J_iα Δξ^α with the mean of J at both ends: the length of the way in a frame that goes with it
            let mut row = [0.0; MOST_DOFS];
            for alpha in 0..d {
                let moved = pair.foot.xi[alpha] - pair.anchor.xi[alpha];
                let mean = 0.5 * (before.jacobian[i][alpha] + frame.jacobian[i][alpha]);
                out.slip[i] += mean * moved;
                add_scaled_row(mean, &projection.xi[alpha], &mut row);
                moving.add_jacobian(i, alpha, 0.5 * moved, &mut row);
            }
            if pair.belt != [0.0; 3] {
                moving.add_direction(i, pair.belt, -1.0, &mut row);
            }
            out.slip_rows[i].extend_from_slice(&row[..n]);
        }
        if d == 1 {
            out.slip_rows[1].resize(n, 0.0);
        }
    }

    fn add_hessian(&self, pair: &Pair, weights: [f64; 3], out: &mut [f64]) {
        let projection = Projection::new(pair);
        projection.add_hessian(weights[0], out);
        if weights[1] != 0.0 || weights[2] != 0.0 {
            let frame = TangentFrame::new(pair.foot, pair.kind.dim());
            MovingFrame::new(&frame, &projection).add_hessian([weights[1], weights[2]], out);
        }
    }
}

impl Samples for Convective {
    fn samples() -> Vec<Self> {
        vec![Convective {}]
    }
}
