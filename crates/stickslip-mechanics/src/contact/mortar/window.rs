//! What a straight cell of a face has in common with those of facets opposite.

use super::clip::Point;
use crate::math::{Vec3, add_scaled, cross, dot, normalize};
use crate::shape::ElementKind;

/// A straight cell of a face, along its normal.
pub(super) trait Window {
    /// A common part.
    type Part;

    /// The part that it has in common with the cell `other` of a facet with nodes at `x`; `None` if that is nothing.
    fn common(&self, x: &[Vec3], other: &[usize]) -> Option<Self::Part>;

    /// Calls `sample` for the quadrature points of a part: their reference coordinates on the face, and their weights there.
    fn places(&self, part: &Self::Part, facet: ElementKind, sample: &mut dyn FnMut(Point, f64));
}

/// Two directions that make a right-handed frame with `n`.
pub(super) fn frame(n: Vec3, along: Vec3) -> Option<[Vec3; 2]> {
    let e = normalize(add_scaled(along, -dot(along, n), n))?;
    Some([e, cross(n, e)])
}
