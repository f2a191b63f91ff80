use std::sync::Arc;

use super::condensation::{Condensation, Swept};
use crate::linear::{LinearError, Matrix};
use crate::math::vector::{dot, norm};

/// The patterns of loads and prescribed displacements met so far, swept through the factors once.
///
/// Whatever acts at a time is a sum of a few patterns with amplitudes. They need not be named: what earlier patterns do not make up is a new one.
#[derive(Debug, Default)]
pub struct LoadPatterns {
    loads: Vec<Pattern>,
    motions: Vec<Pattern>,
}

/// A unit vector over all dofs and what the factors make of the forces it brings.
#[derive(Debug, crate::keep::Keep)]
struct Pattern {
    unit: Arc<Vec<f64>>,
    root: Vec<f64>,
    interior: Vec<Vec<f64>>,
}

/// Loads and prescribed displacements as amplitudes of patterns.
#[derive(Debug, Clone, Default, crate::keep::Keep)]
pub struct Amplitudes {
    loads: Vec<f64>,
    motions: Vec<f64>,
    /// LoadPatterns that are not kept, as there are too many.
    others: Vec<Arc<Pattern>>,
}

/// Most patterns of loads, and of motions, that are kept: a load that turns needs two or three.
const MOST_PATTERNS: usize = 24;

/// The patterns met so far, without what the factors make of them.
#[derive(Debug, Clone, Default, crate::keep::Keep)]
pub struct PatternsRecipe {
    loads: Vec<Arc<Vec<f64>>>,
    motions: Vec<Arc<Vec<f64>>>,
}

impl LoadPatterns {
    /// The patterns met so far.
    pub fn recipe(&self) -> PatternsRecipe {
        let units = |all: &[Pattern]| all.iter().map(|p| Arc::clone(&p.unit)).collect();
        PatternsRecipe {
            loads: units(&self.loads),
            motions: units(&self.motions),
        }
    }

    /// Sweeps them through the factors again, each by itself as at first: that leaves the same bits.
    ///
    /// # Errors
    /// Those of [`Condensation::sweep`].
    pub fn again(
        recipe: PatternsRecipe,
        condensation: &Condensation,
        matrix: &dyn Matrix,
    ) -> Result<Self, LinearError> {
        let pattern = |(unit, (root, interior)): (Arc<Vec<f64>>, Swept)| Pattern {
            unit,
            root,
            interior,
        };
        let loads = recipe.loads.into_iter();
        let motions = recipe.motions.into_iter();
        let loads = loads.map(|unit| {
            let swept = condensation.sweep_pattern(&unit)?;
            Ok(pattern((unit, swept)))
        });
        let motions = motions.map(|unit| {
            let swept = condensation.sweep_pattern(&resisted(matrix, &unit))?;
            Ok(pattern((unit, swept)))
        });
        Ok(LoadPatterns {
            loads: loads.collect::<Result<_, LinearError>>()?,
            motions: motions.collect::<Result<_, LinearError>>()?,
        })
    }

    /// Finds the amplitudes of external forces and prescribed displacements, both over all dofs.
    ///
    /// # Errors
    /// Those of [`Condensation::sweep`].
    pub fn resolve(
        &mut self,
        condensation: &Condensation,
        matrix: &dyn Matrix,
        external: &[f64],
        prescribed: &[f64],
    ) -> Result<Amplitudes, LinearError> {
        let mut others = Vec::new();
        let loads = resolve(&mut self.loads, &mut others, external, &mut |pattern| {
            condensation.sweep_pattern(pattern)
        })?;
        let motions = resolve(&mut self.motions, &mut others, prescribed, &mut |pattern| {
            condensation.sweep_pattern(&resisted(matrix, pattern))
        })?;
        Ok(Amplitudes {
            loads,
            motions,
            others,
        })
    }

    /// The forces at the candidates.
    pub fn load(&self, amplitudes: &Amplitudes, candidates: usize) -> Vec<f64> {
        let mut load = vec![0.0; candidates];
        for (a, pattern) in self.all(amplitudes) {
            for (l, r) in load.iter_mut().zip(&pattern.root) {
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
            .map(|part| vec![0.0; part.interior.ordered().interior().len()])
            .collect();
        for (a, pattern) in self.all(amplitudes) {
            for (out, interior) in out.iter_mut().zip(&pattern.interior) {
                for (o, i) in out.iter_mut().zip(interior) {
                    *o += a * i;
                }
            }
        }
        out
    }

    fn all<'a>(&'a self, amplitudes: &'a Amplitudes) -> impl Iterator<Item = (f64, &'a Pattern)> {
        let loads = amplitudes.loads.iter().copied().zip(&self.loads);
        let motions = amplitudes.motions.iter().copied().zip(&self.motions);
        let others = amplitudes.others.iter().map(|pattern| (1.0, &**pattern));
        loads
            .chain(motions)
            .chain(others)
            .filter(|(a, _)| *a != 0.0)
    }
}

/// The forces that prescribed displacements bring to the free dofs.
fn resisted(matrix: &dyn Matrix, motion: &[f64]) -> Vec<f64> {
    let mut forces = matrix.times(motion);
    forces.iter_mut().for_each(|f| *f = -*f);
    forces
}

fn resolve(
    patterns: &mut Vec<Pattern>,
    others: &mut Vec<Arc<Pattern>>,
    vector: &[f64],
    sweep: &mut dyn FnMut(&[f64]) -> Result<Swept, LinearError>,
) -> Result<Vec<f64>, LinearError> {
    let size = norm(vector);
    let mut amplitudes = vec![0.0; patterns.len()];
    if size == 0.0 || !size.is_finite() {
        return Ok(amplitudes);
    }
    let mut left = vector.to_vec();
    // the second pass takes what rounding left in the first
    for _ in 0..2 {
        for (a, pattern) in amplitudes.iter_mut().zip(patterns.iter()) {
            let part = dot(&pattern.unit, &left);
            *a += part;
            for (l, s) in left.iter_mut().zip(pattern.unit.iter()) {
                *l -= part * s;
            }
        }
    }
    let rest = norm(&left);
    // Less is left of a vector, relative to it, where it is made up of the patterns: rounding.
    if rest > 4e-15 * size {
        let keep = patterns.len() < MOST_PATTERNS;
        let size = if keep { rest } else { 1.0 };
        left.iter_mut().for_each(|l| *l /= size);
        let (root, interior) = sweep(&left)?;
        let pattern = Pattern {
            unit: Arc::new(left),
            root,
            interior,
        };
        if keep {
            patterns.push(pattern);
            amplitudes.push(rest);
        } else {
            others.push(Arc::new(pattern));
        }
    }
    Ok(amplitudes)
}
