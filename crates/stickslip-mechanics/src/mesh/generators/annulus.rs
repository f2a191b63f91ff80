//! Meshes around a hole: columns of cells that close round the centre.

use super::grading::affordable;
use super::lattice::{Diagonal, Key, Lattice, LatticeCell};
use crate::error::MeshError;
use crate::shape::ElementKind;

/// Columns that close round a centre, each with rows of cells from the hole outwards.
pub(super) struct Annulus<'a> {
    pub centre: [f64; 2],
    pub element: ElementKind,
    /// Rows of each column, counter-clockwise.
    pub rows: &'a [usize],
}

impl Annulus<'_> {
    /// The lattice, with the angle `[rad]` and the radius at each position.
    pub fn lattice(&self, polar: impl Fn(Key) -> [f64; 2]) -> Result<Lattice, MeshError> {
        if self.centre.iter().any(|x| !x.is_finite()) {
            return Err(MeshError::new("the centre is not finite").help("give finite coordinates"));
        }
        let columns = self.rows.len();
        let most = self.rows.iter().copied().max().unwrap_or(0);
        affordable(&[columns, most])?;
        // Angles grow against the clock and radii outwards: left-handed as (angle, radius).
        let cells: Vec<LatticeCell> = (self.rows.iter().enumerate())
            .flat_map(|(i, &rows)| {
                (0..rows).map(move |j| LatticeCell {
                    base: [2 * i, 2 * j, 0, 0],
                    axes: [0, 1, 2],
                    reversed: true,
                })
            })
            .collect();
        let (element, diagonal) = (self.element, Diagonal::default());
        Lattice::closed(2, element, diagonal, &cells, 2 * columns, |key| {
            let [angle, radius] = polar(key);
            let (sine, cosine) = angle.sin_cos();
            let [x, y] = self.centre;
            [x + radius * cosine, y + radius * sine, 0.0]
        })
    }
}

/// Refuses lengths that are not positive.
pub(super) fn positive(lengths: &[(&str, f64)]) -> Result<(), MeshError> {
    match lengths.iter().find(|(_, x)| !(x.is_finite() && *x > 0.0)) {
        None => Ok(()),
        Some((name, x)) => Err(MeshError::new(format!("{name} = {x} is not a length"))
            .help(format!("give a positive {name}"))),
    }
}

/// Refuses numbers of cells that are zero.
pub(super) fn some(counts: &[(&str, usize)]) -> Result<(), MeshError> {
    match counts.iter().find(|(_, n)| *n == 0) {
        None => Ok(()),
        Some((name, _)) => {
            Err(MeshError::new(format!("{name} = 0 makes no cells")).help("give at least 1"))
        }
    }
}
