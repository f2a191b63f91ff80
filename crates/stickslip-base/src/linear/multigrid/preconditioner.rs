use super::super::{BlockCsr, LinearError};
use super::aggregate::OUTSIDE;
use super::blocks::{Block, zero};
use super::hierarchy::Hierarchy;
use super::prolong::{Nodes, rigid_modes};
use super::settings::{MeshHints, MultigridSettings};

/// A symmetric V-cycle of smoothed aggregation for elastic bodies in contact, to precondition an iteration.
///
/// The matrix is `Tᵀ K T + D`: the stiffness in [`GapVariables`](super::GapVariables) and the contact stiffness `D`, one block on the
/// diagonal of each point with gap variables. All but these diagonals is made once, from `Tᵀ K T` alone, and serves
/// any `D`: whether points stick, slip or are open changes nothing else. See
/// [Vaněk et al. 1996](crate::references::vanek_1996). Everything is stored in single precision.
#[derive(Debug, Clone)]
pub struct Multigrid {
    levels: Levels,
    fixed: Vec<bool>,
    /// Whether a point has gap variables.
    gaps: Vec<bool>,
    /// A power of two that brings the stiffness near one.
    scale: f64,
}

#[derive(Debug, Clone)]
enum Levels {
    Plane(Hierarchy<2, 3>),
    Space(Hierarchy<3, 6>),
}

impl Multigrid {
    /// The hierarchy of a symmetric positive semidefinite matrix without its `fixed` dofs, and without contact; see
    /// [`update`](Multigrid::update).
    ///
    /// # Errors
    /// [`LinearError::NotFinite`]; [`LinearError::NotPositive`] if the diagonal of a free dof is not positive.
    ///
    /// # Panics
    /// If a length does not fit, or a gap point does not exist.
    pub fn new(
        matrix: &BlockCsr,
        fixed: &[bool],
        hints: MeshHints,
        settings: MultigridSettings,
    ) -> Result<Multigrid, LinearError> {
        let points = matrix.points();
        assert_eq!(fixed.len(), matrix.rows(), "one flag a dof");
        assert!(
            hints.coordinates.len() == points && hints.bodies.len() == points,
            "one hint a point"
        );
        let largest = check(matrix, fixed)?;
        // A power of two changes no bits.
        let scale = (-largest.log2().round()).exp2();
        let scale = if scale.is_finite() { scale } else { 1.0 };
        let levels = match matrix.block_size() {
            2 => Levels::Plane(hierarchy::<2, 3>(matrix, fixed, hints, settings, scale)),
            _ => Levels::Space(hierarchy::<3, 6>(matrix, fixed, hints, settings, scale)),
        };
        let mut gaps = vec![false; points];
        hints.gaps.iter().for_each(|&(point, _)| gaps[point] = true);
        Ok(Multigrid {
            levels,
            fixed: fixed.to_vec(),
            gaps,
            scale,
        })
    }

    /// Takes another matrix over the same points on the finest level, and drops the contact stiffness. The coarse
    /// levels stay: smooth displacements hardly notice that pairs moved by part of a facet or that the stiffness
    /// changed a little. Costs a quarter to a third of a new hierarchy.
    ///
    /// # Errors
    /// As for [`new`](Multigrid::new); then nothing has changed.
    ///
    /// # Panics
    /// If the matrix has other points.
    pub fn refresh(&mut self, matrix: &BlockCsr) -> Result<(), LinearError> {
        assert_eq!(matrix.rows(), self.fixed.len(), "not the same mesh");
        check(matrix, &self.fixed)?;
        match &mut self.levels {
            Levels::Plane(levels) => levels.refresh(matrix, &self.fixed, &self.gaps),
            Levels::Space(levels) => levels.refresh(matrix, &self.fixed, &self.gaps),
        }
        Ok(())
    }

    /// Puts contact stiffnesses `[N/m]` on the gap variables of points: symmetric positive semidefinite blocks row by
    /// row, of which 2D reads the first four entries. Points not named get none. Costs little.
    ///
    /// # Panics
    /// If a point has no gap variables or is named twice.
    pub fn update(&mut self, added: &[(usize, [f64; 9])]) {
        let mut sorted: Vec<(usize, [f64; 9])> = added.to_vec();
        sorted.sort_by_key(|(point, _)| *point);
        for pair in sorted.windows(2) {
            assert!(pair[0].0 < pair[1].0, "point {} twice", pair[0].0);
        }
        for (point, _) in &sorted {
            assert!(self.gaps[*point], "point {point} has no gap variables");
        }
        match &mut self.levels {
            Levels::Plane(levels) => levels.update(&blocks_of(&sorted)),
            Levels::Space(levels) => levels.update(&blocks_of(&sorted)),
        }
    }

    /// One V-cycle: `v` becomes an approximation of `(Tᵀ K T + D)⁻¹ v`, in gap variables; fixed dofs become zero.
    ///
    /// # Panics
    /// If `v` has not one entry a dof.
    pub fn cycle(&self, v: &mut [f64]) {
        match &self.levels {
            Levels::Plane(levels) => self.cycle_of(levels, v),
            Levels::Space(levels) => self.cycle_of(levels, v),
        }
    }

    fn cycle_of<const B: usize, const M: usize>(&self, levels: &Hierarchy<B, M>, v: &mut [f64]) {
        assert_eq!(v.len(), self.fixed.len(), "length of a vector");
        let largest = v.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        if largest == 0.0 {
            return;
        }
        let r = v
            .as_chunks::<B>()
            .0
            .iter()
            .map(|v| [v.map(|v| (v / largest) as f32)]);
        let x = levels.cycle(r.collect());
        let factor = largest * self.scale;
        for (v, x) in v.iter_mut().zip(x.as_flattened().as_flattened()) {
            *v = factor * f64::from(*x);
        }
    }

    /// Whether a motion of everything meets no resistance that the coarsest level could see: something is free to move.
    pub fn singular(&self) -> bool {
        match &self.levels {
            Levels::Plane(levels) => levels.singular(),
            Levels::Space(levels) => levels.singular(),
        }
    }

    /// Bytes stored.
    pub fn bytes(&self) -> usize {
        let levels = match &self.levels {
            Levels::Plane(levels) => levels.bytes(),
            Levels::Space(levels) => levels.bytes(),
        };
        levels + self.gaps.len() + self.fixed.len()
    }

    /// Nodes of each level, finest first.
    pub fn levels(&self) -> Vec<usize> {
        match &self.levels {
            Levels::Plane(levels) => levels.sizes(),
            Levels::Space(levels) => levels.sizes(),
        }
    }

    /// Scalars in the matrices of all levels over those of the finest \[1\].
    pub fn operator_complexity(&self) -> f64 {
        match &self.levels {
            Levels::Plane(levels) => levels.complexity(),
            Levels::Space(levels) => levels.complexity(),
        }
    }
}

/// The largest entry on the diagonal over the free dofs of a matrix that can be used.
fn check(matrix: &BlockCsr, fixed: &[bool]) -> Result<f64, LinearError> {
    if let Some(dof) = matrix.first_not_finite() {
        return Err(LinearError::NotFinite { dof });
    }
    let mut largest: f64 = 0.0;
    for (dof, (value, &fixed)) in matrix.diagonal().into_iter().zip(fixed).enumerate() {
        if !fixed && value <= 0.0 {
            return Err(LinearError::NotPositive { dof });
        }
        if !fixed {
            largest = largest.max(value);
        }
    }
    Ok(largest)
}

fn blocks_of<const B: usize>(added: &[(usize, [f64; 9])]) -> Vec<(u32, Block<f64, B, B>)> {
    let blocks = added.iter().map(|(point, values)| {
        let block = std::array::from_fn(|r| std::array::from_fn(|c| values[r * B + c]));
        (*point as u32, block)
    });
    blocks.collect()
}

fn hierarchy<const B: usize, const M: usize>(
    matrix: &BlockCsr,
    fixed: &[bool],
    hints: MeshHints,
    settings: MultigridSettings,
    scale: f64,
) -> Hierarchy<B, M> {
    let mut normals = vec![None; matrix.points()];
    for &(point, normal) in hints.gaps {
        normals[point] = Some(normal);
    }
    let modes = (0..matrix.points()).map(|point| {
        let mut modes: Block<f64, B, M> = rigid_modes(hints.coordinates[point]);
        for (c, row) in modes.iter_mut().enumerate() {
            if fixed[point * B + c] {
                *row = zero::<1, M>()[0];
            }
        }
        modes
    });
    // Three groups a body: its points, its gaps along the normals and its gaps across.
    let groups = (0..matrix.points()).map(|point| {
        if fixed[point * B..(point + 1) * B].iter().all(|&f| f) {
            OUTSIDE
        } else {
            3 * hints.bodies[point] + u32::from(normals[point].is_some())
        }
    });
    let nodes = Nodes {
        modes: modes.collect(),
        places: hints.coordinates.to_vec(),
        groups: groups.collect(),
        gaps: normals.iter().map(Option::is_some).collect(),
    };
    Hierarchy::new(matrix, fixed, &nodes, &normals, settings, scale)
}
