//! Reference elements: shape functions, their derivatives, faces and quadrature. One file per element.
//!
//! Node order, face order and reference domains follow Gmsh (see its manual, *Node ordering*): lines on `[-1, 1]`,
//! quadrilaterals and hexahedra on `[-1, 1]^d`, triangles and tetrahedra on the unit simplex, wedges on the product of
//! triangle and line. The exceptions are tet10, hex20 and wedge15, whose nodes follow VTK (tet10: edges 01 12 20 03 13 23;
//! hex20: edges 01 12 23 30, 45 56 67 74, 04 15 26 37; wedge15: edges 01 12 20, 34 45 53, 03 14 25), and faces of hexahedra
//! and wedges, which are numbered as in Abaqus; the Gmsh reader translates.

pub(crate) mod gauss;
mod hex20;
mod hex8;
mod kind;
mod line2;
mod line3;
mod quad4;
mod quad8;
mod reference;
mod simplex;
mod tet10;
mod tet4;
mod tri3;
mod tri6;
mod wedge15;
mod wedge6;

#[cfg(test)]
mod tests;

pub use reference::{ElementKind, Face, MAX_NODES, QuadraturePoint, ReferenceElement};

/// A rule that integrates products of two shape functions exactly over an undistorted cell, around an axis too: for masses.
pub fn mass_rule(kind: ElementKind) -> Vec<QuadraturePoint> {
    match kind {
        ElementKind::Line2 | ElementKind::Line3 => gauss::LINE_3.to_vec(),
        ElementKind::Quad4 | ElementKind::Quad8 => gauss::QUAD_3X3.to_vec(),
        ElementKind::Hex8 | ElementKind::Hex20 => gauss::HEX_3X3X3.to_vec(),
        ElementKind::Wedge6 | ElementKind::Wedge15 => gauss::fine_wedge(),
        ElementKind::Tri3 | ElementKind::Tri6 => gauss::collapsed(2),
        ElementKind::Tet4 | ElementKind::Tet10 => gauss::collapsed(3),
    }
}
