//! Numbers that carry their derivatives along three coordinates, so that what is composed of them is differentiated exactly.

use std::ops::{Add, Mul, Neg, Sub};

use crate::math::{Mat3, Vec3};

/// A number and its derivatives with respect to the three coordinates of a point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Dual {
    pub value: f64,
    pub slope: Vec3,
}

/// A vector of such numbers.
pub(super) type DualVec = [Dual; 3];

impl Dual {
    /// A number that does not depend on the point.
    pub fn constant(value: f64) -> Self {
        Dual {
            value,
            slope: [0.0; 3],
        }
    }

    /// A function of this number, given its value and its derivative here.
    pub fn chain(self, value: f64, derivative: f64) -> Self {
        Dual {
            value,
            slope: self.slope.map(|s| derivative * s),
        }
    }

    /// `1 / self`
    pub fn reciprocal(self) -> Self {
        let r = 1.0 / self.value;
        self.chain(r, -r * r)
    }
}

impl Add for Dual {
    type Output = Dual;
    fn add(self, b: Dual) -> Dual {
        Dual {
            value: self.value + b.value,
            slope: crate::math::add(self.slope, b.slope),
        }
    }
}

impl Sub for Dual {
    type Output = Dual;
    fn sub(self, b: Dual) -> Dual {
        Dual {
            value: self.value - b.value,
            slope: crate::math::sub(self.slope, b.slope),
        }
    }
}

impl Mul for Dual {
    type Output = Dual;
    fn mul(self, b: Dual) -> Dual {
        // The rule of the product.
        let slope =
            crate::math::add_scaled(crate::math::scale(self.value, b.slope), b.value, self.slope);
        Dual {
            value: self.value * b.value,
            slope,
        }
    }
}

impl Neg for Dual {
    type Output = Dual;
    fn neg(self) -> Dual {
        self.chain(-self.value, -1.0)
    }
}

/// A vector with its derivative, row: component.
pub(super) fn vector(value: Vec3, slope: &Mat3) -> DualVec {
    std::array::from_fn(|i| Dual {
        value: value[i],
        slope: slope[i],
    })
}

/// A vector that follows from one number: `along` is its derivative with respect to that number.
pub(super) fn follows(value: Vec3, along: Vec3, number: Dual) -> DualVec {
    std::array::from_fn(|i| number.chain(value[i], along[i]))
}

/// `a + s b`
pub(super) fn add_scaled(a: DualVec, s: Dual, b: DualVec) -> DualVec {
    std::array::from_fn(|i| a[i] + s * b[i])
}

/// Scalar product.
pub(super) fn dot(a: DualVec, b: DualVec) -> Dual {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Sum.
pub(super) fn add(a: DualVec, b: DualVec) -> DualVec {
    std::array::from_fn(|i| a[i] + b[i])
}

/// Difference.
pub(super) fn sub(a: DualVec, b: DualVec) -> DualVec {
    std::array::from_fn(|i| a[i] - b[i])
}
