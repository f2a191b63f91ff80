use serde::{Deserialize, Serialize};

use super::method::{Alphas, Method, Scheme};
use crate::registry::Samples;

/// Newmark's method ([`newmark_1959`](crate::references::newmark_1959)). With the defaults it is the trapezoidal rule:
/// unconditionally stable, second order, without dissipation in linear motion.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Newmark {
    /// β `[-]`. Default: 1/4.
    pub beta: f64,
    /// γ `[-]`. Above 1/2 high frequencies are damped and the method is of first order. Default: 1/2.
    pub gamma: f64,
}

impl Default for Newmark {
    fn default() -> Self {
        Newmark {
            beta: 0.25,
            gamma: 0.5,
        }
    }
}

impl Scheme for Newmark {
    fn method(&self) -> Method {
        Method::Implicit(Alphas {
            alpha_m: 0.0,
            alpha_f: 0.0,
            beta: self.beta,
            gamma: self.gamma,
        })
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        let mut faults = Vec::new();
        if !(self.gamma >= 0.5 && self.gamma <= 1.5) {
            let message = format!("must lie between 0.5 and 1.5, not {}", self.gamma);
            faults.push(("gamma", message));
        } else if !(2.0 * self.beta >= self.gamma && self.beta <= 1.0) {
            faults.push((
                "beta",
                format!(
                    "must be at least gamma / 2 = {} for a stable method, and at most 1, not {}",
                    0.5 * self.gamma,
                    self.beta
                ),
            ));
        }
        faults
    }
}

impl Samples for Newmark {
    fn samples() -> Vec<Self> {
        vec![
            Newmark::default(),
            Newmark {
                beta: 0.3025,
                gamma: 0.6,
            },
        ]
    }
}
