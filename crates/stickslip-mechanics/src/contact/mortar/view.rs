//! A face as it lies now, and what a ray from it meets.

use super::clip::Point;
use super::dual::positive;
use super::face::{FACE_NODES, Face};
use super::rim::Rim;
use crate::contact::projection::{FARTHEST, Patch};
use crate::contact::walls::OPPOSED_COSINE;
use crate::math::{
    Mat3, Vec3, add_scaled, cross, dot, inverse, mat_vec, norm, normalize, scale, sub,
};
use crate::shape::ElementKind;

/// Steps of Newton's method for the place where a ray meets a facet.
const ITERATIONS: usize = 20;

/// A quadrature point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sample {
    /// Weight and reference area.
    pub w: f64,
    /// Shape functions of the face, and those with positive integrals.
    pub n: [f64; FACE_NODES],
    pub positive: [f64; FACE_NODES],
    /// Index of the piece, and the shape functions of its facet.
    pub piece: usize,
    pub opposite: [f64; FACE_NODES],
    pub place: Point,
    pub gap: f64,
    /// Gradient of the gap with respect to the place on the secondary.
    pub direction: Vec3,
    /// Gap times the gradients of the shape functions of the facet, along it.
    pub levers: [Vec3; FACE_NODES],
}

/// Position, base vectors and shape functions of a facet.
pub(super) struct Place {
    pub n: [f64; FACE_NODES],
    pub x: Vec3,
    pub a: [Vec3; 2],
}

/// Coordinates of the nodes of a face or facet.
pub(super) fn gather(nodes: &[usize], x: &[Vec3]) -> [Vec3; FACE_NODES] {
    let mut out = [[0.0; 3]; FACE_NODES];
    for (o, &n) in out.iter_mut().zip(nodes) {
        *o = x[n];
    }
    out
}

/// Shape functions of a bilinear quadrilateral and their derivatives, in line: most faces are such ones.
fn bilinear([s, t]: Point) -> ([f64; FACE_NODES], [Point; FACE_NODES]) {
    let mut n = [0.0; FACE_NODES];
    let mut d = [[0.0; 2]; FACE_NODES];
    let ends = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    for ((n, d), [a, b]) in n.iter_mut().zip(&mut d).zip(ends) {
        let (along, across) = (1.0 + a * s, 1.0 + b * t);
        *n = 0.25 * along * across;
        *d = [0.25 * a * across, 0.25 * b * along];
    }
    (n, d)
}

/// Shape functions of a face or facet and their derivatives.
fn shapes(kind: ElementKind, xi: Point) -> ([f64; FACE_NODES], [Point; FACE_NODES]) {
    if kind == ElementKind::Quad4 {
        return bilinear(xi);
    }
    let count = kind.node_count();
    let at = [xi[0], xi[1], 0.0];
    let mut n = [0.0; FACE_NODES];
    let mut d = [[0.0; 3]; FACE_NODES];
    kind.reference().values(at, &mut n[..count]);
    kind.reference().gradients(at, &mut d[..count]);
    (n, d.map(|[s, t, _]| [s, t]))
}

/// A place on a face or facet.
pub(super) fn place(kind: ElementKind, x: &[Vec3], xi: Point) -> Place {
    let count = kind.node_count();
    let (n, d) = shapes(kind, xi);
    let mut p = Place {
        n,
        x: [0.0; 3],
        a: [[0.0; 3]; 2],
    };
    for (k, &c) in x.iter().enumerate().take(count) {
        p.x = add_scaled(p.x, n[k], c);
        p.a[0] = add_scaled(p.a[0], d[k][0], c);
        p.a[1] = add_scaled(p.a[1], d[k][1], c);
    }
    if kind.dim() == 1 {
        p.a[1] = [0.0, 0.0, 1.0];
    }
    p
}

/// Where a ray from `from` along `n` meets a facet: the base vectors there and the signed distance.
fn hit(patch: &Patch, from: Vec3, n: Vec3, xi: &mut Point) -> Option<([Vec3; 2], f64)> {
    let affine = matches!(patch.kind, ElementKind::Line2 | ElementKind::Tri3);
    for _ in 0..ITERATIONS {
        let (x, a) = patch.at(*xi);
        // a1 Δξ + a2 Δη - n s = from - x
        let matrix: Mat3 = std::array::from_fn(|i| [a[0][i], a[1][i], -n[i]]);
        let (inverse, _) = inverse(&matrix)?;
        let step = mat_vec(&inverse, sub(from, x));
        let longest = step[0].abs().max(step[1].abs());
        if !longest.is_finite() || longest > FARTHEST {
            return None;
        }
        xi[0] += step[0];
        xi[1] += step[1];
        // After such a step in reference coordinates the ray meets the facet.
        if affine || longest < 1e-8 {
            let (x, a) = patch.at(*xi);
            return Some((a, dot(sub(x, from), n)));
        }
    }
    None
}

/// Gap `s` times the gradients of shape functions along a facet with the base vectors `a`, of what has these `slopes` in reference coordinates.
fn levers(a: &[Vec3; 2], s: f64, slopes: &[Point]) -> [Vec3; FACE_NODES] {
    let normal = cross(a[0], a[1]);
    let s = s / dot(normal, normal);
    let dual = [scale(s, cross(a[1], normal)), scale(s, cross(normal, a[0]))];
    let mut out = [[0.0; 3]; FACE_NODES];
    for (lever, [d, e]) in out.iter_mut().zip(slopes) {
        *lever = add_scaled(scale(*d, dual[0]), *e, dual[1]);
    }
    out
}

/// What lies behind a facet.
pub(super) struct Wall<'a> {
    /// Depth down to which it may be met `[m]`.
    pub depth: f64,
    /// Its nodes, and the coordinates of all nodes at the last accepted state; empty where they are not known.
    pub nodes: &'a [usize],
    pub before: &'a [Vec3],
}

/// The face as its nodes see it now.
pub(super) struct View<'a> {
    pub face: &'a Face,
    pub x: [Vec3; FACE_NODES],
    pub reference: [Vec3; FACE_NODES],
    pub normals: [Vec3; FACE_NODES],
}

/// A facet that the face may meet: part of a piece, with the wall behind it and its rim.
#[derive(Clone, Copy)]
pub(super) struct MetFacet<'a> {
    pub piece: usize,
    pub facet: &'a Patch,
    pub wall: &'a Wall<'a>,
    pub rim: &'a Rim<'a>,
}

impl View<'_> {
    /// From what lies opposite to a place, at the last accepted state; `None` where that is not known.
    fn apart_before(
        &self,
        wall: &Wall,
        n: &[f64; FACE_NODES],
        opposite: &[f64; FACE_NODES],
    ) -> Option<Vec3> {
        let at = |nodes: &[usize], n: &[f64; FACE_NODES]| {
            let terms = nodes.iter().zip(n);
            terms.fold([0.0; 3], |s, (&k, &n)| add_scaled(s, n, wall.before[k]))
        };
        (!wall.before.is_empty()).then(|| sub(at(&self.face.nodes, n), at(wall.nodes, opposite)))
    }

    /// Unit normal at a place with these shape functions.
    fn normal(&self, n: &[f64; FACE_NODES]) -> Vec3 {
        let mut sum = [0.0; 3];
        for (normal, &n) in self.normals.iter().zip(n) {
            sum = add_scaled(sum, n, *normal);
        }
        normalize(sum).unwrap_or(sum)
    }

    /// Adds a quadrature point at `xi` of weight `w` in reference coordinates, if the facet is met there, and neither lies beyond the other side of the other's body.
    pub fn sample(
        &self,
        xi: Point,
        w: f64,
        met: MetFacet,
        start: &mut Point,
        out: &mut Vec<Sample>,
    ) {
        let MetFacet {
            piece,
            facet,
            wall,
            rim,
        } = met;
        let kind = self.face.kind;
        let there = place(kind, &self.reference, xi);
        let area = match kind.dim() {
            1 => norm(there.a[0]),
            _ => norm(cross(there.a[0], there.a[1])),
        };
        let n = there.n;
        let extent: f64 = self.face.extents.iter().zip(&n).map(|(e, n)| e * n).sum();
        let mut from = [0.0; 3];
        for (x, &n) in self.x.iter().zip(&n).take(kind.node_count()) {
            from = add_scaled(from, n, *x);
        }
        let normal = self.normal(&n);
        let Some((a, gap)) = hit(facet, from, normal, start) else {
            return;
        };
        let Some(m) = normalize(cross(a[0], a[1])) else {
            return;
        };
        let facing = -dot(normal, m);
        let (opposite, slopes) = shapes(facet.kind, *start);
        // Beyond the other side of one of the bodies, unless it has come there within the increment.
        let beyond = |height: f64, outward: Vec3, depth: f64| {
            let before = || self.apart_before(wall, &n, &opposite);
            height < -depth && before().is_none_or(|apart| dot(apart, outward) < -depth)
        };
        let beyond = beyond(gap * facing, m, wall.depth)
            || beyond(gap, scale(-1.0, normal), self.face.depth);
        // At a single place of a curved facet half of the cosine is enough.
        if facing < 0.5 * OPPOSED_COSINE || beyond {
            return;
        }
        let mut positives = n;
        positive(kind, &mut positives);
        out.push(Sample {
            w: w * area * extent,
            n,
            positive: positives,
            piece,
            opposite,
            place: *start,
            gap,
            direction: rim.direction(from, normal, add_scaled(from, gap, normal), m),
            levers: levers(&a, gap, &slopes[..facet.kind.node_count()]),
        });
    }

    /// Normal of a straight cell of the face.
    pub fn cell_normal(&self, cell: &[usize]) -> Vec3 {
        let sum = (cell.iter()).fold([0.0; 3], |s, &k| add_scaled(s, 1.0, self.normals[k]));
        normalize(sum).unwrap_or(sum)
    }
}

/// Whether a facet looks back along `normal`.
pub(super) fn looks_back(facet: &Patch, normal: Vec3) -> bool {
    let [s, t, _] = facet.kind.centre();
    let (_, a) = facet.at([s, t]);
    normalize(cross(a[0], a[1])).is_some_and(|m| dot(m, normal) < -OPPOSED_COSINE)
}
