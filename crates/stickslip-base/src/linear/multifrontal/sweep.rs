//! Forward and backward substitution, front by front.

use std::sync::{Mutex, PoisonError};

use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::{Accum, MatMut, MatRef, Par};
use rayon::prelude::*;

use super::kernels::{back_substitute, substitute};
use super::numeric::PartialFactor;
use super::symbolic::Fronts;

/// Columns that share one pass over the factor.
const COLUMNS_A_PASS: usize = 32;

/// One pass over the factor. Vectors are stored position by position, the columns of a position side by side.
struct Sweep<'a> {
    factor: &'a PartialFactor,
    columns: usize,
    /// The eliminated positions of each piece.
    parts: Vec<Mutex<&'a mut [f64]>>,
}

/// `y := L_II⁻¹ f_I` in place of `interior` and `root -= L_CI y`, for several columns one after the other,
/// in the order of [`Fronts::interior`] and of [`Fronts::root`].
///
/// # Panics
/// If `interior` or `root` has the wrong length.
pub fn forward(factor: &PartialFactor, interior: &mut [f64], root: &mut [f64], columns: usize) {
    let (n, c) = check(factor, interior, root, columns);
    if columns == 1 {
        return Sweep::new(factor, interior, 1).forward(root);
    }
    for start in (0..columns).step_by(COLUMNS_A_PASS) {
        let count = COLUMNS_A_PASS.min(columns - start);
        let interior = &mut interior[start * n..(start + count) * n];
        let root = &mut root[start * c..(start + count) * c];
        let mut x = side_by_side(interior, n, count);
        let mut w = side_by_side(root, c, count);
        Sweep::new(factor, &mut x, count).forward(&mut w);
        one_by_one(&x, interior, n, count);
        one_by_one(&w, root, c, count);
    }
}

/// `u_I := L_II⁻ᵀ (y - L_CIᵀ u_C)` in place of `interior`, which holds `y`; `root` holds `u_C`. Layout as in
/// [`forward`].
///
/// # Panics
/// If `interior` or `root` has the wrong length.
pub fn backward(factor: &PartialFactor, interior: &mut [f64], root: &[f64], columns: usize) {
    let (n, c) = check(factor, interior, root, columns);
    if columns == 1 {
        return Sweep::new(factor, interior, 1).backward(root);
    }
    for start in (0..columns).step_by(COLUMNS_A_PASS) {
        let count = COLUMNS_A_PASS.min(columns - start);
        let interior = &mut interior[start * n..(start + count) * n];
        let root = &root[start * c..(start + count) * c];
        let (mut x, w) = (
            side_by_side(interior, n, count),
            side_by_side(root, c, count),
        );
        Sweep::new(factor, &mut x, count).backward(&w);
        one_by_one(&x, interior, n, count);
    }
}

/// Checks the lengths and returns the numbers of eliminated and of kept dofs.
fn check(factor: &PartialFactor, interior: &[f64], root: &[f64], columns: usize) -> (usize, usize) {
    let (n, c) = (factor.fronts.interior.len(), factor.fronts.root.len());
    assert_eq!(interior.len(), n * columns, "length of the interior");
    assert_eq!(root.len(), c * columns, "length of the root");
    (n, c)
}

/// Columns of `n` numbers, stored row by row.
fn side_by_side(columns: &[f64], n: usize, count: usize) -> Vec<f64> {
    let mut x = vec![0.0; n * count];
    for (i, row) in x.chunks_exact_mut(count).enumerate() {
        for (j, x) in row.iter_mut().enumerate() {
            *x = columns[j * n + i];
        }
    }
    x
}

/// And back.
fn one_by_one(x: &[f64], columns: &mut [f64], n: usize, count: usize) {
    for (i, row) in x.chunks_exact(count).enumerate() {
        for (j, x) in row.iter().enumerate() {
            columns[j * n + i] = *x;
        }
    }
}

/// Adds the rows of a contribution to the rows `targets`.
fn scatter(vector: &mut [f64], targets: &[u32], contribution: &[f64], columns: usize) {
    if columns == 1 {
        for (&target, value) in targets.iter().zip(contribution) {
            vector[target as usize] += value;
        }
        return;
    }
    for (&target, values) in targets.iter().zip(contribution.chunks_exact(columns)) {
        let target = &mut vector[target as usize * columns..][..columns];
        for (t, v) in target.iter_mut().zip(values) {
            *t += v;
        }
    }
}

impl<'a> Sweep<'a> {
    fn new(factor: &'a PartialFactor, mut x: &'a mut [f64], columns: usize) -> Sweep<'a> {
        let fronts = &factor.fronts;
        let mut parts = Vec::with_capacity(fronts.pieces.len());
        for piece in &fronts.pieces {
            let count: usize = piece.fronts.clone().map(|f| fronts.columns(f).len()).sum();
            let (own, rest) = x.split_at_mut(count * columns);
            parts.push(Mutex::new(own));
            x = rest;
        }
        Sweep {
            factor,
            columns,
            parts,
        }
    }

    fn fronts(&self) -> &'a Fronts {
        &self.factor.fronts
    }

    /// The pieces that contribute to the root.
    fn last(&self) -> Vec<u32> {
        let pieces = &self.fronts().pieces;
        (0..pieces.len() as u32)
            .filter(|&at| pieces[at as usize].last)
            .collect()
    }

    fn forward(&self, root: &mut [f64]) {
        let last = self.last();
        for (&at, contribution) in last.iter().zip(self.forward_pieces(&last)) {
            let targets = self
                .fronts()
                .targets(self.fronts().pieces[at as usize].top());
            scatter(root, targets, &contribution, self.columns);
        }
    }

    fn forward_pieces(&self, pieces: &[u32]) -> Vec<Vec<f64>> {
        match pieces {
            [one] => vec![self.forward_piece(*one as usize)],
            _ => pieces
                .par_iter()
                .map(|&at| self.forward_piece(at as usize))
                .collect(),
        }
    }

    /// Goes through a piece and what is below it; what it contributes to its rows.
    fn forward_piece(&self, at: usize) -> Vec<f64> {
        let (fronts, c) = (self.fronts(), self.columns);
        let piece = &fronts.pieces[at];
        let contributions = self.forward_pieces(&piece.children);
        let mut x = self.parts[at]
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        let mut panels = &self.factor.panels[at][..];
        let rows = |front: usize| fronts.sizes(front).1 * c;
        let mut stacks = piece.stacks(&fronts.tree, rows).map(|size| vec![0.0; size]);
        let mut tops = [0; 2];
        let depths = piece.depths(&fronts.tree);
        let mut vector = vec![0.0; tallest(fronts, piece.fronts.clone()) * c];
        let mut product = vec![0.0; if c > 1 { vector.len() } else { 0 }];
        let mut done = 0;
        for front in piece.fronts.clone() {
            let (columns, rows_below) = fronts.sizes(front);
            let height = columns + rows_below;
            let vector = &mut vector[..height * c];
            let own = &mut x[done..done + columns * c];
            done += own.len();
            vector[..columns * c].copy_from_slice(own);
            vector[columns * c..].fill(0.0);
            let parity = depths.of(front);
            if piece.children.is_empty() {
                let children = fronts.children(front);
                let size: usize = children.iter().map(|&child| rows(child as usize)).sum();
                tops[1 - parity] -= size;
                let mut start = tops[1 - parity];
                for &child in children {
                    let contribution = &stacks[1 - parity][start..][..rows(child as usize)];
                    start += contribution.len();
                    scatter(vector, fronts.targets(child as usize), contribution, c);
                }
            } else {
                for (&child, contribution) in fronts.children(front).iter().zip(&contributions) {
                    scatter(vector, fronts.targets(child as usize), contribution, c);
                }
            }
            let (panel, rest) = panels.split_at(height * columns);
            panels = rest;
            if c == 1 {
                substitute(panel, columns, vector);
            } else {
                let l = MatRef::from_column_major_slice(panel, height, columns);
                let (pivots, below) = l.split_at_row(columns);
                let (y, w) = vector.split_at_mut(columns * c);
                let mut y = MatMut::from_row_major_slice_mut(y, columns, c);
                solve_lower_triangular_in_place(pivots, y.as_mut(), Par::Seq);
                // Column by column: the product with long columns is twice as fast as with short rows.
                let product = &mut product[..rows_below * c];
                let target = MatMut::from_column_major_slice_mut(&mut *product, rows_below, c);
                matmul(target, Accum::Replace, below, y.as_ref(), -1.0, Par::Seq);
                for (i, w) in w.chunks_exact_mut(c).enumerate() {
                    for (w, p) in w.iter_mut().zip(product[i..].iter().step_by(rows_below)) {
                        *w += p;
                    }
                }
            }
            own.copy_from_slice(&vector[..columns * c]);
            if front != piece.top() {
                stacks[parity][tops[parity]..][..rows(front)]
                    .copy_from_slice(&vector[columns * c..]);
                tops[parity] += rows(front);
            }
        }
        let top = piece.top();
        vector.truncate((fronts.sizes(top).0) * c + rows(top));
        vector.drain(..fronts.sizes(top).0 * c);
        vector
    }

    fn backward(&self, root: &[f64]) {
        self.backward_pieces(&self.last(), root);
    }

    /// Goes down through pieces that take their rows from `vector`.
    fn backward_pieces(&self, pieces: &[u32], vector: &[f64]) {
        let go = |at: usize| {
            let targets = self.fronts().targets(self.fronts().pieces[at].top());
            let mut rows = Vec::with_capacity(targets.len() * self.columns);
            for &target in targets {
                rows.extend_from_slice(&vector[target as usize * self.columns..][..self.columns]);
            }
            self.backward_piece(at, rows);
        };
        match pieces {
            [one] => go(*one as usize),
            _ => pieces.par_iter().for_each(|&at| go(at as usize)),
        }
    }

    /// Goes down through a piece, `rows` being those of its top, and through what is below it.
    fn backward_piece(&self, at: usize, rows: Vec<f64>) {
        let (fronts, c) = (self.fronts(), self.columns);
        let piece = &fronts.pieces[at];
        let mut x = self.parts[at]
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        let mut panels = &self.factor.panels[at][..];
        let begin = fronts.columns(piece.fronts.start).start;
        let mut vector = vec![0.0; tallest(fronts, piece.fronts.clone()) * c];
        // The rows of the fronts from the top down to the present one.
        let mut stack = rows;
        let mut above = vec![(piece.top(), 0)];
        for front in piece.fronts.clone().rev() {
            let (columns, rows_below) = fronts.sizes(front);
            let height = columns + rows_below;
            let vector = &mut vector[..height * c];
            let (own, w) = vector.split_at_mut(columns * c);
            let start = (fronts.columns(front).start - begin) * c;
            own.copy_from_slice(&x[start..][..columns * c]);
            if front == piece.top() {
                w.copy_from_slice(&stack);
            } else {
                let parent = fronts.tree.parents[front] as usize;
                while above.last().is_some_and(|&(last, _)| last != parent) {
                    above.pop();
                }
                let of_parent = above.last().map_or(0, |&(_, start)| start);
                let parent_columns = fronts.columns(parent).len();
                stack.truncate(of_parent + fronts.sizes(parent).1 * c);
                let x_parent = (fronts.columns(parent).start - begin) * c;
                for (w, &target) in w.chunks_exact_mut(c).zip(fronts.targets(front)) {
                    let target = target as usize;
                    w.copy_from_slice(match target.checked_sub(parent_columns) {
                        None => &x[x_parent + target * c..][..c],
                        Some(row) => &stack[of_parent + row * c..][..c],
                    });
                }
                if !fronts.children(front).is_empty() {
                    above.push((front, stack.len()));
                    stack.extend_from_slice(w);
                }
            }
            let (rest, panel) = panels.split_at(panels.len() - height * columns);
            panels = rest;
            if c == 1 {
                back_substitute(panel, columns, vector);
            } else {
                let l = MatRef::from_column_major_slice(panel, height, columns);
                let (pivots, below) = l.split_at_row(columns);
                let (y, w) = vector.split_at_mut(columns * c);
                let mut y = MatMut::from_row_major_slice_mut(y, columns, c);
                let w = MatRef::from_row_major_slice(&*w, rows_below, c);
                matmul(y.as_mut(), Accum::Add, below.transpose(), w, -1.0, Par::Seq);
                solve_upper_triangular_in_place(pivots.transpose(), y, Par::Seq);
            }
            x[start..][..columns * c].copy_from_slice(&vector[..columns * c]);
        }
        drop(x);
        if !piece.children.is_empty() {
            // The only front of the piece is the last one seen.
            self.backward_pieces(&piece.children, &vector);
        }
    }
}

/// The most rows of a front.
fn tallest(fronts: &Fronts, range: std::ops::Range<usize>) -> usize {
    range
        .map(|front| fronts.sizes(front).0 + fronts.sizes(front).1)
        .max()
        .unwrap_or(0)
}
