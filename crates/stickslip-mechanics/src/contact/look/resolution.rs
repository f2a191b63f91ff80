//! Whether the points in contact are enough to tell where contact is.

use crate::contact::interface::view::ContactView;
use crate::contact::response::Status;

/// How finely contact is resolved.
#[derive(Debug, Clone, Copy, Default, PartialEq, crate::keep::Keep)]
pub struct Resolution {
    /// Points in contact.
    pub points: usize,
    /// Of all points.
    pub of: usize,
    /// Part of the force that is carried where contact is at least three points across `[-]`.
    pub resolved: f64,
}

/// How finely contact is resolved at the last committed state; `None` where nothing is in contact or it is not known which points lie
/// beside each other.
///
/// A patch is three points across where one of them has nothing but points in contact beside it. Surfaces in contact all over are resolved
/// by any mesh.
pub fn resolution(contact: ContactView) -> Option<Resolution> {
    let committed = &contact.state.points;
    let count = contact.points.len();
    if committed.len() != count || contact.neighbours.len() != count {
        return None;
    }
    let closed: Vec<bool> = (committed.iter())
        .map(|h| h.status != Status::Open)
        .collect();
    let points = closed.iter().filter(|&&c| c).count();
    if points == 0 {
        return None;
    }
    let inner = |i: usize| closed[i] && contact.neighbours[i].iter().all(|&j| closed[j]);
    let (mut all, mut resolved) = (0.0, 0.0);
    for i in (0..count).filter(|&i| closed[i]) {
        let force = contact.area_of(i) * committed[i].pressure.abs();
        all += force;
        if inner(i) || contact.neighbours[i].iter().any(|&j| inner(j)) {
            resolved += force;
        }
    }
    (all > 0.0).then(|| Resolution {
        points,
        of: count,
        resolved: if points == count { 1.0 } else { resolved / all },
    })
}
