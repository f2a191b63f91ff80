//! Normal laws: pressure against gap.

mod exponential;
mod linear;
mod micro_contact;
mod power_law;
mod tabular;
mod unilateral;

pub use exponential::Exponential;
pub use linear::Linear;
pub use micro_contact::MicroContact;
pub use power_law::PowerLaw;
pub use tabular::Tabular;
pub use unilateral::Unilateral;

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

crate::family! {
    /// How the interface resists being pressed together.
    NormalModel: "normal", dyn NormalLaw {
        /// Exact non-penetration.
        Unilateral(Unilateral) = "unilateral",
        /// Pressure proportional to penetration.
        Linear(Linear) = "linear",
        /// Normal compliance.
        PowerLaw(PowerLaw) = "power-law",
        /// Statistical micro-contact.
        MicroContact(MicroContact) = "micro-contact",
        /// Exponential compliance.
        Exponential(Exponential) = "exponential",
        /// A measured curve.
        Tabular(Tabular) = "tabular",
    }
}

impl Default for NormalModel {
    fn default() -> Self {
        NormalModel::Unilateral(Unilateral {})
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::Family;

    #[test]
    fn slopes_and_inverse_agree_with_the_law() {
        for model in NormalModel::samples() {
            let law = model.as_dyn();
            assert!(law.faults().is_empty(), "{model:?}");
            // a gap at which each compliant sample carries load, and a scale for the difference quotient
            let Some(scale) = [1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4]
                .into_iter()
                .find(|&d| law.pressure(-d).is_some_and(|p| p.value > 1e6))
            else {
                assert!(law.pressure(-1e-6).is_none());
                assert_eq!(law.gap(3.0).value, 0.0);
                continue;
            };
            for factor in [0.31, 0.77, 1.3, 2.9, 7.1] {
                let g = -factor * scale;
                let h = 1e-5 * scale;
                let at = |g: f64| law.pressure(g).map_or(f64::NAN, |p| p.value);
                let p = law.pressure(g).unwrap_or_default();
                let slope = (at(g + h) - at(g - h)) / (2.0 * h);
                assert!(
                    (p.slope - slope).abs() <= 1e-6 * slope.abs() + 1e-3,
                    "{model:?} {g}"
                );
                assert!(p.slope <= 0.0);
                if p.value > 0.0 {
                    let inverse = law.gap(p.value);
                    assert!((inverse.value - g).abs() < 1e-9 * scale, "{model:?} {g}");
                    assert!(
                        (inverse.slope * p.slope - 1.0).abs() < 1e-8,
                        "{model:?} {g}"
                    );
                }
                let work = (law.energy(g - h) - law.energy(g + h)) / (2.0 * h);
                assert!((work - p.value).abs() <= 1e-5 * p.value, "{model:?} {g}");
            }
            assert_eq!(at_zero(law), 0.0, "{model:?}");
        }
    }

    fn at_zero(law: &dyn NormalLaw) -> f64 {
        law.pressure(1e-3).map_or(f64::NAN, |p| p.value)
    }
}
