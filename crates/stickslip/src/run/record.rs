//! How an accepted increment becomes the last state, and enters the ledger.

use crate::contact::look;
use crate::model::contact::Contact;
use crate::model::definition::Model;
use crate::model::frame::{ContactMemory, Frame};
use crate::model::ledger::{EnergyLedger, Flow};
use crate::model::scene::Scene;
use crate::model::thermal;
use crate::results::summary::Summary;
use crate::solve::accepted::{Accepted, Effort};

/// Makes it the last state, after which contact knows what the frame has already, and enters it into the ledger.
pub(super) fn record(
    model: &Model,
    contact: &Contact,
    frame: &mut Frame,
    summary: &mut Summary,
    accepted: Accepted,
) -> Effort {
    let effort = accepted.effort;
    if let Some(solver) = &accepted.solver {
        *summary
            .attempts
            .friction_solvers
            .entry(solver.clone())
            .or_insert(0) += 1;
    }
    let first = summary.attempts.increments == 0;
    frame.ledger = ledger_after(model, &*frame, contact, &frame.contacts, &accepted, first);
    frame.coupled = contact.coupled(frame).stored();
    let dt = accepted.state.t - frame.state.t;
    frame.state = accepted.state;
    frame.forces = accepted.forces;
    frame.contact = accepted.contact;
    frame.load = accepted.external;
    if let Some(internal) = accepted.internal {
        frame.motion.internal = internal;
        frame.motion.travel = accepted.travel;
    }
    if !frame.fields.is_empty() {
        let scene = Scene {
            model,
            contact,
            frame,
        };
        frame.fields = scene.advanced_fields(dt);
    }
    if let Some(kick) = &mut frame.kick {
        kick.follow(&frame.state, frame.ledger.kinetic, effort.tally);
    }
    summary.attempts.increments += 1;
    summary.attempts.iterations += effort.iterations;
    let turned = model.links.largest_rotation(&frame.state.u);
    // Elastic bodies are looked at where there is a row of the history.
    summary.largest_rotation = summary.largest_rotation.max(turned);
    summary.balance.energy_quality.note(&frame.ledger);
    summary.balance.energy = frame.ledger;
    effort
}

/// The ledger after an increment that the interfaces have committed; `first`: of all.
pub(crate) fn ledger_after(
    model: &Model,
    frame: &Frame,
    contact: &Contact,
    after: &ContactMemory,
    accepted: &Accepted,
    first: bool,
) -> EnergyLedger {
    let followed = accepted.followed || first && pressed_at_start(model, contact, frame);
    // The energy of couplings counts with that of the bodies.
    let couplings = contact.couplings.view(&after.couplings);
    let (stored, coupled) = (couplings.stored(), couplings.work());
    let at = &accepted.state;
    let flow = Flow {
        work: accepted.flow.work + coupled,
        damped: accepted.flow.damped + couplings.damped(),
        thermal: thermal::thermal_energy(model, at.t, &at.u),
        ..accepted.flow
    };
    let interfaces: Vec<_> = contact.views_of(after).map(|i| look::energy(i)).collect();
    let mut ledger = frame.ledger;
    let before = ledger.of_interfaces();
    let energies = [accepted.kinetic, accepted.strain + stored];
    ledger.enter(flow, energies, &interfaces, followed);
    if followed {
        // Less what the interfaces have entered of it.
        let entered = ledger.of_interfaces() - before + stored - frame.coupled - coupled;
        ledger.lose(contact_work(accepted, frame) - entered);
    }
    ledger
}

/// Work that contact took over an increment by the trapezoidal rule, as that of loads is entered.
fn contact_work(accepted: &Accepted, frame: &Frame) -> f64 {
    let mut work = 0.0;
    for (i, after) in accepted.contact.iter().enumerate() {
        let before = frame.contact.get(i).copied().unwrap_or(0.0);
        work += 0.5 * (before + after) * (accepted.state.u[i] - frame.state.u[i]);
    }
    work
}

/// Whether an increment at rest begins with a normal law that presses where the gap is zero. Surfaces that touch as they are meshed are not in
/// balance at the very start then, and the way to where they are costs nothing.
fn pressed_at_start(model: &Model, contact: &Contact, frame: &Frame) -> bool {
    model.steps[frame.step].dynamic.is_none()
        && contact.interfaces.iter().any(|i| {
            let touching = i.laws.normal.as_dyn().pressure(0.0);
            touching.is_some_and(|p| p.value > 0.0)
        })
}
