//! The element types of the format.

use crate::shape::ElementKind;

/// The number of a type: `he8`, `pe6`, `te4`, `he20`, `pe15`, `te10`, `tr3`, `tr6`, `qu4`, `qu8`, `be2`, `be3` are 1 to 12.
pub(super) fn number(kind: ElementKind) -> usize {
    match kind {
        ElementKind::Hex8 => 1,
        ElementKind::Wedge6 => 2,
        ElementKind::Tet4 => 3,
        ElementKind::Hex20 => 4,
        ElementKind::Wedge15 => 5,
        ElementKind::Tet10 => 6,
        ElementKind::Tri3 => 7,
        ElementKind::Tri6 => 8,
        ElementKind::Quad4 => 9,
        ElementKind::Quad8 => 10,
        ElementKind::Line2 => 11,
        ElementKind::Line3 => 12,
    }
}

/// The nodes of a cell in the order of the format: `order[i]` is our node that stands at place `i`. Empty if the orders agree.
///
/// Here, as in input decks, the nodes amid the edges of the top face come before those amid the edges from bottom to top; in the format they come after.
pub(super) fn order(kind: ElementKind) -> &'static [usize] {
    match kind {
        ElementKind::Hex20 => &[
            0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 16, 17, 18, 19, 12, 13, 14, 15,
        ],
        ElementKind::Wedge15 => &[0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 9, 10, 11],
        _ => &[],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The edges of a solid in the order of the format: those of the bottom, from bottom to top, those of the top.
    fn edges(kind: ElementKind) -> Vec<[usize; 2]> {
        let n = kind.corner_count() / 2;
        let ring = |base: usize| (0..n).map(move |i| [base + i, base + (i + 1) % n]);
        let up = (0..n).map(|i| [i, i + n]);
        ring(0).chain(up).chain(ring(n)).collect()
    }

    #[test]
    fn nodes_amid_edges_are_where_the_format_has_them() {
        for kind in [ElementKind::Hex20, ElementKind::Wedge15] {
            let nodes = kind.reference().nodes();
            let at = |place: usize| nodes[order(kind)[place]];
            for (e, [a, b]) in edges(kind).into_iter().enumerate() {
                let middle: [f64; 3] = std::array::from_fn(|i| 0.5 * (at(a)[i] + at(b)[i]));
                assert_eq!(at(kind.corner_count() + e), middle, "{kind} edge {e}");
            }
        }
    }
}
