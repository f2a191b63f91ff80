//! Which side of an interface has its points farther apart, where the two are nearest to each other.

use super::between::Side;
use crate::contact::interface::{InterfaceDefinition, Primary};
use crate::contact::surface::{Facet, spacing};

/// Places where cells are compared, at least.
const LEAST: usize = 4;

/// Distance of the points of the secondary over that of the nodes of the primary, where the surfaces are nearest to each other in the reference
/// configuration: above one where the secondary is the coarser side. Where nothing lies opposite all facets count alike. `None` of an obstacle.
pub fn coarser(definition: &InterfaceDefinition) -> Option<f64> {
    let Primary::Facets(theirs) = &definition.primary else {
        return None;
    };
    let theirs: Vec<&Facet> = theirs.iter().collect();
    let ours: Vec<&Facet> = definition.skin.iter().map(|s| &s.facet).collect();
    if ours.is_empty() || theirs.is_empty() {
        return None;
    }
    let x = &definition.reference;
    let spacings =
        |facets: &[&Facet]| -> Vec<f64> { facets.iter().map(|f| spacing(f, x)).collect() };
    let (own, other) = (spacings(&ours), spacings(&theirs));
    let below = Side::new(theirs.clone(), Vec::new(), 0.0, x, x);
    let above = Side::new(ours.clone(), Vec::new(), 0.0, x, x);
    // Gap, ratio and the larger spacing at each place.
    let mut pairs: Vec<[f64; 3]> = Vec::new();
    for (facet, &a) in ours.iter().zip(&own) {
        let met = below.opposite(facet).map(|(k, gap)| (gap, other[k]));
        pairs.extend(met.map(|(gap, b)| [gap, a / b, a.max(b)]));
    }
    for (facet, &b) in theirs.iter().zip(&other) {
        let met = above.opposite(facet).map(|(k, gap)| (gap, own[k]));
        pairs.extend(met.map(|(gap, a)| [gap, a / b, a.max(b)]));
    }
    if pairs.is_empty() {
        return Some(median(own) / median(other));
    }
    pairs.sort_by(|p, q| p[0].total_cmp(&q[0]));
    // Cells are compared at the nearest quarter of all places.
    let count = ((0.25 * pairs.len() as f64) as usize).max(LEAST);
    let [gap, _, size] = pairs[count.min(pairs.len()) - 1];
    // Places are as near as the farthest of these within a thousandth of the spacing.
    pairs.retain(|p| p[0] <= gap + 1e-3 * size);
    Some(median(pairs.iter().map(|p| p[1]).collect()))
}

/// The middle one of some numbers; NaN of none.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
