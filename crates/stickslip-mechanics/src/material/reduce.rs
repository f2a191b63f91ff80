//! From the stiffness in space to that of a plane or of another frame.

use super::stiffness::{Stiffness, VOIGT};
use crate::math::Vec3;

/// The largest stiffness against strain in one direction alone `[Pa]`: the largest of `C_xx`, `C_yy`, `C_zz`.
///
/// For an isotropic material `λ + 2μ`. Penalties are multiples of it over a length.
pub fn constrained_modulus(c: &Stiffness) -> f64 {
    c[0][0].max(c[1][1]).max(c[2][2])
}

/// The stiffness of plane stress: zz, yz and xz stresses are zero, their strains condensed out.
///
/// Rows and columns zz, yz, xz of the result are zero. Plane strain and axial symmetry need no such step: there the
/// strains (yz, xz, and zz in the plane) vanish, not the stresses.
///
/// `c` must be positive definite, as [`Elasticity::stiffness`](super::Elasticity::stiffness) grants.
pub fn plane_stress(c: &Stiffness) -> Stiffness {
    let mut m = *c;
    // Eliminating one strain after the other is one step of Gaussian elimination each, without pivoting: the matrix
    // is positive definite.
    for p in [2, 4, 5] {
        let pivot = m[p];
        for row in &mut m {
            let factor = row[p] / pivot[p];
            for (x, y) in row.iter_mut().zip(pivot) {
                *x -= factor * y;
            }
        }
    }
    for p in [2, 4, 5] {
        m[p] = [0.0; 6];
        for row in &mut m {
            row[p] = 0.0;
        }
    }
    m
}

/// The stiffness in space of a material whose stiffness along its own `axes` (rows, orthonormal) is `c`.
pub(super) fn rotate(c: &Stiffness, axes: &[Vec3; 3]) -> Stiffness {
    // t maps engineering strains in space to those along the axes: ε' = Q ε Qᵀ; then C = tᵀ C' t.
    let mut t = [[0.0; 6]; 6];
    for i in 0..3 {
        for j in i..3 {
            let twice = if i == j { 1.0 } else { 2.0 };
            for k in 0..3 {
                for l in 0..3 {
                    let half = if k == l { 1.0 } else { 0.5 };
                    t[VOIGT[i][j]][VOIGT[k][l]] += twice * half * axes[i][k] * axes[j][l];
                }
            }
        }
    }
    let mut out = [[0.0; 6]; 6];
    for (i, row) in out.iter_mut().enumerate() {
        for (j, x) in row.iter_mut().enumerate() {
            for (p, cp) in c.iter().enumerate() {
                for (q, cpq) in cp.iter().enumerate() {
                    *x += t[p][i] * cpq * t[q][j];
                }
            }
        }
    }
    // Rounding must not leave it unsymmetric.
    for i in 0..6 {
        for j in 0..i {
            out[i][j] = 0.5 * (out[i][j] + out[j][i]);
            out[j][i] = out[i][j];
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::super::{Elasticity, Isotropic, Material};
    use super::*;
    use crate::registry::Family;

    #[test]
    fn isotropic_plane_stress_is_the_textbook_matrix() {
        let (e, nu) = (210e9, 0.3);
        let c = Isotropic {
            young: e,
            poisson: nu,
            density: 0.0,
        }
        .stiffness()
        .expect("sound");
        let d = plane_stress(&c);
        let f = e / (1.0 - nu * nu);
        let expected = [
            (0, 0, f),
            (0, 1, nu * f),
            (1, 1, f),
            (3, 3, e / 2.6),
            (0, 3, 0.0),
            (2, 2, 0.0),
        ];
        for (i, j, x) in expected {
            assert!((d[i][j] - x).abs() < 1e-12 * f, "{i} {j}");
        }
    }

    #[test]
    fn plane_stress_leaves_no_stress_out_of_plane() {
        for material in Material::samples() {
            let c = material.as_dyn().stiffness().expect("sound");
            let d = plane_stress(&c);
            let strain = [1e-3, -2e-3, 0.0, 0.7e-3, 0.0, 0.0];
            let stress: Vec<f64> = (0..6)
                .map(|i| (0..6).map(|j| d[i][j] * strain[j]).sum())
                .collect();
            // The free strains that make zz, yz, xz stresses vanish give the same in-plane stresses from `c`:
            // checked through the energy, which the free strains minimise.
            let energy: f64 = (0..6).map(|i| stress[i] * strain[i]).sum();
            for free in [[1e-4, 0.0, 0.0], [0.0, 1e-4, 0.0], [2e-4, -1e-4, 3e-4]] {
                let mut other = strain;
                (other[2], other[4], other[5]) = (free[0], free[1], free[2]);
                let full: f64 = (0..6)
                    .map(|i| (0..6).map(|j| other[i] * c[i][j] * other[j]).sum::<f64>())
                    .sum();
                assert!(full >= energy * (1.0 - 1e-12));
            }
        }
    }
}
