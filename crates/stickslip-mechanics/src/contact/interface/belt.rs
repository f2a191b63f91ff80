//! How the surface of the primary moves beyond its body, and where an obstacle is.

use super::definition::{InterfaceDefinition, Primary};
use super::input::InterfaceInput;
use crate::contact::obstacle::Pose;
use crate::math::{Vec3, add, add_scaled, cross, scale, sub};
use crate::system::{Amplitude, Stage};

/// Velocity of the belt.
pub(super) fn belt_velocity(interface: InterfaceInput, t: f64) -> Vec3 {
    if interface.belt.is_empty() {
        return [0.0; 3];
    }
    std::array::from_fn(|i| {
        let rows = interface.belt.iter();
        let table = rows.map(|row| [row[0], row[i + 1] * interface.conditions.pace]);
        Amplitude::new(table.collect()).map_or(0.0, |v| v.at(t))
    })
}

/// Velocity of the surface of the primary at a place, counted from the origin of the interface, in sliding that lasts.
pub(super) fn steady_velocity(interface: InterfaceInput, x: Vec3, t: f64) -> Vec3 {
    let belt = belt_velocity(interface, t);
    match interface.conditions.steady {
        None => belt,
        Some(steady) => {
            let arm = sub(add(interface.origin, x), steady.centre);
            add(add(belt, steady.velocity), cross(steady.turning, arm))
        }
    }
}

/// Belt displacement over the increment; exact, as increments land on the rows of its table.
pub(super) fn belt_path(interface: InterfaceInput, stage: &Stage) -> Vec3 {
    let sum = add(
        belt_velocity(interface, stage.from.t),
        belt_velocity(interface, stage.at.t),
    );
    scale(0.5 * stage.dt, sum)
}

/// How far the belt has gone at a time, counted from the first row of its table `[m]`.
pub(super) fn belt_gone(interface: InterfaceInput, t: f64) -> Vec3 {
    let (Some(first), Some(last)) = (interface.belt.first(), interface.belt.last()) else {
        return [0.0; 3];
    };
    let velocity = |row: &[f64; 4]| [1, 2, 3].map(|k| row[k] * interface.conditions.pace);
    let mut gone = scale((t - first[0]).min(0.0), velocity(first));
    for pair in interface.belt.windows(2) {
        let dt = t.clamp(pair[0][0], pair[1][0]) - pair[0][0];
        let mean = add(
            velocity(&pair[0]),
            belt_velocity(interface, pair[0][0] + dt),
        );
        gone = add_scaled(gone, 0.5 * dt, mean);
    }
    add_scaled(gone, (t - last[0]).max(0.0), velocity(last))
}

/// Pose of the obstacle now and at the last accepted state.
pub(super) fn poses(definition: &InterfaceDefinition, stage: &Stage) -> Option<(Pose, Pose)> {
    match &definition.primary {
        Primary::Rigid(_, motion) => Some((motion.pose(stage.at.t), motion.pose(stage.from.t))),
        Primary::Facets(_) => None,
    }
}
