use super::reference::{ElementKind, ReferenceElement};
use super::{
    hex8::Hex8, hex20::Hex20, line2::Line2, line3::Line3, quad4::Quad4, quad8::Quad8, tet4::Tet4,
    tet10::Tet10, tri3::Tri3, tri6::Tri6, wedge6::Wedge6, wedge15::Wedge15,
};

impl ElementKind {
    /// Every kind, by dimension and order.
    pub const ALL: [ElementKind; 12] = [
        ElementKind::Line2,
        ElementKind::Line3,
        ElementKind::Tri3,
        ElementKind::Tri6,
        ElementKind::Quad4,
        ElementKind::Quad8,
        ElementKind::Tet4,
        ElementKind::Tet10,
        ElementKind::Hex8,
        ElementKind::Hex20,
        ElementKind::Wedge6,
        ElementKind::Wedge15,
    ];

    /// Its shape functions, faces and quadrature.
    pub fn reference(self) -> &'static dyn ReferenceElement {
        match self {
            ElementKind::Line2 => &Line2,
            ElementKind::Line3 => &Line3,
            ElementKind::Tri3 => &Tri3,
            ElementKind::Tri6 => &Tri6,
            ElementKind::Quad4 => &Quad4,
            ElementKind::Quad8 => &Quad8,
            ElementKind::Tet4 => &Tet4,
            ElementKind::Tet10 => &Tet10,
            ElementKind::Hex8 => &Hex8,
            ElementKind::Hex20 => &Hex20,
            ElementKind::Wedge6 => &Wedge6,
            ElementKind::Wedge15 => &Wedge15,
        }
    }

    /// Dimension of the reference element: 1, 2 or 3.
    pub fn dim(self) -> usize {
        match self {
            ElementKind::Line2 | ElementKind::Line3 => 1,
            ElementKind::Tri3 | ElementKind::Tri6 | ElementKind::Quad4 | ElementKind::Quad8 => 2,
            ElementKind::Tet4
            | ElementKind::Tet10
            | ElementKind::Hex8
            | ElementKind::Hex20
            | ElementKind::Wedge6
            | ElementKind::Wedge15 => 3,
        }
    }

    /// Number of nodes.
    pub fn node_count(self) -> usize {
        match self {
            ElementKind::Line2 => 2,
            ElementKind::Line3 | ElementKind::Tri3 => 3,
            ElementKind::Quad4 | ElementKind::Tet4 => 4,
            ElementKind::Tri6 | ElementKind::Wedge6 => 6,
            ElementKind::Quad8 | ElementKind::Hex8 => 8,
            ElementKind::Tet10 => 10,
            ElementKind::Wedge15 => 15,
            ElementKind::Hex20 => 20,
        }
    }

    /// Number of corners, which are the first nodes.
    pub fn corner_count(self) -> usize {
        self.linear().node_count()
    }

    /// The kind of the same shape with corner nodes only.
    pub fn linear(self) -> ElementKind {
        match self {
            ElementKind::Line2 | ElementKind::Line3 => ElementKind::Line2,
            ElementKind::Tri3 | ElementKind::Tri6 => ElementKind::Tri3,
            ElementKind::Quad4 | ElementKind::Quad8 => ElementKind::Quad4,
            ElementKind::Tet4 | ElementKind::Tet10 => ElementKind::Tet4,
            ElementKind::Hex8 | ElementKind::Hex20 => ElementKind::Hex8,
            ElementKind::Wedge6 | ElementKind::Wedge15 => ElementKind::Wedge6,
        }
    }

    /// Polynomial order: 1 without mid-side nodes, 2 with.
    pub fn order(self) -> usize {
        if self == self.linear() { 1 } else { 2 }
    }

    /// Whether it is a triangle or a tetrahedron.
    pub fn is_simplex(self) -> bool {
        matches!(self.linear(), ElementKind::Tri3 | ElementKind::Tet4)
    }

    /// The name in problem files: `quad4`.
    pub fn name(self) -> &'static str {
        match self {
            ElementKind::Line2 => "line2",
            ElementKind::Line3 => "line3",
            ElementKind::Tri3 => "tri3",
            ElementKind::Tri6 => "tri6",
            ElementKind::Quad4 => "quad4",
            ElementKind::Quad8 => "quad8",
            ElementKind::Tet4 => "tet4",
            ElementKind::Tet10 => "tet10",
            ElementKind::Hex8 => "hex8",
            ElementKind::Hex20 => "hex20",
            ElementKind::Wedge6 => "wedge6",
            ElementKind::Wedge15 => "wedge15",
        }
    }

    /// Reference coordinates of the centre.
    pub fn centre(self) -> [f64; 3] {
        match self.linear() {
            ElementKind::Tri3 | ElementKind::Wedge6 => [1.0 / 3.0, 1.0 / 3.0, 0.0],
            ElementKind::Tet4 => [0.25; 3],
            _ => [0.0; 3],
        }
    }
}

impl std::fmt::Display for ElementKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}
