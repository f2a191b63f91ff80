//! Matrices for the tests of this folder.

use faer::Mat;
use faer::prelude::Solve;

use super::BlockCsr;

/// Reproducible numbers in (-1, 1).
pub fn noise(seed: &mut u64, count: usize) -> Vec<f64> {
    (0..count)
        .map(|_| {
            *seed = seed
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (*seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        })
        .collect()
}

/// The matrix written out, row by row.
pub fn dense_of(a: &BlockCsr) -> Vec<f64> {
    let n = a.rows();
    (0..n * n).map(|k| a.entry(k / n, k % n)).collect()
}

/// The solution of a dense system given row by row, by LU with row exchanges.
pub fn dense_solution(a: &[f64], b: &[f64]) -> Vec<f64> {
    let n = b.len();
    let lu = Mat::from_fn(n, n, |i, j| a[i * n + j]).partial_piv_lu();
    let x = lu.solve(Mat::from_fn(n, 1, |i, _| b[i]));
    (0..n).map(|i| x[(i, 0)]).collect()
}

/// A grid of points `(n0, n1, n2)` whose cells hold a spring along every edge and diagonal, each with an elastic and a
/// small isotropic stiffness: translations are its only null vectors. In 2D (`block` 2) the last count is 1.
pub fn grid(counts: [usize; 3], block: usize) -> BlockCsr {
    let index = |p: [usize; 3]| p[0] + counts[0] * (p[1] + counts[1] * p[2]);
    let points = counts.iter().product();
    let mut cells: Vec<Vec<([usize; 3], usize)>> = Vec::new();
    let span = |axis: usize| counts[axis].saturating_sub(1).max(1);
    for z in 0..span(2) {
        for y in 0..span(1) {
            for x in 0..span(0) {
                let mut corners = Vec::new();
                for corner in 0..8 {
                    let p = [x + (corner & 1), y + (corner >> 1 & 1), z + (corner >> 2)];
                    if (0..3).all(|axis| p[axis] < counts[axis]) {
                        corners.push((p, index(p)));
                    }
                }
                cells.push(corners);
            }
        }
    }
    let mut a = BlockCsr::from_couplings(points, block, &mut |add| {
        for cell in &cells {
            add(&cell.iter().map(|c| c.1).collect::<Vec<_>>());
        }
    });
    for cell in &cells {
        let width = cell.len() * block;
        let mut dense = vec![0.0; width * width];
        for (i, (p, _)) in cell.iter().enumerate() {
            for (j, (q, _)) in cell.iter().enumerate().skip(i + 1) {
                let d: Vec<f64> = (0..block).map(|k| q[k] as f64 - p[k] as f64).collect();
                let length2: f64 = d.iter().map(|x| x * x).sum();
                for r in 0..block {
                    for c in 0..block {
                        let k = d[r] * d[c] / length2 + if r == c { 0.1 } else { 0.0 };
                        let (ri, rj) = (i * block + r, j * block + r);
                        let (ci, cj) = (i * block + c, j * block + c);
                        dense[ri * width + ci] += k;
                        dense[rj * width + cj] += k;
                        dense[ri * width + cj] -= k;
                        dense[rj * width + ci] -= k;
                    }
                }
            }
        }
        let ids: Vec<usize> = cell.iter().map(|c| c.1).collect();
        a.add_group(&ids, &dense);
    }
    a
}
