//! Enforcement: how pressure and gap are tied.
//!
//! Every enforcement solves the same scalar relation for the pressure `p ≥ 0`,
//!
//! `gap - h(p) + (p - λ)/ω = 0`,
//!
//! with `h` the gap of the normal law at a pressure and ω a stiffness per area. *Penalty*: `λ = 0`. *Perturbed Lagrangian*: the
//! same with the pressure kept as an unknown of Newton's iteration. *Augmented Lagrangian*: the pressure is an unknown as well, and λ
//! its last estimate, updated until `gap = h(p)` to a stated error. A compliant law needs no help: with `ω = ∞` its own curve is followed.
//!
//! ω is a dimensionless factor times the stiffness of the bodies beside the interface over the size of their cells, so
//! neither the units nor the mesh change how stiff it is.

mod augmented;
mod eliminate;
mod penalty;
mod perturbed;
mod rule;

pub use augmented::AugmentedLagrangian;
pub use eliminate::{condensed_slope, inverse_of_rows, residual};
pub use penalty::Penalty;
pub use perturbed::PerturbedLagrangian;
pub use rule::{Enforcement, Multipliers, Stiffness, pressure};

crate::family! {
    /// How the contact and sticking constraints are enforced.
    EnforcementModel: "enforcement", dyn Enforcement {
        /// Springs.
        Penalty(Penalty) = "penalty",
        /// The paper's formulation.
        PerturbedLagrangian(PerturbedLagrangian) = "perturbed-lagrangian",
        /// Exact to a stated error.
        AugmentedLagrangian(AugmentedLagrangian) = "augmented-lagrangian",
    }
}

impl Default for EnforcementModel {
    fn default() -> Self {
        EnforcementModel::AugmentedLagrangian(AugmentedLagrangian::default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::law::normal::NormalModel;
    use crate::registry::Family;

    #[test]
    fn the_scalar_relation_is_solved_for_every_law() {
        for model in NormalModel::samples() {
            let law = model.as_dyn();
            for stiffness in [1e11, 1e13, 1e16] {
                for gap in [-3e-6, -2e-7, 1e-7] {
                    let p = pressure(law, gap, stiffness);
                    let what = format!("{model:?} ω {stiffness} gap {gap}");
                    if p.value > 0.0 {
                        let r = gap - law.gap(p.value).value + p.value / stiffness;
                        assert!(
                            r.abs() < 1e-12 * (gap.abs() + p.value / stiffness),
                            "{what}"
                        );
                        let h = 1e-4 * gap.abs().min(p.value / stiffness);
                        let at = |g: f64| pressure(law, g, stiffness).value;
                        let slope = (at(gap + h) - at(gap - h)) / (2.0 * h);
                        assert!((p.slope / slope - 1.0).abs() < 1e-4, "{what} {slope}");
                    } else {
                        assert!(gap >= law.gap(1e-300).value, "{what}");
                    }
                }
            }
        }
    }
}
