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
    pub(super) last: Evaluations,
    /// Memory for the next evaluation: what was evaluated before, or tentatively.
    pub(super) trial: Evaluations,
    /// Coordinates at the last evaluation, and at the accepted state that it started from.
    pub(super) x: Vec<Vec3>,
    pub(super) before: Vec<Vec3>,
    /// The frames of bodies that turn at the last evaluation, and room to assemble what acts in space.
    pub(super) in_space: InSpace,
    pub(super) spatial: Assembler,
    /// Where the facets lie, and which way they look.
    pub(super) bounds: Vec<Bounds>,
    pub(super) anchors: Vec<Option<Anchor>>,
    /// Pairs of the reference configuration, for small sliding.
    pub(super) frozen: Vec<Option<(usize, FacetPoint)>>,
    pub(super) search: Search,
    pub(super) faces: FaceSearch,
    /// Nodes of the faces of a mortar without a multiplier, and the coordinates for which they were found.
    pub(super) merged: Vec<Merged>,
    pub(super) merged_at: Vec<Vec3>,
    /// Integrals over the faces of a mortar.
    pub(super) integrals: Vec<FaceIntegral>,
}

impl Clone for Cache {
    /// A copy of an interface starts with an empty one.
    fn clone(&self) -> Self {
        Cache::default()
    }
}
