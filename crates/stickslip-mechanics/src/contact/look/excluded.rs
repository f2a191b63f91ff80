//! Points that do not take part: what their gaps are all the same.

use crate::contact::interface::candidate_range::gaps;
use crate::contact::interface::view::ContactView;
use crate::contact::interface::{CandidateRange, Conditions};

/// The number of points that do not take part although they penetrate the primary at displacements `u`.
pub fn overlooked(contact: ContactView, conditions: &Conditions, u: &[f64], t: f64) -> usize {
    let gaps = excluded_gaps(contact, conditions, u, t).into_iter();
    let smallest = |i: usize| -1e-9 * contact.points[i].size;
    gaps.filter(|&(i, gap)| gap < smallest(i)).count()
}

/// Points that do not take part, with their gaps at displacements `u` and time `t`.
pub fn excluded_gaps(
    contact: ContactView,
    conditions: &Conditions,
    u: &[f64],
    t: f64,
) -> Vec<(usize, f64)> {
    let excluded = &conditions.candidates.excluded;
    if excluded.is_empty() {
        return Vec::new();
    }
    let here = CandidateRange {
        distance: 0.0,
        along: 0.0,
        span: [t, t],
    };
    let gaps = gaps(contact, &contact.coordinates(u), here).into_iter();
    gaps.enumerate().filter(|(i, _)| excluded[*i]).collect()
}
