//! Integrals over the part of one face of the secondary that has the primary opposite.

use super::clip::{Point, Polygon};
use super::dual::{Matrix, dual, positive};
use super::rules::{self, LINE};
use super::{FACE_NODES, Face};
use crate::contact::surface::Facet;
use crate::math::{
    Mat3, Vec3, add_scaled, cross, distance, dot, inverse, mat_vec, norm, normalize, scale, sub,
};
use crate::shape::ElementKind;

/// Cosine of the angle by which a facet has to look back at a face.
const FACING: f64 = 0.1;

/// Part of a face below which what lies opposite is left out.
const LEAST: f64 = 1e-4;

/// Part of a cell below which a piece of it is nothing.
const LEAST_PIECE: f64 = 1e-14;

/// The geometry of both sides.
#[derive(Debug, Clone, Copy)]
pub struct Sides<'a> {
    /// Coordinates of all nodes now.
    pub x: &'a [Vec3],
    /// In the reference configuration, which areas are taken from.
    pub reference: &'a [Vec3],
    /// How the secondary as a whole has turned since then.
    pub turn: Mat3,
    /// The primary.
    pub facets: &'a [Facet],
}

impl Sides<'_> {
    /// Directions along which the gap of a face is measured, at its nodes: those of the reference turn with the surface as a whole, so that a pair that
    /// turns as one keeps its gap. How the surface bends has no part in them: they would change in every iteration, and the tangent does not know.
    fn normals(&self, face: &Face) -> [Vec3; FACE_NODES] {
        let mut out = [[0.0; 3]; FACE_NODES];
        for (o, &normal) in out.iter_mut().zip(&face.normals) {
            *o = mat_vec(&self.turn, normal);
        }
        out
    }
}

/// What a node has in a weighted gap: its weight, and the gradient of the gap with respect to it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Entry {
    /// Weight `[m²]`.
    pub weight: f64,
    /// Gradient `[m²]`.
    pub gradient: Vec3,
}

impl Entry {
    fn add(&mut self, w: f64, direction: Vec3) {
        self.weight += w;
        self.gradient = add_scaled(self.gradient, w, direction);
    }
}

/// The part of a facet that lies opposite a face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// The facet.
    pub facet: usize,
    /// Common area `[m²]`.
    pub area: f64,
    /// `∫ N_k` over it by node of the facet.
    pub sums: [f64; FACE_NODES],
    /// `∫ Φ_a` over it by node of the face.
    pub shares: [f64; FACE_NODES],
    /// `∫ d` of the direction of the gap's gradient.
    pub direction: Vec3,
    /// `∫ N_b` over it by node of the face.
    pub own: [f64; FACE_NODES],
    /// `∫ ξ` of the reference coordinates of the facet.
    pub place: [f64; 2],
}

/// Integrals over a face, to be divided by the area of the whole contact point.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FaceIntegral {
    /// `∫ Φ_a` by node of the face `[m²]`.
    pub area: [f64; FACE_NODES],
    /// `∫ Φ_a g` `[m³]`.
    pub gap: [f64; FACE_NODES],
    /// By node of the face and, within, by node of the face.
    pub secondary: Vec<Entry>,
    /// Nodes of the primary that take part.
    pub nodes: Vec<usize>,
    /// By node of the face and, within, by these nodes; to be subtracted.
    pub primary: Vec<Entry>,
    /// By facet.
    pub pieces: Vec<Piece>,
}

impl FaceIntegral {
    /// Makes it that of a face with nothing opposite.
    pub fn clear(&mut self) {
        self.area = [0.0; FACE_NODES];
        self.gap = [0.0; FACE_NODES];
        self.secondary.clear();
        self.nodes.clear();
        self.primary.clear();
        self.pieces.clear();
    }
}

/// A quadrature point.
#[derive(Debug, Clone, Copy)]
struct Sample {
    /// Weight and reference area.
    w: f64,
    /// Shape functions of the face, and those with positive integrals.
    n: [f64; FACE_NODES],
    positive: [f64; FACE_NODES],
    /// Index of the piece, and the shape functions of its facet.
    piece: usize,
    opposite: [f64; FACE_NODES],
    place: Point,
    gap: f64,
    /// Gradient of the gap with respect to the place on the secondary.
    direction: Vec3,
}

/// Room to work in.
#[derive(Debug, Default)]
pub struct Scratch {
    samples: Vec<Sample>,
}

/// Position, base vectors and shape functions of a facet.
struct Place {
    n: [f64; FACE_NODES],
    x: Vec3,
    a: [Vec3; 2],
}

/// Distance of a middle node from the middle of its edge, relative to the edge, up to which the edge counts as straight.
const STRAIGHT: f64 = 1e-3;

/// Corner nodes of the straight cells that a face is cut into: the face itself if its edges are straight.
fn cells(kind: ElementKind, nodes: &[usize], reference: &[Vec3]) -> &'static [&'static [usize]] {
    let corners = kind.corner_count();
    let at = |k: usize| reference[nodes[k]];
    let straight = (corners..nodes.len()).all(|k| {
        let (a, b) = match kind.dim() {
            1 => (at(0), at(1)),
            _ => (at(k - corners), at((k - corners + 1) % corners)),
        };
        let middle = add_scaled(scale(0.5, a), 0.5, b);
        distance(at(k), middle) <= STRAIGHT * distance(a, b)
    });
    match (kind, straight) {
        (ElementKind::Line2, _) | (ElementKind::Line3, true) => &[&[0, 1]],
        (ElementKind::Line3, false) => &[&[0, 2], &[2, 1]],
        (ElementKind::Tri3, _) | (ElementKind::Tri6, true) => &[&[0, 1, 2]],
        (ElementKind::Tri6, false) => &[&[0, 3, 5], &[3, 1, 4], &[5, 4, 2], &[3, 4, 5]],
        (ElementKind::Quad8, false) => &[
            &[0, 4, 7],
            &[4, 1, 5],
            &[5, 2, 6],
            &[6, 3, 7],
            &[4, 5, 6, 7],
        ],
        _ => &[&[0, 1, 2, 3]],
    }
}

fn gather(nodes: &[usize], x: &[Vec3]) -> [Vec3; FACE_NODES] {
    let mut out = [[0.0; 3]; FACE_NODES];
    for (o, &n) in out.iter_mut().zip(nodes) {
        *o = x[n];
    }
    out
}

fn place(kind: ElementKind, x: &[Vec3], xi: Point) -> Place {
    let count = kind.node_count();
    let at = [xi[0], xi[1], 0.0];
    let mut n = [0.0; FACE_NODES];
    let mut d = [[0.0; 3]; FACE_NODES];
    kind.reference().values(at, &mut n[..count]);
    kind.reference().gradients(at, &mut d[..count]);
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

/// Where a ray from `from` along `n` meets a facet: the facet there and the signed distance.
fn hit(kind: ElementKind, x: &[Vec3], from: Vec3, n: Vec3, xi: &mut Point) -> Option<(Place, f64)> {
    let affine = matches!(kind, ElementKind::Line2 | ElementKind::Tri3);
    for _ in 0..20 {
        let p = place(kind, x, *xi);
        // a1 Δξ + a2 Δη - n s = from - x
        let matrix: Mat3 = std::array::from_fn(|i| [p.a[0][i], p.a[1][i], -n[i]]);
        let (inverse, _) = inverse(&matrix)?;
        let step = mat_vec(&inverse, sub(from, p.x));
        let longest = step[0].abs().max(step[1].abs());
        if !longest.is_finite() || longest > 1e3 {
            return None;
        }
        xi[0] += step[0];
        xi[1] += step[1];
        if affine || longest < 1e-8 {
            let p = place(kind, x, *xi);
            let away = sub(p.x, from);
            return Some((p, dot(away, n)));
        }
    }
    None
}

/// Two directions that make a right-handed frame with `n`.
fn plane(n: Vec3, along: Vec3) -> Option<[Vec3; 2]> {
    let e = normalize(add_scaled(along, -dot(along, n), n))?;
    Some([e, cross(n, e)])
}

/// The face as its nodes see it now.
struct View<'a> {
    face: &'a Face,
    x: [Vec3; FACE_NODES],
    reference: [Vec3; FACE_NODES],
    normals: [Vec3; FACE_NODES],
}

impl View<'_> {
    /// Unit normal at a place with these shape functions.
    fn normal(&self, n: &[f64; FACE_NODES]) -> Vec3 {
        let mut sum = [0.0; 3];
        for (normal, &n) in self.normals.iter().zip(n) {
            sum = add_scaled(sum, n, *normal);
        }
        normalize(sum).unwrap_or(sum)
    }

    /// Adds a quadrature point at `xi` of weight `w` in reference coordinates, if the facet is met there.
    fn sample(
        &self,
        xi: Point,
        w: f64,
        facet: (usize, ElementKind, &[Vec3]),
        start: &mut Point,
        out: &mut Vec<Sample>,
    ) {
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
        let (piece, facet_kind, facet) = facet;
        let Some((p, gap)) = hit(facet_kind, facet, from, normal, start) else {
            return;
        };
        let Some(m) = normalize(cross(p.a[0], p.a[1])) else {
            return;
        };
        let facing = -dot(normal, m);
        if facing < 0.5 * FACING {
            return;
        }
        let mut positives = n;
        positive(kind, &mut positives);
        out.push(Sample {
            w: w * area * extent,
            n,
            positive: positives,
            piece,
            opposite: p.n,
            place: *start,
            gap,
            direction: m.map(|m| m / facing),
        });
    }
}

/// Integrates over `face`, of which the facets `candidates` may lie opposite.
pub fn integrate(
    face: &Face,
    sides: &Sides,
    candidates: &[usize],
    scratch: &mut Scratch,
    out: &mut FaceIntegral,
) {
    out.clear();
    scratch.samples.clear();
    let view = View {
        face,
        x: gather(&face.nodes, sides.x),
        reference: gather(&face.nodes, sides.reference),
        normals: sides.normals(face),
    };
    let whole: f64 = measure(&view);
    for cell in cells(face.kind, &face.nodes, sides.reference) {
        match face.kind.dim() {
            1 => lines(&view, cell, sides, candidates, scratch, out),
            _ => polygons(&view, cell, sides, candidates, scratch, out),
        }
    }
    let covered: f64 = scratch.samples.iter().map(|s| s.w).sum();
    if covered < LEAST * whole {
        out.clear();
        return;
    }
    sum(face, sides, scratch, out);
}

/// Area of the face, roughly.
fn measure(view: &View) -> f64 {
    let kind = view.face.kind;
    let centre = kind.centre();
    let p = place(kind, &view.reference, [centre[0], centre[1]]);
    let extent: f64 = (view.face.extents.iter().zip(&p.n))
        .map(|(e, n)| e * n)
        .sum();
    let (jacobian, reference) = match kind.linear() {
        ElementKind::Line2 => (norm(p.a[0]), 2.0),
        ElementKind::Tri3 => (norm(cross(p.a[0], p.a[1])), 0.5),
        _ => (norm(cross(p.a[0], p.a[1])), 4.0),
    };
    extent * jacobian * reference
}

/// The piece of a facet, new if it is the first time that the face meets it.
fn piece(facet: usize, out: &mut FaceIntegral) -> usize {
    if let Some(known) = out.pieces.iter().position(|p| p.facet == facet) {
        return known;
    }
    out.pieces.push(Piece {
        facet,
        area: 0.0,
        sums: [0.0; FACE_NODES],
        shares: [0.0; FACE_NODES],
        direction: [0.0; 3],
        own: [0.0; FACE_NODES],
        place: [0.0; 2],
    });
    out.pieces.len() - 1
}

/// Whether a facet looks back along `normal`.
fn faces(kind: ElementKind, x: &[Vec3], normal: Vec3) -> bool {
    let centre = kind.centre();
    let p = place(kind, x, [centre[0], centre[1]]);
    normalize(cross(p.a[0], p.a[1])).is_some_and(|m| dot(m, normal) < -FACING)
}

/// Normal of a straight cell of a face.
fn cell_normal(view: &View, cell: &[usize]) -> Vec3 {
    let sum = (cell.iter()).fold([0.0; 3], |s, &k| add_scaled(s, 1.0, view.normals[k]));
    normalize(sum).unwrap_or(sum)
}

fn lines(
    view: &View,
    cell: &[usize],
    sides: &Sides,
    candidates: &[usize],
    scratch: &mut Scratch,
    out: &mut FaceIntegral,
) {
    let normal = cell_normal(view, cell);
    let (a, b) = (view.x[cell[0]], view.x[cell[1]]);
    let Some([along, _]) = plane(normal, sub(b, a)) else {
        return;
    };
    let length = dot(sub(b, a), along);
    let ends = [cell[0], cell[1]].map(|k| view.face.kind.reference().nodes()[k][0]);
    for &f in candidates {
        let facet = &sides.facets[f];
        let x = gather(&facet.nodes, sides.x);
        let x = &x[..facet.nodes.len()];
        let mut known = None;
        for other in cells(facet.kind, &facet.nodes, sides.reference) {
            let at = |k: usize| dot(sub(x[other[k]], a), along) / length;
            let (low, high) = (at(0).min(at(1)).max(0.0), at(0).max(at(1)).min(1.0));
            if high - low <= 1e-12 || !faces(facet.kind, x, normal) {
                continue;
            }
            let p = *known.get_or_insert_with(|| piece(f, out));
            let mut start = [0.0; 2];
            for (point, weight) in LINE {
                let t = low + 0.5 * (1.0 + point) * (high - low);
                let xi = [ends[0] + t * (ends[1] - ends[0]), 0.0];
                let w = 0.5 * weight * (high - low) * (ends[1] - ends[0]).abs();
                view.sample(xi, w, (p, facet.kind, x), &mut start, &mut scratch.samples);
            }
        }
    }
}

/// Where a point of the plane lies in a straight cell with these corners: their weights, and the area in the plane over that in
/// reference coordinates of the cell (a triangle has 1/2 of it, a quadrilateral 4).
fn locate(corners: &[Point], p: Point) -> Option<([f64; 4], f64)> {
    if let &[a, b, c] = corners {
        let area = |p: Point, q: Point, r: Point| {
            (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
        };
        let whole = area(a, b, c);
        let l = [area(p, b, c) / whole, area(p, c, a) / whole];
        return Some(([l[0], l[1], 1.0 - l[0] - l[1], 0.0], whole));
    }
    let weights = |[s, t]: Point| {
        [
            0.25 * (1.0 - s) * (1.0 - t),
            0.25 * (1.0 + s) * (1.0 - t),
            0.25 * (1.0 + s) * (1.0 + t),
            0.25 * (1.0 - s) * (1.0 + t),
        ]
    };
    let mut xi = [0.0; 2];
    for _ in 0..20 {
        let [s, t] = xi;
        let n = weights(xi);
        let ds = [t - 1.0, 1.0 - t, 1.0 + t, -1.0 - t].map(|d| 0.25 * d);
        let dt = [s - 1.0, -1.0 - s, 1.0 + s, 1.0 - s].map(|d| 0.25 * d);
        let (mut r, mut a, mut b) = (p, [0.0; 2], [0.0; 2]);
        for (k, c) in corners.iter().enumerate() {
            for i in 0..2 {
                r[i] -= n[k] * c[i];
                a[i] += ds[k] * c[i];
                b[i] += dt[k] * c[i];
            }
        }
        let det = a[0] * b[1] - a[1] * b[0];
        let step = [
            (b[1] * r[0] - b[0] * r[1]) / det,
            (a[0] * r[1] - a[1] * r[0]) / det,
        ];
        let longest = step[0].abs().max(step[1].abs());
        if !longest.is_finite() || longest > 1e3 {
            return None;
        }
        if longest < 1e-14 {
            return (det > 0.0).then_some((n, det));
        }
        xi = [xi[0] + step[0], xi[1] + step[1]];
    }
    None
}

fn polygons(
    view: &View,
    cell: &[usize],
    sides: &Sides,
    candidates: &[usize],
    scratch: &mut Scratch,
    out: &mut FaceIntegral,
) {
    let normal = cell_normal(view, cell);
    let origin = view.x[cell[0]];
    let Some(axes) = plane(normal, sub(view.x[cell[1]], origin)) else {
        return;
    };
    let flat = |x: Vec3| axes.map(|e| dot(sub(x, origin), e));
    let mut corners = [[0.0; 2]; 4];
    for (c, &k) in corners.iter_mut().zip(cell) {
        *c = flat(view.x[k]);
    }
    let corners = &corners[..cell.len()];
    let window = Polygon::new(corners.iter().copied());
    let size = window.area();
    if size <= 0.0 {
        return;
    }
    let bounds = |points: &[Point]| -> [f64; 4] {
        points.iter().fold(
            [f64::INFINITY, f64::INFINITY, -f64::INFINITY, -f64::INFINITY],
            |b, p| {
                [
                    b[0].min(p[0]),
                    b[1].min(p[1]),
                    b[2].max(p[0]),
                    b[3].max(p[1]),
                ]
            },
        )
    };
    let around = bounds(corners);
    let nodes = view.face.kind.reference().nodes();
    // Area of the cell in reference coordinates of the face, over that in its own.
    let own = Polygon::new(cell.iter().map(|&k| [nodes[k][0], nodes[k][1]])).area();
    let part = own / if cell.len() == 3 { 0.5 } else { 4.0 };
    for &f in candidates {
        let facet = &sides.facets[f];
        let x = gather(&facet.nodes, sides.x);
        let x = &x[..facet.nodes.len()];
        let mut known = None;
        for other in cells(facet.kind, &facet.nodes, sides.reference) {
            let mut flat_corners = [[0.0; 2]; 4];
            for (c, &k) in flat_corners.iter_mut().zip(*other) {
                *c = flat(x[k]);
            }
            let flat_corners = &flat_corners[..other.len()];
            let b = bounds(flat_corners);
            if b[0] >= around[2] || b[2] <= around[0] || b[1] >= around[3] || b[3] <= around[1] {
                continue;
            }
            let common = Polygon::new(flat_corners.iter().copied())
                .reversed()
                .cut(&window)
                .in_order(LEAST_PIECE * size);
            if common.area() <= LEAST_PIECE * size || !faces(facet.kind, x, normal) {
                continue;
            }
            let p = *known.get_or_insert_with(|| piece(f, out));
            let centre = facet.kind.centre();
            let mut start = [centre[0], centre[1]];
            let rule = rules::triangle(view.face.kind, facet.kind);
            let places = common.corners();
            for pair in places[1..].windows(2) {
                let [u, v, w] = [places[0], pair[0], pair[1]];
                let twice = (v[0] - u[0]) * (w[1] - u[1]) - (v[1] - u[1]) * (w[0] - u[0]);
                for &(l, weight) in rule {
                    let at = [0, 1].map(|i| l[0] * u[i] + l[1] * v[i] + l[2] * w[i]);
                    let Some((weights, jacobian)) = locate(corners, at) else {
                        continue;
                    };
                    let mut xi = [0.0; 2];
                    for (&k, w) in cell.iter().zip(weights) {
                        xi[0] += w * nodes[k][0];
                        xi[1] += w * nodes[k][1];
                    }
                    let weight = 0.5 * twice * weight * part / jacobian;
                    view.sample(
                        xi,
                        weight,
                        (p, facet.kind, x),
                        &mut start,
                        &mut scratch.samples,
                    );
                }
            }
        }
    }
}

/// Sums over the quadrature points.
fn sum(face: &Face, sides: &Sides, scratch: &Scratch, out: &mut FaceIntegral) {
    let n = face.nodes.len();
    let mut m = Matrix::default();
    for s in &scratch.samples {
        for (row, a) in m.iter_mut().zip(&s.positive[..n]) {
            for (m, b) in row.iter_mut().zip(&s.positive[..n]) {
                *m += s.w * a * b;
            }
        }
    }
    let functions = dual(&m, n);
    // Nodes of the primary, and where those of each piece are among them.
    let mut places: Vec<[usize; FACE_NODES]> = Vec::with_capacity(out.pieces.len());
    for piece in &out.pieces {
        let mut at = [0; FACE_NODES];
        for (at, &node) in at.iter_mut().zip(&sides.facets[piece.facet].nodes) {
            *at = match out.nodes.iter().position(|&known| known == node) {
                Some(known) => known,
                None => {
                    out.nodes.push(node);
                    out.nodes.len() - 1
                }
            };
        }
        places.push(at);
    }
    let opposite = out.nodes.len();
    out.secondary.resize(n * n, Entry::default());
    out.primary.resize(n * opposite, Entry::default());
    for s in &scratch.samples {
        let piece = &mut out.pieces[s.piece];
        let count = sides.facets[piece.facet].nodes.len();
        let at = &places[s.piece][..count];
        piece.area += s.w;
        piece.direction = add_scaled(piece.direction, s.w, s.direction);
        for (sum, x) in piece.place.iter_mut().zip(s.place) {
            *sum += s.w * x;
        }
        for (sum, n) in piece.own[..n].iter_mut().zip(&s.n) {
            *sum += s.w * n;
        }
        for (sum, n) in piece.sums.iter_mut().zip(&s.opposite[..count]) {
            *sum += s.w * n;
        }
        for a in 0..n {
            let phi = match &functions {
                Some(f) => (0..n).map(|k| f[a][k] * s.positive[k]).sum(),
                // a sliver: functions that are not dual serve as well
                None => s.positive[a],
            };
            let w = s.w * phi;
            out.area[a] += w;
            out.gap[a] += w * s.gap;
            piece.shares[a] += w;
            for (b, entry) in out.secondary[a * n..(a + 1) * n].iter_mut().enumerate() {
                entry.add(w * s.n[b], s.direction);
            }
            let row = &mut out.primary[a * opposite..(a + 1) * opposite];
            for (&k, n) in at.iter().zip(s.opposite) {
                row[k].add(w * n, s.direction);
            }
        }
    }
}
