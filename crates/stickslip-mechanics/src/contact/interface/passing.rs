//! Bodies that go through each other within an increment.
//!
//! Where nothing but contact holds an axle, an iteration in which contact lets go may turn it by any angle, and what is found there may be an equilibrium as good as any: gears fit again
//! some teeth on. But the way there leads through the teeth: between the two ends of the increment the bodies overlap, by more than at either of them.
//!
//! Steps of the iteration are held back for that: by a stiffness against turning of such axles that falls with the moment out of balance, so that where contact has let go a moment turns
//! an axle by a facet and not by any angle, and near the equilibrium nothing is held. That is the method of Levenberg and Marquardt, and it keeps Newton's order
//! ([Fan and Yuan](stickslip_base::references::fan_yuan_2005)).

use super::definition::{Interface, Primary};
use crate::math::distance;
use crate::system::{Assembler, Tangent};

/// Facets that surfaces go before their way is looked at: where they go less, a tooth cannot be missed.
const FAR: f64 = 10.0;

/// Parts of the way at which it is: by no whole number of teeth from one to the next, whatever the number of teeth that it is long.
const PARTS: [f64; 4] = [0.236, 0.382, 0.618, 0.854];

/// Overlap on the way that is none, in lengths of facets: what is straight in one frame is not in another.
const NONE: f64 = 1.0;

impl Interface {
    /// By how much more than at either end its sides overlap on the straight way between two displacements by dof and times `[m]`; `None` where they do not, and where they go too
    /// short a way to miss anything.
    pub fn passes_through(
        &self,
        [from, to]: [&[f64]; 2],
        [before, after]: [f64; 2],
    ) -> Option<f64> {
        let there = !self.laws.tied && self.schedule.active(after) && !self.skin.is_empty();
        if !there || !self.turns {
            return None;
        }
        let ends = [self.coordinates(from), self.coordinates(to)];
        let size = self.facet_size();
        let ways = ends[0].iter().zip(&ends[1]).map(|(&a, &b)| distance(a, b));
        let turned = match &self.primary {
            Primary::Facets(_) => 0.0,
            Primary::Rigid(_, motion) => {
                let poses = [motion.pose(before), motion.pose(after)];
                let moved = ends[1].iter().map(|&x| {
                    let carried = poses[1].outward(poses[0].inward(x));
                    distance(x, carried)
                });
                moved.fold(0.0, f64::max)
            }
        };
        if ways.fold(turned, f64::max) <= FAR * size {
            return None;
        }
        let least = |x: &[_], t: f64| self.lowest(x, t).into_iter().fold(0.0, f64::min);
        let at_ends = least(&ends[0], before).min(least(&ends[1], after));
        let deepest = PARTS.into_iter().fold(at_ends, |deepest: f64, part| {
            let mean = |a: f64, b: f64| a + part * (b - a);
            let u: Vec<f64> = from.iter().zip(to).map(|(&a, &b)| mean(a, b)).collect();
            deepest.min(least(&self.coordinates(&u), mean(before, after)))
        });
        let deeper = at_ends - deepest;
        (deeper > NONE * size).then_some(deeper)
    }

    /// The mean length of facets `[m]`.
    fn facet_size(&self) -> f64 {
        let lengths = self.skin.iter().map(|s| {
            let [a, b] = [0, 1].map(|k| self.reference[s.facet.nodes[k]]);
            distance(a, b)
        });
        lengths.sum::<f64>() / self.skin.len() as f64
    }

    /// Adds to the tangent what holds axles back that forces `b` by dof, out of balance, would turn.
    pub(super) fn hold_axles(&self, b: &[f64], out: &mut Assembler) {
        if !self.turns || self.skin.is_empty() {
            return;
        }
        let points = self
            .nodes
            .iter()
            .copied()
            .zip(self.reference.iter().copied());
        for (dofs, reach) in self.frames.turns_by(points, self.facet_size()) {
            let moment = b[dofs.clone()].iter().map(|m| m * m).sum::<f64>().sqrt();
            for dof in dofs.filter(|&dof| b[dof] != 0.0) {
                let held = moment / reach;
                let tangent = Tangent {
                    rows: &[1.0, 0.0, 0.0],
                    change: &[held, 0.0, 0.0],
                    area: 1.0,
                    hessian: &[],
                    surrogate: if out.wants_surrogate { &[held] } else { &[] },
                };
                out.add_tangent(&[dof], tangent);
            }
        }
    }
}
