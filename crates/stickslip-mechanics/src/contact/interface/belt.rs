//! How the surface of the primary moves beyond its body, and where an obstacle is.

use super::definition::Primary;
use super::parts::Interface;
use crate::contact::obstacle::Pose;
use crate::math::{Vec3, add, cross, scale, sub};
use crate::system::{Amplitude, Stage};

impl Interface {
    /// Velocity of the belt.
    pub(super) fn belt_velocity(&self, t: f64) -> Vec3 {
        if self.belt.is_empty() {
            return [0.0; 3];
        }
        std::array::from_fn(|i| {
            let table = self.belt.iter().map(|row| [row[0], row[i + 1]]).collect();
            Amplitude::new(table).map_or(0.0, |v| v.at(t))
        })
    }

    /// Velocity of the surface of the primary at a place, counted from the origin of the interface, in sliding that lasts.
    pub(super) fn steady_velocity(&self, x: Vec3, t: f64) -> Vec3 {
        let belt = self.belt_velocity(t);
        match self.directives.steady {
            None => belt,
            Some(steady) => {
                let arm = sub(add(self.origin, x), steady.centre);
                add(add(belt, steady.velocity), cross(steady.turning, arm))
            }
        }
    }

    /// Belt displacement over the increment; exact, as increments land on the rows of its table.
    pub(super) fn belt_path(&self, stage: &Stage) -> Vec3 {
        let sum = add(
            self.belt_velocity(stage.from.t),
            self.belt_velocity(stage.at.t),
        );
        scale(0.5 * stage.dt, sum)
    }

    /// Pose of the obstacle now and at the last accepted state.
    pub(super) fn poses(&self, stage: &Stage) -> Option<(Pose, Pose)> {
        match &self.primary {
            Primary::Rigid(_, motion) => Some((motion.pose(stage.at.t), motion.pose(stage.from.t))),
            Primary::Facets(_) => None,
        }
    }
}
