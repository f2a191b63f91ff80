//! Gmsh's element types and how their nodes are numbered.

use crate::shape::ElementKind;

/// What to do with elements of a Gmsh type.
pub(super) enum Kind {
    /// A point.
    Point,
    /// An element of the family. `order[i]` is the position in Gmsh's list of our node `i`; empty if they agree.
    Solid(ElementKind, &'static [usize]),
    /// Not in the family: its name and what to do.
    Refused(&'static str, &'static str),
}

const INCOMPLETE: &str = "set Mesh.SecondOrderIncomplete = 1 in the .geo file (or gmsh -setnumber \
     Mesh.SecondOrderIncomplete 1) and mesh again, for elements without nodes inside faces and cells";
const HIGH: &str = "elements are of order 1 or 2: set Mesh.ElementOrder and mesh again";
const MIXED: &str = "solids are tetrahedra, hexahedra or prisms: mesh with tetrahedra, or with transfinite and recombined volumes";

/// The element of a type number of the Gmsh format.
pub(super) fn kind(gmsh_type: i64) -> Kind {
    use ElementKind::*;
    match gmsh_type {
        15 => Kind::Point,
        1 => Kind::Solid(Line2, &[]),
        8 => Kind::Solid(Line3, &[]),
        2 => Kind::Solid(Tri3, &[]),
        9 => Kind::Solid(Tri6, &[]),
        3 => Kind::Solid(Quad4, &[]),
        16 => Kind::Solid(Quad8, &[]),
        4 => Kind::Solid(Tet4, &[]),
        // Gmsh has the edges 23 and 13 in this order, we have them the other way round.
        11 => Kind::Solid(Tet10, &[0, 1, 2, 3, 4, 5, 6, 7, 9, 8]),
        5 => Kind::Solid(Hex8, &[]),
        // Gmsh's edges: 01 03 04 12 15 23 26 37 45 47 56 67.
        17 => Kind::Solid(
            Hex20,
            &[
                0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15,
            ],
        ),
        6 => Kind::Solid(Wedge6, &[]),
        // Gmsh's edges: 01 02 03 12 14 25 34 35 45.
        18 => Kind::Solid(Wedge15, &[0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11]),
        10 => Kind::Refused("9-node quadrilateral", INCOMPLETE),
        12 => Kind::Refused("27-node hexahedron", INCOMPLETE),
        13 => Kind::Refused("18-node prism", INCOMPLETE),
        7 => Kind::Refused("5-node pyramid", MIXED),
        14 => Kind::Refused("14-node pyramid", MIXED),
        19 => Kind::Refused("13-node pyramid", MIXED),
        20..=28 | 36..=38 => Kind::Refused("line or surface element of order 3 or more", HIGH),
        29..=31 | 92 | 93 => Kind::Refused("solid element of order 3 or more", HIGH),
        _ => Kind::Refused(
            "element outside the family",
            "lines, triangles, quadrilaterals, tetrahedra, hexahedra and prisms of order 1 or 2 are read",
        ),
    }
}
