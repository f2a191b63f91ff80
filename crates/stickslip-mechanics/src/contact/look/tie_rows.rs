//! What an explicit increment holds exactly of a tie.

use crate::contact::interface::{History, Interface};
use crate::math::norm;

/// One direction in which an explicit increment holds a point of a tie exactly.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TieRow {
    /// The point.
    pub point: usize,
    /// The gap, or one of the two components of slip.
    pub direction: usize,
    /// Gradient of it, by dof.
    pub terms: Vec<(usize, f64)>,
    /// What it is, and should not be `[m]`.
    pub off: f64,
    /// Area that the point stands for `[m²]`.
    pub area: f64,
    /// What it is a sum of, rounding of which shows in it `[m]`.
    pub size: f64,
}

/// What is to be held exactly, as it was at the last evaluation.
pub fn tie_rows(interface: &Interface, state: &History) -> Vec<TieRow> {
    let mut out = Vec::new();
    if !interface.view(state).holds_exactly() {
        return out;
    }
    let largest = interface
        .reference
        .iter()
        .map(|&x| norm(x))
        .fold(0.0, f64::max);
    let points = interface.cache.last.points.iter().enumerate();
    for (i, e) in points {
        let batch = interface.cache.last.batch(i);
        let Some(tangent) = batch.tangent(e) else {
            continue;
        };
        let (mut dofs, mut rows) = (batch.dofs(e).to_vec(), tangent.rows.to_vec());
        (interface.cache.geometry.in_space).gradients(&mut dofs, &mut rows);
        for (direction, row) in rows.chunks_exact(dofs.len()).enumerate() {
            let terms = dofs.iter().copied().zip(row.iter().copied());
            let terms: Vec<_> = terms.filter(|(_, a)| *a != 0.0).collect();
            if !terms.is_empty() {
                let factors: f64 = terms.iter().map(|(_, a)| a.abs()).sum();
                out.push(TieRow {
                    point: i,
                    direction,
                    terms,
                    off: e.off[direction],
                    area: e.area,
                    size: factors * largest,
                });
            }
        }
    }
    out
}
