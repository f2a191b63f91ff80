use serde::{Deserialize, Serialize};

use super::method::{Alphas, Method, Scheme};
use crate::registry::Samples;

/// The method of Hilber, Hughes and Taylor ([`hht_1977`](crate::references::hht_1977)): second order, damps high frequencies.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Hht {
    /// α `[-]`, between -1/3 (most damping) and 0 (the trapezoidal rule). Default: -0.05.
    pub alpha: f64,
}

impl Default for Hht {
    fn default() -> Self {
        Hht { alpha: -0.05 }
    }
}

impl Scheme for Hht {
    fn method(&self) -> Method {
        Method::Implicit(Alphas {
            alpha_m: 0.0,
            alpha_f: -self.alpha,
            beta: 0.25 * (1.0 - self.alpha).powi(2),
            gamma: 0.5 - self.alpha,
        })
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        if (-1.0 / 3.0..=0.0).contains(&self.alpha) {
            Vec::new()
        } else {
            vec![(
                "alpha",
                format!("must lie between -1/3 and 0, not {}", self.alpha),
            )]
        }
    }
}

impl Samples for Hht {
    fn samples() -> Vec<Self> {
        vec![Hht::default(), Hht { alpha: -0.3 }]
    }
}
