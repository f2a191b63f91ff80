//! Where a frame is, and rotations by vectors.

use crate::math::{
    Mat3, Vec3, add, add_scaled, cross, dot, identity, mat_vec, norm, normalize, outer, rotation,
    scale, sub, transpose_vec,
};

/// Where a frame is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FramePose {
    /// `R`.
    pub turn: Mat3,
    /// `c` `[m]`.
    pub centre: Vec3,
    /// `c + q` `[m]`.
    pub now: Vec3,
    /// The spin that goes with a change of `θ`, column by column.
    pub(super) spin: Mat3,
}

impl FramePose {
    /// Of a frame that stands still, turned about the place `centre`, which is at `now` in space.
    pub fn still(turn: Mat3, centre: Vec3, now: Vec3) -> Self {
        FramePose {
            turn,
            centre,
            now,
            spin: [[0.0; 3]; 3],
        }
    }

    /// The same with places counted from there.
    #[must_use]
    pub fn counted_from(self, origin: Vec3) -> Self {
        FramePose {
            centre: sub(self.centre, origin),
            now: sub(self.now, origin),
            ..self
        }
    }

    /// Turns a symmetric tensor, xx yy zz xy yz xz, from the axes of the frame to those of space.
    pub fn turn_tensor(&self, tensor: &mut [f64]) {
        let [xx, yy, zz, xy, yz, xz] = [0, 1, 2, 3, 4, 5].map(|k| tensor[k]);
        let inner = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
        // Row i of R A; A is symmetric.
        let half = self.turn.map(|row| mat_vec(&inner, row));
        let at = |i: usize, j: usize| dot(half[i], self.turn[j]);
        let turned = [at(0, 0), at(1, 1), at(2, 2), at(0, 1), at(1, 2), at(0, 2)];
        tensor.copy_from_slice(&turned);
    }

    /// Where the point at `x` at first is in space with this displacement in the frame.
    pub fn place(&self, x: Vec3, w: Vec3) -> Vec3 {
        let arm = add(sub(x, self.centre), w);
        add(self.now, mat_vec(&self.turn, arm))
    }

    /// The displacement in the frame of what is at a place in space.
    pub fn displacement(&self, x: Vec3, place: Vec3) -> Vec3 {
        let arm = transpose_vec(&self.turn, sub(place, self.now));
        sub(arm, sub(x, self.centre))
    }
}

pub(super) fn product(a: &Mat3, b: &Mat3) -> Mat3 {
    let columns = [0, 1, 2].map(|j| mat_vec(a, b.map(|row| row[j])));
    std::array::from_fn(|i| columns.map(|column| column[i]))
}

/// The rotation of a rotation vector, by Rodrigues' formula, and the matrix `T` of its spin: `δR Rᵀ = [T δθ]×`,
/// `T = a 1 + b [θ]× + c θ θᵀ` with `a = sin φ / φ`, `b = (1 - cos φ) / φ²`, `c = (1 - a) / φ²`.
pub(super) fn exponential(theta: Vec3) -> (Mat3, Mat3) {
    let angle = norm(theta);
    if angle == 0.0 {
        return (identity(), identity());
    }
    let turn = rotation(scale(1.0 / angle, theta), angle);
    let square = angle * angle;
    let a = angle.sin() / angle;
    // Below this angle series are as good as the functions they are of.
    let (b, c) = if angle < 1e-4 {
        (0.5 - square / 24.0, 1.0 / 6.0 - square / 120.0)
    } else {
        ((1.0 - angle.cos()) / square, (1.0 - a) / square)
    };
    let dyad = outer(theta, theta);
    let unit = identity();
    let spin = std::array::from_fn(|i| {
        let turned = cross(theta, unit[i]);
        // Row i of [θ]× is -θ × e_i.
        add(add_scaled(scale(a, unit[i]), -b, turned), scale(c, dyad[i]))
    });
    (turn, spin)
}

/// The rotation vector of a rotation, at most half a revolution long.
pub fn rotation_vector(turn: &Mat3) -> Vec3 {
    let axial = [
        turn[2][1] - turn[1][2],
        turn[0][2] - turn[2][0],
        turn[1][0] - turn[0][1],
    ];
    let axial = scale(0.5, axial);
    let (sine, cosine) = (
        norm(axial),
        0.5 * (turn[0][0] + turn[1][1] + turn[2][2] - 1.0),
    );
    let angle = sine.atan2(cosine);
    if sine > 1e-6 {
        return scale(angle / sine, axial);
    }
    if cosine > 0.0 {
        return axial;
    }
    // Half a revolution: R = 2 n nᵀ - 1.
    let longest = (0..3)
        .max_by(|&a, &b| turn[a][a].total_cmp(&turn[b][b]))
        .unwrap_or(0);
    let column: Vec3 =
        std::array::from_fn(|i| 0.5 * (turn[i][longest] + if i == longest { 1.0 } else { 0.0 }));
    scale(angle / norm(column).max(f64::MIN_POSITIVE), column)
}

/// The same with as many revolutions as bring it next to another rotation vector.
pub(super) fn rotation_vector_near(turn: &Mat3, other: Vec3) -> Vec3 {
    let least = rotation_vector(turn);
    let angle = norm(least);
    let Some(axis) = normalize(least).or_else(|| normalize(other)) else {
        return least;
    };
    let whole = 2.0 * std::f64::consts::PI;
    let turns = ((dot(other, axis) - angle) / whole).round();
    scale(angle + turns * whole, axis)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::distance;

    const AXIS: Vec3 = [2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0];

    #[test]
    fn a_rotation_vector_gives_its_rotation() {
        for angle in [0.0, 1e-9, 0.3, 2.0, 3.1, std::f64::consts::PI] {
            let found = rotation_vector(&rotation(AXIS, angle));
            let sign = if found[0] < 0.0 { -1.0 } else { 1.0 };
            let expected = scale(sign * angle, AXIS);
            assert!(distance(found, expected) < 1e-8, "{angle}: {found:?}");
        }
    }

    #[test]
    fn revolutions_are_counted_from_a_rotation_near() {
        for angle in [0.1, 3.0, 3.3, 6.2, 6.4, -9.7, 40.0] {
            let near = scale(angle + 0.2, AXIS);
            let found = rotation_vector_near(&rotation(AXIS, angle), near);
            assert!(
                distance(found, scale(angle, AXIS)) < 1e-8,
                "{angle}: {found:?}"
            );
        }
    }
}
