//! Curved surfaces whose cells are larger than any contact between them can be.

use std::collections::BTreeMap;

use super::super::finding::{DoctorCause, Finding};
use super::super::suspect::Suspect;
use super::common::{median, roles, sides};
use crate::contact::facet_point::evaluate;
use crate::contact::interface::{InterfaceDefinition, Primary};
use crate::contact::look::{Opposite, coordinates};
use crate::contact::surface::spacing;
use crate::contact::surface::{EDGE_ANGLE, Facet, edges};
use crate::math::{Vec3, add, dot, norm, normalize, scale, sub};
use crate::model::definition::Model;

/// Half width of contact over the radius of curvature at which strains are no longer small: a line of contact has a largest pressure of half of that
/// part of the contact modulus (Johnson 1985, eq. 4.43 and 4.45).
pub const WIDEST_CONTACT: f64 = 0.2;

/// Places that are looked at, at least.
const LEAST: usize = 4;

/// Two facets beside each other.
struct Bend {
    facets: [usize; 2],
    /// Between their centres, and the direction from one to the other.
    x: Vec3,
    along: Vec3,
    /// Distance of the nodes along it `[m]`.
    spacing: f64,
    /// Positive where the body is convex `[1/m]`.
    curvature: f64,
}

/// How a surface bends from facet to facet, but for edges of the body.
fn bends(facets: &[&Facet], interface: &InterfaceDefinition) -> Vec<Bend> {
    let mut shared: BTreeMap<Vec<usize>, Vec<usize>> = BTreeMap::new();
    for (f, facet) in facets.iter().enumerate() {
        for edge in edges(facet.kind) {
            let mut key: Vec<usize> = edge.iter().map(|&i| facet.nodes[i]).collect();
            key.sort_unstable();
            shared.entry(key).or_default().push(f);
        }
    }
    let centre = |f: usize| {
        let facet = facets[f];
        let [s, t, _] = facet.kind.centre();
        evaluate(facet.kind, &coordinates(interface, facet), [s, t])
    };
    let bend = |pair: &Vec<usize>| {
        let &[i, j] = pair.as_slice() else {
            return None;
        };
        let (a, b) = (centre(i), centre(j));
        let (way, turn) = (sub(b.x, a.x), sub(b.normal, a.normal));
        let along = normalize(way)?;
        let length = norm(way);
        let angle = 2.0 * (0.5 * norm(turn)).min(1.0).asin();
        (angle < EDGE_ANGLE).then(|| Bend {
            facets: [i, j],
            x: scale(0.5, add(a.x, b.x)),
            along,
            spacing: length / facets[i].kind.order().max(1) as f64,
            curvature: dot(turn, along).signum() * angle / length,
        })
    };
    shared.values().filter_map(bend).collect()
}

/// Spacing and curvature opposite a place along a direction: of the facets there, or of an obstacle, which has no spacing.
fn across(
    interface: &InterfaceDefinition,
    opposite: &mut Opposite,
    bend: &Bend,
    by_facet: &BTreeMap<usize, Vec<&Bend>>,
) -> Option<(f64, f64, f64)> {
    let nearest = opposite.nearest(bend.x)?;
    let Primary::Facets(facets) = &interface.primary else {
        let ends = [-0.5, 0.5].map(|s| add(bend.x, scale(s * bend.spacing, bend.along)));
        let [a, b] = ends.map(|x| opposite.nearest(x));
        let turn = sub(b?.normal, a?.normal);
        let curvature = dot(turn, bend.along) / bend.spacing;
        return Some((nearest.distance, 0.0, curvature));
    };
    let cosine = |b: &&Bend| dot(b.along, bend.along).abs();
    let beside = by_facet.get(&nearest.facet).into_iter().flatten().copied();
    let best = beside
        // From this cosine on directions are one.
        .filter(|b| cosine(b) >= 0.7)
        .max_by(|p, q| cosine(p).total_cmp(&cosine(q)));
    Some(match best {
        Some(best) => (nearest.distance, best.spacing, best.curvature),
        None => (
            nearest.distance,
            spacing(&facets[nearest.facet], &interface.reference),
            0.0,
        ),
    })
}

/// A place on the secondary between two of its facets.
struct Between {
    x: Vec3,
    /// To the other side `[m]`.
    away: f64,
    /// Spacings of both sides along the bend `[m]`.
    spacings: [f64; 2],
    /// Curvature between the surfaces, positive where they part beside the place `[1/m]`.
    curvature: f64,
}

/// Places on the secondary that are nearest to the other side.
fn nearest_places(interface: &InterfaceDefinition, t: f64) -> Vec<Between> {
    let ours: Vec<&Facet> = interface.skin.iter().map(|s| &s.facet).collect();
    let theirs: Vec<&Facet> = match &interface.primary {
        Primary::Facets(facets) => facets.iter().collect(),
        Primary::Rigid(..) => Vec::new(),
    };
    let (own, other) = (bends(&ours, interface), bends(&theirs, interface));
    let mut by_facet: BTreeMap<usize, Vec<&Bend>> = BTreeMap::new();
    for bend in &other {
        for f in bend.facets {
            by_facet.entry(f).or_default().push(bend);
        }
    }
    let mut opposite = Opposite::new(interface, t);
    let mut places = Vec::new();
    for bend in &own {
        if let Some((away, spacing, curvature)) = across(interface, &mut opposite, bend, &by_facet)
        {
            places.push(Between {
                x: bend.x,
                away,
                spacings: [bend.spacing, spacing],
                curvature: bend.curvature + curvature,
            });
        }
    }
    places.sort_by(|a, b| a.away.total_cmp(&b.away));
    // The nearest quarter of all places is looked at.
    places.truncate(((0.25 * places.len() as f64) as usize).max(LEAST));
    places
}

/// Where the sides are nearest to each other, and the least curvature between them near there `[1/m]`: below zero one lies in a hollow of the other.
pub(super) fn rest(interface: &InterfaceDefinition, t: f64) -> Option<(Vec3, f64)> {
    let places = nearest_places(interface, t);
    let least = places.iter().map(|p| p.curvature);
    let first = places.first()?;
    Some((first.x, least.fold(f64::INFINITY, f64::min)))
}

pub(super) fn check(model: &Model, interface: &InterfaceDefinition, t: f64) -> Option<Finding> {
    if interface.laws.tied {
        return None;
    }
    let places = nearest_places(interface, t);
    // For each side its spacing over the radius of what lies between the surfaces.
    let over = |p: &Between, side: usize| p.spacings[side] * p.curvature.max(0.0);
    let part = [0, 1].map(|side| median(places.iter().map(|p| over(p, side)).collect()));
    let side = usize::from(part[1] > part[0]);
    let coarse = part[side];
    (coarse > WIDEST_CONTACT).then(|| say(model, interface, side, coarse))
}

fn say(model: &Model, interface: &InterfaceDefinition, side: usize, coarse: f64) -> Finding {
    let name = &interface.name;
    let role = roles(interface)[side];
    let body = sides(model, interface)[side].clone().unwrap_or_default();
    let finding = DoctorCause::CoarseContact.warning(format!(
        "interface {name}: the cells of the {role} (body {body}) are {coarse:.2} of the radius between the curved surfaces; contact that is as wide as small strains allow has fewer than three of its points across"
    ));
    finding
        .blame(Suspect::interface(
            name,
            format!("cells {coarse:.2} of the radius"),
        ))
        .blame(super::super::places::body(model, &body, "coarse"))
        .advise(format!(
            "refine body {body} where it is touched: cells of a tenth of the radius are a beginning"
        ))
}
