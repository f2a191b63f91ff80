//! What the last evaluation says: of the attempt at hand, not of what has been accepted.

use crate::contact::interface::initial::TOUCHING;
use crate::contact::interface::symptoms::LastAttempt;
use crate::contact::interface::{Conditions, History, Interface};
use crate::contact::response::Status;
use crate::system::Tally;

use crate::contact::interface::wear::sliding_distance;

/// How many points have another status in the present attempt than at the last accepted state.
pub fn switched(interface: &Interface, state: &History) -> usize {
    let points = state.points.iter().zip(&interface.cache.last.points);
    points
        .filter(|(h, e)| h.status != e.response.status)
        .count()
}

/// The points by status.
pub fn tally(interface: &Interface) -> Tally {
    LastAttempt::from(interface).tally()
}

/// Whether a point touched or was near at the last evaluation, by the height of the cell beneath it.
pub fn touches(interface: &Interface) -> bool {
    let mut points = interface.cache.trial.points.iter().zip(&interface.points);
    points.any(|(e, point)| e.over && e.gap <= TOUCHING * point.size)
}

/// The longest way `[m]` that a point which presses has slid over the last increment, times the cycles that it stands for: what [`explicit_limit`](super::explicit_limit) is a limit of.
pub fn slid(interface: &Interface, conditions: &Conditions) -> f64 {
    let pressed = (interface.cache.last.points.iter()).filter(|e| e.response.traction[0] > 0.0);
    let ways = pressed
        .map(|e| sliding_distance(&interface.definition, &e.response, e.frames.before, e.moved));
    ways.fold(0.0, f64::max) * conditions.cycles()
}

/// Statuses at the last evaluation, or at the last accepted state where there is none.
pub fn statuses(interface: &Interface, history: &History) -> Vec<Status> {
    let cache = &interface.cache;
    match cache.last.points.is_empty() {
        true => history.points.iter().map(|h| h.status).collect(),
        false => {
            let points = cache.last.points.iter();
            points.map(|e| e.response.status).collect()
        }
    }
}
