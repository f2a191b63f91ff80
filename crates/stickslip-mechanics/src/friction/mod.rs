//! The friction problem: forces at points under laws of contact and friction, with an operator and a free motion that are given.
//!
//! No mesh, no time, no law of materials: an increment of condensed bodies, a stack of rigid bodies in an instant and a file of a collection are one type,
//! [`FrictionProblem`]. It is solved by methods that fail on different problems ([`solve`]):
//!
//! - [`GaussSeidel`] is strong where the operator is singular, points are few per body and their coupling is weak;
//! - [`NewtonInForces`] is strong where elasticity couples many points and friction is large;
//! - [`ProximalPoint`] makes singular problems regular, and takes away in the end what it added.
//!
//! What counts is the norm of the natural map, [`friction_error`].

pub mod cone;
pub mod ellipse;
mod gauss_seidel;
mod linear;
pub(crate) mod map;
mod newton;
mod point;
mod portfolio;
mod problem;
mod proximal;
mod small;
mod solver;
pub mod text;

#[cfg(test)]
mod tests;

pub use gauss_seidel::GaussSeidel;
pub use map::friction_error;
pub use map::natural_map;
pub use newton::{Length, NewtonInForces, Step};
pub use portfolio::{Solution, Tried, solve};
pub use problem::{FrictionProblem, PointLaw};
pub use proximal::ProximalPoint;
pub use solver::{FrictionSolver, Iterate};
