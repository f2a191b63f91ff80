//! The straight cells of a face.

use crate::math::{Vec3, add_scaled, distance, scale};
use crate::shape::ElementKind;

/// Corner nodes of the straight cells that a face is cut into: the face itself if its edges are straight.
pub(super) fn cells(
    kind: ElementKind,
    nodes: &[usize],
    reference: &[Vec3],
) -> &'static [&'static [usize]] {
    let corners = kind.corner_count();
    let at = |k: usize| reference[nodes[k]];
    let straight = (corners..nodes.len()).all(|k| {
        let (a, b) = match kind.dim() {
            1 => (at(0), at(1)),
            _ => (at(k - corners), at((k - corners + 1) % corners)),
        };
        let middle = add_scaled(scale(0.5, a), 0.5, b);
        // An edge counts as straight up to this distance of its middle node from its middle, relative to the edge.
        distance(at(k), middle) <= 1e-3 * distance(a, b)
    });
    match (kind, straight) {
        (ElementKind::Line2, _) | (ElementKind::Line3, true) => &[&[0, 1]],
        (ElementKind::Line3, false) => &[&[0, 2], &[2, 1]],
        (ElementKind::Tri3, _) | (ElementKind::Tri6, true) => &[&[0, 1, 2]],
        (ElementKind::Tri6, false) => &[&[0, 3, 5], &[3, 1, 4], &[5, 4, 2], &[3, 4, 5]],
        (ElementKind::Quad8, false) => &[
            &[0, 4, 7],
            &[4, 1, 5],
            &[5, 2, 6],
            &[6, 3, 7],
            &[4, 5, 6, 7],
        ],
        _ => &[&[0, 1, 2, 3]],
    }
}
