//! The geometry of both sides.

use super::face::{FACE_NODES, Face};
use crate::contact::surface::Facet;
use crate::math::{Mat3, Vec3, mat_vec};

/// The geometry of both sides.
#[derive(Debug, Clone, Copy)]
pub struct Sides<'a> {
    /// Coordinates of all nodes now.
    pub x: &'a [Vec3],
    /// At the last accepted state; empty where it is not asked for.
    pub before: &'a [Vec3],
    /// In the reference configuration, which areas are taken from.
    pub reference: &'a [Vec3],
    /// How the secondary as a whole has turned since then.
    pub turn: Mat3,
    /// The primary.
    pub facets: &'a [Facet],
    /// How deep behind each facet a place may lie and meet it `[m]`; empty where any depth will do.
    pub walls: &'a [f64],
    /// Planes of symmetry on which both surfaces end: the axis across, and where they are along it `[m]`.
    pub mirrors: &'a [(usize, f64)],
    /// Whether pressure follows from the gap by a law, so that no gap may be taken from beyond the edge of what lies opposite.
    pub compliant: bool,
}

impl Sides<'_> {
    /// Directions along which the gap of a face is measured, at its nodes: those of the reference turn with the surface as a whole, so that a pair that
    /// turns as one keeps its gap. How the surface bends has no part in them: they would change in every iteration, and the tangent does not know.
    pub(super) fn normals(&self, face: &Face) -> [Vec3; FACE_NODES] {
        let mut out = [[0.0; 3]; FACE_NODES];
        for (o, &normal) in out.iter_mut().zip(&face.normals) {
            *o = mat_vec(&self.turn, normal);
        }
        out
    }
}
