//! Friction laws: the largest shear traction the interface carries.

mod coulomb;
mod frictionless;
mod power_law;

pub use coulomb::Coulomb;
pub use frictionless::Frictionless;
pub use power_law::PowerLaw;

/// What a friction law may depend on.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FrictionPoint {
    /// Pressure `[Pa]`, not negative.
    pub pressure: f64,
    /// Penetration `max(0, -gap)` `[m]`.
    pub penetration: f64,
    /// Sliding speed `[m/s]`.
    pub speed: f64,
}

/// The limit of the shear traction and its derivatives.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Limit {
    /// Limit `[Pa]`, not negative.
    pub value: f64,
    /// Derivative with respect to pressure `[-]`.
    pub d_pressure: f64,
    /// Derivative with respect to penetration `[Pa/m]`.
    pub d_penetration: f64,
    /// Derivative with respect to speed `[Pa s/m]`.
    pub d_speed: f64,
}

impl Limit {
    /// The limit, but at most `cap`.
    pub fn capped(self, cap: Option<f64>) -> Self {
        match cap {
            Some(cap) if self.value > cap => Limit {
                value: cap,
                ..Limit::default()
            },
            _ => self,
        }
    }
}

/// States the largest shear traction. What happens below and at the limit is the slip rule's business.
pub trait FrictionLaw: Send + Sync {
    /// The limit at a point in contact.
    fn limit(&self, at: &FrictionPoint) -> Limit;

    /// `false` if there is never any shear traction; saves the tangential unknowns.
    fn frictional(&self) -> bool {
        true
    }

    /// `true` if the law depends on the penetration, which only a compliant normal law gives a physical meaning.
    fn needs_penetration(&self) -> bool {
        false
    }

    /// What is wrong with the parameters, as `(key, message)`; empty if nothing.
    fn faults(&self) -> Vec<(&'static str, String)>;
}

crate::family! {
    /// How much shear the interface carries.
    FrictionModel: "friction", dyn FrictionLaw {
        /// No friction.
        Frictionless(Frictionless) = "none",
        /// Shear limit proportional to pressure.
        Coulomb(Coulomb) = "coulomb",
        /// Shear limit a power of the penetration.
        PowerLaw(PowerLaw) = "power-law",
    }
}

impl Default for FrictionModel {
    fn default() -> Self {
        FrictionModel::Frictionless(Frictionless {})
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::Family;

    #[test]
    fn derivatives_agree_with_differences() {
        for model in FrictionModel::samples() {
            let law = model.as_dyn();
            assert!(law.faults().is_empty(), "{model:?}");
            let at = FrictionPoint {
                pressure: 3.7e7,
                penetration: 4.1e-7,
                speed: 0.2,
            };
            let limit = law.limit(&at);
            let probe = |change: &dyn Fn(&mut FrictionPoint, f64), h: f64| {
                let (mut a, mut b) = (at, at);
                change(&mut a, -h);
                change(&mut b, h);
                (law.limit(&b).value - law.limit(&a).value) / (2.0 * h)
            };
            let close = |a: f64, b: f64| (a - b).abs() <= 1e-7 * b.abs().max(1e-9);
            assert!(
                close(limit.d_pressure, probe(&|p, h| p.pressure += h, 1e2)),
                "{model:?}"
            );
            assert!(
                close(
                    limit.d_penetration,
                    probe(&|p, h| p.penetration += h, 1e-12)
                ),
                "{model:?}"
            );
            assert!(
                close(limit.d_speed, probe(&|p, h| p.speed += h, 1e-6)),
                "{model:?}"
            );
        }
    }
}
