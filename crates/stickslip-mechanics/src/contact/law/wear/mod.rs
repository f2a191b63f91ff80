//! Wear: what sliding takes away from surfaces, and whether contact feels it.

mod archard;
mod dissipated_energy;
mod feedback;
mod hardness;
mod law;
mod tabular;
mod threshold;
mod unworn;

pub use archard::Archard;
pub use dissipated_energy::DissipatedEnergy;
pub use feedback::Feedback;
pub use hardness::ArchardHardness;
pub use law::{Sliding, WearLaw, WearPoint, WearRate};
pub use tabular::Tabular;
pub use threshold::ArchardThreshold;
pub use unworn::Unworn;

crate::family! {
    /// What sliding wears off the surfaces.
    WearModel: "wear", dyn WearLaw {
        /// Nothing.
        Unworn(Unworn) = "none",
        /// Depth in proportion to pressure and path.
        Archard(Archard) = "archard",
        /// The same by a coefficient without dimension and a hardness.
        ArchardHardness(ArchardHardness) = "archard-hardness",
        /// The same beyond a pressure, a path or an energy.
        ArchardThreshold(ArchardThreshold) = "archard-threshold",
        /// Measured rates over pressure and speed.
        Tabular(Tabular) = "tabular",
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

    /// A point that has come some way, and what it slides under a pressure over a path.
    fn sliding(pressure: f64, path: f64, shear: f64) -> (WearPoint, Sliding) {
        let at = WearPoint {
            path: 0.05,
            way: path,
            energy: 0.02,
            spent: 0.4,
            pressure,
            speed: 0.07,
        };
        let slid = Sliding {
            pressed: pressure * path,
            dissipated: shear * pressure * path,
        };
        (at, slid)
    }

    #[test]
    fn only_none_takes_nothing() {
        for model in WearModel::samples() {
            let law = model.as_dyn();
            assert!(law.faults().is_empty(), "{model:?}");
            let (at, slid) = sliding(3.0, 1.0, 0.5);
            let rates = law.rates(&at);
            let worn = rates.map(|r| r.depth(slid));
            assert_eq!(law.active(), worn != [0.0; 2], "{model:?}");
            assert_eq!(law.active(), law.fastest() != [WearRate::default(); 2]);
            assert_eq!(model.is_none(), !law.active(), "{model:?}");
        }
    }

    #[test]
    fn a_depth_has_the_slope_over_the_pressure_that_its_rate_says() {
        for model in WearModel::samples() {
            let law = model.as_dyn();
            let (path, shear) = (0.1, 0.4);
            for pressure in [0.5, 2.0, 5.0, 11.0] {
                for side in [0, 1] {
                    let depth = |p: f64| {
                        let (at, slid) = sliding(p, path, shear);
                        law.rates(&at)[side].depth(slid)
                    };
                    let d = 1e-4;
                    let difference = (depth(pressure + d) - depth(pressure - d)) / (2.0 * d);
                    let (at, _) = sliding(pressure, path, shear);
                    let rate = law.rates(&at)[side];
                    let said = (rate.per_path(shear) + pressure * rate.d_pressure) * path;
                    let off = (said - difference).abs();
                    assert!(off <= 1e-9 * difference.abs(), "{model:?} {pressure}");
                    let most = law.fastest()[side].per_path(shear) * path;
                    assert!(said <= most * (1.0 + 1e-12), "{model:?} {pressure}");
                }
            }
        }
    }

    #[test]
    fn what_wears_after_a_way_does_not_depend_on_how_it_is_divided() {
        let path = |law: &dyn WearLaw, ends: &[f64]| -> f64 {
            let parts = ends.windows(2).map(|w| {
                let at = WearPoint {
                    path: w[0],
                    way: w[1] - w[0],
                    energy: 2.0 * w[0],
                    spent: 2.0 * (w[1] - w[0]),
                    pressure: 5.0,
                    ..WearPoint::default()
                };
                law.rates(&at)[0].pressed * 5.0 * (w[1] - w[0])
            });
            parts.sum()
        };
        let begins = ArchardThreshold {
            coefficient: 2.0,
            primary_coefficient: 0.0,
            pressure: 1.0,
            path: 0.3,
            energy: 0.0,
        };
        let spends = ArchardThreshold {
            path: 0.0,
            energy: 0.6,
            ..begins
        };
        let runs_in = Archard {
            coefficient: 2.0,
            primary_coefficient: 0.0,
            running_in: 3.0,
            running_in_path: 0.5,
        };
        let decayed = 2.0 * 5.0 * (1.0 + 3.0 * 0.5 * (1.0 - (-2.0_f64).exp()));
        let cases: [(&dyn WearLaw, f64); 3] = [
            (&begins, 2.0 * (5.0 - 1.0) * 0.7),
            (&spends, 2.0 * (5.0 - 1.0) * 0.7),
            (&runs_in, decayed),
        ];
        for (law, expected) in cases {
            for ends in [&[0.0, 1.0][..], &[0.0, 0.1, 0.45, 1.0]] {
                let found = path(law, ends);
                assert!((found / expected - 1.0).abs() < 1e-14, "{found} {expected}");
            }
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
        let at = |path: f64| {
            let at = WearPoint {
                path,
                ..WearPoint::default()
            };
            law.rates(&at).map(|r| r.pressed)
        };
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
            energy: 0.0,
        };
        assert_eq!(nothing.faults().len(), 1);
        let soft = ArchardHardness {
            coefficient: 1e-4,
            hardness: 0.0,
            primary_coefficient: 0.0,
            primary_hardness: Some(-1.0),
        };
        assert_eq!(soft.faults().len(), 2, "{:?}", soft.faults());
        let none = ArchardThreshold {
            coefficient: 1.0,
            primary_coefficient: 0.0,
            pressure: 0.0,
            path: 0.0,
            energy: 0.0,
        };
        assert_eq!(none.faults()[0].0, "pressure");
        let table = |values: &[f64]| Tabular {
            pressures: Some(vec![1.0, 2.0]),
            speeds: None,
            coefficient: vec![values.to_vec()],
            primary_coefficient: None,
        };
        // k p is 3 at both ends, and 3.375 in between: it falls.
        assert!(table(&[3.0, 1.5]).faults()[0].1.contains("wear less"));
        assert_eq!(table(&[3.0, 2.0]).faults(), []);
        assert_eq!(
            table(&[0.0, 0.0]).faults()[0].1,
            "one rate must be positive"
        );
        assert!(table(&[1.0]).faults()[0].1.contains("must have 2 rows"));
    }
}
