//! Points of a mortar without a multiplier.

use std::collections::BTreeMap;

/// Points whose own motion is given on all faces around them, and so have no multiplier, with the points that take their part.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MergedPoints {
    /// By point, those that take its part, once for each face that they share, with the area `[m²]` that they take.
    pub(super) heirs: BTreeMap<usize, Vec<(usize, f64)>>,
    /// By point that takes some, the area that it takes `[m²]`.
    pub(super) taken: BTreeMap<usize, f64>,
}

impl MergedPoints {
    /// Those that take the part of a point; none where it keeps its multiplier.
    pub fn heirs(&self, point: usize) -> &[(usize, f64)] {
        self.heirs.get(&point).map_or(&[], Vec::as_slice)
    }

    /// The area of others that a point takes `[m²]`.
    pub fn taken(&self, point: usize) -> f64 {
        self.taken.get(&point).copied().unwrap_or(0.0)
    }

    /// All of them, with those that take their part.
    pub fn all(&self) -> impl Iterator<Item = (usize, &[(usize, f64)])> {
        (self.heirs.iter()).map(|(&point, heirs)| (point, heirs.as_slice()))
    }
}
