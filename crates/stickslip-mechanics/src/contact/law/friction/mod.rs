//! Friction laws: the largest shear traction the interface carries.

mod coulomb;
mod exponential_decay;
mod frictionless;
mod law;
mod orthotropic;
mod orthotropy;
mod power_law;
mod profile;
mod rate_and_state;
mod static_kinetic;
mod stribeck;
mod tabular;

pub use coulomb::Coulomb;
pub use exponential_decay::ExponentialDecay;
pub use frictionless::Frictionless;
pub use law::{FrictionLaw, FrictionPoint, LawState, Limit, MOST_STATES, StateVariable};
pub use orthotropic::{Around, Orthotropic};
pub use orthotropy::{Lines, Orthotropy};
pub use power_law::PowerLaw;
pub use profile::{Along, Profile};
pub use rate_and_state::{Evolution, RateAndState};
pub use static_kinetic::StaticKinetic;
pub use stribeck::Stribeck;
pub use tabular::Tabular;

crate::family! {
    /// The friction law: the largest shear traction of the interface.
    FrictionModel: "friction", dyn FrictionLaw {
        /// No friction.
        Frictionless(Frictionless) = "none",
        /// Shear limit proportional to pressure.
        Coulomb(Coulomb) = "coulomb",
        /// One coefficient along an axis, another across.
        Orthotropic(Orthotropic) = "orthotropic",
        /// Shear limit a power of the penetration.
        PowerLaw(PowerLaw) = "power-law",
        /// One coefficient to start with, another to slide with.
        StaticKinetic(StaticKinetic) = "static-kinetic",
        /// A coefficient that decays with speed.
        ExponentialDecay(ExponentialDecay) = "exponential-decay",
        /// A coefficient that falls with speed, and viscous drag.
        Stribeck(Stribeck) = "stribeck",
        /// Measured coefficients over pressure and speed.
        Tabular(Tabular) = "tabular",
        /// A coefficient that depends on velocity and on a state, as faults have it.
        RateAndState(RateAndState) = "rate-and-state",
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

    /// Points from light to heavy load and from rest to fast sliding, off the corners of the samples.
    fn points() -> Vec<FrictionPoint> {
        let mut out = Vec::new();
        for (pressure, penetration) in [(4.3e4, 1.3e-8), (3.7e7, 4.1e-7), (3.1e8, 2.3e-6)] {
            for speed in [0.0, 3e-6, 0.02, 0.2, 3.1] {
                for sticking in [true, false] {
                    out.push(FrictionPoint {
                        pressure,
                        penetration,
                        speed,
                        sticking,
                        ..FrictionPoint::default()
                    });
                }
            }
        }
        out
    }

    #[test]
    fn derivatives_agree_with_differences() {
        for model in FrictionModel::samples() {
            let law = model.as_dyn();
            assert!(law.faults().is_empty(), "{model:?}");
            // Laws that flow depend on the logarithm of the speed, and have tests of their own.
            for at in points().into_iter().filter(|_| !law.flows()) {
                let limit = law.limit(&at);
                let value = |change: &dyn Fn(&mut FrictionPoint, f64), h: f64| {
                    let mut moved = at;
                    change(&mut moved, h);
                    law.limit(&moved).value
                };
                let probe = |change: &dyn Fn(&mut FrictionPoint, f64), h: f64| {
                    (value(change, h) - value(change, -h)) / (2.0 * h)
                };
                // what rounding of the limit leaves of a difference
                let close = |a: f64, b: f64, h: f64| {
                    (a - b).abs() <= 1e-7 * b.abs() + 4.0 * f64::EPSILON * limit.value / h
                };
                let h = 1e-5 * at.pressure;
                assert!(
                    close(limit.d_pressure, probe(&|p, h| p.pressure += h, h), h),
                    "{model:?} {at:?}"
                );
                let h = 1e-5 * at.penetration;
                assert!(
                    close(limit.d_penetration, probe(&|p, h| p.penetration += h, h), h),
                    "{model:?} {at:?}"
                );
                // there is no speed below zero: at rest it is the derivative to the right
                let faster: &dyn Fn(&mut FrictionPoint, f64) = &|p, h| p.speed += h;
                let h = 1e-6;
                let slope = if at.speed > h {
                    probe(faster, h)
                } else {
                    let ahead = 4.0 * value(faster, h) - value(faster, 2.0 * h);
                    (ahead - 3.0 * limit.value) / (2.0 * h)
                };
                assert!(close(limit.d_speed, slope, h / 4.0), "{model:?} {at:?}");
            }
        }
    }

    #[test]
    fn limits_are_finite_and_never_negative() {
        for model in FrictionModel::samples() {
            let law = model.as_dyn();
            if law.flows() {
                continue;
            }
            for pressure in [f64::MIN_POSITIVE, 1.0, 1e12] {
                for speed in [0.0, f64::MIN_POSITIVE, 1.0, 1e200] {
                    for sticking in [true, false] {
                        let limit = law.limit(&FrictionPoint {
                            pressure,
                            penetration: 1e-6,
                            speed,
                            sticking,
                            ..FrictionPoint::default()
                        });
                        let all = [
                            limit.value,
                            limit.d_pressure,
                            limit.d_penetration,
                            limit.d_speed,
                        ];
                        assert!(all.iter().all(|x| x.is_finite()), "{model:?} {limit:?}");
                        assert!(limit.value >= 0.0, "{model:?} {limit:?}");
                    }
                }
            }
        }
    }
}
