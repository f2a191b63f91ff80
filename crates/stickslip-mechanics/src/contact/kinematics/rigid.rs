//! Gap and slip over a rigid obstacle.

use super::dual::{self, Dual, DualVec, follows, vector};
use super::stencil::Stencil;
use crate::contact::obstacle::{Foot, Pose, Shape};
use crate::contact::surface::ContactPoint;
use crate::math::{
    Mat3, Vec3, add, add_scaled, cross, dot, mat_vec, norm, normalize, rotation, scale, sub,
};

/// Two unit vectors that make a right-handed frame with the unit vector `n`; in 2D the second points out of the plane.
pub fn tangents(n: Vec3, dim: usize) -> [Vec3; 2] {
    if dim == 2 {
        return [[n[1], -n[0], 0.0], [0.0, 0.0, 1.0]];
    }
    // The axis after the one nearest to the normal: the least aligned one is another after the smallest turn of a surface that faces an axis.
    let nearest = (0..3).fold(0, |b, i| if n[i].abs() > n[b].abs() { i } else { b });
    let mut e = [0.0; 3];
    e[(nearest + 1) % 3] = 1.0;
    let t = normalize(add_scaled(e, -dot(e, n), n)).unwrap_or(e);
    [t, cross(n, t)]
}

/// One plus the cosine of the angle between normals below which they count as opposite: the least turn between them has no direction.
const OPPOSITE_NORMALS: f64 = 1e-9;

/// A tangent vector where the unit normal is `from`, carried to where it is `to` by the least rotation that turns one normal into the other. It
/// keeps its length and stays tangent. On planes, cylinders and spheres this is parallel transport along the shortest way.
pub fn carried_over(v: Vec3, from: Vec3, to: Vec3) -> Vec3 {
    let c = (1.0 + dot(from, to)).max(OPPOSITE_NORMALS);
    add_scaled(v, -dot(v, to) / c, add(from, to))
}

/// What is known of a point over an obstacle once its stencil is made, in the frame of the obstacle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidFoot {
    /// The foot of the point.
    pub foot: Foot,
    /// The gap at the last accepted state `[m]`.
    pub gap_before: f64,
    /// Derivatives of the two directions of the shear with respect to the point `[1/m]`, row: component.
    pub turning: [Mat3; 2],
}

/// The part of the turn of an obstacle that a point follows, `α` between nothing and the whole turn `[rad]`, and its derivative with respect to the point
/// in the frame of the obstacle.
///
/// It is the angle by which the point itself has moved around the axis. A point at rest sees the surface go by with one velocity, `α = 0`; one that rides
/// on the obstacle sees it at rest, `α` is the whole turn.
fn followed(pose: &Pose, pose_before: &Pose, x: Vec3, x_before: Vec3) -> Dual {
    let turn = pose.turned_since(pose_before);
    if turn == 0.0 {
        return Dual::constant(0.0);
    }
    let (_, axis) = pose.axis();
    let across = |v: Vec3| add_scaled(v, -dot(v, axis), axis);
    let (now, before) = (across(pose.arm(x)), across(pose_before.arm(x_before)));
    let angle = dot(axis, cross(before, now)).atan2(dot(before, now));
    let (least, most) = (turn.min(0.0), turn.max(0.0));
    if angle <= least || angle >= most {
        return Dual::constant(angle.clamp(least, most));
    }
    Dual {
        value: angle,
        slope: pose.turn_back(scale(1.0 / dot(now, now), cross(axis, now))),
    }
}

/// `θ / sin θ` as a function of `cos θ`, and its derivative.
fn arc_over_sine(cosine: f64, sine: f64) -> (f64, f64) {
    let e = 1.0 - cosine;
    if e < 1e-3 {
        return (
            1.0 + e / 3.0 + e * e * (2.0 / 15.0 + e * (2.0 / 35.0 + e * 8.0 / 315.0)),
            -(1.0 / 3.0 + e * (4.0 / 15.0 + e * (6.0 / 35.0 + e * 32.0 / 315.0))),
        );
    }
    let sine = sine.max(OPPOSITE_NORMALS);
    let g = sine.atan2(cosine) / sine;
    (g, (cosine * g - 1.0) / (sine * sine))
}

/// The frame of the shear and the slips with their derivatives, in the frame of the obstacle.
struct Way {
    directions: [DualVec; 2],
    slips: [Dual; 2],
}

/// Where a point was when the increment began, in the frame that the obstacle had then.
struct Start {
    place: Vec3,
    normal: Vec3,
    directions: [Vec3; 2],
    /// The angle by which the obstacle has turned since then, and how much of that the point has gone along.
    turn: f64,
    follow: Dual,
}

/// The way of a point over the obstacle: along the surface to where it is now, after the obstacle has turned under it by `turn - follow`.
///
/// - The turn is seen as the velocity of the surface under the point, times the time: `β S (a × r)`. Over surfaces of revolution about their axis
///   that is the arc, with the direction it has where it ends.
/// - What remains is the shortest way between two feet. With the signed radius `R` and normals `m`, `n` it is, seen from its end,
///   `d - R (n - m) + R θ/sin θ (n cos θ - m)`: the chord `d` less that of the arc, and the arc.
fn way(
    shape: &dyn Shape,
    pose: &Pose,
    y: Vec3,
    foot: &Foot,
    from: &Start,
    dim: usize,
) -> Option<Way> {
    let Start { turn, follow, .. } = *from;
    let (centre, axis) = pose.axis();
    // what `follow` does to what it turns about the axis
    let under = rotation(axis, follow.value - turn);
    let turned = |v: Vec3| {
        let v = mat_vec(&under, v);
        follows(v, cross(axis, v), follow)
    };
    let arm = turned(sub(from.place, centre));
    let start = add(centre, arm.map(|c| c.value));
    let begun = shape.foot(start)?;
    let arm_slope: Mat3 = arm.map(|c| c.slope);
    let through = |m: &Mat3| -> Mat3 { product(m, &arm_slope) };
    let (n, m) = (
        vector(foot.normal, &foot.curvature),
        vector(begun.normal, &through(&begun.curvature)),
    );
    // the directions, carried to the tangent plane of now
    let carrying = turned(from.normal);
    let sum = dual::add(carrying, n);
    let cosine = Dual::constant(1.0) + dual::dot(carrying, n);
    let directions = if cosine.value > OPPOSITE_NORMALS {
        let inverse = cosine.reciprocal();
        from.directions.map(|direction| {
            let v = turned(direction);
            dual::add_scaled(v, -(dual::dot(v, n) * inverse), sum)
        })
    } else {
        tangents(foot.normal, dim).map(|e| e.map(Dual::constant))
    };
    let radius = Dual::constant(shape.radius());
    let cosine = dual::dot(m, n);
    let sine = norm(cross(begun.normal, foot.normal));
    let (g, slope) = arc_over_sine(cosine.value, sine);
    let arc = cosine.chain(g, slope);
    let chord = dual::sub(
        vector(foot.point, &foot.slope),
        vector(begun.point, &through(&begun.slope)),
    );
    // Directions have no part along n.
    let straight = dual::add_scaled(chord, radius, m);
    let gone = dual::add_scaled(straight, -(radius * arc), m);
    // the surface under the point
    let swept = cross(axis, sub(y, centre));
    let sweep = std::array::from_fn(|i| {
        let mut e = [0.0; 3];
        e[i] = 1.0;
        // a × e for each e: the derivative of a × r, row: component
        cross(e, axis)
    });
    let bent = shape.slope_derivative(y, swept);
    let swung = product(&foot.slope, &sweep);
    let surface = vector(
        mat_vec(&foot.slope, swept),
        &std::array::from_fn(|i| add(bent[i], swung[i])),
    );
    let beta = Dual::constant(turn) - follow;
    let total = dual::add_scaled(gone, -beta, surface);
    Some(Way {
        directions,
        slips: directions.map(|e| dual::dot(e, total)),
    })
}

fn product(a: &Mat3, b: &Mat3) -> Mat3 {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

/// An obstacle and a point, now and when the increment began.
#[derive(Debug, Clone, Copy)]
pub struct ObstaclePair<'a> {
    /// Where the obstacle is.
    pub pose: &'a Pose,
    /// Where it was.
    pub pose_before: &'a Pose,
    /// Where the point is.
    pub x: Vec3,
    /// Where it was.
    pub x_before: Vec3,
}

/// Gap and slip of a point over a rigid obstacle. The slip is the length of the way of the foot over the obstacle since the last accepted state, and tractions
/// are turned as they go along it: the directions of the frame are unit vectors of the tangent plane of now, whatever the turn.
///
/// `belt` is the way of the belt that friction sees. Returns what second derivatives need, or `None` at a centre.
pub fn rigid_stencil(
    shape: &dyn Shape,
    over: ObstaclePair,
    point: &ContactPoint,
    belt: Vec3,
    dim: usize,
    out: &mut Stencil,
) -> Option<RigidFoot> {
    let ObstaclePair {
        pose,
        pose_before,
        x,
        x_before,
    } = over;
    let y = pose.inward(x);
    let foot = shape.foot(y)?;
    let place = pose_before.inward(x_before);
    let anchor = shape.foot(place)?;
    let from = Start {
        place,
        normal: anchor.normal,
        directions: tangents(anchor.normal, dim),
        turn: pose.turned_since(pose_before),
        follow: followed(pose, pose_before, x, x_before),
    };
    let way = way(shape, pose, y, &foot, &from, dim)?;
    let n = point.nodes.len() * dim;
    out.reset(n);
    out.gap = foot.gap;
    out.normal = pose.turn(foot.normal);
    out.normal_before = pose_before.turn(anchor.normal);
    spread(point, out.normal, dim, &mut out.rows[0]);
    let belt = pose.turn_back(belt);
    for i in 0..2 {
        let direction = way.directions[i];
        out.slip[i] = way.slips[i].value;
        out.frame_before[i] = pose_before.turn(from.directions[i]);
        out.frame[i] = pose.turn(direction.map(|c| c.value));
        spread(point, out.frame[i], dim, &mut out.rows[i + 1]);
        let turning =
            (direction.iter().zip(belt)).fold([0.0; 3], |s, (c, b)| add_scaled(s, b, c.slope));
        let gradient = pose.turn(sub(way.slips[i].slope, turning));
        out.slip_rows[i].resize(n, 0.0);
        spread(point, gradient, dim, &mut out.slip_rows[i]);
    }
    if dim == 2 {
        out.slip[1] = 0.0;
        out.rows[2].fill(0.0);
        out.slip_rows[1].fill(0.0);
    }
    Some(RigidFoot {
        foot,
        gap_before: anchor.gap,
        turning: way.directions.map(|e| e.map(|c| c.slope)),
    })
}

/// Adds `Σ wᵢ kᵢ` of a rigid stencil, shape `(n, n)`; `false` if there is nothing to add, as over a plane.
pub fn add_rigid_hessian(
    pose: &Pose,
    point: &ContactPoint,
    feet: &RigidFoot,
    dim: usize,
    weights: [f64; 3],
    out: &mut [f64],
) -> bool {
    let local: Mat3 = std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            weights[0] * feet.foot.curvature[i][j]
                + weights[1] * feet.turning[0][i][j]
                + weights[2] * feet.turning[1][i][j]
        })
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

pub(super) fn spread(point: &ContactPoint, v: Vec3, dim: usize, row: &mut [f64]) {
    for (k, w) in point.weights.iter().enumerate() {
        for i in 0..dim {
            row[k * dim + i] += w * v[i];
        }
    }
}
