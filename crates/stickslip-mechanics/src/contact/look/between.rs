//! What lies between contact points: how far the surfaces penetrate, or stand apart under pressure, where contact is not checked.
//!
//! Points of the secondary see what lies opposite them. A fine primary may enter a coarse face between its points, a corner of a face may enter
//! between quadrature points, and a mean gap may be zero where surfaces are apart. All of that is measured here from the geometry alone, whatever
//! is active: places all over both surfaces are projected on the other side.

use std::collections::BTreeMap;

use rayon::prelude::*;

use crate::contact::bounds::Bounds;
use crate::contact::facet_point::{FACET_NODES, evaluate};
use crate::contact::interface::Primary;
use crate::contact::interface::initial::GLUE;
use crate::contact::interface::view::ContactView;
use crate::contact::projection::{Foot, facet_distance};
use crate::contact::search::Tree;
use crate::contact::surface::{Facet, Skin, concave_offsets};
use crate::math::{Vec3, add_scaled, distance, dot, norm, normalize, sub};
use crate::shape::ElementKind;
use crate::tolerance::NEGLIGIBLE;

/// What the contact points of an interface do not see.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Between {
    /// Largest penetration of the surfaces beyond what the contact points nearby say `[m]`.
    pub penetration: f64,
    /// The same relative to the height of the cell beneath `[-]`.
    pub relative_to_size: f64,
    /// Largest distance by which the surfaces stand apart, everywhere around a point, beyond what the point says; times its pressure and the part of it that
    /// has something opposite, over the largest `[m]`.
    pub apart: f64,
}

/// Faces looked at by one task.
const LOOKS_PER_TASK: usize = 16;

/// A place on a surface.
struct Place {
    x: Vec3,
    /// In the reference configuration.
    from: Vec3,
    /// Outward normal.
    normal: Vec3,
}

/// Places all over a facet in reference coordinates: nodes, middles of edges and quarters of lines.
fn grid(kind: ElementKind) -> &'static [[f64; 2]] {
    match kind {
        ElementKind::Line2 | ElementKind::Line3 => {
            &[[-1.0, 0.0], [-0.5, 0.0], [0.0, 0.0], [0.5, 0.0], [1.0, 0.0]]
        }
        ElementKind::Tri3 | ElementKind::Tri6 => &[
            [0.0, 0.0],
            [1.0, 0.0],
            [0.0, 1.0],
            [0.5, 0.0],
            [0.5, 0.5],
            [0.0, 0.5],
            [1.0 / 3.0, 1.0 / 3.0],
        ],
        _ => &[
            [-1.0, -1.0],
            [1.0, -1.0],
            [1.0, 1.0],
            [-1.0, 1.0],
            [0.0, -1.0],
            [1.0, 0.0],
            [0.0, 1.0],
            [-1.0, 0.0],
            [0.0, 0.0],
        ],
    }
}

/// One side, to be asked for the gap of a place on the other.
pub(super) struct Side<'a> {
    facets: Vec<&'a Facet>,
    /// Heights of the cells beneath, where they are known.
    sizes: Vec<f64>,
    tree: Tree,
    /// Where they lie, and which way they look.
    bounds: Vec<Bounds>,
    margin: f64,
    /// Depth that contact points know of `[m]`.
    deep: f64,
    x: &'a [Vec3],
    reference: &'a [Vec3],
}

impl<'a> Side<'a> {
    pub(super) fn new(
        facets: Vec<&'a Facet>,
        sizes: Vec<f64>,
        deep: f64,
        x: &'a [Vec3],
        reference: &'a [Vec3],
    ) -> Self {
        let tree = Tree::build(facets.iter().map(|f| f.nodes.iter().map(|&n| x[n])));
        // Curved facets leave the boxes of their nodes by a part of their size.
        let curved = facets.iter().filter(|f| f.kind.order() > 1);
        let longest = curved.map(|f| distance(x[f.nodes[0]], x[f.nodes[1]]));
        Side {
            bounds: facets.iter().map(|f| Bounds::around(f, x)).collect(),
            margin: 0.25 * longest.fold(0.0, f64::max),
            facets,
            sizes,
            deep,
            tree,
            x,
            reference,
        }
    }

    /// The facet opposite the centre of one of the other side, and the gap.
    pub(super) fn opposite(&self, facet: &Facet) -> Option<(usize, f64)> {
        let [s, t, _] = facet.kind.centre();
        let place = place(facet, self.x, self.reference, [s, t]);
        self.gap(&place, &mut Vec::new())
    }

    /// The place opposite another, and its facet; `None` beyond the edge.
    fn foot(&self, place: &Place, found: &mut Vec<usize>) -> Option<(usize, Foot)> {
        let (f, _) = self.gap(place, found)?;
        let patch = &self.bounds[f].patch;
        let foot = patch.project(place.x)?;
        let facet = self.facets[f];
        let size = distance(self.x[facet.nodes[0]], self.x[facet.nodes[1]]);
        // A place is opposite a facet up to this far beyond its edge.
        (patch.beyond(&foot).distance <= NEGLIGIBLE * size).then_some((f, foot))
    }

    /// The nearest facet that faces a place, and the gap; `None` where there is none, or where the place lies beneath facets but beside all of
    /// them.
    fn gap(&self, place: &Place, found: &mut Vec<usize>) -> Option<(usize, f64)> {
        self.tree.near(place.x, self.margin, found);
        // Most of what is near is farther than what is met first.
        found.retain(|&f| self.bounds[f].may_face(place.normal));
        let least = |f: usize| self.bounds[f].space.distance2(place.x);
        found.sort_unstable_by(|&a, &b| least(a).total_cmp(&least(b)).then(a.cmp(&b)));
        // Outside an edge the nearest facet may have no foot, and the next one that has is no measure.
        let mut aside: Option<(f64, usize)> = None;
        let mut best: Option<(f64, usize, Option<f64>)> = None;
        for &f in found.iter() {
            if best.is_some_and(|b| least(f) > b.0 * b.0) {
                break;
            }
            let facet = self.facets[f];
            let patch = &self.bounds[f].patch;
            let Some(p) = patch.project(place.x) else {
                continue;
            };
            if dot(p.normal, place.normal) >= 0.0 {
                continue;
            }
            let over = patch.beyond(&p);
            let away = facet_distance(place.x, &p, over);
            let gap = dot(sub(place.x, p.x), p.normal);
            let size = distance(self.x[facet.nodes[0]], self.x[facet.nodes[1]]);
            if over.distance > NEGLIGIBLE * size {
                if gap > 0.0 && aside.is_none_or(|a| away < a.0) {
                    aside = Some((away, f));
                }
                continue;
            }
            if best.is_some_and(|b| b.0 <= away) {
                continue;
            }
            // No place lies deeper beneath a surface than it has come, or than a soft law lets it: what does belongs to the other side of a
            // thin body.
            let mut n = [0.0; FACET_NODES];
            let n = &mut n[..facet.nodes.len()];
            (facet.kind.reference()).values([p.xi[0], p.xi[1], 0.0], n);
            let rest = facet.nodes.iter().zip(&*n);
            let rest = rest.fold([0.0; 3], |s, (&n, &w)| add_scaled(s, w, self.reference[n]));
            let came = dot(sub(sub(place.x, place.from), sub(p.x, rest)), p.normal);
            let size = size.max(self.sizes.get(f).copied().unwrap_or(0.0));
            // Surfaces may overlap by half of a cell without having moved.
            let deepest = self.deep + 0.5 * size + came.abs();
            best = Some((away, f, (gap >= -deepest).then_some(gap)));
        }
        match (best, aside) {
            (Some((away, ..)), Some((beside, f))) if beside < away => Some((f, beside)),
            (Some((_, f, gap)), _) => gap.map(|gap| (f, gap)),
            (None, aside) => aside.map(|(beside, f)| (f, beside)),
        }
    }
}

/// Places all over a facet.
fn places<'a>(
    facet: &'a Facet,
    x: &'a [Vec3],
    reference: &'a [Vec3],
) -> impl Iterator<Item = Place> + 'a {
    let at = move |&xi: &[f64; 2]| place(facet, x, reference, xi);
    grid(facet.kind).iter().map(at)
}

/// A place on a facet.
fn place(facet: &Facet, x: &[Vec3], reference: &[Vec3], xi: [f64; 2]) -> Place {
    let mut nodes = [[0.0; 3]; FACET_NODES];
    let p = evaluate(facet.kind, facet.gather(x, &mut nodes), xi);
    let from = facet.nodes.iter().zip(&p.n);
    Place {
        x: p.x,
        from: from.fold([0.0; 3], |s, (&node, &n)| add_scaled(s, n, reference[node])),
        normal: p.normal,
    }
}

/// What lies between contact points at the last accepted state, with displacements `u` of the mesh points, at time `t`. Nothing of tied
/// surfaces, see [`opening`].
pub fn between(contact: ContactView, u: &[f64], t: f64) -> Between {
    if contact.laws.tied || contact.skin.is_empty() || !contact.schedule.active(t) {
        return Between::default();
    }
    let x = contact.coordinates(u);
    compare(contact, &lowest(contact, &x, t), &x, t)
}

/// By how much tied surfaces have come apart or slid at the last accepted state, with displacements `u` of the mesh points: the root of the mean square over places all over the
/// secondary, each beside what lies opposite in the meshes, as near as what is glued `[m]`. Multipliers hold points or means over faces; what is between them may open.
pub fn opening(contact: ContactView, u: &[f64]) -> f64 {
    let (rest, facets) = (&contact.reference, contact.facets());
    let theirs = Side::new(facets.iter().collect(), Vec::new(), 0.0, rest, rest);
    let within = contact.initial.within.unwrap_or(GLUE);
    let glued = |&i: &usize| {
        contact
            .state
            .start
            .glued
            .get(i)
            .is_some_and(|g| !g.is_nan())
    };
    let x = contact.coordinates(u);
    let of = |skin: &Skin, found: &mut Vec<usize>| {
        let reach = within.of(cell_height(contact, skin));
        let both = places(&skin.facet, rest, rest).zip(places(&skin.facet, &x, rest));
        let squares = both.filter_map(|(before, now)| {
            let (f, foot) = theirs.foot(&before, found)?;
            let gap = dot(sub(before.x, foot.x), foot.normal);
            let mut nodes = [[0.0; 3]; FACET_NODES];
            let nodes = facets[f].gather(&x, &mut nodes);
            let beneath = evaluate(facets[f].kind, nodes, foot.xi);
            let place = add_scaled(beneath.x, gap, beneath.normal);
            let moved = sub(now.x, place);
            (gap.abs() <= reach).then(|| dot(moved, moved))
        });
        squares.fold((0.0, 0.0), |(sum, count), s| (sum + s, count + 1.0))
    };
    let sums: Vec<(f64, f64)> = (contact.skin.par_chunks(LOOKS_PER_TASK))
        .flat_map_iter(|skins| {
            let mut found = Vec::new();
            let held = skins.iter().filter(|s| s.points.iter().any(glued));
            held.map(|skin| of(skin, &mut found)).collect::<Vec<_>>()
        })
        .collect();
    let add = |a: (f64, f64), b: &(f64, f64)| (a.0 + b.0, a.1 + b.1);
    let (sum, count) = sums.iter().fold((0.0, 0.0), add);
    f64::sqrt(sum / f64::max(count, 1.0))
}

/// The same of the meshes, before anything has moved: depth of what overlaps.
pub fn overlap_between(contact: ContactView, t: f64) -> f64 {
    let lowest = lowest(contact, &contact.reference, t);
    lowest.iter().fold(0.0, |m, g| m.max(-g))
}

/// The smallest gap found anywhere on each face of the secondary; infinite where nothing lies opposite.
pub(super) fn lowest(contact: ContactView, x: &[Vec3], t: f64) -> Vec<f64> {
    let mut lowest = vec![f64::INFINITY; contact.skin.len()];
    match &contact.primary {
        Primary::Rigid(shape, motion) => {
            let pose = motion.pose(t);
            for (lowest, skin) in lowest.iter_mut().zip(&contact.skin) {
                for place in places(&skin.facet, x, &contact.reference) {
                    let foot = shape.as_dyn().foot(pose.inward(place.x));
                    *lowest = foot.map_or(*lowest, |foot| lowest.min(foot.gap));
                }
            }
        }
        Primary::Facets(facets) => lowest_of_facets(contact, facets, x, &mut lowest),
    }
    lowest
}

fn lowest_of_facets(contact: ContactView, facets: &[Facet], x: &[Vec3], lowest: &mut [f64]) {
    let committed = contact.state.points.iter();
    let deep = committed.fold(0.0_f64, |m, h| m.max(-h.gap));
    let theirs = Side::new(
        facets.iter().collect(),
        Vec::new(),
        deep,
        x,
        &contact.reference,
    );
    lowest
        .par_chunks_mut(LOOKS_PER_TASK)
        .zip(contact.skin.par_chunks(LOOKS_PER_TASK))
        .for_each(|(lowest, skins)| {
            let mut found = Vec::new();
            for (lowest, skin) in lowest.iter_mut().zip(skins) {
                for place in places(&skin.facet, x, &contact.reference) {
                    if let Some((_, gap)) = theirs.gap(&place, &mut found) {
                        *lowest = lowest.min(gap);
                    }
                }
            }
        });
    let sizes = contact
        .skin
        .iter()
        .map(|s| cell_height(contact, s))
        .collect();
    let ours = contact.skin.iter().map(|s| &s.facet).collect();
    let ours = Side::new(ours, sizes, deep, x, &contact.reference);
    let corners = corners(facets, x, &contact.reference);
    let gaps: Vec<Option<(usize, f64)>> = corners
        .par_chunks(LOOKS_PER_TASK)
        .flat_map_iter(|corners| {
            let mut found = Vec::new();
            let gaps: Vec<_> = corners.iter().map(|c| ours.gap(c, &mut found)).collect();
            gaps
        })
        .collect();
    for (face, gap) in gaps.into_iter().flatten() {
        lowest[face] = lowest[face].min(gap);
    }
}

/// Height of the cell beneath a face.
fn cell_height(contact: ContactView, skin: &Skin) -> f64 {
    let sizes = skin.points.iter().map(|&p| contact.points[p].size);
    sizes.fold(f64::INFINITY, f64::min)
}

/// What was found at coordinates `x`, beside what the contact points say.
fn compare(contact: ContactView, lowest: &[f64], x: &[Vec3], t: f64) -> Between {
    let mut out = Between::default();
    let committed = &contact.state.points;
    if committed.len() != contact.points.len() {
        return out;
    }
    let largest = contact
        .reference
        .iter()
        .map(|&x| norm(x))
        .fold(0.0, f64::max);
    let rounding = 64.0 * f64::EPSILON * (largest + norm(contact.origin));
    // Gaps of the meshes, with what the start of the interface takes off; a point that has nothing opposite says nothing.
    let said = |i: usize| match committed[i].normal == [0.0; 3] {
        true => f64::INFINITY,
        false => committed[i].gap + contact.offset(i, t),
    };
    let mut around = vec![f64::INFINITY; contact.points.len()];
    let mut entered = Vec::new();
    for (f, (skin, &least)) in contact.skin.iter().zip(lowest).enumerate() {
        let wanted = skin.points.iter().map(|&p| said(p)).fold(0.0, f64::min);
        let deep = wanted - least - rounding;
        if deep > 0.0 {
            entered.push((f, deep));
        }
        for &p in &skin.points {
            around[p] = around[p].min(least);
        }
    }
    if !entered.is_empty() {
        // A straight face of a hollow surface lies within what it wraps, as chords do in a circle. That is no contact unseen: the surface that it stands for
        // touches all along.
        let skin: Vec<&Facet> = contact.skin.iter().map(|s| &s.facet).collect();
        let offsets = concave_offsets(&skin, x);
        for (f, deep) in entered {
            let deep = (deep - offsets[f]).max(0.0);
            let height = cell_height(contact, &contact.skin[f]);
            out.penetration = out.penetration.max(deep);
            out.relative_to_size = out.relative_to_size.max(deep / height);
        }
    }
    // A mean over the corner of a face, where the other surface ends, is carried on to the node: what it presses with is the covered part of it.
    let presses = |i: usize| {
        let covered = contact.area_of(i) / (contact.points[i].area * contact.share);
        committed[i].pressure.max(0.0) * covered.min(1.0)
    };
    let most = (0..committed.len()).map(presses).fold(0.0, f64::max);
    // Each of two halves presses where the other one finds contact.
    if most > 0.0 && contact.share == 1.0 {
        for (i, around) in around.iter().enumerate() {
            let apart = around - said(i) - rounding;
            if apart.is_finite() && apart > 0.0 {
                out.apart = out.apart.max(apart * presses(i) / most);
            }
        }
    }
    out
}

/// The nodes of facets, each once, with normals that are means over the facets around it.
fn corners(facets: &[Facet], x: &[Vec3], reference: &[Vec3]) -> Vec<Place> {
    let mut normals: BTreeMap<usize, Vec3> = BTreeMap::new();
    for facet in facets {
        let [s, t, _] = facet.kind.centre();
        let mut nodes = [[0.0; 3]; FACET_NODES];
        let normal = evaluate(facet.kind, facet.gather(x, &mut nodes), [s, t]).normal;
        for &n in &facet.nodes {
            let sum = normals.entry(n).or_default();
            *sum = add_scaled(*sum, 1.0, normal);
        }
    }
    let place = |(n, normal): (usize, Vec3)| Place {
        x: x[n],
        from: reference[n],
        normal: normalize(normal).unwrap_or_default(),
    };
    normals.into_iter().map(place).collect()
}
