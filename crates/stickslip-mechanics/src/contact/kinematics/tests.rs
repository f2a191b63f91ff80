//! The identities of a contact element (VERIFICATION B3), for every kinematics and facet kind.

use super::rigid::tangents;
use super::*;
use crate::contact::facet_point::{FacetPoint, evaluate};
use crate::contact::obstacle::{Motion, ObstacleShape};
use crate::contact::projection::Patch;
use crate::contact::surface::ContactPoint;
use crate::math::{
    Vec3, add, add_scaled, cross, dot, mat_vec, norm, normalize, rotation, scale, sub,
};
use crate::registry::Family;
use crate::shape::ElementKind;

fn project(kind: ElementKind, nodes: &[Vec3], point: Vec3) -> Option<FacetPoint> {
    let foot = Patch::new(kind, nodes).project(point)?;
    Some(evaluate(kind, nodes, foot.xi))
}

/// A small deterministic generator of numbers in [-1, 1], so that tests repeat.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self, dim: usize, size: f64) -> Vec3 {
        let mut v = [0.0; 3];
        for c in v.iter_mut().take(dim) {
            *c = size * self.next();
        }
        v
    }
}

/// Way of a belt.
const BELT: Vec3 = [0.05, -0.03, 0.02];

struct Case {
    kind: ElementKind,
    dim: usize,
    weights: Vec<f64>,
    before: Vec<Vec3>,
    now: Vec<Vec3>,
}

impl Case {
    /// Secondary nodes over a distorted facet, committed and moved.
    fn new(kind: ElementKind, seed: u64) -> Self {
        let mut r = Numbers(seed);
        let dim = kind.dim() + 1;
        let weights = if seed.is_multiple_of(2) {
            vec![1.0]
        } else {
            vec![0.3, 0.7]
        };
        let mut facet: Vec<Vec3> = kind
            .reference()
            .nodes()
            .iter()
            .map(|x| if dim == 2 { [-x[0], 0.0, 0.0] } else { *x })
            .collect();
        for x in &mut facet {
            *x = add(*x, r.vector(dim, 0.06));
        }
        let centre = kind.centre();
        let at = if dim == 2 {
            [0.1, 0.07, 0.0]
        } else {
            add(centre, [0.1, -0.05, 0.07])
        };
        let mut before: Vec<Vec3> = weights
            .iter()
            .map(|_| add(at, r.vector(dim, 0.03)))
            .collect();
        before.extend(facet);
        let now = before
            .iter()
            .map(|x| add(*x, r.vector(dim, 0.04)))
            .collect();
        Case {
            kind,
            dim,
            weights,
            before,
            now,
        }
    }

    fn point(&self, x: &[Vec3]) -> Vec3 {
        self.weights
            .iter()
            .zip(x)
            .fold([0.0; 3], |s, (&w, &x)| add_scaled(s, w, x))
    }

    fn with<T>(
        &self,
        now: &[Vec3],
        model: &KinematicsModel,
        f: impl FnOnce(&Pair, &Stencil) -> T,
    ) -> T {
        let s = self.weights.len();
        let kinematics = model.as_dyn();
        let (mut point, mut point_before) = (self.point(now), self.point(&self.before));
        let anchor = project(self.kind, &self.before[s..], point_before).expect("near the facet");
        let foot = if kinematics.frozen() {
            let place = |x: &[Vec3]| {
                x[s..]
                    .iter()
                    .zip(&anchor.n)
                    .fold([0.0; 3], |sum, (&x, &n)| add_scaled(sum, n, x))
            };
            point = add(anchor.x, sub(point, place(now)));
            point_before = add(anchor.x, sub(point_before, place(&self.before)));
            anchor
        } else {
            project(self.kind, &now[s..], point).expect("near the facet")
        };
        let pair = Pair {
            dim: self.dim,
            weights: &self.weights,
            point,
            kind: self.kind,
            facet: &now[s..],
            foot: &foot,
            anchor: &anchor,
            point_before,
            belt: BELT,
        };
        let mut stencil = Stencil::default();
        kinematics.stencil(&pair, &mut stencil);
        f(&pair, &stencil)
    }

    fn perturbed(&self, dof: usize, h: f64) -> Vec<Vec3> {
        let mut x = self.now.clone();
        x[dof / self.dim][dof % self.dim] += h;
        x
    }
}

fn cases(model: &KinematicsModel) -> Vec<Case> {
    use ElementKind::*;
    let kinds: &[ElementKind] = if model.as_dyn().triangles() {
        &[Line2, Tri3]
    } else {
        &[Line2, Line3, Tri3, Tri6, Quad4, Quad8]
    };
    let seeds = [2, 3, 8, 13];
    kinds
        .iter()
        .flat_map(|&k| seeds.map(|seed| Case::new(k, seed)))
        .collect()
}

#[test]
fn gradients_and_hessians_agree_with_differences() {
    for model in KinematicsModel::samples() {
        for case in cases(&model) {
            let what = format!("{} on {}", model.kind(), case.kind);
            let weights = [0.7, -0.4, 0.9];
            let (stencil, hessian, symmetric) = case.with(&case.now, &model, |pair, s| {
                let [all, normal] = [weights, [1.0, 0.0, 0.0]].map(|weights| {
                    let mut h = vec![0.0; s.n * s.n];
                    model.as_dyn().add_hessian(pair, weights, &mut h);
                    h
                });
                (s.clone(), all, normal)
            });
            let n = stencil.n;
            let combined =
                |s: &Stencil, k: usize| -> f64 { (0..3).map(|q| weights[q] * s.rows[q][k]).sum() };
            let h = 1e-5;
            for l in 0..n {
                let [a, b] =
                    [-h, h].map(|h| case.with(&case.perturbed(l, h), &model, |_, s| s.clone()));
                let d = |a: f64, b: f64| (b - a) / (2.0 * h);
                assert!(
                    (d(a.gap, b.gap) - stencil.rows[0][l]).abs() < 1e-8,
                    "{what} gap {l}"
                );
                for i in 0..2 {
                    // friction sees the slip less the way of the belt along the frame
                    let seen = |s: &Stencil| s.slip[i] - dot(s.frame[i], BELT);
                    let row = match stencil.slip_rows[i].as_slice() {
                        [] => stencil.rows[i + 1][l],
                        row => row[l],
                    };
                    let paper = model.as_dyn().triangles();
                    let difference = match paper {
                        true => d(a.slip[i], b.slip[i]),
                        false => d(seen(&a), seen(&b)),
                    };
                    assert!((difference - row).abs() < 1e-8, "{what} slip {i} {l}");
                }
                if !stencil.skew_row.is_empty() {
                    assert!(
                        (d(a.skew, b.skew) - stencil.skew_row[l]).abs() < 1e-8,
                        "{what} skew"
                    );
                }
                for k in 0..n {
                    let value = hessian[k * n + l];
                    let difference = d(combined(&a, k), combined(&b, k));
                    assert!(
                        (difference - value).abs() < 2e-7,
                        "{what} {k} {l}: {value} {difference}"
                    );
                    assert!(
                        (symmetric[k * n + l] - symmetric[l * n + k]).abs() < 1e-11,
                        "{what} is symmetric along the normal"
                    );
                }
            }
        }
    }
}

#[test]
fn forces_and_moments_balance() {
    for model in KinematicsModel::samples() {
        for case in cases(&model) {
            // small sliding balances moments only where nothing has moved
            let frozen = model.as_dyn().frozen();
            let x = if frozen { &case.before } else { &case.now };
            let rows = case.with(x, &model, |_, s| s.rows.clone());
            for (q, row) in rows.iter().enumerate() {
                let mut force = [0.0; 3];
                let mut moment = [0.0; 3];
                for (node, &x) in x.iter().enumerate() {
                    let mut f = [0.0; 3];
                    f[..case.dim].copy_from_slice(&row[node * case.dim..(node + 1) * case.dim]);
                    force = add(force, f);
                    moment = add(moment, cross(x, f));
                }
                let what = format!("{} on {} row {q}", model.kind(), case.kind);
                assert!(norm(force) < 1e-13, "{what}: force {force:?}");
                if !(frozen && q > 0) {
                    assert!(norm(moment) < 1e-12, "{what}: moment {moment:?}");
                }
            }
        }
    }
}

#[test]
fn a_rigid_motion_makes_no_slip() {
    let turn = rotation([0.0, 0.0, 1.0], 0.7);
    for model in KinematicsModel::samples()
        .iter()
        .filter(|m| !m.as_dyn().frozen())
    {
        for case in cases(model) {
            let moved: Vec<Vec3> = case
                .before
                .iter()
                .map(|&x| add(mat_vec(&turn, x), [0.3, -0.2, 0.0]))
                .collect();
            let at = |x: &[Vec3]| case.with(x, model, |_, s| (s.gap, s.slip));
            let ((g0, _), (g, slip)) = (at(&case.before), at(&moved));
            assert!((g - g0).abs() < 1e-13, "{} on {}", model.kind(), case.kind);
            assert!(
                slip[0].hypot(slip[1]) < 1e-13,
                "{} on {}",
                model.kind(),
                case.kind
            );
        }
    }
}

/// A point glued to a facet that strains in its plane: no slip in convective coordinates; the paper's gaps slip in 3D when the
/// facet shears (THEORY A6, item 14).
#[test]
fn a_straining_facet_makes_no_slip_but_in_the_papers_kinematics() {
    let triangle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let place = [0.3, 0.25, 0.0];
    let shear = |g: f64| move |x: Vec3| [x[0] + g * x[1], x[1], 0.0];
    let slip = |model: &KinematicsModel, g: f64| {
        let mut before = vec![place];
        before.extend(triangle);
        let now = before.iter().map(|&x| shear(g)(x)).collect();
        let case = Case {
            kind: ElementKind::Tri3,
            dim: 3,
            weights: vec![1.0],
            before,
            now,
        };
        case.with(&case.now, model, |_, s| s.slip)
    };
    let convective = KinematicsModel::Convective(Convective {});
    let pop = KinematicsModel::Pop1995(Pop1995 {});
    let g = 1e-4;
    let s = slip(&convective, g);
    assert!(s[0].hypot(s[1]) < 1e-15);
    // 0.5 and 0.6 per unit of the shear E₁₂ = g/2, along a and b
    let s = slip(&pop, g);
    assert!((s[0] / (0.5 * g) - 0.5).abs() < 1e-3, "{s:?}");
    assert!((s[1] / (0.5 * g) - 0.6).abs() < 1e-3, "{s:?}");
}

/// Friction opposes slip on a skew triangle in convective coordinates; in the paper's it does not (THEORY A6, item 13), while
/// its size is right.
#[test]
fn friction_is_isotropic_but_in_the_papers_kinematics() {
    use crate::contact::law::slip::{ReturnMapping, SlipRule, Tangential};
    let beta = std::f64::consts::FRAC_PI_3;
    let direction = |model: &KinematicsModel, angle: f64| {
        let mut before = vec![[0.3, 0.2, 0.0]];
        before.extend([[0.0; 3], [1.0, 0.0, 0.0], [beta.cos(), beta.sin(), 0.0]]);
        let mut now = before.clone();
        now[0] = add(now[0], scale(1e-3, [angle.cos(), angle.sin(), 0.0]));
        let case = Case {
            kind: ElementKind::Tri3,
            dim: 3,
            weights: vec![1.0],
            before,
            now,
        };
        case.with(&case.now, model, |_, s| {
            let t = ReturnMapping {}.traction(
                1.0,
                &Tangential {
                    slip: s.slip,
                    dt: 1.0,
                    stiffness: 1e6,
                    base: [0.0; 2],
                    skew: s.skew,
                    ..Tangential::default()
                },
            );
            let force = add_scaled(scale(t.traction[0], s.frame[0]), t.traction[1], s.frame[1]);
            assert!((norm(force) - 1.0).abs() < 1e-12);
            (-force[1]).atan2(-force[0]).to_degrees()
        })
    };
    let convective = KinematicsModel::Convective(Convective {});
    let pop = KinematicsModel::Pop1995(Pop1995 {});
    for angle in [0.0_f64, 30.0, 60.0, 90.0] {
        assert!((direction(&convective, angle.to_radians()) - angle).abs() < 1e-9);
    }
    for (angle, friction) in [(0.0_f64, 19.1), (60.0, 40.9), (90.0, 60.0)] {
        assert!((direction(&pop, angle.to_radians()) - friction).abs() < 0.05);
    }
}

/// A motion of an obstacle over the unit of time, and where the point was before: the obstacle is at rest, moves, turns under the point by `angle`
/// while the point stays about where it is, and takes the point along for a part of the way.
fn obstacle_motions() -> Vec<(Motion, f64)> {
    let table = vec![vec![0.0; 4], vec![1.0, 0.02, -0.01, 0.03]];
    let turn = |angle: f64| {
        Some(crate::contact::obstacle::Rotation {
            centre: vec![0.05, -0.02, 0.01],
            axis: Some(vec![0.3, 0.2, 1.0]),
            angle: vec![[0.0, 0.2], [1.0, 0.2 + angle]],
        })
    };
    let with = |translation: &Vec<Vec<f64>>, rotation| Motion {
        translation: translation.clone(),
        rotation,
    };
    vec![
        (with(&Vec::new(), None), 0.0),
        (with(&table, None), 0.0),
        (with(&table, turn(0.05)), 0.0),
        (with(&table, turn(1.0)), 0.0),
        (with(&table, turn(-0.7)), -0.4),
        (with(&Vec::new(), turn(1.2)), 0.9),
    ]
}

#[test]
fn rigid_stencils_agree_with_differences() {
    let point = ContactPoint {
        nodes: vec![0, 1],
        weights: vec![0.4, 0.6],
        area: 1.0,
        stiffness: 1.0,
        normal: [0.0; 3],
        size: 1.0,
        across: Default::default(),
    };
    for shape in ObstacleShape::samples() {
        for (motion, along) in obstacle_motions() {
            let poses = (motion.pose(1.0), motion.pose(0.0));
            let shape = shape.as_dyn();
            let x = [[0.31, -0.22, 0.17], [0.33, -0.2, 0.15]];
            let (centre, axis) = poses.1.axis();
            let back = |x: Vec3| add(centre, mat_vec(&rotation(axis, -along), sub(x, centre)));
            let before = back([0.3, -0.21, 0.16]);
            let at = |x: &[Vec3; 2]| {
                let place = point.position(x);
                let mut s = Stencil::default();
                let over = ObstaclePair {
                    pose: &poses.0,
                    pose_before: &poses.1,
                    x: place,
                    x_before: before,
                };
                let feet = rigid_stencil(shape, over, &point, BELT, 3, &mut s);
                (s, feet.expect("off the centre"))
            };
            let (s, feet) = at(&x);
            let weights = [0.7, -0.4, 0.9];
            let mut hessian = vec![0.0; 36];
            add_rigid_hessian(&poses.0, &point, &feet, 3, weights, &mut hessian);
            let h = 1e-6;
            for l in 0..6 {
                let moved = |h: f64| {
                    let mut y = x;
                    y[l / 3][l % 3] += h;
                    at(&y).0
                };
                let (a, b) = (moved(-h), moved(h));
                let d = |a: f64, b: f64| (b - a) / (2.0 * h);
                assert!((d(a.gap, b.gap) - s.rows[0][l]).abs() < 1e-8);
                for i in 0..2 {
                    let seen = |s: &Stencil| s.slip[i] - dot(s.frame[i], BELT);
                    let difference = d(seen(&a), seen(&b));
                    assert!((difference - s.slip_rows[i][l]).abs() < 1e-8, "{along}");
                }
                for k in 0..6 {
                    let c = |s: &Stencil| (0..3).map(|q| weights[q] * s.rows[q][k]).sum::<f64>();
                    assert!(
                        (d(c(&a), c(&b)) - hessian[k * 6 + l]).abs() < 1e-7,
                        "{along}"
                    );
                }
            }
            // a frame of unit vectors in the tangent plane of now
            let all = [s.normal, s.frame[0], s.frame[1]];
            for (i, a) in all.iter().enumerate() {
                for (j, b) in all.iter().enumerate() {
                    let unit = if i == j { 1.0 } else { 0.0 };
                    assert!((dot(*a, *b) - unit).abs() < 1e-14);
                }
            }
        }
    }
}

/// A contact point that is a node.
pub(super) fn single() -> ContactPoint {
    ContactPoint {
        nodes: vec![0],
        weights: vec![1.0],
        area: 1.0,
        stiffness: 1.0,
        normal: [0.0; 3],
        size: 1.0,
        across: Default::default(),
    }
}

/// Slip over an obstacle in space, and the frame.
fn slip_over(
    shape: &ObstacleShape,
    motion: &Motion,
    [x, before]: [Vec3; 2],
    dim: usize,
) -> (Vec3, Stencil) {
    let point = single();
    let mut s = Stencil::default();
    let over = ObstaclePair {
        pose: &motion.pose(1.0),
        pose_before: &motion.pose(0.0),
        x,
        x_before: before,
    };
    rigid_stencil(shape.as_dyn(), over, &point, [0.0; 3], dim, &mut s).expect("a foot");
    (
        add_scaled(scale(s.slip[0], s.frame[0]), s.slip[1], s.frame[1]),
        s,
    )
}

fn turning(centre: Vec3, axis: Vec3, angle: f64) -> Motion {
    Motion {
        translation: Vec::new(),
        rotation: Some(crate::contact::obstacle::Rotation {
            centre: centre.to_vec(),
            axis: Some(axis.to_vec()),
            angle: vec![[0.0, 0.0], [1.0, angle]],
        }),
    }
}

/// A surface of revolution that turns under a point at rest moves past with one velocity: slip is the arc against it, for turns of any size.
#[test]
fn slip_over_what_turns_is_the_arc() {
    use crate::contact::obstacle::{Cylinder, Plane, Sphere};
    let centre = [0.3, -0.2, 0.1];
    let axis = [0.0, 0.6, 0.8];
    let shapes = [
        ObstacleShape::Cylinder(Cylinder {
            centre: centre.to_vec(),
            axis: Some(axis.to_vec()),
            radius: 0.5,
            inside: false,
        }),
        ObstacleShape::Cylinder(Cylinder {
            centre: centre.to_vec(),
            axis: Some(axis.to_vec()),
            radius: 0.5,
            inside: true,
        }),
        ObstacleShape::Sphere(Sphere {
            centre: centre.to_vec(),
            radius: 0.5,
            inside: false,
        }),
        ObstacleShape::Plane(Plane {
            point: centre.to_vec(),
            normal: axis.to_vec(),
        }),
    ];
    let x = add(centre, [0.3, 0.35, 0.15]);
    for shape in &shapes {
        for angle in [0.01, -0.2, 1.0, 3.0, -7.0, 20.0] {
            let (slip, s) = slip_over(shape, &turning(centre, axis, angle), [x, x], 3);
            let foot = shape.as_dyn().foot(x).expect("a foot").point;
            let exact = scale(-angle, cross(axis, sub(foot, centre)));
            assert!(
                norm(sub(slip, exact)) < 1e-13 * (1.0 + norm(exact)),
                "{angle} {slip:?} {exact:?}"
            );
            assert!((dot(s.frame[0], s.frame[0]) - 1.0).abs() < 1e-14);
            // A point that rides along has none, and what it carries turns with it.
            if angle.abs() < 3.0 {
                let turn = rotation(axis, angle);
                let there = add(centre, mat_vec(&turn, sub(x, centre)));
                let (slip, s) = slip_over(shape, &turning(centre, axis, angle), [there, x], 3);
                assert!(norm(slip) < 1e-15, "{angle} {slip:?}");
                for i in 0..2 {
                    let carried = mat_vec(&turn, s.frame_before[i]);
                    assert!(norm(sub(carried, s.frame[i])) < 1e-14, "{angle}");
                }
            }
        }
    }
}

/// A cylinder or a sphere that is pushed along its curvature slips by the angle between the feet times the radius.
#[test]
fn slip_over_what_is_pushed_is_the_arc() {
    use crate::contact::obstacle::{Cylinder, Sphere};
    for inside in [false, true] {
        let shapes = [
            ObstacleShape::Sphere(Sphere {
                centre: vec![0.0; 3],
                radius: 2.0,
                inside,
            }),
            ObstacleShape::Cylinder(Cylinder {
                centre: vec![0.0; 3],
                axis: Some(vec![0.0, 0.0, 1.0]),
                radius: 2.0,
                inside,
            }),
        ];
        for shape in &shapes {
            for angle in [1e-6_f64, 0.03, 0.5, 1.5] {
                // from the angle 0 to `angle`, a little off the surface at both ends
                let before = [2.01, 0.0, 0.0];
                let x = scale(1.98, [angle.cos(), angle.sin(), 0.0]);
                let rest = Motion::default();
                let (slip, s) = slip_over(shape, &rest, [x, before], 3);
                let exact = scale(2.0 * angle, [-angle.sin(), angle.cos(), 0.0]);
                assert!(norm(sub(slip, exact)) < 1e-14, "{angle}");
                for (e, before) in s.frame.iter().zip(s.frame_before) {
                    let carried = mat_vec(&rotation([0.0, 0.0, 1.0], angle), before);
                    assert!(norm(sub(carried, *e)) < 1e-14, "{angle}");
                }
            }
        }
    }
}

/// A surface that faces an axis, and is tilted a little one way or another: the directions of slip stay where they are. A solver that keeps a factor of
/// systems in their components would have the factor of another one.
#[test]
fn directions_of_slip_do_not_jump_where_a_surface_faces_an_axis() {
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let tilted = |by: [f64; 2]| {
                let mut n = [0.0; 3];
                n[axis] = side;
                n[(axis + 1) % 3] = by[0];
                n[(axis + 2) % 3] = by[1];
                tangents(normalize(n).unwrap(), 3)
            };
            let straight = tilted([0.0; 2]);
            for by in [[1e-3, 0.0], [0.0, 1e-3], [-1e-3, 1e-4], [1e-4, -1e-3]] {
                for (t, s) in tilted(by).into_iter().zip(straight) {
                    assert!(norm(sub(t, s)) < 2e-3, "axis {axis}, side {side}, {by:?}");
                }
            }
        }
    }
}
