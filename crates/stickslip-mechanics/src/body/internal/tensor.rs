//! Gradients, strains and stresses at a point of several cells.
//!
//! With `J` the derivative of place by reference coordinates, `c_k` the columns of its cofactor matrix and `g_k` the
//! derivatives of the displacement by the reference coordinates,
//!
//! ```text
//! ∂u_i/∂x_j = Σ_k g_k[i] c_k[j] / det J,      ∫ σ ∇N_a = Σ_q Σ_k (σ c_k) ∂N_a/∂ξ_k
//! ```
//!
//! (unit weights), so that one division a point is all there is to inverting `J`, and it can be left to the stress.

use pulp::Simd;

use super::lane::Lane;

/// A vector of `D` components.
pub type Vector<S, const D: usize> = [Lane<S>; D];

/// The columns of the cofactor matrix of the matrix with columns `j`, and the determinant.
#[inline(always)]
pub fn cofactors<S: Simd, const D: usize>(
    simd: S,
    j: &[Vector<S, D>; D],
) -> ([Vector<S, D>; D], Lane<S>) {
    let zero = Lane::splat(simd, 0.0);
    let mut c = [[zero; D]; D];
    if D == 2 {
        c[0][0] = j[1][1];
        c[0][1] = zero - j[1][0];
        c[1][0] = zero - j[0][1];
        c[1][1] = j[0][0];
    } else {
        for k in 0..D {
            let (p, q) = (&j[(k + 1) % D], &j[(k + 2) % D]);
            for i in 0..D {
                let (m, n) = ((i + 1) % D, (i + 2) % D);
                c[k][i] = p[n].times_from(q[m], p[m] * q[n]);
            }
        }
    }
    let mut determinant = j[0][0] * c[0][0];
    for i in 1..D {
        determinant = j[0][i].times_plus(c[0][i], determinant);
    }
    (c, determinant)
}

/// The strain `Σ_k sym(g_k ⊗ c_k)` with engineering shear strains, `V = 2 D` components xx yy zz xy (yz xz); in the
/// plane zz is zero.
#[inline(always)]
pub fn strain<S: Simd, const D: usize, const V: usize, const M: usize>(
    simd: S,
    g: &[Vector<S, D>; M],
    c: &[Vector<S, D>; M],
) -> [Lane<S>; V] {
    let mut e = [Lane::splat(simd, 0.0); V];
    for i in 0..D {
        e[i] = g[0][i] * c[0][i];
        for k in 1..M {
            e[i] = g[k][i].times_plus(c[k][i], e[i]);
        }
    }
    for (v, i, j) in [(3, 0, 1), (4, 1, 2), (5, 0, 2)] {
        if v < V {
            e[v] = g[0][j].times_plus(c[0][i], g[0][i] * c[0][j]);
            for k in 1..M {
                e[v] = g[k][i].times_plus(c[k][j], e[v]);
                e[v] = g[k][j].times_plus(c[k][i], e[v]);
            }
        }
    }
    e
}

/// The Voigt index of the tensor component `(i, j)`, as [`VOIGT`](crate::material::VOIGT).
const VOIGT: [[usize; 3]; 3] = crate::material::VOIGT;

/// `sum + σ c`.
#[inline(always)]
pub fn traction<S: Simd, const D: usize, const V: usize>(
    stress: &[Lane<S>; V],
    c: &Vector<S, D>,
    sum: &Vector<S, D>,
) -> Vector<S, D> {
    let mut t = *sum;
    for i in 0..D {
        for j in 0..D {
            t[i] = stress[VOIGT[i][j]].times_plus(c[j], t[i]);
        }
    }
    t
}

/// The sum of the first three components.
#[inline(always)]
pub fn trace<S: Simd, const V: usize>(v: &[Lane<S>; V]) -> Lane<S> {
    v[0] + v[1] + v[2]
}

/// Adds to the first three components.
#[inline(always)]
pub fn shift<S: Simd, const V: usize>(v: &mut [Lane<S>; V], by: Lane<S>) {
    for i in 0..3 {
        v[i] += by;
    }
}

/// Takes the mean off the first three components and returns it.
#[inline(always)]
pub fn take_mean<S: Simd, const V: usize>(simd: S, v: &mut [Lane<S>; V]) -> Lane<S> {
    let mean = trace(v) * Lane::splat(simd, 1.0 / 3.0);
    for i in 0..3 {
        v[i] = v[i] - mean;
    }
    mean
}
