//! How stiffly bodies and enforcement resist at a point.

use super::attempt::Attempt;
use super::definition::InterfaceDefinition;
use super::input::InterfaceInput;
use super::view::ContactView;
use crate::contact::enforcement::{Multipliers, Stiffness};
use crate::contact::surface::ContactPoint;

/// Part of the mass over the square of the increment that counts as stiffness: a tenth of what the trapezoidal rule makes of it. More would turn the
/// rounding of gaps into pressure where supports hold a body already.
const INERTIAL_STIFFNESS: f64 = 0.4;

/// Mass per area behind each point `[kg/m²]`, from the masses of the points of the mesh `[kg]`; zero where there is none.
pub fn mass_per_area(interface: &InterfaceDefinition, by_point: &[f64]) -> Vec<f64> {
    let mass = |p: &ContactPoint| -> f64 {
        let nodes = p.nodes.iter().zip(&p.weights);
        nodes
            .map(|(&node, w)| w * by_point.get(interface.nodes[node]).copied().unwrap_or(0.0))
            .sum::<f64>()
            .max(0.0)
    };
    interface.points.iter().map(|p| mass(p) / p.area).collect()
}

/// How stiffly the bodies resist at a point `[Pa/m]`: the cell beneath, and over an increment of length `moving` its mass.
pub(super) fn own_stiffness(interface: InterfaceInput, i: usize, moving: Option<f64>) -> f64 {
    let inertia = interface.conditions.inertia.get(i).copied().unwrap_or(0.0);
    let inertia = moving.map_or(0.0, |dt| INERTIAL_STIFFNESS * inertia / (dt * dt));
    interface.points[i].stiffness + inertia
}

/// Stiffness against slip at a point whose own is this `[Pa/m]`; infinite where the law alone says what resists.
pub(super) fn tangential_stiffness(contact: ContactView, attempt: &Attempt, own: f64) -> f64 {
    match contact.laws.needs_tangential_stiffness() {
        true => spring(
            contact,
            attempt,
            contact.laws.enforcement.as_dyn().tangential(),
            own,
        ),
        false if contact.laws.lends_spring(contact.state.springs) => own,
        false => f64::INFINITY,
    }
}

/// A stiffness of the enforcement as far as it has been tightened, or that of the cell beneath where explicit springs replace multipliers.
pub(in crate::contact) fn spring(
    contact: ContactView,
    attempt: &Attempt,
    stiffness: Stiffness,
    own: f64,
) -> f64 {
    let multipliers = contact.laws.enforcement.as_dyn().multipliers();
    if contact.state.springs && multipliers != Multipliers::None {
        return own;
    }
    let start = stiffness.resolve(own);
    if attempt.tightened == 0 {
        return start;
    }
    // Never softer than asked for, and never so stiff that the bodies drown in rounding.
    let raised = start * 10_f64.powi(attempt.tightened as i32);
    // An augmented Lagrangian is tightened up to this stiffness relative to that of the bodies.
    raised.min(1e6 * own).max(start)
}
