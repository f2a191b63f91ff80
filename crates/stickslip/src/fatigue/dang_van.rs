use serde::{Deserialize, Serialize};

use super::circle::smallest_circle;
use super::criterion::{Criterion, OnPlane, factor};
use crate::registry::Samples;

/// [Dang Van 1993](crate::references::dang_van_1993) by planes: the largest `τ(t) + a p_h(t)` of all planes and times `[Pa]`. The microscopic shear `τ(t)` is counted from the middle of the smallest circle around the path of the
/// shear in the plane, where grains that adapt leave it; `p_h` is a third of the trace of the stress, positive in tension.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct DangVan {
    /// How much the hydrostatic stress counts `[-]`; from the limits of torsion `t` and of bending `f`, both alternating: `3 (t/f - 1/2)`.
    pub a: f64,
}

impl Criterion for DangVan {
    fn name(&self) -> &'static str {
        "DANGVAN"
    }

    fn on_plane(&self, at: &OnPlane) -> Option<f64> {
        let (middle, _) = smallest_circle(&at.shear);
        let values = at.shear.iter().zip(&at.hydrostatic);
        let values = values.map(|(t, p)| (t[0] - middle[0]).hypot(t[1] - middle[1]) + self.a * p);
        Some(values.fold(f64::NEG_INFINITY, f64::max))
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        factor("a", self.a)
    }
}

impl Samples for DangVan {
    fn samples() -> Vec<Self> {
        vec![DangVan { a: 0.3 }]
    }
}
