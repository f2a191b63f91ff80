//! Facets that may belong to the points of an interface, looked for when points have moved, and that which does.

use rayon::prelude::*;

use super::cache::Geometry;
use super::definition::{InterfaceDefinition, Primary};
use super::evaluation::EVALUATED_PER_TASK;
use super::search::Search;
use crate::contact::bounds::Bounds;
use crate::contact::facet_point::FacetPoint;
use crate::contact::kinematics::{Part, rotation_of};
use crate::contact::pairing::{Choice, Previous};
use crate::contact::surface::ContactPoint;
use crate::math::{Vec3, dot, mat_vec};

/// Cosine of the angle up to which a surface looks where it looked in the reference configuration, for finding facets that look back. It is
/// an angle of 18 degrees. Where facets are looked for in the turned direction from the first, 57 of 61 short cases (see [`tolerance`](crate::tolerance)) have
/// the same digits, and all the same history.
const UNTURNED_COSINE: f64 = 0.95;

/// Searches anew when the points have moved so far that a nearer facet might be missing from the candidates.
pub(in crate::contact) fn update_candidates(
    definition: &InterfaceDefinition,
    search: &mut Search,
    x: &[Vec3],
) {
    let Primary::Facets(facets) = &definition.primary else {
        return;
    };
    if search.stale(x) {
        search.renew(&definition.points, facets, x, facing(definition, x));
    }
}

/// Outward normals of the contact points that have turned far since the reference configuration, by their faces; empty if none has.
fn facing(definition: &InterfaceDefinition, x: &[Vec3]) -> Vec<Vec3> {
    let mut around = vec![Vec::new(); definition.points.len()];
    for skin in &definition.skin {
        let corners = &skin.facet.nodes[..skin.facet.kind.corner_count()];
        for &p in &skin.points {
            around[p].push((corners, 1.0));
        }
    }
    let turned = |(point, around): (&ContactPoint, &Vec<Part>)| {
        let parts = around.iter().copied();
        let turn = rotation_of(parts, x, &definition.reference, definition.dofs.dim);
        mat_vec(&turn, point.normal)
    };
    let normals: Vec<Vec3> = definition.points.iter().zip(&around).map(turned).collect();
    let mut pairs = normals.iter().zip(&definition.points);
    match pairs.any(|(n, p)| dot(*n, p.normal) < UNTURNED_COSINE) {
        true => normals,
        false => Vec::new(),
    }
}

/// Bounds of the facets.
pub(super) fn enclose(definition: &InterfaceDefinition, x: &[Vec3], out: &mut Vec<Bounds>) {
    let around = definition
        .facets()
        .par_iter()
        .with_min_len(EVALUATED_PER_TASK);
    around.map(|f| Bounds::around(f, x)).collect_into_vec(out);
}

/// Coordinates at a state and at the accepted one before, nothing where that does not matter, and where the facets lie.
#[derive(Clone, Copy)]
pub(super) struct Places<'a> {
    pub x: &'a [Vec3],
    pub before: &'a [Vec3],
    pub bounds: &'a [Bounds],
}

/// The facet that a point belongs to, of those found by the search, and its projection there; the distance to the surface if it belongs to none.
pub(super) fn closest(
    definition: &InterfaceDefinition,
    i: usize,
    places: Places,
    search: &Search,
    previous: Previous,
) -> Result<(usize, FacetPoint), f64> {
    let turned = search.facing.get(i).copied();
    let choice = Choice {
        facets: definition.facets(),
        bounds: places.bounds,
        candidates: search.candidates.get(i).map_or(&[], Vec::as_slice),
        margin: search.margin,
        x: places.x,
        reference: &definition.reference,
        position: definition.points[i].position(places.x),
        outward: turned.unwrap_or(definition.points[i].normal),
        walls: definition
            .walls
            .of(definition.facets(), &definition.reference),
        before: match places.before.is_empty() {
            true => (places.before, [0.0; 3]),
            false => (places.before, definition.points[i].position(places.before)),
        },
    };
    choice.closest(previous)
}

/// The same of all points, wherever they were.
pub(in crate::contact) fn closest_of_all(
    definition: &InterfaceDefinition,
    x: &[Vec3],
    search: &Search,
) -> Vec<Result<(usize, FacetPoint), f64>> {
    let mut bounds = Vec::new();
    enclose(definition, x, &mut bounds);
    (0..definition.points.len())
        .map(|i| {
            closest(
                definition,
                i,
                Places {
                    x,
                    before: &[],
                    bounds: &bounds,
                },
                search,
                Previous::default(),
            )
        })
        .collect()
}

/// Pairs in the reference configuration, for small sliding.
pub(super) fn pair_reference(definition: &InterfaceDefinition, geometry: &mut Geometry) {
    let needed = definition.mortar.is_none() && definition.kinematics.as_dyn().frozen();
    if !needed || !geometry.frozen.is_empty() {
        return;
    }
    update_candidates(definition, &mut geometry.search, &definition.reference);
    let pairs = closest_of_all(definition, &definition.reference, &geometry.search);
    geometry.frozen = pairs.into_iter().map(Result::ok).collect();
}
