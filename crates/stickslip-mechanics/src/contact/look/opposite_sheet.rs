//! The surface that lies opposite the contact points, with what sliding has left on it.

use std::collections::BTreeMap;

use super::sheet::Sheet;
use crate::contact::interface::view::ContactView;
use crate::contact::obstacle::Place;
use crate::contact::worn::WearTrack;
use crate::math::{Vec3, add, sub};
use crate::shape::ElementKind;
use crate::system::{Field, Fields, Location};

/// Fields with one or more numbers a point.
fn fields(all: Vec<(&str, usize, Vec<f64>)>) -> Fields {
    let field = |(name, components, values): (&str, usize, Vec<f64>)| Field {
        name: name.into(),
        location: Location::Point,
        components,
        values,
    };
    Fields {
        all: all.into_iter().map(field).collect(),
    }
}

/// The surface opposite the contact points with U, CDISS and CWEAR, where something wears; of an obstacle, and of a primary whose material moves past, the places that points have worn with CWEAR, in
/// coordinates of the matter, where it was at first. `None` of an obstacle that does not wear. `u`: displacements.
pub fn opposite_sheet(contact: ContactView, u: &[f64]) -> Option<Sheet> {
    match &contact.opposite_wear.track {
        _ if !contact.wears() => None,
        Some(track) => Some(track_sheet(contact, track)),
        None if contact.rigid() => None,
        None => Some(facet_sheet(contact, u)),
    }
}

fn facet_sheet(contact: ContactView, u: &[f64]) -> Sheet {
    let mut places: BTreeMap<usize, usize> = contact.primary_nodes().map(|n| (n, 0)).collect();
    for (k, place) in places.values_mut().enumerate() {
        *place = k;
    }
    let now = contact.coordinates(u);
    let state = contact.state;
    let dissipated = |n: &usize| state.dissipated.get(*n).copied().unwrap_or(0.0);
    let depth = |n: &usize| state.worn.opposite_depth(*n);
    let moved = places
        .keys()
        .flat_map(|&n| sub(now[n], contact.reference[n]));
    let face = |kind: ElementKind, nodes: &[usize]| {
        let corners = nodes.iter().map(|n| places[n]);
        (kind, corners.collect())
    };
    let facets = contact.facets().iter();
    Sheet {
        points: (places
            .keys()
            .map(|&n| add(contact.reference[n], contact.origin)))
        .collect(),
        nodes: places.keys().map(|&n| contact.node_ids[n]).collect(),
        faces: facets.clone().map(|f| face(f.kind, &f.nodes)).collect(),
        cells: facets.map(|f| f.cell).collect(),
        fields: fields(vec![
            ("U", 3, moved.collect()),
            ("CDISS", 1, places.keys().map(dissipated).collect()),
            ("CWEAR", 1, places.keys().map(depth).collect()),
        ]),
    }
}

fn track_sheet(contact: ContactView, track: &WearTrack) -> Sheet {
    let places = &contact.state.worn.track.places;
    let numbers: BTreeMap<Place, usize> = places.keys().copied().zip(0..).collect();
    let position = |[row, at]: Place| -> Vec3 {
        add(track.chart.position(row, f64::from(at)), contact.origin)
    };
    let known = |place: &Place| numbers.get(place).copied();
    let faces = places.keys().filter_map(|place| {
        let beside: Vec<Place> = track.chart.next(*place).map(|(next, _)| next).collect();
        let first = beside.first()?;
        match (contact.dofs.dim, beside.get(1)) {
            (2, _) => Some((ElementKind::Line2, vec![known(place)?, known(first)?])),
            (_, Some(above)) => {
                let corner = [above[0], first[1]];
                let around = [place, first, &corner, above].map(known);
                let corners: Option<Vec<usize>> = around.into_iter().collect();
                Some((ElementKind::Quad4, corners?))
            }
            // Rows of a sphere have each a number of places of their own.
            _ => None,
        }
    });
    let faces: Vec<(ElementKind, Vec<usize>)> = faces.collect();
    Sheet {
        points: places.keys().map(|place| position(*place)).collect(),
        nodes: vec![0; places.len()],
        cells: vec![0; faces.len()],
        faces,
        fields: fields(vec![("CWEAR", 1, places.values().copied().collect())]),
    }
}
