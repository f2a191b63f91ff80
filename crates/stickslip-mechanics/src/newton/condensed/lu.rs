use std::ops::{Add, AddAssign, Mul};

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::perm::PermRef;
use faer::{MatMut, MatRef, Par, Spec};

use crate::linear::Compliance;

/// A dense LU factor with row exchanges in single or double precision.
#[derive(Debug)]
pub enum Lu {
    /// Four bytes a number.
    Single(Factor<f32>),
    /// Eight.
    Double(Factor<f64>),
}

/// The parts of the factor.
#[derive(Debug)]
pub struct Factor<T> {
    n: usize,
    lu: Vec<T>,
    forward: Vec<usize>,
    backward: Vec<usize>,
}

/// Numbers a factor may have.
pub trait Entry:
    faer::traits::ComplexField
    + Copy
    + Send
    + Sync
    + Add<Output = Self>
    + AddAssign
    + Mul<Output = Self>
{
    /// From double precision.
    fn of(x: f64) -> Self;
    /// To double precision.
    fn to(self) -> f64;
    /// A column of a compliance.
    fn column(w: &Compliance, j: usize) -> &[Self];
    /// The factor in its precision.
    fn wrap(factor: Factor<Self>) -> Lu;
    /// Pivot below which the matrix counts as singular.
    const SINGULAR: f64;
}

impl Entry for f64 {
    fn of(x: f64) -> f64 {
        x
    }
    fn to(self) -> f64 {
        self
    }
    fn column(w: &Compliance, j: usize) -> &[f64] {
        &w.values()[j * w.size()..(j + 1) * w.size()]
    }
    fn wrap(factor: Factor<f64>) -> Lu {
        Lu::Double(factor)
    }
    const SINGULAR: f64 = 1e-11;
}

impl Entry for f32 {
    fn of(x: f64) -> f32 {
        x as f32
    }
    fn to(self) -> f64 {
        f64::from(self)
    }
    fn column(w: &Compliance, j: usize) -> &[f32] {
        w.column(j)
    }
    fn wrap(factor: Factor<f32>) -> Lu {
        Lu::Single(factor)
    }
    const SINGULAR: f64 = 1e-5;
}

impl Lu {
    /// Factors a matrix of shape `(n, n)`, column by column. `None` if it is singular up to rounding or not finite.
    pub fn of<T: Entry>(n: usize, mut matrix: Vec<T>) -> Option<Lu> {
        if n == 0 {
            return Some(T::wrap(Factor {
                n,
                lu: matrix,
                forward: Vec::new(),
                backward: Vec::new(),
            }));
        }
        if matrix.iter().any(|v| !v.to().is_finite()) {
            return None;
        }
        let (mut forward, mut backward) = (vec![0usize; n], vec![0usize; n]);
        let scratch = factor::lu_in_place_scratch::<usize, T>(n, n, Par::Seq, Spec::default());
        let mut memory = MemBuffer::try_new(scratch).ok()?;
        factor::lu_in_place(
            MatMut::from_column_major_slice_mut(&mut matrix, n, n),
            &mut forward,
            &mut backward,
            Par::Seq,
            MemStack::new(&mut memory),
            Spec::default(),
        );
        for i in 0..n {
            let pivot = matrix[i * n + i].to().abs();
            // The matrix is the unit matrix and what interfaces add. A NaN is singular as well.
            if pivot.is_nan() || pivot <= T::SINGULAR {
                return None;
            }
        }
        Some(T::wrap(Factor {
            n,
            lu: matrix,
            forward,
            backward,
        }))
    }

    /// Solves in place.
    ///
    /// # Panics
    /// If the length is not that of the matrix.
    pub fn solve(&self, x: &mut [f64]) {
        match self {
            Lu::Single(factor) => factor.solve(x),
            Lu::Double(factor) => factor.solve(x),
        }
    }
}

impl<T: Entry> Factor<T> {
    fn solve(&self, x: &mut [f64]) {
        let n = self.n;
        assert_eq!(x.len(), n, "length of the right-hand side");
        if n == 0 {
            return;
        }
        let mut rhs: Vec<T> = x.iter().map(|&x| T::of(x)).collect();
        let lu = MatRef::from_column_major_slice(&self.lu, n, n);
        let scratch = solve::solve_in_place_scratch::<usize, T>(n, 1, Par::Seq);
        solve::solve_in_place(
            lu,
            lu,
            PermRef::new_checked(&self.forward, &self.backward, n),
            MatMut::from_column_major_slice_mut(&mut rhs, n, 1),
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
        );
        for (x, r) in x.iter_mut().zip(rhs) {
            *x = r.to();
        }
    }
}
