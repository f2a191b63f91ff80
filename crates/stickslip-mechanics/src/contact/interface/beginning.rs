//! How an interface begins to act: the gaps it counts from, and the places its points are moved to.

use std::sync::Arc;

use super::conditions::Conditions;
use super::history::History;
use super::initial::{CLOSE, GLUE, Start, Within};
use super::parts::Interface;
use super::pass::all_gaps_at;
use crate::contact::surface::ContactPoint;
use crate::system::{Stage, State};

/// Takes note of the gaps with which the interface begins to act, if it has not begun yet, in a step from `span[0]` to `span[1]`.
pub fn begin_acting(
    interface: &mut Interface,
    state: &mut History,
    conditions: &Conditions,
    stage: &Stage,
    span: [f64; 2],
) {
    if state.start.begun || !interface.schedule.active(0.5 * (span[0] + span[1])) {
        return;
    }
    let start = Arc::make_mut(&mut state.start);
    start.begun = true;
    start.span = span;
    if !matches!(interface.initial.start, Start::Offset | Start::Ramp) {
        return;
    }
    let gaps = all_gaps_at(&mut interface.force(state, conditions), stage);
    let largest = match interface.initial.start {
        Start::Offset => interface.initial.within.unwrap_or(CLOSE),
        _ => Within::Distance(0.0),
    };
    let points = gaps.iter().zip(&interface.points).enumerate();
    let offset = points
        .map(|(i, (&gap, point))| {
            // It is the gap of the meshes that counts as another one: heights stay.
            let gap = gap + interface.relief.get(i).copied().unwrap_or(0.0);
            if gap <= largest.of(point.size) {
                gap - interface.initial.gap
            } else {
                0.0
            }
        })
        .collect();
    Arc::make_mut(&mut state.start).offset = offset;
}

/// Finds the distances of tied surfaces in the reference configuration.
pub fn glue(interface: &mut Interface, state: &mut History, stage: &Stage) {
    if !interface.laws.tied || !state.start.glued.is_empty() {
        return;
    }
    Arc::make_mut(&mut state.start).glued = vec![0.0; interface.points.len()];
    let rest = State {
        t: stage.from.t,
        u: vec![0.0; stage.at.u.len()],
        ..State::default()
    };
    let still = Stage {
        from: &rest,
        at: &rest,
        dt: stage.dt,
        rate: None,
        frames: stage.frames,
    };
    let gaps = all_gaps_at(&mut interface.force(state, &Conditions::default()), &still);
    let within = interface.initial.within.unwrap_or(GLUE);
    let near = |(gap, p): (f64, &ContactPoint)| {
        if gap.abs() <= within.of(p.size) {
            gap
        } else {
            f64::NAN
        }
    };
    let glued = gaps.into_iter().zip(&interface.points).map(near).collect();
    Arc::make_mut(&mut state.start).glued = glued;
}
