use serde::{Deserialize, Serialize};

use super::rule::{SlipRule, SlipState, Tangential};
use crate::registry::Samples;

/// Stick until the limit, then slide: the trial traction `base - ω_T slip` is returned radially to the limit
/// ([Simo and Laursen 1992](stickslip_base::references::simo_laursen_1992)), or to the point of an ellipse that its slip direction asks for. There is no creep; what gives in stick is only the
/// stiffness of the enforcement, which the augmented Lagrangian removes. No parameters.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ReturnMapping {}

impl SlipRule for ReturnMapping {
    fn traction(&self, limit: f64, motion: &Tangential) -> SlipState {
        let w = motion.stiffness;
        let trial = [
            motion.base[0] - w * motion.slip[0],
            motion.base[1] - w * motion.slip[1],
        ];
        let cone = motion.cone(limit);
        if cone.size(trial) <= limit * (1.0 + motion.slack) {
            return SlipState {
                traction: trial,
                d_slip: [[-w, 0.0], [0.0, -w]],
                ..SlipState::default()
            };
        }
        let slips = cone.returned(trial, -w);
        SlipState {
            traction: slips.shear,
            d_slip: slips.d_motion,
            d_limit: slips.d_limit,
            d_skew: slips.d_skew,
            sliding: true,
            sliding_path: [0, 1].map(|i| motion.slip[i] + (slips.shear[i] - motion.base[i]) / w),
        }
    }

    fn stuck(&self, _limit: f64, motion: &Tangential) -> SlipState {
        self.traction(f64::INFINITY, motion)
    }

    fn sticks(&self) -> bool {
        true
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        Vec::new()
    }
}

impl Samples for ReturnMapping {
    fn samples() -> Vec<Self> {
        vec![ReturnMapping {}]
    }
}
