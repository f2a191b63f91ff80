//! Surface-to-surface contact: gaps and slips weighted over the common part of two surfaces.
//!
//! Each node of the secondary carries one contact point. Its gap is the mean of the distance between the surfaces, weighted by the
//! multiplier's function Φ of that node ([Puso and Laursen 2004](stickslip_base::references::puso_2004)),
//!
//! `g_j = 1/A_j ∫ Φ_j g dA`, `A_j = ∫ Φ_j dA`,
//!
//! over the part of the surface that has the primary opposite, cut where facets of the primary end. Φ is dual to the shape functions
//! ([Wohlmuth 2000](stickslip_base::references::wohlmuth_2000)): the mean of a field that is a sum of shape functions is its value at the node, so that laws
//! and multipliers stay local; where pressure follows from the gap, Φ on faces that are covered in part is the nearer to the shape functions the less of them is covered, so that no gap is taken
//! from beyond the edge. The Φ add up to one: a uniform pressure gives the nodal forces that it has in the bodies, on both sides, and
//! patch tests pass on any pair of meshes.
//!
//! The gradient of the gap is that of the integral at fixed places of the secondary. What moves with the cuts drops out, as the integrand is
//! continuous across them, but for the cut where the primary ends: there the gradient is that of an edge over a face (`rim`). The change of the gradient itself, of the size of pressure over modulus, is left out of the tangent.

mod cells;
mod clip;
mod correct;
mod dual;
mod face;
mod integral;
mod integrate;
mod interval;
mod merge;
mod merged_points;
mod plane;
mod rim;
mod rules;
mod sides;
mod sum;
mod view;
mod window;

pub use correct::correct;
pub use dual::{mean_weights, positive, positive_areas};
pub use face::{FACE_NODES, Face, Mortar};
pub use integral::{FaceIntegral, Piece};
pub use integrate::{Scratch, integrate};
pub use merge::{Merged, merged, merged_points};
pub use merged_points::MergedPoints;
pub use sides::Sides;
