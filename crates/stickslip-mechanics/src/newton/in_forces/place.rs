//! A point of contact among those of an increment, and the two things it can be: an unknown of the friction problem, or part of what surrounds it.

use crate::friction::PointLaw;
use crate::friction::map::project;
use crate::math::norm;
use crate::system::{Assembler, ContactBlock, StickTrial, Tangent};

/// Force, and point of that force.
pub(super) type At = (usize, usize);

/// A point, and what it carries.
pub(super) type Found = (At, [f64; 3]);

/// A point of one of the forces.
pub(super) struct Place {
    pub at: At,
    pub alone: StickTrial,
    /// Gradients by the dofs of the bulk.
    pub block: ContactBlock,
}

impl Place {
    /// One of its gradients times displacements.
    pub fn along(&self, q: usize, du: &[f64]) -> f64 {
        let n = self.block.dofs.len();
        let row = &self.block.rows[q * n..(q + 1) * n];
        row.iter()
            .zip(&self.block.dofs)
            .map(|(b, &dof)| b * du[dof])
            .sum()
    }

    /// Adds a force along one of its gradients.
    pub fn push(&self, q: usize, force: f64, out: &mut [f64]) {
        let n = self.block.dofs.len();
        let row = &self.block.rows[q * n..(q + 1) * n];
        for (b, &dof) in row.iter().zip(&self.block.dofs) {
            out[dof] += force * b;
        }
    }

    /// Compliance of the point itself; where shear has none, that of the body, which does no harm where no shear is carried.
    pub fn own(&self, q: usize) -> f64 {
        match self.alone.stiffness[q] {
            k if k > 0.0 => 1.0 / k,
            _ => 1.0 / self.alone.body,
        }
    }

    /// Gap or slip that counts, under displacements and without forces.
    pub fn free(&self, q: usize, du: &[f64]) -> f64 {
        self.along(q, du) - self.own(q) * self.alone.forces[q]
    }

    /// Whether it would be pressed if it alone carried nothing.
    pub fn approaches(&self, alone: &[f64]) -> bool {
        self.free(0, alone) < 0.0 || self.alone.forces[0] > 0.0
    }

    /// The limit of its shear; none where nothing sticks.
    pub fn law(&self) -> PointLaw {
        let sticks = self.alone.stiffness[1] > 0.0;
        if sticks {
            self.alone.law
        } else {
            PointLaw::default()
        }
    }

    /// What the laws make of forces that it would carry if it was pressed and stuck, and how these change with those, `d forces[p] / d trial[q]`.
    fn lawful(&self, trial: [f64; 3]) -> ([f64; 3], [[f64; 3]; 3]) {
        let mut slope = [[0.0; 3]; 3];
        if trial[0] <= 0.0 {
            return ([0.0; 3], slope);
        }
        if self.law().ellipse.is_some() {
            let lawful = project(3, &self.law(), &trial);
            let slope = [0, 1, 2].map(|p| [0, 1, 2].map(|q| lawful.derivative[3 * p + q]));
            return (lawful.forces, slope);
        }
        slope[0][0] = 1.0;
        let (limit, mu) = self.law().limit(trial[0]);
        let shear = norm([0.0, trial[1], trial[2]]);
        if shear <= limit {
            slope[1][1] = 1.0;
            slope[2][2] = 1.0;
            return (trial, slope);
        }
        let mut forces = [trial[0], 0.0, 0.0];
        for q in 1..3 {
            let along = trial[q] / shear;
            forces[q] = limit * along;
            slope[q][0] = mu * along;
        }
        (forces, slope)
    }

    /// The forces that it carries after displacements, if it is no unknown.
    pub fn carried(&self, du: &[f64]) -> [f64; 3] {
        let trial =
            [0, 1, 2].map(|q| self.alone.forces[q] - self.alone.stiffness[q] * self.along(q, du));
        self.lawful(trial).0
    }

    /// Adds what it does where it is no unknown: its forces, and their tangent at the state of evaluation.
    pub fn surround(&self, held: &mut Assembler) {
        let block = &self.block;
        let n = block.dofs.len();
        let (forces, slope) = self.lawful(self.alone.forces);
        for (q, force) in forces.into_iter().enumerate() {
            self.push(q, -force, &mut held.residual);
        }
        let mut change = vec![0.0; 3 * n];
        for (q, slope) in slope.iter().enumerate() {
            for (p, slope) in slope.iter().enumerate() {
                for k in 0..n {
                    change[q * n + k] += slope * self.alone.stiffness[p] * block.rows[p * n + k];
                }
            }
        }
        let along = [0, 1, 2].map(|q| slope[q][q] * self.alone.stiffness[q]);
        add(held, block, &change, along);
    }

    /// Holds it softly where it is.
    pub fn hold(&self, stiffness: f64, held: &mut Assembler) {
        let change: Vec<f64> = self.block.rows.iter().map(|row| stiffness * row).collect();
        add(held, &self.block, &change, [stiffness; 3]);
    }
}

/// Adds a tangent with gradients of a block; `along` is by how much forces fall along their own gradients, for the factor.
fn add(held: &mut Assembler, block: &ContactBlock, change: &[f64], along: [f64; 3]) {
    let n = block.dofs.len();
    let mut surrogate = vec![0.0; if held.wants_surrogate { n * n } else { 0 }];
    for (k, out) in surrogate.chunks_exact_mut(n).enumerate() {
        for (q, along) in along.into_iter().enumerate() {
            let row = &block.rows[q * n..(q + 1) * n];
            for (out, r) in out.iter_mut().zip(row) {
                *out += along * row[k] * r;
            }
        }
    }
    held.add_tangent(
        &block.dofs,
        Tangent {
            rows: &block.rows,
            change,
            area: 1.0,
            hessian: &[],
            surrogate: &surrogate,
        },
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(forces: [f64; 3]) -> Place {
        let rows = vec![1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        let alone = StickTrial {
            dofs: vec![0, 1, 2],
            rows: rows.clone(),
            area: 1.0,
            body: 1.0,
            stiffness: [2.0, 3.0, 3.0],
            forces,
            rubs: true,
            law: PointLaw {
                mu: 0.4,
                adhesion: 0.1,
                ..PointLaw::default()
            },
        };
        let block = ContactBlock {
            dofs: vec![0, 1, 2],
            change: rows.clone(),
            rows,
            ..ContactBlock::default()
        };
        let at = (0, 0);
        Place { at, alone, block }
    }

    #[test]
    fn a_point_that_is_no_unknown_obeys_its_law_and_its_tangent_is_that_of_its_forces() {
        for (trial, carried) in [
            ([-1.0, 0.3, 0.0], [0.0, 0.0, 0.0]),
            ([1.0, 0.3, 0.0], [1.0, 0.3, 0.0]),
            ([1.0, -2.0, 0.0], [1.0, -0.5, 0.0]),
        ] {
            let place = place(trial);
            let mut held = Assembler::new(3);
            held.reset(true);
            place.surround(&mut held);
            assert_eq!(held.residual, carried.map(|f: f64| -f));
            for v in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.7, -0.2, 0.0]] {
                let h = 1e-6;
                let [after, before] = [h, -h].map(|h| place.carried(&v.map(|v| h * v)));
                let mut change = [0.0; 3];
                held.blocks[0].apply(&v, &mut change);
                for q in 0..3 {
                    let forces = (after[q] - before[q]) / (2.0 * h);
                    assert!((change[q] + forces).abs() < 1e-8, "{trial:?} {v:?} {q}");
                }
            }
        }
    }
}
