use std::ops::Range;

use super::super::ordering::{NONE, elimination_order, elimination_tree};
use super::super::symbolic::FIXED;
use super::super::{BlockCsr, LinearError};
use super::graph::{check_closed, column_counts, couplings, rows_of_groups};
use super::schedule::Piece;
use super::supernodes::Supernodes;

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
    /// The position of each dof of `points`, or [`FIXED`].
    pub(super) position_of: Vec<u32>,
    /// The first position a front eliminates; length `fronts + 1`.
    pub(super) first: Vec<u32>,
    /// The front above, or [`NONE`] for the root.
    pub(super) parents: Vec<u32>,
    /// Where the rows of a front start in `rows`; length `fronts + 1`.
    pub(super) row_starts: Vec<usize>,
    /// Positions of the rows below the eliminated ones, ascending in each front.
    pub(super) rows: Vec<u32>,
    /// The same rows as local rows of the front above (its eliminated ones first), or as places in `root`.
    pub(super) targets: Vec<u32>,
    /// Where the children of a front start in `children`; length `fronts + 1`.
    pub(super) child_starts: Vec<u32>,
    pub(super) children: Vec<u32>,
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
        let b = matrix.block_size();
        let free = |point: usize| (point * b..(point + 1) * b).filter(|&dof| !fixed[dof]);
        let active = |point: &usize| free(*point).next().is_some();
        check_closed(matrix, &points, fixed)?;

        let inner: Vec<u32> = (points.clone())
            .filter(|p| !kept[*p] && active(p))
            .map(|p| p as u32)
            .collect();
        let outer: Vec<u32> = (points.clone())
            .filter(|p| kept[*p] && active(p))
            .map(|p| p as u32)
            .collect();
        let mut node_of = vec![NONE; points.len()];
        for (node, &point) in inner.iter().chain(&outer).enumerate() {
            node_of[point as usize - points.start] = node as u32;
        }
        let node_of = |point: u32| {
            let local = (point as usize).checked_sub(points.start);
            local.and_then(|at| node_of.get(at)).map_or(NONE, |&n| n)
        };

        let graph = couplings(
            matrix,
            &inner,
            |node, own| (node as usize) < inner.len() && node != own,
            node_of,
        );
        let order = elimination_order(&graph);
        let tree = elimination_tree(&graph, &order);
        drop(graph);
        // From here on the nodes are numbered by elimination, the kept ones behind.
        let mut step_of = vec![NONE; inner.len() + outer.len()];
        for (step, &node) in order.iter().enumerate() {
            step_of[node as usize] = step as u32;
        }
        for (node, step) in step_of.iter_mut().enumerate().skip(inner.len()) {
            *step = node as u32;
        }
        let counts = column_counts(matrix, &inner, &outer, &order, &step_of, node_of)?;
        let supernodes = Supernodes::new(&tree, &counts[..inner.len()], b);

        // And now once more, by groups of columns.
        let mut fronts = Fronts {
            shape: (matrix.points(), b),
            points: points.clone(),
            interior: Vec::new(),
            root: outer
                .iter()
                .flat_map(|&p| free(p as usize))
                .map(|dof| dof as u32)
                .collect(),
            position_of: Vec::new(),
            first: vec![0],
            parents: supernodes.parents,
            row_starts: vec![0],
            rows: Vec::new(),
            targets: Vec::new(),
            child_starts: Vec::new(),
            children: Vec::new(),
            pieces: Vec::new(),
        };
        let mut place_of = vec![NONE; step_of.len()];
        let mut place = 0;
        for group in &supernodes.groups {
            for &step in group {
                let node = order[step as usize] as usize;
                place_of[node] = place;
                place += 1;
                fronts
                    .interior
                    .extend(free(inner[node] as usize).map(|dof| dof as u32));
            }
            fronts.first.push(fronts.interior.len() as u32);
        }
        for (node, place) in place_of.iter_mut().enumerate().skip(inner.len()) {
            *place = node as u32;
        }
        if fronts.interior.len() + fronts.root.len() >= FIXED as usize {
            return Err(LinearError::OutOfMemory { bytes: 0 });
        }
        fronts.number_positions();

        // Rows of the fronts, first by places of points.
        let mut point_at = vec![0; place_of.len()];
        for (node, &place) in place_of.iter().enumerate() {
            point_at[place as usize] = *inner
                .get(node)
                .unwrap_or_else(|| &outer[node - inner.len()]);
        }
        let rows = rows_of_groups(
            &supernodes.groups,
            &fronts.parents,
            |at| {
                let point = point_at[at as usize];
                (matrix.neighbours(point as usize).iter())
                    .map(|&other| node_of(other))
                    .filter(|&node| node != NONE)
                    .map(|node| place_of[node as usize])
            },
            place_of.len(),
        );
        for places in rows {
            for place in places {
                let dofs = free(point_at[place as usize] as usize);
                fronts
                    .rows
                    .extend(dofs.map(|dof| fronts.position_of[dof - points.start * b]));
            }
            fronts.row_starts.push(fronts.rows.len());
        }
        // Rows of a front are among those of the front above it, by construction.
        let linked = fronts.link();
        debug_assert!(linked.is_some());
        Ok(fronts)
    }

    /// Fills `position_of` from `interior` and `root`.
    pub(super) fn number_positions(&mut self) {
        let b = self.shape.1;
        self.position_of = vec![FIXED; self.points.len() * b];
        for (position, &dof) in self.interior.iter().chain(&self.root).enumerate() {
            self.position_of[dof as usize - self.points.start * b] = position as u32;
        }
    }

    /// Fills what follows from the rows and parents; `None` if rows are missing in a front above.
    pub(super) fn link(&mut self) -> Option<()> {
        let fronts = self.len();
        let mut starts = vec![0u32; fronts + 1];
        for &parent in self.parents.iter().filter(|p| **p != NONE) {
            starts[parent as usize + 1] += 1;
        }
        for i in 0..fronts {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        self.children = vec![0; starts[fronts] as usize];
        for (front, &parent) in self.parents.iter().enumerate() {
            if parent != NONE {
                self.children[next[parent as usize] as usize] = front as u32;
                next[parent as usize] += 1;
            }
        }
        self.child_starts = starts;

        let mut targets = Vec::with_capacity(self.rows.len());
        for (front, &parent) in self.parents.iter().enumerate() {
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
        self.pieces = Piece::partition(self);
        Some(())
    }

    /// Number of fronts, without the root.
    pub(super) fn len(&self) -> usize {
        self.parents.len()
    }

    /// Positions a front eliminates.
    #[inline]
    pub(super) fn columns(&self, front: usize) -> Range<usize> {
        self.first[front] as usize..self.first[front + 1] as usize
    }

    /// Positions of the rows of a front below the eliminated ones.
    #[inline]
    pub(super) fn rows(&self, front: usize) -> &[u32] {
        &self.rows[self.row_starts[front]..self.row_starts[front + 1]]
    }

    /// Where the rows of a front are in the front above.
    #[inline]
    pub(super) fn targets(&self, front: usize) -> &[u32] {
        &self.targets[self.row_starts[front]..self.row_starts[front + 1]]
    }

    /// The fronts that contribute to a front, ascending.
    #[inline]
    pub(super) fn children(&self, front: usize) -> &[u32] {
        &self.children[self.child_starts[front] as usize..self.child_starts[front + 1] as usize]
    }

    /// Columns and rows below them of a front.
    #[inline]
    pub(super) fn sizes(&self, front: usize) -> (usize, usize) {
        (
            self.columns(front).len(),
            self.row_starts[front + 1] - self.row_starts[front],
        )
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
        (0..self.len()).map(|front| self.flops_of(front)).sum()
    }

    /// The same for one front: the square of the length of each column.
    pub(super) fn flops_of(&self, front: usize) -> f64 {
        let (columns, rows) = self.sizes(front);
        let sum = |n: f64| n * (n + 1.0) * (2.0 * n + 1.0) / 6.0;
        sum((columns + rows) as f64) - sum(rows as f64)
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
            + 8 * self.parents.len();
        4 * words as u64
    }

    /// About the memory a factorisation needs at most, the Schur complement and the factor included \[bytes\].
    pub fn peak_bytes(&self) -> u64 {
        let blocks: u64 = (0..self.len())
            .map(|front| self.sizes(front))
            .map(|(columns, rows)| columns as u64 * (columns + rows) as u64)
            .sum();
        let schur = (self.root.len() as u64).pow(2);
        let words = self.position_of.len() + self.interior.len() + 2 * self.rows.len();
        8 * (blocks + schur + Piece::peak(self)) + 4 * words as u64
    }
}
