use std::sync::Arc;

use super::condensation::{Condensation, Swept};
use super::substructure::{dot, norm};
use crate::linear::BlockCsr;

/// The shapes of loads and prescribed displacements met so far, swept through the factors once.
///
/// Whatever acts at a time is a sum of a few shapes with amplitudes. Nobody has to say which: what earlier shapes do not make up is a new one.
#[derive(Debug, Default)]
pub struct Shapes {
    loads: Vec<Shape>,
    motions: Vec<Shape>,
}

/// A unit vector over all dofs and what the factors make of the forces it brings.
#[derive(Debug)]
struct Shape {
    shape: Vec<f64>,
    root: Vec<f64>,
    interior: Vec<Vec<f64>>,
}

/// Loads and prescribed displacements as amplitudes of shapes.
#[derive(Debug, Clone, Default)]
pub struct Amplitudes {
    loads: Vec<f64>,
    motions: Vec<f64>,
    /// Shapes that are not kept, as there are too many.
    others: Vec<Arc<Shape>>,
}

/// Most shapes of loads, and of motions, that are kept: a load that turns needs two or three.
const MOST: usize = 24;

/// What is left of a vector, relative to it, when it counts as made up of the shapes: rounding.
const ROUNDING: f64 = 4e-15;

impl Shapes {
    /// Finds the amplitudes of external forces and prescribed displacements, both over all dofs.
    pub fn resolve(
        &mut self,
        condensation: &Condensation,
        matrix: &BlockCsr,
        external: &[f64],
        prescribed: &[f64],
    ) -> Amplitudes {
        let mut others = Vec::new();
        let loads = resolve(&mut self.loads, &mut others, external, &mut |shape| {
            condensation.sweep(shape)
        });
        let motions = resolve(&mut self.motions, &mut others, prescribed, &mut |shape| {
            let mut forces = vec![0.0; shape.len()];
            matrix.mul(shape, &mut forces);
            forces.iter_mut().for_each(|f| *f = -*f);
            condensation.sweep(&forces)
        });
        Amplitudes {
            loads,
            motions,
            others,
        }
    }

    /// The forces at the candidates.
    pub fn load(&self, amplitudes: &Amplitudes, candidates: usize) -> Vec<f64> {
        let mut load = vec![0.0; candidates];
        for (a, shape) in self.all(amplitudes) {
            for (l, r) in load.iter_mut().zip(&shape.root) {
                *l += a * r;
            }
        }
        load
    }

    /// The swept forces in the interiors, part by part.
    pub fn interior(&self, amplitudes: &Amplitudes, condensation: &Condensation) -> Vec<Vec<f64>> {
        let mut out: Vec<Vec<f64>> = condensation
            .parts
            .iter()
            .map(|part| vec![0.0; part.partial.fronts().interior().len()])
            .collect();
        for (a, shape) in self.all(amplitudes) {
            for (out, interior) in out.iter_mut().zip(&shape.interior) {
                for (o, i) in out.iter_mut().zip(interior) {
                    *o += a * i;
                }
            }
        }
        out
    }

    fn all<'a>(&'a self, amplitudes: &'a Amplitudes) -> impl Iterator<Item = (f64, &'a Shape)> {
        let loads = amplitudes.loads.iter().copied().zip(&self.loads);
        let motions = amplitudes.motions.iter().copied().zip(&self.motions);
        let others = amplitudes.others.iter().map(|shape| (1.0, &**shape));
        loads
            .chain(motions)
            .chain(others)
            .filter(|(a, _)| *a != 0.0)
    }
}

fn resolve(
    shapes: &mut Vec<Shape>,
    others: &mut Vec<Arc<Shape>>,
    vector: &[f64],
    sweep: &mut dyn FnMut(&[f64]) -> Swept,
) -> Vec<f64> {
    let size = norm(vector);
    let mut amplitudes = vec![0.0; shapes.len()];
    if size == 0.0 || !size.is_finite() {
        return amplitudes;
    }
    let mut left = vector.to_vec();
    // the second pass takes what rounding left in the first
    for _ in 0..2 {
        for (a, shape) in amplitudes.iter_mut().zip(shapes.iter()) {
            let part = dot(&shape.shape, &left);
            *a += part;
            for (l, s) in left.iter_mut().zip(&shape.shape) {
                *l -= part * s;
            }
        }
    }
    let rest = norm(&left);
    if rest > ROUNDING * size {
        let keep = shapes.len() < MOST;
        let unit = if keep { rest } else { 1.0 };
        left.iter_mut().for_each(|l| *l /= unit);
        let (root, interior) = sweep(&left);
        let shape = Shape {
            shape: left,
            root,
            interior,
        };
        if keep {
            shapes.push(shape);
            amplitudes.push(rest);
        } else {
            others.push(Arc::new(shape));
        }
    }
    amplitudes
}
