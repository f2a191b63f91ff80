//! Bodies that turn: small strains in a frame that turns by any angle.
//!
//! A reference point carries the frame: its translation `q`, and a rotation vector `θ` that gives the rotation `R(θ)`. A point of the body with the
//! reference place `X` and the displacement `w` *in the axes of the frame* is in space at `x = c + q + R (X - c + w)`, where `c` is the place of the
//! reference point. The body itself, its stiffness and its supports, knows `w` alone and stays linear: its factor serves whatever the rotation. What
//! acts in space, first of all contact, sees `x`; of its forces the body gets `Rᵀ f`, and the reference point the resultant and the moment about itself at
//! the places where points *are*, so that action and reaction balance exactly, moments too. That is the floating frame of reference with the frame's motion
//! among the unknowns ([`shabana_2013`](stickslip_base::references::shabana_2013), chapter 5).
//!
//! `BodyFrames` is this map and the transpose of its derivative for forces and tangent blocks; the derivative of the derivative, by which forces turn with the
//! frame, is left to Newton's iteration. It is of the size of what contact carries over the length of the body, beside the stiffness of contact.
//!
//! A rigid body is one without `w`: its own hidden points carry the frame, or those of a reference point. In space the rotation of such a frame is counted from
//! the start of an increment ([`IncrementalRotation`](super::IncrementalRotation)), so that it is small whatever the body has turned by.

use std::ops::Range;

use super::frame_pose::{FramePose, exponential, product};
use super::{Dofs, Link};
use crate::math::{Mat3, Vec3, add, cross, distance, mat_vec, scale, sub, transpose_vec};

/// A body that is described in a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyFrame {
    /// Its points.
    pub points: Range<usize>,
    /// What the frame goes with.
    pub carrier: Carrier,
    /// Whether they stand still in it.
    pub rigid: bool,
}

/// What the frame of a body goes with.
#[derive(Debug, Clone, PartialEq)]
pub enum Carrier {
    /// A reference point, or a rigid body itself: its motion is among the unknowns.
    Reference {
        /// Its hidden points, as those of its link.
        hidden: usize,
        /// Where it is at first `[m]`.
        centre: Vec3,
        /// The length that rotations are multiplied by `[m]`.
        length: f64,
        /// The rotation where that of the unknowns is zero.
        base: Mat3,
    },
    /// Nothing: it stands still there. Bodies that turn freely ([`Corotations`](super::Corotations)) are seen from such frames for an increment.
    Still(FramePose),
}

impl BodyFrame {
    /// The hidden points of the reference point that carries it, if one does.
    pub fn hidden(&self) -> Option<usize> {
        match self.carrier {
            Carrier::Reference { hidden, .. } => Some(hidden),
            Carrier::Still(_) => None,
        }
    }
}

/// By which dofs something in space moves: those of its point, the translation and the rotation of its frame.
pub(super) type Turned = [(usize, f64); 7];

/// The bodies of a model that turn; without any, everything here does nothing.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BodyFrames {
    dofs: Dofs,
    all: Vec<BodyFrame>,
}

impl BodyFrames {
    /// Frames of these bodies.
    pub fn new(dofs: Dofs, all: Vec<BodyFrame>) -> Self {
        BodyFrames { dofs, all }
    }

    /// The numbering of dofs, hidden points counted.
    pub fn dofs(&self) -> Dofs {
        self.dofs
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// The bodies.
    pub fn all(&self) -> &[BodyFrame] {
        &self.all
    }

    /// The body that a point belongs to.
    pub fn of_point(&self, point: usize) -> Option<usize> {
        self.all.iter().position(|f| f.points.contains(&point))
    }

    /// Whether rigid bodies have any of them.
    pub fn any_rigid(&self) -> bool {
        self.all.iter().any(|f| f.rigid)
    }

    /// Whether nothing prescribes by how much some frame turns.
    pub fn any_unheld(&self, fixed: &[bool]) -> bool {
        let mut all = self.all.iter();
        all.any(|frame| self.rotation(frame).any(|dof| !fixed[dof]))
    }

    /// The dofs of the rotation of a frame that a reference point carries.
    fn rotation(&self, frame: &BodyFrame) -> std::ops::Range<usize> {
        let axes = if self.dofs.dim == 2 { 1 } else { 3 };
        frame.hidden().map_or(0..0, |h| {
            let first = self.dofs.of(h + 1, 0);
            first..first + axes
        })
    }

    /// By how much each frame that a reference point carries has to turn, in the numbers of its dofs of rotation, for the farthest of these `points`, at
    /// their reference places, to go by a `way` `[m]`; with these dofs.
    pub fn turns_by(
        &self,
        points: impl Iterator<Item = (usize, Vec3)> + Clone,
        way: f64,
    ) -> Vec<(std::ops::Range<usize>, f64)> {
        let each = self.all.iter().filter_map(|frame| {
            let Carrier::Reference { centre, length, .. } = frame.carrier else {
                return None;
            };
            let own = (points.clone()).filter(|(p, _)| frame.points.contains(p));
            let farthest = own.map(|(_, x)| distance(x, centre)).fold(0.0, f64::max);
            (farthest > 0.0).then(|| (self.rotation(frame), way * length / farthest))
        });
        each.collect()
    }

    /// Hidden points of frames that turn freely in space: those that carry rigid bodies.
    pub fn spun(&self) -> Vec<(usize, f64)> {
        let mut out: Vec<(usize, f64)> = Vec::new();
        let rigid = self.all.iter().filter(|f| f.rigid && self.dofs.dim == 3);
        for frame in rigid {
            if let Carrier::Reference { hidden, length, .. } = frame.carrier
                && out.iter().all(|(h, _)| *h != hidden)
            {
                out.push((hidden, length));
            }
        }
        out
    }

    fn is_spun(&self, frame: &BodyFrame) -> bool {
        let hidden = frame.hidden();
        let mut all = self.all.iter();
        self.dofs.dim == 3 && hidden.is_some() && all.any(|f| f.rigid && f.hidden() == hidden)
    }

    /// The same with rotations in space counted from where displacements `u` have led to.
    #[must_use]
    pub fn from_here(&self, u: &[f64]) -> Self {
        let mut out = self.clone();
        for (frame, own) in out.all.iter_mut().zip(&self.all) {
            let here = self.pose(own, u).turn;
            if let Carrier::Reference { base, .. } = &mut frame.carrier
                && self.is_spun(own)
            {
                *base = here;
            }
        }
        out
    }

    /// The same with further frames.
    #[must_use]
    pub fn with(mut self, more: impl IntoIterator<Item = BodyFrame>) -> Self {
        self.all.extend(more);
        self
    }

    /// Writes velocities and accelerations in space of the points of rigid bodies, with those of their hidden points, whose rotations are along the axes of the body.
    pub fn move_points(&self, points: &[Vec3], u: &[f64], [v, a]: [&mut [f64]; 2]) {
        for (frame, pose) in self.all.iter().zip(self.poses(u)) {
            let Carrier::Reference { hidden, length, .. } = frame.carrier else {
                continue;
            };
            if !frame.rigid {
                continue;
            }
            let turning = |x: &[f64]| {
                let x = scale(1.0 / length, self.dofs.vector(x, hidden + 1));
                match self.dofs.dim {
                    2 => [0.0, 0.0, x[0]],
                    _ => x,
                }
            };
            let (spin, turn) = (turning(v), turning(a));
            let (way, pull) = (self.dofs.vector(v, hidden), self.dofs.vector(a, hidden));
            for p in frame.points.clone() {
                let arm = sub(points[p], pose.centre);
                let swept = cross(spin, arm);
                let bent = add(cross(turn, arm), cross(spin, swept));
                let own = self.dofs.of(p, 0)..self.dofs.of(p + 1, 0);
                let moved = add(way, mat_vec(&pose.turn, swept));
                let pulled = add(pull, mat_vec(&pose.turn, bent));
                v[own.clone()].copy_from_slice(&moved[..self.dofs.dim]);
                a[own].copy_from_slice(&pulled[..self.dofs.dim]);
            }
        }
    }

    /// Whether a hidden point, or the one after it, is that of a frame.
    pub fn carries(&self, link: &Link) -> bool {
        self.all.iter().any(|f| f.hidden() == Some(link.hidden))
    }

    /// Where the frames are, at the displacements `u` by dof.
    pub fn poses(&self, u: &[f64]) -> Vec<FramePose> {
        self.all.iter().map(|f| self.pose(f, u)).collect()
    }

    fn pose(&self, frame: &BodyFrame, u: &[f64]) -> FramePose {
        let (hidden, centre, length, base) = match frame.carrier {
            Carrier::Still(pose) => return pose,
            Carrier::Reference {
                hidden,
                centre,
                length,
                base,
            } => (hidden, centre, length, base),
        };
        let theta = scale(1.0 / length, self.dofs.vector(u, hidden + 1));
        let theta = match self.dofs.dim {
            2 => [0.0, 0.0, theta[0]],
            _ => theta,
        };
        let (turn, spin) = exponential(theta);
        FramePose {
            turn: product(&base, &turn),
            centre,
            now: add(centre, self.dofs.vector(u, hidden)),
            spin: product(&base, &spin),
        }
    }

    /// Displacements in space by dof, from those in frames.
    pub fn in_space(&self, points: &[Vec3], u: &[f64]) -> Vec<f64> {
        let mut out = u.to_vec();
        for (frame, pose) in self.all.iter().zip(self.poses(u)) {
            for p in frame.points.clone() {
                let place = pose.place(points[p], self.dofs.vector(u, p));
                let moved = sub(place, points[p]);
                out[self.dofs.of(p, 0)..self.dofs.of(p + 1, 0)]
                    .copy_from_slice(&moved[..self.dofs.dim]);
            }
        }
        out
    }

    /// Turns vectors by dof, such as forces, from the axes of space to those of frames.
    pub fn turn_in(&self, u: &[f64], vectors: &mut [f64]) {
        self.turn(u, vectors, |pose, v| transpose_vec(&pose.turn, v));
    }

    /// Displacements in frames by dof, from those in space: of frames that stand still.
    pub fn in_frames(&self, points: &[Vec3], u: &[f64]) -> Vec<f64> {
        let mut out = u.to_vec();
        for (frame, pose) in self.all.iter().zip(self.poses(u)) {
            for p in frame.points.clone() {
                let place = add(points[p], self.dofs.vector(u, p));
                let moved = pose.displacement(points[p], place);
                out[self.dofs.of(p, 0)..self.dofs.of(p + 1, 0)]
                    .copy_from_slice(&moved[..self.dofs.dim]);
            }
        }
        out
    }

    /// Turns vectors by dof, such as forces, from the axes of frames to those of space.
    pub fn turn_out(&self, u: &[f64], vectors: &mut [f64]) {
        self.turn(u, vectors, |pose, v| mat_vec(&pose.turn, v));
    }

    /// Turns symmetric tensors by point, xx yy zz xy yz xz, from the axes of frames to those of space.
    pub fn turn_tensors(&self, u: &[f64], tensors: &mut [f64]) {
        for (frame, pose) in self.all.iter().zip(self.poses(u)) {
            for p in frame.points.clone() {
                if let Some(tensor) = tensors.get_mut(6 * p..6 * p + 6) {
                    pose.turn_tensor(tensor);
                }
            }
        }
    }

    fn turn(&self, u: &[f64], vectors: &mut [f64], by: impl Fn(&FramePose, Vec3) -> Vec3) {
        for (frame, pose) in self.all.iter().zip(self.poses(u)) {
            for p in frame.points.clone() {
                let turned = by(&pose, self.dofs.vector(vectors, p));
                vectors[self.dofs.of(p, 0)..self.dofs.of(p + 1, 0)]
                    .copy_from_slice(&turned[..self.dofs.dim]);
            }
        }
    }

    /// Lets forces by dof that act in space on points act on bodies and frames.
    pub fn transfer(&self, points: &[Vec3], u: &[f64], forces: &mut [f64]) {
        for (frame, pose) in self.all.iter().zip(self.poses(u)) {
            for p in frame.points.clone() {
                let force = self.dofs.vector(forces, p);
                if force != [0.0; 3] {
                    let place = pose.place(points[p], self.dofs.vector(u, p));
                    self.hand_over(frame, &pose, p, place, force, forces);
                }
            }
        }
    }

    /// Replaces the force on a point by that in its frame, and adds what the frame gets.
    fn hand_over(
        &self,
        frame: &BodyFrame,
        pose: &FramePose,
        p: usize,
        place: Vec3,
        force: Vec3,
        forces: &mut [f64],
    ) {
        let dim = self.dofs.dim;
        let own = transpose_vec(&pose.turn, force);
        for c in 0..dim {
            forces[self.dofs.of(p, c)] = own[c];
        }
        let Carrier::Reference { hidden, length, .. } = frame.carrier else {
            return;
        };
        for c in 0..dim {
            forces[self.dofs.of(hidden, c)] += force[c];
        }
        let moment = scale(1.0 / length, cross(sub(place, pose.now), force));
        // Moments on what turns freely in space stay along its axes.
        let moment = match self.is_spun(frame) {
            true => moment,
            false => transpose_vec(&pose.spin, moment),
        };
        match dim {
            2 => forces[self.dofs.of(hidden + 1, 0)] += moment[2],
            _ => {
                for (c, moment) in moment.into_iter().enumerate() {
                    forces[self.dofs.of(hidden + 1, c)] += moment;
                }
            }
        }
    }

    /// How the displacement in space of a point along an axis follows the dofs, where the point is at `place`.
    pub(super) fn row(&self, body: usize, pose: &FramePose, dof: usize, place: Vec3) -> Turned {
        let frame = &self.all[body];
        let (point, c) = self.dofs.locate(dof);
        let reference = match frame.carrier {
            Carrier::Reference { hidden, length, .. } => Some((hidden, length)),
            Carrier::Still(_) => None,
        };
        let first = reference.map_or(dof, |(hidden, _)| self.dofs.of(hidden, c));
        let mut row = [(first, 0.0); 7];
        // Points of rigid bodies do not move in their frames.
        let own = if frame.rigid { 0 } else { self.dofs.dim };
        for j in 0..own {
            row[1 + j] = (self.dofs.of(point, j), pose.turn[c][j]);
        }
        let Some((hidden, length)) = reference else {
            return row;
        };
        row[0] = (first, 1.0);
        // δx = (spin δθ) × arm
        let arm = sub(place, pose.now);
        let axes: &[usize] = match self.dofs.dim {
            2 => &[2],
            _ => &[0, 1, 2],
        };
        for (k, &axis) in axes.iter().enumerate() {
            let column = [0, 1, 2].map(|i| pose.spin[i][axis]);
            let moved = cross(column, arm)[c] / length;
            row[4 + k] = (self.dofs.of(hidden + 1, k), moved);
        }
        row
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::math::identity;
    use crate::system::{Assembler, InSpace};

    fn noise(count: usize, seed: f64) -> Vec<f64> {
        let number = |i: usize| (12.9898 * (i as f64 + seed)).sin() * 0.7;
        (0..count).map(number).collect()
    }

    /// Points 0 to 3 are a body that turns, 4 is free, 5 and 6 carry the frame.
    fn sample(dim: usize) -> (Arc<BodyFrames>, Vec<Vec3>) {
        let dofs = Dofs { dim, points: 7 };
        let frame = BodyFrame {
            points: 0..4,
            carrier: Carrier::Reference {
                hidden: 5,
                centre: [0.3, -0.2, if dim == 3 { 0.5 } else { 0.0 }],
                length: 0.8,
                base: identity(),
            },
            rigid: false,
        };
        let places = noise(15, 3.0);
        let points = places.chunks(3).map(|x| match dim {
            2 => [x[0], x[1], 0.0],
            _ => [x[0], x[1], x[2]],
        });
        let points = points.collect();
        (Arc::new(BodyFrames::new(dofs, vec![frame])), points)
    }

    fn places(frames: &BodyFrames, points: &[Vec3], u: &[f64]) -> Vec<Vec3> {
        let moved = frames.in_space(points, u);
        let each = points.iter().enumerate();
        each.map(|(p, &x)| add(x, frames.dofs.vector(&moved, p)))
            .collect()
    }

    #[test]
    fn a_frame_moves_its_points_as_a_rigid_body_and_back() {
        for dim in [2, 3] {
            let (frames, points) = sample(dim);
            let mut u = noise(7 * dim, 1.0);
            u[..4 * dim].fill(0.0);
            let x = places(&frames, &points, &u);
            for p in 0..4 {
                for q in 0..p {
                    let apart = distance(x[p], x[q]) - distance(points[p], points[q]);
                    assert!(apart.abs() < 1e-14);
                }
                let pose = frames.poses(&u)[0];
                let back = pose.displacement(points[p], x[p]);
                assert!(distance(back, [0.0; 3]) < 1e-14);
            }
        }
    }

    #[test]
    fn rows_are_derivatives_of_places_whatever_the_angle() {
        for dim in [2, 3] {
            for turned in [1e-9, 1e-5, 0.5, 3.0, 7.0] {
                let (frames, points) = sample(dim);
                let mut u = noise(7 * dim, 1.0);
                for c in 0..dim {
                    u[6 * dim + c] *= turned;
                }
                let x = places(&frames, &points, &u);
                let each = x.iter().copied().enumerate();
                let space = InSpace::new(&frames, frames.poses(&u), each);
                let du = noise(7 * dim, 9.0);
                let step = 1e-6;
                let at = |sign: f64| {
                    let both = u.iter().zip(&du);
                    let u: Vec<f64> = both.map(|(u, d)| u + sign * step * d).collect();
                    places(&frames, &points, &u)
                };
                let (after, before) = (at(1.0), at(-1.0));
                for p in 0..5 {
                    for c in 0..dim {
                        let expected = (after[p][c] - before[p][c]) / (2.0 * step);
                        let found = space.moved(frames.dofs.of(p, c), &du);
                        assert!(
                            (found - expected).abs() < 1e-8,
                            "{dim} {turned}: {found} {expected}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn what_acts_in_space_does_the_same_work_on_bodies_and_frames() {
        for dim in [2, 3] {
            let (frames, points) = sample(dim);
            let u = noise(7 * dim, 1.0);
            let x = places(&frames, &points, &u);
            let space = InSpace::new(&frames, frames.poses(&u), x.iter().copied().enumerate());
            let (du, mut forces) = (noise(7 * dim, 9.0), noise(7 * dim, 5.0));
            forces[5 * dim..].fill(0.0);
            let work = |f: &[f64], du: &[f64]| f.iter().zip(du).map(|(f, d)| f * d).sum::<f64>();
            let moved: Vec<f64> = (0..5 * dim).map(|dof| space.moved(dof, &du)).collect();
            let expected = work(&forces[..5 * dim], &moved);
            let mut spatial = Assembler::new(7 * dim);
            spatial.residual.copy_from_slice(&forces);
            let mut out = Assembler::new(7 * dim);
            space.assemble(&mut spatial, &mut out);
            assert!((work(&out.residual, &du) - expected).abs() < 1e-12);
            // Loads take the same way.
            frames.transfer(&points, &u, &mut forces);
            for (a, b) in forces.iter().zip(&out.residual) {
                assert!((a - b).abs() < 1e-12, "{dim}: {a} {b}");
            }
            // Vectors turn out and back.
            let mut v = noise(7 * dim, 2.0);
            let pose = frames.poses(&u)[0];
            let before = frames.dofs.vector(&v, 2);
            frames.turn_out(&u, &mut v);
            let back = transpose_vec(&pose.turn, frames.dofs.vector(&v, 2));
            assert!(distance(back, before) < 1e-14);
        }
    }

    #[test]
    fn tensors_turn_with_their_axes() {
        let (frames, _) = sample(3);
        let u = noise(21, 1.0);
        let pose = frames.poses(&u)[0];
        // A dyad of a vector stays one.
        let v = [0.3, -0.7, 0.4];
        let w = mat_vec(&pose.turn, v);
        let dyad = |v: Vec3| {
            let [x, y, z] = v;
            [x * x, y * y, z * z, x * y, y * z, x * z]
        };
        let mut tensor = dyad(v);
        pose.turn_tensor(&mut tensor);
        for (a, b) in tensor.iter().zip(dyad(w)) {
            assert!((a - b).abs() < 1e-14);
        }
    }
}
