//! Which points an interface looks at: those that may come into contact soon.

use super::{Interface, Primary};
use crate::contact::kinematics::mean_gap;
use crate::contact::response::Status;
use crate::contact::search::{Box3, Tree};
use crate::contact::surface::ContactPoint;
use crate::math::{Vec3, distance};

/// How far contact may come before somebody has to look again.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    /// Distance from the primary up to which a point of the secondary takes part, beyond what cells call for `[m]`.
    pub approach: f64,
    /// How far points may move along the primary `[m]`.
    pub along: f64,
    /// The time span in which obstacles move `[s]`.
    pub span: [f64; 2],
}

/// Positions of an obstacle that are looked at.
const POSES: usize = 9;

/// Cells beyond the reach that take part all the same.
const MARGIN: f64 = 2.0;

/// Part of the reach within which contact is expected to stay.
const INNER: f64 = 0.5;

impl Interface {
    /// Lets only those points take part that are within reach at displacements `u`, and marks their nodes and those they may meet among all
    /// points of the mesh. What is marked already, and what has been in contact, takes part in any case.
    pub fn limit(&mut self, u: &[f64], reach: Reach, kept: &mut [bool]) {
        self.ready();
        let x = self.coordinates(u);
        let distances = self.distances(&x, reach);
        let mut size: f64 = 0.0;
        let mut lists = Vec::new();
        if let Primary::Facets(facets) = &self.primary {
            let length = |nodes: &[usize]| distance(x[nodes[0]], x[nodes[1]]);
            size = facets.iter().map(|f| length(&f.nodes)).fold(0.0, f64::max);
            let tree = Tree::build(facets.iter().map(|f| f.nodes.iter().map(|&n| x[n])));
            let faces = self.mortar.iter().flat_map(|m| &m.faces);
            let own = faces.map(|f| length(&f.nodes)).fold(0.0, f64::max);
            let margin = reach.along + size + own;
            lists = (self.points.iter().zip(&distances))
                .map(|(point, &d)| {
                    let mut near = Vec::new();
                    if d <= reach.approach + MARGIN * size {
                        tree.near(point.position(&x), margin, &mut near);
                    }
                    near
                })
                .collect();
        }
        let own = self.points.iter().map(|p| p.size).fold(0.0, f64::max);
        let limit = reach.approach + MARGIN * size.max(own);
        let memory = &mut self.memory;
        memory.asleep.clear();
        memory.inner = Vec::with_capacity(distances.len());
        for (i, (point, &d)) in self.points.iter().zip(&distances).enumerate() {
            let known = point.nodes.iter().all(|&n| kept[self.nodes[n]]);
            let awake = d <= limit || known || memory.committed[i].status != Status::Open;
            memory.asleep.push(!awake);
            memory.inner.push(d <= INNER * limit || known);
            if !awake {
                continue;
            }
            for &n in &point.nodes {
                kept[self.nodes[n]] = true;
            }
            if let Some(mortar) = &self.mortar {
                let around = mortar.around[i].iter();
                for &n in around.flat_map(|&(f, _)| &mortar.faces[f].nodes) {
                    kept[self.nodes[n]] = true;
                }
            }
            if let (Primary::Facets(facets), Some(near)) = (&self.primary, lists.get(i)) {
                let was = memory.committed[i].facet;
                for &f in near.iter().chain(&was) {
                    for &n in &facets[f].nodes {
                        kept[self.nodes[n]] = true;
                    }
                }
            }
        }
        if memory.asleep.iter().all(|asleep| !asleep) {
            memory.asleep.clear();
        }
    }

    /// Lets all points take part and marks all nodes.
    pub fn wake(&mut self, kept: &mut [bool]) {
        self.memory.asleep.clear();
        self.memory.inner.clear();
        for &node in &self.nodes {
            kept[node] = true;
        }
    }

    /// Whether contact has come so near to points that do not take part that they should.
    pub fn spreads(&self) -> bool {
        if self.memory.asleep.is_empty() {
            return false;
        }
        let points = self.memory.last.points.iter().zip(&self.memory.inner);
        points
            .into_iter()
            .any(|(e, &inner)| !inner && e.response.status != Status::Open)
    }

    /// The number of points that do not take part although they penetrate the primary at displacements `u`.
    pub fn overlooked(&mut self, u: &[f64], t: f64) -> usize {
        if self.memory.asleep.is_empty() {
            return 0;
        }
        let x = self.coordinates(u);
        let span = Reach {
            approach: 0.0,
            along: 0.0,
            span: [t, t],
        };
        let asleep = self.memory.asleep.clone();
        let gaps = self.gaps(&x, span);
        let smallest = |i: usize| -1e-9 * self.points[i].size;
        (0..asleep.len())
            .filter(|&i| asleep[i] && gaps[i] < smallest(i))
            .count()
    }

    /// Finds the gaps of points that do not take part, for reports of the state with displacements `u` at time `t`.
    pub fn measure(&mut self, u: &[f64], t: f64) {
        if self.memory.asleep.is_empty() {
            return;
        }
        let x = self.coordinates(u);
        let here = Reach {
            approach: 0.0,
            along: 0.0,
            span: [t, t],
        };
        let gaps = self.gaps(&x, here);
        let memory = &mut self.memory;
        for (i, &gap) in gaps.iter().enumerate().filter(|(i, _)| memory.asleep[*i]) {
            if let Some(e) = memory.last.points.get_mut(i) {
                e.gap = gap;
            }
            memory.committed[i].gap = gap;
        }
    }

    /// Distances from the primary, whatever side of it.
    fn distances(&mut self, x: &[Vec3], reach: Reach) -> Vec<f64> {
        self.gaps(x, reach)
            .into_iter()
            .map(|g| g.max(0.0))
            .collect()
    }

    /// The smallest gaps over the span; infinite where a point does not face the primary.
    fn gaps(&mut self, x: &[Vec3], reach: Reach) -> Vec<f64> {
        let gaps = self.distances_to_primary(x, reach);
        let end = reach.span[1];
        let gaps = gaps.into_iter().enumerate();
        gaps.map(|(i, gap)| gap - self.initial.offset(i, end))
            .collect()
    }

    fn distances_to_primary(&mut self, x: &[Vec3], reach: Reach) -> Vec<f64> {
        match &self.primary {
            Primary::Rigid(shape, motion) => {
                let [from, to] = reach.span;
                let poses: Vec<_> = (0..POSES)
                    .map(|k| motion.pose(from + (to - from) * k as f64 / (POSES - 1) as f64))
                    .collect();
                let gap = |p: &ContactPoint| {
                    let gaps = poses
                        .iter()
                        .filter_map(|pose| mean_gap(shape.as_dyn(), pose, p, x));
                    gaps.fold(f64::INFINITY, f64::min)
                };
                self.points.iter().map(gap).collect()
            }
            Primary::Facets(_) => {
                self.search(x);
                let mut boxes: Vec<Box3> = Vec::new();
                self.enclose(x, &mut boxes);
                (0..self.points.len())
                    .map(|i| match self.closest(i, x, &boxes, None, None) {
                        Ok((_, foot)) => {
                            let away = crate::math::sub(self.points[i].position(x), foot.x);
                            crate::math::dot(away, foot.normal)
                        }
                        Err(distance) => distance,
                    })
                    .collect()
            }
        }
    }
}
