//! The stiffness of a material and the order of its components.

/// A 6×6 stiffness `[Pa]`, row by row, in the order of this module.
pub type Stiffness = [[f64; 6]; 6];

/// The Voigt index of the tensor component `(i, j)`.
pub const VOIGT: [[usize; 3]; 3] = [[0, 3, 5], [3, 1, 4], [5, 4, 2]];
