//! The slip of a point that comes into contact with an obstacle within an increment.
//!
//! While it was away it has not slid. What its foot has gone in the meantime is another way than that of the surface under it, though nothing slips: a wheel of the
//! radius `R` on a drum of the radius `r` that rolls by the angle `φ` brings points there whose feet have gone by `R φ (1 - φ² (1/6 + R/2r + R²/3r²))`. Friction that knew of
//! that way would let the wheel go farther by as much in each increment.
//!
//! So such a point has slipped by how fast it goes over the surface in the end, times the increment, in a motion with one velocity about one axis
//! ([`slid`](super::turning::slid)). Of what rolls nothing is left of that but the part `(R²/r² - 1) φ²/12`: the two turn by different angles.

use super::rigid::{ObstaclePair, RigidFoot, spread};
use super::stencil::Stencil;
use super::turning::{back, slid};
use crate::contact::surface::ContactPoint;
use crate::math::{Mat3, Vec3, add, add_scaled, dot, mat_vec, sub};

/// Replaces the slip of a stencil over an obstacle, and its gradients, by those of a point that was away when the increment began; `own` is the rotation of the faces around
/// the point since then, of whose change with displacements the gradients do not know.
pub fn arriving_slip(
    over: ObstaclePair,
    point: &ContactPoint,
    own: &Mat3,
    feet: &RigidFoot,
    belt: Vec3,
    dim: usize,
    out: &mut Stencil,
) {
    let ObstaclePair {
        pose,
        pose_before,
        x,
        x_before,
    } = over;
    let columns = |of: &dyn Fn(Vec3) -> Vec3| -> [Vec3; 3] {
        [0, 1, 2].map(|j| {
            let mut e = [0.0; 3];
            e[j] = 1.0;
            of(e)
        })
    };
    let turned = columns(&|e| pose.turn(pose_before.turn_back(e)));
    let other: Mat3 = std::array::from_fn(|i| std::array::from_fn(|j| turned[j][i]));
    // What lies under the point in the end, where it is and where it was.
    let under = pose.outward(feet.foot.point);
    let under_before = pose_before.outward(feet.foot.point);
    let apart = mat_vec(own, sub(x_before, under_before));
    let way = slid(sub(sub(x, under), apart), own, &other);
    let along = |v: Vec3| pose.turn(mat_vec(&feet.foot.slope, pose.turn_back(v)));
    // By what it changes with the place of the point, whose foot moves along the surface.
    let changes = columns(&|e| {
        let foot = along(e);
        let carried = mat_vec(own, back(&other, foot));
        slid(add(sub(e, foot), carried), own, &other)
    });
    let seen = pose.turn_back(sub(way, belt));
    for i in 0..dim - 1 {
        out.slip[i] = dot(out.frame[i], way);
        let turning = (feet.turning[i].iter().zip(seen))
            .fold([0.0; 3], |sum, (row, s)| add_scaled(sum, s, *row));
        let gradient = add(changes.map(|c| dot(out.frame[i], c)), pose.turn(turning));
        out.slip_rows[i].fill(0.0);
        spread(point, gradient, dim, &mut out.slip_rows[i]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::kinematics::rigid_stencil;
    use crate::contact::kinematics::tests::single;
    use crate::contact::obstacle::{Cylinder, Motion, ObstacleShape, Rotation};
    use crate::math::{rotation, scale};
    use crate::registry::Family;

    const UP: Vec3 = [0.0, 0.0, 1.0];

    fn turning(centre: Vec3, axis: Vec3, angle: f64) -> Motion {
        Motion {
            translation: vec![vec![0.0; 4], vec![1.0, 0.02, -0.01, 0.03]],
            rotation: Some(Rotation {
                centre: centre.to_vec(),
                axis: Some(axis.to_vec()),
                angle: vec![[0.0, 0.2], [1.0, 0.2 + angle]],
            }),
        }
    }

    /// The slips of the way of the foot and of what arrives, of the lowest point of a wheel on an axle above a drum that both turn without slipping.
    fn rolled(wheel: f64, drum: f64, angle: f64) -> [f64; 2] {
        let shape = ObstacleShape::Cylinder(Cylinder {
            centre: vec![0.0, -drum],
            axis: None,
            radius: drum,
            inside: false,
        });
        let mut motion = turning([0.0, -drum, 0.0], UP, angle * wheel / drum);
        motion.translation.clear();
        let poses = [motion.pose(1.0), motion.pose(0.0)];
        let own = rotation(UP, -angle);
        let hub = [0.0, wheel, 0.0];
        let x_before = add(hub, back(&own, scale(-1.0, hub)));
        let mut s = Stencil::default();
        let over = ObstaclePair {
            pose: &poses[0],
            pose_before: &poses[1],
            x: [0.0; 3],
            x_before,
        };
        let feet = rigid_stencil(shape.as_dyn(), over, &single(), [0.0; 3], 2, &mut s);
        let feet = feet.expect("a foot");
        let way = s.slip[0];
        arriving_slip(over, &single(), &own, &feet, [0.0; 3], 2, &mut s);
        [way, s.slip[0]].map(|slip| slip / (wheel * angle))
    }

    #[test]
    fn what_rolls_arrives_without_slip() {
        for (wheel, drum) in [(0.1, 0.05), (0.05, 0.1), (1.0, 1e6)] {
            for angle in [0.02, 0.06, 0.12] {
                let [way, arrived] = rolled(wheel, drum, angle);
                let ratio = wheel / drum;
                // As the foot of what comes nearer goes, and as two do of which one turns by more than the other.
                let gone = (1.0 / 6.0 + ratio / 2.0 + ratio * ratio / 3.0) * angle * angle;
                let turned = (ratio * ratio - 1.0) * angle * angle / 12.0;
                assert!(
                    (way.abs() / gone - 1.0).abs() < 0.2,
                    "{ratio} {angle}: {way} {gone}"
                );
                assert!(
                    (arrived / turned - 1.0).abs() < 0.01,
                    "{ratio} {angle}: {arrived} {turned}"
                );
            }
        }
    }

    #[test]
    fn gradients_agree_with_differences_and_what_moves_with_the_obstacle_has_none() {
        let axis = scale(1.0 / 1.13_f64.sqrt(), [0.3, 0.2, 1.0]);
        for shape in ObstacleShape::samples() {
            for angle in [0.0, 0.3, -1.0] {
                let motion = turning([0.05, -0.02, 0.01], axis, angle);
                let poses = [motion.pose(1.0), motion.pose(0.0)];
                let own = rotation([0.48, 0.6, 0.64], 0.2);
                let before = [0.3, -0.21, 0.16];
                let belt = [0.05, -0.03, 0.02];
                let at = |x: Vec3, own: &Mat3| {
                    let mut s = Stencil::default();
                    let over = ObstaclePair {
                        pose: &poses[0],
                        pose_before: &poses[1],
                        x,
                        x_before: before,
                    };
                    let feet = rigid_stencil(shape.as_dyn(), over, &single(), belt, 3, &mut s);
                    let feet = feet.expect("a foot");
                    arriving_slip(over, &single(), own, &feet, belt, 3, &mut s);
                    s
                };
                let x = [0.31, -0.22, 0.17];
                let s = at(x, &own);
                for l in 0..3 {
                    let moved = |h: f64| {
                        let mut y = x;
                        y[l] += h;
                        at(y, &own)
                    };
                    let (a, b) = (moved(-1e-6), moved(1e-6));
                    for i in 0..2 {
                        let seen = |s: &Stencil| s.slip[i] - dot(s.frame[i], belt);
                        let difference = (seen(&b) - seen(&a)) / 2e-6;
                        assert!(
                            (difference - s.slip_rows[i][l]).abs() < 1e-8,
                            "{shape:?} {angle}: {difference} {}",
                            s.slip_rows[i][l]
                        );
                    }
                }
                let [now, then] = poses;
                let carried = now.outward(then.inward(before));
                let turn = rotation(axis, angle);
                let still = at(carried, &turn);
                assert!(
                    still.slip.iter().all(|s| s.abs() < 1e-14),
                    "{:?}",
                    still.slip
                );
            }
        }
    }
}
