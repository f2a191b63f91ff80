//! Which facets a point may meet: a tree of boxes over the facets, asked for the facets near a point.

use super::facet_point::FACET_NODES;
use crate::math::Vec3;
use crate::shape::ElementKind;
use crate::tolerance::ROUNDING;

/// An axis-aligned box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Box3 {
    low: Vec3,
    high: Vec3,
}

impl Box3 {
    const EMPTY: Box3 = Box3 {
        low: [f64::INFINITY; 3],
        high: [f64::NEG_INFINITY; 3],
    };

    fn include(&mut self, other: &Box3) {
        for i in 0..3 {
            self.low[i] = self.low[i].min(other.low[i]);
            self.high[i] = self.high[i].max(other.high[i]);
        }
    }

    fn of(points: impl Iterator<Item = Vec3>) -> Box3 {
        points.fold(Box3::EMPTY, |mut b, p| {
            b.include(&Box3 { low: p, high: p });
            b
        })
    }

    /// A box around a facet with these nodes, bulges included.
    pub fn around(kind: ElementKind, nodes: impl Iterator<Item = Vec3>) -> Box3 {
        let mut x = [[0.0; 3]; FACET_NODES];
        let mut count = 0;
        for (x, node) in x.iter_mut().zip(nodes) {
            *x = node;
            count += 1;
        }
        let corners = kind.corner_count();
        let mut b = Box3::of(x[..corners.min(count)].iter().copied());
        // A quadratic facet is the linear one and, for each middle node, its distance from the middle of its edge times a function
        // between zero and one.
        for k in corners..count {
            let (from, to) = (x[k - corners], x[(k - corners + 1) % corners]);
            for i in 0..3 {
                let away = x[k][i] - 0.5 * (from[i] + to[i]);
                b.low[i] += away.min(0.0);
                b.high[i] += away.max(0.0);
            }
        }
        b
    }

    /// Squared distance from a point to the box.
    #[inline]
    pub fn distance2(&self, p: Vec3) -> f64 {
        (0..3)
            .map(|i| {
                (self.low[i] - p[i])
                    .max(p[i] - self.high[i])
                    .max(0.0)
                    .powi(2)
            })
            .sum()
    }

    /// Whether a ray meets the box.
    fn is_met(&self, from: Vec3, along: Vec3) -> bool {
        let (mut enters, mut leaves) = (0.0_f64, f64::INFINITY);
        for i in 0..3 {
            // Facets that are flat along an axis have no extent there.
            // Room around a box for a ray that touches it.
            let room = ROUNDING * (self.high[i].abs() + self.low[i].abs());
            let (low, high) = (self.low[i] - room, self.high[i] + room);
            if along[i] == 0.0 {
                if from[i] < low || from[i] > high {
                    return false;
                }
                continue;
            }
            let (a, b) = ((low - from[i]) / along[i], (high - from[i]) / along[i]);
            enters = enters.max(a.min(b));
            leaves = leaves.min(a.max(b));
        }
        enters <= leaves
    }

    fn centre(&self, axis: usize) -> f64 {
        0.5 * (self.low[axis] + self.high[axis])
    }

    /// Squared distance from a point to the farthest corner.
    fn farthest2(&self, p: Vec3) -> f64 {
        (0..3)
            .map(|i| {
                (p[i] - self.low[i])
                    .abs()
                    .max((self.high[i] - p[i]).abs())
                    .powi(2)
            })
            .sum()
    }
}

#[derive(Debug, Clone)]
struct Node {
    bounds: Box3,
    /// Leaves: first item and count. Inner nodes: the second child and 0; the first child follows the node.
    index: usize,
    count: usize,
}

/// A tree of boxes over facets. It is a value: built from coordinates, asked, thrown away.
#[derive(Debug, Clone, Default)]
pub struct Tree {
    nodes: Vec<Node>,
    items: Vec<usize>,
    boxes: Vec<Box3>,
}

const LEAF: usize = 4;

/// More nodes than any walk through a tree has before it: two for each level, which halves its items.
const STACK: usize = 2 * usize::BITS as usize;

/// Nodes a walk through a tree has still to visit.
struct Stack {
    nodes: [usize; STACK],
    count: usize,
}

impl Stack {
    fn new() -> Self {
        Stack {
            nodes: [0; STACK],
            count: 1,
        }
    }

    #[inline]
    fn push(&mut self, node: usize) {
        self.nodes[self.count] = node;
        self.count += 1;
    }

    #[inline]
    fn pop(&mut self) -> Option<usize> {
        self.count = self.count.checked_sub(1)?;
        Some(self.nodes[self.count])
    }
}

impl Tree {
    /// Builds the tree over facets given by their node coordinates. A curved facet may bulge out of the box of its nodes by
    /// less than its size; queries with a margin of that order find it all the same.
    pub fn build<I: Iterator<Item = Vec3>>(facets: impl Iterator<Item = I>) -> Tree {
        let boxes: Vec<Box3> = facets.map(Box3::of).collect();
        let mut tree = Tree {
            nodes: Vec::with_capacity(boxes.len()),
            items: (0..boxes.len()).collect(),
            boxes,
        };
        if !tree.items.is_empty() {
            tree.split(0, tree.items.len());
        }
        tree
    }

    fn split(&mut self, start: usize, end: usize) {
        let mut bounds = Box3::EMPTY;
        for &i in &self.items[start..end] {
            bounds.include(&self.boxes[i]);
        }
        let me = self.nodes.len();
        self.nodes.push(Node {
            bounds,
            index: start,
            count: end - start,
        });
        if end - start <= LEAF {
            return;
        }
        let extent = |a: usize| bounds.high[a] - bounds.low[a];
        let axis = (0..3).fold(0, |b, a| if extent(a) > extent(b) { a } else { b });
        let middle = start + (end - start) / 2;
        let boxes = &self.boxes;
        // Ties are broken by index, so that the tree depends on nothing but the facets.
        self.items[start..end].select_nth_unstable_by(middle - start, |&i, &j| {
            boxes[i]
                .centre(axis)
                .total_cmp(&boxes[j].centre(axis))
                .then(i.cmp(&j))
        });
        self.split(start, middle);
        let second = self.nodes.len();
        self.split(middle, end);
        self.nodes[me].index = second;
        self.nodes[me].count = 0;
    }

    /// All facets whose boxes come as near to `point` as the nearest facet can be, plus `margin`; sorted by index.
    pub fn near(&self, point: Vec3, margin: f64, out: &mut Vec<usize>) {
        out.clear();
        if self.nodes.is_empty() {
            return;
        }
        // The nearest facet is not farther than the farthest corner of any one box.
        let mut bound = f64::INFINITY;
        let mut reach = f64::INFINITY;
        let mut stack = Stack::new();
        while let Some(i) = stack.pop() {
            let node = &self.nodes[i];
            if node.bounds.distance2(point) > reach {
                continue;
            }
            if node.count == 0 {
                let (a, b) = (i + 1, node.index);
                let near = |i: usize| self.nodes[i].bounds.distance2(point);
                // the nearer child is looked at first
                let (first, second) = if near(a) <= near(b) { (a, b) } else { (b, a) };
                stack.push(second);
                stack.push(first);
                continue;
            }
            let items = &self.items[node.index..node.index + node.count];
            let farthest = |&item: &usize| self.boxes[item].farthest2(point);
            let nearest = items.iter().map(farthest).fold(bound, f64::min);
            if nearest < bound {
                bound = nearest;
                reach = (bound.sqrt() + margin).powi(2);
            }
            out.extend(
                items
                    .iter()
                    .filter(|&&item| self.boxes[item].distance2(point) <= reach),
            );
        }
        // What was met before the bound was known.
        out.retain(|&item| self.boxes[item].distance2(point) <= reach);
        out.sort_unstable();
    }

    /// All facets whose boxes a ray meets; sorted by index.
    pub fn along(&self, from: Vec3, direction: Vec3, out: &mut Vec<usize>) {
        out.clear();
        if self.nodes.is_empty() {
            return;
        }
        let mut stack = Stack::new();
        while let Some(i) = stack.pop() {
            let node = &self.nodes[i];
            if !node.bounds.is_met(from, direction) {
                continue;
            }
            if node.count == 0 {
                stack.push(i + 1);
                stack.push(node.index);
            } else {
                let items = &self.items[node.index..node.index + node.count];
                out.extend(
                    items
                        .iter()
                        .filter(|&&item| self.boxes[item].is_met(from, direction)),
                );
            }
        }
        out.sort_unstable();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_what_a_scan_finds() {
        // segments along a wavy line
        let facet = |i: usize| {
            let p = |k: usize| [k as f64 * 0.1, (k as f64 * 0.7).sin(), 0.0];
            [p(i), p(i + 1)]
        };
        let tree = Tree::build((0..200).map(|i| facet(i).into_iter()));
        let mut found = Vec::new();
        for k in 0..50 {
            let point = [k as f64 * 0.41, (k as f64).cos() * 1.5, 0.0];
            tree.near(point, 0.05, &mut found);
            let boxes: Vec<Box3> = (0..200).map(|i| Box3::of(facet(i).into_iter())).collect();
            let bound = boxes
                .iter()
                .map(|b| b.farthest2(point))
                .fold(f64::INFINITY, f64::min)
                .sqrt()
                + 0.05;
            let scan: Vec<usize> = (0..200)
                .filter(|&i| boxes[i].distance2(point) <= bound * bound)
                .collect();
            assert_eq!(found, scan);
        }
    }

    #[test]
    fn boxes_hold_curved_facets() {
        use crate::contact::facet_point::evaluate;
        for kind in [
            ElementKind::Line2,
            ElementKind::Line3,
            ElementKind::Tri3,
            ElementKind::Tri6,
            ElementKind::Quad4,
            ElementKind::Quad8,
        ] {
            let bent = |(k, x): (usize, &Vec3)| {
                let wave = |c: usize| 0.2 * (3.7 * (k + 5 * c) as f64).sin();
                [x[0] + wave(0), x[1] + wave(1), wave(2)]
            };
            let nodes = kind.reference().nodes().iter().enumerate();
            let nodes: Vec<Vec3> = nodes.map(bent).collect();
            let b = Box3::around(kind, nodes.iter().copied());
            for i in 0..21 {
                for j in 0..21 {
                    let (s, t) = (i as f64 / 20.0, j as f64 / 20.0);
                    let xi = match kind.is_simplex() {
                        true => [s, (1.0 - s) * t],
                        false => [2.0 * s - 1.0, 2.0 * t - 1.0],
                    };
                    let x = evaluate(kind, &nodes, xi).x;
                    assert!(b.distance2(x) < 1e-28, "{kind} at {xi:?}");
                }
            }
            let extent = |i: usize| b.high[i] - b.low[i];
            assert!(extent(0) < 4.0 && extent(2) < 2.0, "{kind}");
        }
    }
}
