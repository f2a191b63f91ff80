//! Energies of an interface.

use super::evaluation::Evaluation;
use super::history::PointHistory;
use super::view::ContactView;
use crate::system::Energy;

/// Recoverable energy of the interface: of the normal law, and of the springs of the enforcement where they yield, in both directions.
pub(in crate::contact) fn stored_energy(contact: ContactView) -> f64 {
    stored_by_point(contact).into_iter().sum()
}

/// The same by point `[J]`; empty where the interface does not act.
pub fn stored_by_point(contact: ContactView) -> Vec<f64> {
    if !contact.state.acting {
        return Vec::new();
    }
    let own = law_energies(contact, contact.state.points.iter().map(|h| h.gap));
    (contact.state.points.iter().enumerate())
        .map(|(i, h)| contact.area_of(i) * (own[i] + spring_energy(contact, i, h) + h.sheared))
        .collect()
}

/// What is stored the very moment the interface begins to act, as it has been evaluated for that: overlap that a law or a spring presses apart.
pub(super) fn initial_energy(contact: ContactView, points: &[Evaluation]) -> f64 {
    if contact.state.acting {
        return 0.0;
    }
    let own = law_energies(contact, points.iter().map(|e| e.gap));
    let stored = points.iter().zip(own).enumerate().map(|(i, (e, own))| {
        let point = PointHistory {
            pressure: e.response.traction[0],
            damping: e.response.damping,
            gap: e.gap,
            stiffness: e.stiffness,
            ..PointHistory::default()
        };
        e.area * (own + spring_energy(contact, i, &point))
    });
    stored.sum()
}

/// Energy per area of the springs of the enforcement at a point.
fn spring_energy(contact: ContactView, i: usize, h: &PointHistory) -> f64 {
    if !h.stiffness[0].is_finite() || !contact.laws.needs_normal_stiffness() {
        return 0.0;
    }
    // what is left of the constraint's violation, a spring from λ to p
    let rest = contact.state.rest.get(i).copied().unwrap_or(0.0);
    let left = rest - h.gap;
    // Tied surfaces pull as well, where something is opposite.
    let pulls = contact.laws.tied && h.gap.is_finite();
    let left = if pulls { left } else { left.max(0.0) };
    0.5 * (h.pressure - h.damping) * left
}

/// Energies at the last committed state.
pub fn energy(contact: ContactView) -> Energy {
    Energy {
        stored: stored_energy(contact),
        ..contact.state.energy
    }
}

/// Recoverable energy of the normal law alone `[J]`.
pub fn law_energy(contact: ContactView) -> f64 {
    let energies = law_energies(contact, contact.state.points.iter().map(|h| h.gap));
    let energies = energies.iter().enumerate();
    energies.map(|(i, own)| contact.area_of(i) * own).sum()
}

/// The same by point and per area `[J/m²]`.
fn law_energies(contact: ContactView, gaps: impl Iterator<Item = f64>) -> Vec<f64> {
    match &contact.laws.user.normal {
        Some(user) => user.energies(&gaps.collect::<Vec<_>>()),
        None => {
            let law = contact.laws.normal_law();
            gaps.map(|gap| law.energy(gap)).collect()
        }
    }
}
