//! A mortar's integrals at a state: which facets its faces may meet, and the integrals over what they have in common. Where tied surfaces are glued.

use rayon::prelude::*;

use super::turning::{self, Part};
use super::{GLUE, Interface, Primary};
use crate::contact::mortar::{FaceIntegral, Scratch, Sides, correct, integrate};
use crate::contact::search::Tree;
use crate::contact::surface::ContactPoint;
use crate::math::{Vec3, add_scaled, distance, identity};
use crate::system::{Stage, State};

/// Faces integrated by one task.
const CHUNK: usize = 8;

impl Interface {
    /// Finds the distances of tied surfaces in the reference configuration.
    pub(super) fn glue(&mut self, stage: &Stage) {
        if !self.laws.tied || !self.memory.glued.is_empty() {
            return;
        }
        self.memory.glued = vec![0.0; self.points.len()];
        let rest = State {
            t: stage.from.t,
            u: vec![0.0; stage.at.u.len()],
            ..State::default()
        };
        let still = Stage {
            from: &rest,
            at: &rest,
            dt: stage.dt,
            rate: None,
        };
        let asleep = std::mem::take(&mut self.memory.asleep);
        let gaps = self.gaps_at(&still);
        self.memory.asleep = asleep;
        let within = self.initial.within.unwrap_or(GLUE);
        let near = |(gap, p): (f64, &ContactPoint)| {
            if gap.abs() <= within.of(p.size) {
                gap
            } else {
                f64::NAN
            }
        };
        self.memory.glued = gaps.into_iter().zip(&self.points).map(near).collect();
    }

    /// Integrates over all faces at coordinates `x`, along normals that have turned as the surface has at `turned`; over the reference configuration,
    /// once, where sliding is small.
    pub(super) fn integrate(&mut self, x: &[Vec3], turned: &[Vec3]) {
        let frozen = self.kinematics.as_dyn().frozen();
        if frozen && !self.memory.integrals.is_empty() {
            return;
        }
        // Lent out, as the search changes the memory.
        let reference = std::mem::take(&mut self.reference);
        let x = if frozen { &reference } else { x };
        self.integrate_at((x, turned), &reference, frozen);
        self.reference = reference;
    }

    fn integrate_at(&mut self, (x, turned): (&[Vec3], &[Vec3]), reference: &[Vec3], frozen: bool) {
        self.search_faces(x);
        let turn = match frozen {
            true => identity(),
            false => turning::of_points(self.own_nodes(), (turned, reference), self.dofs.dim),
        };
        let (Some(mortar), Primary::Facets(facets)) = (&self.mortar, &self.primary) else {
            return;
        };
        let memory = &mut self.memory;
        let sides = Sides {
            x,
            reference,
            turn,
            facets,
        };
        // A face takes part as long as one of its points does. What is frozen must serve for ever.
        let awake = |points: &[usize]| {
            frozen || memory.asleep.is_empty() || points.iter().any(|&p| !memory.asleep[p])
        };
        let mut integrals = std::mem::take(&mut memory.integrals);
        integrals.resize_with(mortar.faces.len(), FaceIntegral::default);
        mortar
            .faces
            .par_chunks(CHUNK)
            .zip(integrals.par_chunks_mut(CHUNK))
            .zip(memory.opposite.par_chunks(CHUNK))
            .for_each(|((faces, integrals), opposite)| {
                let mut scratch = Scratch::default();
                for ((face, integral), opposite) in faces.iter().zip(integrals).zip(opposite) {
                    if awake(&face.points) {
                        integrate(face, &sides, opposite, &mut scratch, integral);
                    } else {
                        integral.clear();
                    }
                }
            });
        if self.dofs.dim == 3 {
            correct(&sides, &mortar.faces, &mut integrals);
        }
        memory.integrals = integrals;
    }

    /// The nodes of the faces of a mortar, each as often as it has faces.
    fn own_nodes(&self) -> impl Iterator<Item = usize> + Clone {
        let faces = self.mortar.iter().flat_map(|m| &m.faces);
        faces.flat_map(|face| face.nodes.iter().copied())
    }

    /// The corners of the faces around a point of a mortar.
    pub(super) fn faces_around(&self, i: usize) -> impl Iterator<Item = Part<'_>> + Clone {
        let faces =
            (self.mortar.iter()).flat_map(move |m| m.around[i].iter().map(|&(f, _)| &m.faces[f]));
        faces.map(|face| (&face.nodes[..face.kind.corner_count()], 1.0))
    }

    /// Searches anew when nodes have moved so far that a facet might be missing from the candidates of a face.
    fn search_faces(&mut self, x: &[Vec3]) {
        let (Some(mortar), Primary::Facets(facets)) = (&self.mortar, &self.primary) else {
            return;
        };
        let memory = &mut self.memory;
        let size = |nodes: &[usize]| {
            let corners = nodes.iter().map(|&n| distance(x[nodes[0]], x[n]));
            corners.fold(0.0, f64::max)
        };
        let margin = facets.iter().map(|f| size(&f.nodes)).fold(0.0, f64::max);
        let moved = (memory.opposite_at.iter().zip(x))
            .map(|(&a, &b)| distance(a, b))
            .fold(0.0, f64::max);
        if memory.opposite_at.len() == x.len() && moved <= 0.1 * margin {
            return;
        }
        let tree = Tree::build(facets.iter().map(|f| f.nodes.iter().map(|&n| x[n])));
        memory.opposite.resize(mortar.faces.len(), Vec::new());
        (mortar.faces.par_chunks(CHUNK))
            .zip(memory.opposite.par_chunks_mut(CHUNK))
            .for_each(|(faces, opposite)| {
                for (face, opposite) in faces.iter().zip(opposite) {
                    let weight = 1.0 / face.nodes.len() as f64;
                    let centre =
                        (face.nodes.iter()).fold([0.0; 3], |c, &n| add_scaled(c, weight, x[n]));
                    let radius = face.nodes.iter().map(|&n| distance(centre, x[n]));
                    let radius = radius.fold(0.0, f64::max);
                    tree.near(centre, radius + 0.5 * margin, opposite);
                }
            });
        memory.opposite_at.clear();
        memory.opposite_at.extend_from_slice(x);
    }
}
