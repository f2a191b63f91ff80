//! Which fronts one task works on.

use std::ops::Range;

use super::super::ordering::NONE;
use super::tree::FrontTree;

/// Splitting ends at this depth, so that the recursion over pieces stays shallow.
const DEEPEST: usize = 64;

/// Fronts that one task goes through in order: a whole subtree, or one front above the subtrees.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Piece {
    /// The fronts; the last one is above all others.
    pub fronts: Range<usize>,
    /// The pieces whose contributions the (only) front takes.
    pub children: Vec<u32>,
    /// Whether it contributes to the root.
    pub last: bool,
}

impl Piece {
    /// The front above the others.
    pub fn top(&self) -> usize {
        self.fronts.end - 1
    }

    /// Splits the tree by its work alone, so that nothing depends on the number of threads.
    pub fn partition(tree: &FrontTree) -> Vec<Piece> {
        let n = tree.len();
        let mut work: Vec<f64> = (0..n).map(|front| tree.flops_of(front)).collect();
        let mut begin: Vec<usize> = (0..n).collect();
        for front in 0..n {
            let parent = tree.parents[front] as usize;
            if parent < n {
                work[parent] += work[front];
                begin[parent] = begin[parent].min(begin[front]);
            }
        }
        let total: f64 = (0..n)
            .filter(|&front| tree.parents[front] == NONE)
            .map(|front| work[front])
            .sum();
        // A subtree is split while it holds more than a sixteenth of all work, and more than 1e7 additions and multiplications: less is not
        // worth a task of its own.
        let most = (total / 16.0).max(1e7);
        // Parents come after their children: go down from the last.
        let mut split = vec![false; n];
        let mut depth = vec![0; n];
        let mut pieces = Vec::new();
        let mut piece_of = vec![0u32; n];
        for front in (0..n).rev() {
            let parent = tree.parents[front];
            let above = parent == NONE || split[parent as usize];
            depth[front] = if parent == NONE {
                0
            } else {
                depth[parent as usize] + 1
            };
            split[front] = above && work[front] > most && depth[front] < DEEPEST;
            if above {
                let begin = if split[front] { front } else { begin[front] };
                pieces.push(Piece {
                    fronts: begin..front + 1,
                    children: Vec::new(),
                    last: parent == NONE,
                });
            }
        }
        pieces.reverse();
        for (at, piece) in pieces.iter_mut().enumerate() {
            let top = piece.top();
            piece_of[top] = at as u32;
            if split[top] {
                let children = tree.children(top).iter();
                piece.children = children.map(|&front| piece_of[front as usize]).collect();
            }
        }
        pieces
    }

    /// The largest sizes of two stacks that hold the contributions of the fronts below the top: those of even and of
    /// odd depth. A front finds its children on top of the one stack and adds its own to the other.
    pub fn stacks(&self, tree: &FrontTree, size: impl Fn(usize) -> usize) -> [usize; 2] {
        let (mut now, mut most) = ([0; 2], [0; 2]);
        let odd = self.depths(tree);
        for front in self.fronts.clone() {
            let own = odd.of(front);
            for &child in tree
                .children(front)
                .iter()
                .filter(|_| self.children.is_empty())
            {
                now[1 - own] -= size(child as usize);
            }
            if front != self.top() {
                now[own] += size(front);
                most[own] = most[own].max(now[own]);
            }
        }
        most
    }

    /// The parity of the depth of each front below the top.
    pub fn depths(&self, tree: &FrontTree) -> Depths {
        let start = self.fronts.start;
        let mut odd = vec![0u8; self.fronts.len()];
        for front in self.fronts.clone().rev().skip(1) {
            odd[front - start] = 1 - odd[tree.parents[front] as usize - start];
        }
        Depths { start, odd }
    }

    /// The most numbers held by contributions at any time if one task does all.
    pub fn peak(pieces: &[Piece], tree: &FrontTree) -> u64 {
        let square = |front: usize| (tree.sizes(front).1 as u64).pow(2);
        let mut peaks = vec![0u64; pieces.len()];
        let mut most = 0;
        for (at, piece) in pieces.iter().enumerate() {
            let own = square(piece.top());
            let stacks = piece.stacks(tree, |front| square(front) as usize);
            let (mut held, mut peak) = (0, 0);
            for &child in &piece.children {
                peak = peak.max(held + peaks[child as usize]);
                held += square(pieces[child as usize].top());
            }
            peaks[at] = peak.max(held + own + (stacks[0] + stacks[1]) as u64);
            if piece.last {
                most = most.max(peaks[at]);
            }
        }
        most
    }
}

/// Parities of depths in a piece.
pub(super) struct Depths {
    start: usize,
    odd: Vec<u8>,
}

impl Depths {
    /// 0 for the top and every second level below it, 1 for the others.
    #[inline]
    pub fn of(&self, front: usize) -> usize {
        usize::from(self.odd[front - self.start])
    }
}
