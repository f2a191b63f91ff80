//! Graphs of points: what is coupled, and what elimination couples.

use std::ops::Range;

use super::super::ordering::{Graph, NONE, elimination_order, elimination_tree};
use super::super::{BlockCsr, LinearError};
use super::supernodes::Supernodes;

/// The nodes in the order of elimination, and the step above each step in the elimination tree, or [`NONE`].
pub(super) struct Elimination {
    pub order: Vec<u32>,
    pub tree: Vec<u32>,
}

/// The points of a substructure that have free dofs, as nodes of a graph: those that are eliminated, behind them the kept ones.
pub(super) struct Nodes<'a> {
    matrix: &'a BlockCsr,
    fixed: &'a [bool],
    /// The points of the substructure.
    pub points: Range<usize>,
    /// Points that are eliminated.
    pub inner: Vec<u32>,
    /// Points that are kept.
    outer: Vec<u32>,
    /// The node of each of the points, or [`NONE`].
    node_of: Vec<u32>,
    /// Pairs of nodes that are coupled although the matrix does not couple them, both ways, ascending.
    extra: Vec<(u32, u32)>,
}

impl<'a> Nodes<'a> {
    /// The nodes of some points. Refuses couplings of a free dof of these points to a free dof elsewhere.
    pub fn new(
        matrix: &'a BlockCsr,
        points: Range<usize>,
        fixed: &'a [bool],
        kept: &[bool],
    ) -> Result<Nodes<'a>, LinearError> {
        let mut nodes = Nodes {
            matrix,
            fixed,
            inner: Vec::new(),
            outer: Vec::new(),
            node_of: vec![NONE; points.len()],
            extra: Vec::new(),
            points,
        };
        nodes.check_closed()?;
        for point in nodes.points.clone() {
            if nodes.free_of(point).next().is_some() {
                let list = if kept[point] {
                    &mut nodes.outer
                } else {
                    &mut nodes.inner
                };
                list.push(point as u32);
            }
        }
        for (node, &point) in nodes.inner.iter().chain(&nodes.outer).enumerate() {
            nodes.node_of[point as usize - nodes.points.start] = node as u32;
        }
        Ok(nodes)
    }

    fn check_closed(&self) -> Result<(), LinearError> {
        for point in self.points.clone() {
            let Some(dof) = self.free_of(point).next() else {
                continue;
            };
            let outside = (self.matrix.neighbours(point).iter())
                .map(|&other| other as usize)
                .filter(|other| !self.points.contains(other))
                .find_map(|other| self.free_of(other).next());
            if let Some(other) = outside {
                return Err(LinearError::NotAnalysed { dofs: [dof, other] });
            }
        }
        Ok(())
    }

    /// Couples the dofs of each group with each other.
    pub fn couple(&mut self, groups: &[Vec<usize>]) {
        let mut extra = Vec::new();
        for group in groups {
            let points = group.iter().map(|dof| dof / self.matrix.block_size());
            let mut nodes: Vec<u32> = points
                .map(|point| self.node_of[point - self.points.start])
                .filter(|&node| node != NONE)
                .collect();
            nodes.sort_unstable();
            nodes.dedup();
            for &i in &nodes {
                let coupled = self.matrix.neighbours(self.point(i));
                let new = |j: &u32| coupled.binary_search(&(self.point(*j) as u32)).is_err();
                extra.extend(nodes.iter().copied().filter(new).map(|j| (i, j)));
            }
        }
        extra.sort_unstable();
        extra.dedup();
        self.extra = extra;
    }

    fn free_of(&self, point: usize) -> impl Iterator<Item = usize> {
        let b = self.matrix.block_size();
        (point * b..(point + 1) * b).filter(|&dof| !self.fixed[dof])
    }

    /// Number of nodes.
    pub fn count(&self) -> usize {
        self.inner.len() + self.outer.len()
    }

    /// Points and block size of the matrix.
    pub fn shape(&self) -> (usize, usize) {
        (self.matrix.points(), self.matrix.block_size())
    }

    /// The free dofs of a node.
    pub fn free(&self, node: u32) -> impl Iterator<Item = u32> {
        self.free_of(self.point(node)).map(|dof| dof as u32)
    }

    fn point(&self, node: u32) -> usize {
        let node = node as usize;
        let point = match node.checked_sub(self.inner.len()) {
            None => self.inner[node],
            Some(kept) => self.outer[kept],
        };
        point as usize
    }

    /// The nodes that a node is coupled to, itself among them.
    fn coupled(&self, node: u32) -> impl Iterator<Item = u32> {
        let others = self.matrix.neighbours(self.point(node)).iter();
        others
            .filter_map(|&other| (other as usize).checked_sub(self.points.start))
            .filter_map(|local| self.node_of.get(local).copied())
            .filter(|&node| node != NONE)
            .chain(self.extra_of(node))
    }

    fn extra_of(&self, node: u32) -> impl Iterator<Item = u32> {
        let start = self.extra.partition_point(|pair| pair.0 < node);
        let own = self.extra[start..].iter();
        own.take_while(move |pair| pair.0 == node)
            .map(|pair| pair.1)
    }

    /// The order in which those that are eliminated leave few entries.
    pub fn elimination(&self) -> Elimination {
        let graph = self.inner_graph();
        let order = elimination_order(&graph);
        let tree = elimination_tree(&graph, &order);
        Elimination { order, tree }
    }

    /// The couplings of the nodes that are eliminated.
    fn inner_graph(&self) -> Graph {
        let mut graph = Graph {
            starts: vec![0],
            neighbours: Vec::new(),
        };
        let count = self.inner.len() as u32;
        for own in 0..count {
            let others = self.coupled(own);
            let wanted = others.filter(|&other| other < count && other != own);
            graph.neighbours.extend(wanted);
            graph.starts.push(graph.neighbours.len());
        }
        graph
    }

    /// Entries in every column of the factor, by step of elimination, if a row counts for as much as `weight` says of its node: each row is a
    /// subtree of the elimination tree.
    pub fn column_counts(
        &self,
        elimination: &Elimination,
        weight: impl Fn(u32) -> usize,
    ) -> Vec<usize> {
        let Elimination { order, tree } = elimination;
        let nodes = self.with_kept(order.iter().copied());
        let step_of = inverse(&nodes);
        let mut counts: Vec<usize> = order.iter().map(|&node| weight(node)).collect();
        let mut seen_by = vec![NONE; counts.len()];
        for (row, &node) in nodes.iter().enumerate() {
            let own = weight(node);
            let end = row.min(counts.len());
            for other in self.coupled(node) {
                let mut step = step_of[other as usize] as usize;
                while step < end && seen_by[step] != row as u32 {
                    seen_by[step] = row as u32;
                    counts[step] += own;
                    step = tree[step] as usize;
                }
            }
        }
        counts
    }

    /// The nodes coupled to each group of steps behind its own ones, in the order of elimination by groups: couplings of its own and of its
    /// children.
    pub fn rows(&self, order: &[u32], supernodes: &Supernodes) -> Vec<Vec<u32>> {
        let steps = supernodes.groups.iter().flatten();
        let nodes = self.with_kept(steps.map(|&step| order[step as usize]));
        let place_of = inverse(&nodes);
        let coupled = |place: u32| {
            let others = self.coupled(nodes[place as usize]);
            others.map(|other| place_of[other as usize])
        };
        let mut rows = rows_of_groups(supernodes, coupled, nodes.len());
        for place in rows.iter_mut().flatten() {
            *place = nodes[*place as usize];
        }
        rows
    }

    /// The nodes eliminated in some order, behind them the kept ones.
    fn with_kept(&self, eliminated: impl Iterator<Item = u32>) -> Vec<u32> {
        let kept = self.inner.len() as u32..self.count() as u32;
        eliminated.chain(kept).collect()
    }
}

/// Where each number stands in a permutation.
fn inverse(permutation: &[u32]) -> Vec<u32> {
    let mut inverse = vec![NONE; permutation.len()];
    for (at, &number) in permutation.iter().enumerate() {
        inverse[number as usize] = at as u32;
    }
    inverse
}

/// The places of nodes coupled to each group behind its own ones, ascending: its couplings and those of its children.
fn rows_of_groups<I: Iterator<Item = u32>>(
    supernodes: &Supernodes,
    coupled: impl Fn(u32) -> I,
    places: usize,
) -> Vec<Vec<u32>> {
    let Supernodes { groups, parents } = supernodes;
    let mut rows: Vec<Vec<u32>> = vec![Vec::new(); groups.len()];
    let mut seen_by = vec![NONE; places];
    let mut end = 0;
    for (at, group) in groups.iter().enumerate() {
        let start = end;
        end += group.len() as u32;
        let (before, above) = rows.split_at_mut(at + 1);
        let own = &mut before[at];
        let mut is_new = |place: u32| {
            let seen = &mut seen_by[place as usize];
            let new = *seen != at as u32;
            *seen = at as u32;
            new
        };
        own.retain(|&place| place >= end && is_new(place));
        for place in start..end {
            for other in coupled(place) {
                if other >= end && is_new(other) {
                    own.push(other);
                }
            }
        }
        own.sort_unstable();
        // A parent comes after its children.
        if parents[at] != NONE {
            above[parents[at] as usize - (at + 1)].extend_from_slice(own);
        }
    }
    rows
}
