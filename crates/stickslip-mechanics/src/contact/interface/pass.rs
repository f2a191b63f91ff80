//! An evaluation of all points of an interface.

use super::belt::{belt_path, belt_velocity, poses};
use super::cache::{Cache, Geometry};
use super::candidates::enclose;
use super::evaluate::evaluate_points;
use super::evaluation::{Batch, EVALUATED_PER_TASK, Evaluation, Evaluations};
use super::faces::integrate_faces;
use super::input::InterfaceInput;
use super::parts::InterfaceForce;
use super::scene::{LawQuery, Scene, Wants};
use super::user_laws::ask;
use crate::math::scale;
use crate::system::{Force, InSpace, Stage};

/// Evaluates all points; what comes out is the trial of the cache.
pub(super) fn evaluate_all<'a>(
    interface: InterfaceInput,
    cache: &'a mut Cache,
    stage: &Stage,
    wants: Wants,
) -> &'a Evaluations {
    let Cache {
        last,
        trial,
        anchors,
        geometry,
        ..
    } = cache;
    move_to(interface, geometry, stage, wants);
    let count = interface.points.len();
    anchors.resize(count, None);
    trial.points.resize(count, Evaluation::default());
    trial
        .batches
        .resize_with(count.div_ceil(EVALUATED_PER_TASK), Batch::default);
    let poses = poses(&interface, stage);
    let scene = Scene {
        interface,
        geometry,
        last: &last.points,
        poses: poses.as_ref(),
        belt: belt_path(interface, stage),
        belt_end: scale(stage.dt, belt_velocity(interface, stage.at.t)),
        rate: stage.rate,
        dt: stage.dt,
        t: stage.at.t,
        wants,
        answers: &[],
        query: LawQuery::Nothing,
    };
    let answers = ask(&scene, trial, anchors);
    let scene = Scene {
        answers: &answers,
        ..scene
    };
    evaluate_points(&scene, trial, anchors);
    trial
}

/// Finds out where the surfaces are at a stage, and what lies opposite.
fn move_to(interface: InterfaceInput, geometry: &mut Geometry, stage: &Stage, wants: Wants) {
    let frames = interface.frames_at(stage);
    interface.coordinates_into(frames, &stage.at.u, &mut geometry.x);
    interface.coordinates_into(frames, &stage.from.u, &mut geometry.before);
    if !frames.is_empty() {
        let places = (interface.nodes.iter().copied()).zip(geometry.x.iter().copied());
        let poses = interface.poses_of(frames, &stage.at.u);
        geometry.in_space = InSpace::new(frames, poses, places);
    } else if !geometry.in_space.is_empty() {
        geometry.in_space = InSpace::default();
    }
    if interface.mortar.is_some() {
        integrate_faces(interface, geometry, wants);
    } else if !interface.kinematics.as_dyn().frozen() {
        enclose(interface.definition, &geometry.x, &mut geometry.bounds);
    }
}

/// Gaps of all points at a stage, without touching the history; infinite where nothing lies opposite.
pub fn gaps_at(interface: &mut InterfaceForce, stage: &Stage) -> Vec<f64> {
    gaps_with(interface, stage, Wants::default())
}

/// The same of all points, those too that do not take part.
pub(super) fn all_gaps_at(interface: &mut InterfaceForce, stage: &Stage) -> Vec<f64> {
    let wants = Wants {
        everywhere: true,
        ..Wants::default()
    };
    gaps_with(interface, stage, wants)
}

fn gaps_with(interface: &mut InterfaceForce, stage: &Stage, wants: Wants) -> Vec<f64> {
    interface.prepare(stage);
    interface.begin();
    let (input, cache) = interface.parts();
    let evaluations = evaluate_all(input, cache, stage, wants);
    evaluations
        .points
        .iter()
        .map(Evaluation::known_gap)
        .collect()
}
