//! A mortar's integrals at a state: which facets its faces may meet, and the integrals over what they have in common. Where tied surfaces are glued.

use rayon::prelude::*;

use super::cache::Cache;
use super::definition::Primary;
use super::initial::GLUE;
use super::parts::Interface;
use super::scene::Wants;
use crate::contact::kinematics::{Part, of_points};
use crate::contact::mortar::{
    FACE_NODES, FaceIntegral, Merged, Scratch, Sides, correct, integrate, merged,
};
use crate::contact::surface::ContactPoint;
use crate::contact::symmetry::Across;
use crate::math::{Mat3, Vec3, identity};
use crate::system::{Stage, State};

/// Faces integrated by one task.
const CHUNK: usize = 8;

impl Interface {
    /// Finds the distances of tied surfaces in the reference configuration.
    pub(super) fn glue(&mut self, stage: &Stage) {
        if !self.laws.tied || !self.history.start.glued.is_empty() {
            return;
        }
        self.history.start.glued = vec![0.0; self.points.len()];
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
        let gaps = self.all_gaps_at(&still);
        let within = self.initial.within.unwrap_or(GLUE);
        let near = |(gap, p): (f64, &ContactPoint)| {
            if gap.abs() <= within.of(p.size) {
                gap
            } else {
                f64::NAN
            }
        };
        self.history.start.glued = gaps.into_iter().zip(&self.points).map(near).collect();
    }

    /// Integrates over all faces at the coordinates of the evaluation, along normals that have turned as the surface has, at the last accepted state where it
    /// `holds_turns`; over the reference configuration, once, where sliding is small.
    pub(super) fn integrate(&self, cache: &mut Cache, wants: Wants) {
        let (Some(mortar), Primary::Facets(facets)) = (&self.mortar, &self.primary) else {
            return;
        };
        let frozen = self.kinematics.as_dyn().frozen();
        if frozen && !cache.integrals.is_empty() {
            return;
        }
        match frozen {
            true => self.merge(cache, &self.reference),
            // An attempt asks at one state for all of its iterations. After a restart those of the last attempt are known.
            false if !cache.before.is_empty() => {
                let before = std::mem::take(&mut cache.before);
                self.merge(cache, &before);
                cache.before = before;
            }
            false => {}
        }
        let turned = if wants.holds_turns {
            &cache.before
        } else {
            &cache.x
        };
        let reference = &self.reference;
        let (x, before, turn): (&[Vec3], &[Vec3], Mat3) = match frozen {
            true => (reference, &[], identity()),
            false => {
                let at = (turned.as_slice(), reference.as_slice());
                let turn = of_points(self.own_nodes(), at, self.dofs.dim);
                (&cache.x, &cache.before, self.across().turn(turn))
            }
        };
        cache.faces.renew(&mortar.faces, facets, x);
        let mirrors = self.mirrors();
        let sides = Sides {
            x,
            before,
            reference,
            turn,
            facets,
            walls: self.walls.of(facets, reference),
            mirrors: &mirrors,
            compliant: !self.laws.needs_normal_stiffness(),
        };
        // A face takes part as long as one of its points does. What is frozen must serve for ever.
        let excluded = &self.directives.excluded;
        let included = |points: &[usize]| {
            frozen
                || wants.everywhere
                || excluded.is_empty()
                || points.iter().any(|&p| !excluded[p])
        };
        let integrals = &mut cache.integrals;
        integrals.resize_with(mortar.faces.len(), FaceIntegral::default);
        cache.merged.resize(mortar.faces.len(), Merged::default());
        mortar
            .faces
            .par_chunks(CHUNK)
            .zip(integrals.par_chunks_mut(CHUNK))
            .zip(cache.faces.opposite.par_chunks(CHUNK))
            .zip(cache.merged.par_chunks(CHUNK))
            .for_each(|(((faces, integrals), opposite), merged)| {
                let mut scratch = Scratch::default();
                let all = faces.iter().zip(integrals).zip(opposite).zip(merged);
                for (((face, integral), opposite), &merged) in all {
                    if included(&face.points) {
                        integrate((face, merged), &sides, opposite, &mut scratch, integral);
                    } else {
                        integral.clear();
                    }
                }
            });
        if self.dofs.dim == 3 {
            correct(&sides, &mortar.faces, integrals);
        }
    }

    /// Finds the nodes without a multiplier, at coordinates `at`: those of the accepted state that an attempt starts from, as what is covered must not change
    /// from iteration to iteration.
    fn merge(&self, cache: &mut Cache, at: &[Vec3]) {
        let (Some(mortar), false) = (&self.mortar, cache.merged_at == at) else {
            return;
        };
        let covered = self.covered(cache, at);
        cache.merged = merged(&mortar.faces, &covered);
        cache.merged_at = at.to_vec();
    }

    /// By point of a mortar the part of its area that has the primary opposite, on the face on which that is most. One where pressure follows from the gap, so that no
    /// constraint asks for a force, and where the faces around have no edge of the primary near.
    fn covered(&self, cache: &mut Cache, at: &[Vec3]) -> Vec<f64> {
        let mut out = vec![1.0; self.points.len()];
        let compliant = !self.laws.needs_normal_stiffness();
        let (Some(mortar), Primary::Facets(facets), false) =
            (&self.mortar, &self.primary, compliant)
        else {
            return out;
        };
        let ends: Vec<bool> = (facets.iter())
            .map(|facet| facet.continues.iter().any(|c| !c))
            .collect();
        if !ends.contains(&true) {
            return out;
        }
        cache.faces.renew(&mortar.faces, facets, at);
        let turn = of_points(self.own_nodes(), (at, &self.reference), self.dofs.dim);
        let mirrors = self.mirrors();
        let sides = Sides {
            x: at,
            before: &[],
            reference: &self.reference,
            turn: self.across().turn(turn),
            facets,
            walls: self.walls.of(facets, &self.reference),
            mirrors: &mirrors,
            compliant,
        };
        let faces = mortar.faces.par_iter().zip(&cache.faces.opposite);
        let found: Vec<Option<[f64; FACE_NODES]>> = faces
            .map_init(
                || (Scratch::default(), FaceIntegral::default()),
                |(scratch, integral), (face, opposite)| {
                    opposite.iter().any(|&f| ends[f]).then(|| {
                        integrate(
                            (face, Merged::default()),
                            &sides,
                            opposite,
                            scratch,
                            integral,
                        );
                        integral.area
                    })
                },
            )
            .collect();
        for (part, around) in out.iter_mut().zip(&mortar.around) {
            let of = |&(f, a): &(usize, usize)| {
                found[f].map_or(1.0, |areas| areas[a] / mortar.faces[f].areas[a])
            };
            *part = around.iter().map(of).fold(0.0, f64::max);
        }
        out
    }

    /// Planes of symmetry on which both surfaces end: the axis across, and where they are along it.
    fn mirrors(&self) -> Vec<(usize, f64)> {
        let mut out: Vec<(usize, f64)> = Vec::new();
        for point in self.points.iter().filter(|p| p.across.any()) {
            let x = self.reference[point.nodes[0]];
            for c in (0..self.dofs.dim).filter(|&c| point.across.0[c]) {
                if !out.contains(&(c, x[c])) {
                    out.push((c, x[c]));
                }
            }
        }
        out
    }

    /// What the mean turn of the whole surface does not have, because it ends on planes of symmetry.
    fn across(&self) -> Across {
        let points = self.points.iter().map(|p| p.across.0);
        Across(points.fold([false; 3], |all, p| std::array::from_fn(|c| all[c] || p[c])))
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
}
