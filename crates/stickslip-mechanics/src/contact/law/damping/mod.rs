//! Damping across the interface: pressure that follows from how fast the surfaces approach or part.

mod hunt_crossley;
mod law;
mod undamped;
mod viscous;

pub use hunt_crossley::HuntCrossley;
pub use law::{Extra, NormalDamping};
pub use undamped::Undamped;
pub use viscous::Viscous;

crate::family! {
    /// Contact damping: pressure as a function of the closing velocity.
    DampingModel: "damping", dyn NormalDamping {
        /// No damping.
        Undamped(Undamped) = "none",
        /// A dashpot.
        Viscous(Viscous) = "viscous",
        /// Damping in proportion to the pressure.
        HuntCrossley(HuntCrossley) = "hunt-crossley",
    }
}

impl Default for DampingModel {
    fn default() -> Self {
        DampingModel::Undamped(Undamped {})
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::Family;

    #[test]
    fn derivatives_agree_with_differences() {
        for model in DampingModel::samples() {
            let law = model.as_dyn();
            assert!(law.faults().is_empty(), "{model:?}");
            for pressure in [2.9e3, 4.1e7] {
                for rate in [-1.3, -1e-3, 0.0, 2e-3, 0.8] {
                    let extra = law.extra(pressure, rate);
                    let difference = |dp: f64, dr: f64| {
                        let (a, b) = (
                            law.extra(pressure - dp, rate - dr),
                            law.extra(pressure + dp, rate + dr),
                        );
                        (b.value - a.value) / (2.0 * (dp + dr))
                    };
                    let close = |a: f64, b: f64| (a - b).abs() <= 1e-8 * b.abs();
                    let d_pressure = difference(1e-3 * pressure, 0.0);
                    assert!(close(extra.d_pressure, d_pressure), "{model:?} {rate}");
                    let d_rate = difference(0.0, 1e-3);
                    assert!(close(extra.d_rate, d_rate), "{model:?} {rate}");
                }
            }
        }
    }

    #[test]
    fn what_is_active_takes_energy_and_nothing_else_does() {
        for model in DampingModel::samples() {
            let law = model.as_dyn();
            assert_eq!(law.extra(1e6, 0.0).value, 0.0, "{model:?}");
            for rate in [-0.7, 0.2] {
                let power = law.extra(1e6, rate).value * rate;
                assert_eq!(power > 0.0, law.active(), "{model:?}");
                assert!(power >= 0.0, "{model:?}");
            }
        }
    }

    #[test]
    fn a_coefficient_that_is_not_positive_is_a_fault() {
        for coefficient in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let models: [&dyn NormalDamping; 2] =
                [&Viscous { coefficient }, &HuntCrossley { coefficient }];
            for model in models {
                let faults = model.faults();
                assert_eq!(faults.len(), 1, "{coefficient}");
                assert_eq!(faults[0].0, "coefficient");
            }
        }
    }
}
