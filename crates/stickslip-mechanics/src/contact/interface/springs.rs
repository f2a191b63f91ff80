//! Explicit dynamics: springs in place of multipliers, and how stiff they are.

use super::definition::Interface;
use crate::contact::enforcement::Multipliers;
use crate::system::Links;

/// Penetration of a point about to touch, relative to the cell beneath.
const TOUCHED: f64 = 1e-6;

impl Interface {
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
        let before = self.stored_energy();
        self.history.springs = springs;
        self.history.rest.clear();
        let multipliers = self.laws.enforcement.as_dyn().multipliers() != Multipliers::None;
        if springs && multipliers && self.laws.needs_normal_stiffness() {
            let points = self.points.iter().zip(&self.history.points);
            self.history.rest = points
                .map(|(p, h)| {
                    if h.pressure > 0.0 || self.laws.tied && h.gap.is_finite() {
                        h.gap + h.pressure / p.stiffness
                    } else {
                        0.0
                    }
                })
                .collect();
        }
        let points = self.points.iter().zip(&self.history.points);
        let sheared = points.map(|(p, h)| self.sheared(self.sticking(p.stiffness), h.shear));
        let sheared: Vec<f64> = sheared.collect();
        for (h, sheared) in self.history.points.iter_mut().zip(sheared) {
            h.sheared = sheared;
        }
        self.history.energy.stored = self.stored_energy();
        self.history.energy.stored - before
    }

    /// An upper bound of the squared frequency `[1/s²]` that the springs of the interface have with these inverse masses by dof: by the
    /// rows of its stiffness (Gershgorin). Springs that are not in contact count as well where they have a stiffness of their own. For
    /// a rigid body the springs at all its points add up, each with what the body gives way there, `1/m + |arm|²/I` as inverse mass.
    pub fn highest_frequency(&self, inverse_mass: &[f64], links: &Links) -> f64 {
        let inverse = |node: usize| inverse_mass[self.dofs.of(node, 0)];
        self.highest_eigenvalue(&|i| self.stiffest(i, links), &inverse, links)
    }

    /// The same of compliant laws and springs alone, as they were pressed in the last evaluation, with inverse masses by point of the mesh: what is
    /// held by multipliers has no frequency.
    pub fn pressed_frequency(&self, inverse_mass: &[f64], links: &Links) -> f64 {
        if self.unknown() && self.laws.needs_normal_stiffness() {
            return 0.0;
        }
        let last = &self.cache.last.points;
        let pressed = |i: usize| {
            last.get(i)
                .map_or(0.0, |e| e.response.d_gap[0][0] - e.response.d_rate[0])
        };
        self.highest_eigenvalue(&|i| pressed(i).abs(), &|node| inverse_mass[node], links)
    }

    /// An upper bound of the rate `[1/s]` at which what laws add with the velocity takes it away, in the same way.
    pub fn highest_rate(&self, inverse_mass: &[f64], links: &Links) -> f64 {
        let last = &self.cache.last.points;
        let damping = self.laws.damping.as_dyn();
        let touched = |i: usize| {
            let depth = TOUCHED * self.points[i].size;
            let own = self.laws.normal_law().pressure(-depth);
            own.map_or(self.points[i].stiffness * depth, |p| p.value)
        };
        let viscosity = |i: usize| {
            let now = last.get(i).map_or(0.0, |e| e.viscosity);
            // No frequency bounds the step on the way to a dashpot.
            match damping.active() {
                true => now.max(damping.extra(touched(i), 0.0).d_rate),
                false => now,
            }
        };
        let inverse = |node: usize| inverse_mass[self.dofs.of(node, 0)];
        self.highest_eigenvalue(&viscosity, &inverse, links)
    }

    /// The spring of a point `[Pa/m]`: what there is, and what there will be when it touches.
    fn stiffest(&self, i: usize, links: &Links) -> f64 {
        let point = &self.points[i];
        let own = if self.laws.needs_normal_stiffness() {
            self.spring(self.laws.enforcement.as_dyn().normal(), point.stiffness)
        } else {
            0.0
        };
        let now = self.cache.last.points.get(i).map_or(0.0, |e| e.slope());
        // A rigid body has no cells whose frequency would bound the step on the way to a compliant surface.
        let rigid = |&node: &usize| links.of_point(self.nodes[node]).is_some();
        let touched = || self.laws.normal_law().pressure(-TOUCHED * point.size);
        let ahead = match point.nodes.iter().any(rigid) {
            true => -touched().map_or(0.0, |p| p.slope),
            false => 0.0,
        };
        own.max(now).max(ahead)
    }

    /// A bound of the largest eigenvalue of something per area at the points over the masses.
    fn highest_eigenvalue(
        &self,
        of: &dyn Fn(usize) -> f64,
        inverse_mass: &dyn Fn(usize) -> f64,
        links: &Links,
    ) -> f64 {
        let mut rows: Vec<f64> = vec![0.0; self.nodes.len()];
        let sides = if self.rigid() { 1.0 } else { 2.0 };
        for (i, point) in self.points.iter().enumerate() {
            // Of a mortar less than the whole of a point may have something opposite.
            let whole = sides * point.area * of(i);
            if whole == 0.0 {
                continue;
            }
            for (node, w) in self.weights_of(i) {
                rows[node] += whole * w.abs();
            }
        }
        let mut highest = 0.0_f64;
        let mut rigid = vec![0.0; links.all().len()];
        for (k, &node) in rows.iter().zip(&self.nodes) {
            let own = k * inverse_mass(node);
            match links.of_point(node) {
                None => highest = highest.max(own),
                Some(body) => rigid[body] += own,
            }
        }
        rigid.into_iter().fold(highest, f64::max)
    }
}
