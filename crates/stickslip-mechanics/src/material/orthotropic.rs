use super::axes;
use super::check::{self, MaterialError, modulus};
use super::elasticity::Elasticity;
use super::reduce::rotate;
use super::stiffness::Stiffness;
use crate::math::{Vec3, inverse};
use crate::registry::Samples;

/// Three orthogonal planes of symmetry.
///
/// `nu12` is the contraction along axis 2 under stress along axis 1, so that `nu12 / e1 = nu21 / e2`.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Orthotropic {
    /// Young's modulus along axis 1 `[Pa]`.
    pub e1: f64,
    /// Young's modulus along axis 2 `[Pa]`.
    pub e2: f64,
    /// Young's modulus along axis 3 `[Pa]`.
    pub e3: f64,
    /// Poisson's ratio `[1]`: contraction along 2 under stress along 1.
    pub nu12: f64,
    /// Poisson's ratio `[1]`: contraction along 3 under stress along 1.
    pub nu13: f64,
    /// Poisson's ratio `[1]`: contraction along 3 under stress along 2.
    pub nu23: f64,
    /// Shear modulus in the plane 1-2 `[Pa]`.
    pub g12: f64,
    /// Shear modulus in the plane 1-3 `[Pa]`.
    pub g13: f64,
    /// Shear modulus in the plane 2-3 `[Pa]`.
    pub g23: f64,
    /// Mass per volume `[kg/m³]`; needed for gravity and dynamics only.
    #[serde(default)]
    pub density: f64,
    /// Directions of the axes 1 and 2 in space `[1]`; they are normalised, and axis 2 is made orthogonal to axis 1.
    /// Without it the axes are x, y, z.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axes: Option<[Vec3; 2]>,
}

impl Orthotropic {
    /// The Poisson's ratio to look at when the compliance is not positive definite.
    fn suspect(&self) -> &'static str {
        let pairs = [
            ("nu12", self.nu12, self.e1, self.e2),
            ("nu13", self.nu13, self.e1, self.e3),
            ("nu23", self.nu23, self.e2, self.e3),
        ];
        // Energy needs |ν_ij| < √(E_i / E_j); the worst offender relative to that bound is named.
        let excess = |&(_, nu, ei, ej): &(&str, f64, f64, f64)| nu.abs() * (ej / ei).sqrt();
        pairs
            .iter()
            .max_by(|a, b| excess(a).total_cmp(&excess(b)))
            .map_or("nu12", |p| p.0)
    }
}

impl Elasticity for Orthotropic {
    fn stiffness(&self) -> Result<Stiffness, MaterialError> {
        let moduli = [
            ("e1", self.e1),
            ("e2", self.e2),
            ("e3", self.e3),
            ("g12", self.g12),
            ("g13", self.g13),
            ("g23", self.g23),
        ];
        for (parameter, value) in moduli {
            modulus(parameter, value)?;
        }
        for (parameter, value) in [
            ("nu12", self.nu12),
            ("nu13", self.nu13),
            ("nu23", self.nu23),
        ] {
            if !value.is_finite() {
                return Err(MaterialError::new(
                    parameter,
                    format!("{parameter} = {value} is not a finite number"),
                ));
            }
        }
        let (s12, s13, s23) = (
            -self.nu12 / self.e1,
            -self.nu13 / self.e1,
            -self.nu23 / self.e2,
        );
        let compliance = [
            [1.0 / self.e1, s12, s13],
            [s12, 1.0 / self.e2, s23],
            [s13, s23, 1.0 / self.e3],
        ];
        let suspect = self.suspect();
        let Some((normal, _)) = inverse(&compliance) else {
            return Err(MaterialError::new(
                suspect,
                format!("the Poisson's ratios make the compliance singular, look at {suspect}"),
            ));
        };
        let mut c = [[0.0; 6]; 6];
        for i in 0..3 {
            c[i][..3].copy_from_slice(&normal[i]);
        }
        c[3][3] = self.g12;
        c[4][4] = self.g23;
        c[5][5] = self.g13;
        check::symmetric(&mut c, suspect)?;
        check::elliptic(&c, suspect).map_err(|e| {
            e.help(format!(
                "look at {suspect}: |nu_ij| must stay below sqrt(E_i / E_j), and 1 - nu12 nu21 - nu13 nu31 - nu23 nu32 - 2 nu21 nu32 nu13 above zero"
            ))
        })?;
        Ok(match self.frame()? {
            Some(axes) => rotate(&c, &axes),
            None => c,
        })
    }

    fn frame(&self) -> Result<Option<[Vec3; 3]>, MaterialError> {
        self.axes.map(axes::frame).transpose()
    }

    fn density(&self) -> f64 {
        self.density
    }
}

impl Samples for Orthotropic {
    fn samples() -> Vec<Self> {
        // A carbon-fibre ply, along x and turned by 30° in the plane.
        let ply = Orthotropic {
            e1: 140e9,
            e2: 10e9,
            e3: 9e9,
            nu12: 0.3,
            nu13: 0.28,
            nu23: 0.45,
            g12: 5e9,
            g13: 4.5e9,
            g23: 3.2e9,
            density: 1600.0,
            axes: None,
        };
        let (s, c) = 30.0_f64.to_radians().sin_cos();
        let turned = Orthotropic {
            axes: Some([[c, s, 0.0], [-s, c, 0.0]]),
            ..ply.clone()
        };
        vec![ply, turned]
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Isotropic, smallest_eigenvalue};
    use super::*;

    fn like_isotropic(axes: Option<[Vec3; 2]>) -> Orthotropic {
        let (e, nu) = (70e9, 0.33);
        let g = e / (2.0 * (1.0 + nu));
        Orthotropic {
            e1: e,
            e2: e,
            e3: e,
            nu12: nu,
            nu13: nu,
            nu23: nu,
            g12: g,
            g13: g,
            g23: g,
            density: 0.0,
            axes,
        }
    }

    #[test]
    fn equal_constants_are_isotropic_in_any_frame() {
        let reference = Isotropic {
            young: 70e9,
            poisson: 0.33,
            density: 0.0,
        }
        .stiffness()
        .expect("sound");
        for axes in [None, Some([[1.0, 2.0, -1.0], [0.3, 0.0, 1.0]])] {
            let c = like_isotropic(axes).stiffness().expect("sound");
            for (a, b) in c.iter().flatten().zip(reference.iter().flatten()) {
                assert!((a - b).abs() < 1e-14 * reference[0][0] * 10.0, "{a} {b}");
            }
        }
    }

    #[test]
    fn a_quarter_turn_swaps_the_axes() {
        let ply = &Orthotropic::samples()[0];
        let c = ply.stiffness().expect("sound");
        let turned = Orthotropic {
            axes: Some([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]]),
            ..ply.clone()
        }
        .stiffness()
        .expect("sound");
        let scale = c[0][0];
        assert!((turned[1][1] - c[0][0]).abs() < 1e-12 * scale);
        assert!((turned[0][0] - c[1][1]).abs() < 1e-12 * scale);
        // The plane 2-3 of the material is the plane x-z of space.
        assert!((turned[5][5] - c[4][4]).abs() < 1e-12 * scale);
        // A rotation keeps the eigenvalues.
        let (a, b) = (smallest_eigenvalue(&turned), smallest_eigenvalue(&c));
        assert!((a - b).abs() < 1e-9 * b);
    }

    #[test]
    fn indefinite_constants_name_the_ratio_and_the_eigenvalue() {
        let bad = Orthotropic {
            nu23: 1.2,
            ..Orthotropic::samples()[0].clone()
        };
        let e = bad.stiffness().expect_err("indefinite");
        assert_eq!(e.parameter, "nu23");
        assert!(e.smallest_eigenvalue.expect("given") < 0.0);
        assert!(e.to_string().contains("smallest eigenvalue"));
        let flat = like_isotropic(Some([[1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]));
        assert_eq!(flat.stiffness().expect_err("parallel").parameter, "axes");
    }
}
