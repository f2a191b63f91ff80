//! Rigid bodies: the motion of many points by that of a few.
//!
//! `Dofs` numbers the points of the mesh and, after them, two hidden points for each rigid body: its translation, and its
//! rotation about the centre of mass times the mean distance of its mass, so that all unknowns are lengths and all that acts
//! on them are forces. `system::Links` is the linear map `u = T q` from hidden dofs to those of the points, and its transpose
//! for forces and blocks. The points of a rigid body have dofs like all others, but they are marked as fixed, and no matrix
//! has entries there: stiffness there is none, mass and springs stand at the hidden points.
//!
//! Contact, loads and output see points only. `impose` makes the points follow wherever displacements, their increments,
//! velocities or accelerations are made; `transfer` gives the hidden dofs what acts on the points before anything is balanced;
//! Newton transforms contact blocks before they are solved with. Supports and initial velocities are turned into values of
//! hidden dofs once, in `problem/build/rigid.rs`.
//!
//! A rigid body that turns by any angle has a frame ([`BodyFrames`](super::BodyFrames)) that its hidden points carry. Its points stand still in that, so that here
//! they follow nothing: the rows of `T` are zero, and what acts on the points has been handed to the frame before.

use std::collections::BTreeMap;
use std::ops::Range;

use super::{ContactBlock, Dofs, Motion};
use crate::linear::BlockCsr;
use crate::math::{Vec3, norm, scale};

/// What a rigid body may do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Freedom {
    /// Nothing of its own: a reference point carries it.
    Carried,
    /// Move along y: all that axial symmetry leaves.
    Axial,
    /// Move in the plane and turn in it.
    Plane,
    /// Move and turn in space.
    Space,
}

/// The points of a rigid body and the two hidden points whose dofs move them; of a reference point, which belongs to no mesh, the hidden
/// points alone.
///
/// Rotations are small: a point moves by `q + θ × arm`. The first hidden point has the translation `q`, the second `θ` times a length
/// of the body, so that all unknowns are lengths and all that acts on them are forces. In the plane `θ` has one component, which is
/// the first of its point.
#[derive(Debug, Clone, PartialEq)]
pub struct Link {
    /// The points.
    pub points: Range<usize>,
    /// The centre of mass, or the reference point `[m]`.
    pub centre: Vec3,
    /// From the centre to each of the points `[m]`.
    pub arms: Vec<Vec3>,
    /// The first hidden point; the second follows it.
    pub hidden: usize,
    /// The length that rotations are multiplied by `[m]`.
    pub length: f64,
    /// What the body may do.
    pub freedom: Freedom,
    /// Whether a frame places the points, so that they may turn by any angle.
    pub framed: bool,
}

impl Link {
    /// The hidden dofs that have a meaning, and which.
    pub fn motions(&self, dofs: Dofs) -> Vec<(usize, Motion)> {
        let move_along = |i| (dofs.of(self.hidden, i), Motion::Translation(i));
        let turn = self.hidden + 1;
        match self.freedom {
            Freedom::Carried => Vec::new(),
            Freedom::Axial => vec![move_along(1)],
            Freedom::Plane => vec![
                move_along(0),
                move_along(1),
                (dofs.of(turn, 0), Motion::Rotation(2)),
            ],
            Freedom::Space => (0..3)
                .map(move_along)
                .chain((0..3).map(|i| (dofs.of(turn, i), Motion::Rotation(i))))
                .collect(),
        }
    }

    /// The rotation `[rad]` in a vector by dof.
    pub fn rotation(&self, dofs: Dofs, u: &[f64]) -> Vec3 {
        scale(1.0 / self.length, dofs.vector(u, self.hidden + 1))
    }

    /// The hidden dof of a motion; `None` where it has none.
    pub fn dof(&self, dofs: Dofs, motion: Motion) -> Option<usize> {
        let mut all = self.motions(dofs).into_iter();
        all.find(|(_, m)| *m == motion).map(|(dof, _)| dof)
    }

    /// By which hidden dofs a point moves in a direction, and how far; of what a frame places, nothing is left to say.
    fn row(&self, dofs: Dofs, point: usize, component: usize) -> Row {
        if self.framed {
            return [(dofs.of(self.hidden, component), 0.0); 3];
        }
        self.row_at(dofs, self.arms[point - self.points.start], component)
    }

    /// The same for what moves along at an arm `[m]` from the centre.
    pub fn row_at(&self, dofs: Dofs, arm: Vec3, component: usize) -> Row {
        let arm = scale(1.0 / self.length, arm);
        let (q, turn) = (dofs.of(self.hidden, component), self.hidden + 1);
        match (self.freedom, component) {
            (Freedom::Carried, _) => [(q, 0.0); 3],
            (Freedom::Axial, 1) => [(q, 1.0), (q, 0.0), (q, 0.0)],
            (Freedom::Axial, _) => [(q, 0.0); 3],
            (Freedom::Plane, 0) => [(q, 1.0), (dofs.of(turn, 0), -arm[1]), (q, 0.0)],
            (Freedom::Plane, _) => [(q, 1.0), (dofs.of(turn, 0), arm[0]), (q, 0.0)],
            (Freedom::Space, c) => {
                let (a, b) = ((c + 1) % 3, (c + 2) % 3);
                [
                    (q, 1.0),
                    (dofs.of(turn, a), arm[b]),
                    (dofs.of(turn, b), -arm[a]),
                ]
            }
        }
    }
}

/// A row of `T`: hidden dofs and factors, some of them zero.
pub type Row = [(usize, f64); 3];

/// A dof of a reference point that does nothing but follow what points of bodies do: a weighted sum of their displacements.
#[derive(Debug, Clone, PartialEq)]
pub struct DependentNode {
    /// The dof.
    pub dof: usize,
    /// Dofs of points and factors.
    pub row: Vec<(usize, f64)>,
}

/// All rigid bodies of a model: `u = T q` at their points, by the dofs `q` of their hidden points. Reference points stand among them.
///
/// Where there are none, everything here does nothing.
#[derive(Debug, Clone, PartialEq)]
pub struct Links {
    dofs: Dofs,
    all: Vec<Link>,
    followers: Vec<DependentNode>,
    /// The rigid body of every point, [`NONE`] without one; empty if there are none at all.
    owner: Vec<u32>,
}

const NONE: u32 = u32::MAX;

impl Links {
    /// Links with the points of each, no two sharing any.
    ///
    /// # Panics
    /// If a link names a point that does not exist, or has not one arm a point.
    pub fn new(dofs: Dofs, all: Vec<Link>) -> Self {
        let mut owner = Vec::new();
        if !all.is_empty() {
            owner.resize(dofs.points, NONE);
        }
        for (i, link) in all.iter().enumerate() {
            assert_eq!(link.points.len(), link.arms.len(), "arms of a rigid body");
            owner[link.points.clone()].fill(i as u32);
        }
        Links {
            dofs,
            all,
            followers: Vec::new(),
            owner,
        }
    }

    /// The same with dofs that follow points of bodies.
    #[must_use]
    pub fn with_followers(mut self, followers: Vec<DependentNode>) -> Self {
        self.followers = followers;
        self
    }

    /// The numbering of dofs, hidden points counted.
    pub fn dofs(&self) -> Dofs {
        self.dofs
    }

    /// The points whose displacements are handed to dofs that follow.
    pub fn followed(&self) -> impl Iterator<Item = usize> + '_ {
        let rows = self.followers.iter().flat_map(|f| &f.row);
        rows.map(|(dof, _)| self.dofs.locate(*dof).0)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// The rigid bodies.
    pub fn all(&self) -> &[Link] {
        &self.all
    }

    /// The rigid body that a point belongs to, hidden points not counted.
    pub fn of_point(&self, point: usize) -> Option<usize> {
        match self.owner.get(point) {
            None | Some(&NONE) => None,
            Some(&i) => Some(i as usize),
        }
    }

    /// The rigid body that has this hidden point.
    pub fn of_hidden(&self, point: usize) -> Option<usize> {
        self.all
            .iter()
            .position(|l| l.hidden == point || l.hidden + 1 == point)
    }

    /// Whether a hidden point is there for the rotation of its body.
    pub fn turns(&self, point: usize) -> bool {
        self.all.iter().any(|l| l.hidden + 1 == point)
    }

    /// The row of `T` for a dof of a rigid body's point; `None` for all others.
    pub fn row(&self, dof: usize) -> Option<Row> {
        let (point, component) = self.dofs.locate(dof);
        let link = &self.all[self.of_point(point)?];
        Some(link.row(self.dofs, point, component))
    }

    /// Terms of a sum of displacements by the dofs that move them: those of points of rigid bodies by hidden ones.
    pub fn moved(&self, terms: impl IntoIterator<Item = (usize, f64)>) -> Vec<(usize, f64)> {
        let mut out: Vec<(usize, f64)> = Vec::new();
        let mut known = BTreeMap::new();
        let mut add = |dof: usize, a: f64| {
            let at = *known.entry(dof).or_insert_with(|| {
                out.push((dof, 0.0));
                out.len() - 1
            });
            out[at].1 += a;
        };
        for (dof, a) in terms {
            match self.row(dof) {
                None => add(dof, a),
                Some(hidden) => hidden.into_iter().for_each(|(d, f)| add(d, f * a)),
            }
        }
        out
    }

    /// The same where the body has not turned yet: velocities and supports at the start.
    pub fn row_at_start(&self, dof: usize) -> Option<Row> {
        let (point, component) = self.dofs.locate(dof);
        let link = &self.all[self.of_point(point)?];
        Some(link.row_at(self.dofs, link.arms[point - link.points.start], component))
    }

    /// Visits the dofs of all points of rigid bodies with their rows.
    fn rows(&self, visit: &mut dyn FnMut(usize, Row)) {
        for link in &self.all {
            for point in link.points.clone() {
                for c in 0..self.dofs.dim {
                    visit(self.dofs.of(point, c), link.row(self.dofs, point, c));
                }
            }
        }
    }

    /// Marks what is no unknown: the points of rigid bodies, and hidden dofs without a meaning.
    pub fn dependent(&self, marks: &mut [bool]) {
        for link in &self.all {
            let nodal = self.dofs.of(link.points.start, 0)..self.dofs.of(link.points.end, 0);
            marks[nodal].fill(true);
            let hidden = self.dofs.of(link.hidden, 0)..self.dofs.of(link.hidden + 2, 0);
            let motions = link.motions(self.dofs);
            for dof in hidden {
                marks[dof] |= motions.iter().all(|(d, _)| *d != dof);
            }
        }
        for follower in &self.followers {
            marks[follower.dof] = true;
        }
    }

    /// Moves the points of rigid bodies as the hidden dofs say: displacements, their increments, velocities, accelerations.
    pub fn impose(&self, u: &mut [f64]) {
        self.rows(&mut |dof, row| {
            u[dof] = row.iter().map(|&(hidden, factor)| factor * u[hidden]).sum();
        });
        for DependentNode { dof, row } in &self.followers {
            u[*dof] = row.iter().map(|&(other, factor)| factor * u[other]).sum();
        }
    }

    /// `Tᵀ f`: moves the forces on points of rigid bodies to the hidden dofs.
    pub fn transfer(&self, f: &mut [f64]) {
        for DependentNode { dof, row } in &self.followers {
            let force = f[*dof];
            f[*dof] = 0.0;
            if force != 0.0 {
                row.iter()
                    .for_each(|&(other, factor)| f[other] += factor * force);
            }
        }
        self.rows(&mut |dof, row| {
            let force = f[dof];
            f[dof] = 0.0;
            if force != 0.0 {
                for (hidden, factor) in row {
                    f[hidden] += factor * force;
                }
            }
        });
    }

    /// Marks the points of rigid bodies in directions in which no free dof moves them.
    pub fn still(&self, fixed: &[bool], marks: &mut [bool]) {
        self.rows(&mut |dof, row| {
            marks[dof] = row.iter().all(|&(d, factor)| factor == 0.0 || fixed[d]);
        });
    }

    /// Adds a spring between a dof and the ground `[N/m]` to a matrix that couples the hidden points of each body.
    pub fn add_spring(&self, matrix: &mut BlockCsr, dof: usize, stiffness: f64) {
        let (points, dense) = self.spring(dof, stiffness);
        match points[..] {
            [_] => matrix.add_diagonal(dof, stiffness),
            _ => matrix.add_group(&points, &dense),
        }
    }

    /// The same as a dense matrix, row by row, and its points.
    pub fn spring(&self, dof: usize, stiffness: f64) -> (Vec<usize>, Vec<f64>) {
        let (point, component) = self.dofs.locate(dof);
        let Some(link) = self.of_point(point).map(|i| &self.all[i]) else {
            let width = self.dofs.dim;
            let mut dense = vec![0.0; width * width];
            dense[component * (width + 1)] = stiffness;
            return (vec![point], dense);
        };
        let row = link.row(self.dofs, point, component);
        let first = self.dofs.of(link.hidden, 0);
        let width = 2 * self.dofs.dim;
        let mut dense = vec![0.0; width * width];
        for (a, fa) in row {
            for (b, fb) in row {
                dense[(a - first) * width + b - first] += fa * stiffness * fb;
            }
        }
        (vec![link.hidden, link.hidden + 1], dense)
    }

    /// The block `Tᵀ K T` over the dofs that move those of a block; `None` if none of them is of a rigid body.
    pub fn transform(&self, block: &ContactBlock) -> Option<ContactBlock> {
        let (dofs, rows) = self.replace(&block.dofs)?;
        Some(congruent_block(block, dofs, &rows))
    }

    /// The dofs that move these, each once; `None` if none of them is of a rigid body.
    pub fn transform_dofs(&self, dofs: &[usize]) -> Option<Vec<usize>> {
        Some(self.replace(dofs)?.0)
    }

    /// The dofs that move these, each once, and the row of each of these with positions among them.
    fn replace(&self, dofs: &[usize]) -> Option<(Vec<usize>, Vec<Row>)> {
        if self.is_empty() {
            return None;
        }
        let bound = |dof: &usize| self.of_point(self.dofs.locate(*dof).0).is_some();
        if !dofs.iter().any(bound) {
            return None;
        }
        let mut new: Vec<usize> = Vec::with_capacity(dofs.len());
        let rows = dofs
            .iter()
            .map(|&dof| {
                let row = self
                    .row(dof)
                    .unwrap_or([(dof, 1.0), (dof, 0.0), (dof, 0.0)]);
                row.map(|(dof, factor)| {
                    let at = new.iter().position(|&d| d == dof).unwrap_or_else(|| {
                        new.push(dof);
                        new.len() - 1
                    });
                    (at, factor)
                })
            })
            .collect();
        Some((new, rows))
    }

    /// The largest rotation `[rad]` of those that are linearised.
    pub fn largest_rotation(&self, u: &[f64]) -> f64 {
        let linear = self.all.iter().filter(|l| !l.framed);
        let angles = linear.map(|l| norm(l.rotation(self.dofs, u)));
        angles.fold(0.0, f64::max)
    }
}

/// `Tᵀ K T` over the dofs that move those of the block, with the rows of `T`.
pub(super) fn congruent_block<const W: usize>(
    block: &ContactBlock,
    dofs: Vec<usize>,
    rows: &[[(usize, f64); W]],
) -> ContactBlock {
    let m = dofs.len();
    ContactBlock {
        hessian: congruent(rows, m, &block.hessian),
        surrogate: congruent(rows, m, &block.surrogate),
        rows: columns(rows, m, &block.rows),
        change: columns(rows, m, &block.change),
        dofs,
    }
}

/// `Tᵀ K T` with the rows of `T`, which has `m` columns; empty if `K` is.
fn congruent<const W: usize>(rows: &[[(usize, f64); W]], m: usize, k: &[f64]) -> Vec<f64> {
    if k.is_empty() {
        return Vec::new();
    }
    let n = rows.len();
    let mut out = vec![0.0; m * m];
    let mut product = vec![0.0; m];
    for (i, left) in rows.iter().enumerate() {
        product.fill(0.0);
        for (k, right) in k[i * n..(i + 1) * n].iter().zip(rows) {
            for &(column, factor) in right {
                product[column] += k * factor;
            }
        }
        for &(row, factor) in left.iter().filter(|(_, factor)| *factor != 0.0) {
            for (o, p) in out[row * m..(row + 1) * m].iter_mut().zip(&product) {
                *o += factor * p;
            }
        }
    }
    out
}

/// `A T` with the rows of `T`, which has `m` columns.
pub(super) fn columns<const W: usize>(rows: &[[(usize, f64); W]], m: usize, a: &[f64]) -> Vec<f64> {
    let n = rows.len();
    let mut out = vec![0.0; a.len() / n.max(1) * m];
    for (a, o) in a.chunks_exact(n).zip(out.chunks_exact_mut(m)) {
        for (a, row) in a.iter().zip(rows) {
            for &(column, factor) in row {
                o[column] += a * factor;
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers without a pattern.
    fn noise(count: usize, seed: f64) -> Vec<f64> {
        (0..count)
            .map(|i| (12.9898 * (i as f64 + seed)).sin() * 1.7)
            .collect()
    }

    /// Points 0 and 1 are free, 2 to 4 and 5 to 6 are two rigid bodies, 7 to 10 are hidden.
    fn sample(freedom: Freedom) -> (Dofs, Links) {
        let dim = if freedom == Freedom::Space { 3 } else { 2 };
        let dofs = Dofs { dim, points: 11 };
        let arm = |i: usize| {
            let x = noise(3, i as f64);
            [x[0], x[1], if dim == 3 { x[2] } else { 0.0 }]
        };
        let link = |points: Range<usize>, hidden, length| Link {
            centre: [0.0; 3],
            arms: points.clone().map(arm).collect(),
            points,
            hidden,
            length,
            freedom,
            framed: false,
        };
        (
            dofs,
            Links::new(dofs, vec![link(2..5, 7, 0.7), link(5..7, 9, 2.0)]),
        )
    }

    const ALL: [Freedom; 3] = [Freedom::Axial, Freedom::Plane, Freedom::Space];

    /// `T` as a dense matrix over all dofs: free dofs follow themselves.
    fn dense(dofs: Dofs, links: &Links) -> Vec<Vec<f64>> {
        let n = dofs.count();
        let mut columns: Vec<Vec<f64>> = Vec::new();
        for j in 0..n {
            let mut u = vec![0.0; n];
            u[j] = 1.0;
            links.impose(&mut u);
            columns.push(u);
        }
        (0..n)
            .map(|i| (0..n).map(|j| columns[j][i]).collect())
            .collect()
    }

    #[test]
    fn points_move_by_translation_and_cross_product() {
        use crate::math::{add, cross};
        for freedom in [Freedom::Plane, Freedom::Space] {
            let (dofs, links) = sample(freedom);
            let mut u = noise(dofs.count(), 0.3);
            links.impose(&mut u);
            for link in links.all() {
                let q = dofs.vector(&u, link.hidden);
                let turned = link.rotation(dofs, &u);
                let theta = match freedom {
                    Freedom::Space => turned,
                    _ => [0.0, 0.0, turned[0]],
                };
                for (p, &arm) in link.points.clone().zip(&link.arms) {
                    let expected = add(q, cross(theta, arm));
                    let found = dofs.vector(&u, p);
                    for c in 0..dofs.dim {
                        assert!((found[c] - expected[c]).abs() < 1e-14, "{freedom:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn along_an_axis_only_the_axial_direction_moves() {
        let (dofs, links) = sample(Freedom::Axial);
        let mut u = noise(dofs.count(), 0.3);
        links.impose(&mut u);
        assert_eq!(dofs.vector(&u, 3), [0.0, u[dofs.of(7, 1)], 0.0]);
        let mut marks = vec![false; dofs.count()];
        links.dependent(&mut marks);
        let free = (dofs.of(7, 0)..dofs.count()).filter(|&i| !marks[i]);
        assert_eq!(
            free.collect::<Vec<_>>(),
            [dofs.of(7, 1), dofs.of(9, 1)].to_vec()
        );
    }

    #[test]
    fn virtual_work_is_the_same() {
        for freedom in ALL {
            let (dofs, links) = sample(freedom);
            let mut u = noise(dofs.count(), 0.9);
            links.impose(&mut u);
            let f = noise(dofs.count(), 5.1);
            // Forces on hidden dofs are there already.
            let before: f64 = f.iter().zip(&u).map(|(f, u)| f * u).sum();
            let mut moved = f.clone();
            links.transfer(&mut moved);
            let after: f64 = moved.iter().zip(&u).map(|(f, u)| f * u).sum();
            assert!((before - after).abs() < 1e-12 * before.abs().max(1.0));
            for p in 2..7 {
                assert_eq!(dofs.vector(&moved, p), [0.0; 3]);
            }
        }
    }

    #[test]
    fn blocks_become_the_dense_product() {
        for freedom in ALL {
            let (dofs, links) = sample(freedom);
            let points = [1, 3, 2, 6];
            let list: Vec<usize> = points
                .iter()
                .flat_map(|&p| (0..dofs.dim).map(move |c| dofs.of(p, c)))
                .collect();
            let n = list.len();
            let block = ContactBlock {
                hessian: noise(n * n, 2.0),
                surrogate: noise(n * n, 7.0),
                rows: noise(3 * n, 11.0),
                change: noise(3 * n, 13.0),
                dofs: list.clone(),
            };
            let found = links.transform(&block).expect("rigid points");
            let coupled = links.transform_dofs(&list);
            assert_eq!(coupled.as_deref(), Some(found.dofs.as_slice()));
            let t = dense(dofs, &links);
            for (k, kt) in [
                (&block.tangent(), &found.tangent()),
                (&block.hessian, &found.hessian),
                (&block.surrogate, &found.surrogate),
            ] {
                let m = found.dofs.len();
                for (i, &gi) in found.dofs.iter().enumerate() {
                    for (j, &gj) in found.dofs.iter().enumerate() {
                        let mut expected = 0.0;
                        for (a, &ga) in list.iter().enumerate() {
                            for (b, &gb) in list.iter().enumerate() {
                                expected += t[ga][gi] * k[a * n + b] * t[gb][gj];
                            }
                        }
                        assert!((kt[i * m + j] - expected).abs() < 1e-11, "{freedom:?}");
                    }
                }
            }
            for (a, at) in [(&block.rows, &found.rows), (&block.change, &found.change)] {
                let m = found.dofs.len();
                for (a, at) in a.chunks(n).zip(at.chunks(m)) {
                    for (&gi, found) in found.dofs.iter().zip(at) {
                        let expected: f64 = list.iter().zip(a).map(|(&ga, a)| a * t[ga][gi]).sum();
                        assert!((found - expected).abs() < 1e-12, "{freedom:?}");
                    }
                }
            }
            let free = ContactBlock {
                dofs: vec![0, 1],
                surrogate: vec![1.0; 4],
                ..ContactBlock::default()
            };
            assert_eq!(links.transform(&free), None);
            let straight = ContactBlock {
                hessian: Vec::new(),
                ..block
            };
            let found = links.transform(&straight).expect("rigid points");
            assert!(found.hessian.is_empty());
        }
    }

    #[test]
    fn springs_have_the_energy_of_the_points_they_hold() {
        for freedom in ALL {
            let (dofs, links) = sample(freedom);
            let mut matrix = BlockCsr::from_couplings(dofs.points, dofs.dim, &mut |add| {
                add(&[7, 8]);
                add(&[9, 10]);
            });
            let springs = [
                (dofs.of(0, 1), 2.0),
                (dofs.of(4, 0), 3.0),
                (dofs.of(5, 1), 4.0),
            ];
            for (dof, k) in springs {
                links.add_spring(&mut matrix, dof, k);
            }
            let mut u = noise(dofs.count(), 0.4);
            links.impose(&mut u);
            let mut force = vec![0.0; u.len()];
            matrix.mul(&u, &mut force);
            let twice: f64 = force.iter().zip(&u).map(|(f, u)| f * u).sum();
            let expected: f64 = springs.iter().map(|&(dof, k)| k * u[dof] * u[dof]).sum();
            assert!((twice - expected).abs() < 1e-12 * expected, "{freedom:?}");
        }
    }

    #[test]
    fn points_are_still_when_all_that_moves_them_is_fixed() {
        let (dofs, links) = sample(Freedom::Plane);
        let mut fixed = vec![false; dofs.count()];
        links.dependent(&mut fixed);
        fixed[dofs.of(7, 0)] = true;
        let mut marks = vec![true; dofs.count()];
        links.still(&fixed, &mut marks);
        assert!(!marks[dofs.of(2, 0)] && !marks[dofs.of(2, 1)]);
        fixed[dofs.of(8, 0)] = true;
        links.still(&fixed, &mut marks);
        assert!(marks[dofs.of(2, 0)] && !marks[dofs.of(2, 1)] && !marks[dofs.of(5, 0)]);
    }

    #[test]
    fn without_rigid_bodies_nothing_happens() {
        let dofs = Dofs { dim: 2, points: 3 };
        let links = Links::new(dofs, Vec::new());
        let mut u = noise(6, 0.0);
        let before = u.clone();
        links.impose(&mut u);
        links.transfer(&mut u);
        assert_eq!(u, before);
        assert!(links.is_empty() && links.transform_dofs(&[0, 1]).is_none());
        assert_eq!(links.largest_rotation(&u), 0.0);
    }
}
