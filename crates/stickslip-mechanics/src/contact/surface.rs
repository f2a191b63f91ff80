//! The two sides of an interface as the contact pipeline sees them.

use std::collections::BTreeMap;

use crate::contact::facet_point::{FACET_NODES, evaluate};
use crate::contact::symmetry::Across;
use crate::math::{Vec3, angle, cross, distance, dot, norm, sub};
use crate::shape::ElementKind;

/// A point of the secondary surface at which contact is checked: a node, a quadrature point of a face, or on an obstacle the mean over a quadratic
/// face that belongs to one of its nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactPoint {
    /// Mesh points it hangs on: one, or those of a face, so at most eight.
    pub nodes: Vec<usize>,
    /// Their weights, adding up to one.
    pub weights: Vec<f64>,
    /// Area of the surface it stands for `[m²]` (thickness or 2πr included).
    pub area: f64,
    /// Stiffness of the body beneath, constrained modulus over cell height `[Pa/m]`.
    pub stiffness: f64,
    /// Outward normal of the secondary surface in the reference configuration.
    pub normal: Vec3,
    /// Height of the cell beneath `[m]`, for reports.
    pub size: f64,
    /// What vectors at it do not have, because it lies on planes of symmetry.
    pub across: Across,
}

impl ContactPoint {
    /// The node that it belongs to: the only one, or the first if it outweighs the others; none of a place within a face.
    pub fn node(&self) -> Option<usize> {
        match (self.nodes.as_slice(), self.weights.first()) {
            (&[one], _) => Some(one),
            (&[first, ..], Some(&w)) if w >= 1.0 => Some(first),
            _ => None,
        }
    }

    /// Where results at it are shown: at its node, or at its position.
    pub fn place(&self, x: &[Vec3]) -> Vec3 {
        self.node().map_or_else(|| self.position(x), |node| x[node])
    }

    /// Its position, given those of all mesh points.
    pub fn position(&self, x: &[Vec3]) -> Vec3 {
        let mut p = [0.0; 3];
        for (&node, &w) in self.nodes.iter().zip(&self.weights) {
            p = crate::math::add_scaled(p, w, x[node]);
        }
        p
    }
}

/// A facet of the primary surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Facet {
    /// Line, triangle or quadrilateral, linear or quadratic.
    pub kind: ElementKind,
    /// Mesh points, oriented so that the normal points out of the body.
    pub nodes: Vec<usize>,
    /// For each edge (3D) or end (2D), whether the surface goes on beyond it.
    pub continues: Vec<bool>,
    /// Constrained modulus of the cell beneath `[Pa]`.
    pub modulus: f64,
    /// User's number of the cell beneath.
    pub cell: u64,
}

impl Facet {
    /// Coordinates of its nodes.
    #[inline]
    pub fn gather<'a>(&self, x: &[Vec3], out: &'a mut [Vec3; FACET_NODES]) -> &'a [Vec3] {
        for (c, &n) in out.iter_mut().zip(&self.nodes) {
            *c = x[n];
        }
        &out[..self.nodes.len()]
    }
}

/// A face of the secondary as it lies there, whatever contact is checked at.
#[derive(Debug, Clone, PartialEq)]
pub struct Skin {
    /// The face; the normal points out of the body.
    pub facet: Facet,
    /// Its contact points.
    pub points: Vec<usize>,
}

/// The faces of a secondary with these points, of which single nodes may lie on several smooth parts of the surface: then `own` has those of
/// each face. A face without points is left out.
pub fn skin(facets: Vec<Facet>, points: &[ContactPoint], own: Option<&[Vec<usize>]>) -> Vec<Skin> {
    let mut at_node: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    let mut within: BTreeMap<&[usize], Vec<usize>> = BTreeMap::new();
    for (i, point) in points.iter().enumerate() {
        match point.node() {
            Some(node) => at_node.entry(node).or_default().push(i),
            None => within.entry(&point.nodes).or_default().push(i),
        }
    }
    let of = |facet: &Facet| -> Vec<usize> {
        let nodes = facet.nodes.iter().filter_map(|n| at_node.get(n));
        let inner = within.get(facet.nodes.as_slice());
        nodes.chain(inner).flatten().copied().collect()
    };
    (facets.into_iter().enumerate())
        .map(|(k, facet)| Skin {
            points: own.map_or_else(|| of(&facet), |own| own[k].clone()),
            facet,
        })
        .filter(|skin| !skin.points.is_empty())
        .collect()
}

/// Corner indices of the edges (3D) or ends (2D) of a facet kind, in the order of [`Facet::continues`].
pub fn edges(kind: ElementKind) -> &'static [&'static [usize]] {
    match kind {
        ElementKind::Line2 | ElementKind::Line3 => &[&[0], &[1]],
        ElementKind::Tri3 | ElementKind::Tri6 => &[&[0, 1], &[1, 2], &[2, 0]],
        _ => &[&[0, 1], &[1, 2], &[2, 3], &[3, 0]],
    }
}

/// Finds out which edges are shared with another facet.
pub fn connect(facets: &mut [Facet]) {
    let mut count: BTreeMap<Vec<usize>, usize> = BTreeMap::new();
    let key = |facet: &Facet, edge: &[usize]| {
        let mut key: Vec<usize> = edge.iter().map(|&i| facet.nodes[i]).collect();
        key.sort_unstable();
        key
    };
    for facet in facets.iter() {
        for edge in edges(facet.kind) {
            *count.entry(key(facet, edge)).or_default() += 1;
        }
    }
    for facet in facets.iter_mut() {
        facet.continues = edges(facet.kind)
            .iter()
            .map(|edge| count[&key(facet, edge)] > 1)
            .collect();
    }
}

/// Angle between neighbouring facets beyond which they meet at an edge of the body `[rad]`, 29 degrees: a circle of 13 facets or more is round. With 0.25 and 1
/// the histories of all short cases (see [`tolerance`](crate::tolerance)) are the same; with 1 a finding of the random problem 50, `coarse-contact`, changes.
pub const EDGE_ANGLE: f64 = 0.5;

/// How a smooth surface turns from facet to facet: for each edge that two facets share, the angle between their normals `[rad]` and the distance of
/// their centres. Edges of the body are left out.
pub fn turns(facets: &[&Facet], x: &[Vec3]) -> Vec<[f64; 2]> {
    let mut sides: BTreeMap<Vec<usize>, Vec<usize>> = BTreeMap::new();
    for (f, facet) in facets.iter().enumerate() {
        for edge in edges(facet.kind) {
            let mut key: Vec<usize> = edge.iter().map(|&i| facet.nodes[i]).collect();
            key.sort_unstable();
            sides.entry(key).or_default().push(f);
        }
    }
    let centre = |f: usize| {
        let facet = facets[f];
        let nodes: Vec<Vec3> = facet.nodes.iter().map(|&n| x[n]).collect();
        let [s, t, _] = facet.kind.centre();
        evaluate(facet.kind, &nodes, [s, t])
    };
    let pair = |sides: &Vec<usize>| match sides.as_slice() {
        &[a, b] => {
            let (a, b) = (centre(a), centre(b));
            let angle = angle(a.normal, b.normal);
            (angle < EDGE_ANGLE).then(|| [angle, distance(a.x, b.x)])
        }
        _ => None,
    };
    sides.values().filter_map(pair).collect()
}

/// By facet, how far a smooth surface through the nodes stands off it at most on its outer side, because the surface is hollow there `[m]`: an eighth of the angle to the facets beside
/// it times the distance to them, along both directions of a facet in space. Zero where the surface is flat or bulges, and of quadratic facets, which follow it.
pub fn concave_offsets(facets: &[&Facet], x: &[Vec3]) -> Vec<f64> {
    let mut sides: BTreeMap<Vec<usize>, Vec<usize>> = BTreeMap::new();
    for (f, facet) in facets.iter().enumerate() {
        for edge in edges(facet.kind) {
            let mut key: Vec<usize> = edge.iter().map(|&i| facet.nodes[i]).collect();
            key.sort_unstable();
            sides.entry(key).or_default().push(f);
        }
    }
    let centre = |f: usize| {
        let facet = facets[f];
        let nodes: Vec<Vec3> = facet.nodes.iter().map(|&n| x[n]).collect();
        let [s, t, _] = facet.kind.centre();
        evaluate(facet.kind, &nodes, [s, t])
    };
    let mut sums = vec![(0.0, 0.0); facets.len()];
    for pair in sides.values() {
        let &[a, b] = pair.as_slice() else { continue };
        let (p, q) = (centre(a), centre(b));
        let turned = angle(p.normal, q.normal);
        if turned >= EDGE_ANGLE {
            continue;
        }
        let way = sub(q.x, p.x);
        // Normals that come towards each other are those of a hollow.
        let depth = -dot(sub(q.normal, p.normal), way).signum() * turned * distance(p.x, q.x);
        for f in [a, b] {
            sums[f].0 += depth;
            sums[f].1 += 1.0;
        }
    }
    let of = |(facet, (sum, count)): (&&Facet, (f64, f64))| match facet.kind.order() {
        1 if count > 0.0 => (facet.kind.dim() as f64 * sum / (8.0 * count)).max(0.0),
        _ => 0.0,
    };
    facets.iter().zip(sums).map(of).collect()
}

/// Distance of the nodes of a facet, from its measure: that of a square, or half of one, with nodes at its corners.
pub fn spacing(facet: &Facet, x: &[Vec3]) -> f64 {
    let nodes: Vec<Vec3> = facet.nodes.iter().map(|&n| x[n]).collect();
    let [s, t, _] = facet.kind.centre();
    let p = evaluate(facet.kind, &nodes, [s, t]);
    let jacobian = norm(cross(p.a[0], p.a[1]));
    let whole = match facet.kind.linear() {
        ElementKind::Line2 => 2.0 * jacobian,
        ElementKind::Tri3 => jacobian.sqrt(),
        _ => 2.0 * jacobian.sqrt(),
    };
    whole / facet.kind.order().max(1) as f64
}

/// Splits quadrilaterals into triangles along their first diagonal, for the paper's 3 + 1 node element.
pub fn triangulate(facets: Vec<Facet>) -> Vec<Facet> {
    let mut out = Vec::with_capacity(2 * facets.len());
    for facet in facets {
        let split: &[&[usize]] = match facet.kind {
            ElementKind::Quad4 => &[&[0, 1, 2], &[0, 2, 3]],
            ElementKind::Tri6 => &[&[0, 3, 5], &[3, 1, 4], &[5, 4, 2], &[3, 4, 5]],
            ElementKind::Quad8 => &[
                &[0, 4, 7],
                &[4, 1, 5],
                &[5, 2, 6],
                &[6, 3, 7],
                &[4, 5, 6],
                &[4, 6, 7],
            ],
            ElementKind::Line3 => &[&[0, 2], &[2, 1]],
            _ => {
                out.push(facet);
                continue;
            }
        };
        for piece in split {
            out.push(Facet {
                kind: if piece.len() == 2 {
                    ElementKind::Line2
                } else {
                    ElementKind::Tri3
                },
                nodes: piece.iter().map(|&i| facet.nodes[i]).collect(),
                continues: Vec::new(),
                ..facet.clone()
            });
        }
    }
    out
}
