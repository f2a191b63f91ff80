//! The stencil of a point: gap and slip with their gradients, and what a kinematics makes it from.

use crate::contact::facet_point::FacetPoint;
use crate::math::Vec3;
use crate::shape::ElementKind;

/// Gap and slip of one contact point, with their gradients over its dofs (secondary nodes first, then facet nodes; `dim` a node).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Stencil {
    /// Number of dofs.
    pub n: usize,
    /// Gap, positive if open `[m]`.
    pub gap: f64,
    /// Unit normal out of the primary.
    pub normal: Vec3,
    /// Slip of the secondary over the primary since the last accepted state, in the two directions of the frame `[m]`.
    pub slip: [f64; 2],
    /// The two directions, now: the shear traction on the secondary is `t₁ frame₁ + t₂ frame₂`.
    pub frame: [Vec3; 2],
    /// The same at the last accepted state, in which tractions carried over are expressed: what turns them into those of now is the way of the
    /// point over the surface, and the way of the surface.
    pub frame_before: [Vec3; 2],
    /// Unit normal to the directions at the last accepted state.
    pub normal_before: Vec3,
    /// Cosine of the angle between the directions.
    pub skew: f64,
    /// Where pressure and shear tractions act, each of length `n`: `-Σ tᵢ rowᵢ` are the forces of a unit area. Along the normal this is
    /// the gradient of the gap; the others are what moves the point along the directions of the frame.
    pub rows: [Vec<f64>; 3],
    /// Gradients of the slips; empty where they are the rows above, as in flat places.
    pub slip_rows: [Vec<f64>; 2],
    /// Gradient of the skew; empty where it is zero.
    pub skew_row: Vec<f64>,
    /// Size of the coordinates from which the gap is a difference `[m]`: what its rounding is relative to.
    pub coordinate_scale: f64,
}

impl Stencil {
    /// Empties the stencil for `n` dofs; buffers keep their memory.
    pub fn reset(&mut self, n: usize) {
        self.n = n;
        for row in &mut self.rows {
            row.clear();
            row.resize(n, 0.0);
        }
        for row in &mut self.slip_rows {
            row.clear();
        }
        self.skew_row.clear();
        self.skew = 0.0;
    }
}

/// A contact point on a facet, at the state of evaluation and at the last accepted one.
#[derive(Debug, Clone, Copy)]
pub struct Pair<'a> {
    /// 2 or 3.
    pub dim: usize,
    /// Weights of the secondary nodes.
    pub weights: &'a [f64],
    /// Position of the secondary point.
    pub point: Vec3,
    /// Kind of the facet.
    pub kind: ElementKind,
    /// Coordinates of the facet's nodes.
    pub facet: &'a [Vec3],
    /// Projection of the point on the facet.
    pub foot: &'a FacetPoint,
    /// Projection of the point on the same facet, both at the last accepted state.
    pub anchor: &'a FacetPoint,
    /// The point at the last accepted state.
    pub point_before: Vec3,
    /// Way of the belt that friction sees, over the increment and in space `[m]`: it counts along the directions of the frame, with which it changes.
    pub belt: Vec3,
}

impl Pair<'_> {
    /// Number of dofs of the stencil.
    pub fn dofs(&self) -> usize {
        (self.weights.len() + self.facet.len()) * self.dim
    }
}

/// A way to measure gap and slip.
pub trait Kinematics: Send + Sync {
    /// `true` if pairs, normals and weights are those of the reference configuration: gap and slips are linear in the displacements then and have no second
    /// derivatives.
    fn frozen(&self) -> bool {
        false
    }

    /// `true` if facets must be lines or triangles.
    fn triangles(&self) -> bool {
        false
    }

    /// Fills `out`.
    fn stencil(&self, pair: &Pair, out: &mut Stencil);

    /// Adds `Σ wᵢ kᵢ` to `out`, shape `(n, n)`: the derivatives of the rows, weighted. Those of the normal are symmetric.
    fn add_hessian(&self, pair: &Pair, weights: [f64; 3], out: &mut [f64]);
}
