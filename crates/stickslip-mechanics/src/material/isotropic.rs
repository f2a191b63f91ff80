use super::check::{MaterialError, modulus};
use super::elasticity::Elasticity;
use super::stiffness::Stiffness;
use crate::registry::Samples;

/// The same in all directions.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Isotropic {
    /// Young's modulus `[Pa]`, positive.
    pub young: f64,
    /// Poisson's ratio `[1]`, between -1 and 0.5, bounds excluded.
    pub poisson: f64,
    /// Mass per volume `[kg/m³]`; needed for gravity and dynamics only.
    #[serde(default)]
    pub density: f64,
}

impl Isotropic {
    /// Lamé's constants `(λ, μ)` `[Pa]`, unchecked.
    pub fn lame(&self) -> (f64, f64) {
        let (e, nu) = (self.young, self.poisson);
        (
            e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
            e / (2.0 * (1.0 + nu)),
        )
    }
}

impl Elasticity for Isotropic {
    fn stiffness(&self) -> Result<Stiffness, MaterialError> {
        modulus("young", self.young)?;
        let nu = self.poisson;
        if !(nu > -1.0 && nu < 0.5) {
            let error = MaterialError::new(
                "poisson",
                format!("poisson = {nu} is outside the open interval (-1, 0.5)"),
            )
            .help(
                "for a nearly incompressible body use 0.499 or so with formulation = \"mean-dilatation\"",
            );
            // The eigenvalues are 3κ (once) and 2μ (five times); at the ends of the interval one is unbounded.
            let smallest = (self.young / (1.0 - 2.0 * nu)).min(self.young / (1.0 + nu));
            return Err(if smallest.is_finite() {
                error.eigenvalue(smallest)
            } else {
                error
            });
        }
        let (lambda, mu) = self.lame();
        let mut c = [[0.0; 6]; 6];
        for i in 0..3 {
            c[i][..3].fill(lambda);
            c[i][i] += 2.0 * mu;
            c[i + 3][i + 3] = mu;
        }
        super::check::elliptic(&c, "poisson")?;
        Ok(c)
    }

    fn density(&self) -> f64 {
        self.density
    }
}

impl Samples for Isotropic {
    fn samples() -> Vec<Self> {
        vec![
            Isotropic {
                young: 210e9,
                poisson: 0.3,
                density: 7850.0,
            },
            Isotropic {
                young: 5e6,
                poisson: 0.4999,
                density: 1100.0,
            },
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(young: f64, poisson: f64) -> Isotropic {
        Isotropic {
            young,
            poisson,
            density: 0.0,
        }
    }

    #[test]
    fn uniaxial_stress_gives_young_and_poisson() {
        let c = of(200.0, 0.25).stiffness().expect("sound");
        let strain = [1e-3, -0.25e-3, -0.25e-3, 0.0, 0.0, 0.0];
        let stress: Vec<f64> = c
            .iter()
            .map(|row| row.iter().zip(strain).map(|(c, e)| c * e).sum())
            .collect();
        assert!((stress[0] - 0.2).abs() < 1e-15);
        assert!(stress[1].abs() < 1e-15 && stress[2].abs() < 1e-15);
    }

    #[test]
    fn parameters_at_fault_are_named() {
        let e = of(-1.0, 0.3).stiffness().expect_err("negative");
        assert_eq!(e.parameter, "young");
        let e = of(1.0, 0.6).stiffness().expect_err("too large");
        assert_eq!(e.parameter, "poisson");
        assert!((e.smallest_eigenvalue.expect("finite") + 5.0).abs() < 1e-12);
        assert!(
            e.to_string()
                .contains("smallest eigenvalue of the stiffness is -5")
        );
        let e = of(1.0, 0.5).stiffness().expect_err("incompressible");
        assert_eq!(e.parameter, "poisson");
        assert_eq!(
            of(1.0, f64::NAN).stiffness().expect_err("NaN").parameter,
            "poisson"
        );
        let mut m = of(1.0, 0.3);
        m.density = -1.0;
        assert_eq!(m.check().expect_err("density").parameter, "density");
    }
}
