//! Surface-to-surface contact: gaps and slips weighted over the common part of two surfaces.
//!
//! Each node of the secondary carries one contact point. Its gap is the mean of the distance between the surfaces, weighted by the
//! multiplier's function Φ of that node ([Puso and Laursen 2004](crate::references::puso_2004)),
//!
//! `g_j = 1/A_j ∫ Φ_j g dA`, `A_j = ∫ Φ_j dA`,
//!
//! over the part of the surface that has the primary opposite, cut where facets of the primary end. Φ is dual to the shape functions
//! ([Wohlmuth 2000](crate::references::wohlmuth_2000)): the mean of a field that is a sum of shape functions is its value at the node, so that laws
//! and multipliers stay local. The Φ add up to one: a uniform pressure gives the nodal forces that it has in the bodies, on both sides, and
//! patch tests pass on any pair of meshes.
//!
//! The gradient of the gap is that of the integral at fixed places of the secondary. What moves with the cuts drops out, as the integrand is
//! continuous across them. The change of the gradient itself, of the size of pressure over modulus, is left out of the tangent.

mod clip;
mod correct;
mod dual;
mod integrate;
mod rules;

pub use correct::correct;
pub use dual::{mean_weights, positive_areas};
pub use integrate::{FaceIntegral, Scratch, Sides, integrate};

use crate::math::Vec3;
use crate::shape::ElementKind;

/// Most nodes of a face.
pub const FACE_NODES: usize = 8;

/// A face of the secondary.
#[derive(Debug, Clone, PartialEq)]
pub struct Face {
    /// Line, triangle or quadrilateral, linear or quadratic.
    pub kind: ElementKind,
    /// Its nodes, oriented so that the normal points out of the body.
    pub nodes: Vec<usize>,
    /// The contact point of each node.
    pub points: Vec<usize>,
    /// Unit normal at each node out of the body, averaged where the surface is smooth, in the reference configuration.
    pub normals: Vec<Vec3>,
    /// Extent out of the plane at each node: thickness or `2πr` `[m]`; one in 3D.
    pub extents: Vec<f64>,
}

/// The secondary as faces.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mortar {
    /// The faces.
    pub faces: Vec<Face>,
    /// Faces around each contact point, and its position among their nodes.
    pub around: Vec<Vec<(usize, usize)>>,
}

impl Mortar {
    /// From faces, for this many contact points.
    pub fn new(faces: Vec<Face>, points: usize) -> Self {
        let mut around = vec![Vec::new(); points];
        for (f, face) in faces.iter().enumerate() {
            for (a, &point) in face.points.iter().enumerate() {
                around[point].push((f, a));
            }
        }
        Mortar { faces, around }
    }
}
