//! Energies of an interface.

use super::definition::Interface;
use super::history::PointHistory;
use crate::system::Energy;

impl Interface {
    /// Recoverable energy of the interface: of the normal law, and of the springs of the enforcement where they yield, in both directions.
    pub(super) fn stored_energy(&self) -> f64 {
        self.stored_by_point().into_iter().sum()
    }

    /// The same by point `[J]`; empty where the interface does not act.
    pub fn stored_by_point(&self) -> Vec<f64> {
        if !self.history.acting {
            return Vec::new();
        }
        let own = self.law_energies(self.history.points.iter().map(|h| h.gap));
        (self.history.points.iter().enumerate())
            .map(|(i, h)| self.area_of(i) * (own[i] + self.spring_energy(i, h) + h.sheared))
            .collect()
    }

    /// What is stored the very moment the interface begins to act, as it has been evaluated for that: overlap that a law or a spring presses apart.
    pub(super) fn initial_energy(&self) -> f64 {
        if self.history.acting {
            return 0.0;
        }
        let points = &self.cache.trial.points;
        let own = self.law_energies(points.iter().map(|e| e.gap));
        let stored = points.iter().zip(own).enumerate().map(|(i, (e, own))| {
            let point = PointHistory {
                pressure: e.response.traction[0],
                damping: e.response.damping,
                gap: e.gap,
                stiffness: [e.normal_stiffness, e.tangential_stiffness],
                ..PointHistory::default()
            };
            e.area * (own + self.spring_energy(i, &point))
        });
        stored.sum()
    }

    /// Energy per area of the springs of the enforcement at a point.
    fn spring_energy(&self, i: usize, h: &PointHistory) -> f64 {
        if !h.stiffness[0].is_finite() || !self.laws.needs_normal_stiffness() {
            return 0.0;
        }
        // what is left of the constraint's violation, a spring from λ to p
        let rest = self.history.rest.get(i).copied().unwrap_or(0.0);
        let left = rest - h.gap;
        // Tied surfaces pull as well, where something is opposite.
        let pulls = self.laws.tied && h.gap.is_finite();
        let left = if pulls { left } else { left.max(0.0) };
        0.5 * (h.pressure - h.damping) * left
    }

    /// Energies at the last committed state.
    pub fn energy(&self) -> Energy {
        Energy {
            stored: self.stored_energy(),
            ..self.history.energy
        }
    }

    /// Recoverable energy of the normal law alone `[J]`.
    pub fn law_energy(&self) -> f64 {
        let energies = self.law_energies(self.history.points.iter().map(|h| h.gap));
        let energies = energies.iter().enumerate();
        energies.map(|(i, own)| self.area_of(i) * own).sum()
    }

    /// The same by point and per area `[J/m²]`.
    fn law_energies(&self, gaps: impl Iterator<Item = f64>) -> Vec<f64> {
        match &self.laws.user.normal {
            Some(user) => user.energies(&gaps.collect::<Vec<_>>()),
            None => {
                let law = self.laws.normal_law();
                gaps.map(|gap| law.energy(gap)).collect()
            }
        }
    }
}
