//! What is reported follows from the history alone, whatever has been tried since, and takes no more memory than is counted.

use super::objective::{accept, all, start, tried};
use super::view::ContactView;
use crate::contact::law::wear::{Archard, Feedback, WearModel};
use crate::contact::look;
use crate::math::{Vec3, mat_vec, rotation};
use crate::system::{Fields, State};

/// The shoe, pressed and slid along the drum by an angle and lifted by a part.
fn slid(drum: usize, angle: f64, lift: f64) -> impl Fn(usize, Vec3) -> Vec3 {
    let turn = rotation([0.0, 0.0, 1.0], angle);
    move |k, x| match k < drum {
        true => x,
        false => mat_vec(&turn, x).map(|x| (1.0 + lift) * x),
    }
}

/// All that an interface says of itself, in words that differ when a bit does.
fn said(contact: ContactView, state: &State) -> String {
    let mut fields = Fields::default();
    look::fields(contact, &mut fields);
    let u = &state.u;
    format!(
        "{:?}",
        (
            (look::quality(contact), look::balance(contact, u)),
            (look::table(contact, u), look::resultant(contact, u)),
            (look::energy(contact), look::law_energy(contact)),
            (look::wear(contact), look::numerical_factor(contact)),
            look::resolution(contact),
            look::between(contact, u, state.t),
            fields,
        )
    )
}

#[test]
fn what_is_reported_does_not_depend_on_what_was_tried_since() {
    for dim in [2, 3] {
        for (what, mut interface) in all(dim) {
            interface.definition.laws.wear = WearModel::Archard(Archard {
                coefficient: 1e-9,
                primary_coefficient: 1e-9,
                running_in: 0.0,
                running_in_path: 0.0,
            });
            interface.definition.laws.feedback = Feedback::Implicit;
            let drum = interface.primary_nodes;
            let origin = start(&interface);
            let state = accept(&mut interface, &origin, slid(drum, 1e-4, 0.0));
            let state = accept(&mut interface, &state, slid(drum, 0.05, 0.0));
            let before = said(interface.view(), &state);
            let history = interface.state.clone();
            tried(&mut interface, &state, slid(drum, 0.3, 0.002));
            assert_eq!(said(interface.view(), &state), before, "{what}");
            assert_eq!(interface.state, history, "{what}");
            // The history is all there is to it.
            let mut other = interface.clone();
            other.state = history;
            assert_eq!(said(other.view(), &state), before, "{what}");
        }
    }
}

#[test]
fn a_history_takes_the_memory_that_is_counted() {
    for dim in [2, 3] {
        for (what, mut interface) in all(dim) {
            let drum = interface.primary_nodes;
            let origin = start(&interface);
            let state = accept(&mut interface, &origin, slid(drum, 1e-4, 0.0));
            accept(&mut interface, &state, slid(drum, 0.05, 0.0));
            let (taken, counted) = (interface.state.taken(), interface.history_bytes());
            assert!(taken <= counted, "{what}: {taken} of {counted}");
            assert!(counted <= 3 * taken, "{what}: {taken} of {counted}");
        }
    }
}
