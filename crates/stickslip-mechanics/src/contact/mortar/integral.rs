//! What is known of a face once it is integrated over.

use super::face::FACE_NODES;
use crate::math::{Vec3, add_scaled};

/// What a node has in a weighted gap: its weight, and the gradient of the gap with respect to it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Entry {
    /// Weight `[m²]`.
    pub weight: f64,
    /// Gradient `[m²]`.
    pub gradient: Vec3,
}

impl Entry {
    pub(super) fn add(&mut self, w: f64, direction: Vec3) {
        self.weight += w;
        self.gradient = add_scaled(self.gradient, w, direction);
    }
}

/// The part of a facet that lies opposite a face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// The facet.
    pub facet: usize,
    /// Common area `[m²]`.
    pub area: f64,
    /// `∫ N_k` over it by node of the facet.
    pub sums: [f64; FACE_NODES],
    /// `∫ Φ_a` over it by node of the face.
    pub shares: [f64; FACE_NODES],
    /// `∫ d` of the direction of the gap's gradient.
    pub direction: Vec3,
    /// `∫ N_b` over it by node of the face.
    pub own: [f64; FACE_NODES],
    /// `∫ ξ` of the reference coordinates of the facet.
    pub place: [f64; 2],
}

/// Integrals over a face, to be divided by the area of the whole contact point.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FaceIntegral {
    /// `∫ Φ_a` by node of the face `[m²]`.
    pub area: [f64; FACE_NODES],
    /// `∫ Φ_a g` `[m³]`.
    pub gap: [f64; FACE_NODES],
    /// By node of the face and, within, by node of the face.
    pub secondary: Vec<Entry>,
    /// Nodes of the primary that take part.
    pub nodes: Vec<usize>,
    /// By node of the face and, within, by these nodes; to be subtracted.
    pub primary: Vec<Entry>,
    /// `∫ Φ_a g ∇N_k` along the facets, ordered as these `[m²]`.
    pub levers: Vec<Vec3>,
    /// By node of the primary, its part of the areas opposite of the facets around it `[m²]`.
    pub reach: Vec<f64>,
    /// By facet.
    pub pieces: Vec<Piece>,
}

impl FaceIntegral {
    /// Makes it that of a face with nothing opposite.
    pub fn clear(&mut self) {
        self.area = [0.0; FACE_NODES];
        self.gap = [0.0; FACE_NODES];
        self.secondary.clear();
        self.nodes.clear();
        self.primary.clear();
        self.levers.clear();
        self.reach.clear();
        self.pieces.clear();
    }

    /// The number of the piece of a facet, new if it is the first time that the face meets it.
    pub(super) fn piece_of(&mut self, facet: usize) -> usize {
        if let Some(known) = self.pieces.iter().position(|p| p.facet == facet) {
            return known;
        }
        self.pieces.push(Piece {
            facet,
            area: 0.0,
            sums: [0.0; FACE_NODES],
            shares: [0.0; FACE_NODES],
            direction: [0.0; 3],
            own: [0.0; FACE_NODES],
            place: [0.0; 2],
        });
        self.pieces.len() - 1
    }
}
