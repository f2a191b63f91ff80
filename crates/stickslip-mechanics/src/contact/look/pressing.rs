//! Where an interface presses, for those who know what moves its sides.

use crate::contact::interface::view::ContactView;
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

/// The points that press at the last committed state.
pub fn pressing(contact: ContactView) -> Vec<Pressing> {
    let committed = contact.state.points.iter().enumerate();
    let pressed = committed.filter(|(_, h)| contact.state.acting && h.pressure > 0.0);
    let found = pressed.map(|(i, h)| {
        let point = &contact.points[i];
        let opposite = contact.state.opposite.of(i).first();
        Pressing {
            place: add(point.position(&contact.reference), contact.origin),
            normal: h.normal,
            force: contact.area_of(i) * h.pressure,
            sides: [
                point.nodes.first().map(|&n| contact.nodes[n]),
                opposite.map(|&(n, _)| contact.nodes[n]),
            ],
        }
    });
    found.collect()
}
