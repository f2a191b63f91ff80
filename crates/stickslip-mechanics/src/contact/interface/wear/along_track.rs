//! An interface over a track: what lies open beneath its points, and what they take.

use std::collections::{BTreeMap, HashMap};

use super::super::belt::belt_gone;
use super::super::definition::{InterfaceDefinition, Primary};
use super::super::evaluation::Evaluations;
use super::super::history::History;
use super::super::input::InterfaceInput;
use super::super::scene::Scene;
use super::super::sides::facet_weights;
use crate::contact::obstacle::{Place, Pose};
use crate::contact::worn::track::Under;
use crate::math::{Vec3, add, add_scaled, norm, scale, sub};
use crate::system::Stage;

/// By how much what lies opposite a point has moved, of coordinates of all nodes.
fn opposite_moved(
    interface: &InterfaceDefinition,
    opposite: impl Iterator<Item = (usize, f64)>,
    x: &[Vec3],
) -> Vec3 {
    opposite.fold([0.0; 3], |sum, (n, w)| {
        add_scaled(sum, w, sub(x[n], interface.reference[n]))
    })
}

/// The depth of the track beneath a point, which lies over the nodes of `sides` `[m]`.
pub(super) fn track_depth(i: usize, scene: &Scene, sides: &[(usize, f64)]) -> f64 {
    let interface = scene.interface;
    let places = &interface.state.worn.track.places;
    let (Some(track), false) = (&interface.opposite_wear.track, places.is_empty()) else {
        return 0.0;
    };
    let x = &scene.geometry.x;
    let theirs = sides.iter().filter(|(n, _)| *n < interface.primary_nodes);
    let moved = opposite_moved(&interface, theirs.map(|&(n, w)| (n, -w)), x);
    let under = Under {
        pose: scene.poses.map(|(pose, _)| *pose),
        moved: add(moved, belt_gone(interface, scene.t)),
    };
    let beneath = track.beneath(i, x, &under);
    beneath
        .map(|(place, w)| w * places.get(&place).copied().unwrap_or(0.0))
        .sum()
}

/// Takes from the track what points have worn off it over an increment, along their ways.
pub(in crate::contact) fn wear_track(
    input: InterfaceInput,
    last: &Evaluations,
    volumes: &[f64],
    stage: &Stage,
    next: &mut History,
) {
    let Some(track) = &input.definition.opposite_wear.track else {
        return;
    };
    let ways = last.points.iter().zip(volumes);
    let ways = ways.filter(|(_, v)| **v != 0.0).map(|(e, _)| norm(e.moved));
    let longest = ways.fold(0.0, f64::max);
    // One part along the distance of two places, and at most so many.
    let parts = (longest / track.chart.spacing()).ceil().clamp(1.0, 4096.0);
    let [from, to] = [&stage.from.u, &stage.at.u].map(|u| input.coordinates(u));
    let mut lost: HashMap<Place, f64> = HashMap::new();
    for part in 0..parts as usize {
        let part = (part as f64 + 0.5) / parts;
        let between = |(a, b): (&Vec3, &Vec3)| add_scaled(scale(1.0 - part, *a), part, *b);
        let x: Vec<Vec3> = from.iter().zip(&to).map(between).collect();
        let t = stage.from.t + part * (stage.at.t - stage.from.t);
        let (pose, gone) = (pose(&input, t), belt_gone(input, t));
        for (i, volume) in volumes.iter().enumerate().filter(|(_, v)| **v != 0.0) {
            let moved = add(
                gone,
                opposite_moved(&input, facet_weights(input.primary_nodes, last, i), &x),
            );
            let under = Under { pose, moved };
            for (place, w) in track.beneath(i, &x, &under).filter(|(_, w)| *w != 0.0) {
                *lost.entry(place).or_default() += w * volume / parts;
            }
        }
    }
    let gained: BTreeMap<Place, f64> = (lost.into_iter())
        .map(|(place, volume)| (place, volume / track.chart.area(place, track.extent)))
        .collect();
    let felt = feels(input, last, &gained, volumes, &to, stage.at.t);
    let depths = &mut next.worn.track;
    for (place, depth) in gained {
        *depths.places.entry(place).or_default() += depth;
    }
    depths.taken.resize(volumes.len(), 0.0);
    for (taken, volume) in depths.taken.iter_mut().zip(volumes) {
        *taken += volume;
    }
    depths.felt = felt;
    show_track(input, stage.at.t, next);
}

/// What lies open beneath each point at the end of an increment in which the track `gained` depths, over what the point has taken per area: one where it stays on its track, little where
/// it comes on matter that others have not worn.
fn feels(
    interface: InterfaceInput,
    last: &Evaluations,
    gained: &BTreeMap<Place, f64>,
    volumes: &[f64],
    x: &[Vec3],
    t: f64,
) -> Vec<f64> {
    let Some(track) = &interface.opposite_wear.track else {
        return Vec::new();
    };
    let (pose, gone) = (pose(&interface, t), belt_gone(interface, t));
    let feels = |(i, volume): (usize, &f64)| {
        let own = volume / last.points[i].area;
        if !(own.is_finite() && own > 0.0) {
            return 1.0;
        }
        let moved = add(
            gone,
            opposite_moved(
                &interface,
                facet_weights(interface.primary_nodes, last, i),
                x,
            ),
        );
        let under = Under { pose, moved };
        let beneath = track.beneath(i, x, &under);
        let here = beneath.map(|(place, w)| w * gained.get(&place).copied().unwrap_or(0.0));
        (here.sum::<f64>() / own).clamp(0.0, 1.0)
    };
    volumes.iter().enumerate().map(feels).collect()
}

/// Where an obstacle is.
fn pose(interface: &InterfaceDefinition, t: f64) -> Option<Pose> {
    match &interface.primary {
        Primary::Rigid(_, motion) => Some(motion.pose(t)),
        Primary::Facets(_) => None,
    }
}

/// Gives the nodes of the primary the depth of the matter that is there now.
fn show_track(interface: InterfaceInput, t: f64, next: &mut History) {
    let (Some(track), false) = (&interface.opposite_wear.track, interface.rigid()) else {
        return;
    };
    let gone = belt_gone(interface, t);
    let places = &next.worn.track.places;
    let depth = |x: &Vec3| -> f64 {
        let around = track.chart.around(sub(*x, gone)).into_iter();
        around
            .map(|(place, w)| w * places.get(&place).copied().unwrap_or(0.0))
            .sum()
    };
    let shown: Vec<f64> = interface.reference[..interface.primary_nodes]
        .iter()
        .map(depth)
        .collect();
    let depths = &mut next.worn.opposite;
    depths.resize(interface.nodes.len(), 0.0);
    depths[..shown.len()].copy_from_slice(&shown);
}
