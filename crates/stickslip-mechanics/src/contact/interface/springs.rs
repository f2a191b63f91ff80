//! Explicit dynamics: springs in place of multipliers, and how stiff they are; ties that hold exactly.

use super::energies::stored_energy;
use super::parts::Interface;
use crate::contact::enforcement::Multipliers;
use crate::system::Assembler;

impl Interface {
    /// Lets these tractions `[Pa]`, by point and along the directions of its rows, be those of the last evaluation, and adds their forces to a residual.
    pub fn pull_ties(&mut self, tractions: &[(usize, [f64; 3])], out: Option<&mut Assembler>) {
        for &(i, traction) in tractions {
            self.cache.last.pull(i, traction);
        }
        let Some(out) = out else {
            return;
        };
        let mut spatial = Assembler::new(out.residual.len());
        for &(i, _) in tractions {
            let (batch, e) = (self.cache.last.batch(i), &self.cache.last.points[i]);
            spatial.add_residual(batch.dofs(e), batch.force(e).unwrap_or_default());
        }
        self.cache.in_space.assemble(&mut spatial, out);
    }

    /// Enforces contact and stick by springs in explicit dynamics, whatever the enforcement: those of a penalty, or as stiff as the cells
    /// beneath.
    ///
    /// What presses already goes on pressing: a spring starts where its force is that of the multiplier it replaces. The energy `[J]` that this
    /// puts into the springs is returned.
    pub fn use_springs(&mut self, springs: bool) -> f64 {
        // Every step says anew how it is integrated.
        self.directives.impulses = false;
        if self.history.springs == springs {
            return 0.0;
        }
        let before = stored_energy(self.view());
        self.history.springs = springs;
        self.history.rest.clear();
        let multipliers = self.laws.enforcement.as_dyn().multipliers() != Multipliers::None;
        if springs && multipliers && self.laws.needs_normal_stiffness() {
            let exact = self.view().holds_exactly();
            let points = self.points.iter().zip(&self.history.points);
            self.history.rest = points
                .map(|(p, h)| {
                    if exact && h.gap.is_finite() {
                        h.gap
                    } else if h.pressure > 0.0 || self.laws.tied && h.gap.is_finite() {
                        h.gap + h.pressure / p.stiffness
                    } else {
                        0.0
                    }
                })
                .collect();
        }
        // Springs of stick come or go with the shear that there is; what holds exactly has none.
        let points = self.history.points.iter().zip(&self.points);
        let sheared: Vec<f64> = points
            .map(|(h, p)| self.sheared(h.shear, self.tangential_stiffness(p.stiffness)))
            .collect();
        let points = self.history.points.iter_mut().zip(sheared);
        points.for_each(|(h, sheared)| h.sheared = sheared);
        self.history.energy.stored = stored_energy(self.view());
        self.history.energy.stored - before
    }
}
