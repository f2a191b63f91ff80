//! The gradients of a point, and how those of a later time follow from them.

use std::collections::BTreeMap;

use super::place::Place;
use crate::math::{Mat3, inverse};

/// Gradients of the gap and of both slips of a point by dof, row by row.
#[derive(Debug)]
pub(super) struct Gradients {
    dofs: Vec<usize>,
    rows: Vec<f64>,
}

impl Gradients {
    /// Those of a point.
    pub fn of(place: &Place) -> Self {
        Gradients {
            dofs: place.block.dofs.clone(),
            rows: place.block.rows.clone(),
        }
    }

    /// One of them times displacements.
    pub fn along(&self, q: usize, du: &[f64]) -> f64 {
        let n = self.dofs.len();
        let row = &self.rows[q * n..(q + 1) * n];
        row.iter()
            .zip(&self.dofs)
            .map(|(b, &dof)| b * du[dof])
            .sum()
    }

    /// `T` for which `T` times these is nearest to the gradients of a point: the frame of its slips may have turned, the normal have tilted. `None` if it is
    /// not near, as the point has gone to other facets.
    pub fn turn(&self, place: &Place) -> Option<Mat3> {
        let (n, then) = (place.block.dofs.len(), self.dofs.len());
        let own: BTreeMap<usize, usize> = self.dofs.iter().copied().zip(0..).collect();
        let (mut products, mut squares, mut size) = ([[0.0; 3]; 3], [[0.0; 3]; 3], 0.0);
        for a in 0..3 {
            let row = &place.block.rows[a * n..(a + 1) * n];
            size += row.iter().map(|r| r * r).sum::<f64>();
            for b in 0..3 {
                let before = &self.rows[b * then..(b + 1) * then];
                let shared = place.block.dofs.iter().zip(row);
                let shared = shared.filter_map(|(dof, r)| Some(r * before[*own.get(dof)?]));
                products[a][b] = shared.sum();
                let same = self.rows[a * then..(a + 1) * then].iter().zip(before);
                squares[a][b] = same.map(|(a, b)| a * b).sum();
            }
        }
        // In the plane there is one direction of slip.
        let none = [0, 1, 2].map(|a| squares[a][a] == 0.0);
        for a in (0..3).filter(|&a| none[a]) {
            squares[a][a] = 1.0;
        }
        let (inverse, _) = inverse(&squares)?;
        let entry = |a: usize, b: usize| (0..3).map(|k| products[a][k] * inverse[k][b]).sum();
        let mut turn: Mat3 = std::array::from_fn(|a| std::array::from_fn(|b| entry(a, b)));
        let met = turn.iter().flatten().zip(products.iter().flatten());
        let met: f64 = met.map(|(t, p)| t * p).sum();
        for a in (0..3).filter(|&a| none[a]) {
            turn[a][a] = 1.0;
        }
        // Up to a tenth of the gradients may be none of those before.
        (size - met <= 0.1 * 0.1 * size).then_some(turn)
    }
}
