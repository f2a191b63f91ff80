//! Axles that nothing but contact holds.
//!
//! Steps of the iteration are held back that would turn one through the teeth of another (`look/passing.rs`): by a stiffness against turning of such axles that falls with the moment out of
//! balance, so that where contact has let go a moment turns an axle by a facet and not by any angle, and near the equilibrium nothing is held. That is the method of Levenberg and
//! Marquardt, and it keeps Newton's order ([Fan and Yuan](stickslip_base::references::fan_yuan_2005)).

use super::definition::InterfaceDefinition;
use crate::system::{Assembler, BodyFrames, Tangent};

/// Adds to the tangent what holds axles back, of bodies in these frames, that forces `b` by dof, out of balance, would turn.
pub(super) fn damp_axles(
    definition: &InterfaceDefinition,
    frames: &BodyFrames,
    b: &[f64],
    out: &mut Assembler,
) {
    if !definition.turns || definition.skin.is_empty() {
        return;
    }
    let points = definition
        .nodes
        .iter()
        .copied()
        .zip(definition.reference.iter().copied());
    for (dofs, reach) in frames.turns_by(points, definition.facet_size()) {
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
