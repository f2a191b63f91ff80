//! What sliding has worn off both surfaces, and what it has taken.

use crate::contact::interface::view::ContactView;

/// What sliding has worn off both surfaces.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct WearReport {
    /// Largest depth on the secondary and on the primary `[m]`.
    pub depth: [f64; 2],
    /// Volume lost by the secondary and by the primary `[m³]`.
    pub volume: [f64; 2],
}

/// What the track has lost: its largest depth `[m]` and the volume that the depths make up `[m³]`; `None` where there is none.
pub(super) fn track_lost(contact: ContactView) -> Option<[f64; 2]> {
    let track = contact.opposite_wear.track.as_ref()?;
    let places = contact.state.worn.track.places.iter();
    Some(
        places.fold([0.0, 0.0], |[deepest, volume], (place, depth)| {
            let area = track.chart.area(*place, track.extent);
            [f64::max(deepest, *depth), volume + depth * area]
        }),
    )
}

/// The steepest slope of the track, and its largest depth times its curvature, as it was made.
pub(super) fn track_profile(contact: ContactView) -> [f64; 2] {
    let Some(track) = &contact.opposite_wear.track else {
        return [0.0; 2];
    };
    let places = &contact.state.worn.track.places;
    let mut worst = [0.0_f64; 2];
    for (&place, depth) in places {
        worst[1] = worst[1].max(depth * track.chart.curvature());
        for (next, way) in track.chart.next(place) {
            let other = places.get(&next).filter(|_| way > 0.0);
            worst[0] = other.map_or(worst[0], |o| worst[0].max((depth - o).abs() / way));
        }
    }
    worst
}

/// Depth and volume of wear so far; `None` where it is not followed.
pub fn wear(contact: ContactView) -> Option<WearReport> {
    if !contact.laws.wear.as_dyn().active() {
        return None;
    }
    let worn = &contact.state.worn;
    let nodes = worn.opposite.iter().copied();
    let track = track_lost(contact).map_or(0.0, |[deepest, _]| deepest);
    let mut report = WearReport {
        depth: [worn.deepest_own(), nodes.fold(track, f64::max)],
        volume: worn.volume,
    };
    if contact.exchanged {
        report.depth.reverse();
        report.volume.reverse();
    }
    Some(report)
}

/// Volume that the depths of both sides make up, that with the points first `[m³]`: what the laws say has been lost, to rounding.
pub fn worn_volume(contact: ContactView) -> [f64; 2] {
    let worn = &contact.state.worn;
    let points = 0..contact.points.len();
    let own = points
        .map(|i| worn.own_depth(i) * contact.own_area(i))
        .sum();
    if let Some([_, volume]) = track_lost(contact) {
        return [own, volume];
    }
    let depths = worn.opposite.iter().zip(&contact.opposite_wear.area);
    [own, depths.map(|(depth, area)| depth * area).sum()]
}

/// What sliding has taken so far, place by place: volumes of both sides where one of them wears `[m³]`, otherwise energies `[J]`.
pub fn taken(contact: ContactView) -> Vec<f64> {
    let points = contact.state.points.iter().enumerate();
    if !contact.wears() {
        return points
            .map(|(i, h)| h.dissipated * contact.own_area(i))
            .collect();
    }
    let worn = &contact.state.worn;
    let own = points.map(|(i, _)| worn.own_depth(i) * contact.own_area(i));
    let depths = worn.opposite.iter().zip(&contact.opposite_wear.area);
    let nodes = depths.map(|(depth, area)| depth * area);
    own.chain(nodes)
        .chain(worn.track.taken.iter().copied())
        .collect()
}

/// The places of [`taken`] where something wears: whether they are on the primary, and their areas `[m²]`.
pub fn wear_places(contact: ContactView) -> Vec<(bool, f64)> {
    let areas = || (0..contact.points.len()).map(|i| contact.own_area(i));
    let own = areas().map(|area| (false, area));
    let worn = &contact.state.worn;
    let nodes = worn.opposite.iter().zip(&contact.opposite_wear.area);
    let nodes = nodes.map(|(_, area)| (true, *area));
    own.chain(nodes)
        .chain(areas().map(|area| (true, area)))
        .collect()
}
