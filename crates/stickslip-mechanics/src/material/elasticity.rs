//! What a material says.

use super::check::{self, MaterialError};
use super::reduce::constrained_modulus;
use super::stiffness::Stiffness;
use crate::math::Vec3;

/// A linear elastic material.
pub trait Elasticity {
    /// The stiffness `[Pa]`, checked: symmetric and positive definite.
    ///
    /// # Errors
    /// Names the parameter at fault and, where the tensor is not elliptic, its smallest eigenvalue.
    fn stiffness(&self) -> Result<Stiffness, MaterialError>;

    /// Mass per volume `[kg/m³]`.
    fn density(&self) -> f64;

    /// The material's own axes as rows, where it has some: along them thermal expansion is given.
    ///
    /// # Errors
    /// Axes that do not span a plane.
    fn frame(&self) -> Result<Option<[Vec3; 3]>, MaterialError> {
        Ok(None)
    }

    /// A modulus `[Pa]` by which other quantities are made dimensionless: the largest constrained modulus
    /// (uniaxial strain), see [`constrained_modulus`].
    ///
    /// # Errors
    /// As [`stiffness`](Elasticity::stiffness).
    fn characteristic_modulus(&self) -> Result<f64, MaterialError> {
        Ok(constrained_modulus(&self.stiffness()?))
    }

    /// Checks all parameters.
    ///
    /// # Errors
    /// As [`stiffness`](Elasticity::stiffness); also for a density that is negative or not finite.
    fn check(&self) -> Result<(), MaterialError> {
        self.stiffness()?;
        check::density(self.density())
    }
}
