//! What small rotations leave out where bodies touch.
//!
//! A body that turns by the small rotation `θ` about a place `c` moves by `θ × (x - c)`, and misses `½ θ × (θ × (x - c))` of what it should: it grows by half the square of the
//! angle. How much that is beside its own size says nothing of contact. What it makes of the gap does, beside the way by which the bodies have come nearer elastically.

use crate::contact::look::Pressing;
use crate::math::{Vec3, add, cross, dot, scale, sub};
use crate::model::rigid::anchors::Anchors;

/// A body that turns by a small rotation, and where it is held.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Turned {
    /// The rotation `[rad]`.
    pub by: Vec3,
    /// What does not move.
    pub anchors: Anchors,
}

impl Turned {
    /// What is missed at a place, `½ θ × (θ × (x - c))`; in an unconstrained direction of the body it is known but for a constant.
    pub fn missed(&self, x: Vec3) -> Vec3 {
        std::array::from_fn(|c| {
            let arm = sub(x, self.anchors[c].unwrap_or_default());
            0.5 * cross(self.by, cross(self.by, arm))[c]
        })
    }

    fn is_free(&self, c: usize) -> bool {
        self.anchors[c].is_none()
    }
}

/// What is missed of the gap at the points of an interface `[m]`: `sides` are what moves the secondary and the primary at each.
///
/// A body that is unconstrained in a direction goes there until it touches: what its surface misses in the mean is no gap.
pub(crate) fn missed_gaps(points: &[Pressing], sides: &[[Option<&Turned>; 2]]) -> Vec<f64> {
    let mut out = vec![0.0; points.len()];
    for (side, sign) in [(0, 1.0), (1, -1.0)] {
        let missed: Vec<Vec3> = (points.iter().zip(sides))
            .map(|(p, s)| s[side].map_or([0.0; 3], |turned| turned.missed(p.place)))
            .collect();
        let (mut sum, mut force) = ([0.0; 3], 0.0);
        for (p, m) in points.iter().zip(&missed) {
            sum = add(sum, scale(p.force, *m));
            force += p.force;
        }
        for (((out, p), s), m) in out.iter_mut().zip(points).zip(sides).zip(&missed) {
            let Some(turned) = s[side] else {
                continue;
            };
            let mean = |c: usize| match turned.is_free(c) && force > 0.0 {
                true => sum[c] / force,
                false => 0.0,
            };
            let own = sub(*m, [0, 1, 2].map(mean));
            *out += sign * dot(own, p.normal);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pressing(place: Vec3, normal: Vec3) -> Pressing {
        Pressing {
            place,
            normal,
            force: 1.0,
            sides: [Some(0), Some(1)],
        }
    }

    #[test]
    fn a_shaft_on_a_held_axle_grows_by_half_the_square_of_its_turn() {
        let around = (0..8).map(|k| (0.25 * std::f64::consts::PI * f64::from(k)).sin_cos());
        let points: Vec<Pressing> = around
            .map(|(s, c)| pressing([3.0 + 2.0 * c, 2.0 * s, 0.0], [-c, -s, 0.0]))
            .collect();
        let turned = Turned {
            by: [0.0, 0.0, 0.1],
            anchors: [Some([3.0, 0.0, 0.0]); 3],
        };
        // The secondary grows into the bore in the linear theory: the gap should be larger by that.
        for gap in missed_gaps(&points, &[[Some(&turned), None]; 8]) {
            assert!((gap - 0.5 * 0.01 * 2.0).abs() < 1e-14, "{gap}");
        }
    }

    #[test]
    fn what_a_body_can_go_along_with_is_not_missed() {
        let points = [[-1.0, 5.0, 0.0], [1.0, 5.0, 0.0]].map(|x| pressing(x, [0.0, 1.0, 0.0]));
        let mut turned = Turned {
            by: [0.0, 0.0, 0.1],
            anchors: [Some([0.0; 3]); 3],
        };
        let held = missed_gaps(&points, &[[Some(&turned), None]; 2]);
        assert!(
            held.iter().all(|gap| (gap + 0.025).abs() < 1e-14),
            "{held:?}"
        );
        turned.anchors[1] = None;
        let free = missed_gaps(&points, &[[Some(&turned), None]; 2]);
        assert!(free.iter().all(|gap| gap.abs() < 1e-14), "{free:?}");
    }
}
