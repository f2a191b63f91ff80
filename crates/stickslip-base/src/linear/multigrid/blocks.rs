//! Sparse matrices of rectangular blocks, and the products that make a coarse operator.

use rayon::prelude::*;

use super::super::BlockCsr;
use super::super::block_csr::ROWS_PER_TASK;

/// A dense block, row by row.
pub(super) type Block<T, const R: usize, const C: usize> = [[T; C]; R];

/// A square block of zeros.
pub(super) fn zero<const R: usize, const C: usize>() -> Block<f64, R, C> {
    [[0.0; C]; R]
}

/// A sparse matrix of `R × C` blocks in compressed rows; the columns of a row ascend.
#[derive(Debug, Clone)]
pub(super) struct Blocks<T, const R: usize, const C: usize> {
    pub starts: Vec<usize>,
    pub columns: Vec<u32>,
    pub values: Vec<Block<T, R, C>>,
}

/// The rows of a square matrix in double precision, whoever stores it.
pub(super) trait Rows<const B: usize>: Sync {
    /// Number of block rows.
    fn count(&self) -> usize;
    /// The columns of a row, ascending, and their blocks.
    fn row(&self, row: usize) -> (&[u32], &[Block<f64, B, B>]);

    /// The diagonal block of a row; zero where none is stored.
    fn diagonal(&self, row: usize) -> Block<f64, B, B> {
        let (columns, blocks) = self.row(row);
        match columns.binary_search(&(row as u32)) {
            Ok(at) => blocks[at],
            Err(_) => zero(),
        }
    }
}

impl<const B: usize> Rows<B> for BlockCsr {
    fn count(&self) -> usize {
        self.points()
    }

    fn row(&self, row: usize) -> (&[u32], &[Block<f64, B, B>]) {
        let (lines, _) = self.row_blocks(row).as_chunks::<B>();
        (self.neighbours(row), lines.as_chunks::<B>().0)
    }
}

impl<const B: usize> Rows<B> for Blocks<f64, B, B> {
    fn count(&self) -> usize {
        self.rows()
    }

    fn row(&self, row: usize) -> (&[u32], &[Block<f64, B, B>]) {
        self.row(row)
    }
}

/// One row of blocks under construction, in any order of columns.
pub(super) struct RowBuilder<const R: usize, const C: usize> {
    /// Place of each column in the row; `NONE` where there is none yet.
    places: Vec<u32>,
    pub columns: Vec<u32>,
    pub values: Vec<Block<f64, R, C>>,
}

const NONE: u32 = u32::MAX;

impl<const R: usize, const C: usize> RowBuilder<R, C> {
    fn new(columns: usize) -> Self {
        RowBuilder {
            places: vec![NONE; columns],
            columns: Vec::new(),
            values: Vec::new(),
        }
    }

    /// The block of a column, zero at first.
    #[inline]
    pub fn block(&mut self, column: u32) -> &mut Block<f64, R, C> {
        let place = &mut self.places[column as usize];
        if *place == NONE {
            *place = self.columns.len() as u32;
            self.columns.push(column);
            self.values.push(zero());
        }
        &mut self.values[*place as usize]
    }

    /// Moves the row, sorted, to the end of `part` and forgets it.
    fn flush<T: Number>(&mut self, order: &mut Vec<u32>, part: &mut Part<T, R, C>) {
        order.clear();
        order.extend(0..self.columns.len() as u32);
        order.sort_unstable_by_key(|&at| self.columns[at as usize]);
        for &at in &*order {
            let column = self.columns[at as usize];
            self.places[column as usize] = NONE;
            part.columns.push(column);
            part.values.push(convert(&self.values[at as usize]));
        }
        part.lengths.push(order.len());
        self.columns.clear();
        self.values.clear();
    }
}

/// Consecutive rows made by one task.
struct Part<T, const R: usize, const C: usize> {
    lengths: Vec<usize>,
    columns: Vec<u32>,
    values: Vec<Block<T, R, C>>,
}

/// The two floating-point types values are stored in.
pub(super) trait Number: Copy + Default + Send + Sync + Into<f64> {
    /// The nearest number of this type.
    fn from_f64(value: f64) -> Self;
}

impl Number for f64 {
    fn from_f64(value: f64) -> f64 {
        value
    }
}

impl Number for f32 {
    fn from_f64(value: f64) -> f32 {
        value as f32
    }
}

/// The block in another precision.
pub(super) fn convert<T: Number, const R: usize, const C: usize>(
    block: &Block<f64, R, C>,
) -> Block<T, R, C> {
    block.map(|row| row.map(T::from_f64))
}

impl<T: Number, const R: usize, const C: usize> Blocks<T, R, C> {
    /// A matrix made row by row: `fill` adds the blocks of a row to the builder.
    pub fn build(
        rows: usize,
        columns: usize,
        fill: impl Fn(usize, &mut RowBuilder<R, C>) + Sync,
    ) -> Self {
        let tasks: Vec<usize> = (0..rows).step_by(ROWS_PER_TASK).collect();
        let parts: Vec<Part<T, R, C>> = tasks
            .into_par_iter()
            .map_init(
                || (RowBuilder::new(columns), Vec::new()),
                |(builder, order), first| {
                    let mut part = Part {
                        lengths: Vec::with_capacity(ROWS_PER_TASK),
                        columns: Vec::new(),
                        values: Vec::new(),
                    };
                    for row in first..(first + ROWS_PER_TASK).min(rows) {
                        fill(row, builder);
                        builder.flush(order, &mut part);
                    }
                    part
                },
            )
            .collect();
        let total = parts.iter().map(|part| part.columns.len()).sum();
        let mut starts = Vec::with_capacity(rows + 1);
        let mut columns = Vec::with_capacity(total);
        let mut values = Vec::with_capacity(total);
        starts.push(0);
        let mut end = 0;
        for part in parts {
            for length in part.lengths {
                end += length;
                starts.push(end);
            }
            columns.extend_from_slice(&part.columns);
            values.extend_from_slice(&part.values);
        }
        Blocks {
            starts,
            columns,
            values,
        }
    }

    /// Number of block rows.
    pub fn rows(&self) -> usize {
        self.starts.len() - 1
    }

    /// The columns of a row, ascending, and their blocks.
    #[inline]
    pub fn row(&self, row: usize) -> (&[u32], &[Block<T, R, C>]) {
        let range = self.starts[row]..self.starts[row + 1];
        (&self.columns[range.clone()], &self.values[range])
    }

    /// Bytes stored.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.starts) + size_of_val(&*self.columns) + size_of_val(&*self.values)
    }

    /// Where the blocks of each column are.
    pub fn columns_of(&self, columns: usize) -> Columns {
        let mut starts = vec![0; columns + 1];
        for &column in &self.columns {
            starts[column as usize + 1] += 1;
        }
        for i in 0..columns {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut entries = vec![(0, 0); self.columns.len()];
        for row in 0..self.rows() {
            for at in self.starts[row]..self.starts[row + 1] {
                let place = &mut next[self.columns[at] as usize];
                entries[*place] = (row as u32, at as u32);
                *place += 1;
            }
        }
        Columns { starts, entries }
    }
}

/// The blocks of a matrix by columns: their row and their place in `values`.
#[derive(Debug, Clone)]
pub(super) struct Columns {
    pub starts: Vec<usize>,
    pub entries: Vec<(u32, u32)>,
}

impl Columns {
    /// Row and place of the blocks of a column, by ascending row.
    #[inline]
    pub fn of(&self, column: usize) -> &[(u32, u32)] {
        &self.entries[self.starts[column]..self.starts[column + 1]]
    }

    /// Bytes stored.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.starts) + size_of_val(&*self.entries)
    }
}

/// `out += a b`
#[inline]
pub(super) fn add_product<T: Number, const R: usize, const K: usize, const C: usize>(
    out: &mut Block<f64, R, C>,
    a: &Block<f64, R, K>,
    b: &Block<T, K, C>,
) {
    for (out, a) in out.iter_mut().zip(a) {
        for (&a, b) in a.iter().zip(b) {
            for (o, &b) in out.iter_mut().zip(b) {
                *o += a * b.into();
            }
        }
    }
}

/// `out += aᵀ b`
#[inline]
pub(super) fn add_transposed<T: Number, const R: usize, const K: usize, const C: usize>(
    out: &mut Block<f64, R, C>,
    a: &Block<T, K, R>,
    b: &Block<f64, K, C>,
) {
    for (a, b) in a.iter().zip(b) {
        for (&a, out) in a.iter().zip(out.iter_mut()) {
            let a: f64 = a.into();
            for (o, b) in out.iter_mut().zip(b) {
                *o += a * b;
            }
        }
    }
}

/// `Pᵀ A P`
pub(super) fn galerkin<const B: usize, const M: usize>(
    a: &impl Rows<B>,
    p: &Blocks<f32, B, M>,
    by_column: &Columns,
) -> Blocks<f64, M, M> {
    let coarse = by_column.starts.len() - 1;
    let ap: Blocks<f64, B, M> = Blocks::build(a.count(), coarse, |row, out| {
        // A row that no coarse function reaches is never read.
        if p.starts[row] == p.starts[row + 1] {
            return;
        }
        let (columns, blocks) = a.row(row);
        for (&j, a) in columns.iter().zip(blocks) {
            let (nodes, blocks) = p.row(j as usize);
            for (&node, p) in nodes.iter().zip(blocks) {
                add_product(out.block(node), a, p);
            }
        }
    });
    Blocks::build(coarse, coarse, |node, out| {
        for &(row, at) in by_column.of(node) {
            let p = &p.values[at as usize];
            let (nodes, blocks) = ap.row(row as usize);
            for (&other, ap) in nodes.iter().zip(blocks) {
                add_transposed(out.block(other), p, ap);
            }
        }
    })
}
