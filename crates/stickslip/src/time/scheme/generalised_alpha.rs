use serde::{Deserialize, Serialize};

use super::method::{Alphas, Method, Scheme};
use crate::registry::Samples;

/// The generalised-α method of Chung and Hulbert ([`chung_hulbert_1993`](crate::references::chung_hulbert_1993)): second
/// order, damps high frequencies as asked for and low ones as little as possible.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct GeneralisedAlpha {
    /// What one increment leaves of the amplitude of infinitely high frequencies, ρ∞ `[-]`, between 0 and 1. Default: 0.9.
    pub rho: f64,
}

impl Default for GeneralisedAlpha {
    fn default() -> Self {
        GeneralisedAlpha { rho: 0.9 }
    }
}

impl Scheme for GeneralisedAlpha {
    fn method(&self) -> Method {
        let rho = self.rho;
        let alpha_m = (2.0 * rho - 1.0) / (rho + 1.0);
        let alpha_f = rho / (rho + 1.0);
        Method::Implicit(Alphas {
            alpha_m,
            alpha_f,
            beta: 0.25 * (1.0 - alpha_m + alpha_f).powi(2),
            gamma: 0.5 - alpha_m + alpha_f,
        })
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        if (0.0..=1.0).contains(&self.rho) {
            Vec::new()
        } else {
            vec![("rho", format!("must lie between 0 and 1, not {}", self.rho))]
        }
    }
}

impl Samples for GeneralisedAlpha {
    fn samples() -> Vec<Self> {
        vec![GeneralisedAlpha::default(), GeneralisedAlpha { rho: 0.3 }]
    }
}
