use std::sync::Arc;

use super::union::Union;
use super::{Compliance, DistributedOperator, LinearError, Numbers, Workspace};

/// What is left of a matrix at the kept dofs of a body, symmetric.
#[derive(Debug)]
pub enum Schur {
    /// Of shape `(n, n)`, column by column; the upper triangle is zero.
    Here(Numbers),
    /// With the processes of an engine.
    DistributedOperator(Arc<dyn DistributedOperator>),
}

impl Schur {
    /// The sum of the diagonal of `n` rows.
    pub fn trace(&self, n: usize) -> f64 {
        match self {
            Schur::Here(values) => (0..n).map(|i| values[i * (n + 1)]).sum(),
            Schur::DistributedOperator(spread) => spread.trace(),
        }
    }

    /// Products with vectors.
    ///
    /// # Errors
    /// Those of [`DistributedOperator::products`].
    pub fn products(&self, vectors: &[Vec<f64>]) -> Result<Vec<Vec<f64>>, LinearError> {
        Ok(match (self, vectors.first()) {
            (_, None) => Vec::new(),
            (Schur::Here(values), _) => vectors.iter().map(|v| product(values, v)).collect(),
            (Schur::DistributedOperator(spread), Some(first)) => {
                let all = spread.products(&vectors.concat())?;
                all.chunks(first.len().max(1))
                    .map(<[f64]>::to_vec)
                    .collect()
            }
        })
    }

    /// The places of `n` rows that hang together by stiffness, or as `together` says.
    pub fn pieces(&self, n: usize, together: impl Fn(usize, usize) -> bool) -> Vec<Vec<usize>> {
        let mut union = Union::new(n);
        match self {
            Schur::Here(values) => {
                for j in 0..n {
                    let column = &values[j * n..(j + 1) * n];
                    for (i, &value) in column.iter().enumerate().skip(j + 1) {
                        if together(i, j) || value != 0.0 {
                            union.join(i, j);
                        }
                    }
                }
            }
            Schur::DistributedOperator(spread) => {
                let mut first = std::collections::BTreeMap::new();
                for (i, &piece) in spread.pieces().iter().enumerate() {
                    union.join(i, *first.entry(piece).or_insert(i));
                    if i > 0 && together(i, i - 1) {
                        union.join(i, i - 1);
                    }
                }
            }
        }
        let mut pieces: Vec<Vec<usize>> = vec![Vec::new(); n];
        (0..n).for_each(|i| pieces[union.top(i)].push(i));
        pieces.retain(|piece| !piece.is_empty());
        pieces
    }

    /// The inverse of `S + σ Σ m mᵀ`, of `n` rows; gives memory back.
    ///
    /// # Errors
    /// Those of [`Compliance::of`] and [`DistributedOperator::invert`].
    pub fn invert(
        self,
        n: usize,
        modes: &[Vec<f64>],
        sigma: f64,
        workspace: &Workspace,
    ) -> Result<Compliance, LinearError> {
        let mut values = match self {
            Schur::Here(values) => values,
            Schur::DistributedOperator(spread) => {
                spread.invert(modes, sigma)?;
                return Ok(Compliance::spread(n, spread));
            }
        };
        for mode in modes {
            for j in 0..n {
                let s = sigma * mode[j];
                if s != 0.0 {
                    let column = &mut values[j * n..(j + 1) * n];
                    for (k, m) in column.iter_mut().zip(mode).skip(j) {
                        *k += s * m;
                    }
                }
            }
        }
        let compliance = Compliance::of(n, &mut values);
        workspace.give(values);
        compliance
    }
}

/// `S v` from the lower triangle.
fn product(s: &[f64], v: &[f64]) -> Vec<f64> {
    let n = v.len();
    let mut out = vec![0.0; n];
    for j in 0..n {
        let column = &s[j * n..(j + 1) * n];
        out[j] += column[j] * v[j];
        let mut sum = 0.0;
        for i in j + 1..n {
            out[i] += column[i] * v[j];
            sum += column[i] * v[i];
        }
        out[j] += sum;
    }
    out
}
