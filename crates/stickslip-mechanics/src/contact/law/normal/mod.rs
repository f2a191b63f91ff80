//! Normal laws: pressure against gap.

mod exponential;
mod law;
mod linear;
mod micro_contact;
mod power_law;
mod tabular;
mod unilateral;

pub use exponential::Exponential;
pub use law::NormalLaw;
pub(crate) use law::{not_negative, positive};
pub use linear::Linear;
pub use micro_contact::MicroContact;
pub use power_law::PowerLaw;
pub use tabular::Tabular;
pub use unilateral::Unilateral;

crate::family! {
    /// The normal law: pressure as a function of the gap.
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
