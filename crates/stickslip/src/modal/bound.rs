//! Displacements that equations determine: they are no unknowns of small motions.
//!
//! Equations between displacements, `A x = 0` about the state, are solved for as many displacements as they say something of, each a weighted sum of others:
//! `x = T q`. The matrices become `Tᵀ K T`, forces `Tᵀ f`, and there are as many modes as freedoms. A stiff spring in place of an equation would add a mode of its
//! own, which on a body that has no other stiffness lies among those that are asked for, and which friction may drive.

use std::collections::{BTreeMap, BTreeSet};

use crate::linear::BlockCsr;

/// A row over dofs.
pub(crate) type Sparse = Vec<(usize, f64)>;

/// Groups that are added to a matrix together.
const GROUPS_TOGETHER: usize = 500;

/// Displacements as sums of others, by dof.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Bound {
    rows: BTreeMap<usize, Sparse>,
}

impl Bound {
    /// Solves equations for as many displacements as they determine. What is `fixed` is zero in them.
    pub fn new(equations: Vec<Sparse>, fixed: &[bool]) -> Self {
        let free = equations.into_iter().map(|row| -> Sparse {
            let kept = substituted(&row, &|_| None).into_iter();
            kept.filter(|(dof, _)| !fixed[*dof]).collect()
        });
        let free: Vec<Sparse> = free.collect();
        // What few equations know of is solved for first, so that little has to be put into others.
        let mut known: BTreeMap<usize, usize> = BTreeMap::new();
        for (dof, _) in free.iter().flatten() {
            *known.entry(*dof).or_default() += 1;
        }
        let mut bound = Bound::default();
        let mut users: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
        for equation in free {
            let size = largest(&equation);
            let mut left = bound.row(&equation);
            // Below this part of its largest factor nothing is left of an equation when others have been put into it: it says nothing new.
            left.retain(|(_, a)| a.abs() > 1e-10 * size);
            let most = largest(&left);
            // The displacement for which an equation is solved has at least a tenth of its largest factor: the sums grow by no more than
            // the inverse of that.
            let able = left.iter().filter(|(_, a)| a.abs() >= 0.1 * most);
            let rank = |dof: &usize| known.get(dof).copied().unwrap_or(0);
            let Some(&(pivot, factor)) = able.min_by(|(i, a), (j, b)| {
                let first = rank(i).cmp(&rank(j));
                first.then(b.abs().total_cmp(&a.abs())).then(i.cmp(j))
            }) else {
                continue;
            };
            left.retain(|(dof, _)| *dof != pivot);
            left.iter_mut().for_each(|(_, a)| *a /= -factor);
            // Those that were solved before may know of it.
            for user in users.remove(&pivot).unwrap_or_default() {
                let Some(row) = bound.rows.remove(&user) else {
                    continue;
                };
                let row = substituted(&row, &|dof| (dof == pivot).then_some(&left));
                row.iter().for_each(|(dof, _)| {
                    users.entry(*dof).or_default().insert(user);
                });
                bound.rows.insert(user, row);
            }
            left.iter().for_each(|(dof, _)| {
                users.entry(*dof).or_default().insert(pivot);
            });
            bound.rows.insert(pivot, left);
        }
        bound
    }

    /// Whether nothing is bound.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// The dofs that are no unknowns any more.
    pub fn dofs(&self) -> impl Iterator<Item = usize> + '_ {
        self.rows.keys().copied()
    }

    /// A row over displacements as one over those that are left.
    pub fn row(&self, row: &Sparse) -> Sparse {
        match row.iter().any(|(dof, _)| self.rows.contains_key(dof)) {
            true => substituted(row, &|dof| self.rows.get(&dof)),
            false => row.clone(),
        }
    }

    /// `x = T q`, in place: bound displacements follow.
    pub fn expand(&self, x: &mut [f64]) {
        for (dof, row) in &self.rows {
            x[*dof] = row.iter().map(|&(other, a)| a * x[other]).sum();
        }
    }

    /// `Tᵀ f`, in place: forces on bound displacements act on those that move them.
    pub fn gather(&self, f: &mut [f64]) {
        for (dof, row) in &self.rows {
            let force = f[*dof];
            f[*dof] = 0.0;
            if force != 0.0 {
                row.iter().for_each(|&(other, a)| f[other] += a * force);
            }
        }
    }

    /// `Tᵀ A T` of symmetric matrices of one pattern, and of one pattern again. Rows and columns of bound displacements stay and have no meaning.
    pub fn reduce(&self, matrices: &[&BlockCsr]) -> Vec<BlockCsr> {
        let mut out: Vec<BlockCsr> = matrices.iter().map(|m| (*m).clone()).collect();
        let Some(dim) = matrices.first().map(|m| m.block_size()) else {
            return out;
        };
        let points: BTreeSet<usize> = self.dofs().map(|dof| dof / dim).collect();
        let points: Vec<usize> = points.into_iter().collect();
        for chunk in points.chunks(GROUPS_TOGETHER) {
            let groups = chunk.iter().map(|&p| self.group(p, matrices));
            let groups: Vec<_> = groups.collect();
            for (k, matrix) in out.iter_mut().enumerate() {
                let own = groups.iter().filter(|(around, _)| !around.is_empty());
                let own = own.map(|(around, dense)| (around.clone(), dense[k].clone()));
                *matrix = matrix.with_groups(&own.collect::<Vec<_>>());
            }
        }
        out
    }

    /// What the bound displacements of a point add to the matrices: the points that it is about, and a dense matrix each. Nothing where they meet nothing.
    fn group(&self, point: usize, matrices: &[&BlockCsr]) -> (Vec<usize>, Vec<Vec<f64>>) {
        let dim = matrices[0].block_size();
        let own: Vec<(usize, &Sparse)> = (point * dim..(point + 1) * dim)
            .filter_map(|dof| Some((dof, self.rows.get(&dof)?)))
            .collect();
        // Entries of all matrices in the rows of this point.
        let mut entries = Vec::new();
        for &(dof, row) in &own {
            for &other in matrices[0].neighbours(point) {
                for j in other as usize * dim..(other as usize + 1) * dim {
                    let values: Vec<f64> = matrices.iter().map(|m| m.entry(dof, j)).collect();
                    if values.iter().any(|v| *v != 0.0) {
                        entries.push((row, j, values));
                    }
                }
            }
        }
        let mut around = BTreeSet::new();
        for (row, j, _) in &entries {
            around.extend(row.iter().map(|(dof, _)| dof / dim));
            match self.rows.get(j) {
                Some(other) => around.extend(other.iter().map(|(dof, _)| dof / dim)),
                None => _ = around.insert(j / dim),
            }
        }
        let around: Vec<usize> = around.into_iter().collect();
        let width = around.len() * dim;
        let place = |dof: usize| -> usize {
            around.binary_search(&(dof / dim)).unwrap_or_default() * dim + dof % dim
        };
        let mut dense = vec![vec![0.0; width * width]; matrices.len()];
        for (row, j, values) in &entries {
            for (out, value) in dense.iter_mut().zip(values) {
                for &(i, a) in row.iter() {
                    match self.rows.get(j) {
                        Some(other) => {
                            for &(j, b) in other {
                                out[place(i) * width + place(j)] += a * b * value;
                            }
                        }
                        // The entry of the other triangle is met nowhere else.
                        None => {
                            let (i, j) = (place(i), place(*j));
                            out[i * width + j] += a * value;
                            out[j * width + i] += a * value;
                        }
                    }
                }
            }
        }
        (around, dense)
    }
}

fn largest(row: &Sparse) -> f64 {
    row.iter().fold(0.0, |m, (_, a)| m.max(a.abs()))
}

/// A row with sums in place of some displacements, each dof once and ascending.
fn substituted<'a>(row: &Sparse, of: &dyn Fn(usize) -> Option<&'a Sparse>) -> Sparse {
    let mut out: BTreeMap<usize, f64> = BTreeMap::new();
    for &(dof, a) in row {
        match of(dof) {
            Some(sum) => {
                let each = sum.iter();
                each.for_each(|&(other, b)| *out.entry(other).or_default() += a * b);
            }
            None => *out.entry(dof).or_default() += a,
        }
    }
    out.into_iter().filter(|(_, a)| *a != 0.0).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three points of two dofs, all coupled, with a symmetric matrix without structure.
    fn matrix() -> BlockCsr {
        let mut matrix = BlockCsr::from_couplings(3, 2, &mut |group| group(&[0, 1, 2]));
        let entry = |i: usize, j: usize| ((i * j + i + j) as f64).sin();
        let dense: Vec<f64> = (0..36).map(|k| entry(k / 6, k % 6)).collect();
        matrix.add_group(&[0, 1, 2], &dense);
        matrix
    }

    #[test]
    fn equations_that_say_the_same_twice_bind_once() {
        let equations = vec![
            vec![(0, 1.0), (2, -1.0)],
            vec![(2, 2.0), (4, -1.0), (5, 3.0)],
            // The sum of both.
            vec![(0, 1.0), (2, 1.0), (4, -1.0), (5, 3.0)],
            // Nothing but what is fixed.
            vec![(1, 1.0)],
        ];
        let fixed = [false, true, false, false, false, false];
        let bound = Bound::new(equations.clone(), &fixed);
        assert_eq!(bound.dofs().count(), 2);
        let mut x = [0.3, 0.0, -1.2, 0.7, 2.1, -0.4];
        bound.expand(&mut x);
        for equation in &equations {
            let sum: f64 = equation.iter().map(|&(dof, a)| a * x[dof]).sum();
            assert!(sum.abs() < 1e-14, "{sum:e}");
        }
    }

    #[test]
    fn energies_are_those_of_the_displacements_that_follow() {
        let equations = vec![
            vec![(0, 1.0), (3, -2.0), (4, 0.5)],
            vec![(1, 1.0), (0, 0.3), (5, 1.0)],
        ];
        let bound = Bound::new(equations, &[false; 6]);
        let matrix = matrix();
        let reduced = &bound.reduce(&[&matrix, &matrix])[1];
        let mut q = [0.9, -0.2, 0.4, 1.3, -0.8, 0.6];
        bound.dofs().for_each(|dof| q[dof] = 0.0);
        let mut x = q;
        bound.expand(&mut x);
        let energy = |matrix: &BlockCsr, x: &[f64]| -> f64 {
            let mut f = vec![0.0; 6];
            matrix.mul(x, &mut f);
            f.iter().zip(x).map(|(f, x)| f * x).sum()
        };
        let (whole, small) = (energy(&matrix, &x), energy(reduced, &q));
        assert!((whole - small).abs() < 1e-13, "{whole} {small}");
        // Forces that are gathered do the work of those that act.
        let mut forces = [1.0, 2.0, -0.5, 0.25, 3.0, -1.0];
        let work = |f: &[f64], x: &[f64]| -> f64 { f.iter().zip(x).map(|(f, x)| f * x).sum() };
        let before = work(&forces, &x);
        bound.gather(&mut forces);
        assert!((before - work(&forces, &q)).abs() < 1e-14);
    }
}
