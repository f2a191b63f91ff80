//! Which facets the points and faces of an interface may meet, and until when that holds.

use rayon::prelude::*;

use super::evaluation::EVALUATED_PER_TASK;
use crate::contact::mortar::Face;
use crate::contact::search::Tree;
use crate::contact::surface::{ContactPoint, Facet};
use crate::math::{Vec3, add_scaled, distance};

/// Facets near points.
#[derive(Debug, Clone, Default)]
pub(in crate::contact) struct Search {
    /// By point, ascending.
    pub candidates: Vec<Vec<usize>>,
    /// Coordinates for which they were found.
    at: Vec<Vec3>,
    /// Distance up to which facets are candidates `[m]`.
    pub margin: f64,
    /// Outward normals of the points then; empty where those of the reference serve.
    pub facing: Vec<Vec3>,
}

/// Facets near the faces of a mortar.
#[derive(Debug, Clone, Default)]
pub(in crate::contact) struct FaceSearch {
    /// By face.
    pub opposite: Vec<Vec<usize>>,
    /// Coordinates for which they were found.
    at: Vec<Vec3>,
}

/// Faces looked at or integrated by one task.
pub(super) const FACES_PER_TASK: usize = 8;

impl Search {
    /// Whether the points have moved so far that a nearer facet might be missing from the candidates.
    pub fn stale(&self, x: &[Vec3]) -> bool {
        let moved = (self.at.iter().zip(x)).map(|(&a, &b)| distance(a, b));
        let moved = moved.fold(0.0, f64::max);
        // Facets are looked for again once points have moved by this part of the margin.
        self.at.len() != x.len() || moved > 0.25 * self.margin
    }

    /// Coordinates at the last search; empty before there was one.
    pub fn at(&self) -> &[Vec3] {
        &self.at
    }

    /// Looks for the facets near points at coordinates `x`; `facing`: the outward normals there.
    pub fn renew(
        &mut self,
        points: &[ContactPoint],
        facets: &[Facet],
        x: &[Vec3],
        facing: Vec<Vec3>,
    ) {
        let size = |f: &Facet| distance(x[f.nodes[0]], x[f.nodes[1]]);
        // Curved facets leave the boxes of their nodes by a part of their size. Flat ones do not, and where a mesh is graded the longest of them
        // would bring in far too many of the small ones.
        let curved = |f: &Facet| f.kind.order() > 1;
        self.margin = if facets.iter().any(curved) {
            facets.iter().map(size).fold(0.0, f64::max)
        } else {
            facets.iter().map(size).sum::<f64>() / facets.len().max(1) as f64
        };
        let tree = Tree::build(facets.iter().map(|f| f.nodes.iter().map(|&n| x[n])));
        self.candidates.resize(points.len(), Vec::new());
        let margin = self.margin;
        points
            .par_chunks(EVALUATED_PER_TASK)
            .zip(self.candidates.par_chunks_mut(EVALUATED_PER_TASK))
            .for_each(|(points, candidates)| {
                for (point, candidates) in points.iter().zip(candidates) {
                    tree.near(point.position(x), margin, candidates);
                }
            });
        self.at.clear();
        self.at.extend_from_slice(x);
        self.facing = facing;
    }
}

impl FaceSearch {
    /// Coordinates at the last search; empty before there was one.
    pub fn at(&self) -> &[Vec3] {
        &self.at
    }

    /// Searches anew when nodes have moved so far that a facet might be missing from the candidates of a face.
    pub fn renew(&mut self, faces: &[Face], facets: &[Facet], x: &[Vec3]) {
        let size = |nodes: &[usize]| {
            let corners = nodes.iter().map(|&n| distance(x[nodes[0]], x[n]));
            corners.fold(0.0, f64::max)
        };
        let margin = facets.iter().map(|f| size(&f.nodes)).fold(0.0, f64::max);
        let moved = (self.at.iter().zip(x))
            .map(|(&a, &b)| distance(a, b))
            .fold(0.0, f64::max);
        // Facets are looked for again once faces have moved by this part of the margin.
        if self.at.len() == x.len() && moved <= 0.1 * margin {
            return;
        }
        let tree = Tree::build(facets.iter().map(|f| f.nodes.iter().map(|&n| x[n])));
        self.opposite.resize(faces.len(), Vec::new());
        (faces.par_chunks(FACES_PER_TASK))
            .zip(self.opposite.par_chunks_mut(FACES_PER_TASK))
            .for_each(|(faces, opposite)| {
                for (face, opposite) in faces.iter().zip(opposite) {
                    let weight = 1.0 / face.nodes.len() as f64;
                    let centre =
                        (face.nodes.iter()).fold([0.0; 3], |c, &n| add_scaled(c, weight, x[n]));
                    let radius = face.nodes.iter().map(|&n| distance(centre, x[n]));
                    let radius = radius.fold(0.0, f64::max);
                    // A facet may be beyond the ball around a face by half of its size.
                    tree.near(centre, radius + 0.5 * margin, opposite);
                }
            });
        self.at.clear();
        self.at.extend_from_slice(x);
    }
}
