//! How thick the body is behind each facet of the primary and each face of the secondary, where its other face belongs to the same surface.
//!
//! A point can lie behind a facet because it has entered the body, or because it lies beyond its other face and looks the same way as the surfaces that could
//! enter: the top of a block that stands on a wall lies behind the bottom of the wall. Half of the thickness tells the two apart: what is deeper
//! is nearer to the other face, unless it has come there within the increment.

use std::sync::OnceLock;

use super::facet_point::{FACET_NODES, evaluate};
use super::search::Tree;
use super::surface::Facet;
use crate::math::{Vec3, add_scaled, cross, distance, dot, norm, scale, sub};
use crate::tolerance::NEGLIGIBLE;

/// Depths behind the facets of a surface at which a point is none of them any more.
#[derive(Debug, Clone, Default)]
pub struct Walls {
    depths: OnceLock<Vec<f64>>,
}

/// Cosine of the angle, beyond a right one, by which a face has to look against another to be opposite to it, some 6 degrees: faces that stand at right
/// angles are no two sides of a gap or of a wall. Between 0.03 and 0.3 histories of the short cases (see [`tolerance`](crate::tolerance)) are
/// the same to 1e-9; the largest pressure of one random problem, 20, moves by 4e-10.
pub(super) const OPPOSED_COSINE: f64 = 0.1;

impl Walls {
    /// Of facets with nodes at `x` in the reference configuration: by facet the depth behind it down to which it may be met, infinite where no other face lies
    /// there. Empty where that is so of all.
    pub fn of(&self, facets: &[Facet], x: &[Vec3]) -> &[f64] {
        self.depths.get_or_init(|| depths(facets, x))
    }
}

/// The depth behind a facet down to which it may be met.
#[inline]
pub fn depth_behind(walls: &[f64], facet: usize) -> f64 {
    walls.get(facet).copied().unwrap_or(f64::INFINITY)
}

/// By facet with nodes at `x`, the depth behind it down to which it may be met `[m]`; empty where it is infinite for all.
pub fn depths(facets: &[Facet], x: &[Vec3]) -> Vec<f64> {
    let middles: Vec<(Vec3, Vec3)> = facets.iter().map(|f| middle(f, x)).collect();
    // Nothing lies behind facets that all look the same way.
    let opposed = |&(_, n): &(Vec3, Vec3)| dot(n, middles[0].1) < -OPPOSED_COSINE;
    let mut any = middles.iter().skip(1).any(opposed);
    if !any && facets.len() > 1 {
        let (mut low, mut high) = (middles[0].1, middles[0].1);
        for (_, n) in &middles {
            for i in 0..3 {
                low[i] = low[i].min(n[i]);
                high[i] = high[i].max(n[i]);
            }
        }
        any = (0..3).any(|i| low[i] < -OPPOSED_COSINE && high[i] > OPPOSED_COSINE);
    }
    if !any {
        return Vec::new();
    }
    let tree = Tree::build(facets.iter().map(|f| f.nodes.iter().map(|&n| x[n])));
    let mut crossed = Vec::new();
    // Faces that meet at an edge make a wedge, whose tip has no other side.
    let meet = |f: usize, g: usize| facets[f].nodes.iter().any(|n| facets[g].nodes.contains(n));
    let all: Vec<f64> = middles
        .iter()
        .enumerate()
        .map(|(f, &(from, normal))| {
            let inward = scale(-1.0, normal);
            tree.along(from, inward, &mut crossed);
            let beyond = crossed.iter();
            let beyond =
                beyond.filter(|&&g| dot(middles[g].1, normal) < -OPPOSED_COSINE && !meet(f, g));
            let thickness = beyond.filter_map(|&g| meets(&facets[g], x, from, inward));
            // A point is behind a facet up to half of the thickness.
            0.5 * thickness.fold(f64::INFINITY, f64::min)
        })
        .collect();
    match all.iter().any(|d| d.is_finite()) {
        true => all,
        false => Vec::new(),
    }
}

/// The middle of a facet and its normal there.
fn middle(facet: &Facet, x: &[Vec3]) -> (Vec3, Vec3) {
    let mut nodes = [[0.0; 3]; FACET_NODES];
    let [s, t, _] = facet.kind.centre();
    let p = evaluate(facet.kind, facet.gather(x, &mut nodes), [s, t]);
    (p.x, p.normal)
}

/// How far along a ray it meets a facet, taken for its corners; `None` where it does not.
fn meets(facet: &Facet, x: &[Vec3], from: Vec3, along: Vec3) -> Option<f64> {
    let corners = &facet.nodes[..facet.kind.corner_count()];
    let at = |k: usize| x[corners[k]];
    if corners.len() == 2 {
        // in the plane: the ray crosses the line between both ends
        let line = sub(at(1), at(0));
        let across = |a: Vec3, b: Vec3| a[0] * b[1] - a[1] * b[0];
        let slant = across(line, along);
        let to = sub(from, at(0));
        let place = across(to, along) / slant;
        let way = across(to, line) / slant;
        // A ray meets a facet that it passes this near to: it must not slip through between two.
        let hit = (-NEGLIGIBLE..=1.0 + NEGLIGIBLE).contains(&place) && way > 0.0;
        return hit.then_some(way);
    }
    let fan = (1..corners.len() - 1).filter_map(|k| {
        let (a, b, c) = (at(0), at(k), at(k + 1));
        let normal = cross(sub(b, a), sub(c, a));
        let way = dot(sub(a, from), normal) / dot(along, normal);
        let p = add_scaled(from, way, along);
        let side = |a: Vec3, b: Vec3| {
            let room = NEGLIGIBLE * norm(normal) * distance(a, b);
            dot(cross(sub(b, a), sub(p, a)), normal) >= -room * norm(normal).sqrt()
        };
        (way > 0.0 && side(a, b) && side(b, c) && side(c, a)).then_some(way)
    });
    fan.reduce(f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::ElementKind;

    fn facet(kind: ElementKind, nodes: &[usize]) -> Facet {
        Facet {
            kind,
            nodes: nodes.to_vec(),
            continues: vec![false; nodes.len()],
            modulus: 1.0,
            cell: 0,
        }
    }

    #[test]
    fn behind_both_faces_of_a_wall_lies_half_of_its_thickness() {
        // The top is one facet, the bottom two; the body is between y = -0.2 and 0.
        let x = [
            [1.0, 0.0, 0.0],
            [0.0, 0.0, 0.0],
            [0.0, -0.2, 0.0],
            [0.4, -0.2, 0.0],
            [1.0, -0.2, 0.0],
        ];
        let line = |a, b| facet(ElementKind::Line2, &[a, b]);
        let both = [line(0, 1), line(2, 3), line(3, 4)];
        let walls = Walls::default();
        let found = walls.of(&both, &x);
        assert!(found.iter().all(|d| (d - 0.1).abs() < 1e-12), "{found:?}");
        let one = Walls::default();
        assert!(one.of(&both[..1], &x).is_empty());
    }

    #[test]
    fn a_facet_in_space_sees_the_one_behind_it_and_no_other() {
        let square = |z: f64, aside: f64| {
            [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[a, b]| [a + aside, b, z])
        };
        let x = [square(0.0, 0.0), square(-0.3, 0.0), square(-0.1, 2.0)].concat();
        let quad = |nodes: &[usize]| facet(ElementKind::Quad4, nodes);
        let facets = [
            quad(&[0, 1, 2, 3]),
            quad(&[7, 6, 5, 4]),
            quad(&[11, 10, 9, 8]),
        ];
        let walls = Walls::default();
        let found = walls.of(&facets, &x);
        assert!((found[0] - 0.15).abs() < 1e-12 && (found[1] - 0.15).abs() < 1e-12);
        assert_eq!(found[2], f64::INFINITY);
    }
}
