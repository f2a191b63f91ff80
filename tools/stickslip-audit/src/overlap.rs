//! Where the surfaces really are: depth of points of either side in the other, gaps, ties and slip, by own projections.

use std::collections::BTreeMap;

use crate::bulk::Bulk;
use crate::case::kind;
use crate::contact::{Scale, at, points};
use crate::figure::Report;
use crate::law::{depth, laws};
use crate::results::{Before, Results};
use crate::side::{Foot, Pair, Side, foot};
use crate::spring;
use crate::vec3::{Vec3, along, dot, norm, scale, sub, tangential};

/// Checks the places of the surfaces of an interface.
pub fn check(
    results: &Results,
    pair: &Pair,
    sizes: &Scale,
    bulk: Option<&Bulk>,
    report: &mut Report,
) {
    if pair.tied {
        return tied(results, pair, report);
    }
    penetration(results, pair, sizes, 0.0, report);
    gaps(results, pair, sizes, report);
    apart(results, pair, sizes, report);
    slips(results, pair, sizes, bulk, report);
}

/// How deep the surfaces lie in each other beyond what points and laws say. Of a rough surface the real one is up to `rough` off the mesh.
pub fn penetration(results: &Results, pair: &Pair, sizes: &Scale, rough: f64, report: &mut Report) {
    let started = depths(results, pair, None);
    for (i, state) in results.states.iter().enumerate() {
        let step = &results.case.steps[results.case.step_at(state.t)];
        if !step.lists("interfaces", &pair.name) {
            continue;
        }
        let mut deep = depths(results, pair, Some(i));
        if !pair.as_meshed {
            deep = (deep - started).max(0.0);
        }
        // A law that gives way has a depth of its own. A node may have the mean of the points on the faces around it, which is less than that of
        // the deepest of them: as deep as the law says of the largest pressure.
        let own = at(state)
            .into_iter()
            .filter(|p| p.pressure > 0.0)
            .map(|p| -p.gap);
        let most = results.at(&format!("{}.CPRESSMAX", pair.name), state);
        let laws = laws(&results.case, &pair.name, results.case.step_at(state.t));
        let deepest = match laws {
            Some(laws) if most > 0.0 && !pair.damped && !pair.two_sided => depth(laws.normal, most),
            _ => 0.0,
        };
        let allowed = own.fold(deepest, f64::max) + rough;
        let floor = 1e-9 * results.mesh.size(None);
        let beyond = if deep > floor { deep - allowed } else { 0.0 };
        report.note("penetration", &pair.name, beyond / sizes.approach, state.t);
        let beyond = between(results, pair, i) - deep.max(allowed);
        if beyond > floor {
            report.note("between", &pair.name, beyond / sizes.approach, state.t);
        }
    }
}

/// Where everything is at a state, or at the start.
fn places(results: &Results, state: Option<usize>) -> (Vec<Vec3>, f64) {
    match state {
        Some(i) => (results.states[i].places(), results.states[i].t),
        None => (results.mesh.points.clone(), 0.0),
    }
}

/// The largest depth of a point of either side in the other.
fn depths(results: &Results, pair: &Pair, state: Option<usize>) -> f64 {
    let (x, t) = places(results, state);
    let (Side::Body { points, facets }, mesh) = (&pair.secondary, &results.mesh) else {
        return 0.0;
    };
    let depth = |foot: Option<Foot>, reach: f64| match foot {
        Some(foot) if foot.gap < 0.0 && -foot.gap < reach => -foot.gap,
        _ => 0.0,
    };
    let over =
        |points: &std::collections::BTreeSet<usize>, facets: &[crate::mesh::Facet], reach: f64| {
            let each = points
                .iter()
                .map(|p| depth(foot(mesh, facets, &x, x[*p]), reach));
            each.fold(0.0, f64::max)
        };
    let reach = |facets: &[crate::mesh::Facet]| {
        let body = facets.first().map(|f| f.body);
        0.3 * mesh.size(body)
    };
    match &pair.primary {
        Side::Body {
            points: others,
            facets: other,
        } => over(points, other, reach(other)).max(over(others, facets, reach(facets))),
        Side::Rigid(obstacle) => {
            let each = points
                .iter()
                .map(|p| depth(obstacle.foot(x[*p], t), f64::INFINITY));
            each.fold(0.0, f64::max)
        }
    }
}

/// The largest depth of places all over the faces in an obstacle, which may enter between nodes.
fn between(results: &Results, pair: &Pair, state: usize) -> f64 {
    let (Side::Body { facets, .. }, Side::Rigid(obstacle)) = (&pair.secondary, &pair.primary)
    else {
        return 0.0;
    };
    let (x, t) = places(results, Some(state));
    let of = |facet: &crate::mesh::Facet| {
        let corners: Vec<Vec3> = facet.nodes.iter().map(|n| x[*n]).collect();
        let here = |xi| crate::loads::place(facet.kind, &corners, xi);
        let depth = |xi| obstacle.foot(here(xi), t).map_or(0.0, |foot| -foot.gap);
        grid(facet.kind).into_iter().map(depth).fold(0.0, f64::max)
    };
    facets.iter().map(of).fold(0.0, f64::max)
}

/// Own distances of the points of node-to-facet contact and of obstacles.
fn gaps(results: &Results, pair: &Pair, sizes: &Scale, report: &mut Report) {
    if pair.mortar || pair.kinematics == "small-sliding" || !pair.as_meshed {
        return;
    }
    let nodes = points(results, pair);
    for (i, state) in results.states.iter().enumerate() {
        let (x, t) = places(results, Some(i));
        let values = at(state);
        for node in nodes.iter().filter(|n| values[**n].status > 0.0) {
            let distance = |node: usize| match &pair.primary {
                Side::Rigid(obstacle) => Some(obstacle.foot(x[node], t)?.gap),
                Side::Body { facets, .. } => Some(foot(&results.mesh, facets, &x, x[node])?.gap),
            };
            // Over edges and corners there is no foot, and the distance is that to the edge.
            if let Some(gap) = pair.mean(*node, distance) {
                let off = (gap - values[*node].gap).abs();
                report.note("gap", &pair.name, off / sizes.approach, t);
            }
        }
    }
}

/// Where points of mortar contact press though the surfaces stand apart all around them: the mean gap of a point, whose weights are not all positive, may be
/// less than any gap.
fn apart(results: &Results, pair: &Pair, sizes: &Scale, report: &mut Report) {
    let (Side::Body { facets, .. }, Side::Body { facets: other, .. }) =
        (&pair.secondary, &pair.primary)
    else {
        return;
    };
    // Each of two sides presses where the other one finds contact, and what starts closed has gaps of its own.
    if !pair.mortar || pair.two_sided || !pair.as_meshed {
        return;
    }
    let nodes: std::collections::BTreeSet<usize> = points(results, pair).into_iter().collect();
    for (i, state) in results.states.iter().enumerate() {
        let (x, t) = places(results, Some(i));
        let values = at(state);
        let presses = |n: &usize| nodes.contains(n) && values[*n].pressure > 0.0;
        let least = around(&results.mesh, facets, other, &x, presses);
        for (node, (least, covered)) in least {
            let point = &values[node];
            let beyond = least - point.gap;
            if beyond.is_finite() && beyond > 1e-9 * results.mesh.size(None) {
                let weight = covered * point.pressure / sizes.pressure;
                report.note("apart", &pair.name, weight * beyond / sizes.approach, t);
            }
        }
    }
}

/// Of each wanted node the least gap of places all over the facets around it, and the part of them that have something opposite.
fn around(
    mesh: &crate::mesh::Mesh,
    facets: &[crate::mesh::Facet],
    other: &[crate::mesh::Facet],
    x: &[Vec3],
    wanted: impl Fn(&usize) -> bool,
) -> std::collections::BTreeMap<usize, (f64, f64)> {
    let mut found: std::collections::BTreeMap<usize, (f64, usize, usize)> =
        std::collections::BTreeMap::new();
    for facet in facets.iter().filter(|f| f.nodes.iter().any(&wanted)) {
        let corners: Vec<Vec3> = facet.nodes.iter().map(|n| x[*n]).collect();
        let (mut least, mut covered, mut all) = (f64::INFINITY, 0, 0);
        for xi in grid(facet.kind) {
            all += 1;
            let here = crate::loads::place(facet.kind, &corners, xi);
            if let Some(foot) = foot(mesh, other, x, here) {
                covered += 1;
                least = least.min(foot.gap);
            }
        }
        for node in facet.nodes.iter().filter(|n| wanted(n)) {
            let sum = found.entry(*node).or_insert((f64::INFINITY, 0, 0));
            *sum = (sum.0.min(least), sum.1 + covered, sum.2 + all);
        }
    }
    let part = |(n, (least, covered, all)): (usize, (f64, usize, usize))| {
        (n, (least, covered as f64 / f64::max(all as f64, 1.0)))
    };
    found.into_iter().map(part).collect()
}

/// Places all over a facet in its reference coordinates: five along each direction.
fn grid(kind: crate::element::Kind) -> Vec<[f64; 3]> {
    use crate::element::Kind;
    let steps = 0..5u8;
    let unit = |k: u8| f64::from(k) / 4.0;
    let both = |k: u8| 2.0 * unit(k) - 1.0;
    match (kind, kind.dim()) {
        (Kind::Triangle(_), _) => steps
            .flat_map(|a| (0..5 - a).map(move |b| [unit(a), unit(b), 0.0]))
            .collect(),
        (_, 1) => steps.map(|a| [both(a), 0.0, 0.0]).collect(),
        _ => steps
            .flat_map(|a| (0..5).map(move |b| [both(a), both(b), 0.0]))
            .collect(),
    }
}

/// Distances between tied surfaces do not change.
fn tied(results: &Results, pair: &Pair, report: &mut Report) {
    let (Side::Body { points, .. }, Side::Body { facets, .. }) = (&pair.secondary, &pair.primary)
    else {
        return;
    };
    let (x, _) = places(results, None);
    let mesh = &results.mesh;
    let feet: Vec<(usize, Foot)> = points
        .iter()
        .filter_map(|p| Some((*p, foot(mesh, facets, &x, x[*p])?)))
        .collect();
    let moved = results.states.iter().flat_map(|s| &s.u).map(|u| norm(*u));
    let largest = moved.fold(f64::MIN_POSITIVE, f64::max);
    for state in &results.states {
        let (mut sum, mut count) = (0.0, 0.0);
        for (node, foot) in &feet {
            let mean = foot
                .weights
                .iter()
                .fold([0.0; 3], |s, (n, w)| along(s, *w, state.u[*n]));
            sum += norm(sub(state.u[*node], mean)).powi(2);
            count += 1.0;
        }
        report.note(
            "tie",
            &pair.name,
            (sum / f64::max(count, 1.0)).sqrt() / largest,
            state.t,
        );
    }
}

/// Pieces of the way of an obstacle in an increment.
const ARC: u32 = 16;

/// How far a point moves over what it is on, and which way.
fn slips(results: &Results, pair: &Pair, sizes: &Scale, bulk: Option<&Bulk>, report: &mut Report) {
    if pair.belt || sizes.slip == 0.0 {
        return;
    }
    let nodes = points(results, pair);
    let dim = results.case.space.dim();
    let quadratic = results.mesh.cells.iter().any(|(kind, _)| kind.quadratic());
    let springs = bulk.map(|b| spring::of_stick(&results.case, &results.mesh, pair, b));
    let springs = springs.unwrap_or_default();
    let interface = results.case.of("interface", &pair.name);
    let is = |key: &str, wanted: &str| {
        let chosen = interface.and_then(|t| kind(t, key));
        chosen.is_some_and(|(name, _)| name == wanted)
    };
    let penalised = is("enforcement", "penalty");
    let printed = is("kinematics", "pop-1995");
    // Work of friction, and what it would be against slip, by node.
    let mut works: BTreeMap<usize, [f64; 2]> = BTreeMap::new();
    for (i, state) in results.states.iter().enumerate() {
        let Some(Before::Written(old)) = results.before(i) else {
            continue;
        };
        let (now, then) = (at(state), at(old));
        let sprung = penalised || results.case.steps[results.case.step_at(state.t)].explicit();
        let (x1, x0) = (state.places(), old.places());
        let (mut mean, mut count) = ([0.0; 2], 0.0);
        let frictionless = now
            .iter()
            .all(|p| p.carried() == 0.0 || p.carried().is_nan());
        let dt = (state.t - old.t).max(f64::MIN_POSITIVE);
        // The motion of a point over what it is on, if nodes have moved like this.
        let over = |node: usize, moved: &dyn Fn(usize) -> Vec3| {
            let (carried, normal) = match &pair.primary {
                Side::Rigid(obstacle) => {
                    // What is under the point has come this way, which is an arc where the obstacle turns: piece by piece, as the point goes.
                    let step = 1.0 / f64::from(ARC);
                    let mut way = [0.0; 3];
                    for k in 0..ARC {
                        let s = f64::from(k) * step;
                        let t = [s, s + step].map(|s| old.t + s * (state.t - old.t));
                        let here = along(x1[node], s + step - 1.0, moved(node));
                        let place = obstacle.foot(here, t[1])?.place;
                        way = along(way, -1.0, obstacle.carried(place, t[1], t[0]));
                    }
                    (way, obstacle.foot(x1[node], state.t)?.normal)
                }
                Side::Body { facets, .. } => {
                    let under = foot(&results.mesh, facets, &x0, x0[node])?;
                    let sum = |s: Vec3, (n, w): &(usize, f64)| along(s, *w, moved(*n));
                    let way = under.weights.iter().fold([0.0; 3], sum);
                    // What counts as no gap turns with the surface.
                    let after = foot(&results.mesh, facets, &x1, along(under.place, 1.0, way));
                    let turn = after.map_or([0.0; 3], |f| sub(f.normal, under.normal));
                    (along(way, under.gap, turn), under.normal)
                }
            };
            let own = tangential(sub(moved(node), carried), normal);
            let mut frame = frame(normal, dim);
            if pair.exchanged {
                // Both the motion and the normal of what is written are the other way round: the second direction turns with the normal.
                frame[0] = scale(-1.0, frame[0]);
            }
            Some(frame.map(|e| dot(own, e)))
        };
        let slid = |node: usize| over(node, &|n| sub(x1[n], x0[n]));
        // In motion friction is against the velocity at the end of the increment, over which slip may have turned round.
        let dynamic = results.case.steps[results.case.step_at(state.t)].dynamic();
        let v = match dynamic {
            true => state.grid.vector("V"),
            false => Vec::new(),
        };
        let swept = |node: usize| match v.is_empty() {
            true => slid(node),
            false => over(node, &|n| scale(dt, v[n])),
        };
        for node in nodes
            .iter()
            .filter(|n| now[**n].status > 0.0 && then[**n].status > 0.0)
        {
            let part = |k: usize| pair.mean(*node, |n| Some(slid(n)?[k]));
            let (Some(first), Some(second)) = (part(0), part(1)) else {
                continue;
            };
            let own = [first, second];
            let said = [0, 1].map(|k| now[*node].slip[k] - then[*node].slip[k]);
            let off = [own[0] - said[0], own[1] - said[1]];
            mean = [mean[0] + off[0], mean[1] + off[1]];
            count += 1.0;
            // The slip of a mortar point is a mean over the faces around it: only the mean over all is that of the places. The paper's own in space is along edges of
            // facets, and not objective.
            let objective = dim == 2 || !printed;
            if !pair.mortar && objective {
                // What was slipped before goes along where a point is carried by an obstacle that turns.
                let so_far = then[*node].slip;
                let moved = |n: usize| sub(x1[n], x0[n]);
                let swing = pair.swing(*node, &x1, &moved, [old.t, state.t]);
                let swung = so_far[0].hypot(so_far[1]) * swing;
                let off = (off[0].hypot(off[1]) - swung).max(0.0);
                report.note("slip", &pair.name, off / sizes.slip, state.t);
            }
            // The mean of a mortar point is not that of the places where what lies opposite has corners within its faces, or its weights have both signs:
            // there friction is held against the slip that is written. In motion that says nothing of how an increment ends: what is asked is that friction
            // takes the work of one against slip from all of them.
            let written = pair.mortar && (quadratic || !dynamic);
            let own = if written { said } else { own };
            let (length, carried) = (own[0].hypot(own[1]), now[*node].carried());
            let slides = now[*node].status == 2.0 && then[*node].status == 2.0;
            if slides && !frictionless && length > 0.05 * sizes.slip && carried > 1e-3 * sizes.limit
            {
                let shear = now[*node].shear;
                // Where points stick by springs friction is against what is left of the slip without what the spring has stretched by.
                let stretch = match sprung {
                    true => {
                        let Some(stiffness) = springs.get(node) else {
                            continue;
                        };
                        [0, 1].map(|k| (shear[k] - then[*node].shear[k]) / stiffness)
                    }
                    false => [0.0; 2],
                };
                let left = |way: [f64; 2]| [way[0] + stretch[0], way[1] + stretch[1]];
                let (least, own) = (stretch[0].hypot(stretch[1]), left(own));
                // How stiff it is, is known only about.
                if own[0].hypot(own[1]) < least {
                    continue;
                }
                let cosine = |way: [f64; 2]| {
                    let length = way[0].hypot(way[1]);
                    let along = shear[0] * way[0] + shear[1] * way[1];
                    if length > 0.0 {
                        along / (length * carried)
                    } else {
                        0.0
                    }
                };
                let end = |k: usize| pair.mean(*node, |n| Some(swept(n)?[k]));
                if written && dynamic {
                    let sum = works.entry(*node).or_default();
                    let along = shear[0] * own[0] + shear[1] * own[1];
                    *sum = [sum[0] + along, sum[1] + own[0].hypot(own[1]) * carried];
                    continue;
                }
                let end = match written {
                    true => own,
                    false => end(0).zip(end(1)).map_or(own, |(a, b)| left([a, b])),
                };
                let cosine = cosine(own).min(cosine(end));
                report.note("direction", &pair.name, 1.0 + cosine, state.t);
            }
        }
        // With few points the mean over them is not the one over the faces.
        if pair.mortar && count >= if dim == 3 { 9.0 } else { 3.0 } {
            let off = mean[0].hypot(mean[1]) / count;
            report.note("slip", &pair.name, off / sizes.slip, state.t);
        }
    }
    let end = results.states.last().map_or(0.0, |state| state.t);
    for [work, most] in works.into_values().filter(|[_, most]| *most > 0.0) {
        report.note("direction", &pair.name, 1.0 + work / most, end);
    }
}

/// Directions 1 and 2 of the fields: the x axis laid into the surface, or where the normal is along it the y axis (in 3D the z axis),
/// and the one across.
fn frame(normal: Vec3, dim: usize) -> [Vec3; 2] {
    let axis = match (normal[0].abs() < 0.99, dim) {
        (true, _) => [1.0, 0.0, 0.0],
        (false, 2) => [0.0, 1.0, 0.0],
        _ => [0.0, 0.0, 1.0],
    };
    let first = crate::vec3::unit(tangential(axis, normal));
    [first, crate::vec3::cross(normal, first)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::Kind;

    /// One triangle over another, whose nodes are a unit apart though it presses with a mean gap below zero: the least gap around says so.
    #[test]
    fn the_least_gap_around_a_point_is_that_of_the_places() {
        let facet = |nodes: [usize; 3], cell: usize| crate::mesh::Facet {
            kind: Kind::Triangle(3),
            nodes: nodes.to_vec(),
            cell,
            body: cell,
        };
        let x: Vec<Vec3> = [0.0, 1.0]
            .iter()
            .flat_map(|z| [[0.0, 0.0, *z], [1.0, 0.0, *z], [0.0, 1.0, *z]])
            .chain([[0.2, 0.2, -1.0], [0.2, 0.2, 2.0]])
            .collect();
        let mesh = crate::mesh::Mesh {
            points: x.clone(),
            cells: vec![
                (Kind::Tetrahedron(4), vec![0, 1, 2, 6]),
                (Kind::Tetrahedron(4), vec![3, 4, 5, 7]),
            ],
            owner: vec![0, 1],
            body: vec![0, 0, 0, 1, 1, 1, 0, 1],
            names: vec!["lower".into(), "upper".into()],
            facets: Vec::new(),
        };
        let sides = ([facet([3, 4, 5], 1)], [facet([0, 1, 2], 0)]);
        let found = around(&mesh, &sides.0, &sides.1, &x, |n| *n == 3);
        assert_eq!(found.len(), 1);
        let (least, covered) = found[&3];
        assert!((least - 1.0).abs() < 1e-12 && covered == 1.0, "{found:?}");
    }

    #[test]
    fn places_cover_a_facet() {
        assert_eq!(grid(Kind::Line(3)).len(), 5);
        assert_eq!(grid(Kind::Quad(8)).len(), 25);
        let triangle = grid(Kind::Triangle(6));
        assert_eq!(triangle.len(), 15);
        assert!(triangle.iter().all(|xi| xi[0] + xi[1] <= 1.0));
    }
}
