//! What an enforcement says, and the equation that all of them solve.

use super::super::law::normal::NormalLaw;
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

    pub(super) fn choose(absolute: Option<f64>, factor: Option<f64>, default: f64) -> Self {
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
