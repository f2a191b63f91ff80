//! Planes of symmetry on which both surfaces of an interface end.
//!
//! What lies beyond such a plane is the mirror image of what is modelled, and has a part in the means around a point on it: in the sum of the normals, in the slip of
//! what lies opposite, in how the faces have turned. With the image the parts across the plane cancel, and the others are those of the half that is there. So nothing
//! has to be mirrored: leaving out what is across the plane is the same.

use crate::math::{Mat3, Vec3, identity, rotation};

/// Components of vectors that a point on planes of symmetry, each across an axis of coordinates, does not have.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Across(pub [bool; 3]);

impl Across {
    /// Whether the point lies on such a plane.
    pub fn any(self) -> bool {
        self.0 != [false; 3]
    }

    /// The part of a vector within the planes.
    pub fn within(self, v: Vec3) -> Vec3 {
        std::array::from_fn(|c| if self.0[c] { 0.0 } else { v[c] })
    }

    /// The axes about which a moment is not cancelled by that of the mirror images: all, the axis across, or none where there are two.
    pub fn axes(self) -> [bool; 3] {
        match self.0.iter().filter(|&&across| across).count() {
            0 => [true; 3],
            1 => self.0,
            _ => [false; 3],
        }
    }

    /// The part of a rotation that leaves the planes where they are: about the axis across, and none where there are two.
    pub fn turn(self, turn: Mat3) -> Mat3 {
        if !self.any() {
            return turn;
        }
        let mut axes = (0..3).filter(|&c| self.0[c]);
        let (Some(c), None) = (axes.next(), axes.next()) else {
            return identity();
        };
        let [i, j] = [(c + 1) % 3, (c + 2) % 3];
        let mut axis = [0.0; 3];
        axis[c] = 1.0;
        rotation(
            axis,
            (turn[j][i] - turn[i][j]).atan2(turn[i][i] + turn[j][j]),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{mat_vec, norm, sub};

    #[test]
    fn of_a_rotation_the_part_about_the_axis_across_is_left() {
        let about_x = rotation([1.0, 0.0, 0.0], 0.7);
        let found = Across([true, false, false]).turn(about_x);
        for (a, b) in found.iter().zip(&about_x) {
            assert!(norm(sub(*a, *b)) < 1e-15);
        }
        let across = Across([false, true, false]);
        let kept = across.turn(rotation([0.0, 0.6, 0.8], 0.3));
        assert!(norm(sub(mat_vec(&kept, [0.0, 1.0, 0.0]), [0.0, 1.0, 0.0])) < 1e-15);
        assert_eq!(Across([true, false, true]).turn(about_x), identity());
        assert_eq!(Across::default().turn(about_x), about_x);
    }

    #[test]
    fn what_is_across_goes_and_the_rest_stays() {
        let across = Across([true, false, false]);
        assert!(across.any() && !Across::default().any());
        assert_eq!(across.axes(), [true, false, false]);
        assert_eq!(Across::default().axes(), [true; 3]);
        assert_eq!(Across([true, false, true]).axes(), [false; 3]);
        assert_eq!(across.within([1.0, 2.0, 3.0]), [0.0, 2.0, 3.0]);
    }
}
