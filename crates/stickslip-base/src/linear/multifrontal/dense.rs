//! The dense kernels of a front.
//!
//! A front with `p` eliminated columns and `r` rows below has a panel of shape `(p + r, p)` and a contribution of
//! shape `(r, r)`, both column by column, of which the lower triangle counts.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{
    LltError, LltRegularization, cholesky_in_place, cholesky_in_place_scratch,
};
use faer::linalg::matmul::{matmul, triangular};
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Accum, MatMut, MatRef, Par, Spec};
use rayon::prelude::*;

/// Columns of a panel eliminated at a time.
pub(super) const PANEL_COLUMNS: usize = 128;

/// Rows and columns of a product made at a time, and the depth to which it is made; fixed, so that results never depend on the number of
/// threads. A target of this size stays in the second cache while all depth is added to it: on an AVX-512 core with 2 MiB of it 60 GF/s for
/// a product of order 2352 and depth 512 to 1000, where one call for the whole reaches 50, and where sizes of 192 to 768 and depths of 96
/// to 256 reach 54 to 60.
const PRODUCT_TILE: usize = 240;
const PRODUCT_DEPTH: usize = 128;

/// Columns of the root that one task adds to.
const ROOT_COLUMNS_PER_TASK: usize = 384;

/// A contribution to be added: its order, the local rows of the front above, and its values.
#[derive(Clone, Copy)]
pub(super) struct Child<'a> {
    pub targets: &'a [u32],
    pub values: &'a [f64],
}

/// Whether a front is large enough to be shared by tasks.
pub(super) fn is_large(flops: f64) -> bool {
    // Fronts with less work, in additions and multiplications, stay in one task.
    flops > 5e7
}

/// Runs of targets that follow each other.
struct Run {
    source: usize,
    target: usize,
    length: usize,
}

/// The targets as runs.
fn runs(targets: &[u32]) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for (source, &target) in targets.iter().enumerate() {
        let target = target as usize;
        match runs.last_mut() {
            Some(run) if run.target + run.length == target => run.length += 1,
            _ => runs.push(Run {
                source,
                target,
                length: 1,
            }),
        }
    }
    runs
}

/// Adds the columns of `children` that belong to the local columns `wanted` of a front to `columns`, which holds
/// those columns from the local row `top` on.
fn add_children(
    columns: &mut [f64],
    height: usize,
    top: usize,
    wanted: std::ops::Range<usize>,
    children: &[Child],
) {
    for child in children {
        let order = child.targets.len();
        let from = child
            .targets
            .partition_point(|&t| (t as usize) < wanted.start);
        let to = child
            .targets
            .partition_point(|&t| (t as usize) < wanted.end);
        if from == to {
            continue;
        }
        let runs = runs(&child.targets[from..]);
        let mut first = 0;
        for j in from..to {
            // The first run that reaches down to the diagonal.
            while runs[first].source + runs[first].length <= j - from {
                first += 1;
            }
            let source = &child.values[j * order..(j + 1) * order];
            let column = child.targets[j] as usize - wanted.start;
            let target = &mut columns[column * height..(column + 1) * height];
            let mut skip = j - from - runs[first].source;
            for run in &runs[first..] {
                let source = &source[from + run.source + skip..][..run.length - skip];
                let target = &mut target[run.target + skip - top..][..run.length - skip];
                for (t, s) in target.iter_mut().zip(source) {
                    *t += s;
                }
                skip = 0;
            }
        }
    }
}

/// Adds the contributions of the children to the panel of a front with `columns` columns.
pub(super) fn add_to_panel(panel: &mut [f64], columns: usize, children: &[Child], large: bool) {
    let height = panel.len() / columns.max(1);
    let width = if large { PANEL_COLUMNS } else { columns.max(1) };
    let add = |(chunk, part): (usize, &mut [f64])| {
        let start = chunk * width;
        add_children(
            part,
            height,
            0,
            start..start + part.len() / height,
            children,
        );
    };
    if large {
        panel
            .par_chunks_mut(width * height)
            .enumerate()
            .for_each(add);
    } else if height > 0 {
        panel.chunks_mut(width * height).enumerate().for_each(add);
    }
}

/// Eliminates the columns of a panel: Cholesky of the top, rows below divided by it.
/// The column whose pivot is not positive, if any.
pub(super) fn factor_panel(panel: &mut [f64], columns: usize, large: bool) -> Result<(), usize> {
    let height = panel.len() / columns.max(1);
    let mut memory = MemBuffer::new(cholesky_in_place_scratch::<f64>(
        PANEL_COLUMNS.min(columns),
        Par::Seq,
        Spec::default(),
    ));
    let mut start = 0;
    while start < columns {
        let width = PANEL_COLUMNS.min(columns - start);
        let (done, rest) = panel.split_at_mut(start * height);
        let done = MatRef::from_column_major_slice(&*done, height, start);
        let block = &mut rest[..width * height];
        let block = MatMut::from_column_major_slice_mut(block, height, width);
        let (_, block) = block.split_at_row_mut(start);
        let (mut pivots, below) = block.split_at_row_mut(width);
        let (own, done_below) = done.split_at_row(start).1.split_at_row(width);
        lower_product(pivots.as_mut(), Accum::Add, own);
        cholesky_in_place(
            pivots.as_mut(),
            LltRegularization::default(),
            Par::Seq,
            MemStack::new(&mut memory),
            Spec::default(),
        )
        .map_err(|LltError::NonPositivePivot { index }| start + index)?;
        let pivots = pivots.as_ref();
        let eliminate = |(mut rows, done): (MatMut<f64>, MatRef<f64>)| {
            if start > 0 {
                product(rows.as_mut(), Accum::Add, done, own);
            }
            solve_lower_triangular_in_place(pivots, rows.transpose_mut(), Par::Seq);
        };
        let tiles = row_tiles(below, done_below);
        if large {
            tiles.into_par_iter().for_each(eliminate);
        } else {
            tiles.into_iter().for_each(eliminate);
        }
        start += width;
    }
    Ok(())
}

/// Two matrices with as many rows, cut into tiles of rows.
fn row_tiles<'a>(
    mut rows: MatMut<'a, f64>,
    mut done: MatRef<'a, f64>,
) -> Vec<(MatMut<'a, f64>, MatRef<'a, f64>)> {
    let mut tiles = Vec::with_capacity(rows.nrows().div_ceil(PRODUCT_TILE));
    while rows.nrows() > 0 {
        let height = PRODUCT_TILE.min(rows.nrows());
        let (own, rest) = rows.split_at_row_mut(height);
        let (above, below) = done.split_at_row(height);
        tiles.push((own, above));
        (rows, done) = (rest, below);
    }
    tiles
}

/// Factors of a product slice by slice of its depth, and how each slice counts.
fn slices<'a>(
    accum: Accum,
    left: MatRef<'a, f64>,
    right: MatRef<'a, f64>,
) -> impl Iterator<Item = (Accum, MatRef<'a, f64>, MatRef<'a, f64>)> {
    let depth = left.ncols();
    (0..depth.max(1)).step_by(PRODUCT_DEPTH).map(move |from| {
        let count = PRODUCT_DEPTH.min(depth - from);
        let accum = if from == 0 { accum } else { Accum::Add };
        let (left, right) = (left.subcols(from, count), right.subcols(from, count));
        (accum, left, right)
    })
}

/// `target -= left rightᵀ` or `target = -left rightᵀ`.
fn product(mut target: MatMut<f64>, accum: Accum, left: MatRef<f64>, right: MatRef<f64>) {
    for (accum, left, right) in slices(accum, left, right) {
        let right = right.transpose();
        matmul(target.as_mut(), accum, left, right, -1.0, Par::Seq);
    }
}

/// `target -= factor factorᵀ` or `target = -factor factorᵀ`, lower triangle.
fn lower_product(mut target: MatMut<f64>, accum: Accum, factor: MatRef<f64>) {
    use triangular::BlockStructure::{Rectangular, TriangularLower};
    for (accum, factor, _) in slices(accum, factor, factor) {
        triangular::matmul(
            target.as_mut(),
            TriangularLower,
            accum,
            factor,
            Rectangular,
            factor.transpose(),
            Rectangular,
            -1.0,
            Par::Seq,
        );
    }
}

/// What elimination leaves to the rows below: `-L_r L_rᵀ` plus the contributions of the children to them.
pub(super) fn contribute(
    contribution: &mut [f64],
    panel: &[f64],
    columns: usize,
    rows: usize,
    children: &[Child],
    large: bool,
) {
    if rows == 0 {
        return;
    }
    let below = MatRef::from_column_major_slice(panel, columns + rows, columns);
    let below = below.split_at_row(columns).1;
    let fill = |(chunk, part): (usize, &mut [f64])| {
        let start = chunk * PRODUCT_TILE;
        let count = part.len() / rows;
        let target = MatMut::from_column_major_slice_mut(&mut *part, rows, count);
        let (_, target) = target.split_at_row_mut(start);
        let (diagonal, rest) = target.split_at_row_mut(count);
        let (own, under) = below.split_at_row(start).1.split_at_row(count);
        lower_product(diagonal, Accum::Replace, own);
        for (tile, left) in row_tiles(rest, under) {
            product(tile, Accum::Replace, left, own);
        }
        let wanted = columns + start..columns + start + count;
        add_children(part, rows, columns, wanted, children);
    };
    let chunks = PRODUCT_TILE * rows;
    if large {
        let chunks = contribution.par_chunks_mut(chunks).enumerate();
        chunks.for_each(fill);
    } else {
        let chunks = contribution.chunks_mut(chunks).enumerate();
        chunks.for_each(fill);
    }
}

/// Adds a contribution to the lower triangle of the root of order `order`.
pub(super) fn add_to_root(root: &mut [f64], order: usize, child: Child) {
    if order > 0 {
        root.par_chunks_mut(ROOT_COLUMNS_PER_TASK * order)
            .enumerate()
            .for_each(|(chunk, part)| {
                let start = chunk * ROOT_COLUMNS_PER_TASK;
                let wanted = start..start + part.len() / order;
                add_children(part, order, 0, wanted, &[child]);
            });
    }
}
