use serde::{Deserialize, Serialize};

use super::facet::add_relative;
use super::frame::TangentFrame;
use super::stencil::{Kinematics, Pair, Stencil};
use crate::math::{dot, sub};
use crate::registry::Samples;

/// Small sliding: every point keeps the facet, the weights and the normal it has in the reference configuration. Gap and slip
/// are linear in the displacements. For joints that slip by a small part of an element; cheap, and free of geometric
/// effects. No parameters.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SmallSliding {}

impl Kinematics for SmallSliding {
    fn frozen(&self) -> bool {
        true
    }

    /// The pair comes with the reference projection as `foot` and `anchor`, while `point` and `point_before` are the position
    /// relative to that foot's material place: `x_s - Σ N_j x_j` now and at the last accepted state, added to the foot.
    fn stencil(&self, pair: &Pair, out: &mut Stencil) {
        out.reset(pair.dofs());
        let foot = pair.foot;
        let frame = TangentFrame::new(foot, pair.kind.dim()).directions;
        out.frame = frame;
        out.frame_before = frame;
        out.normal = foot.normal;
        out.normal_before = foot.normal;
        out.gap = dot(sub(pair.point, foot.x), foot.normal);
        let moved = sub(pair.point, pair.point_before);
        add_relative(pair, foot.normal, 1.0, &mut out.rows[0]);
        for (i, &direction) in frame.iter().enumerate().take(pair.kind.dim()) {
            out.slip[i] = dot(moved, direction);
            add_relative(pair, direction, 1.0, &mut out.rows[i + 1]);
        }
        if pair.kind.dim() == 1 {
            out.slip[1] = 0.0;
        }
    }

    fn add_hessian(&self, _: &Pair, _: [f64; 3], _: &mut [f64]) {}
}

impl Samples for SmallSliding {
    fn samples() -> Vec<Self> {
        vec![SmallSliding {}]
    }
}
