//! How fast and how far surfaces slide, under laws that keep their speed.

use crate::contact::interface::view::ContactView;
use crate::math::norm;

/// Sliding of an interface at an accepted state.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SlidingReport {
    /// Largest speed `[m/s]`.
    pub fastest: f64,
    /// Largest slip so far `[m]`.
    pub farthest: f64,
    /// Slip so far, integrated over the surface `[m³]`: over an earthquake, its potency.
    pub potency: f64,
}

/// How fast and how far surfaces slide; `None` under a law that does not keep its speed.
pub fn sliding(contact: ContactView) -> Option<SlidingReport> {
    let law = contact.laws.friction_law();
    let first = contact.state.law_states.first()?;
    law.speed_in(first)?;
    let mut sliding = SlidingReport::default();
    for (state, point) in contact.state.law_states.iter().zip(&contact.state.points) {
        let slip = norm(point.slip);
        sliding.fastest = sliding.fastest.max(law.speed_in(state).unwrap_or(0.0));
        sliding.farthest = sliding.farthest.max(slip);
        sliding.potency += slip * point.area;
    }
    Some(sliding)
}
