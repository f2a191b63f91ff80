//! What a normal law says.

use crate::math::Slope;

/// A relation between the gap (positive: open) and the pressure (positive: compression), falling and one-sided.
pub trait NormalLaw: Send + Sync {
    /// Pressure `[Pa]` and its derivative at a gap `[m]`; `None` where the law is set-valued (unilateral).
    fn pressure(&self, gap: f64) -> Option<Slope>;

    /// The inverse `h(p)`: the gap `[m]` at a pressure `p > 0` `[Pa]`, and its derivative (not positive).
    fn gap(&self, pressure: f64) -> Slope;

    /// Recoverable energy per area `[J/m²]` at a gap.
    fn energy(&self, gap: f64) -> f64;

    /// What is wrong with the parameters, as `(key, message)`; empty if nothing.
    fn faults(&self) -> Vec<(&'static str, String)>;
}

/// A finding if `value` is not a positive finite number.
pub(crate) fn positive(key: &'static str, value: f64) -> Option<(&'static str, String)> {
    (!(value > 0.0 && value.is_finite()))
        .then(|| (key, format!("must be positive and finite, not {value}")))
}

/// A finding if `value` is negative or not finite.
pub(crate) fn not_negative(key: &'static str, value: f64) -> Option<(&'static str, String)> {
    if !value.is_finite() {
        Some((key, format!("must be finite, not {value}")))
    } else if value < 0.0 {
        Some((key, format!("must not be negative, but is {value}")))
    } else {
        None
    }
}
