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
                    if h.pressure > 0.0 {
                        h.gap + h.pressure / p.stiffness
                    } else {
                        0.0
                    }
                })
                .collect();
        }
        self.history.energy.stored = self.stored_energy();
        self.history.energy.stored - before
    }

    /// An upper bound of the squared frequency `[1/s²]` that the springs of the interface have with these inverse masses by dof: by the
    /// rows of its stiffness (Gershgorin). Springs that are not in contact count as well where they have a stiffness of their own. For
    /// a rigid body the springs at all its points add up, each with what the body gives way there, `1/m + |arm|²/I` as inverse mass.
    pub fn highest_frequency(&self, inverse_mass: &[f64], links: &Links) -> f64 {
        let mut rows: Vec<f64> = vec![0.0; self.nodes.len()];
        let sides = if self.rigid() { 1.0 } else { 2.0 };
        let enforcement = self.laws.enforcement.as_dyn();
        let law = self.laws.normal_law();
        for (i, point) in self.points.iter().enumerate() {
            let last = self.cache.last.points.get(i);
            let own = if self.laws.needs_normal_stiffness() {
                self.spring(enforcement.normal(), point.stiffness)
            } else {
                0.0
            };
            let now = last.map_or(0.0, |e| e.slope());
            // A rigid body has no cells whose frequency would bound the step on the way to a compliant surface.
            let rigid = |&node: &usize| links.of_point(self.nodes[node]).is_some();
            let ahead = match point.nodes.iter().any(rigid) {
                true => -law.pressure(-TOUCHED * point.size).map_or(0.0, |p| p.slope),
                false => 0.0,
            };
            // Of a mortar less than the whole of a point may have something opposite.
            let stiffness = sides * point.area * own.max(now).max(ahead);
            if stiffness == 0.0 {
                continue;
            }
            for (node, w) in self.weights_of(i) {
                rows[node] += stiffness * w.abs();
            }
        }
        let mut highest = 0.0_f64;
        let mut rigid = vec![0.0; links.all().len()];
        for (k, &node) in rows.iter().zip(&self.nodes) {
            let squared = k * inverse_mass[self.dofs.of(node, 0)];
            match links.of_point(node) {
                None => highest = highest.max(squared),
                Some(body) => rigid[body] += squared,
            }
        }
        rigid.into_iter().fold(highest, f64::max)
    }
}
