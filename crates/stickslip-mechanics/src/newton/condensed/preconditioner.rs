use std::sync::Arc;

use super::gap_matrix::{GapMatrix, Placed};
use super::lu::Lu;
use super::rows::{GapRows, Rows};
use super::small_matrix::SmallMatrix;
use super::tangent::{Precision, Tangent};
use crate::math::vector::dot;
use crate::system::{Cause, StepFailure};

/// The inverse of the system of some iteration before, without the curvature of the gaps.
///
/// With `Bᵀ C` for the tangent of the interfaces, `(I + Bᵀ C W)⁻¹ = I - Bᵀ (I + C W Bᵀ)⁻¹ C W`
/// (the matrix modification formula, [Hager 1989](stickslip_base::references::hager_1989)): the matrix to be factored has one row for every gap and slip. Forces of artificial
/// springs are rows of it too.
#[derive(Debug)]
pub(super) struct Preconditioner {
    rows: Arc<Vec<Rows>>,
    /// Rows of gaps and slips.
    count: usize,
    order: Option<Vec<usize>>,
    lu: Lu,
    /// `σ` and `Z` at the active dofs of each spring.
    springs: Vec<(f64, Vec<f64>)>,
}

/// What the factor was made of beside the bodies.
#[derive(Debug, Clone, Default, crate::keep::Keep)]
pub(super) struct Factored {
    rows: Arc<Vec<Rows>>,
    count: usize,
    /// Where it was made of a [`GapMatrix`]: when each point had come.
    order: Option<Vec<usize>>,
}

/// Rows up to which the factor is in double precision in any case: it costs next to nothing.
pub(super) const SMALL: usize = 600;

impl Preconditioner {
    /// Factors the tangent of an iteration, with the compliance of gaps and slips if it is known.
    pub fn of(
        tangent: &Tangent,
        of: GapRows,
        gaps: Option<&GapMatrix>,
    ) -> Result<Preconditioner, StepFailure> {
        let GapRows { rows, count } = of;
        let factored = Factored {
            rows: Arc::new(rows.to_vec()),
            count,
            order: gaps.map(|gaps| gaps.order(rows)),
        };
        let kept = gaps.and_then(|gaps| gaps.place(rows));
        Preconditioner::made(factored, tangent, kept)
    }

    /// What it was made of beside the bodies.
    pub fn factored(&self) -> Factored {
        Factored {
            rows: Arc::clone(&self.rows),
            count: self.count,
            order: self.order.clone(),
        }
    }

    /// Factors the tangent of an iteration before; the blocks of the one given play no part.
    pub fn again(factored: Factored, tangent: &Tangent) -> Result<Preconditioner, StepFailure> {
        let gaps = factored.order.as_ref().map(|order| {
            let mut ranked: Vec<(usize, &Rows)> =
                order.iter().copied().zip(&*factored.rows).collect();
            ranked.sort_by_key(|(rank, _)| *rank);
            let rows = ranked.into_iter().map(|(_, rows)| rows.clone()).collect();
            GapMatrix::of(rows, tangent)
        });
        let rows = Arc::clone(&factored.rows);
        let kept = gaps.as_ref().and_then(|gaps| gaps.place(&rows));
        Preconditioner::made(factored, tangent, kept)
    }

    fn made(
        factored: Factored,
        tangent: &Tangent,
        kept: Option<Placed>,
    ) -> Result<Preconditioner, StepFailure> {
        let Factored { rows, count, order } = factored;
        let springs: Vec<(f64, Vec<f64>)> = tangent
            .springs
            .iter()
            .map(|spring| {
                let z = (0..tangent.active.len()).map(|i| tangent.product_at(spring, i));
                (spring.sigma, z.collect())
            })
            .collect();
        let matrix = SmallMatrix {
            tangent,
            rows: &rows,
            count,
            springs: &springs,
            kept,
        };
        let Some(lu) = single(&matrix).or_else(|| double(&matrix)) else {
            return Err(StepFailure::new(
                Cause::Singular,
                "the bodies and interfaces together are singular",
            ));
        };
        Ok(Preconditioner {
            rows,
            count,
            order,
            lu,
            springs,
        })
    }

    /// Whether it is of the same points, whatever their rows are now.
    pub fn is_of(&self, rows: &[Rows], count: usize) -> bool {
        let all = || self.rows.iter().zip(rows);
        self.springs.is_empty()
            && (self.count, self.rows.len()) == (count, rows.len())
            && all().all(|(a, b)| a.is_of(b))
    }

    /// Solves for the forces along the rows, in place.
    pub fn solve(&self, q: &mut [f64]) {
        self.lu.solve(q);
    }

    /// Solves in place.
    pub fn apply(&self, tangent: &Tangent, v: &mut [f64], precision: Precision) {
        let (y, beta) = v.split_at_mut(tangent.active.len());
        let u = tangent.apply_compliance(y, precision);
        let mut q = vec![0.0; self.count + self.springs.len()];
        for rows in self.rows.iter() {
            rows.apply_changes(&u, &mut q);
        }
        for (k, (sigma, z)) in self.springs.iter().enumerate() {
            q[self.count + k] = beta[k] + sigma * dot(z, y);
        }
        self.lu.solve(&mut q);
        for rows in self.rows.iter() {
            rows.subtract_forces(&q, y);
        }
        beta.copy_from_slice(&q[self.count..]);
    }
}

/// The factor in single precision, where that will do.
fn single(matrix: &SmallMatrix) -> Option<Lu> {
    if matrix.count <= SMALL {
        return None;
    }
    let (entries, amplification) = matrix.assemble::<f32>();
    // Up to this amplification `C W Bᵀ` the factor may be in single precision: of its seven digits three are left.
    if amplification > 1e4 {
        return None;
    }
    Lu::of(matrix.count + matrix.springs.len(), entries)
}

fn double(matrix: &SmallMatrix) -> Option<Lu> {
    let (entries, _) = matrix.assemble::<f64>();
    Lu::of(matrix.count + matrix.springs.len(), entries)
}
