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
mod penalty;
mod perturbed;

pub use augmented::AugmentedLagrangian;
pub use penalty::Penalty;
pub use perturbed::PerturbedLagrangian;

use super::law::normal::NormalLaw;
use crate::math::Slope;

/// What becomes of the multipliers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Multipliers {
    /// There are none.
    None,
    /// Unknowns of Newton's iteration.
    Unknown,
    /// Updated between equilibrium solves until the worst violation of gap and stick is below this fraction of the elastic approach.
    Augmented {
        /// Largest violation relative to the elastic approach.
        error: f64,
    },
}

/// A stiffness per area: given, or as a multiple of the bodies' own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stiffness {
    /// Multiple of `M / h`, the constrained modulus over the cell size `[-]`.
    Factor(f64),
    /// Absolute `[Pa/m]`.
    Absolute(f64),
}

impl Stiffness {
    /// In Pa/m, for bodies of stiffness `scale = M / h`.
    pub fn resolve(self, scale: f64) -> f64 {
        match self {
            Stiffness::Factor(factor) => factor * scale,
            Stiffness::Absolute(value) => value,
        }
    }

    fn choose(absolute: Option<f64>, factor: Option<f64>, default: f64) -> Self {
        match absolute {
            Some(value) => Stiffness::Absolute(value),
            None => Stiffness::Factor(factor.unwrap_or(default)),
        }
    }
}

/// A way to tie pressure and gap, and traction and stick.
pub trait Enforcement: Send + Sync {
    /// What becomes of the multipliers.
    fn multipliers(&self) -> Multipliers;
    /// Stiffness ω against penetration.
    fn normal(&self) -> Stiffness;
    /// Stiffness ω_T of sticking.
    fn tangential(&self) -> Stiffness;
    /// What is wrong with the parameters, as `(key, message)`; empty if nothing.
    fn faults(&self) -> Vec<(&'static str, String)>;
}

crate::family! {
    /// How contact and stick are enforced.
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

/// Solves `gap - h(p) + p/ω = 0` for `p`, the relation of a penalty; pressure and its derivative with respect to the gap.
///
/// Zero (with zero slope) where the solution would be tension.
pub fn pressure(law: &dyn NormalLaw, gap: f64, stiffness: f64) -> Slope {
    let Some(own) = law.pressure(gap) else {
        let p = -stiffness * gap;
        return if p > 0.0 {
            Slope {
                value: p,
                slope: -stiffness,
            }
        } else {
            Slope::default()
        };
    };
    if stiffness.is_infinite() {
        return own;
    }
    // F(p) = p + ω (gap - h(p)) rises with p, is concave or convex with h, and has its root above zero iff F(0+) < 0.
    let open = law.gap(f64::MIN_POSITIVE).value;
    if stiffness * (open - gap) <= 0.0 {
        return Slope::default();
    }
    let (mut low, mut high) = (0.0, (stiffness * (open - gap)).max(0.0));
    let mut p = high;
    for _ in 0..200 {
        let h = law.gap(p.max(f64::MIN_POSITIVE));
        let f = p + stiffness * (gap - h.value);
        if f > 0.0 {
            high = p;
        } else {
            low = p;
        }
        let newton = p - f / (1.0 - stiffness * h.slope);
        let next = if newton > low && newton < high {
            newton
        } else {
            0.5 * (low + high)
        };
        let settled = (next - p).abs() <= 1e-15 * p;
        p = next;
        if settled {
            break;
        }
    }
    let h = law.gap(p.max(f64::MIN_POSITIVE));
    Slope {
        value: p,
        slope: -stiffness / (1.0 - stiffness * h.slope),
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
