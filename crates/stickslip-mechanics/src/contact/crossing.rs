//! Surfaces that run through themselves: a meshing mistake (bodies merged over each other, a fold, a wrong set) that would leave
//! points between two sheets without a side to be on.

use super::search::Tree;
use super::surface::{Facet, triangulate};
use crate::math::{Vec3, cross, distance, dot, norm, scale, sub};
use crate::tolerance::{NEGLIGIBLE, SAME};

/// The first two facets that run through each other, as positions in `facets`, whose nodes are positions in `x`. Neighbours, which
/// share a node, do not count; curved facets are taken as the plane pieces between their nodes.
pub fn crossing(facets: &[Facet], x: &[Vec3]) -> Option<(usize, usize)> {
    let tree = Tree::build(facets.iter().map(|f| f.nodes.iter().map(|&n| x[n])));
    let pieces: Vec<Vec<Vec<Vec3>>> = facets
        .iter()
        .map(|f| {
            let coordinates = |p: &Facet| p.nodes.iter().map(|&n| x[n]).collect();
            triangulate(vec![f.clone()])
                .iter()
                .map(coordinates)
                .collect()
        })
        .collect();
    let mut near = Vec::new();
    for (i, facet) in facets.iter().enumerate() {
        let count = facet.nodes.len() as f64;
        let sum = |c: usize| facet.nodes.iter().map(|&n| x[n][c]).sum::<f64>();
        let centre = scale(1.0 / count, std::array::from_fn(sum));
        let radius = facet.nodes.iter().map(|&n| distance(x[n], centre));
        tree.near(centre, radius.fold(0.0, f64::max), &mut near);
        for &j in near.iter().filter(|&&j| j > i) {
            let shared = facet.nodes.iter().any(|n| facets[j].nodes.contains(n));
            let cross = |a: &Vec<Vec3>| pieces[j].iter().any(|b| pieces_cross(a, b));
            if !shared && pieces[i].iter().any(cross) {
                return Some((i, j));
            }
        }
    }
    None
}

/// Whether two segments of the plane, or two triangles in space, run through each other.
fn pieces_cross(a: &[Vec3], b: &[Vec3]) -> bool {
    match (a, b) {
        ([a0, a1], [b0, b1]) => segments_cross([*a0, *a1], [*b0, *b1]),
        ([a0, a1, a2], [b0, b1, b2]) => {
            // Of two triangles that run through each other one is pierced by an edge of the other.
            let pierced = |t: [Vec3; 3], other: [Vec3; 3]| {
                (0..3).any(|k| edge_pierces([other[k], other[(k + 1) % 3]], t))
            };
            let (a, b) = ([*a0, *a1, *a2], [*b0, *b1, *b2]);
            pierced(a, b) || pierced(b, a)
        }
        _ => false,
    }
}

fn inside(s: f64) -> bool {
    // A common point must lie inside both facets: facets that merely touch do not cross.
    s > NEGLIGIBLE && s < 1.0 - NEGLIGIBLE
}

/// Segments in the plane z = 0.
fn segments_cross(a: [Vec3; 2], b: [Vec3; 2]) -> bool {
    let (r, w, d) = (sub(a[1], a[0]), sub(b[1], b[0]), sub(b[0], a[0]));
    let sine = cross(r, w)[2];
    if sine.abs() <= SAME * norm(r) * norm(w) {
        return false;
    }
    inside(cross(d, w)[2] / sine) && inside(cross(d, r)[2] / sine)
}

/// Whether an edge goes through the inside of a triangle: `edge[0] + s r = t[0] + u e1 + v e2`.
fn edge_pierces(edge: [Vec3; 2], t: [Vec3; 3]) -> bool {
    let (r, e1, e2) = (sub(edge[1], edge[0]), sub(t[1], t[0]), sub(t[2], t[0]));
    let normal = cross(e1, e2);
    let sine = dot(normal, r);
    if sine.abs() <= SAME * norm(normal) * norm(r) {
        return false;
    }
    let d = sub(edge[0], t[0]);
    let s = -dot(normal, d) / sine;
    let q = cross(d, r);
    let (u, v) = (-dot(e2, q) / sine, dot(e1, q) / sine);
    inside(s) && u > NEGLIGIBLE && v > NEGLIGIBLE && u + v < 1.0 - NEGLIGIBLE
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::ElementKind;

    fn facet(kind: ElementKind, nodes: &[usize]) -> Facet {
        Facet {
            kind,
            nodes: nodes.to_vec(),
            continues: Vec::new(),
            modulus: 0.0,
            cell: 0,
        }
    }

    /// A chain of lines through the points.
    fn chain(points: &[[f64; 2]]) -> Option<(usize, usize)> {
        let facets: Vec<Facet> = (1..points.len())
            .map(|i| facet(ElementKind::Line2, &[i - 1, i]))
            .collect();
        let x: Vec<Vec3> = points.iter().map(|p| [p[0], p[1], 0.0]).collect();
        crossing(&facets, &x)
    }

    #[test]
    fn a_loop_in_the_plane_is_found_and_a_hook_is_not() {
        let hook = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 0.1]];
        assert_eq!(chain(&hook), None);
        let mut knot = hook.to_vec();
        knot[4][1] = -0.1;
        assert_eq!(chain(&knot), Some((0, 3)));
        // ending on the first line, or running along it, is touching
        knot[4][1] = 0.0;
        assert_eq!(chain(&knot), None);
        knot.push([0.5, 0.0]);
        assert_eq!(chain(&knot), None);
    }

    #[test]
    fn a_long_wavy_line_is_searched_far_and_wide() {
        let mut points: Vec<[f64; 2]> = (0..200)
            .map(|i| [i as f64 * 0.1, (i as f64 * 0.7).sin()])
            .collect();
        assert_eq!(chain(&points), None);
        // back over the line in one long facet
        points.push([20.0, 3.0]);
        points.push([0.05, -2.0]);
        assert!(matches!(chain(&points), Some((_, 200))));
    }

    /// Two quadrilaterals: one in the plane z = 0, one upright whose lower edge is at `bottom`.
    fn upright(kind: ElementKind, bottom: f64) -> Option<(usize, usize)> {
        let mut x: Vec<Vec3> = vec![
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.3, 0.2, bottom],
            [0.6, 0.7, bottom],
            [0.6, 0.7, 2.0],
            [0.3, 0.2, 2.0],
        ];
        let mut facets = vec![facet(kind, &[0, 1, 2, 3]), facet(kind, &[4, 5, 6, 7])];
        if kind == ElementKind::Quad8 {
            for f in &mut facets {
                for k in 0..4 {
                    let (a, b) = (x[f.nodes[k]], x[f.nodes[(k + 1) % 4]]);
                    f.nodes.push(x.len());
                    x.push(scale(0.5, crate::math::add(a, b)));
                }
            }
        }
        if kind == ElementKind::Tri3 {
            for f in &mut facets {
                f.nodes.pop();
            }
        }
        crossing(&facets, &x)
    }

    #[test]
    fn surfaces_in_space_cross_or_touch() {
        for kind in [ElementKind::Tri3, ElementKind::Quad4, ElementKind::Quad8] {
            assert_eq!(upright(kind, -0.1), Some((0, 1)), "{kind:?}");
            assert_eq!(upright(kind, 0.0), None, "{kind:?}");
            assert_eq!(upright(kind, 0.1), None, "{kind:?}");
        }
    }

    #[test]
    fn neighbours_do_not_count() {
        // a fold flat onto itself
        let x = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.2, 0.2, 0.0],
        ];
        let facets = [
            facet(ElementKind::Tri3, &[0, 1, 2]),
            facet(ElementKind::Tri3, &[1, 0, 3]),
        ];
        assert_eq!(crossing(&facets, &x), None);
    }
}
