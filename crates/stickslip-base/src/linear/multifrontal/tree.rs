use std::ops::Range;

use super::super::ordering::NONE;

/// The tree of the fronts: how many positions and rows each has, and which front takes its contribution.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FrontTree {
    /// The first position a front eliminates; length `fronts + 1`.
    pub first: Vec<u32>,
    /// The front above, or [`NONE`] for the root.
    pub parents: Vec<u32>,
    /// Where the rows of a front start among those of all fronts; length `fronts + 1`.
    pub row_starts: Vec<usize>,
    /// Where the children of a front start in `children`; length `fronts + 1`.
    child_starts: Vec<u32>,
    children: Vec<u32>,
}

impl FrontTree {
    /// Fronts with these parents; where their positions and rows are is still to be told. `None` if a parent does not come behind its children,
    /// or subtrees are not contiguous.
    pub fn of(parents: Vec<u32>) -> Option<FrontTree> {
        check(&parents)?;
        let fronts = parents.len();
        let mut starts = vec![0u32; fronts + 1];
        for &parent in parents.iter().filter(|p| **p != NONE) {
            starts[parent as usize + 1] += 1;
        }
        for i in 0..fronts {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut children = vec![0; starts[fronts] as usize];
        for (front, &parent) in parents.iter().enumerate() {
            if parent != NONE {
                children[next[parent as usize] as usize] = front as u32;
                next[parent as usize] += 1;
            }
        }
        Some(FrontTree {
            first: vec![0],
            parents,
            row_starts: vec![0],
            child_starts: starts,
            children,
        })
    }

    /// Number of fronts, without the root.
    pub fn len(&self) -> usize {
        self.parents.len()
    }

    /// Positions a front eliminates.
    #[inline]
    pub fn columns(&self, front: usize) -> Range<usize> {
        self.first[front] as usize..self.first[front + 1] as usize
    }

    /// Where the rows of a front are among those of all fronts.
    #[inline]
    pub fn rows(&self, front: usize) -> Range<usize> {
        self.row_starts[front]..self.row_starts[front + 1]
    }

    /// The fronts that contribute to a front, ascending.
    #[inline]
    pub fn children(&self, front: usize) -> &[u32] {
        &self.children[self.child_starts[front] as usize..self.child_starts[front + 1] as usize]
    }

    /// Columns and rows below them of a front.
    #[inline]
    pub fn sizes(&self, front: usize) -> (usize, usize) {
        (self.columns(front).len(), self.rows(front).len())
    }

    /// Additions and multiplications that the elimination of a front takes: the square of the length of each column.
    pub fn flops_of(&self, front: usize) -> f64 {
        let (columns, rows) = self.sizes(front);
        let sum = |n: f64| n * (n + 1.0) * (2.0 * n + 1.0) / 6.0;
        sum((columns + rows) as f64) - sum(rows as f64)
    }
}

fn check(parents: &[u32]) -> Option<()> {
    let count = parents.len();
    let mut sizes = vec![1usize; count];
    let mut begins: Vec<usize> = (0..count).collect();
    for (front, &parent) in parents.iter().enumerate() {
        if begins[front] + sizes[front] != front + 1 {
            return None;
        }
        if parent != NONE {
            let parent = parent as usize;
            if parent <= front || parent >= count {
                return None;
            }
            sizes[parent] += sizes[front];
            begins[parent] = begins[parent].min(begins[front]);
        }
    }
    Some(())
}
