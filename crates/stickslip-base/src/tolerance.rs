//! The tolerances that the whole house shares. All are relative: a length to a length, a force to a force.
//!
//! A tolerance that decides more than what rounding or an iteration leaves has a name of its own where it is used. Where no theory gives its value, its comment
//! says over which range it was varied, alone, and what changed. *The short cases* are then those of the tested examples, with all their
//! `expected*.toml`, and of the random problems 1 to 120 of `cargo xtask robustness` that read the constant and take a second or two: up to 190 of 238.

/// What rounding in double precision leaves of a sum of a few thousand terms or of a product of unit vectors: about 4500 machine epsilons.
pub const ROUNDING: f64 = 1e-12;

/// The part of themselves by which two numbers may differ that are meant to be equal: times, places, prescribed values, a sum and its parts. It is more than
/// two ways of computing a number differ by, and less than what files are rounded to.
pub const SAME: f64 = 1e-9;

/// The part of a length, a force or a velocity that makes no difference to a result of engineering. It is more than the tolerances of the iterations leave.
pub const NEGLIGIBLE: f64 = 1e-6;
