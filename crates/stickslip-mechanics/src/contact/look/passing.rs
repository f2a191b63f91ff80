//! Bodies that go through each other within an increment.
//!
//! Where nothing but contact holds an axle, an iteration in which contact lets go may turn it by any angle, and what is found there may be an equilibrium as good as any: gears fit again
//! some teeth on. But the way there leads through the teeth: between the two ends of the increment the bodies overlap, by more than at either of them.

use super::between::lowest;
use crate::contact::interface::Primary;
use crate::contact::interface::view::ContactView;
use crate::math::distance;

/// Parts of the way at which it is: by no whole number of teeth from one to the next, whatever the number of teeth that it is long.
const PLACES_ON_THE_WAY: [f64; 4] = [0.236, 0.382, 0.618, 0.854];

/// By how much more than at either end its sides overlap on the straight way between two displacements by dof and times `[m]`; `None` where they do not, and where they go too
/// short a way to miss anything.
pub fn tunnels(
    contact: ContactView,
    [from, to]: [&[f64]; 2],
    [before, after]: [f64; 2],
) -> Option<f64> {
    let there = !contact.laws.tied && contact.schedule.active(after) && !contact.skin.is_empty();
    if !there || !contact.turns {
        return None;
    }
    let ends = [contact.coordinates(from), contact.coordinates(to)];
    let size = contact.facet_size();
    let ways = ends[0].iter().zip(&ends[1]).map(|(&a, &b)| distance(a, b));
    let turned = match &contact.primary {
        Primary::Facets(_) => 0.0,
        Primary::Rigid(_, motion) => {
            let poses = [motion.pose(before), motion.pose(after)];
            let moved = ends[1].iter().map(|&x| {
                let carried = poses[1].outward(poses[0].inward(x));
                distance(x, carried)
            });
            moved.fold(0.0, f64::max)
        }
    };
    // The way of surfaces is looked at once they go ten facets: where they go less, a tooth cannot be missed.
    if ways.fold(turned, f64::max) <= 10.0 * size {
        return None;
    }
    let least = |x: &[_], t: f64| lowest(contact, x, t).into_iter().fold(0.0, f64::min);
    let at_ends = least(&ends[0], before).min(least(&ends[1], after));
    let deepest = PLACES_ON_THE_WAY
        .into_iter()
        .fold(at_ends, |deepest: f64, part| {
            let mean = |a: f64, b: f64| a + part * (b - a);
            let u: Vec<f64> = from.iter().zip(to).map(|(&a, &b)| mean(a, b)).collect();
            deepest.min(least(&contact.coordinates(&u), mean(before, after)))
        });
    let deeper = at_ends - deepest;
    // An overlap on the way of less than a facet is none: what is straight in one frame is not in another.
    (deeper > size).then_some(deeper)
}
