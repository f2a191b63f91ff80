//! What a formulation means for cells of a kind: the rule, and how strains follow from displacements.

use super::{Formulation, Space};
use crate::shape::{ElementKind, QuadraturePoint};

/// How the strains of a cell are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Scheme {
    /// As the displacements give them.
    Plain,
    /// With the mean of the dilatation over the cell.
    MeanDilatation,
    /// The mean of all strains over the cell, and stiffness against what has none (`hourglass.rs`).
    Uniform,
    /// With the gradients of modes inside the cell (`incompatible.rs`).
    Incompatible,
}

impl Scheme {
    /// For cells of `kind`.
    pub fn of(kind: ElementKind, formulation: Formulation) -> Self {
        let bilinear = matches!(kind, ElementKind::Quad4 | ElementKind::Hex8);
        match formulation {
            Formulation::MeanDilatation => Scheme::MeanDilatation,
            Formulation::Reduced if bilinear => Scheme::Uniform,
            Formulation::IncompatibleModes if bilinear => Scheme::Incompatible,
            _ => Scheme::Plain,
        }
    }
}

/// The rule for the stiffness of a cell. Means over a cell are exact integrals.
///
/// A tri3 turned about an axis gets the three points of tri6: with one, the ring would have a mode without energy
/// besides its rigid one, and `∫ N r` would be off.
pub(super) fn stiffness_rule(
    kind: ElementKind,
    space: Space,
    formulation: Formulation,
) -> &'static [QuadraturePoint] {
    let element = kind.reference();
    let reduced = formulation == Formulation::Reduced;
    match (kind, space) {
        (ElementKind::Tri3, Space::Axisymmetric) => ElementKind::Tri6.reference().quadrature(),
        _ if reduced && Scheme::of(kind, formulation) == Scheme::Plain => {
            element.reduced_quadrature()
        }
        _ => element.quadrature(),
    }
}

/// The points of a cell at which stresses are printed: those of CalculiX and Abaqus, see
/// [`CellState`](super::CellState).
pub(super) fn printed_rule(
    kind: ElementKind,
    formulation: Formulation,
) -> &'static [QuadraturePoint] {
    let element = kind.reference();
    if kind == ElementKind::Wedge6 || formulation == Formulation::Reduced {
        element.reduced_quadrature()
    } else {
        element.quadrature()
    }
}
