//! One level: its matrix, the smoother and the way to the next level.

use rayon::prelude::*;

use super::super::block_csr::ROWS_PER_TASK;
use super::blocks::{Block, Blocks, Columns, Rows, convert, zero};
use super::jacobi::{BlockJacobi, active, invert};
use super::prolong::Nodes;

/// A vector on a level, node by node.
pub(super) type Vector<const B: usize> = Vec<Block<f32, 1, B>>;

/// A block added to the diagonal of a node.
pub(super) type Added<const B: usize> = (u32, Block<f64, B, B>);

/// The diagonal of a node that carries gap variables, without what contact adds.
#[derive(Debug, Clone)]
struct GapDiagonal<const B: usize> {
    node: u32,
    /// Where its diagonal block is in the matrix.
    at: usize,
    block: Block<f64, B, B>,
    active: [bool; B],
}

/// A level of the hierarchy.
#[derive(Debug, Clone)]
pub(super) struct Level<const B: usize, const M: usize> {
    /// The operator with the contact stiffness on its diagonal.
    pub matrix: Blocks<f32, B, B>,
    /// Inverse diagonal blocks, zero at dofs left out.
    inverse: Vec<Block<f32, B, B>>,
    gaps: Vec<GapDiagonal<B>>,
    /// The largest eigenvalue of the operator divided by its block diagonal.
    pub spectral_radius: f64,
    pub prolong: Blocks<f32, B, M>,
    pub restrict: Columns,
    /// Factor between the matrix given and the one stored, which single precision can hold in any units.
    scale: f64,
}

impl<const B: usize, const M: usize> Level<B, M> {
    /// A level from its matrix in double precision, which is not kept.
    pub fn new(
        a: &impl Rows<B>,
        fixed: &[bool],
        nodes: &Nodes<B, M>,
        jacobi: &BlockJacobi<B>,
        prolong: Blocks<f32, B, M>,
        restrict: Columns,
        scale: f64,
    ) -> Self {
        let mut level = Level {
            matrix: Blocks {
                starts: vec![0],
                columns: Vec::new(),
                values: Vec::new(),
            },
            inverse: Vec::new(),
            gaps: Vec::new(),
            spectral_radius: 0.0,
            prolong,
            restrict,
            scale,
        };
        level.set_matrix(a, fixed, &nodes.gaps, jacobi);
        level
    }

    /// Takes another matrix over the same nodes, without contact, and keeps the way to the next level.
    pub fn refresh(&mut self, a: &impl Rows<B>, fixed: &[bool], gaps: &[bool]) {
        self.set_matrix(a, fixed, gaps, &BlockJacobi::new(a, fixed));
    }

    fn set_matrix(
        &mut self,
        a: &impl Rows<B>,
        fixed: &[bool],
        gaps: &[bool],
        jacobi: &BlockJacobi<B>,
    ) {
        let (count, scale) = (a.count(), self.scale);
        self.spectral_radius = jacobi.spectral_radius;
        self.matrix = Blocks::build(count, count, |row, out| {
            let (columns, blocks) = a.row(row);
            out.columns.extend_from_slice(columns);
            out.values
                .extend(blocks.iter().map(|block| scaled(block, scale)));
        });
        let inverse = jacobi.inverse.iter();
        self.inverse = inverse
            .map(|block| convert(&scaled(block, 1.0 / scale)))
            .collect();
        let nodes = (0..count).filter(|&node| gaps[node]);
        self.gaps = nodes
            .map(|node| {
                let block = a.diagonal(node);
                let columns = self.matrix.row(node).0;
                let place = columns.partition_point(|&j| (j as usize) < node);
                GapDiagonal {
                    node: node as u32,
                    at: self.matrix.starts[node] + place,
                    block,
                    active: active(&block, fixed, node),
                }
            })
            .collect();
    }

    /// Puts other contact stiffnesses on the diagonal of the gap nodes, given by ascending node, and returns those
    /// of the next level. Gap nodes not named get none.
    pub fn update(&mut self, added: &[Added<B>]) -> Vec<Added<M>> {
        let mut next: Vec<Added<M>> = Vec::new();
        let mut given = added.iter().peekable();
        for gap in &self.gaps {
            while given.next_if(|(node, _)| *node < gap.node).is_some() {}
            let mut block = gap.block;
            if let Some((_, extra)) = given.next_if(|(node, _)| *node == gap.node) {
                let sum = block.as_flattened_mut().iter_mut();
                sum.zip(extra.as_flattened()).for_each(|(b, e)| *b += e);
                let (columns, values) = self.prolong.row(gap.node as usize);
                for (&column, p) in columns.iter().zip(values) {
                    next.push((column, congruence(p, extra)));
                }
            }
            self.matrix.values[gap.at] = convert(&scaled(&block, self.scale));
            self.inverse[gap.node as usize] =
                convert(&scaled(&invert(&block, &gap.active), 1.0 / self.scale));
        }
        // The sort is stable: sums do not depend on chance.
        next.sort_by_key(|(column, _)| *column);
        next.dedup_by(|later, first| {
            let same = later.0 == first.0;
            if same {
                let sum = first.1.as_flattened_mut().iter_mut();
                sum.zip(later.1.as_flattened()).for_each(|(f, l)| *f += l);
            }
            same
        });
        next
    }

    /// Smooths `x` for the residual `r`, both updated, by a Chebyshev polynomial of `steps` terms in `D⁻¹ A` that is
    /// small from `1 / ratio` of the spectral radius upwards. The last product with `A` is left out if `r` is not
    /// needed any more.
    pub fn smooth(
        &self,
        steps: usize,
        ratio: f64,
        r: &mut [Block<f32, 1, B>],
        x: &mut [Block<f32, 1, B>],
        residual: bool,
    ) {
        let (low, high) = (self.spectral_radius / ratio, self.spectral_radius);
        let (centre, half) = (0.5 * (high + low), 0.5 * (high - low));
        let mut rho = half / centre;
        let mut d = vec![[[0.0; B]]; r.len()];
        d.par_chunks_mut(ROWS_PER_TASK)
            .zip(x.par_chunks_mut(ROWS_PER_TASK))
            .zip(r.par_chunks(ROWS_PER_TASK))
            .zip(self.inverse.par_chunks(ROWS_PER_TASK))
            .for_each(|(((d, x), r), inverse)| {
                for (((d, x), r), inverse) in d.iter_mut().zip(x).zip(r).zip(inverse) {
                    let step = multiply(inverse, r);
                    for c in 0..B {
                        d[0][c] = step[0][c] / centre as f32;
                        x[0][c] += d[0][c];
                    }
                }
            });
        let mut e = if steps > 1 {
            vec![[[0.0; B]]; r.len()]
        } else {
            Vec::new()
        };
        for _ in 1..steps {
            let next = 1.0 / (2.0 * centre / half - rho);
            let (keep, take) = ((next * rho) as f32, (2.0 * next / half) as f32);
            rho = next;
            e.par_chunks_mut(ROWS_PER_TASK)
                .zip(x.par_chunks_mut(ROWS_PER_TASK))
                .zip(r.par_chunks_mut(ROWS_PER_TASK))
                .enumerate()
                .for_each(|(task, ((e, x), r))| {
                    for (i, ((e, x), r)) in e.iter_mut().zip(x).zip(r).enumerate() {
                        let row = task * ROWS_PER_TASK + i;
                        subtract_row(&self.matrix, row, &d, r);
                        let step = multiply(&self.inverse[row], r);
                        for c in 0..B {
                            e[0][c] = keep * d[row][0][c] + take * step[0][c];
                            x[0][c] += e[0][c];
                        }
                    }
                });
            std::mem::swap(&mut d, &mut e);
        }
        if residual {
            self.subtract_product(&d, r);
        }
    }

    /// `r -= A d`
    pub fn subtract_product(&self, d: &[Block<f32, 1, B>], r: &mut [Block<f32, 1, B>]) {
        r.par_chunks_mut(ROWS_PER_TASK)
            .enumerate()
            .for_each(|(task, part)| {
                for (i, r) in part.iter_mut().enumerate() {
                    subtract_row(&self.matrix, task * ROWS_PER_TASK + i, d, r);
                }
            });
    }

    /// `Pᵀ r`
    pub fn restricted(&self, r: &[Block<f32, 1, B>]) -> Vector<M> {
        let count = self.restrict.starts.len() - 1;
        let mut coarse = vec![[[0.0; M]]; count];
        coarse
            .par_chunks_mut(ROWS_PER_TASK)
            .enumerate()
            .for_each(|(task, part)| {
                for (i, target) in part.iter_mut().enumerate() {
                    for &(row, at) in self.restrict.of(task * ROWS_PER_TASK + i) {
                        let r = &r[row as usize][0];
                        for (p, r) in self.prolong.values[at as usize].iter().zip(r) {
                            for (t, p) in target[0].iter_mut().zip(p) {
                                *t += p * r;
                            }
                        }
                    }
                }
            });
        coarse
    }

    /// `P c`
    pub fn prolonged(&self, coarse: &[Block<f32, 1, M>]) -> Vector<B> {
        let mut fine = vec![[[0.0; B]]; self.prolong.rows()];
        fine.par_chunks_mut(ROWS_PER_TASK)
            .enumerate()
            .for_each(|(task, part)| {
                for (i, target) in part.iter_mut().enumerate() {
                    let (columns, values) = self.prolong.row(task * ROWS_PER_TASK + i);
                    for (&column, p) in columns.iter().zip(values) {
                        let c = &coarse[column as usize][0];
                        for (t, p) in target[0].iter_mut().zip(p) {
                            *t += p.iter().zip(c).map(|(p, c)| p * c).sum::<f32>();
                        }
                    }
                }
            });
        fine
    }

    /// Bytes stored.
    pub fn bytes(&self) -> usize {
        self.matrix.bytes()
            + self.prolong.bytes()
            + self.restrict.bytes()
            + size_of_val(&*self.inverse)
            + size_of_val(&*self.gaps)
    }
}

/// The block times a factor.
fn scaled<const B: usize>(block: &Block<f64, B, B>, factor: f64) -> Block<f64, B, B> {
    block.map(|row| row.map(|v| factor * v))
}

/// `r -= A d` in one row.
#[inline]
fn subtract_row<const B: usize>(
    matrix: &Blocks<f32, B, B>,
    row: usize,
    d: &[Block<f32, 1, B>],
    r: &mut Block<f32, 1, B>,
) {
    let (columns, blocks) = matrix.row(row);
    let mut sum = [0.0; B];
    for (&j, block) in columns.iter().zip(blocks) {
        let d = &d[j as usize][0];
        for (s, line) in sum.iter_mut().zip(block) {
            for (a, d) in line.iter().zip(d) {
                *s += a * d;
            }
        }
    }
    for (r, s) in r[0].iter_mut().zip(sum) {
        *r -= s;
    }
}

#[inline]
fn multiply<const B: usize>(a: &Block<f32, B, B>, x: &Block<f32, 1, B>) -> Block<f32, 1, B> {
    [std::array::from_fn(|i| {
        a[i].iter().zip(&x[0]).map(|(a, x)| a * x).sum()
    })]
}

/// `Pᵀ D P`
fn congruence<const B: usize, const M: usize>(
    p: &Block<f32, B, M>,
    d: &Block<f64, B, B>,
) -> Block<f64, M, M> {
    let mut dp = zero();
    super::blocks::add_product(&mut dp, d, p);
    let mut out = zero();
    super::blocks::add_transposed(&mut out, p, &dp);
    out
}
