//! Explicit dynamics: springs in place of multipliers, and how stiff they are; ties that hold exactly.

use std::sync::Arc;

use super::commit::sheared;
use super::energies::stored_energy;
use super::history::History;
use super::parts::Interface;
use super::stiffness::tangential_stiffness;
use crate::contact::enforcement::Multipliers;
use crate::system::Assembler;

/// Lets these tractions `[Pa]`, by point and along the directions of its rows, be those of the last evaluation, and adds their forces to a residual.
pub fn pull_ties(
    interface: &mut Interface,
    tractions: &[(usize, [f64; 3])],
    out: Option<&mut Assembler>,
) {
    for &(i, traction) in tractions {
        interface.cache.last.pull(i, traction);
    }
    let Some(out) = out else {
        return;
    };
    let mut spatial = Assembler::new(out.residual.len());
    for &(i, _) in tractions {
        let (batch, e) = (
            interface.cache.last.batch(i),
            &interface.cache.last.points[i],
        );
        spatial.add_residual(batch.dofs(e), batch.force(e).unwrap_or_default());
    }
    interface
        .cache
        .geometry
        .in_space
        .assemble(&mut spatial, out);
}

/// Enforces contact and stick by springs in explicit dynamics, whatever the enforcement: those of a penalty, or as stiff as the cells
/// beneath.
///
/// What presses already goes on pressing: a spring starts where its force is that of the multiplier it replaces. The energy `[J]` that this
/// puts into the springs is returned.
pub fn use_springs(interface: &mut Interface, state: &mut History, springs: bool) -> f64 {
    if state.springs == springs {
        return 0.0;
    }
    let before = stored_energy(interface.view(state));
    state.springs = springs;
    state.rest = Arc::default();
    let multipliers = interface.laws.enforcement.as_dyn().multipliers() != Multipliers::None;
    if springs && multipliers && interface.laws.needs_normal_stiffness() {
        let exact = interface.view(state).holds_exactly();
        let points = interface.points.iter().zip(&state.points);
        let rest = points
            .map(|(p, h)| {
                if exact && h.gap.is_finite() {
                    h.gap
                } else if h.pressure > 0.0 || interface.laws.tied && h.gap.is_finite() {
                    h.gap + h.pressure / p.stiffness
                } else {
                    0.0
                }
            })
            .collect();
        state.rest = Arc::new(rest);
    }
    // Springs of stick come or go with the shear that there is; what holds exactly has none.
    let contact = interface.view(state);
    let points = state.points.iter().zip(&contact.points);
    let sheared: Vec<f64> = points
        .map(|(h, p)| {
            let stiffness = tangential_stiffness(contact, &interface.attempt, p.stiffness);
            sheared(contact, h.shear, stiffness)
        })
        .collect();
    let points = state.points.iter_mut().zip(sheared);
    points.for_each(|(h, sheared)| h.sheared = sheared);
    state.energy.stored = stored_energy(interface.view(state));
    state.energy.stored - before
}
