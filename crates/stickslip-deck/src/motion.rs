//! Where parts and local systems of coordinates are put.

use stickslip::math::{Vec3, add, cross, dot, normalize, scale, sub};

use crate::axes::sine_and_cosine;

/// A rotation followed by a translation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Motion {
    /// Rows of the matrix.
    turn: [Vec3; 3],
    shift: Vec3,
}

impl Motion {
    /// Nothing moves.
    pub const NONE: Motion = Motion {
        turn: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        shift: [0.0; 3],
    };

    /// A translation.
    pub fn by(shift: Vec3) -> Self {
        Motion {
            shift,
            ..Motion::NONE
        }
    }

    /// From the coordinates of axes (rows) with this origin to those that the axes are given in.
    pub fn from_axes(axes: [Vec3; 3], origin: Vec3) -> Self {
        Motion {
            turn: std::array::from_fn(|i| std::array::from_fn(|j| axes[j][i])),
            shift: origin,
        }
    }

    /// The same, then a rotation by an angle in degrees about the axis from `a` to `b`; `None` if these are one point.
    pub fn then_turned(self, a: Vec3, b: Vec3, degrees: f64) -> Option<Self> {
        let k = normalize(sub(b, a))?;
        let (s, c) = sine_and_cosine(degrees);
        let about = |v: Vec3| {
            let across = add(scale(c, v), scale(s, cross(k, v)));
            add(across, scale((1.0 - c) * dot(k, v), k))
        };
        // The columns of the matrix are the images of the axes.
        let column = |j: usize| about(std::array::from_fn(|i| self.turn[i][j]));
        let columns = [column(0), column(1), column(2)];
        Some(Motion {
            turn: std::array::from_fn(|i| std::array::from_fn(|j| columns[j][i])),
            shift: add(a, about(sub(self.shift, a))),
        })
    }

    /// A point.
    pub fn point(&self, x: Vec3) -> Vec3 {
        match *self == Motion::NONE {
            // To the last bit, and without negative zeros.
            true => x,
            false => add(self.vector(x), self.shift),
        }
    }

    /// A direction.
    pub fn vector(&self, v: Vec3) -> Vec3 {
        self.turn.map(|row| dot(row, v))
    }

    /// Whether what lies in a plane z = constant stays in one, and keeps its side.
    pub fn in_plane(&self) -> bool {
        let z = self.vector([0.0, 0.0, 1.0]);
        (z[2] - 1.0).abs() < 1e-12
    }
}
