//! Masses that meet what does not give way: contact is an impulse there, and no force that one increment hands on to the next.
//!
//! The trapezoidal rule takes half of the force at the start of an increment. That of an impact is as large as the increment is short, and half of it would
//! act once more on a body that has turned round already: the energy of a block that falls on a rigid floor grows without end. Here, as in
//! [`kane_1999`](crate::references::kane_1999), contact acts through its mean over the increment alone, which is what holds the surfaces at its end:
//!
//! ```text
//! u₁ = u₀ + dt v₀ + dt² ((½ - β) a₀ + β a₁) + dt²/2 a_c,   v₁ = v₀ + dt ((1 - γ) a₀ + γ a₁) + dt a_c,   M a_c = -R₁
//! ```
//!
//! with accelerations `a` that contact has no part in, whose balance is that of the stage. With `A = a₁ + a_c/(2β)` displacements follow Newmark's
//! relation, velocities do but for `(1 - γ/(2β)) dt a_c`, and the balance is as it was but for the weight `(1 - α_m)/(2β)` of `R₁`. Friction that is held
//! against a velocity without that part may push along the one with it. So it is none: `β = γ/2`, for generalised-alpha the least with which the scheme is
//! stable at any increment ([`chung_hulbert_1993`](crate::references::chung_hulbert_1993)). What does no work on surfaces that stay closed takes energy from
//! those that meet.
//!
//! How fast a mass rebounds from there is left to chance: to where in the increment it has met the other one. So velocities are projected, in the norm of
//! the mass, on those with which pressed points stay where they are: the law of impact of
//! [`jean_moreau_1992`](crate::references::jean_moreau_1992) with no restitution. A projection makes no energy.

use crate::contact::interface::{InterfaceForce, Pressed, pressed_points};
use crate::contact::look;
use crate::math::vector::dot;
use crate::model::contact::Contact;
use crate::model::definition::{ContactAt, Dynamic, Model};
use crate::model::frame::Frame;
use crate::solve::inertia::Inertia;
use crate::system::{Stage, StepFailure};
use crate::tolerance::ROUNDING;

/// Whether contact is an impulse over an increment: of masses alone, with what does not give way and does not move.
pub(super) fn is_impulse(
    model: &Model,
    frame: &Frame,
    dynamic: &Dynamic,
    contact: &Contact,
    inertia: &Inertia,
    [from, to]: [f64; 2],
) -> bool {
    let acting = || contact.views(frame).filter(|i| i.schedule.active(to));
    let light = |node: &usize| inertia.light[model.dofs.of(*node, 0)];
    dynamic.contact_at == ContactAt::End
        && contact.couplings.is_empty()
        && acting().next().is_some()
        && acting().all(|i| look::is_hard(i) && i.stands(from, to) && !i.nodes.iter().any(light))
}

/// `M⁻¹ f` over all dofs, zero where they are fixed.
pub(super) fn kicked(
    model: &Model,
    inertia: &Inertia,
    fixed: &[bool],
    force: &[f64],
) -> Result<Vec<f64>, StepFailure> {
    if force.iter().all(|f| *f == 0.0) {
        return Ok(vec![0.0; fixed.len()]);
    }
    let mut kick = inertia.accelerator(fixed, 0.0)(force)?;
    model.links.impose(&mut kick);
    Ok(kick)
}

/// Stops pressed points, and gives the energy that this and the way to where they met have taken `[J]`.
pub(super) fn stop(
    model: &Model,
    inertia: &Inertia,
    fixed: &[bool],
    interfaces: &mut [InterfaceForce],
    stage: &Stage,
    v: &mut Vec<f64>,
) -> Result<f64, StepFailure> {
    let interfaces = interfaces.iter_mut();
    let pressed: Vec<Pressed> = interfaces.flat_map(|i| pressed_points(i, stage)).collect();
    let both = stage.at.u.iter().zip(&stage.from.u);
    let moved: Vec<f64> = both.map(|(a, b)| a - b).collect();
    let rates = |x: &[f64]| -> Vec<f64> {
        let along = |p: &Pressed| p.dofs.iter().zip(&p.gap).map(|(&d, g)| g * x[d]).sum();
        pressed.iter().map(along).collect()
    };
    // What is pressed apart from an overlap gains that, which is work of the overlap.
    let closed = pressed.iter().zip(rates(&moved));
    let mut lost: f64 = closed.map(|(p, opened)| p.force * (-opened).max(0.0)).sum();
    let mut accelerate = inertia.accelerator(fixed, 0.0);
    let mut moves = |impulses: &[f64]| -> Result<Vec<f64>, StepFailure> {
        let mut all = vec![0.0; fixed.len()];
        for (p, impulse) in pressed.iter().zip(impulses) {
            p.dofs
                .iter()
                .zip(&p.gap)
                .for_each(|(&d, g)| all[d] += g * impulse);
        }
        model.links.transfer(&mut all);
        let mut change = accelerate(&all)?;
        model.links.impose(&mut change);
        Ok(change)
    };
    // Conjugate gradients for the impulses: points may press more often than bodies can move, but what they ask for agrees. Where that is rounding alone
    // they lead nowhere, and the best there was is kept.
    let mut rest: Vec<f64> = rates(v).iter().map(|r| -r).collect();
    let start = dot(&rest, &rest);
    let (mut direction, mut square) = (rest.clone(), start);
    let before = inertia.kinetic_energy(v);
    let fastest = v.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let rounding = ROUNDING * ROUNDING * fastest * fastest * pressed.len() as f64;
    // What is left of the velocity at pressed points, relative to what there was.
    let enough = rounding.max(ROUNDING * ROUNDING * start);
    let mut best = (square, v.clone());
    for _ in 0..4 * pressed.len() {
        // What is left may become so much larger than its least on the way, in squares.
        if square <= enough || square > 1e6 * best.0 {
            break;
        }
        let change = moves(&direction)?;
        let image = rates(&change);
        let step = square / dot(&direction, &image);
        if !(step.is_finite() && step > 0.0) {
            break;
        }
        v.iter_mut().zip(&change).for_each(|(v, c)| *v += step * c);
        rest.iter_mut()
            .zip(&image)
            .for_each(|(r, i)| *r -= step * i);
        let next = dot(&rest, &rest);
        direction
            .iter_mut()
            .zip(&rest)
            .for_each(|(d, r)| *d = r + next / square * *d);
        square = next;
        if square < best.0 {
            best = (square, v.clone());
        }
    }
    *v = best.1;
    lost += before - inertia.kinetic_energy(v);
    Ok(lost)
}
