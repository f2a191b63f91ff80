//! Motions of bodies as a whole that even contact cannot hold, and gaps that a body under force has to close.

use super::super::balance::unbalanced;
use super::super::finding::{DoctorCause, Finding};
use super::super::motions::{FloatingBody, floating, rows};
use super::super::places::secondary;
use super::common::forced;
use super::measured::Measured;
use crate::assess::view::View;
use crate::contact::look::Opposite;
use crate::contact::response::Status;
use crate::number::figure;
use crate::tolerance::NEGLIGIBLE;

/// Points of an interface that are asked, about; those that touch are all asked.
const ASKED_POINTS: usize = 2000;

pub(super) fn check(view: &View, measured: &[Measured]) -> Vec<Finding> {
    let model = view.model;
    let Some(step) = model.steps.first().filter(|s| s.dynamic.is_none()) else {
        return Vec::new();
    };
    let t = step.start + 1e-9 * (step.end - step.start);
    let (mut all, mut touching) = (Vec::new(), Vec::new());
    for (interface, measured) in view.contact.interfaces.iter().zip(measured) {
        if !interface.schedule.active(t) {
            continue;
        }
        let laws = &interface.laws;
        let status = match laws.tied || laws.friction_law().frictional() {
            true => Status::Stick,
            false => Status::Slip,
        };
        let mut opposite = Opposite::new(interface, t);
        let stride = interface.points.len().div_ceil(ASKED_POINTS).max(1);
        for (i, (&gap, beside)) in measured.gaps.iter().zip(&measured.nearest).enumerate() {
            let Some(beside) = beside.filter(|_| gap.is_finite()) else {
                continue;
            };
            let touches = gap <= NEGLIGIBLE * interface.points[i].size;
            if !touches && !i.is_multiple_of(stride) {
                continue;
            }
            let mut own = Vec::new();
            rows(interface, &mut opposite, i, beside.normal, status, &mut own);
            if touches {
                touching.extend(own.clone());
            }
            all.extend(own);
        }
    }
    let stops = view.couplings().stops(t);
    all.extend(stops.map(|row| row.terms().collect()));
    let free = floating(view, t, &all);
    if !free.is_empty() {
        return vec![
            DoctorCause::FreeRigidMode.warning(
                "bodies can move as a whole: neither supports, nor springs, nor contact can hold them",
            )
            .blame_all(free.iter().map(|l| l.place(model, "is free")))
                .advise(
                    "support these motions, or hold them by weak springs (`[load.NAME] spring`)",
                )
                .advise("friction holds a body along a surface, contact alone does not"),
        ];
    }
    let statics = model.steps.iter().filter(|s| s.dynamic.is_none());
    let mut out = Vec::new();
    // Supports that come later may hold what is free now: the first step counts.
    out.extend(statics.take(1).find_map(|s| unbalanced(view, s.end)));
    let waiting = floating(view, t, &touching);
    if waiting.is_empty() || !forced(view) {
        return out;
    }
    // The nearest point of all interfaces of the bodies that wait.
    let mut nearest: Option<(usize, usize, f64)> = None;
    for (k, m) in measured.iter().enumerate() {
        for (i, &gap) in m.gaps.iter().enumerate() {
            if gap > 0.0 && gap.is_finite() && nearest.is_none_or(|n| gap < n.2) {
                nearest = Some((k, i, gap));
            }
        }
    }
    let Some((k, i, gap)) = nearest else {
        return out;
    };
    let interface = &view.contact.interfaces[k];
    let finding = DoctorCause::InitialGap.warning(format!("bodies that contact has to hold do not touch yet: the smallest gap is {}", figure(gap))).note_unless(gap > interface.points[i].size)
        .blame(secondary(interface, i, format!("gap {}", figure(gap))))
        .advise("move the bodies until they touch (`body.NAME.translate`), or prescribe a displacement instead of a force");
    let held = |l: &FloatingBody| l.place(model, "is held by nothing that touches");
    out.push(finding.blame_all(waiting.iter().map(held)));
    out
}
