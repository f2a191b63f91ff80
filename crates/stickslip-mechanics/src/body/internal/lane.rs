//! Numbers of several cells side by side, one vector register of the machine.

use std::ops::{Add, AddAssign, Mul, Sub};

use pulp::Simd;

/// Cells that are gathered and scattered together: the widest register of any machine holds so many numbers. Narrower
/// ones take the cells of a group in several parts, so that the layout, and with fused multiplication the bits of the
/// result, are the same on all.
pub const GROUP: usize = 8;

/// One number of every cell of a group.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub struct Row(pub [f64; GROUP]);

/// Vectors at the nodes of a group of cells: `nodes[a][i]` is component `i` at node `a`.
pub type Nodes<const N: usize, const D: usize> = [[Row; D]; N];

/// One number of as many cells as a register holds.
#[derive(Debug, Clone, Copy)]
pub struct Lane<S: Simd> {
    simd: S,
    value: S::f64s,
}

impl<S: Simd> Lane<S> {
    /// The same number for all cells.
    #[inline(always)]
    pub fn splat(simd: S, value: f64) -> Self {
        Lane {
            simd,
            value: simd.splat_f64s(value),
        }
    }

    /// The numbers of part `part` of a group.
    #[inline(always)]
    pub fn load(simd: S, row: &Row, part: usize) -> Self {
        Lane {
            simd,
            value: S::as_simd_f64s(&row.0).0[part],
        }
    }

    /// Writes them to part `part` of a group.
    #[inline(always)]
    pub fn store(self, row: &mut Row, part: usize) {
        S::as_mut_simd_f64s(&mut row.0).0[part] = self.value;
    }

    /// `self · factor + summand`, in one instruction where the machine has it.
    #[inline(always)]
    pub fn times_plus(self, factor: Self, summand: Self) -> Self {
        Lane {
            value: self
                .simd
                .mul_add_e_f64s(self.value, factor.value, summand.value),
            ..self
        }
    }

    /// `summand - self · factor`.
    #[inline(always)]
    pub fn times_from(self, factor: Self, summand: Self) -> Self {
        Lane {
            value: self
                .simd
                .negate_mul_add_e_f64s(self.value, factor.value, summand.value),
            ..self
        }
    }

    /// `1 / self`.
    #[inline(always)]
    pub fn inverse(self) -> Self {
        Lane {
            value: self.simd.div_f64s(self.simd.splat_f64s(1.0), self.value),
            ..self
        }
    }
}

impl<S: Simd> Add for Lane<S> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Lane {
            value: self.simd.add_f64s(self.value, other.value),
            ..self
        }
    }
}

impl<S: Simd> Sub for Lane<S> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Lane {
            value: self.simd.sub_f64s(self.value, other.value),
            ..self
        }
    }
}

impl<S: Simd> Mul for Lane<S> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Lane {
            value: self.simd.mul_f64s(self.value, other.value),
            ..self
        }
    }
}

impl<S: Simd> AddAssign for Lane<S> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
