//! Forces and energies beside which others are rounding.

use super::view::View;

/// The energy that may be nothing but rounding of the strains `[J]`.
pub(super) fn rounded_energy(view: &View) -> f64 {
    let moved = farthest(view);
    // Energies below this part of what the model would store if it strained as far as it moves are rounding.
    1e-13 * stiffness(view) * moved * moved
}

/// The largest displacement or rotation of a dof.
pub(super) fn farthest(view: &View) -> f64 {
    (view.frame.state.u.iter()).fold(0.0, |m, u| f64::max(m, u.abs()))
}

/// Force `[N]` in the stiffest body if the largest displacement were its strain, beside which forces may be nothing but rounding.
pub(super) fn strain_force(view: &View) -> f64 {
    stiffness(view) * farthest(view)
}

/// Stiffness `[N/m]` of a body of the stiffest material and the size of the model.
fn stiffness(view: &View) -> f64 {
    let blocks = 0..view.model.mesh.blocks.len();
    let moduli = view.model.elastic().flat_map(|b| {
        let of = |k: usize| b.elastic.constrained_modulus(k);
        blocks.clone().filter_map(of)
    });
    let stiffest = moduli.fold(0.0_f64, f64::max);
    stiffest * view.model.size.powi(view.model.mesh.dim as i32 - 2)
}
