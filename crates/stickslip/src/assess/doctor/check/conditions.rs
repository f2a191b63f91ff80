//! Models in which nothing acts.

use super::super::finding::{DoctorCause, Finding};
use super::super::suspect::Suspect;
use super::common::{forced, travel};
use super::measured::Measured;
use crate::assess::view::View;
use crate::model::definition::Model;

pub(super) fn check(view: &View, measured: &[Measured]) -> Vec<Finding> {
    let model = view.model;
    let mut out = inert(model);
    let belts = view.contact.interfaces.iter().any(|i| !i.belt.is_empty());
    let overlaps = view.contact.interfaces.iter().zip(measured).any(|(i, m)| {
        let points = i.points.iter().zip(&m.gaps);
        points.into_iter().any(|(p, g)| *g < -1e-6 * p.size)
    });
    let moves = model.steps.iter().any(|step| step.modal.is_none());
    if moves
        && travel(view) == 0.0
        && !forced(view)
        && !belts
        && !overlaps
        && model.actions.initials.is_empty()
    {
        out.push(
            DoctorCause::NothingActs.warning(
                "nothing acts: no load, no prescribed displacement, no motion of an obstacle, no overlap"
            )
            .blame(Suspect::key("step", "every step leaves the model as it is"))
            .advise("check that values are not zero and that steps list the loads and supports that act"),
        );
    }
    out
}

/// Temperatures of bodies that do not expand.
fn inert(model: &Model) -> Vec<Finding> {
    let expands = |p: &usize| {
        let mut bodies = model.elastic().filter(|b| b.points.contains(p));
        bodies.any(|b| b.elastic.parts().iter().any(|part| part.dilation.is_some()))
    };
    let fields = model
        .actions
        .heat
        .iter()
        .flat_map(|h| &h.temperatures.fields);
    let idle = fields.filter(|f| !f.entries.iter().any(|(p, _)| expands(p)));
    let finding = |name: &String| {
        let message =
            format!("temperature {name} changes nothing: no material of its bodies expands");
        DoctorCause::NothingActs
            .warning(message)
            .blame(Suspect::key(format!("temperature.{name}"), ""))
            .advise("give their materials an `expansion`, the coefficient of thermal expansion")
    };
    idle.map(|field| finding(&field.name)).collect()
}
