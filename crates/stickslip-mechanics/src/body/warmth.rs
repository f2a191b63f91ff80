//! Thermal strain in a cell.
//!
//! A cell has the temperatures that suit its strains: with strains that are constant in it, the mean of its nodes; in quadratic cells what its
//! corners have, linearly, as CalculiX and Abaqus do. Temperatures of a higher order would press on strains that the cell does not have.

use super::scheme::Scheme;
use crate::material::Dilation;
use crate::shape::{ElementKind, QuadraturePoint};

/// The warmth of one cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct Warmth<'a, const N: usize> {
    pub dilation: &'a Dilation,
    /// Temperatures of the nodes at the start.
    pub start: [f64; N],
    /// By how much they are warmer now.
    pub rise: [f64; N],
}

impl<const N: usize> Warmth<'_, N> {
    /// The thermal strain where the nodes have these weights.
    pub fn strain(&self, weights: &[f64; N]) -> [f64; 6] {
        let mean = |values: &[f64; N]| values.iter().zip(weights).map(|(v, w)| v * w).sum();
        self.dilation.strain(mean(&self.start), mean(&self.rise))
    }
}

/// What the temperatures of the nodes weigh at each point of a rule.
pub(super) fn weights<const N: usize>(
    kind: ElementKind,
    scheme: Scheme,
    rule: &[QuadraturePoint],
) -> Vec<[f64; N]> {
    let corners = match kind {
        ElementKind::Tri6 => ElementKind::Tri3,
        ElementKind::Quad8 => ElementKind::Quad4,
        ElementKind::Tet10 => ElementKind::Tet4,
        ElementKind::Wedge15 => ElementKind::Wedge6,
        ElementKind::Hex20 => ElementKind::Hex8,
        _ if scheme == Scheme::Incompatible => kind,
        _ => return vec![[1.0 / N as f64; N]; rule.len()],
    };
    let count = corners.node_count();
    let at = |q: &QuadraturePoint| {
        let mut weights = [0.0; N];
        corners.reference().values(q.xi, &mut weights[..count]);
        weights
    };
    rule.iter().map(at).collect()
}
