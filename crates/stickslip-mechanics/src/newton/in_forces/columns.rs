//! The operator of friction problems that follow each other, of which a column is made once.

use std::collections::BTreeMap;

use super::gradients::Gradients;
use super::linear::Linear;
use super::place::{At, Place};
use crate::friction::FrictionProblem;
use crate::math::{Mat3, identity, inverse, mat_vec, transpose_vec};
use crate::system::StepFailure;

/// Most unknowns of a friction problem: solvers take their cube.
pub(super) const MOST_UNKNOWNS: usize = 900;

/// Most unknowns that have columns, relative to those.
const REMEMBERED: usize = 2;

/// What forces at points do to points through the bodies, `B K⁻¹ Bᵀ`, as it was when its columns were made, and the last forces.
///
/// A column is the solution of a linear system. Most friction problems of an increment differ from the one before by what laws and surfaces have become at
/// its solution, which is little: the frames of points turn, and their columns with them. A problem is stated around forces whose motion is known, `u = u(r₀)
/// + W (r - r₀)`, so that it is exact at the forces that solve it, whatever `W` is.
#[derive(Debug, Default)]
pub(super) struct Columns {
    /// Where a point stands among those that have columns.
    places: BTreeMap<At, usize>,
    known: Vec<Known>,
    /// By component of those points, over their components.
    values: Vec<Vec<f64>>,
    /// The pass at hand.
    pass: usize,
}

/// A point with columns.
#[derive(Debug)]
struct Known {
    /// The gradients that it had when they were made.
    gradients: Gradients,
    /// How those of the pass at hand follow from them.
    turn: Mat3,
    /// The pass in which they were made.
    made: usize,
    /// Its last forces, along the gradients that it had then.
    forces: [f64; 3],
}

impl Columns {
    /// Goes on with the points of another pass, and makes columns of those that have none, or that have gone to other facets.
    pub fn begin(&mut self, linear: &mut Linear, points: &[&Place]) -> Result<(), StepFailure> {
        self.pass += 1;
        let mut new = Vec::new();
        for &point in points {
            let known = self.places.get(&point.at).map(|&k| &mut self.known[k]);
            let turned = known.and_then(|known| {
                known.turn = known.gradients.turn(point)?;
                Some(())
            });
            if turned.is_none() {
                new.push(point);
            }
        }
        let all = (self.known.len() + new.len()) * linear.dimension();
        if all > REMEMBERED * MOST_UNKNOWNS {
            *self = Columns {
                pass: self.pass,
                ..Columns::default()
            };
            new = points.to_vec();
        }
        self.make(linear, &new)
    }

    /// Makes those columns of points anew that are not of this pass.
    pub fn renew(&mut self, linear: &mut Linear, points: &[&Place]) -> Result<(), StepFailure> {
        let old = points.iter().filter(|p| !self.is_new(p));
        let old: Vec<&Place> = old.copied().collect();
        self.make(linear, &old)
    }

    /// Whether all columns of points are of this pass.
    pub fn are_new(&self, points: &[&Place]) -> bool {
        points.iter().all(|p| self.is_new(p))
    }

    fn is_new(&self, point: &Place) -> bool {
        self.known[self.places[&point.at]].made == self.pass
    }

    /// Makes columns. What other points do to these is what these do to them, which is true of all but surroundings that slip.
    fn make(&mut self, linear: &mut Linear, points: &[&Place]) -> Result<(), StepFailure> {
        let d = linear.dimension();
        for point in points {
            let k = *self.places.entry(point.at).or_insert(self.known.len());
            let known = Known {
                gradients: Gradients::of(point),
                turn: identity(),
                made: self.pass,
                forces: self.known.get(k).map_or([0.0; 3], |known| known.forces),
            };
            match self.known.get_mut(k) {
                Some(before) => *before = known,
                None => self.known.push(known),
            }
        }
        let size = self.known.len() * d;
        self.values.resize(size, Vec::new());
        for column in &mut self.values {
            column.resize(size, 0.0);
        }
        let mut unit = vec![0.0; linear.rest.len()];
        for point in points {
            for q in 0..d {
                unit.fill(0.0);
                point.push(q, 1.0, &mut unit);
                let du = linear.displacements(&unit)?;
                self.keep(self.places[&point.at] * d + q, d, &du);
            }
        }
        linear.attempt.statistics.columns += points.len() * d;
        Ok(())
    }

    /// Keeps a column, of which these are the displacements, and the row that is like it where nothing makes one.
    fn keep(&mut self, j: usize, d: usize, du: &[f64]) {
        for (k, known) in self.known.iter().enumerate() {
            for p in 0..d {
                let value = known.gradients.along(p, du);
                self.values[j][k * d + p] = value;
                if known.made < self.pass {
                    self.values[k * d + p][j] = value;
                }
            }
        }
    }

    /// The last forces of points, nothing where there were none.
    pub fn forces(&self, points: &[&Place], d: usize) -> Vec<f64> {
        let known = points.iter().map(|p| &self.known[self.places[&p.at]]);
        let forces = known.flat_map(|k| {
            let back = inverse(&k.turn).map_or_else(identity, |(back, _)| back);
            transpose_vec(&back, k.forces).into_iter().take(d)
        });
        forces.collect()
    }

    /// Takes the forces of points, and that others have none.
    pub fn found(&mut self, points: &[&Place], forces: &[f64]) {
        for known in &mut self.known {
            known.forces = [0.0; 3];
        }
        let d = forces.len() / points.len().max(1);
        for (point, own) in points.iter().zip(forces.chunks(d.max(1))) {
            let known = &mut self.known[self.places[&point.at]];
            let own = std::array::from_fn(|q| own.get(q).copied().unwrap_or(0.0));
            known.forces = transpose_vec(&known.turn, own);
        }
    }

    /// The friction problem of points around forces under which displacements are `du`.
    pub fn problem(&self, points: &[&Place], forces: &[f64], du: &[f64]) -> FrictionProblem {
        let size = forces.len();
        let d = size / points.len().max(1);
        let places: Vec<usize> = points.iter().map(|p| self.places[&p.at]).collect();
        let mut problem = FrictionProblem {
            dimension: d,
            operator: vec![0.0; size * size],
            free: vec![0.0; size],
            laws: points.iter().map(|p| p.law()).collect(),
        };
        for (j, &from) in places.iter().enumerate() {
            for (i, &to) in places.iter().enumerate() {
                let block = self.block(to, from, d);
                for (p, row) in block.iter().take(d).enumerate() {
                    let start = (i * d + p) * size + j * d;
                    problem.operator[start..start + d].copy_from_slice(&row[..d]);
                }
            }
            for q in 0..d {
                problem.operator[(j * d + q) * (size + 1)] += points[j].own(q);
            }
        }
        let known = problem.motion(forces);
        for (j, point) in points.iter().enumerate() {
            for q in 0..d {
                let k = j * d + q;
                problem.free[k] = point.free(q, du) + point.own(q) * forces[k] - known[k];
            }
        }
        problem
    }

    /// What forces at a point do to another, along the gradients of the pass at hand.
    fn block(&self, to: usize, from: usize, d: usize) -> Mat3 {
        let mut then = [[0.0; 3]; 3];
        for (q, column) in self.values[from * d..(from + 1) * d].iter().enumerate() {
            for (row, value) in then.iter_mut().zip(&column[to * d..(to + 1) * d]) {
                row[q] = *value;
            }
        }
        let (rows, columns) = (&self.known[to].turn, &self.known[from].turn);
        let half = then.map(|row| mat_vec(columns, row));
        std::array::from_fn(|p| {
            std::array::from_fn(|q| (0..3).map(|k| rows[p][k] * half[k][q]).sum::<f64>())
        })
    }
}
