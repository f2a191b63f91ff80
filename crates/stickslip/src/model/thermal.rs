//! What temperatures do to bodies: forces that follow from thermal strain, and the energy that goes with it.
//!
//! With thermal strain `ε_T` the energy of the bodies is `½ uᵀ K u - uᵀ f + c`: the forces `f = ∫ Bᵀ C ε_T` act like loads, so that the stiffness stays
//! what it was, and `c = ½ ∫ ε_Tᵀ C ε_T` is what it takes to hold a body that would expand.

use std::sync::Arc;

use super::definition::Model;
use super::heat::{Heat, Pressed};
use crate::body::{At, Warm, recover};
use crate::math::vector::dot;

/// Weights whose largest is one, and what they are multiplied by.
fn scaled(mut weights: Vec<[f64; 2]>) -> (Vec<[f64; 2]>, f64) {
    let all = weights.as_flattened().iter().copied();
    let largest = all.fold(0.0_f64, |m, w| if w.abs() > m.abs() { w } else { m });
    if largest == 0.0 {
        return (weights, 1.0);
    }
    let each = weights.as_flattened_mut().iter_mut();
    each.for_each(|w| *w /= largest);
    (weights, largest)
}

/// Forces and energy at a time, and by how much the forces have to be multiplied. Where strains are in proportion to temperatures, what grows
/// is the same to the last bit but for a factor: condensed bodies know it again. They follow from the time alone, whatever was asked for before.
fn at(heat: &Heat, model: &Model, t: f64) -> (Arc<Pressed>, f64) {
    let fields = heat.temperatures.fields.iter();
    let weights = fields.map(|f| f.weights(t)).collect();
    let (weights, factor) = match linear(model) {
        true => scaled(weights),
        false => (weights, 1.0),
    };
    // A thread that panicked has left what is whole: it is put there at once.
    let mut last = (heat.last.lock()).unwrap_or_else(std::sync::PoisonError::into_inner);
    if let Some(known) = last.as_ref().filter(|known| known.weights == weights) {
        return (known.clone(), factor);
    }
    let rest = vec![0.0; model.dofs.count()];
    let at = At {
        u: &rest[..model.mesh.points.len() * model.dofs.dim],
        warm: Warm::Weighted(&weights),
    };
    let (mut force, mut energy) = (rest.clone(), 0.0);
    for body in model.elastic() {
        recover::internal_force(&body.elastic, at, &mut force);
        energy += recover::strain_energy(&body.elastic, at);
    }
    force.iter_mut().for_each(|f| *f = -*f);
    let pressed = Arc::new(Pressed {
        weights,
        force,
        energy,
    });
    *last = Some(pressed.clone());
    (pressed, factor)
}

/// Whether all strains are in proportion to temperatures.
fn linear(model: &Model) -> bool {
    let parts = model.elastic().flat_map(|b| b.elastic.parts());
    let mut dilations = parts.filter_map(|p| p.dilation.as_ref());
    dilations.all(|d| d.is_linear())
}

/// Adds so many times what temperatures press with at a time to `out` `[N]`, by dof.
pub(crate) fn add_thermal_forces(model: &Model, t: f64, times: f64, out: &mut [f64]) {
    if let Some(heat) = &model.actions.heat {
        let (pressed, factor) = at(heat, model, t);
        let both = out.iter_mut().zip(&pressed.force);
        both.for_each(|(out, f)| *out += times * factor * f);
    }
}

/// By how much the strain energy at displacements and a time is more than that without thermal strain; and that of bodies that are held where they are
/// meshed `[J]`.
pub(crate) fn thermal_energy(model: &Model, t: f64, u: &[f64]) -> [f64; 2] {
    let Some(heat) = &model.actions.heat else {
        return [0.0; 2];
    };
    let (pressed, factor) = at(heat, model, t);
    let held = factor * factor * pressed.energy;
    [held - factor * dot(u, &pressed.force), held]
}

/// Whether temperatures move bodies.
pub fn is_heated(model: &Model) -> bool {
    model.actions.heat.as_ref().is_some_and(|h| {
        let mut rises = h.temperatures.extremes().into_iter();
        rises.any(|e| e != [0.0; 2])
    })
}

#[cfg(test)]
mod tests {
    use super::scaled;

    #[test]
    fn what_grows_keeps_its_proportions() {
        let whole = [[1.0, 1.0], [0.5, 0.0]];
        for part in [0.3, -0.7, 1.0] {
            let (weights, factor) = scaled(whole.map(|w| w.map(|x| part * x)).to_vec());
            assert_eq!((weights, factor), (whole.to_vec(), part));
        }
        let none = vec![[0.0; 2]; 2];
        assert_eq!(scaled(none.clone()), (none, 1.0));
    }
}
