//! Bodies that supports, springs and couplings leave free to move.

use super::super::contact::Contact;
use super::super::definition::{Model, Reference};
use super::super::frame::ContactMemory;
use super::super::scene::Scene;
use super::held::{Resisted, directions, plain};
use super::modes::{BEYOND_CUT, Mode, centre, modes, motions, shift_and_turn};
use super::{null_space, null_space_below};
use crate::body::couplings::Row;
use crate::body::{RigidMode, rigid_modes};
use crate::contact::interface::Interface;
use crate::contact::look;
use crate::math::{Vec3, add, cross, sub};
use crate::tolerance::{NEGLIGIBLE, SAME};

/// A body that supports and springs leave free to move, with those that ties make one with it.
#[derive(Clone, crate::keep::Keep)]
pub(crate) struct FreeBody {
    /// The indices of the bodies.
    pub bodies: Vec<usize>,
    /// Their free motions: what they are, and displacements by dof, the largest about of size one.
    pub motions: Vec<(String, Vec<f64>)>,
    /// An orthonormal basis of the directions in which they can move without turning.
    pub slides: Vec<Vec3>,
}

impl FreeBody {
    /// The names of the bodies.
    pub fn name(&self, model: &Model) -> String {
        let names = self.bodies.iter().map(|&b| model.bodies[b].name.as_str());
        names.collect::<Vec<_>>().join(" and ")
    }

    /// Whether a point of the mesh is one of theirs.
    pub fn has(&self, model: &Model, point: usize) -> bool {
        let mut points = self.bodies.iter().map(|&b| &model.bodies[b].points);
        points.any(|points| points.contains(&point))
    }

    /// Their points, and the hidden ones that are displaced with them.
    pub fn points<'a>(&'a self, model: &'a Model) -> impl Iterator<Item = usize> + 'a {
        self.bodies.iter().flat_map(|&b| model.displaced_with(b))
    }

    /// Whether it rubs on something at the last accepted state.
    pub fn rubs(&self, model: &Model, contact: &Contact, memory: &ContactMemory) -> bool {
        let mut rubbing = contact.views_of(memory).filter(|i| look::rubs(*i));
        rubbing.any(|i| i.nodes.iter().any(|&n| self.has(model, n)))
    }
}

/// A motion of one body among those that ties may make one.
struct Part {
    /// Its index among the modes of all bodies.
    mode: usize,
    name: String,
    /// Displacements by dof.
    vector: Vec<f64>,
}

/// The bodies that supports, springs, couplings and ties acting at `t` leave free to move.
pub(crate) fn free_bodies(scene: &Scene, t: f64) -> Vec<FreeBody> {
    let model = scene.model;
    let mut held = scene.supported(t);
    for spring in &model.actions.springs {
        for &(dof, stiffness) in spring.entries() {
            held[dof] |= stiffness > 0.0;
        }
    }
    let rows: Vec<_> = scene.couplings().acting(t).collect();
    let modes = modes(model);
    let ties: Vec<&Interface> = (scene.contact.interfaces.iter())
        .filter(|i| i.laws.tied && i.schedule.active(t))
        .collect();
    let groups = groups(model, &ties);
    let all = groups.iter().map(|group| {
        let parts = parts(model, group, &rows, &modes);
        let gram = resisted(model, &parts, &held, &rows, &modes, &ties, t);
        free(model, group, &parts, &gram, &modes)
    });
    all.flatten().collect()
}

/// Bodies that ties join, each group in order.
fn groups(model: &Model, ties: &[&Interface]) -> Vec<Vec<usize>> {
    let mut of: Vec<usize> = (0..model.bodies.len()).collect();
    for tie in ties {
        let mut joined: Vec<usize> = (model.bodies.iter().enumerate())
            .filter(|(_, body)| tie.nodes.iter().any(|n| body.points.contains(n)))
            .map(|(b, _)| of[b])
            .collect();
        joined.sort_unstable();
        if let Some(&first) = joined.first() {
            of.iter_mut()
                .filter(|o| joined.contains(o))
                .for_each(|o| *o = first);
        }
    }
    let members = |first: usize| (0..of.len()).filter(|&b| of[b] == first).collect();
    let groups = (0..of.len()).map(members);
    groups.filter(|g: &Vec<usize>| !g.is_empty()).collect()
}

/// The motions of bodies, scaled like their modes.
fn parts(model: &Model, group: &[usize], rows: &[&Row], modes: &[Mode]) -> Vec<Part> {
    let mut out = Vec::new();
    for &index in group {
        let body = &model.bodies[index];
        let own = match body.rigid {
            None => {
                let points: Vec<usize> = body.points.clone().collect();
                let mut own = carrying(model, &points, &|r| r.body == Some(index));
                // What has been cut off moves by itself as well.
                for piece in &body.pieces {
                    let beyond = carrying(model, piece, &|r| {
                        r.body == Some(index) && is_tied_to(model, rows, r, piece)
                    });
                    own.extend(beyond.into_iter().map(|m| RigidMode {
                        name: format!("{} {BEYOND_CUT}", m.name),
                        ..m
                    }));
                }
                own
            }
            Some(rigid) => motions(model, rigid.link),
        };
        let known = modes.iter().enumerate().filter(|(_, m)| m.body == index);
        for (mut m, (mode, known)) in own.into_iter().zip(known) {
            // Rotations count by the displacement they make at the rim of the body, like translations; those of rigid bodies do so already.
            if body.rigid.is_none() && known.angle() > 0.0 {
                m.vector.iter_mut().for_each(|v| *v *= known.angle());
            }
            out.push(Part {
                mode,
                name: m.name,
                vector: m.vector,
            });
        }
    }
    out
}

/// Sums of products of what supports, springs, couplings and ties resist of motions.
fn resisted(
    model: &Model,
    parts: &[Part],
    held: &[bool],
    rows: &[&Row],
    modes: &[Mode],
    ties: &[&Interface],
    t: f64,
) -> Vec<Vec<f64>> {
    let several = parts
        .iter()
        .any(|p| modes[p.mode].body != modes[parts[0].mode].body);
    let mut glued = Resisted {
        model,
        modes,
        gram: vec![vec![0.0; modes.len()]; if several { modes.len() } else { 0 }],
    };
    for tie in ties.iter().filter(|_| several) {
        glued.interface(tie, &directions(tie, t));
    }
    let entry = |a: &Part, b: &Part| -> f64 {
        let both = a.vector.iter().zip(&b.vector).zip(held);
        let sum: f64 = both
            .filter(|(_, held)| **held)
            .map(|((a, b), _)| a * b)
            .sum();
        // What a coupling resists, whatever is at its other end.
        let coupled = rows.iter().map(|r| r.sum(&a.vector) * r.sum(&b.vector));
        let glued = glued.gram.get(a.mode).map_or(0.0, |row| row[b.mode]);
        sum + coupled.sum::<f64>() + glued
    };
    let row = |a| parts.iter().map(|b| entry(a, b)).collect();
    parts.iter().map(row).collect()
}

/// What is free of a group of bodies; `None` where nothing is.
fn free(
    model: &Model,
    group: &[usize],
    parts: &[Part],
    gram: &[Vec<f64>],
    modes: &[Mode],
) -> Option<FreeBody> {
    let (mut unheld, none) = null_space(gram, SAME);
    if group.len() > 1 {
        unheld = plain(unheld);
    }
    let moves = |b: usize, motion: &Vec<f64>| {
        let mut both = motion.iter().zip(parts);
        both.any(|(c, part)| modes[part.mode].body == b && c.abs() > NEGLIGIBLE)
    };
    let moved = group.iter().copied();
    let bodies: Vec<usize> = moved
        .filter(|&b| unheld.iter().any(|m| moves(b, m)))
        .collect();
    let motions = unheld.iter().map(|motion| {
        let both = || motion.iter().zip(parts);
        let largest = both().fold(0.0_f64, |m, (c, _)| m.max(c.abs()));
        let mut names: Vec<&str> = Vec::new();
        // A mode is named from this part of the largest on.
        for (_, part) in both().filter(|(c, _)| c.abs() > 0.1 * largest) {
            if !names.contains(&part.name.as_str()) {
                names.push(&part.name);
            }
        }
        let mut vector = vec![0.0; model.dofs.count()];
        for (c, part) in both() {
            let own = vector.iter_mut().zip(&part.vector);
            own.for_each(|(v, m)| *v += c * m);
        }
        (names.join(" with "), vector)
    });
    let motions: Vec<(String, Vec<f64>)> = motions.collect();
    if motions.is_empty() {
        return None;
    }
    // What all bodies do alike along an axis.
    let along: Vec<(usize, Vec<usize>)> = (0..3)
        .map(|c| {
            let own = |p: &Part| axis(&p.name) == Some(c);
            (c, (0..parts.len()).filter(|&i| own(&parts[i])).collect())
        })
        .filter(|(_, own): &(usize, Vec<usize>)| !own.is_empty())
        .collect();
    let together = |a: &[usize], b: &[usize]| -> f64 {
        a.iter()
            .flat_map(|&i| b.iter().map(move |&j| gram[i][j]))
            .sum()
    };
    let block: Vec<Vec<f64>> = (along.iter())
        .map(|(_, a)| along.iter().map(|(_, b)| together(a, b)).collect())
        .collect();
    let slides = null_space_below(&block, none).into_iter().map(|vector| {
        let mut slide = [0.0; 3];
        for ((c, _), part) in along.iter().zip(vector) {
            slide[*c] = part;
        }
        slide
    });
    Some(FreeBody {
        bodies,
        motions,
        slides: slides.collect(),
    })
}

/// The motions without strain of these points, with what reference points do that are tied to them, over all dofs.
fn carrying(model: &Model, points: &[usize], tied: &dyn Fn(&Reference) -> bool) -> Vec<RigidMode> {
    let mut modes = rigid_modes(&model.mesh, points, model.space);
    let centre = centre(model, points);
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
    let (shift, turn) = shift_and_turn(&mode.name);
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
