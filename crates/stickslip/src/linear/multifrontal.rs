//! interim
use std::ops::Range;
use std::sync::Arc;

use faer::Mat;

use super::{BlockCsr, Factor, LinearError, Symbolic};

/// Where the entries of a partial factor are.
#[derive(Debug)]
pub struct Fronts {
    symbolic: Arc<Symbolic>,
    interior: Vec<u32>,
    root: Vec<u32>,
    dofs: usize,
}

impl Fronts {
    /// Analyses.
    pub fn analyze(
        matrix: &BlockCsr,
        points: Range<usize>,
        fixed: &[bool],
        kept: &[bool],
    ) -> Result<Fronts, LinearError> {
        let b = matrix.block_size();
        let mut left = vec![true; fixed.len()];
        let (mut interior, mut root) = (Vec::new(), Vec::new());
        for p in points {
            for dof in p * b..(p + 1) * b {
                if fixed[dof] {
                    continue;
                }
                if kept[p] {
                    root.push(dof as u32);
                } else {
                    left[dof] = false;
                    interior.push(dof as u32);
                }
            }
        }
        let symbolic = Arc::new(Symbolic::analyze(matrix, &left, &[])?);
        Ok(Fronts {
            symbolic,
            interior,
            root,
            dofs: fixed.len(),
        })
    }
    /// Interior dofs.
    pub fn interior(&self) -> &[u32] {
        &self.interior
    }
    /// Kept dofs.
    pub fn root(&self) -> &[u32] {
        &self.root
    }
    /// Flops.
    pub fn flops(&self) -> f64 {
        self.symbolic.flops()
    }
    /// Nonzeros.
    pub fn nonzeros(&self) -> usize {
        self.symbolic.factor_nonzeros()
    }
    /// Bytes.
    pub fn peak_bytes(&self) -> u64 {
        8 * self.nonzeros() as u64
    }
}

/// A partial factor.
#[derive(Debug)]
pub struct PartialFactor {
    fronts: Arc<Fronts>,
    factor: Factor,
    coupling: Vec<(u32, u32, f64)>,
}

impl PartialFactor {
    /// Factors.
    pub fn new(
        fronts: &Arc<Fronts>,
        matrix: &BlockCsr,
    ) -> Result<(PartialFactor, Mat<f64>), LinearError> {
        let factor = Factor::new(&fronts.symbolic, matrix, &[])?;
        let b = matrix.block_size();
        let mut place = vec![u32::MAX; fronts.dofs];
        for (i, &d) in fronts.interior.iter().enumerate() {
            place[d as usize] = i as u32;
        }
        let mut coupling = Vec::new();
        let n = fronts.root.len();
        let mut s = Mat::zeros(n, n);
        for (i, &d) in fronts.root.iter().enumerate() {
            for &q in matrix.neighbours(d as usize / b) {
                for e in q as usize * b..(q as usize + 1) * b {
                    if place[e] != u32::MAX {
                        let k = matrix.entry(d as usize, e);
                        coupling.push((i as u32, place[e], k));
                    }
                }
            }
            for (j, &e) in fronts.root.iter().enumerate() {
                s[(i, j)] = matrix.entry(d as usize, e as usize);
            }
        }
        let me = PartialFactor {
            fronts: Arc::clone(fronts),
            factor,
            coupling,
        };
        for j in 0..n {
            let mut v = vec![0.0; me.fronts.interior.len()];
            for &(i, k, a) in &me.coupling {
                if i as usize == j {
                    v[k as usize] += a;
                }
            }
            let mut root = vec![0.0; n];
            me.forward(&mut v, &mut root, 1);
            for i in 0..n {
                s[(i, j)] += root[i];
            }
        }
        Ok((me, s))
    }
    /// The analysis.
    pub fn fronts(&self) -> &Arc<Fronts> {
        &self.fronts
    }
    fn solve(&self, x: &mut [f64]) {
        let mut full = vec![0.0; self.fronts.dofs];
        for (&d, x) in self.fronts.interior.iter().zip(x.iter()) {
            full[d as usize] = *x;
        }
        self.factor.solve(&mut full);
        for (&d, x) in self.fronts.interior.iter().zip(x.iter_mut()) {
            *x = full[d as usize];
        }
    }
    /// Forward.
    pub fn forward(&self, interior: &mut [f64], root: &mut [f64], columns: usize) {
        let (ni, nc) = (self.fronts.interior.len(), self.fronts.root.len());
        for c in 0..columns {
            let mut x = interior[c * ni..(c + 1) * ni].to_vec();
            self.solve(&mut x);
            for &(i, k, a) in &self.coupling {
                root[c * nc + i as usize] -= a * x[k as usize];
            }
        }
    }
    /// Backward.
    pub fn backward(&self, interior: &mut [f64], root: &[f64], columns: usize) {
        let (ni, nc) = (self.fronts.interior.len(), self.fronts.root.len());
        for c in 0..columns {
            let x = &mut interior[c * ni..(c + 1) * ni];
            for &(i, k, a) in &self.coupling {
                x[k as usize] -= a * root[c * nc + i as usize];
            }
            self.solve(x);
        }
    }
}
