use serde::{Deserialize, Serialize};

use super::rule::{SlipRule, SlipState, Tangential};
use crate::registry::Samples;

/// Stick until the limit, then slide: the trial traction `base - ω_T slip` is returned radially to the limit
/// ([Simo and Laursen 1992](stickslip_base::references::simo_laursen_1992)). There is no creep; what gives in stick is only the
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
        let size = motion.length(trial);
        if size <= limit * (1.0 + motion.slack) {
            return SlipState {
                traction: trial,
                d_slip: [[-w, 0.0], [0.0, -w]],
                ..SlipState::default()
            };
        }
        // t = limit m with m = trial / |trial|
        let m = [trial[0] / size, trial[1] / size];
        let slope = motion.length_slope(trial, size);
        let traction = [limit * m[0], limit * m[1]];
        let mut d_slip = [[0.0; 2]; 2];
        for i in 0..2 {
            for j in 0..2 {
                let unit = if i == j { 1.0 } else { 0.0 };
                d_slip[i][j] = -w * limit / size * (unit - m[i] * slope[j]);
            }
        }
        // d|trial|/dskew = trial₁ trial₂ / |trial|
        let d_size = trial[0] * trial[1] / size;
        SlipState {
            traction,
            d_slip,
            d_limit: m,
            d_skew: [-traction[0] * d_size / size, -traction[1] * d_size / size],
            sliding: true,
            sliding_path: [
                motion.slip[0] + (traction[0] - motion.base[0]) / w,
                motion.slip[1] + (traction[1] - motion.base[1]) / w,
            ],
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
