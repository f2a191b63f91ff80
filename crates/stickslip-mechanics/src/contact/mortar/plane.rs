//! A cell that is a triangle or a quadrilateral: what it has in common with others is a polygon in the plane across its normal.

use super::clip::{Point, Polygon};
use super::rules;
use super::view::View;
use super::window::{Window, frame};
use crate::contact::projection::FARTHEST;
use crate::math::{Vec3, dot, sub};
use crate::shape::ElementKind;

/// Steps of Newton's method for a place in a quadrilateral.
const ITERATIONS: usize = 20;

/// Most corners of a cell.
const CELL_CORNERS: usize = 4;

/// A cell in a plane.
pub(super) struct Plane {
    kind: ElementKind,
    origin: Vec3,
    axes: [Vec3; 2],
    /// Its corners in the plane, with their reference coordinates on the face.
    corners: [Point; CELL_CORNERS],
    nodes: [Point; CELL_CORNERS],
    count: usize,
    polygon: Polygon,
    size: f64,
    around: [f64; 4],
    /// Area of the cell in reference coordinates of the face, over that in its own.
    part: f64,
}

/// The smallest and the largest coordinates.
fn bounds(points: &[Point]) -> [f64; 4] {
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
}

impl Plane {
    /// `None` of a cell without area.
    pub fn new(view: &View, cell: &[usize], normal: Vec3) -> Option<Self> {
        let origin = view.x[cell[0]];
        let axes = frame(normal, sub(view.x[cell[1]], origin))?;
        let reference = view.face.kind.reference().nodes();
        let (mut corners, mut nodes) = ([[0.0; 2]; CELL_CORNERS], [[0.0; 2]; CELL_CORNERS]);
        for ((corner, node), &k) in corners.iter_mut().zip(&mut nodes).zip(cell) {
            *corner = axes.map(|e| dot(sub(view.x[k], origin), e));
            *node = [reference[k][0], reference[k][1]];
        }
        let count = cell.len();
        let polygon = Polygon::new(corners[..count].iter().copied());
        let size = polygon.area();
        if size <= 0.0 {
            return None;
        }
        let own = Polygon::new(nodes[..count].iter().copied()).area();
        Some(Plane {
            kind: view.face.kind,
            origin,
            axes,
            around: bounds(&corners[..count]),
            corners,
            part: own / if count == 3 { 0.5 } else { 4.0 },
            count,
            nodes,
            polygon,
            size,
        })
    }

    /// Reference coordinates on the face of a place in the plane, and the area there over that here.
    fn on_face(&self, at: Point) -> Option<(Point, f64)> {
        let (weights, jacobian) = locate(&self.corners[..self.count], at)?;
        let mut xi = [0.0; 2];
        for (node, w) in self.nodes.iter().zip(weights) {
            xi[0] += w * node[0];
            xi[1] += w * node[1];
        }
        Some((xi, jacobian))
    }
}

impl Window for Plane {
    type Part = Polygon;

    fn common(&self, x: &[Vec3], other: &[usize]) -> Option<Polygon> {
        let mut corners = [[0.0; 2]; CELL_CORNERS];
        for (c, &k) in corners.iter_mut().zip(other) {
            *c = self.axes.map(|e| dot(sub(x[k], self.origin), e));
        }
        let corners = &corners[..other.len()];
        let (a, b) = (&self.around, bounds(corners));
        if b[0] >= a[2] || b[2] <= a[0] || b[1] >= a[3] || b[3] <= a[1] {
            return None;
        }
        // A smaller piece of a cell is nothing.
        let least = 1e-14 * self.size;
        let common = Polygon::new(corners.iter().copied())
            .reversed()
            .cut(&self.polygon)
            .in_order(least);
        let nothing = common.area() <= least;
        (!nothing).then_some(common)
    }

    fn places(&self, common: &Polygon, facet: ElementKind, sample: &mut dyn FnMut(Point, f64)) {
        let rule = rules::triangle(self.kind, facet);
        let corners = common.corners();
        for pair in corners[1..].windows(2) {
            let [u, v, w] = [corners[0], pair[0], pair[1]];
            let twice = (v[0] - u[0]) * (w[1] - u[1]) - (v[1] - u[1]) * (w[0] - u[0]);
            for &(l, weight) in rule {
                let at = [0, 1].map(|i| l[0] * u[i] + l[1] * v[i] + l[2] * w[i]);
                if let Some((xi, jacobian)) = self.on_face(at) {
                    sample(xi, 0.5 * twice * weight * self.part / jacobian);
                }
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
    let &[a, b, c, d] = corners else {
        return None;
    };
    let sum = |f: [f64; 4]| {
        [0, 1].map(|i| 0.25 * (f[0] * a[i] + f[1] * b[i] + f[2] * c[i] + f[3] * d[i]))
    };
    let middle = sum([1.0, 1.0, 1.0, 1.0]);
    let along = sum([-1.0, 1.0, 1.0, -1.0]);
    let across = sum([-1.0, -1.0, 1.0, 1.0]);
    let twist = sum([1.0, -1.0, 1.0, -1.0]);
    let [mut s, mut t] = [0.0; 2];
    for _ in 0..ITERATIONS {
        let u = [0, 1].map(|i| along[i] + t * twist[i]);
        let v = [0, 1].map(|i| across[i] + s * twist[i]);
        let r = [0, 1].map(|i| p[i] - middle[i] - s * along[i] - t * v[i]);
        let det = u[0] * v[1] - u[1] * v[0];
        let step = [
            (v[1] * r[0] - v[0] * r[1]) / det,
            (u[0] * r[1] - u[1] * r[0]) / det,
        ];
        let longest = step[0].abs().max(step[1].abs());
        if !longest.is_finite() || longest > FARTHEST {
            return None;
        }
        // After such a step in reference coordinates the place is found.
        if longest < 1e-14 {
            let weights = [
                0.25 * (1.0 - s) * (1.0 - t),
                0.25 * (1.0 + s) * (1.0 - t),
                0.25 * (1.0 + s) * (1.0 + t),
                0.25 * (1.0 - s) * (1.0 + t),
            ];
            return (det > 0.0).then_some((weights, det));
        }
        s += step[0];
        t += step[1];
    }
    None
}
