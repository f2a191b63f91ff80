//! What a reference element says.

use crate::keep::Keep;

/// The element family.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Hash,
    PartialOrd,
    Ord,
    serde::Serialize,
    serde::Deserialize,
    Keep,
)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum ElementKind {
    /// 2-node line (a boundary facet of tri3 and quad4).
    Line2,
    /// 3-node line (a boundary facet of tri6 and quad8); the third node is the middle one.
    Line3,
    /// 3-node triangle.
    Tri3,
    /// 6-node triangle.
    Tri6,
    /// 4-node quadrilateral.
    Quad4,
    /// 8-node serendipity quadrilateral.
    Quad8,
    /// 4-node tetrahedron.
    Tet4,
    /// 10-node tetrahedron.
    Tet10,
    /// 8-node hexahedron.
    Hex8,
    /// 20-node serendipity hexahedron.
    Hex20,
    /// 6-node wedge: a triangle times a line.
    Wedge6,
    /// 15-node serendipity wedge.
    Wedge15,
}

/// Most nodes any element has.
pub const MAX_NODES: usize = 20;

/// A quadrature point on the reference element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QuadraturePoint {
    /// Reference coordinates; unused ones are zero.
    pub xi: [f64; 3],
    /// Weight. The weights of a rule add up to the measure of the reference element.
    pub weight: f64,
}

/// A face (3D) or edge (2D) of an element: its kind and its nodes as local indices, ordered so that the normal
/// (2D: the tangent turned clockwise, `(t_y, -t_x)`; 3D: right-hand rule) points out of the element.
#[derive(Debug, Clone, Copy)]
pub struct Face {
    /// The face as an element of its own.
    pub kind: ElementKind,
    /// Local node indices in the order of that element.
    pub nodes: &'static [usize],
}

impl Face {
    /// From its kind and nodes.
    pub(super) const fn of(kind: ElementKind, nodes: &'static [usize]) -> Face {
        Face { kind, nodes }
    }
}

/// Corners, and behind them the middles of edges between two of them.
pub(super) const fn with_middles<const N: usize>(
    corners: &[[f64; 3]],
    edges: &[[usize; 2]],
) -> [[f64; 3]; N] {
    let mut nodes = [[0.0; 3]; N];
    let mut k = 0;
    while k < 3 * N {
        let (node, c) = (k / 3, k % 3);
        let ends = if node < corners.len() {
            [node; 2]
        } else {
            edges[node - corners.len()]
        };
        nodes[node][c] = 0.5 * (corners[ends[0]][c] + corners[ends[1]][c]);
        k += 1;
    }
    nodes
}

/// The edges of a prism: those of both ends, and those between them.
pub(super) const fn edges_of_prism<const N: usize>() -> [[usize; 2]; N] {
    let corners = N / 3;
    let mut edges = [[0; 2]; N];
    let mut k = 0;
    while k < corners {
        let next = (k + 1) % corners;
        edges[k] = [k, next];
        edges[k + corners] = [k + corners, next + corners];
        edges[k + 2 * corners] = [k, k + corners];
        k += 1;
    }
    edges
}

/// A reference element.
pub trait ReferenceElement: Sync {
    /// Reference coordinates of the nodes.
    fn nodes(&self) -> &'static [[f64; 3]];
    /// Shape functions at `xi`; `n` has length `nodes().len()`.
    fn values(&self, xi: [f64; 3], n: &mut [f64]);
    /// Their derivatives, `d[node][direction]`; directions beyond the dimension are zero.
    fn gradients(&self, xi: [f64; 3], d: &mut [[f64; 3]]);
    /// Second derivatives `d[node] = [∂ξξ, ∂ηη, ∂ξη]`. Lines, triangles and quadrilaterals only (contact facets);
    /// solids leave `d` zero.
    fn second_derivatives(&self, _xi: [f64; 3], d: &mut [[f64; 3]]) {
        d.fill([0.0; 3]);
    }
    /// Third derivatives `d[node] = [∂ξξξ, ∂ξξη, ∂ξηη, ∂ηηη]`. Zero but for quad8.
    fn third_derivatives(&self, _xi: [f64; 3], d: &mut [[f64; 4]]) {
        d.fill([0.0; 4]);
    }
    /// Faces (3D elements) or edges (2D elements), outward.
    fn faces(&self) -> &'static [Face];
    /// The rule for the stiffness: exact for an undistorted element (wedge15: but for terms above the second order in its triangle).
    fn quadrature(&self) -> &'static [QuadraturePoint];
    /// The rule of reduced integration; that of the stiffness where there is no other.
    fn reduced_quadrature(&self) -> &'static [QuadraturePoint] {
        self.quadrature()
    }
}
