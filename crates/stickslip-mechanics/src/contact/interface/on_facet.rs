//! A contact point over a facet.

use super::cache::Cache;
use super::candidates::{Places, closest};
use super::clamped::clamped_pair;
use super::evaluation::{Batch, Evaluation, FacetContact};
use super::finish::finish;
use super::input::InterfaceInput;
use super::respond::respond;
use super::scene::{Met, Scene};
use crate::contact::facet_point::{FACET_NODES, FacetPoint, evaluate};
use crate::contact::kinematics::Pair;
use crate::contact::pairing::{Anchor, Previous};
use crate::contact::surface::Facet;
use crate::math::{Vec3, add, add_scaled, dot, norm, sub};

/// How often a point may slide off an outer edge before it stays off.
pub(super) const MOST_LEFT: usize = 2;

/// A point that no facet carries.
struct NoProjection {
    /// From the surface `[m]`.
    distance: f64,
    /// It stays off the outer edge, but lies beneath the surface.
    off_edge: bool,
}

/// The place on a facet that moves with it.
fn material(foot: &FacetPoint, nodes: &[Vec3]) -> Vec3 {
    let weighted = nodes.iter().zip(&foot.n);
    weighted.fold([0.0; 3], |s, (&x, &n)| add_scaled(s, n, x))
}

pub(super) fn evaluate_facet(
    i: usize,
    facets: &[Facet],
    scene: &Scene,
    anchor: &mut Option<Anchor>,
    batch: &mut Batch,
) -> Evaluation {
    let interface = scene.interface;
    let (point, geometry) = (&interface.points[i], scene.geometry);
    let kinematics = interface.kinematics.as_dyn();
    let mut position = point.position(&geometry.x);
    let mut position_before = point.position(&geometry.before);
    let (f, foot) = match facet_of(i, facets, scene, anchor) {
        Ok(found) => found,
        Err(off) => {
            return Evaluation {
                foot: FacetContact {
                    off_edge: off.off_edge,
                    ..FacetContact::default()
                },
                ..Evaluation::open(off.distance)
            };
        }
    };
    let facet = &facets[f];
    let mut now = [[0.0; 3]; FACET_NODES];
    let now = facet.gather(&geometry.x, &mut now);
    let anchor = if kinematics.frozen() {
        // relative to the material place of the frozen foot
        let mut then = [[0.0; 3]; FACET_NODES];
        let then = facet.gather(&geometry.before, &mut then);
        position = add(foot.x, sub(position, material(&foot, now)));
        position_before = add(foot.x, sub(position_before, material(&foot, then)));
        &foot
    } else {
        match Anchor::at(anchor, f, facet, &geometry.before, position_before) {
            Some(anchor) => anchor,
            None => return Evaluation::open(dot(sub(position, foot.x), foot.normal)),
        }
    };
    let pair = Pair {
        dim: interface.dofs.dim,
        weights: &point.weights,
        point: position,
        kind: facet.kind,
        facet: now,
        foot: &foot,
        anchor,
        point_before: position_before,
        belt: scene.belt_seen(),
    };
    kinematics.stencil(&pair, &mut batch.stencil);
    let largest = now.iter().map(|&x| dot(x, x));
    batch.stencil.coordinate_scale = largest.fold(dot(position, position), f64::max).sqrt();
    let met = Met {
        i,
        area: point.area,
        sides: batch.sides.len(),
    };
    batch.sides.extend(interface.own_weights(i));
    let theirs = facet.nodes.iter().copied().zip(foot.n.iter().map(|n| -n));
    batch.sides.extend(theirs);
    if clamped_pair(&interface, &batch.sides[met.sides..], foot.normal) {
        batch.sides.truncate(met.sides);
        return Evaluation::open(f64::INFINITY);
    }
    let mut e = respond(met, scene, batch);
    e.foot.facet = Some(f);
    e.foot.xi = foot.xi;
    finish(scene, &mut e, batch);
    e
}

/// The second derivatives of gap and slips of a point over a facet, weighted by what it carries; shape `(n, n)`. `None` if it carries nothing.
pub(super) fn curvature_of_point(
    interface: InterfaceInput,
    i: usize,
    facets: &[Facet],
    cache: &Cache,
) -> Option<Vec<f64>> {
    let (point, geometry) = (&interface.points[i], &cache.geometry);
    let e = cache.last.points.get(i)?;
    let traction = if interface.unknown() {
        e.kept.multiplier
    } else {
        e.response.traction
    };
    if e.slots.rows.is_none() || traction == [0.0; 3] {
        return None;
    }
    let f = e.foot.facet?;
    let facet = &facets[f];
    let point_before = point.position(&geometry.before);
    let mut kept = cache.anchors.get(i).cloned().flatten();
    let mut nodes = [[0.0; 3]; FACET_NODES];
    let now = facet.gather(&geometry.x, &mut nodes);
    let pair = Pair {
        dim: interface.dofs.dim,
        weights: &point.weights,
        point: point.position(&geometry.x),
        kind: facet.kind,
        facet: now,
        foot: &evaluate(facet.kind, now, e.foot.xi),
        anchor: Anchor::at(&mut kept, f, facet, &geometry.before, point_before)?,
        point_before,
        // The way of the belt curves nothing.
        belt: [0.0; 3],
    };
    let mut out = vec![0.0; pair.dofs() * pair.dofs()];
    let weights = traction.map(|t| -e.area * t);
    interface
        .kinematics
        .as_dyn()
        .add_hessian(&pair, weights, &mut out);
    Some(out)
}

/// The facet of a point and its projection there; where it is if it has none.
fn facet_of(
    i: usize,
    facets: &[Facet],
    scene: &Scene,
    anchor: &mut Option<Anchor>,
) -> Result<(usize, FacetPoint), NoProjection> {
    let interface = scene.interface;
    let geometry = scene.geometry;
    let found = if interface.kinematics.as_dyn().frozen() {
        geometry.frozen[i].ok_or(f64::INFINITY)
    } else {
        let facet = scene.last.get(i).and_then(|e| e.foot.facet);
        let facet = facet.or(interface.state.points[i].facet);
        // The projection starts from that at the last accepted state, not from that of the last iteration: what comes out must not
        // depend on the way to it.
        let near = facet.and_then(|f| {
            let before = interface.points[i].position(&geometry.before);
            let foot = Anchor::at(anchor, f, &facets[f], &geometry.before, before);
            foot.map(|foot| foot.xi)
        });
        let held = interface.attempt.flips[i].oscillates();
        let previous = Previous { facet, near, held };
        let places = Places {
            x: &geometry.x,
            before: &geometry.before,
            bounds: &geometry.bounds,
        };
        closest(interface.definition, i, places, &geometry.search, previous)
    };
    // Where an earlier point that moves alike carries, this one has nothing to do.
    let earlier = interface.alike.get(i).map_or(&[][..], Vec::as_slice);
    let carries = |&j: &usize| facet_of(j, facets, scene, &mut None).is_ok();
    if found.is_ok() && earlier.iter().any(carries) {
        return Err(NoProjection {
            distance: f64::INFINITY,
            off_edge: false,
        });
    }
    match found {
        // At an outer edge there may be no solution with the point on it and none with it off: after the second time it stays
        // off until the rest has settled, and if it leaves twice again until the next increment.
        Ok((_, p)) if interface.attempt.flips[i].left >= MOST_LEFT => {
            let away = sub(interface.points[i].position(&geometry.x), p.x);
            Err(NoProjection {
                distance: norm(away),
                off_edge: dot(away, p.normal) < 0.0,
            })
        }
        found => found.map_err(|distance| NoProjection {
            distance,
            off_edge: false,
        }),
    }
}
