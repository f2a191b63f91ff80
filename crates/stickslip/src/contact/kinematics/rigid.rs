use super::Stencil;
use crate::contact::obstacle::{Foot, Pose, Shape};
use crate::contact::surface::ContactPoint;
use crate::math::{Mat3, Vec3, add_scaled, cross, dot, mat_vec, normalize, scale, sub};

/// Two unit vectors that make a right-handed frame with the unit vector `n`; in 2D the second points out of the plane.
pub fn tangents(n: Vec3, dim: usize) -> [Vec3; 2] {
    if dim == 2 {
        return [[n[1], -n[0], 0.0], [0.0, 0.0, 1.0]];
    }
    let axis = (0..3).fold(0, |b, i| if n[i].abs() < n[b].abs() { i } else { b });
    let mut e = [0.0; 3];
    e[axis] = 1.0;
    let t = normalize(add_scaled(e, -dot(e, n), n)).unwrap_or(e);
    [t, cross(n, t)]
}

/// Gap and slip of a point over a rigid obstacle. The slip is how far the foot has moved over the obstacle since the last
/// accepted state, measured along two directions that are fixed to the obstacle then; over one increment a curved obstacle
/// turns away from them by the angle slid, which costs the square of that angle in traction.
///
/// Returns the foot now and at the last accepted state in the frame of the obstacle, or `None` at a centre.
pub fn rigid_stencil(
    shape: &dyn Shape,
    (pose, pose_before): (&Pose, &Pose),
    point: &ContactPoint,
    (x, x_before): (Vec3, Vec3),
    dim: usize,
    out: &mut Stencil,
) -> Option<[Foot; 2]> {
    let foot = shape.foot(pose.inward(x))?;
    let anchor = shape.foot(pose_before.inward(x_before))?;
    let n = point.nodes.len() * dim;
    out.reset(n);
    out.gap = foot.gap;
    out.normal = pose.turn(foot.normal);
    let frame = tangents(anchor.normal, dim);
    let moved = sub(foot.point, anchor.point);
    spread(point, out.normal, dim, &mut out.rows[0]);
    for (i, &direction) in frame.iter().enumerate() {
        out.slip[i] = dot(direction, moved);
        out.frame_before[i] = pose_before.turn(direction);
        out.frame[i] = pose.turn(mat_vec(&foot.slope, direction));
        spread(point, out.frame[i], dim, &mut out.rows[i + 1]);
    }
    if dim == 2 {
        out.slip[1] = 0.0;
        out.rows[2].fill(0.0);
    }
    Some([foot, anchor])
}

/// Adds `Σ wᵢ kᵢ` of a rigid stencil, shape `(n, n)`; `false` if there is nothing to add, as over a plane.
#[allow(clippy::too_many_arguments)] // the same data as the stencil's, plus weights and target
pub fn add_rigid_hessian(
    shape: &dyn Shape,
    pose: &Pose,
    point: &ContactPoint,
    x: Vec3,
    feet: &[Foot; 2],
    dim: usize,
    weights: [f64; 3],
    out: &mut [f64],
) -> bool {
    let frame = tangents(feet[1].normal, dim);
    let v = add_scaled(scale(weights[1], frame[0]), weights[2], frame[1]);
    let dd = shape.slope_derivative(pose.inward(x), v);
    let local: Mat3 = std::array::from_fn(|i| {
        std::array::from_fn(|j| weights[0] * feet[0].curvature[i][j] + dd[i][j])
    });
    if local == [[0.0; 3]; 3] {
        return false;
    }
    // H in space: turn local turnᵀ
    let mut h = [[0.0; 3]; 3];
    for j in 0..3 {
        let mut e = [0.0; 3];
        e[j] = 1.0;
        let column = pose.turn(mat_vec(&local, pose.turn_back(e)));
        for i in 0..3 {
            h[i][j] = column[i];
        }
    }
    let n = point.nodes.len() * dim;
    for (k, wk) in point.weights.iter().enumerate() {
        for (l, wl) in point.weights.iter().enumerate() {
            for i in 0..dim {
                for j in 0..dim {
                    out[(k * dim + i) * n + l * dim + j] += wk * wl * h[i][j];
                }
            }
        }
    }
    true
}

fn spread(point: &ContactPoint, v: Vec3, dim: usize, row: &mut [f64]) {
    for (k, w) in point.weights.iter().enumerate() {
        for i in 0..dim {
            row[k * dim + i] += w * v[i];
        }
    }
}
