use std::ops::Range;

use super::super::ordering::NONE;
use super::super::{BlockCsr, LinearError};
use super::graph::{Elimination, Nodes};
use super::schedule::Piece;
use super::supernodes::Supernodes;
use super::tree::FrontTree;

/// Where the entries of a partial factor are; its size and cost are known before any arithmetic.
///
/// The interior points are ordered by nested dissection without the kept ones; the rows of the kept ones are carried
/// along. Front by front the eliminated dofs are contiguous in [`interior`](Fronts::interior). A *position* is a
/// place in `interior`, or behind it in [`root`](Fronts::root).
#[derive(Debug, Clone, PartialEq)]
pub struct Fronts {
    /// Points and block size of the matrix analysed.
    pub(super) shape: (usize, usize),
    pub(super) points: Range<usize>,
    pub(super) interior: Vec<u32>,
    pub(super) root: Vec<u32>,
    /// The position of each dof of `points`, or [`NONE`].
    pub(super) position_of: Vec<u32>,
    /// The fronts.
    pub(super) tree: FrontTree,
    /// Positions of the rows below the eliminated ones, ascending in each front.
    pub(super) rows: Vec<u32>,
    /// The same rows as local rows of the front above (its eliminated ones first), or as places in `root`.
    pub(super) targets: Vec<u32>,
    /// What one task does, children first.
    pub(super) pieces: Vec<Piece>,
}

impl Fronts {
    /// Analyses the substructure of the given `points` without the dofs marked in `fixed` (one mark a dof of
    /// `matrix`); the free dofs of the points marked in `kept` (one mark a point of `matrix`) are not eliminated.
    ///
    /// # Errors
    /// [`LinearError::NotAnalysed`] if a free dof of `points` is coupled to a free dof of another point;
    /// [`LinearError::OutOfMemory`].
    ///
    /// # Panics
    /// If `fixed` or `kept` has the wrong length, or `points` do not exist.
    pub fn analyze(
        matrix: &BlockCsr,
        points: Range<usize>,
        fixed: &[bool],
        kept: &[bool],
    ) -> Result<Fronts, LinearError> {
        assert_eq!(fixed.len(), matrix.rows(), "length of `fixed`");
        assert_eq!(kept.len(), matrix.points(), "length of `kept`");
        assert!(points.start <= points.end && points.end <= kept.len());
        let nodes = Nodes::new(matrix, points, fixed, kept)?;
        Fronts::of_nodes(&nodes, &nodes.elimination())
    }

    /// For an order of elimination.
    pub(super) fn of_nodes(
        nodes: &Nodes,
        elimination: &Elimination,
    ) -> Result<Fronts, LinearError> {
        let counts = nodes.column_counts(elimination, |_| 1);
        let supernodes = Supernodes::new(&elimination.tree, &counts, nodes.shape().1);
        let rows = nodes.rows(&elimination.order, &supernodes);
        Fronts::of_groups(nodes, &elimination.order, supernodes, &rows)
    }

    /// From the groups of steps eliminated together, and the nodes in the rows below each.
    fn of_groups(
        nodes: &Nodes,
        order: &[u32],
        supernodes: Supernodes,
        rows: &[Vec<u32>],
    ) -> Result<Fronts, LinearError> {
        let Supernodes { groups, parents } = supernodes;
        let mut tree = FrontTree::of(parents).expect("groups come subtree by subtree");
        let mut interior = Vec::new();
        for group in &groups {
            for &step in group {
                interior.extend(nodes.free(order[step as usize]));
            }
            tree.first.push(interior.len() as u32);
        }
        let kept = nodes.inner.len()..nodes.count();
        let root: Vec<u32> = kept.flat_map(|node| nodes.free(node as u32)).collect();
        if interior.len() + root.len() >= NONE as usize {
            return Err(LinearError::OutOfMemory { bytes: 0 });
        }
        let mut fronts = Fronts {
            shape: nodes.shape(),
            points: nodes.points.clone(),
            interior,
            root,
            position_of: Vec::new(),
            tree,
            rows: Vec::new(),
            targets: Vec::new(),
            pieces: Vec::new(),
        };
        fronts.number_positions();
        let origin = fronts.points.start * fronts.shape.1;
        for rows in rows {
            for &node in rows {
                let dofs = nodes.free(node).map(|dof| dof as usize - origin);
                let positions = dofs.map(|dof| fronts.position_of[dof]);
                fronts.rows.extend(positions);
            }
            fronts.tree.row_starts.push(fronts.rows.len());
        }
        // Rows of a front are among those of the front above it, by construction.
        let linked = fronts.link();
        debug_assert!(linked.is_some());
        Ok(fronts)
    }

    /// Fills `position_of` from `interior` and `root`.
    pub(super) fn number_positions(&mut self) {
        let b = self.shape.1;
        self.position_of = vec![NONE; self.points.len() * b];
        for (position, &dof) in self.interior.iter().chain(&self.root).enumerate() {
            self.position_of[dof as usize - self.points.start * b] = position as u32;
        }
    }

    /// Fills what follows from the rows and the tree; `None` if rows are missing in a front above.
    pub(super) fn link(&mut self) -> Option<()> {
        let mut targets = Vec::with_capacity(self.rows.len());
        for (front, &parent) in self.tree.parents.iter().enumerate() {
            let (own, above) = match parent {
                NONE => (self.interior.len()..self.interior.len(), None),
                _ => (
                    self.columns(parent as usize),
                    Some(self.rows(parent as usize)),
                ),
            };
            let mut at = 0;
            for &row in self.rows(front) {
                let local = (row as usize).checked_sub(own.start)?;
                match above {
                    Some(above) if local >= own.len() => {
                        at += above.get(at..)?.iter().position(|&r| r == row)?;
                        targets.push((own.len() + at) as u32);
                    }
                    _ => targets.push(local as u32),
                }
            }
        }
        self.targets = targets;
        self.pieces = Piece::partition(&self.tree);
        Some(())
    }

    /// Two of these free dofs whose coupling the factor has no entry for. What it stores counts, not what the matrix couples: fill can be used by any
    /// block. Of an analysis that keeps nothing.
    pub(super) fn first_uncovered(&self, dofs: &[usize]) -> Option<[usize; 2]> {
        let positions = dofs.iter().map(|&dof| (self.position_of[dof], dof));
        let mut free: Vec<_> = positions.filter(|(at, _)| *at != NONE).collect();
        free.sort_unstable();
        free.iter().enumerate().find_map(|(i, &(column, dof))| {
            let front = self.tree.first.partition_point(|&first| first <= column) - 1;
            let (end, below) = (self.tree.first[front + 1], self.rows(front));
            let missing = |row: &u32| *row >= end && below.binary_search(row).is_err();
            let other = free[i + 1..].iter().find(|(row, _)| missing(row))?.1;
            Some([dof, other])
        })
    }

    /// Number of fronts, without the root.
    pub(super) fn len(&self) -> usize {
        self.tree.len()
    }

    /// Positions a front eliminates.
    #[inline]
    pub(super) fn columns(&self, front: usize) -> Range<usize> {
        self.tree.columns(front)
    }

    /// Positions of the rows of a front below the eliminated ones.
    #[inline]
    pub(super) fn rows(&self, front: usize) -> &[u32] {
        &self.rows[self.tree.rows(front)]
    }

    /// Where the rows of a front are in the front above.
    #[inline]
    pub(super) fn targets(&self, front: usize) -> &[u32] {
        &self.targets[self.tree.rows(front)]
    }

    /// The fronts that contribute to a front, ascending.
    #[inline]
    pub(super) fn children(&self, front: usize) -> &[u32] {
        self.tree.children(front)
    }

    /// Columns and rows below them of a front.
    #[inline]
    pub(super) fn sizes(&self, front: usize) -> (usize, usize) {
        self.tree.sizes(front)
    }

    /// The eliminated dofs in the order of elimination.
    pub fn interior(&self) -> &[u32] {
        &self.interior
    }

    /// The kept free dofs, ascending.
    pub fn root(&self) -> &[u32] {
        &self.root
    }

    /// Additions and multiplications of the partial factorisation, those of the Schur complement included.
    pub fn flops(&self) -> f64 {
        (0..self.len()).map(|front| self.tree.flops_of(front)).sum()
    }

    /// Stored entries of the factor on and below the diagonal, with the zeros stored to make its blocks larger.
    pub fn nonzeros(&self) -> usize {
        let entries = |(columns, rows)| columns * (columns + 1) / 2 + columns * rows;
        (0..self.len())
            .map(|front| entries(self.sizes(front)))
            .sum()
    }

    /// The points analysed.
    pub fn points(&self) -> Range<usize> {
        self.points.clone()
    }

    /// Dofs a point.
    pub fn block_size(&self) -> usize {
        self.shape.1
    }

    /// About the memory held \[bytes\].
    pub fn bytes(&self) -> u64 {
        let words = self.interior.len()
            + self.root.len()
            + self.position_of.len()
            + 2 * self.rows.len()
            + 8 * self.len();
        4 * words as u64
    }

    /// The most numbers that a factorisation asks of its workspace at once.
    pub fn longest(&self) -> usize {
        let square = |front: usize| self.sizes(front).1.pow(2);
        let of_piece = |piece: &Piece| {
            let [even, odd] = piece.stacks(&self.tree, square);
            even.max(odd).max(square(piece.top()))
        };
        let pieces = self.pieces.iter().map(of_piece);
        pieces.max().unwrap_or(0).max(self.root.len().pow(2))
    }

    /// About the memory a factorisation needs at most, the Schur complement and the factor included \[bytes\].
    pub fn peak_bytes(&self) -> u64 {
        let blocks: u64 = (0..self.len())
            .map(|front| self.sizes(front))
            .map(|(columns, rows)| columns as u64 * (columns + rows) as u64)
            .sum();
        let schur = (self.root.len() as u64).pow(2);
        let words = self.position_of.len() + self.interior.len() + 2 * self.rows.len();
        8 * (blocks + schur + Piece::peak(&self.pieces, &self.tree)) + 4 * words as u64
    }
}
