//! Wear: what sliding takes away from surfaces, and whether contact feels it.

mod archard;
mod dissipated_energy;
mod feedback;
mod law;
mod unworn;

pub use archard::Archard;
pub use dissipated_energy::DissipatedEnergy;
pub use feedback::Feedback;
pub use law::{Sliding, WearLaw, WearRate};
pub use unworn::Unworn;

crate::family! {
    /// What sliding wears off the surfaces.
    WearModel: "wear", dyn WearLaw {
        /// Nothing.
        Unworn(Unworn) = "none",
        /// Depth in proportion to pressure and path.
        Archard(Archard) = "archard",
        /// Depth in proportion to what friction dissipates.
        DissipatedEnergy(DissipatedEnergy) = "dissipated-energy",
    }
}

impl Default for WearModel {
    fn default() -> Self {
        WearModel::Unworn(Unworn {})
    }
}

impl WearModel {
    /// Whether it is none at all, and has not to be written.
    pub fn is_none(&self) -> bool {
        matches!(self, WearModel::Unworn(_))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::Family;

    #[test]
    fn only_none_takes_nothing() {
        for model in WearModel::samples() {
            let law = model.as_dyn();
            assert!(law.faults().is_empty(), "{model:?}");
            let slid = Sliding {
                pressed: 3.0,
                dissipated: 0.5,
            };
            let rates = law.rates(0.0);
            let worn = rates.map(|r| r.depth(slid));
            assert_eq!(law.active(), worn != [0.0; 2], "{model:?}");
            assert_eq!(model.is_none(), !law.active(), "{model:?}");
            // Twice as much sliding takes away twice as much.
            let twice = Sliding {
                pressed: 6.0,
                dissipated: 1.0,
            };
            assert_eq!(rates.map(|r| r.depth(twice)), worn.map(|d| 2.0 * d));
            // It is as soft as that says: the derivative with respect to the pressure, of a shear in proportion to it.
            let [own, _] = rates;
            let (pressure, path, shear) = (5.0, 0.1, 0.4);
            let at = |p: f64| {
                own.depth(Sliding {
                    pressed: p * path,
                    dissipated: shear * p * path,
                })
            };
            let difference = (at(pressure + 1.0) - at(pressure - 1.0)) / 2.0;
            let said = own.per_path(shear) * path;
            assert!((said - difference).abs() <= 1e-12 * difference, "{model:?}");
        }
    }

    #[test]
    fn a_surface_that_runs_in_wears_ever_more_slowly_down_to_the_steady_rate() {
        let law = Archard {
            coefficient: 1.0,
            primary_coefficient: 2.0,
            running_in: 3.0,
            running_in_path: 0.5,
        };
        let at = |path: f64| law.rates(path).map(|r| r.pressed);
        assert_eq!(at(0.0), [4.0, 8.0]);
        let half = at(0.5);
        assert!((half[0] - (1.0 + 3.0 * (-1.0_f64).exp())).abs() < 1e-15);
        assert!((at(1e3)[1] - 2.0).abs() < 1e-15);
    }

    #[test]
    fn coefficients_that_make_no_sense_are_faults() {
        let bad = Archard {
            coefficient: -1.0,
            primary_coefficient: f64::NAN,
            running_in: 1.0,
            running_in_path: 0.0,
        };
        assert_eq!(bad.faults().len(), 3, "{:?}", bad.faults());
        let nothing = DissipatedEnergy {
            coefficient: 0.0,
            primary_coefficient: 0.0,
        };
        assert_eq!(nothing.faults().len(), 1);
    }
}
