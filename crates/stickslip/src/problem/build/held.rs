//! Whose motion is a contact point's own: nodes whose displacements are prescribed, or follow from those of others.
//!
//! A multiplier of contact changes a motion. Where a support prescribes that of a node, or a reference point or another tie does, the constraint of the node would act
//! on whatever of the opposite surface is left to move, by a small weight and so with any force. Such nodes are marked here, once, for all interfaces: on faces of a mortar
//! their neighbours take over (`contact/mortar/merge.rs`), of points at nodes that move as one only one carries at a time, and where both sides are clamped nothing is left to be kept apart (`InterfaceMesh::clamped`).

use std::collections::{BTreeMap, BTreeSet};

use crate::body::couplings::{Coupling, Row, Tie};
use crate::contact::interface::InterfaceDefinition;
use crate::contact::mortar::merged_points;
use crate::contact::surface::ContactPoint;
use crate::math::{Vec3, dot, symmetric_eigen};
use crate::model::Support;
use crate::system::{Course, Dofs, Link, Links};

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
    /// Dofs that are kept equal in all steps: by equations, as at the ends of a period, and at one place, on the two sides of a cut.
    equal: [Vec<[usize; 2]>; 2],
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
        // Points of bodies follow the reference point that the last term of a row is of. Of equations between points of surfaces only those count that make one motion of
        // two (`equal`): what others carry is their sum's to share, which the elimination of their forces does (`couplings/fit.rs`).
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
            equal: [equal(couplings), cut(couplings)],
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
    pub fn mark(&mut self, interfaces: &mut [InterfaceDefinition]) {
        let (ties, others): (Vec<_>, Vec<_>) = interfaces.iter_mut().partition(|i| i.laws.tied);
        for interface in ties.into_iter().chain(others) {
            self.mark_one(interface);
        }
    }

    /// Nodes of the secondary, with an axis, that move as another one of it, and that one: at the same place, or where nodes of the primary move alike as well, as at the ends of a period that both bodies have. One of
    /// the two has a motion of its own. With a multiplier each only the sum of the two would be known, or, where meshes do not match, their difference by next to nothing.
    fn repeated(
        &self,
        theirs: &[usize],
        own: &[usize],
    ) -> BTreeMap<(usize, usize), (usize, usize)> {
        let [theirs, own] =
            [theirs, own].map(|nodes| nodes.iter().copied().collect::<BTreeSet<_>>());
        let [apart, together] = self.equal.each_ref().map(|pairs| {
            let places = pairs
                .iter()
                .map(|pair| pair.map(|dof| self.dofs.locate(dof)));
            let of_one_axis = places.filter(|[a, b]| a.1 == b.1);
            of_one_axis.collect::<Vec<[(usize, usize); 2]>>()
        });
        let both = |nodes: &BTreeSet<usize>, pair: &[(usize, usize); 2]| {
            pair.iter().all(|(node, _)| nodes.contains(node))
        };
        let along = |c: usize| {
            let mut pairs = apart.iter().filter(|pair| pair[0].1 == c);
            pairs.any(|pair| both(&theirs, pair))
        };
        let met = (0..self.dofs.dim)
            .filter(|&c| along(c))
            .collect::<BTreeSet<_>>();
        // By node the one that it moves as.
        let mut first = BTreeMap::<(usize, usize), (usize, usize)>::new();
        let apart = apart.iter().filter(|pair| met.contains(&pair[0].1));
        for pair in apart.chain(&together).filter(|pair| both(&own, pair)) {
            let ends = pair.map(|(node, component)| root(&first, node, component));
            if ends[0] != ends[1] {
                first.insert(ends[1], ends[0]);
            }
        }
        let of = |place: &(usize, usize)| (*place, root(&first, place.0, place.1));
        first.keys().map(of).collect()
    }

    /// Points that stand at nodes, and by point the earlier ones that move as it does. Each has the area of all that move alike, as one of them carries for all. Of ties only
    /// the first is left: they do not slide. The nodes are those of the primary and those of the secondary after it.
    pub fn as_one(
        &self,
        mut points: Vec<ContactPoint>,
        tied: bool,
        nodes: &[usize],
        primary_nodes: usize,
    ) -> (Vec<ContactPoint>, Vec<Vec<usize>>) {
        let (theirs, own) = nodes.split_at(primary_nodes);
        let repeated = self.repeated(theirs, own);
        let moves_as_another: BTreeSet<usize> = (repeated.iter())
            .flat_map(|(one, first)| [one.0, first.0])
            .collect();
        let leader = |point: &ContactPoint| {
            let node = nodes[point.node()?];
            if !moves_as_another.contains(&node) {
                return None;
            }
            let along = |c: usize| root(&repeated, node, c).0;
            let first = along(0);
            (1..self.dofs.dim)
                .all(|c| along(c) == first)
                .then_some(first)
        };
        let mut groups = BTreeMap::<usize, Vec<usize>>::new();
        for (i, point) in points.iter().enumerate() {
            if let Some(first) = leader(point) {
                groups.entry(first).or_default().push(i);
            }
        }
        let mut alike = vec![Vec::new(); points.len()];
        for group in groups.values().filter(|group| group.len() > 1) {
            let area = group.iter().map(|&i| points[i].area).sum();
            for (k, &i) in group.iter().enumerate() {
                points[i].area = area;
                alike[i] = group[..k].to_vec();
            }
        }
        if alike.iter().all(Vec::is_empty) {
            return (points, Vec::new());
        }
        if tied {
            let mut alone = alike.iter().map(Vec::is_empty);
            points.retain(|_| alone.next().unwrap_or(true));
            alike.clear();
        }
        (points, alike)
    }

    fn mark_one(&mut self, interface: &mut InterfaceDefinition) {
        let (tied, dim) = (interface.laws.tied, self.dofs.dim);
        let (theirs, own) = interface.nodes.split_at(interface.primary_nodes);
        let repeated = self.repeated(theirs, own);
        let mesh = interface.mesh_mut();
        mesh.clamped = (mesh.nodes.iter()).map(|&n| self.clamped(n)).collect();
        let Some(mortar) = &mut mesh.mortar else {
            return;
        };
        for face in &mut mortar.faces {
            for (a, held) in face.held.iter_mut().enumerate() {
                let node = mesh.nodes[face.nodes[a]];
                let mut axes = match self.tied.contains(&node) {
                    true => [true; 3],
                    false => self.of(node, &self.held),
                };
                axes = std::array::from_fn(|c| axes[c] || repeated.contains_key(&(node, c)));
                let across = mesh.points[face.points[a]].across.0;
                axes = std::array::from_fn(|c| axes[c] && !across[c]);
                *held = match tied {
                    true => axes[..dim].contains(&true),
                    // A node that has half of a motion along the normal left or less has none of its own: of two nodes that are held alike
                    // neither can make way for the other.
                    false => left(face.normals[a], axes) <= 0.5,
                };
            }
        }
        mortar.merged = merged_points(mortar);
        if tied {
            let own = &interface.nodes[interface.primary_nodes..];
            self.tied.extend(own);
        }
    }
}

/// Where the chain of nodes that move as others ends.
fn root(
    first: &BTreeMap<(usize, usize), (usize, usize)>,
    node: usize,
    component: usize,
) -> (usize, usize) {
    let mut place = (node, component);
    while let Some(&next) = first.get(&place) {
        place = next;
    }
    place
}

/// Dofs of bodies that equations keep equal in all steps.
fn equal(couplings: &[Coupling]) -> Vec<[usize; 2]> {
    let plain = |c: &&Coupling| !c.referred && c.tie == Tie::Equation { value: 0.0 };
    let rows = couplings.iter().filter(plain).filter(|c| always(c));
    rows.flat_map(|c| &c.rows).filter_map(pair).collect()
}

/// Dofs of the two sides of cuts that pretensions keep equal in all steps.
fn cut(couplings: &[Coupling]) -> Vec<[usize; 2]> {
    let mut out = Vec::new();
    for coupling in couplings.iter().filter(|c| always(c)) {
        if let Tie::Pretension(p) = &coupling.tie {
            let rows = &coupling.rows[..p.across(coupling.rows.len())];
            out.extend(rows.iter().filter_map(pair));
        }
    }
    out
}

/// Whether it acts in all steps.
fn always(coupling: &Coupling) -> bool {
    let mut pieces = coupling.schedule.pieces.iter();
    pieces.all(|p| p.course != Course::Off)
}

/// The two displacements that a row says are equal.
fn pair(row: &Row) -> Option<[usize; 2]> {
    let terms: Vec<(usize, f64)> = row.terms().collect();
    match terms[..] {
        [(a, f), (b, g)] if f == -g => Some([a, b]),
        _ => None,
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
    // Part of the best known motion of a rigid body from which on a motion of it is known.
    both.is_some_and(|(least, most)| *least > 1e-10 * most)
}

/// How far a unit motion along `normal` is left where these axes are held.
fn left(normal: Vec3, held: [bool; 3]) -> f64 {
    let free: Vec3 = std::array::from_fn(|c| if held[c] { 0.0 } else { normal[c] });
    dot(free, free).sqrt()
}
