//! Motions of whole bodies that nothing can hold, however contact comes out: known before a quasi-static step begins.

use super::super::definition::Model;
use super::super::scene::Scene;
use super::modes::Mode;
use super::null_space;
use crate::contact::interface::{Interface, Primary};
use crate::contact::look;
use crate::contact::look::Opposite;
use crate::math::{Vec3, dot, symmetric_eigen};
use crate::tolerance::SAME;

/// An unconstrained motion: how much of each mode is in it.
pub(crate) type Unheld = Vec<f64>;

/// Most modes that are looked at together.
const MOST_RIGID_MODES: usize = 120;

/// Points of an interface that are asked, about.
const ASKED_POINTS: usize = 2000;

/// Sums of products of what resists the modes.
pub(super) struct Resisted<'a> {
    pub model: &'a Model,
    pub modes: &'a [Mode],
    pub gram: Vec<Vec<f64>>,
}

impl Resisted<'_> {
    /// A linear function of the displacements, by its value for each mode, counts with a weight.
    fn row(&mut self, values: &[(usize, f64)], weight: f64) {
        for &(i, a) in values {
            for &(j, b) in values {
                self.gram[i][j] += weight * a * b;
            }
        }
    }

    /// A displacement that cannot change.
    fn dof(&mut self, dof: usize) {
        let each = self.modes.iter().enumerate();
        let values: Vec<_> = each.map(|(i, m)| (i, m.at(self.model, dof))).collect();
        let own: Vec<_> = values.into_iter().filter(|(_, v)| *v != 0.0).collect();
        self.row(&own, 1.0);
    }

    /// A sum of displacements with factors.
    fn sum(&mut self, terms: impl Iterator<Item = (usize, f64)>) {
        let terms: Vec<_> = terms.collect();
        let rate = |m: &Mode| {
            terms
                .iter()
                .map(|&(dof, a)| a * m.at(self.model, dof))
                .sum()
        };
        let values: Vec<(usize, f64)> = self.modes.iter().map(rate).enumerate().collect();
        self.row(&values, 1.0);
    }

    /// The motions that it leaves free, with simple names.
    fn free(&self) -> Vec<Unheld> {
        plain(null_space(&self.gram, SAME).0)
    }

    /// Contact along `directions` at the points of an interface, as if all of them had come to touch.
    pub fn interface(&mut self, interface: &Interface, directions: &[Vec3]) {
        let model = self.model;
        let body_of = |point: usize| model.bodies.iter().position(|b| b.points.contains(&point));
        let first = match &interface.primary {
            Primary::Facets(facets) => facets.first().map(|f| interface.nodes[f.nodes[0]]),
            Primary::Rigid(..) => None,
        };
        let theirs = first.and_then(body_of);
        // A surface may reach over the cut of a pretension: then what is opposite counts.
        let cut = theirs.is_some_and(|b| !model.bodies[b].pieces.is_empty());
        let mut opposite = cut.then(|| Opposite::new(interface, 0.0));
        let stride = interface.points.len().div_ceil(ASKED_POINTS).max(1);
        let asked: Vec<_> = interface.points.iter().step_by(stride).collect();
        let weight = 1.0 / asked.len().max(1) as f64;
        for point in asked {
            let own = interface.nodes[point.nodes[0]];
            let ours = body_of(own);
            if ours == theirs {
                continue;
            }
            let x = interface.place(point);
            let nearest = opposite
                .as_mut()
                .and_then(|o| o.facing(point.position(&interface.reference)));
            let facing = nearest.or(first);
            for &d in directions {
                let each = self.modes.iter().enumerate();
                let values = each.filter_map(|(i, m)| {
                    let sign = m.relative(model, own, facing);
                    (sign != 0.0).then(|| (i, sign * dot(d, m.velocity(x))))
                });
                let values: Vec<_> = values.collect();
                self.row(&values, weight);
            }
        }
    }
}

/// Motions that neither supports, springs and couplings nor any contact could hold while the interfaces act as they do at `t`. Of contact
/// the most is believed: that every point of a secondary meets what it faces, that gaps of couplings close, and that friction is as large as need be.
/// Tied surfaces count without contact too.
pub(crate) fn unheld(scene: &Scene, t: f64, modes: &[Mode], contact: bool) -> Vec<Unheld> {
    let Some(mut resisted) = without_contact(scene, t, modes) else {
        return Vec::new();
    };
    let couplings = scene.couplings();
    for row in couplings.stops(t).filter(|_| contact) {
        resisted.sum(row.terms());
    }
    let acting = scene
        .contact
        .interfaces
        .iter()
        .filter(|i| i.schedule.active(t));
    for interface in acting.filter(|i| contact || i.laws.tied) {
        let directions = directions(interface, t);
        resisted.interface(interface, &directions);
    }
    resisted.free()
}

/// Motions that neither supports, springs and couplings at `t` hold nor `rows`, linear functions of the displacements by dof.
pub(crate) fn unheld_beside(
    scene: &Scene,
    t: f64,
    modes: &[Mode],
    rows: &[Vec<(usize, f64)>],
) -> Vec<Unheld> {
    let Some(mut resisted) = without_contact(scene, t, modes) else {
        return Vec::new();
    };
    for row in rows {
        resisted.sum(row.iter().copied());
    }
    resisted.free()
}

/// What supports, springs and couplings resist; `None` where there are no motions, or too many.
fn without_contact<'a>(scene: &Scene<'a>, t: f64, modes: &'a [Mode]) -> Option<Resisted<'a>> {
    let model = scene.model;
    let count = modes.len();
    if count == 0 || count > MOST_RIGID_MODES {
        return None;
    }
    let mut resisted = Resisted {
        model,
        modes,
        gram: vec![vec![0.0; count]; count],
    };
    let held = scene.supported(t);
    let held = held.iter().enumerate().filter(|(_, held)| **held);
    held.for_each(|(dof, _)| resisted.dof(dof));
    for &(dof, k) in model.actions.springs.iter().flat_map(|s| s.entries()) {
        if k > 0.0 {
            resisted.dof(dof);
        }
    }
    for row in scene.couplings().acting(t) {
        resisted.sum(row.terms());
    }
    Some(resisted)
}

/// Directions in which an interface may resist: all where it sticks or is tied, else those of its normals.
pub(super) fn directions(interface: &Interface, t: f64) -> Vec<Vec3> {
    let unit = |c: usize| std::array::from_fn(|d| if c == d { 1.0 } else { 0.0 });
    let all = || (0..interface.dofs.dim).map(unit).collect();
    if interface.laws.tied || interface.laws.friction_law().frictional() {
        return all();
    }
    let mut normals: Vec<Vec3> = look::normals(interface)
        .into_iter()
        .map(|(_, n)| n)
        .collect();
    if let Primary::Rigid(shape, motion) = &interface.primary {
        let pose = motion.pose(t);
        for point in &interface.points {
            let x = pose.inward(point.position(&interface.reference));
            let Some(foot) = shape.as_dyn().foot(x) else {
                continue;
            };
            if foot.curvature.as_flattened().iter().any(|c| *c != 0.0) {
                return all();
            }
            normals.push(pose.turn(foot.normal));
        }
    }
    let mut gram = vec![vec![0.0; 3]; 3];
    for n in &normals {
        for (i, row) in gram.iter_mut().enumerate() {
            for (g, nj) in row.iter_mut().zip(n) {
                *g += n[i] * nj;
            }
        }
    }
    let (values, vectors) = symmetric_eigen(&gram);
    let whole: f64 = values.iter().sum();
    let some = values
        .iter()
        .enumerate()
        .filter(|(_, v)| **v > SAME * whole);
    some.map(|(k, _)| std::array::from_fn(|i| vectors[i][k]))
        .collect()
}

/// Other vectors of the same space, each with a mode that is in none of the others, so that they have simple names.
pub(super) fn plain(mut basis: Vec<Unheld>) -> Vec<Unheld> {
    let mut taken: Vec<usize> = Vec::new();
    for k in 0..basis.len() {
        let free = (0..basis[k].len()).filter(|i| !taken.contains(i));
        let Some(pivot) = free.max_by(|&a, &b| basis[k][a].abs().total_cmp(&basis[k][b].abs()))
        else {
            break;
        };
        taken.push(pivot);
        let factor = 1.0 / basis[k][pivot];
        basis[k].iter_mut().for_each(|v| *v *= factor);
        let row = basis[k].clone();
        for (other, vector) in basis.iter_mut().enumerate() {
            if other != k {
                let part = vector[pivot];
                vector
                    .iter_mut()
                    .zip(&row)
                    .for_each(|(v, r)| *v -= part * r);
            }
        }
    }
    for vector in &mut basis {
        let largest = vector.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        vector
            .iter_mut()
            .for_each(|v| *v /= largest.max(f64::MIN_POSITIVE));
    }
    basis
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mixed_motions_get_simple_names() {
        let (c, s) = (0.6, 0.8);
        let mixed = vec![vec![c, s, 0.0, 0.0], vec![-s, c, 0.0, 0.0]];
        let simple = plain(mixed);
        for vector in &simple {
            let parts = vector.iter().filter(|v| v.abs() > SAME).count();
            assert_eq!(parts, 1, "{simple:?}");
        }
    }
}
