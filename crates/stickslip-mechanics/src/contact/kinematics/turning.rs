//! How a patch of a surface has turned since the last accepted state, and the slip of what lies on it.

use super::rigid::{carried_over, tangents};
use crate::math::{
    Mat3, Vec3, add, add_scaled, cross, dot, identity, mat_vec, norm, normalize, rotation, scale,
    sub, symmetric_eigen, transpose_vec,
};

/// A facet of a patch: its corners, in order, and its weight.
pub type Part<'a> = (&'a [usize], f64);

/// The rotation of a patch from `before` to `x`: that of its mean normal, and the spin about it that turns its edges best. Exact if the
/// patch moves as a rigid one, whatever the angle, and the same for any numbering.
pub fn rotation_of<'a>(
    parts: impl Iterator<Item = Part<'a>> + Clone,
    x: &[Vec3],
    before: &[Vec3],
    dim: usize,
) -> Mat3 {
    let axis = |at: &[Vec3]| match dim {
        2 => Some([0.0, 0.0, 1.0]),
        _ => normalize(parts.clone().fold([0.0; 3], |sum, (nodes, w)| {
            add_scaled(sum, w, area_vector(nodes, at))
        })),
    };
    let (Some(from), Some(to)) = (axis(before), axis(x)) else {
        return identity();
    };
    let tilt = tilt(from, to);
    let (mut sine, mut cosine) = (0.0, 0.0);
    for (nodes, w) in parts.clone() {
        let (a, b) = (centre(nodes, before), centre(nodes, x));
        for &node in nodes {
            let turned = mat_vec(&tilt, sub(before[node], a));
            let now = sub(x[node], b);
            sine += w * dot(to, cross(turned, now));
            cosine += w * (dot(turned, now) - dot(turned, to) * dot(now, to));
        }
    }
    // rows of spin · tilt
    rotation(to, sine.atan2(cosine)).map(|row| transpose_vec(&tilt, row))
}

/// The rotation that takes nodes from `before` to `x` best, by least squares; a node counts as often as it is named. Exact if they move as a rigid body.
///
/// In the plane its tangent is known; in space it is the quaternion that belongs to the largest eigenvalue of a symmetric matrix
/// ([`horn_1987`](stickslip_base::references::horn_1987)), which is one for nodes in a plane too, and whatever the angle.
pub fn of_points(
    nodes: impl Iterator<Item = usize> + Clone,
    x: &[Vec3],
    before: &[Vec3],
    dim: usize,
) -> Mat3 {
    let (mut from, mut to, mut count) = ([0.0; 3], [0.0; 3], 0.0);
    for n in nodes.clone() {
        (from, to) = (add(from, before[n]), add(to, x[n]));
        count += 1.0;
    }
    let part = 1.0 / f64::max(count, 1.0);
    let (from, to) = (scale(part, from), scale(part, to));
    // s[i][j] = Σ of component i before times component j now
    let mut s = [[0.0; 3]; 3];
    for n in nodes {
        let (a, b) = (sub(before[n], from), sub(x[n], to));
        for (row, a) in s.iter_mut().zip(a) {
            *row = add_scaled(*row, a, b);
        }
    }
    if dim == 2 {
        let angle = (s[0][1] - s[1][0]).atan2(s[0][0] + s[1][1]);
        return rotation([0.0, 0.0, 1.0], angle);
    }
    let twist = [s[1][2] - s[2][1], s[2][0] - s[0][2], s[0][1] - s[1][0]];
    let trace = s[0][0] + s[1][1] + s[2][2];
    let mut matrix = vec![vec![0.0; 4]; 4];
    matrix[0][0] = trace;
    for i in 0..3 {
        matrix[0][i + 1] = twist[i];
        matrix[i + 1][0] = twist[i];
        for j in 0..3 {
            matrix[i + 1][j + 1] = s[i][j] + s[j][i] - if i == j { trace } else { 0.0 };
        }
    }
    let (_, vectors) = symmetric_eigen(&matrix);
    let vector = [1, 2, 3].map(|i| vectors[i][3]);
    let sine = norm(vector);
    match normalize(vector) {
        Some(axis) => rotation(axis, 2.0 * sine.atan2(vectors[0][3])),
        None => identity(),
    }
}

/// A rotation that takes the unit vector `from` to `to`: the least one, or half a turn about a line across and the least one from there, where half a turn
/// has no direction of its own.
fn tilt(from: Vec3, to: Vec3) -> Mat3 {
    let over = dot(from, to) < -0.5;
    let across = tangents(from, 3)[0];
    let column = |c: usize| {
        let mut v = [0.0; 3];
        v[c] = 1.0;
        match over {
            true => {
                let half = add_scaled(scale(-1.0, v), 2.0 * dot(v, across), across);
                tilted(half, scale(-1.0, from), to)
            }
            false => tilted(v, from, to),
        }
    };
    let columns = [column(0), column(1), column(2)];
    std::array::from_fn(|i| std::array::from_fn(|j| columns[j][i]))
}

/// `v` turned by the least rotation that takes the unit vector `from` to `to`.
fn tilted(v: Vec3, from: Vec3, to: Vec3) -> Vec3 {
    let along = dot(v, from);
    add_scaled(
        carried_over(add_scaled(v, -along, from), from, to),
        along,
        to,
    )
}

fn centre(nodes: &[usize], x: &[Vec3]) -> Vec3 {
    let sum = nodes.iter().fold([0.0; 3], |s, &n| add(s, x[n]));
    scale(1.0 / nodes.len() as f64, sum)
}

fn area_vector(nodes: &[usize], x: &[Vec3]) -> Vec3 {
    let origin = x[nodes[0]];
    let arms = nodes.iter().map(|&n| sub(x[n], origin));
    let pairs = arms.clone().zip(arms.skip(1));
    pairs.fold([0.0; 3], |s, (a, b)| add(s, cross(a, b)))
}

/// The rotation vector of `a bᵀ`, for a turn of less than a half.
fn logarithm(a: &Mat3, b: &Mat3) -> Vec3 {
    let r = |i: usize, j: usize| dot(a[i], b[j]);
    let twice = [r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1)];
    let sine = 0.5 * dot(twice, twice).sqrt();
    let angle = sine.atan2(0.5 * (r(0, 0) + r(1, 1) + r(2, 2) - 1.0));
    let factor = if sine > 1e-8 { 0.5 * angle / sine } else { 0.5 };
    scale(factor, twice)
}

/// The way of a point over a surface `[m]` that turns under it: seen by the point, which turns by `own`, the surface has turned by `other` and what lies
/// under the point now has come by `-moved`.
///
/// That is a motion with one velocity about one axis. The velocity of what moves past under the point is
/// `v = d + φ × d / 2 + k φ × (φ × d)` with the relative rotation vector `φ` and `k = (1 - θ/2 cot θ/2) / θ²`, so that the way has the length of the
/// arc and the direction in which it ends. Two that turn alike have `φ = 0`.
pub(super) fn slid(moved: Vec3, own: &Mat3, other: &Mat3) -> Vec3 {
    let phi = logarithm(other, own);
    let square = dot(phi, phi);
    let half = 0.5 * square.sqrt();
    let k = if half < 1e-3 {
        (1.0 + square / 60.0) / 12.0
    } else {
        (1.0 - half / half.tan()) / square
    };
    let turned = cross(phi, moved);
    add_scaled(add_scaled(moved, 0.5, turned), k, cross(phi, turned))
}

/// `mᵀ v` for a rotation: back to the last accepted state.
pub(super) fn back(m: &Mat3, v: Vec3) -> Vec3 {
    transpose_vec(m, v)
}

/// `m v - v`
pub(super) fn swung(m: &Mat3, v: Vec3) -> Vec3 {
    sub(mat_vec(m, v), v)
}

/// `(a bᵀ - 1) v`
pub(super) fn swung_apart(a: &Mat3, b: &Mat3, v: Vec3) -> Vec3 {
    sub(mat_vec(a, back(b, v)), v)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two faces of a patch, bent against each other.
    const PATCH: [Vec3; 6] = [
        [0.0, 0.0, 0.0],
        [1.0, 0.1, 0.0],
        [1.1, 1.0, 0.1],
        [0.0, 0.9, 0.0],
        [2.0, 0.0, 0.3],
        [2.1, 1.0, 0.4],
    ];

    fn parts() -> impl Iterator<Item = Part<'static>> + Clone {
        [(&[0, 1, 2, 3][..], 1.0), (&[1, 4, 5, 2][..], 0.4)].into_iter()
    }

    #[test]
    fn a_rigid_patch_has_turned_by_its_rotation() {
        for angle in [1e-9, 0.01, 1.0, 2.5, 3.1, std::f64::consts::PI] {
            let turn = rotation([0.48, 0.6, 0.64], angle);
            let moved = |x: &Vec3| add(mat_vec(&turn, *x), [3.0, -1.0, 0.5]);
            let now: Vec<Vec3> = PATCH.iter().map(moved).collect();
            let found = rotation_of(parts(), &now, &PATCH, 3);
            for (a, b) in found.iter().zip(&turn) {
                assert!(norm(sub(*a, *b)) < 1e-14, "{angle}");
            }
        }
    }

    #[test]
    fn rigid_points_have_turned_by_their_rotation() {
        for angle in [0.0, 1e-9, 0.01, 1.0, 2.5, std::f64::consts::PI] {
            let turn = rotation([0.48, 0.6, 0.64], angle);
            let plane = rotation([0.0, 0.0, 1.0], angle);
            for (dim, turn) in [(3, turn), (2, plane)] {
                // flat ones first
                for count in [4, 6] {
                    let mut before = PATCH[..count].to_vec();
                    before[2][2] = 0.0;
                    let moved = |x: &Vec3| add(mat_vec(&turn, *x), [3.0, -1.0, 0.5]);
                    let now: Vec<Vec3> = before.iter().map(moved).collect();
                    let found = of_points(0..count, &now, &before, dim);
                    for (a, b) in found.iter().zip(&turn) {
                        assert!(norm(sub(*a, *b)) < 1e-14, "{dim}D {angle}: {a:?} {b:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_line_in_the_plane_may_turn_by_any_angle() {
        let before = [[0.0, 0.0, 0.0], [1.0, 0.2, 0.0]];
        for angle in [1e-9, 0.3, -3.0] {
            let turn = rotation([0.0, 0.0, 1.0], angle);
            let now = before.map(|x| mat_vec(&turn, x));
            let line = [(&[0, 1][..], 1.0)];
            let found = rotation_of(line.into_iter(), &now, &before, 2);
            for (a, b) in found.iter().zip(&turn) {
                assert!(norm(sub(*a, *b)) < 1e-15, "{angle}");
            }
        }
    }

    #[test]
    fn what_turns_under_a_point_goes_by_along_an_arc() {
        let axis = [0.6, 0.0, 0.8];
        let arm = [0.3, -0.4, 0.5];
        for angle in [1e-7, 0.01, 0.5, 2.0] {
            let other = rotation(axis, angle);
            // what lies under the point was at Rᵀ r before: the point has moved over it by the opposite of its way
            let moved = scale(-1.0, sub(arm, back(&other, arm)));
            let way = slid(moved, &crate::math::identity(), &other);
            let exact = scale(-angle, cross(axis, arm));
            assert!(
                norm(sub(way, exact)) < 1e-14 * (1.0 + 1e8 * angle.min(1e-8)),
                "{angle}"
            );
            // the same seen by one who turns
            let own = rotation([0.0, 1.0, 0.0], 0.7);
            let both = product(&other, &own);
            assert!(norm(sub(slid(moved, &own, &both), way)) < 1e-13);
            assert!(norm(sub(slid(moved, &own, &own), moved)) < 1e-15);
        }
    }

    fn product(a: &Mat3, b: &Mat3) -> Mat3 {
        std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
    }
}
