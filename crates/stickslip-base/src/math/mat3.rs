use super::vec3::{Vec3, cross, dot};

/// A 3×3 matrix, row by row.
pub type Mat3 = [[f64; 3]; 3];

/// The unit matrix.
#[inline]
pub fn identity() -> Mat3 {
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
}

/// `m v`
#[inline]
pub fn mat_vec(m: &Mat3, v: Vec3) -> Vec3 {
    [dot(m[0], v), dot(m[1], v), dot(m[2], v)]
}

/// `mᵀ v`
#[inline]
pub fn transpose_vec(m: &Mat3, v: Vec3) -> Vec3 {
    std::array::from_fn(|j| m[0][j] * v[0] + m[1][j] * v[1] + m[2][j] * v[2])
}

/// `a ⊗ b`
#[inline]
pub fn outer(a: Vec3, b: Vec3) -> Mat3 {
    std::array::from_fn(|i| std::array::from_fn(|j| a[i] * b[j]))
}

/// Determinant.
#[inline]
pub fn determinant(m: &Mat3) -> f64 {
    dot(m[0], cross(m[1], m[2]))
}

/// Inverse and determinant; `None` if the determinant is zero or not finite.
#[inline]
pub fn inverse(m: &Mat3) -> Option<(Mat3, f64)> {
    let d = determinant(m);
    if d == 0.0 || !d.is_finite() {
        return None;
    }
    let c0 = cross(m[1], m[2]);
    let c1 = cross(m[2], m[0]);
    let c2 = cross(m[0], m[1]);
    Some((
        std::array::from_fn(|i| [c0[i] / d, c1[i] / d, c2[i] / d]),
        d,
    ))
}

/// Most iterations of the polar decomposition; a handful is enough for all that is not crushed.
const MOST_ITERATIONS: usize = 60;

/// The rotation in the polar decomposition of a matrix, by Newton's method `R ← (R + R⁻ᵀ) / 2`
/// ([`higham_1986`](crate::references::higham_1986)); `None` where it mirrors or is singular.
pub fn polar_rotation(m: &Mat3) -> Option<Mat3> {
    let mut r = *m;
    for _ in 0..MOST_ITERATIONS {
        let (back, determinant) = inverse(&r)?;
        if determinant <= 0.0 {
            return None;
        }
        let next: Mat3 =
            std::array::from_fn(|i| std::array::from_fn(|j| 0.5 * (r[i][j] + back[j][i])));
        let change = next.as_flattened().iter().zip(r.as_flattened());
        let change = change.fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
        r = next;
        // Quadratically: the next change is of the size of rounding.
        if change < 1e-12 {
            break;
        }
    }
    Some(r)
}

/// The rotation by `angle` `[rad]` about the unit vector `axis` (Rodrigues' formula).
pub fn rotation(axis: Vec3, angle: f64) -> Mat3 {
    let (s, c) = angle.sin_cos();
    let skew = [
        [0.0, -axis[2], axis[1]],
        [axis[2], 0.0, -axis[0]],
        [-axis[1], axis[0], 0.0],
    ];
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let unit = if i == j { 1.0 } else { 0.0 };
            c * unit + s * skew[i][j] + (1.0 - c) * axis[i] * axis[j]
        })
    })
}
