//! The identities of a contact element (VERIFICATION B3), for every kinematics and facet kind.

use super::*;
use crate::contact::obstacle::{Motion, ObstacleShape};
use crate::contact::pairing::project;
use crate::contact::surface::ContactPoint;
use crate::math::{add, add_scaled, cross, dot, mat_vec, norm, rotation, scale, sub};
use crate::registry::Family;

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
            let (stencil, hessian) = case.with(&case.now, &model, |pair, s| {
                let mut h = vec![0.0; s.n * s.n];
                model.as_dyn().add_hessian(pair, s, weights, &mut h);
                (s.clone(), h)
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
                    let row = stencil.rows[i + 1][l];
                    assert!(
                        (d(a.slip[i], b.slip[i]) - row).abs() < 1e-8,
                        "{what} slip {i} {l}"
                    );
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
                        (value - hessian[l * n + k]).abs() < 1e-11,
                        "{what} is symmetric"
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
                    smoothing: 0.0,
                    slack: 0.0,
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

#[test]
fn rigid_stencils_agree_with_differences() {
    let motion = Motion {
        translation: vec![vec![0.0, 0.0, 0.0, 0.0], vec![1.0, 0.02, -0.01, 0.03]],
        rotation: Some(crate::contact::obstacle::Rotation {
            centre: vec![0.0; 3],
            axis: Some(vec![0.3, 0.2, 1.0]),
            angle: vec![[0.0, 0.0], [1.0, 0.05]],
        }),
    };
    let poses = (motion.pose(1.0), motion.pose(0.0));
    let point = ContactPoint {
        nodes: vec![0, 1],
        weights: vec![0.4, 0.6],
        area: 1.0,
        stiffness: 1.0,
        normal: [0.0; 3],
        size: 1.0,
    };
    for shape in ObstacleShape::samples() {
        let shape = shape.as_dyn();
        let x = [[0.31, -0.22, 0.17], [0.33, -0.2, 0.15]];
        let before = [0.3, -0.21, 0.16];
        let at = |x: &[Vec3; 2]| {
            let place = point.position(x);
            let mut s = Stencil::default();
            let feet = rigid_stencil(
                shape,
                (&poses.0, &poses.1),
                &point,
                (place, before),
                3,
                &mut s,
            );
            (s, feet.expect("off the centre"), place)
        };
        let (s, feet, place) = at(&x);
        let weights = [0.7, -0.4, 0.9];
        let mut hessian = vec![0.0; 36];
        add_rigid_hessian(
            shape,
            &poses.0,
            &point,
            place,
            &feet,
            3,
            weights,
            &mut hessian,
        );
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
                assert!((d(a.slip[i], b.slip[i]) - s.rows[i + 1][l]).abs() < 1e-8);
            }
            for k in 0..6 {
                let c = |s: &Stencil| (0..3).map(|q| weights[q] * s.rows[q][k]).sum::<f64>();
                assert!((d(c(&a), c(&b)) - hessian[k * 6 + l]).abs() < 1e-7);
            }
        }
        assert!(dot(s.normal, s.normal) - 1.0 < 1e-14);
    }
}
