//! What an interface can make again from its definition and displacements: kept because that takes time.

use super::evaluation::Evaluations;
use super::search::{FaceSearch, Search};
use crate::contact::bounds::Bounds;
use crate::contact::facet_point::FacetPoint;
use crate::contact::mortar::{FaceIntegral, Merged};
use crate::contact::pairing::Anchor;
use crate::math::Vec3;
use crate::system::{Assembler, InSpace};

/// What was found for the last evaluations.
#[derive(Debug, Default)]
pub struct Cache {
    /// The last iterate; without points before there is one.
    pub(in crate::contact) last: Evaluations,
    /// What was evaluated last, where that was not for the next iterate, or what the last iterate took the place of.
    pub(in crate::contact) trial: Evaluations,
    /// Where facets of the points were at the start.
    pub(in crate::contact) anchors: Vec<Option<Anchor>>,
    /// Where the surfaces are, and what lies opposite.
    pub(in crate::contact) geometry: Geometry,
    /// Room to assemble what acts in space.
    pub(in crate::contact) spatial: Assembler,
}

/// Where the surfaces of an interface are, and what lies opposite.
#[derive(Debug, Default)]
pub(in crate::contact) struct Geometry {
    /// Coordinates at the last evaluation, and at the accepted state that it started from.
    pub x: Vec<Vec3>,
    pub before: Vec<Vec3>,
    /// The frames of bodies that turn at the last evaluation.
    pub in_space: InSpace,
    /// Where the facets lie, and which way they look.
    pub bounds: Vec<Bounds>,
    /// Pairs of the reference configuration, for small sliding.
    pub frozen: Vec<Option<(usize, FacetPoint)>>,
    pub search: Search,
    pub faces: FaceSearch,
    /// Nodes of the faces of a mortar without a multiplier.
    pub merged: MergedNodes,
    /// Integrals over the faces of a mortar.
    pub integrals: Vec<FaceIntegral>,
    /// The coordinates at which all faces were integrated; empty where some were excluded, or normals were those of another state.
    pub integrated: Vec<Vec3>,
}

/// Nodes of faces without a multiplier, by face, and the coordinates for which they were found.
#[derive(Debug, Default)]
pub(in crate::contact) struct MergedNodes {
    pub nodes: Vec<Merged>,
    pub at: Vec<Vec3>,
}

impl Cache {
    /// Lets what was evaluated last be the iterate; what that was before is kept as what was evaluated last.
    pub(super) fn take_trial(&mut self) {
        std::mem::swap(&mut self.last, &mut self.trial);
    }
}

impl Clone for Cache {
    /// A copy of an interface starts with an empty one.
    fn clone(&self) -> Self {
        Cache::default()
    }
}
