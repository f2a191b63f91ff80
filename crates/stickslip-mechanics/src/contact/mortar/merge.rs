//! Nodes of a secondary that have no multiplier of their own, and who takes their part.
//!
//! A multiplier needs a motion that its constraint can change. A node whose motion along its normal is prescribed, or follows from that of others, has none: its
//! constraint would act on the nodes of the primary beside it alone, by whatever small weight they have there, and ask for any force. The multiplier space is reduced at
//! such nodes as at the ends of mortar lines, where displacements are given too: the function of the node is added to those of its neighbours, which so
//! still add up to one, and stay dual to the shape functions of all other nodes ([Wohlmuth 2000](stickslip_base::references::wohlmuth_2000), section 2, on the end
//! points of a line; [Puso and Laursen 2004](stickslip_base::references::puso_2004)). A node beyond the edge of the primary has a function that is small everywhere on the
//! part that is covered. What its constraint asks for would act on next to no area. Its part is taken by the neighbours as well.

use super::face::{FACE_NODES, Face, Mortar};
use super::merged_points::MergedPoints;
use crate::shape::ElementKind;

/// Which nodes of a face have no multiplier: a bit a node.
pub type Merged = u8;

/// Part of its area on one of its faces that a node has to have covered, relative to the best node of the face, to have a multiplier of its own.
///
/// A line that is covered to the share `c` has `c²` of the area of the node beyond covered. With a multiplier of its own the last pressure is too large, as it is a mean over
/// a part of what grows toward an edge and pushes against the one before it; without one it is too small, as the mean goes over more. For `c` near 0.87 both are off
/// alike, by a fifth for the end of a block under a wider plate, as of meshes that match.
const COVERED: f64 = 0.75;

/// The nodes of each face without a multiplier. `covered`: by point the part of the area that has the primary opposite, one where all has.
pub fn merged(faces: &[Face], covered: &[f64]) -> Vec<Merged> {
    let of = |face: &Face| {
        let part = |a: usize| match face.held[a] {
            true => 0.0,
            false => covered[face.points[a]],
        };
        let parts: Vec<f64> = (0..face.nodes.len()).map(part).collect();
        let most = parts.iter().copied().fold(0.0, f64::max);
        let small = |p: &f64| *p < COVERED * most;
        let bits = parts.iter().enumerate();
        bits.filter(|(_, p)| small(p))
            .fold(0, |m, (a, _)| m | 1 << a)
    };
    faces.iter().map(of).collect()
}

/// The points without a multiplier of a mortar whose held nodes are marked.
pub fn merged_points(mortar: &Mortar) -> MergedPoints {
    let mut merged = MergedPoints::default();
    for point in 0..mortar.around.len() {
        let heirs = heirs(mortar, point);
        for &(heir, area) in &heirs {
            *merged.taken.entry(heir).or_default() += area;
        }
        if heirs.iter().any(|(_, area)| *area > 0.0) {
            merged.heirs.insert(point, heirs);
        }
    }
    merged
}

/// The points that take the part of a point whose own motion is given on all faces around it, once for each face that they share, with the area `[m²]` that they take;
/// none where it keeps its multiplier.
fn heirs(mortar: &Mortar, point: usize) -> Vec<(usize, f64)> {
    let around = &mortar.around[point];
    let gives = |&(f, a): &(usize, usize)| {
        let held = &mortar.faces[f].held;
        held[a] && held.contains(&false)
    };
    if !around.iter().all(gives) {
        return Vec::new();
    }
    let of = |&(f, a): &(usize, usize)| {
        let face = &mortar.faces[f];
        let bits = face.held.iter().enumerate().filter(|(_, held)| **held);
        let merged = bits.fold(0, |m, (k, _)| m | 1 << k);
        let found = nearest(face.kind, merged, a);
        let part = face.areas[a] / found.len().max(1) as f64;
        found.into_iter().map(move |k| (face.points[k], part))
    };
    around.iter().flat_map(of).collect()
}

/// Nodes beside each other along the edges of a face.
fn beside(kind: ElementKind, a: usize) -> Vec<usize> {
    let corners = kind.corner_count();
    match (kind.dim(), kind.order()) {
        (1, 1) => vec![1 - a],
        (1, _) if a == 2 => vec![0, 1],
        (1, _) => vec![2],
        (_, 1) => vec![(a + 1) % corners, (a + corners - 1) % corners],
        _ if a < corners => vec![corners + a, corners + (a + corners - 1) % corners],
        _ => vec![a - corners, (a - corners + 1) % corners],
    }
}

/// The nearest nodes that have a multiplier, counted along edges.
fn nearest(kind: ElementKind, merged: Merged, a: usize) -> Vec<usize> {
    let has = |k: usize| merged & (1 << k) == 0;
    let (mut seen, mut front) = (1_u8 << a, vec![a]);
    while !front.is_empty() {
        let mut next = Vec::new();
        for k in front.iter().flat_map(|&k| beside(kind, k)) {
            if seen & (1 << k) == 0 {
                seen |= 1 << k;
                next.push(k);
            }
        }
        let found: Vec<usize> = next.iter().copied().filter(|&k| has(k)).collect();
        if !found.is_empty() {
            return found;
        }
        front = next;
    }
    Vec::new()
}

/// Gives the functions of nodes without a multiplier to the nearest nodes with one, in equal parts: `functions` has a row a node.
pub(super) fn give(kind: ElementKind, merged: Merged, functions: &mut [[f64; FACE_NODES]]) {
    for a in (0..kind.node_count()).filter(|a| merged & (1 << a) != 0) {
        let heirs = nearest(kind, merged, a);
        let part = 1.0 / heirs.len().max(1) as f64;
        let given = functions[a].map(|v| part * v);
        functions[a] = [0.0; FACE_NODES];
        for k in heirs {
            for (v, g) in functions[k].iter_mut().zip(given) {
                *v += g;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KINDS: [ElementKind; 6] = [
        ElementKind::Line2,
        ElementKind::Line3,
        ElementKind::Tri3,
        ElementKind::Tri6,
        ElementKind::Quad4,
        ElementKind::Quad8,
    ];

    #[test]
    fn functions_add_up_to_the_same_whoever_gives_his_away() {
        for kind in KINDS {
            let n = kind.node_count();
            for merged in 0..(1_u32 << n) - 1 {
                let merged = merged as Merged;
                let mut rows = [[0.0; FACE_NODES]; FACE_NODES];
                for (k, row) in rows.iter_mut().enumerate().take(n) {
                    row[k] = 1.0 + k as f64;
                }
                give(kind, merged, &mut rows);
                for k in 0..n {
                    let sum: f64 = rows.iter().map(|row| row[k]).sum();
                    assert!((sum - 1.0 - k as f64).abs() < 1e-12, "{kind} {merged:b}");
                    let gone = merged & (1 << k) != 0;
                    assert_eq!(gone, rows[k] == [0.0; FACE_NODES], "{kind} {merged:b} {k}");
                }
            }
        }
    }

    #[test]
    fn a_held_edge_gives_its_functions_across_the_face() {
        let heirs = |kind, merged, a| {
            let mut found = nearest(kind, merged, a);
            found.sort_unstable();
            found
        };
        assert_eq!(heirs(ElementKind::Quad4, 0b1001, 0), [1]);
        assert_eq!(heirs(ElementKind::Quad4, 0b1001, 3), [2]);
        assert_eq!(heirs(ElementKind::Quad4, 0b0001, 0), [1, 3]);
        // corners 0 and 3 and the node between them
        assert_eq!(heirs(ElementKind::Quad8, 0b1000_1001, 7), [4, 6]);
        assert_eq!(heirs(ElementKind::Line3, 0b001, 0), [2]);
    }

    fn line(held: [bool; 2]) -> Face {
        Face {
            kind: ElementKind::Line2,
            nodes: vec![0, 1],
            points: vec![0, 1],
            normals: vec![[0.0, 1.0, 0.0]; 2],
            extents: vec![1.0; 2],
            areas: vec![0.5; 2],
            area: 1.0,
            held: held.to_vec(),
            depth: f64::INFINITY,
            continues: Vec::new(),
        }
    }

    #[test]
    fn a_face_whose_nodes_are_all_held_keeps_their_multipliers() {
        let of = |held, covered: &[f64]| merged(&[line(held)], covered)[0];
        assert_eq!(of([true, true], &[1.0, 1.0]), 0b00);
        assert_eq!(of([true, false], &[1.0, 1.0]), 0b01);
        assert_eq!(of([false, false], &[1.0, 0.7]), 0b10);
        assert_eq!(of([false, false], &[1.0, 0.8]), 0b00);
        assert_eq!(of([true, false], &[1.0, 0.1]), 0b01, "the one not held");
        assert_eq!(of([false, false], &[0.1, 0.1]), 0b00, "a rib under a face");
    }
}
