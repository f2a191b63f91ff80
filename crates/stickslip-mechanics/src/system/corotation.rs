//! Free bodies that turn by any angle: each is linear in a frame of its own, which follows it.
//!
//! The frame of a body is the rotation `R` and the centre `c` that fit its points best: with weights `m` and places `X` counted from the weighted centre, `R` is
//! the rotation in the polar decomposition `Σ m (x - c) Xᵀ = R U`. What is left of the displacements is `w = Rᵀ (x - c) - X`; the body stores
//! `½ wᵀ K w` with the stiffness that was assembled once. The force that follows from that energy is
//!
//! ```text
//! f = R Pᵀ K w,   Pᵀ g = g - m/M Σ g - m a × X,   a = J⁻¹ Σ (X + w) × g,   J = tr(U) 1 - U
//! ```
//!
//! It has no resultant and no moment about anything, whatever the displacements are, so that momentum and angular momentum stay. `P` takes from a motion the part
//! by which the frame moves. That is the element-independent corotation of [`nour_omid_rankin_1991`](stickslip_base::references::nour_omid_rankin_1991) with a
//! whole body for an element.

use std::ops::Range;

use super::{Dofs, FramePose};
use crate::math::{
    Mat3, Vec3, add, add_scaled, cross, dot, identity, inverse, mat_vec, norm, outer,
    polar_rotation, rotation, scale, sub, transpose_vec,
};

/// A body with a frame of its own.
#[derive(Debug, Clone, PartialEq)]
struct Corotated {
    points: Range<usize>,
    /// Weighted centre of the points at first `[m]`.
    centre: Vec3,
    /// From there to each of them `[m]`.
    arms: Vec<Vec3>,
    weights: Vec<f64>,
    /// Sum of the weights.
    total: f64,
}

/// Where the frame of a body is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyTurn {
    /// `R`.
    pub turn: Mat3,
    /// `c` at first `[m]`.
    pub centre: Vec3,
    /// `c` now `[m]`.
    pub now: Vec3,
    /// `J⁻¹`.
    resistance: Mat3,
}

impl BodyTurn {
    /// The frame, standing still.
    pub fn pose(&self) -> FramePose {
        FramePose::still(self.turn, self.centre, self.now)
    }

    /// Where it is after a rotation by a vector `[rad]` and a way `[m]`, along the axes of space.
    #[must_use]
    pub fn moved(self, angle: Vec3, way: Vec3) -> Self {
        let size = norm(angle);
        let more = match size > 0.0 {
            true => rotation(scale(1.0 / size, angle), size),
            false => identity(),
        };
        let columns = [0, 1, 2].map(|j| mat_vec(&more, self.turn.map(|row| row[j])));
        BodyTurn {
            turn: std::array::from_fn(|i| columns.map(|column| column[i])),
            now: add(self.now, way),
            ..self
        }
    }
}

/// The bodies of a model with frames of their own; without any, everything here does nothing.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Corotations {
    dofs: Dofs,
    all: Vec<Corotated>,
}

impl Corotations {
    /// Frames for bodies with these points and a weight a point; `places` are those of all points of the model.
    pub fn new(dofs: Dofs, places: &[Vec3], bodies: Vec<(Range<usize>, Vec<f64>)>) -> Self {
        let all = bodies.into_iter().map(|(points, weights)| {
            let total: f64 = weights.iter().sum();
            let own = &places[points.clone()];
            let both = own.iter().zip(&weights);
            let sum = both.fold([0.0; 3], |s, (&x, &w)| add_scaled(s, w, x));
            let centre = scale(1.0 / total, sum);
            Corotated {
                points,
                centre,
                arms: own.iter().map(|&x| sub(x, centre)).collect(),
                weights,
                total,
            }
        });
        Corotations {
            dofs,
            all: all.collect(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// The points of each body.
    pub fn points(&self) -> impl Iterator<Item = Range<usize>> {
        self.all.iter().map(|b| b.points.clone())
    }

    /// Which body has a frame of its own and this point.
    pub fn of_point(&self, point: usize) -> Option<usize> {
        self.all.iter().position(|b| b.points.contains(&point))
    }

    /// Where the frames are, at the displacements `u` by dof in space.
    pub fn turns(&self, u: &[f64]) -> Vec<BodyTurn> {
        self.all.iter().map(|b| self.turn(b, u)).collect()
    }

    fn turn(&self, body: &Corotated, u: &[f64]) -> BodyTurn {
        let moved = |p: usize| self.dofs.vector(u, p);
        let points = body.points.clone().zip(&body.weights);
        let sum = points.fold([0.0; 3], |s, (p, &w)| add_scaled(s, w, moved(p)));
        let shift = scale(1.0 / body.total, sum);
        let mut f = [[0.0; 3]; 3];
        let each = body.points.clone().zip(body.arms.iter().zip(&body.weights));
        for (p, (&arm, &w)) in each {
            let y = add(arm, sub(moved(p), shift));
            let dyad = outer(scale(w, y), arm);
            f.iter_mut().zip(dyad).for_each(|(f, d)| *f = add(*f, d));
        }
        let (turn, resistance) = frame_of(self.dofs.dim, &f);
        BodyTurn {
            turn,
            centre: body.centre,
            now: add(body.centre, shift),
            resistance,
        }
    }

    /// Displacements that are left in the frames, along their axes; those of all else as they are.
    pub fn local(&self, turns: &[BodyTurn], u: &[f64]) -> Vec<f64> {
        let mut out = u.to_vec();
        for (body, turn) in self.all.iter().zip(turns) {
            let shift = sub(turn.now, turn.centre);
            for (p, &arm) in body.points.clone().zip(&body.arms) {
                let y = add(arm, sub(self.dofs.vector(u, p), shift));
                self.put(p, sub(transpose_vec(&turn.turn, y), arm), &mut out);
            }
        }
        out
    }

    /// Turns vectors by dof from the axes of the frames to those of space.
    pub fn turn_out(&self, turns: &[BodyTurn], vectors: &mut [f64]) {
        for (body, turn) in self.all.iter().zip(turns) {
            for p in body.points.clone() {
                let turned = mat_vec(&turn.turn, self.dofs.vector(vectors, p));
                self.put(p, turned, vectors);
            }
        }
    }

    /// Turns symmetric tensors by point, xx yy zz xy yz xz, from the axes of the frames to those of space.
    pub fn turn_tensors(&self, turns: &[BodyTurn], tensors: &mut [f64]) {
        for (body, turn) in self.all.iter().zip(turns) {
            let pose = turn.pose();
            for p in body.points.clone() {
                if let Some(tensor) = tensors.get_mut(6 * p..6 * p + 6) {
                    pose.turn_tensor(tensor);
                }
            }
        }
    }

    /// Writes forces in space at displacements `u`, where `internal` writes those in the frames at the displacements that are left there.
    pub fn forces(&self, u: &[f64], internal: impl FnOnce(&[f64], &mut [f64]), out: &mut [f64]) {
        let turns = self.turns(u);
        let local = self.local(&turns, u);
        internal(&local, out);
        self.outward(&turns, &local, out);
    }

    /// Writes forces in space at displacements `u` and velocities `v`, where `matrix` writes those in the frames at the velocities that are left there.
    pub fn damping(
        &self,
        u: &[f64],
        v: &[f64],
        matrix: impl FnOnce(&[f64], &mut [f64]),
        out: &mut [f64],
    ) {
        if self.is_empty() {
            return matrix(v, out);
        }
        let turns = self.turns(u);
        let local = self.local(&turns, u);
        matrix(&self.deforming(&turns, &local, v), out);
        self.outward(&turns, &local, out);
    }

    /// `R Pᵀ g`: forces in space from those in the frames, where displacements there are `local`.
    pub fn outward(&self, turns: &[BodyTurn], local: &[f64], g: &mut [f64]) {
        for (body, turn) in self.all.iter().zip(turns) {
            let (mut sum, mut moment) = ([0.0; 3], [0.0; 3]);
            for (p, &arm) in body.points.clone().zip(&body.arms) {
                let force = self.dofs.vector(g, p);
                sum = add(sum, force);
                moment = add(moment, cross(add(arm, self.dofs.vector(local, p)), force));
            }
            let a = mat_vec(&turn.resistance, moment);
            let mean = scale(1.0 / body.total, sum);
            let each = body.points.clone().zip(body.arms.iter().zip(&body.weights));
            for (p, (&arm, &w)) in each {
                let rigid = add(mean, cross(a, arm));
                let force = add_scaled(self.dofs.vector(g, p), -w, rigid);
                self.put(p, mat_vec(&turn.turn, force), g);
            }
        }
    }

    /// `P Rᵀ v`: velocities along the axes of the frames without those of the frames themselves.
    pub fn deforming(&self, turns: &[BodyTurn], local: &[f64], v: &[f64]) -> Vec<f64> {
        let mut out = v.to_vec();
        for (body, turn) in self.all.iter().zip(turns) {
            let own = |p| transpose_vec(&turn.turn, self.dofs.vector(v, p));
            let [mean, spin] = body.rigid(turn, own);
            for (p, &arm) in body.points.clone().zip(&body.arms) {
                let y = add(arm, self.dofs.vector(local, p));
                let rigid = add(mean, cross(spin, y));
                self.put(p, sub(own(p), rigid), &mut out);
            }
        }
        out
    }

    /// The spins of the frames `[rad/s]` and the velocities of their centres, both along the axes of space, with the velocities `v`.
    pub fn spins(&self, turns: &[BodyTurn], v: &[f64]) -> Vec<[Vec3; 2]> {
        let bodies = self.all.iter().zip(turns);
        let each = bodies.map(|(body, turn)| {
            let own = |p| transpose_vec(&turn.turn, self.dofs.vector(v, p));
            let [mean, spin] = body.rigid(turn, own);
            [mat_vec(&turn.turn, spin), mat_vec(&turn.turn, mean)]
        });
        each.collect()
    }

    /// Where points go in a time `dt` if nothing acts on them: displacements, in `out`, of bodies that turn and deform as they do with displacements `u` and velocities `v`.
    pub fn go_on(&self, u: &[f64], v: &[f64], dt: f64, out: &mut [f64]) {
        let turns = self.turns(u);
        let local = self.local(&turns, u);
        let deforming = self.deforming(&turns, &local, v);
        let spins = self.spins(&turns, v);
        for ((body, turn), [spin, velocity]) in self.all.iter().zip(&turns).zip(spins) {
            let pose = turn.moved(scale(dt, spin), scale(dt, velocity)).pose();
            for (p, &arm) in body.points.clone().zip(&body.arms) {
                let w = self.dofs.vector(&local, p);
                let w = add_scaled(w, dt, self.dofs.vector(&deforming, p));
                let place = add(body.centre, arm);
                self.put(p, sub(pose.place(place, w), place), out);
            }
        }
    }

    fn put(&self, point: usize, value: Vec3, out: &mut [f64]) {
        out[self.dofs.of(point, 0)..self.dofs.of(point + 1, 0)]
            .copy_from_slice(&value[..self.dofs.dim]);
    }
}

impl Corotated {
    /// Velocity and spin of the frame, along its axes, with these velocities of the points.
    fn rigid(&self, turn: &BodyTurn, own: impl Fn(usize) -> Vec3) -> [Vec3; 2] {
        let (mut sum, mut moment) = ([0.0; 3], [0.0; 3]);
        let each = self.points.clone().zip(self.arms.iter().zip(&self.weights));
        for (p, (&arm, &w)) in each {
            let v = own(p);
            sum = add_scaled(sum, w, v);
            moment = add(moment, cross(scale(w, arm), v));
        }
        [
            scale(1.0 / self.total, sum),
            mat_vec(&turn.resistance, moment),
        ]
    }
}

/// `R` and `J⁻¹` of a sum of dyads `Σ m (x - c) Xᵀ`, in two or three dimensions.
pub fn frame_of(dim: usize, f: &Mat3) -> (Mat3, Mat3) {
    let turn = match dim {
        2 => planar(f),
        _ => rotation_of(f),
    };
    // U = Rᵀ F, symmetric but for rounding.
    let stretch: Mat3 = std::array::from_fn(|i| {
        std::array::from_fn(|j| (0..3).map(|k| turn[k][i] * f[k][j]).sum())
    });
    let trace: f64 = (0..dim).map(|i| stretch[i][i]).sum();
    let unit = identity();
    let j: Mat3 = match dim {
        2 => scaled(unit, trace),
        _ => std::array::from_fn(|i| sub(scale(trace, unit[i]), stretch[i])),
    };
    let resistance = inverse(&j).map_or([[0.0; 3]; 3], |(inverse, _)| inverse);
    (turn, resistance)
}

fn scaled(m: Mat3, s: f64) -> Mat3 {
    m.map(|row| scale(s, row))
}

/// That in space; none where the body is crushed.
fn rotation_of(f: &Mat3) -> Mat3 {
    let size = f.iter().map(|row| dot(*row, *row)).sum::<f64>().sqrt();
    let unit = scaled(*f, 3.0_f64.sqrt() / size.max(f64::MIN_POSITIVE));
    polar_rotation(&unit).unwrap_or_else(identity)
}

/// The rotation nearest to a matrix in the plane.
fn planar(f: &Mat3) -> Mat3 {
    let (c, s) = (f[0][0] + f[1][1], f[1][0] - f[0][1]);
    let length = c.hypot(s);
    match length > 0.0 {
        true => [
            [c / length, -s / length, 0.0],
            [s / length, c / length, 0.0],
            [0.0, 0.0, 1.0],
        ],
        false => identity(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::distance;

    fn noise(count: usize, seed: f64) -> Vec<f64> {
        let number = |i: usize| (12.9898 * (i as f64 + seed)).sin() * 43758.5453;
        (0..count).map(|i| number(i).fract()).collect()
    }

    /// A body of six points, another point after it, a stiffness that does not vanish for rigid motions, and displacements that strain it by a few per cent.
    fn sample(dim: usize) -> (Corotations, Vec<Vec3>, Vec<f64>, Vec<Vec<f64>>) {
        let dofs = Dofs { dim, points: 7 };
        let raw = noise(21, 3.0);
        let places: Vec<Vec3> = (raw.chunks(3))
            .map(|x| [x[0], x[1], if dim == 3 { x[2] } else { 0.0 }])
            .collect();
        let weights = noise(6, 8.0).iter().map(|w| 1.0 + w.abs()).collect();
        let bodies = Corotations::new(dofs, &places, vec![(0..6, weights)]);
        // Springs between all pairs of points along their lines.
        let n = 6 * dim;
        let mut k = vec![vec![0.0; n]; n];
        for p in 0..6 {
            for q in 0..p {
                let line = sub(places[p], places[q]);
                let e = scale(1.0 / distance(places[p], places[q]), line);
                for i in 0..dim {
                    for j in 0..dim {
                        let s = (1.0 + p as f64) * e[i] * e[j];
                        k[p * dim + i][p * dim + j] += s;
                        k[q * dim + i][q * dim + j] += s;
                        k[p * dim + i][q * dim + j] -= s;
                        k[q * dim + i][p * dim + j] -= s;
                    }
                }
            }
        }
        let turn = match dim {
            2 => rotation([0.0, 0.0, 1.0], 2.1),
            _ => rotation([0.6, 0.0, 0.8], 2.1),
        };
        let mut u: Vec<f64> = noise(7 * dim, 1.0).iter().map(|u| 0.03 * u).collect();
        for p in 0..6 {
            let x = add(places[p], dofs.vector(&u, p));
            let moved = sub(
                add(
                    mat_vec(&turn, x),
                    [0.4, -2.0, if dim == 3 { 0.1 } else { 0.0 }],
                ),
                places[p],
            );
            u[p * dim..(p + 1) * dim].copy_from_slice(&moved[..dim]);
        }
        (bodies, places, u, k)
    }

    fn times(k: &[Vec<f64>], w: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; w.len()];
        for (i, row) in k.iter().enumerate() {
            out[i] = row.iter().zip(w).map(|(k, w)| k * w).sum();
        }
        out
    }

    fn energy(bodies: &Corotations, u: &[f64], k: &[Vec<f64>]) -> f64 {
        let w = bodies.local(&bodies.turns(u), u);
        0.5 * times(k, &w).iter().zip(&w).map(|(f, w)| f * w).sum::<f64>()
    }

    fn force(bodies: &Corotations, u: &[f64], k: &[Vec<f64>]) -> Vec<f64> {
        let turns = bodies.turns(u);
        let w = bodies.local(&turns, u);
        let mut g = times(k, &w);
        bodies.outward(&turns, &w, &mut g);
        g
    }

    #[test]
    fn forces_follow_from_the_energy_and_balance_among_themselves() {
        for dim in [2, 3] {
            let (bodies, places, u, k) = sample(dim);
            let f = force(&bodies, &u, &k);
            for dof in 0..6 * dim {
                let at = |s: f64| {
                    let mut u = u.clone();
                    u[dof] += s;
                    energy(&bodies, &u, &k)
                };
                let expected = (at(1e-6) - at(-1e-6)) / 2e-6;
                assert!(
                    (f[dof] - expected).abs() < 1e-8,
                    "{dim}: {} {expected}",
                    f[dof]
                );
            }
            let (mut sum, mut moment) = ([0.0; 3], [0.0; 3]);
            for (p, &place) in places.iter().enumerate().take(6) {
                let force = bodies.dofs.vector(&f, p);
                sum = add(sum, force);
                moment = add(moment, cross(add(place, bodies.dofs.vector(&u, p)), force));
            }
            assert!(distance(sum, [0.0; 3]) < 1e-14 && distance(moment, [0.0; 3]) < 1e-13);
            assert!(f[6 * dim..].iter().all(|f| *f == 0.0));
        }
    }

    #[test]
    fn a_rigid_motion_changes_no_energy_and_turns_the_forces() {
        for dim in [2, 3] {
            let (bodies, places, u, k) = sample(dim);
            let more = match dim {
                2 => rotation([0.0, 0.0, 1.0], -1.3),
                _ => rotation([0.0, 0.6, -0.8], 2.9),
            };
            let mut moved = u.clone();
            for (p, &place) in places.iter().enumerate().take(6) {
                let x = mat_vec(&more, add(place, bodies.dofs.vector(&u, p)));
                bodies.put(p, sub(x, place), &mut moved);
            }
            let (f, g) = (force(&bodies, &u, &k), force(&bodies, &moved, &k));
            for p in 0..6 {
                let turned = mat_vec(&more, bodies.dofs.vector(&f, p));
                assert!(distance(turned, bodies.dofs.vector(&g, p)) < 1e-13);
            }
            assert!((energy(&bodies, &u, &k) - energy(&bodies, &moved, &k)).abs() < 1e-14);
        }
    }

    #[test]
    fn the_velocity_of_a_turning_body_deforms_nothing() {
        for dim in [2, 3] {
            let (bodies, places, u, _) = sample(dim);
            let turns = bodies.turns(&u);
            let local = bodies.local(&turns, &u);
            let spin = [0.0, 0.0, 1.7];
            let mut v = vec![0.5; 7 * dim];
            for (p, &place) in places.iter().enumerate().take(6) {
                let x = add(place, bodies.dofs.vector(&u, p));
                let velocity = add([0.3, -0.2, 0.0], cross(spin, x));
                bodies.put(p, velocity, &mut v);
            }
            let left = bodies.deforming(&turns, &local, &v);
            assert!(left[..6 * dim].iter().all(|v| v.abs() < 1e-13));
            // A quarter of a revolution later.
            let quarter = 0.5 * std::f64::consts::PI / spin[2];
            let mut later = u.clone();
            bodies.go_on(&u, &v, quarter, &mut later);
            let again = bodies.local(&bodies.turns(&later), &later);
            for (a, b) in again[..6 * dim].iter().zip(&local) {
                assert!((a - b).abs() < 1e-13);
            }
            let first = sub(add(places[0], bodies.dofs.vector(&u, 0)), turns[0].now);
            let now = bodies.turns(&later)[0].now;
            let last = sub(add(places[0], bodies.dofs.vector(&later, 0)), now);
            let turned = [-first[1], first[0], first[2]];
            assert!(distance(last, turned) < 1e-13);
            assert_eq!(left[6 * dim..], v[6 * dim..]);
            let [found, _] = bodies.spins(&turns, &v)[0];
            assert!(distance(found, spin) < 1e-13);
        }
    }

    #[test]
    fn what_deforms_and_what_acts_are_transposed() {
        for dim in [2, 3] {
            let (bodies, _, u, _) = sample(dim);
            let turns = bodies.turns(&u);
            let local = bodies.local(&turns, &u);
            let (v, mut g) = (noise(7 * dim, 2.0), noise(7 * dim, 5.0));
            let left = bodies.deforming(&turns, &local, &v);
            let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            let expected = dot(&left, &g);
            bodies.outward(&turns, &local, &mut g);
            assert!((dot(&v, &g) - expected).abs() < 1e-13);
        }
    }
}
