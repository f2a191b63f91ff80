//! VTK's cell types.

use crate::shape::ElementKind;

/// What to do with cells of a VTK type.
pub(super) enum Cell {
    /// A point.
    Vertex,
    /// An element of the family. `order[i]` is the position in VTK's list of our node `i`; empty if they agree.
    Solid(ElementKind, &'static [usize]),
    /// Not in the family: its name and what to do.
    Refused(&'static str, &'static str),
}

/// VTK's number of a kind.
pub(super) fn vtk_type(kind: ElementKind) -> u8 {
    match kind {
        ElementKind::Line2 => 3,
        ElementKind::Line3 => 21,
        ElementKind::Tri3 => 5,
        ElementKind::Tri6 => 22,
        ElementKind::Quad4 => 9,
        ElementKind::Quad8 => 23,
        ElementKind::Tet4 => 10,
        ElementKind::Tet10 => 24,
        ElementKind::Hex8 => 12,
        ElementKind::Hex20 => 25,
        ElementKind::Wedge6 => 13,
        ElementKind::Wedge15 => 26,
    }
}

/// The nodes of a cell in VTK's order, and back again: it is its own inverse. Empty if the orders agree.
///
/// VTK's linear wedge has its first triangle facing out of the cell, while its quadratic one, as ours, has it facing in.
pub(super) fn vtk_order(kind: ElementKind) -> &'static [usize] {
    match kind {
        ElementKind::Wedge6 => &[0, 2, 1, 3, 5, 4],
        _ => &[],
    }
}

const MIXED: &str = "solids are tetrahedra, wedges or hexahedra: mesh with these";
const SPLIT: &str =
    "split it into triangles or tetrahedra (the filter Triangulate or Tetrahedralize of ParaView)";
const SERENDIPITY: &str =
    "write elements of order 1, or of order 2 without nodes inside faces and cells";

/// The meaning of a number in `types`.
pub(super) fn cell(number: f64) -> Cell {
    let ours = ElementKind::ALL
        .into_iter()
        .find(|&kind| f64::from(vtk_type(kind)) == number);
    if let Some(kind) = ours {
        return Cell::Solid(kind, vtk_order(kind));
    }
    let number = if number.fract() == 0.0 { number } else { -1.0 };
    match number as i64 {
        1 => Cell::Vertex,
        8 => Cell::Solid(ElementKind::Quad4, &[0, 1, 3, 2]),
        11 => Cell::Solid(ElementKind::Hex8, &[0, 1, 3, 2, 4, 5, 7, 6]),
        2 => Cell::Refused("poly-vertex", "write the points as single vertices"),
        4 => Cell::Refused("poly-line", "write the lines as single segments"),
        6 => Cell::Refused("triangle strip", SPLIT),
        7 => Cell::Refused("polygon", SPLIT),
        42 => Cell::Refused("polyhedron", SPLIT),
        14 | 27 => Cell::Refused("pyramid", MIXED),
        28 | 29 | 33 | 34 | 37 => {
            Cell::Refused("element with nodes inside faces or cells", SERENDIPITY)
        }
        35 | 36 | 60..=81 => Cell::Refused("element of higher order", SERENDIPITY),
        _ => Cell::Refused(
            "cell outside the family",
            "triangles, quadrilaterals, tetrahedra, wedges and hexahedra of order 1 or 2 are read",
        ),
    }
}
