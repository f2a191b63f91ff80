//! Whose motion is a contact point's own: nodes whose displacements are prescribed, or follow from those of others.
//!
//! A multiplier of contact changes a motion. Where a support prescribes that of a node, or a reference point or another tie does, the constraint of the node would act
//! on whatever of the opposite surface is left to move, by a small weight and so with any force. Such nodes are marked here, once, for all interfaces: on faces of a mortar
//! their neighbours take over (`contact/mortar/merge.rs`), and where both sides are clamped nothing is left to be kept apart (`Interface::clamped`).

use std::collections::{BTreeMap, BTreeSet};

use crate::body::couplings::{Coupling, Tie};
use crate::contact::interface::Interface;
use crate::math::{Vec3, dot, symmetric_eigen};
use crate::model::Support;
use crate::system::{Course, Dofs, Link, Links};

/// Part of a motion along the normal that is left to a node, below which it has none of its own: of two nodes that are held alike neither can make way for the other.
const LEAST: f64 = 0.5;

/// Part of the best known motion of a rigid body from which on a motion of it is known.
const KNOWN: f64 = 1e-10;

/// Which displacements are not free.
pub(super) struct HeldNodes<'a> {
    links: &'a Links,
    dofs: Dofs,
    /// By dof: prescribed in some step, or following others.
    held: Vec<bool>,
    /// Prescribed in all steps.
    always: Vec<bool>,
    /// What follows that.
    led: Led,
    /// Points of secondaries of ties so far.
    tied: BTreeSet<usize>,
}

impl<'a> HeldNodes<'a> {
    pub fn new(links: &'a Links, dofs: Dofs, supports: &[Support], couplings: &[Coupling]) -> Self {
        let steps = supports.first().map_or(0, |s| s.schedule.pieces.len());
        let mut held = vec![false; dofs.count()];
        let mut always = vec![steps > 0; dofs.count()];
        for step in 0..steps {
            let mut now = vec![false; dofs.count()];
            let acting = |s: &&Support| s.schedule.pieces[step].course != Course::Off;
            for entry in supports.iter().filter(acting).flat_map(|s| &s.entries) {
                now[entry.dof] = true;
            }
            for ((held, always), now) in held.iter_mut().zip(&mut always).zip(now) {
                *held |= now;
                *always &= now;
            }
        }
        // Points of bodies follow the reference point that the last term of a row is of. Equations between points of surfaces are no such case: what each carries
        // is their sum's to share, which the elimination of their forces does (`couplings/fit.rs`).
        let followers = couplings
            .iter()
            .filter(|c| c.referred && matches!(c.tie, Tie::Equation { .. }));
        for row in followers.flat_map(|c| &c.rows) {
            let mine = |dof: usize| {
                let (point, _) = dofs.locate(dof);
                links.of_point(point).is_none() && links.of_hidden(point).is_none()
            };
            let bodies: Vec<usize> = (row.terms().map(|(dof, _)| dof))
                .filter(|&dof| mine(dof))
                .collect();
            // A reference point that follows the mean of many holds none of them.
            if let [follower] = bodies[..] {
                held[follower] = true;
            }
        }
        let led = Led::new(links, dofs, couplings, &always);
        HeldNodes {
            links,
            dofs,
            held,
            always,
            led,
            tied: BTreeSet::new(),
        }
    }

    /// Whether a point of an elastic body is held along each axis.
    fn of(&self, point: usize, among: &[bool]) -> [bool; 3] {
        let free = self.links.of_point(point).is_some();
        std::array::from_fn(|c| c < self.dofs.dim && !free && among[self.dofs.of(point, c)])
    }

    /// Whether it is prescribed along each axis how a point moves, in all steps: by supports, or because it follows.
    fn clamped(&self, point: usize) -> [bool; 3] {
        let by_support = self.of(point, &self.always);
        let follows = |c: usize| match self.links.of_point(point) {
            Some(link) => self.led.bodies.contains(&link),
            None => self.led.dofs.contains(&self.dofs.of(point, c)),
        };
        std::array::from_fn(|c| c < self.dofs.dim && (by_support[c] || follows(c)))
    }

    /// Marks the nodes of all interfaces: those of ties first, as a node that is tied twice follows once.
    pub fn mark(&mut self, interfaces: &mut [Interface]) {
        let (ties, others): (Vec<_>, Vec<_>) = interfaces.iter_mut().partition(|i| i.laws.tied);
        for interface in ties.into_iter().chain(others) {
            self.mark_one(interface);
        }
    }

    fn mark_one(&mut self, interface: &mut Interface) {
        let (tied, dim) = (interface.laws.tied, self.dofs.dim);
        interface.clamped = (interface.nodes.iter()).map(|&n| self.clamped(n)).collect();
        let Some(mortar) = &mut interface.mortar else {
            return;
        };
        for face in &mut mortar.faces {
            for (a, held) in face.held.iter_mut().enumerate() {
                let node = interface.nodes[face.nodes[a]];
                let mut axes = match self.tied.contains(&node) {
                    true => [true; 3],
                    false => self.of(node, &self.held),
                };
                let across = interface.points[face.points[a]].across.0;
                axes = std::array::from_fn(|c| axes[c] && !across[c]);
                *held = match tied {
                    true => axes[..dim].contains(&true),
                    false => left(face.normals[a], axes) <= LEAST,
                };
            }
        }
        if tied {
            let own = &interface.nodes[interface.primary_nodes..];
            self.tied.extend(own);
        }
    }
}

/// What follows, in all steps, reference points whose motions are prescribed in all steps. Two multipliers, of contact and of a coupling, would act on one motion that
/// neither can change.
struct Led {
    /// Displacements of elastic bodies.
    dofs: BTreeSet<usize>,
    /// Rigid bodies that follow in all their motions.
    bodies: BTreeSet<usize>,
}

impl Led {
    fn new(links: &Links, dofs: Dofs, couplings: &[Coupling], always: &[bool]) -> Self {
        let mut led = BTreeSet::new();
        let mut known = BTreeMap::<usize, Vec<[(usize, f64); 3]>>::new();
        let acts = |c: &&Coupling| c.schedule.pieces.iter().all(|p| p.course != Course::Off);
        let kinematic = |c: &&Coupling| c.referred && matches!(c.tie, Tie::Equation { .. });
        let acting = couplings.iter().filter(kinematic).filter(acts);
        for row in acting.flat_map(|c| &c.rows) {
            let hidden = |dof: &usize| links.of_hidden(dofs.locate(*dof).0).is_some();
            let all = row.terms().map(|(dof, _)| dof);
            let (leads, own): (Vec<_>, Vec<_>) = all.partition(|dof| hidden(dof));
            let [follower] = own[..] else {
                continue;
            };
            if !leads.iter().all(|&dof| always[dof]) {
                continue;
            }
            match links.of_point(dofs.locate(follower).0) {
                None => {
                    led.insert(follower);
                }
                Some(link) => {
                    let rows = known.entry(link).or_default();
                    rows.extend(links.row_at_start(follower));
                }
            }
        }
        let whole = known.into_iter();
        let whole = whole.filter(|(link, rows)| determine(&links.all()[*link], dofs, rows));
        Led {
            dofs: led,
            bodies: whole.map(|(link, _)| link).collect(),
        }
    }
}

/// Whether these sums of the motions of a rigid body say what all of them are.
fn determine(link: &Link, dofs: Dofs, rows: &[[(usize, f64); 3]]) -> bool {
    let part = |row: &[(usize, f64); 3], dof: usize| -> f64 {
        row.iter().filter(|(d, _)| *d == dof).map(|(_, a)| a).sum()
    };
    let motions = link.motions(dofs);
    let with = |i: usize, j: usize| rows.iter().map(|row| part(row, i) * part(row, j)).sum();
    let gram: Vec<Vec<f64>> = (motions.iter())
        .map(|&(i, _)| motions.iter().map(|&(j, _)| with(i, j)).collect())
        .collect();
    let (values, _) = symmetric_eigen(&gram);
    let both = values.first().zip(values.last());
    both.is_some_and(|(least, most)| *least > KNOWN * most)
}

/// How far a unit motion along `normal` is left where these axes are held.
fn left(normal: Vec3, held: [bool; 3]) -> f64 {
    let free: Vec3 = std::array::from_fn(|c| if held[c] { 0.0 } else { normal[c] });
    dot(free, free).sqrt()
}
