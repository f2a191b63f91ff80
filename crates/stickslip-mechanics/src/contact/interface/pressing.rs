//! Where an interface presses, for those who know what moves its sides.

use super::definition::Interface;
use crate::math::{Vec3, add};

/// A contact point that presses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pressing {
    /// Its place in the reference configuration `[m]`.
    pub place: Vec3,
    /// The normal out of the primary.
    pub normal: Vec3,
    /// Force of the pressure `[N]`.
    pub force: f64,
    /// A mesh point of the secondary, and one of the primary that lies opposite; none on an obstacle.
    pub sides: [Option<usize>; 2],
}

impl Interface {
    /// The points that press at the last committed state.
    pub fn pressing(&self) -> Vec<Pressing> {
        let committed = self.history.points.iter().enumerate();
        let pressed = committed.filter(|(_, h)| self.history.acting && h.pressure > 0.0);
        let found = pressed.map(|(i, h)| {
            let point = &self.points[i];
            let opposite = self.history.opposite.of(i).first();
            Pressing {
                place: add(point.position(&self.reference), self.origin),
                normal: h.normal,
                force: self.area_of(i) * h.pressure,
                sides: [
                    point.nodes.first().map(|&n| self.nodes[n]),
                    opposite.map(|&(n, _)| self.nodes[n]),
                ],
            }
        });
        found.collect()
    }
}
