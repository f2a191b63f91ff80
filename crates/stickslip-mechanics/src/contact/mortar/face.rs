//! The secondary as faces.

use std::collections::BTreeMap;

use super::merged_points::MergedPoints;
use crate::contact::surface::edges;
use crate::math::{Vec3, dot};
use crate::shape::ElementKind;

/// Most nodes of a face.
pub const FACE_NODES: usize = 8;

/// A face of the secondary.
#[derive(Debug, Clone, PartialEq)]
pub struct Face {
    /// Line, triangle or quadrilateral, linear or quadratic.
    pub kind: ElementKind,
    /// Its nodes, oriented so that the normal points out of the body.
    pub nodes: Vec<usize>,
    /// The contact point of each node.
    pub points: Vec<usize>,
    /// Unit normal at each node out of the body, averaged where the surface is smooth, in the reference configuration.
    pub normals: Vec<Vec3>,
    /// Extent out of the plane at each node: thickness or `2πr` `[m]`; one in 3D.
    pub extents: Vec<f64>,
    /// The part of each node of its area, by the function of positive integral `[m²]`.
    pub areas: Vec<f64>,
    /// Its area in the reference configuration `[m²]`.
    pub area: f64,
    /// Whether the motion of each node that contact would change is prescribed in some step, or follows from that of others.
    pub held: Vec<bool>,
    /// How deep behind it a place may lie and be met `[m]`: half of the body's thickness there, where its other side belongs to the surface, else infinite.
    pub depth: f64,
    /// For each edge (3D) or end (2D), whether the surface goes smoothly on beyond it; [`Mortar::new`] finds out.
    pub continues: Vec<bool>,
}

/// The secondary as faces.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mortar {
    /// The faces.
    pub faces: Vec<Face>,
    /// Faces around each contact point, and its position among their nodes.
    pub around: Vec<Vec<(usize, usize)>>,
    /// Points without a multiplier; none before held nodes have been marked.
    pub merged: MergedPoints,
}

impl Mortar {
    /// From faces, for this many contact points.
    pub fn new(mut faces: Vec<Face>, points: usize) -> Self {
        connect(&mut faces);
        let mut around = vec![Vec::new(); points];
        for (f, face) in faces.iter().enumerate() {
            for (a, &point) in face.points.iter().enumerate() {
                around[point].push((f, a));
            }
        }
        Mortar {
            faces,
            around,
            merged: MergedPoints::default(),
        }
    }
}

/// Cosine of the angle between the normals that two faces have at a node from which on they meet at an edge of the body: normals are
/// averaged where the surface is smooth. It is an angle of 2.6 degrees; with 0.8 and with 8
/// degrees all short cases (see [`tolerance`](crate::tolerance)) have the same digits.
const SMOOTH_COSINE: f64 = 0.999;

/// Finds out which edges are shared with a face that goes smoothly on.
fn connect(faces: &mut [Face]) {
    let mut known: BTreeMap<Vec<usize>, Vec<(usize, usize)>> = BTreeMap::new();
    for (f, face) in faces.iter_mut().enumerate() {
        face.continues = vec![false; edges(face.kind).len()];
        for (e, corners) in edges(face.kind).iter().enumerate() {
            let mut key: Vec<usize> = corners.iter().map(|&k| face.nodes[k]).collect();
            key.sort_unstable();
            known.entry(key).or_default().push((f, e));
        }
    }
    let normal = |faces: &[Face], f: usize, node: usize| {
        let face = &faces[f];
        let at = face.nodes.iter().position(|&n| n == node);
        at.and_then(|k| face.normals.get(k).copied())
    };
    for (nodes, sides) in &known {
        let [(f, e), (g, h)] = sides[..] else {
            continue;
        };
        let smooth = nodes.iter().all(|&node| {
            let both = normal(faces, f, node).zip(normal(faces, g, node));
            both.is_some_and(|(a, b)| dot(a, b) > SMOOTH_COSINE)
        });
        faces[f].continues[e] = smooth;
        faces[g].continues[h] = smooth;
    }
}
