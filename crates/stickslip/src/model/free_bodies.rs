//! Bodies that supports, springs and couplings leave free to move.

use super::contact::Contact;
use super::definition::{Model, Reference};
use super::scene::Scene;
use crate::body::couplings::Row;
use crate::body::{RigidMode, rigid_modes};
use crate::math::{Vec3, add, cross, scale, sub, symmetric_eigen};

/// A body that supports and springs leave free to move.
#[derive(Clone)]
pub(crate) struct FreeBody {
    /// Its index.
    pub body: usize,
    /// Its free motions: what they are, and displacements by dof, the largest of size one.
    pub motions: Vec<(String, Vec<f64>)>,
    /// An orthonormal basis of the directions in which it can move without turning.
    pub slides: Vec<Vec3>,
}

impl FreeBody {
    /// Whether it rubs on something, or is glued to it, at the last accepted state.
    pub fn rubs(&self, model: &Model, contact: &Contact) -> bool {
        let points = &model.bodies[self.body].points;
        let mut rubbing = contact.interfaces.iter().filter(|i| i.rubs());
        rubbing.any(|i| i.nodes.iter().any(|n| points.contains(n)))
    }
}

impl Scene<'_> {
    /// The bodies that supports, springs and couplings acting at `t` leave free to move.
    pub(crate) fn free_bodies(&self, t: f64) -> Vec<FreeBody> {
        let model = self.model;
        let mut held = self.supported(t);
        for spring in &model.springs {
            for &(dof, stiffness) in spring.entries() {
                held[dof] |= stiffness > 0.0;
            }
        }
        let rows: Vec<_> = self.contact.couplings.acting(t).collect();
        let mut out = Vec::new();
        for (index, body) in model.bodies.iter().enumerate() {
            let modes = match body.rigid {
                None => {
                    let points: Vec<usize> = body.points.clone().collect();
                    let mut modes = carrying(model, &points, &|r| r.body == Some(index));
                    // What has been cut off moves by itself as well.
                    for piece in &body.pieces {
                        let own = carrying(model, piece, &|r| {
                            r.body == Some(index) && is_tied_to(model, &rows, r, piece)
                        });
                        modes.extend(own.into_iter().map(|m| RigidMode {
                            name: format!("{} {BEYOND}", m.name),
                            ..m
                        }));
                    }
                    modes
                }
                Some(rigid) => motions(model, rigid.link),
            };
            // Rotations count by the displacement they make at the rim of the body, like translations.
            let modes: Vec<_> = modes
                .into_iter()
                .map(|m| {
                    let largest = m.vector.iter().fold(0.0_f64, |a, v| a.max(v.abs()));
                    (m.name, m.vector, 1.0 / largest.max(f64::MIN_POSITIVE))
                })
                .collect();
            let gram: Vec<Vec<f64>> = modes
                .iter()
                .map(|(_, a, sa)| {
                    modes
                        .iter()
                        .map(|(_, b, sb)| {
                            let sum: f64 = a
                                .iter()
                                .zip(b)
                                .zip(&held)
                                .filter(|(_, held)| **held)
                                .map(|((a, b), _)| a * b)
                                .sum();
                            // What a coupling resists, whatever is at its other end.
                            let coupled: f64 = rows.iter().map(|r| r.sum(a) * r.sum(b)).sum();
                            (sum + coupled) * sa * sb
                        })
                        .collect()
                })
                .collect();
            let (values, vectors) = symmetric_eigen(&gram);
            let largest = values.last().copied().unwrap_or(0.0);
            let mut motions = Vec::new();
            for (k, value) in values.iter().enumerate() {
                if *value > 1e-10 * largest.max(f64::MIN_POSITIVE) {
                    continue;
                }
                let parts: Vec<&str> = modes
                    .iter()
                    .enumerate()
                    .filter(|(i, _)| vectors[*i][k].abs() > 0.1)
                    .map(|(_, (name, _, _))| name.as_str())
                    .collect();
                let mut vector = vec![0.0; model.dofs.count()];
                for (i, (_, mode, scale)) in modes.iter().enumerate() {
                    let factor = scale * vectors[i][k];
                    vector
                        .iter_mut()
                        .zip(mode)
                        .for_each(|(v, m)| *v += factor * m);
                }
                motions.push((parts.join(" with "), vector));
            }
            if motions.is_empty() {
                continue;
            }
            // Translations come first.
            let axes: Vec<usize> = modes.iter().filter_map(|(name, ..)| axis(name)).collect();
            let block: Vec<Vec<f64>> = gram[..axes.len()]
                .iter()
                .map(|row| row[..axes.len()].to_vec())
                .collect();
            let (values, vectors) = symmetric_eigen(&block);
            let slides = values.iter().enumerate();
            let slides = slides.filter(|(_, v)| **v <= 1e-10 * largest.max(f64::MIN_POSITIVE));
            let slides = slides.map(|(k, _)| {
                let mut slide = [0.0; 3];
                for (i, &c) in axes.iter().enumerate() {
                    slide[c] = vectors[i][k];
                }
                slide
            });
            out.push(FreeBody {
                body: index,
                motions,
                slides: slides.collect(),
            });
        }
        out
    }
}

/// What is said of motions of a part that a pretension has cut off.
pub(crate) const BEYOND: &str = "beyond the cut";

/// The motions without strain of these points, with what reference points do that are tied to them, over all dofs.
fn carrying(model: &Model, points: &[usize], tied: &dyn Fn(&Reference) -> bool) -> Vec<RigidMode> {
    let mut modes = rigid_modes(&model.mesh, points, model.space);
    let places = points.iter().map(|p| model.mesh.points[*p]);
    let sum = places.fold([0.0; 3], add);
    let centre = scale(1.0 / points.len().max(1) as f64, sum);
    for mode in &mut modes {
        carry(model, tied, centre, mode);
    }
    modes
}

/// Whether all that these rows tie to a reference point are such points, which ascend.
fn is_tied_to(model: &Model, rows: &[&Row], reference: &Reference, points: &[usize]) -> bool {
    let is_own = |point: usize| model.links.of_hidden(point) == Some(reference.link);
    let of = |row: &Row| -> Vec<usize> {
        let terms = row.terms();
        terms.map(|(dof, _)| model.dofs.locate(dof).0).collect()
    };
    let all = rows.iter().map(|row| of(row));
    let own: Vec<Vec<usize>> = all.filter(|row| row.iter().any(|&p| is_own(p))).collect();
    let there = |p: &usize| is_own(*p) || points.binary_search(p).is_ok();
    !own.is_empty() && own.iter().flatten().all(there)
}

/// Adds to a motion of points what the reference points tied to them do.
fn carry(model: &Model, tied: &dyn Fn(&Reference) -> bool, centre: Vec3, mode: &mut RigidMode) {
    let unit = |name: &str, kind: &str| -> Vec3 {
        let axis = name.strip_prefix(kind);
        ["x", "y", "z"].map(|a| f64::from(u8::from(axis == Some(a))))
    };
    let shift = unit(&mode.name, "translation ");
    let turn = unit(&mode.name, "rotation about ");
    let velocity = |x: Vec3| add(shift, cross(turn, sub(x, centre)));
    mode.vector.resize(model.dofs.count(), 0.0);
    for (dof, moved) in model.carried(tied, velocity, turn) {
        mode.vector[dof] = moved;
    }
}

/// The direction of a translation.
fn axis(motion: &str) -> Option<usize> {
    let axes = ["x", "y", "z"].into_iter();
    let translation = motion.strip_prefix("translation ")?;
    axes.into_iter().position(|a| a == translation)
}

/// The motions of a rigid body over all dofs, hidden ones and those of its points.
pub(crate) fn motions(model: &Model, link: usize) -> Vec<RigidMode> {
    let motions = model.links.all()[link].motions(model.dofs);
    motions
        .into_iter()
        .map(|(dof, motion)| {
            let mut vector = vec![0.0; model.dofs.count()];
            vector[dof] = 1.0;
            model.links.impose(&mut vector);
            RigidMode {
                name: motion.to_string(),
                vector,
            }
        })
        .collect()
}

crate::keep!(FreeBody {
    body,
    motions,
    slides
});
