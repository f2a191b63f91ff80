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
    /// Memory for the next evaluation: what was evaluated before, or tentatively.
    pub(in crate::contact) trial: Evaluations,
    /// Coordinates at the last evaluation, and at the accepted state that it started from.
    pub(in crate::contact) x: Vec<Vec3>,
    pub(in crate::contact) before: Vec<Vec3>,
    /// The frames of bodies that turn at the last evaluation, and room to assemble what acts in space.
    pub(in crate::contact) in_space: InSpace,
    pub(in crate::contact) spatial: Assembler,
    /// Where the facets lie, and which way they look.
    pub(in crate::contact) bounds: Vec<Bounds>,
    pub(in crate::contact) anchors: Vec<Option<Anchor>>,
    /// Pairs of the reference configuration, for small sliding.
    pub(in crate::contact) frozen: Vec<Option<(usize, FacetPoint)>>,
    pub(in crate::contact) search: Search,
    pub(in crate::contact) faces: FaceSearch,
    /// Nodes of the faces of a mortar without a multiplier, and the coordinates for which they were found.
    pub(in crate::contact) merged: Vec<Merged>,
    pub(in crate::contact) merged_at: Vec<Vec3>,
    /// Integrals over the faces of a mortar.
    pub(in crate::contact) integrals: Vec<FaceIntegral>,
}

impl Clone for Cache {
    /// A copy of an interface starts with an empty one.
    fn clone(&self) -> Self {
        Cache::default()
    }
}
