//! All levels together.

use super::aggregate::aggregate;
use super::blocks::{Block, Blocks, Rows, galerkin};
use super::bottom::Bottom;
use super::jacobi::BlockJacobi;
use super::level::{Added, Level, Vector};
use super::prolong::{Nodes, Normals, smoothed, tentative};
use super::settings::MultigridSettings;

/// Levels at most; coarsening that stops to reduce ends before.
const MAX_LEVELS: usize = 12;

/// Levels with `B` dofs a node on the finest and `M` on the others.
#[derive(Debug, Clone)]
pub(super) struct Hierarchy<const B: usize, const M: usize> {
    fine: Level<B, M>,
    coarse: Vec<Level<M, M>>,
    bottom: Bottom,
    settings: MultigridSettings,
}

/// What coarsening makes of a level.
struct Coarsened<const B: usize, const M: usize> {
    level: Level<B, M>,
    matrix: Blocks<f64, M, M>,
    nodes: Nodes<M, M>,
}

fn coarsen<const B: usize, const M: usize>(
    a: &impl Rows<B>,
    fixed: &[bool],
    nodes: &Nodes<B, M>,
    normals: &Normals,
    settings: &MultigridSettings,
    strength: f64,
    scale: f64,
) -> Coarsened<B, M> {
    let (of, count) = aggregate(a, &nodes.groups, strength);
    let (first_guess, coarse_nodes) = tentative(nodes, normals, &of, count);
    let jacobi = BlockJacobi::new(a, fixed);
    let damping = settings.prolongation_damping / jacobi.spectral_radius;
    let coarse = coarse_nodes.modes.len();
    let prolong = smoothed(a, &jacobi.inverse, damping, nodes, &first_guess, coarse);
    let restrict = prolong.columns_of(coarse);
    let matrix = galerkin(a, &prolong, &restrict);
    Coarsened {
        level: Level::new(a, fixed, nodes, &jacobi, prolong, restrict, scale),
        matrix,
        nodes: coarse_nodes,
    }
}

impl<const B: usize, const M: usize> Hierarchy<B, M> {
    pub fn new(
        a: &impl Rows<B>,
        fixed: &[bool],
        nodes: &Nodes<B, M>,
        normals: &Normals,
        settings: MultigridSettings,
        scale: f64,
    ) -> Self {
        let first = coarsen(
            a,
            fixed,
            nodes,
            normals,
            &settings,
            settings.strength,
            scale,
        );
        let (mut matrix, mut nodes) = (first.matrix, first.nodes);
        let mut coarse: Vec<Level<M, M>> = Vec::new();
        while nodes.modes.len() * M > settings.coarsest_dofs && coarse.len() + 2 < MAX_LEVELS {
            let normals = vec![None; nodes.modes.len()];
            let next = coarsen(&matrix, &[], &nodes, &normals, &settings, 0.0, scale);
            let kept = next.nodes.modes.len() as f64 / nodes.modes.len() as f64;
            // Aggregates may unite bodies where a level keeps more than this part of the nodes of the one before.
            if kept > 0.5 {
                // Many small bodies. Gap variables stay among themselves.
                let united = |(&gap, &group): (&bool, &u32)| if gap { 1 + group % 3 } else { 0 };
                let groups: Vec<u32> = nodes.gaps.iter().zip(&nodes.groups).map(united).collect();
                if groups == nodes.groups {
                    break;
                }
                nodes.groups = groups;
                continue;
            }
            coarse.push(next.level);
            (matrix, nodes) = (next.matrix, next.nodes);
        }
        Hierarchy {
            fine: first.level,
            coarse,
            bottom: Bottom::new(&matrix, scale),
            settings,
        }
    }

    /// Takes another matrix on the finest level; the contact stiffnesses are to be given again.
    pub fn refresh(&mut self, a: &impl Rows<B>, fixed: &[bool], gaps: &[bool]) {
        self.fine.refresh(a, fixed, gaps);
        self.update(&[]);
    }

    /// Puts other contact stiffnesses, by ascending node, on the diagonals of all levels.
    pub fn update(&mut self, added: &[Added<B>]) {
        let mut added = self.fine.update(added);
        for level in &mut self.coarse {
            added = level.update(&added);
        }
        self.bottom.factor(&added);
    }

    /// The V-cycle: an approximate solution for a right-hand side.
    pub fn cycle(&self, mut r: Vector<B>) -> Vector<B> {
        self.down(&self.fine, &mut r, |coarse| self.coarse_cycle(0, coarse))
    }

    fn coarse_cycle(&self, index: usize, mut r: Vector<M>) -> Vector<M> {
        match self.coarse.get(index) {
            None => {
                self.bottom.solve(&mut r);
                r
            }
            Some(level) => self.down(level, &mut r, |next| self.coarse_cycle(index + 1, next)),
        }
    }

    /// Smooths, corrects by what `coarse` finds, and smooths again.
    fn down<const D: usize>(
        &self,
        level: &Level<D, M>,
        r: &mut [Block<f32, 1, D>],
        coarse: impl FnOnce(Vector<M>) -> Vector<M>,
    ) -> Vector<D> {
        let (steps, ratio) = (self.settings.smoother_steps, self.settings.smoother_ratio);
        let mut x = vec![[[0.0; D]]; r.len()];
        level.smooth(steps, ratio, r, &mut x, true);
        let correction = level.prolonged(&coarse(level.restricted(r)));
        level.subtract_product(&correction, r);
        for (x, d) in x
            .as_flattened_mut()
            .iter_mut()
            .zip(correction.as_flattened())
        {
            x.iter_mut().zip(d).for_each(|(x, d)| *x += d);
        }
        level.smooth(steps, ratio, r, &mut x, false);
        x
    }

    /// Whether the coarsest level has directions without stiffness.
    pub fn singular(&self) -> bool {
        self.bottom.singular
    }

    /// Nodes of every level.
    pub fn sizes(&self) -> Vec<usize> {
        let mut sizes = vec![self.fine.matrix.rows()];
        sizes.extend(self.coarse.iter().map(|level| level.matrix.rows()));
        sizes.push(match self.coarse.last() {
            Some(level) => level.restrict.starts.len() - 1,
            None => self.fine.restrict.starts.len() - 1,
        });
        sizes
    }

    /// Scalars in the matrices of all levels over those of the finest.
    pub fn complexity(&self) -> f64 {
        let fine = (self.fine.matrix.columns.len() * B * B) as f64;
        let coarse = self
            .coarse
            .iter()
            .map(|level| level.matrix.columns.len() * M * M);
        let bottom = self.sizes().last().map_or(0, |n| (n * M) * (n * M));
        1.0 + (coarse.sum::<usize>() + bottom) as f64 / fine
    }

    /// Bytes stored.
    pub fn bytes(&self) -> usize {
        let coarse: usize = self.coarse.iter().map(Level::bytes).sum();
        self.fine.bytes() + coarse + self.bottom.bytes()
    }
}
