//! The compliance of gaps and slips, kept from one linear system to the next where their gradients stay what they are.

use std::collections::{HashMap, HashSet};

use rayon::prelude::*;

use super::lu::Entry;
use super::rows::{Rows, Tied};
use super::tangent::{Precision, Tangent};
use crate::linear::Compliance;

/// `G = B W Bᵀ`: how far gaps open and points slip under unit forces along gaps and slips.
///
/// Of two bodies that press each other the compliance has rows for all dofs near the points that touch, on either side; `G` has three for a point. Where surfaces
/// slide by little its gradients do not change, and a Krylov step reads `G` alone.
///
/// The entry of two points is the product of the one that came first with what the other moves: with the same points in the same order all bits are the same.
#[derive(Debug)]
pub(super) struct GapMatrix {
    /// The points in the order in which they came.
    rows: Vec<Rows>,
    /// Place in that order by key.
    places: HashMap<[u64; 2], usize>,
    /// First row of each point, and their number.
    starts: Vec<usize>,
    matrix: Compliance,
}

/// Rows that the matrix may have for each one that is used.
const SLACK: usize = 2;

/// Whether gradients are mostly what they were.
pub(super) fn hardly_change(keys: &[[u64; 2]], before: &[[u64; 2]]) -> bool {
    let before: HashSet<[u64; 2]> = before.iter().copied().collect();
    let same = keys.iter().filter(|&key| before.contains(key)).count();
    // It pays to keep what the gradients give if these are those of the last solution at so many of the points.
    same as f64 >= 0.9 * keys.len() as f64
}

impl Default for GapMatrix {
    /// That of no points.
    fn default() -> Self {
        GapMatrix {
            rows: Vec::new(),
            places: HashMap::new(),
            starts: vec![0],
            matrix: Compliance::from_values(0, Vec::new()),
        }
    }
}

impl GapMatrix {
    /// The matrix of points in this order.
    pub fn of(rows: Vec<Rows>, tangent: &Tangent) -> GapMatrix {
        GapMatrix::default().followed_by(Vec::new(), rows, tangent)
    }

    /// The points in their order.
    pub fn rows(&self) -> &[Rows] {
        &self.rows
    }

    /// A matrix that has these points: this one, if it has them all and not many others; or else of them alone, those that are known first.
    pub fn with(self, points: &[Rows], tangent: &Tangent) -> GapMatrix {
        let asked: HashSet<[u64; 2]> = points.iter().map(Rows::key).collect();
        let used: usize = points.iter().map(Rows::count).sum();
        let known = asked.iter().all(|key| self.places.contains_key(key));
        if known && self.matrix.size() <= SLACK * used {
            return self;
        }
        let kept: Vec<usize> = (0..self.rows.len())
            .filter(|&k| asked.contains(&self.rows[k].key()))
            .collect();
        let new = points
            .iter()
            .filter(|p| !self.places.contains_key(&p.key()));
        let new = new.cloned().collect();
        self.followed_by(kept, new, tangent)
    }

    /// Some of its points and new ones behind them.
    fn followed_by(self, kept: Vec<usize>, new: Vec<Rows>, tangent: &Tangent) -> GapMatrix {
        let old: Vec<usize> = kept
            .iter()
            .flat_map(|&k| self.starts[k]..self.starts[k + 1])
            .collect();
        let mut rows: Vec<Rows> = kept.iter().map(|&k| self.rows[k].clone()).collect();
        rows.extend(new);
        let mut starts = vec![0];
        for point in &rows {
            starts.push(starts[starts.len() - 1] + point.count());
        }
        let n = starts[rows.len()];
        let known = self.matrix.size();
        let lines: Vec<(usize, usize)> = (0..rows.len())
            .flat_map(|k| (0..rows[k].count()).map(move |q| (k, q)))
            .collect();
        let mut values = vec![0.0; n * n];
        // Column by column what is above the diagonal: points that came before.
        values
            .par_chunks_exact_mut(n.max(1))
            .zip(lines.into_par_iter().enumerate())
            .for_each(|(column, (at, (point, q)))| match old.get(at) {
                Some(&from) => {
                    let before = &self.matrix.values()[from * known..];
                    for (out, &row) in column.iter_mut().zip(&old[..=at]) {
                        *out = before[row];
                    }
                }
                None => {
                    let u = tangent.displacement_along(&rows[point], q);
                    for (k, other) in rows[..=point].iter().enumerate() {
                        other.apply_gradients(&u, &mut column[starts[k]..starts[k + 1]]);
                    }
                }
            });
        mirror_up(n, &mut values);
        GapMatrix {
            places: rows.iter().map(Rows::key).zip(0..).collect(),
            rows,
            starts,
            matrix: Compliance::from_values(n, values),
        }
    }

    /// Where points are in it; `None` if one is not, or if its forces follow from more than its gaps and slips.
    pub fn place(&self, points: &[Rows]) -> Option<Placed<'_>> {
        let of = |rows: &Rows| {
            let first = self.starts[*self.places.get(&rows.key())?];
            Some((first, rows.tied()?))
        };
        let points = points.iter().map(of).collect::<Option<Vec<_>>>()?;
        Some(Placed {
            matrix: &self.matrix,
            points,
        })
    }

    /// Ranks of points by the order in which they came, as far as they are there.
    pub fn order(&self, points: &[Rows]) -> Vec<usize> {
        let place = |rows: &Rows| self.places.get(&rows.key()).copied();
        points.iter().filter_map(place).collect()
    }
}

/// Copies what is above the diagonal below it.
fn mirror_up(n: usize, values: &mut [f64]) {
    for j in 0..n {
        for i in 0..j {
            values[i * n + j] = values[j * n + i];
        }
    }
}

/// The points of a linear system in a [`GapMatrix`].
pub(super) struct Placed<'a> {
    matrix: &'a Compliance,
    /// First row of each, and `S`.
    points: Vec<(usize, Tied)>,
}

impl Placed<'_> {
    /// `out = (I + S G) q`.
    pub fn apply(&self, q: &[f64], out: &mut [f64], precision: Precision) {
        let n = self.matrix.size();
        let (mut x, mut u) = (vec![0.0; n], vec![0.0; n]);
        let mut rest = q;
        for (first, tied) in &self.points {
            let (own, behind) = rest.split_at(tied.count);
            x[*first..first + tied.count].copy_from_slice(own);
            rest = behind;
        }
        match precision {
            Precision::Single => self.matrix.mul_single(&x, &mut u),
            Precision::Double => self.matrix.mul(&x, &mut u),
        }
        let mut at = 0;
        for (first, tied) in &self.points {
            let own = at..at + tied.count;
            tied.times(&u[*first..first + tied.count], &mut out[own.clone()]);
            out[own.clone()]
                .iter_mut()
                .zip(&q[own])
                .for_each(|(out, q)| *out += q);
            at += tied.count;
        }
    }

    /// `I + S G` column by column, and the largest entry of the diagonal of `S G`.
    pub fn assemble<T: Entry>(&self) -> (Vec<T>, f64) {
        let n = self.matrix.size();
        let size: usize = self.points.iter().map(|(_, tied)| tied.count).sum();
        let columns: Vec<usize> = (self.points.iter())
            .flat_map(|(first, tied)| *first..first + tied.count)
            .collect();
        let mut matrix = vec![T::of(0.0); size * size];
        let diagonal = matrix
            .par_chunks_exact_mut(size.max(1))
            .zip(columns.par_iter().enumerate())
            .map(|(out, (at, &column))| {
                let g = &self.matrix.values()[column * n..(column + 1) * n];
                let (mut row, mut sums) = (0, [0.0; 3]);
                let mut diagonal = 0.0;
                for (first, tied) in &self.points {
                    let sums = &mut sums[..tied.count];
                    tied.times(&g[*first..first + tied.count], sums);
                    for &sum in sums.iter() {
                        if row == at {
                            diagonal = sum;
                        }
                        out[row] = T::of(sum + f64::from(u8::from(row == at)));
                        row += 1;
                    }
                }
                diagonal.abs()
            })
            .collect::<Vec<f64>>();
        (matrix, diagonal.into_iter().fold(0.0, f64::max))
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::super::active::{self, Active};
    use super::super::condensation::{Condensation, Plan};
    use super::super::library::Library;
    use super::*;
    use crate::linear::{BlockCsr, Engine, Multifrontal};
    use crate::system::ContactBlock;

    /// Points of each of two bodies, all of which may touch.
    const POINTS: usize = 40;

    fn noise(k: usize) -> f64 {
        (12.9898 * k as f64).sin().fract()
    }

    /// Two chains of points, each tied to the next ones and to the ground.
    fn bodies() -> Condensation {
        let links = (0..2).flat_map(|body| (1..POINTS).map(move |k| body * POINTS + k));
        let links: Vec<[usize; 2]> = links.map(|k| [k - 1, k]).collect();
        let mut matrix = BlockCsr::from_couplings(2 * POINTS, 3, &mut |couple| {
            links.iter().for_each(|link| couple(link));
        });
        for (at, link) in links.iter().enumerate() {
            let mut dense = [0.0; 36];
            for i in 0..6 {
                for j in 0..6 {
                    let same = if (i < 3) == (j < 3) { 1.0 } else { -1.0 };
                    let along = |i: usize| 0.3 + noise(7 * at + i % 3);
                    dense[6 * i + j] =
                        same * (along(i) * along(j) + f64::from(u8::from(i % 3 == j % 3)));
                }
            }
            matrix.add_group(link, &dense);
        }
        for dof in 0..matrix.rows() {
            matrix.add_diagonal(dof, 0.05);
        }
        let engine: Arc<dyn Engine> = Arc::new(Multifrontal);
        let library = Library::new(0);
        let (fixed, kept) = (vec![false; matrix.rows()], vec![true; 2 * POINTS]);
        let parts = [0..POINTS, POINTS..2 * POINTS];
        let springs = super::super::ArtificialSprings {
            places: &|_| None,
            typical: 1.0,
        };
        let plan = Plan::new(&matrix, &parts, &fixed, &kept, springs, &library, &engine).unwrap();
        let made = Condensation::new(plan, &matrix, &fixed, springs, &library, &|| true);
        made.unwrap().0
    }

    /// The block of a point of the first body over two of the second; `turned` by something, with a tangent of its own.
    fn block(k: usize, turned: f64) -> ContactBlock {
        let dofs = [k, POINTS + k, POINTS + (k + 1) % POINTS];
        let dofs: Vec<usize> = dofs.iter().flat_map(|p| 3 * p..3 * p + 3).collect();
        let weights = [1.0, -0.4, -0.6];
        let axes =
            |q: usize, c: usize| noise(31 * k + 3 * q + c) + if q == c { 2.0 } else { turned };
        let row = |q: usize| (0..9).map(move |i| weights[i / 3] * axes(q, i % 3));
        let rows: Vec<f64> = (0..3).flat_map(row).collect();
        let s = |q: usize, p: usize| noise(5 * k + 3 * q + p) + if q == p { 4.0 } else { 0.0 };
        let change = (0..27).map(|at| {
            let (q, i) = (at / 9, at % 9);
            (0..3).map(|p| s(q, p) * rows[9 * p + i]).sum()
        });
        ContactBlock {
            change: change.collect(),
            dofs,
            rows,
            ..ContactBlock::default()
        }
    }

    /// Calls with the rows of these points and their tangent.
    fn with<R>(
        bodies: &Condensation,
        points: &[(usize, f64)],
        call: impl FnOnce(&[Rows], &Tangent) -> R,
    ) -> R {
        let all: Vec<ContactBlock> = (0..POINTS).map(|k| block(k, 0.0)).collect();
        let active = Active::new(bodies, &Active::touched(bodies, &all));
        let blocks: Vec<ContactBlock> =
            points.iter().map(|&(k, turned)| block(k, turned)).collect();
        let placed: Vec<active::Placed> = blocks.iter().map(|b| active.place(bodies, b)).collect();
        let tangent = Tangent {
            condensation: bodies,
            active: &active,
            blocks: &placed,
            springs: &[],
        };
        call(&Rows::of(&placed).0, &tangent)
    }

    /// `(I + C W Bᵀ) q` by the compliance itself.
    fn applied(rows: &[Rows], tangent: &Tangent, q: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; tangent.active.len()];
        rows.iter().for_each(|rows| rows.subtract_forces(q, &mut y));
        let u = tangent.apply_compliance(&y, Precision::Double);
        let mut out = vec![0.0; q.len()];
        rows.iter()
            .for_each(|rows| rows.apply_changes(&u, &mut out));
        out.iter().zip(q).map(|(out, q)| q - out).collect()
    }

    fn straight(points: impl IntoIterator<Item = usize>) -> Vec<(usize, f64)> {
        points.into_iter().map(|k| (k, 0.0)).collect()
    }

    #[test]
    fn it_is_the_compliance_of_gaps_and_slips_whoever_comes_and_goes() {
        let bodies = bodies();
        let mut kept = GapMatrix::default();
        let turned: Vec<(usize, f64)> = (4..30)
            .map(|k| (k, if k == 9 { 0.3 } else { 0.0 }))
            .collect();
        // more, fewer, others, one that has turned
        for points in [
            straight(0..20),
            straight(0..30),
            straight(4..30),
            straight((3..9).chain(25..40)),
            turned,
        ] {
            kept = with(&bodies, &points, |rows, tangent| {
                let kept = kept.with(rows, tangent);
                let placed = kept.place(rows).unwrap();
                let q: Vec<f64> = (0..3 * rows.len()).map(noise).collect();
                let mut out = vec![0.0; q.len()];
                placed.apply(&q, &mut out, Precision::Double);
                let expected = applied(rows, tangent, &q);
                let (matrix, _) = placed.assemble::<f64>();
                for (i, (out, expected)) in out.iter().zip(&expected).enumerate() {
                    let product: f64 = (0..q.len()).map(|j| matrix[j * q.len() + i] * q[j]).sum();
                    let size = 1e-11 * expected.abs().max(10.0);
                    assert!((out - expected).abs() < size, "{out} {expected}");
                    assert!((product - expected).abs() < size, "{product} {expected}");
                }
                kept
            });
        }
    }

    #[test]
    fn it_is_made_again_with_the_same_bits() {
        let bodies = bodies();
        let mut kept = GapMatrix::default();
        for points in [
            straight(20..40),
            straight(10..40),
            straight((0..9).chain(30..40)),
        ] {
            kept = with(&bodies, &points, |rows, tangent| kept.with(rows, tangent));
        }
        let points = straight((0..9).chain(30..40));
        let again = with(&bodies, &points, |_, tangent| {
            GapMatrix::of(kept.rows().to_vec(), tangent)
        });
        assert_eq!(kept.matrix.values(), again.matrix.values());
        // what was there first stands first
        assert_eq!(
            with(&bodies, &points, |rows, _| kept.order(rows))[9..],
            [0, 1, 2, 3, 4, 5, 6, 7, 8, 9]
        );
    }

    #[test]
    fn forces_that_follow_from_more_than_gaps_are_not_tied() {
        let bodies = bodies();
        with(&bodies, &straight(0..3), |rows, tangent| {
            let kept = GapMatrix::of(rows.to_vec(), tangent);
            assert!(kept.place(rows).is_some());
            let blocks: Vec<ContactBlock> = (0..3)
                .map(|k| {
                    let mut block = block(k, 0.0);
                    block.change[4] += 0.1 * f64::from(u8::from(k == 1));
                    block
                })
                .collect();
            let placed: Vec<active::Placed> = (blocks.iter())
                .map(|b| tangent.active.place(&bodies, b))
                .collect();
            assert!(kept.place(&Rows::of(&placed).0).is_none());
        });
    }

    #[test]
    fn a_few_that_come_do_not_count_as_change() {
        let bodies = bodies();
        let keys = |points: &[(usize, f64)]| {
            with(&bodies, points, |rows, _| {
                rows.iter().map(Rows::key).collect::<Vec<_>>()
            })
        };
        let before = keys(&straight(0..30));
        assert!(hardly_change(&keys(&straight(0..33)), &before));
        assert!(hardly_change(&keys(&straight(20..30)), &before));
        assert!(!hardly_change(&keys(&straight(0..40)), &before));
        let turned: Vec<(usize, f64)> = (0..30).map(|k| (k, 1e-15)).collect();
        assert!(!hardly_change(&keys(&turned), &before));
        assert!(!hardly_change(&before, &[]));
    }
}
