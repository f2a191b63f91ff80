//! Schemes that integrate the equations of motion, one file each.
//!
//! The implicit ones are one kernel with four numbers, [`Alphas`]; see [`newmark`](super::newmark).

mod central_difference;
mod generalised_alpha;
mod hht;
mod method;
mod trapezoidal;

pub use central_difference::CentralDifference;
pub use generalised_alpha::GeneralisedAlpha;
pub use hht::Hht;
pub use method::{Alphas, Method, Scheme};
pub use trapezoidal::Newmark;

crate::family! {
    /// How the equations of motion are integrated.
    SchemeModel: "scheme", dyn Scheme {
        /// Newmark's method.
        Newmark(Newmark) = "newmark",
        /// Hilber, Hughes and Taylor.
        Hht(Hht) = "hht",
        /// Chung and Hulbert.
        GeneralisedAlpha(GeneralisedAlpha) = "generalised-alpha",
        /// Explicit.
        CentralDifference(CentralDifference) = "central-difference",
    }
}

impl Default for SchemeModel {
    fn default() -> Self {
        SchemeModel::GeneralisedAlpha(GeneralisedAlpha::default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::Family;

    #[test]
    fn implicit_samples_are_second_order_and_stable() {
        for model in SchemeModel::samples() {
            assert!(model.as_dyn().faults().is_empty(), "{model:?}");
            let Method::Implicit(a) = model.as_dyn().method() else {
                continue;
            };
            if matches!(model, SchemeModel::Newmark(n) if n.gamma != 0.5) {
                continue;
            }
            // Chung and Hulbert 1993, eq. (17) and (18)
            assert!(
                (a.gamma - (0.5 - a.alpha_m + a.alpha_f)).abs() < 1e-15,
                "{model:?}"
            );
            assert!(a.alpha_m <= a.alpha_f && a.alpha_f <= 0.5, "{model:?}");
            assert!(
                a.beta >= 0.25 + 0.5 * (a.alpha_f - a.alpha_m) - 1e-15,
                "{model:?}"
            );
        }
    }
}
