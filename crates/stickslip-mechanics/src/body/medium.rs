//! What all cells of a part share.

use super::geometry::Table;
use super::hourglass::{Hourglass, modulus};
use super::incompatible::Modes;
use super::operator::Operator;
use super::scheme::{Scheme, stiffness_rule};
use super::{Formulation, Space, warmth};
use crate::material::Stiffness;
use crate::shape::ElementKind;

/// Cells of one kind with `N` nodes and of one material.
#[derive(Debug, Clone)]
pub(super) struct Medium<const N: usize> {
    /// Shape functions at the points of the rule for the stiffness.
    pub table: Table<N>,
    pub space: Space,
    pub scheme: Scheme,
    /// Stiffness as it acts in the space.
    pub acting: Stiffness,
    pub operator: Operator,
    /// Motions without strain; none unless the scheme has them.
    pub hourglass: Hourglass<N>,
    /// Young's modulus for them `[Pa]`.
    pub modulus: f64,
    /// Modes inside the cell; of use with the scheme that has them.
    pub modes: Modes<N>,
    /// Shape functions at the centre, where the stress of a uniform strain is taken to be.
    pub centre: [f64; N],
    /// What the temperatures of the nodes weigh at the points of the rule.
    pub warmth: Vec<[f64; N]>,
}

impl<const N: usize> Medium<N> {
    /// For the stiffness as it acts in the space.
    pub fn new(
        kind: ElementKind,
        space: Space,
        formulation: Formulation,
        acting: &Stiffness,
    ) -> Self {
        let scheme = Scheme::of(kind, formulation);
        let rule = stiffness_rule(kind, space, formulation);
        let mut centre = [0.0; N];
        kind.reference().values(kind.centre(), &mut centre);
        Medium {
            table: Table::with_rule(kind, rule),
            space,
            scheme,
            acting: *acting,
            operator: Operator::new(acting, space, scheme),
            hourglass: Hourglass::new(kind, space),
            modulus: modulus(acting, space),
            modes: Modes::new(kind, rule),
            centre,
            warmth: warmth::weights(kind, scheme, rule),
        }
    }

    /// The same cells with another stiffness.
    pub fn set_stiffness(&mut self, acting: &Stiffness) {
        self.acting = *acting;
        self.operator = Operator::new(acting, self.space, self.scheme);
        self.modulus = modulus(acting, self.space);
    }

    /// Number of points at which a cell has its stresses.
    pub fn stations(&self) -> usize {
        match self.scheme {
            Scheme::Uniform => 1,
            _ => self.table.len(),
        }
    }

    /// Shape functions at such a point.
    pub fn values(&self, station: usize) -> &[f64; N] {
        match self.scheme {
            Scheme::Uniform => &self.centre,
            _ => &self.table.values[station],
        }
    }
}
