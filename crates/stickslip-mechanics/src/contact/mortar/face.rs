//! The secondary as faces.

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
    /// The part of each node of its area, by the function of positive integral `[m²]`.
    pub areas: Vec<f64>,
    /// Its area in the reference configuration `[m²]`.
    pub area: f64,
    /// Whether the motion of each node that contact would change is prescribed in some step, or follows from that of others.
    pub held: Vec<bool>,
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
