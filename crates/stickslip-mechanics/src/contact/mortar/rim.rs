//! Where the primary ends over the inside of the secondary.
//!
//! Two surfaces at an angle touch at an edge. If that is an edge of the secondary, it touches a facet, and pressure acts along the normal of the primary: the gradient of the gap at fixed places.
//! If it is an edge of the primary it touches a face, and pressure acts along the normal of the face: what the edge does by being moved along its own facet is in the cut, which
//! the gradient at fixed places does not include. Which of the two it is shows where the gap becomes smaller: there one surface ends before the other.

use super::face::Face;
use super::sides::Sides;
use crate::contact::facet_point::FACET_NODES;
use crate::contact::projection::Patch;
use crate::contact::surface::edges;
use crate::math::{Vec3, add_scaled, cross, dot, norm, normalize, scale, sub};
use crate::shape::ElementKind;
use crate::tolerance::NEGLIGIBLE;

/// Sines of the angle between two surfaces up to which they lie on each other, and from which they touch at an edge. Strains turn what is pressed flat by no more than the lower one, the limit
/// that small strains have, and there both normals are the same to that part.
const ANGLES: [f64; 2] = [0.05, 0.1];

/// Facets after which no farther ones are looked at.
const STEPS: usize = 16;

/// What lies around a place of a face and a facet opposite.
pub(super) struct Rim<'a> {
    pub face: &'a Face,
    /// Coordinates of its nodes now, and its outward normal.
    pub x: &'a [Vec3],
    pub outward: Vec3,
    pub sides: &'a Sides<'a>,
    /// What may lie opposite the face, whether the primary ends at an edge of any of it, and the facet that does.
    pub candidates: &'a [usize],
    pub ends: bool,
    pub facet: usize,
}

impl Rim<'_> {
    /// The gradient of a gap that is measured along `normal` from the place `from` of the face to `foot` on the facet, whose normal is `m`.
    pub fn direction(&self, from: Vec3, normal: Vec3, foot: Vec3, m: Vec3) -> Vec3 {
        let plain = scale(-1.0 / dot(normal, m), m);
        if !self.ends {
            return plain;
        }
        let tilt = norm(cross(self.outward, m));
        let [flat, edge] = ANGLES;
        let share = ((tilt - flat) / (edge - flat)).min(1.0);
        let along = dot(normal, self.outward);
        if share <= 0.0 || along <= 0.0 || !self.primary_ends(from, foot, m) {
            return plain;
        }
        // One along the ray, as the other.
        let own = scale(-1.0 / along, self.outward);
        add_scaled(scale(1.0 - share, plain), share, own)
    }

    /// Whether on the way on which the gap becomes smaller the primary ends before the secondary.
    fn primary_ends(&self, from: Vec3, foot: Vec3, m: Vec3) -> bool {
        let Some(mut way) = downhill(self.outward, m) else {
            return false;
        };
        let (mut f, mut x, mut m) = (self.facet, foot, m);
        for _ in 0..STEPS {
            let facet = &self.sides.facets[f];
            let mut nodes = [[0.0; 3]; FACET_NODES];
            let nodes = facet.gather(self.sides.x, &mut nodes);
            let Some((edge, length)) = leave(facet.kind, nodes, m, x, way) else {
                return false;
            };
            x = add_scaled(x, length, way);
            if facet.continues.get(edge) == Some(&false) {
                let size = norm(sub(nodes[0], nodes[1]));
                return !self.mirrored(x, size) && self.secondary_reaches(from, x, way);
            }
            let shared: Vec<usize> = (edges(facet.kind)[edge].iter())
                .map(|&k| facet.nodes[k])
                .collect();
            let other = |&&c: &&usize| {
                let nodes = &self.sides.facets[c].nodes;
                c != f && shared.iter().all(|n| nodes.contains(n))
            };
            let Some(&next) = self.candidates.iter().find(other) else {
                return false;
            };
            let facet = &self.sides.facets[next];
            let mut nodes = [[0.0; 3]; FACET_NODES];
            let patch = Patch::new(facet.kind, facet.gather(self.sides.x, &mut nodes));
            let Some(normal) = normal(&patch) else {
                return false;
            };
            // Where it rises again the surfaces touch inside of both.
            match downhill(self.outward, normal) {
                Some(next) if dot(next, way) > 0.0 => way = next,
                _ => return false,
            }
            (f, m) = (next, normal);
        }
        false
    }

    /// Whether a place lies on a plane of symmetry, beyond which the surfaces go on as their images.
    fn mirrored(&self, at: Vec3, size: f64) -> bool {
        let mut planes = self.sides.mirrors.iter();
        planes.any(|&(axis, place)| (at[axis] - place).abs() <= NEGLIGIBLE * size)
    }

    /// Whether the secondary is still there where the primary ends, at `end`.
    fn secondary_reaches(&self, from: Vec3, end: Vec3, way: Vec3) -> bool {
        let flat = add_scaled(way, -dot(way, self.outward), self.outward);
        let Some(along) = normalize(flat) else {
            return false;
        };
        let Some((edge, length)) = leave(self.face.kind, self.x, self.outward, from, along) else {
            return false;
        };
        let continues = self.face.continues.get(edge).is_some_and(|&c| c);
        // Where both end at one place, as on a plane of symmetry, what they stand apart looks like a piece of one beyond the other: a part of that height, as they are tilted.
        let beyond = sub(end, add_scaled(from, length, along));
        continues || dot(beyond, along) < -dot(beyond, self.outward).abs()
    }
}

/// The direction in the plane with the normal `m` in which it comes nearest to a surface with the outward normal `n`.
fn downhill(n: Vec3, m: Vec3) -> Option<Vec3> {
    normalize(sub(scale(dot(n, m), m), n))
}

/// The outward normal in the middle of a patch.
pub(super) fn normal(patch: &Patch) -> Option<Vec3> {
    let [s, t, _] = patch.kind.centre();
    let (_, a) = patch.at([s, t]);
    normalize(cross(a[0], a[1]))
}

/// The edge by which a way from a place within a polygon leaves it, and how long that is; `normal` is its own.
fn leave(
    kind: ElementKind,
    x: &[Vec3],
    normal: Vec3,
    from: Vec3,
    way: Vec3,
) -> Option<(usize, f64)> {
    let each = edges(kind).iter().enumerate();
    let left = each.filter_map(|(k, corners)| match **corners {
        [end] => {
            let length = dot(sub(x[end], from), way);
            let other = x[1 - end];
            (dot(sub(x[end], other), way) > 0.0).then_some((k, length))
        }
        [a, b] => {
            let out = cross(sub(x[b], x[a]), normal);
            let rate = dot(way, out);
            (rate > 0.0).then(|| (k, dot(sub(x[a], from), out) / rate))
        }
        _ => None,
    });
    let nearest = left.min_by(|a, b| a.1.total_cmp(&b.1));
    nearest.map(|(k, length)| (k, length.max(0.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_way_leaves_a_polygon_by_the_edge_it_comes_to_first() {
        let line = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
        let up = [0.0, 1.0, 0.0];
        let from = [0.5, 0.0, 0.0];
        let right = leave(ElementKind::Line2, &line, up, from, [1.0, 0.0, 0.0]);
        assert_eq!(right, Some((1, 1.5)));
        let left = leave(ElementKind::Line2, &line, up, from, [-1.0, 0.0, 0.0]);
        assert_eq!(left, Some((0, 0.5)));
        let square = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 1.0, 0.0],
        ];
        let z = [0.0, 0.0, 1.0];
        let from = [0.5, 0.25, 0.0];
        for (way, edge, length) in [
            ([1.0, 0.0, 0.0], 1, 0.5),
            ([0.0, 1.0, 0.0], 2, 0.75),
            ([0.0, -1.0, 0.0], 0, 0.25),
            ([-1.0, 0.0, 0.0], 3, 0.5),
        ] {
            let found = leave(ElementKind::Quad4, &square, z, from, way);
            assert_eq!(found, Some((edge, length)));
        }
    }

    #[test]
    fn a_plane_comes_nearest_downhill() {
        // Over a floor that looks up, a plane that rises to the right.
        let m = normalize([0.2, -1.0, 0.0]).expect("a normal");
        let way = downhill([0.0, 1.0, 0.0], m).expect("a slope");
        assert!(way[0] < 0.0 && way[1] < 0.0 && dot(way, m).abs() < 1e-15);
        assert_eq!(downhill([0.0, 1.0, 0.0], [0.0, -1.0, 0.0]), None);
    }
}
