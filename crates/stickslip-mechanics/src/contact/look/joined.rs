//! Where surfaces are pressed together, as those need it who let something flow from one to the other.

use crate::contact::interface::view::ContactView;

/// A contact point that presses, between the mesh points of both sides.
#[derive(Debug, Clone, PartialEq)]
pub struct Joined {
    /// Pressure `[Pa]`.
    pub pressure: f64,
    /// Area that the point stands for `[m²]`.
    pub area: f64,
    /// Mesh points of the secondary with weights that add up to one.
    pub secondary: Vec<(usize, f64)>,
    /// Mesh points of the primary opposite, with weights that add up to one; none on an obstacle.
    pub primary: Vec<(usize, f64)>,
}

/// The points that press at the last committed state.
pub fn joined(contact: ContactView) -> Vec<Joined> {
    let committed = contact.state.points.iter().enumerate();
    let pressed = committed.filter(|(_, h)| contact.state.acting && h.pressure > 0.0);
    let of = |(node, w): (usize, f64)| (contact.nodes[node], w);
    let found = pressed.map(|(i, h)| Joined {
        pressure: h.pressure,
        area: contact.area_of(i),
        secondary: contact.own_weights(i).map(of).collect(),
        primary: contact
            .state
            .opposite
            .of(i)
            .iter()
            .copied()
            .map(of)
            .collect(),
    });
    found.collect()
}
