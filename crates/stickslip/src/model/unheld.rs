//! Motions of whole bodies that nothing can hold, however contact comes out: known before a quasi-static step begins.

use super::definition::{Model, Reference};
use super::scene::Scene;
use crate::body::couplings::Row;
use crate::contact::interface::{Interface, Primary};
use crate::contact::look;
use crate::math::{Vec3, add, cross, dot, norm, scale, sub, symmetric_eigen};
use crate::system::{Freedom, Motion};

/// A motion of one body without strain.
pub(crate) struct Mode {
    /// The body.
    pub body: usize,
    /// `translation x`, `rotation about z`.
    pub name: String,
    shift: Vec3,
    turn: Vec3,
    centre: Vec3,
    /// The dof that stands for it in a rigid body.
    hidden: Option<usize>,
    /// The part of the body that moves alone, if it is not the whole.
    piece: Option<usize>,
}

impl Mode {
    /// A motion of a body, or a part of it, about a centre, rotations by the length that they are measured with.
    fn new(
        body: usize,
        piece: Option<usize>,
        motion: Motion,
        centre: Vec3,
        length: f64,
        hidden: Option<usize>,
    ) -> Self {
        let (mut shift, mut turn) = ([0.0; 3], [0.0; 3]);
        match motion {
            Motion::Translation(i) => shift[i] = 1.0,
            Motion::Rotation(i) => turn[i] = 1.0 / length,
        }
        Mode {
            body,
            name: match piece {
                None => motion.to_string(),
                Some(_) => format!("{motion} {BEYOND}"),
            },
            shift,
            turn,
            centre,
            hidden,
            piece,
        }
    }

    /// The velocity of what moves with the body at a place.
    pub fn velocity(&self, x: Vec3) -> Vec3 {
        add(self.shift, cross(self.turn, sub(x, self.centre)))
    }

    /// The angle by which it turns `[rad/m]`.
    pub fn angle(&self) -> f64 {
        norm(self.turn)
    }

    /// Relative motion of a point against the point that it faces: 1 or -1 where one of them moves with the mode, 0 where both do or none does.
    pub fn relative(&self, model: &Model, own: usize, facing: Option<usize>) -> f64 {
        let goes = |point: usize| f64::from(u8::from(self.moves(model, point)));
        goes(own) - facing.map_or(0.0, goes)
    }

    /// Whether a point moves with it.
    fn moves(&self, model: &Model, point: usize) -> bool {
        let body = &model.bodies[self.body];
        match self.piece {
            None => body.points.contains(&point),
            Some(piece) => body.pieces[piece].binary_search(&point).is_ok(),
        }
    }

    /// The rate of a sum of displacements.
    pub fn along(&self, model: &Model, row: &Row) -> f64 {
        let terms = row.terms();
        terms.map(|(dof, a)| a * self.at(model, dof)).sum()
    }

    /// The motion at a dof.
    pub fn at(&self, model: &Model, dof: usize) -> f64 {
        let (point, component) = model.dofs.locate(dof);
        match model.mesh.points.get(point) {
            Some(_) if !self.moves(model, point) => 0.0,
            Some(&x) => self.velocity(x)[component],
            None if self.hidden == Some(dof) => 1.0,
            None => {
                let own = |r: &Reference| r.body == Some(self.body);
                let carried = model.carried(own, |x| self.velocity(x), self.turn);
                let own = carried.into_iter().find(|(d, _)| *d == dof);
                own.map_or(0.0, |(_, moved)| moved)
            }
        }
    }
}

/// What is said of motions of a part that a pretension has cut off.
pub(super) const BEYOND: &str = "beyond the cut";

/// A motion that nothing holds: how much of each mode is in it.
pub(crate) type Unheld = Vec<f64>;

/// Most modes that are looked at together.
const MOST_MODES: usize = 120;

/// What is left of a motion, relative to the stiffest, that counts as held.
const HELD: f64 = 1e-10;

/// Part of a motion below which a mode is no part of it.
pub(crate) const NO_PART: f64 = 1e-6;

/// Points of an interface that are asked, about.
const ASKED: usize = 2000;

/// Least share of the directions of an interface.
const FLAT: f64 = 1e-9;

/// The motions of all bodies, each of size one at the rim of the body.
pub(crate) fn modes(model: &Model) -> Vec<Mode> {
    let axes: (&[usize], &[usize]) = match model.space {
        crate::body::Space::Axisymmetric => (&[1], &[]),
        crate::body::Space::Solid => (&[0, 1, 2], &[0, 1, 2]),
        _ => (&[0, 1], &[2]),
    };
    let mut out = Vec::new();
    for (body, b) in model.bodies.iter().enumerate() {
        if let Some(rigid) = b.rigid {
            let link = &model.links.all()[rigid.link];
            let first = model.mesh.points[link.points.start];
            let centre = link.arms.first().map_or(first, |&arm| sub(first, arm));
            // The axis of symmetry is where the radius is zero.
            let centre = match link.freedom {
                Freedom::Axial | Freedom::Carried => [0.0; 3],
                _ => centre,
            };
            for (dof, motion) in link.motions(model.dofs) {
                let length = link.length;
                out.push(Mode::new(body, None, motion, centre, length, Some(dof)));
            }
            continue;
        }
        let whole: Vec<usize> = b.points.clone().collect();
        let pieces = b.pieces.iter().enumerate();
        let parts = std::iter::once((None, &whole)).chain(pieces.map(|(k, p)| (Some(k), p)));
        for (piece, points) in parts {
            let points = || points.iter().map(|&p| model.mesh.points[p]);
            let sum = points().fold([0.0; 3], add);
            let centre = scale(1.0 / points().count().max(1) as f64, sum);
            let rim = points().map(|x| crate::math::distance(x, centre));
            let rim = rim.fold(f64::MIN_POSITIVE, f64::max);
            let (translations, rotations) = axes;
            let moves = translations.iter().map(|&i| Motion::Translation(i));
            let turns = rotations.iter().map(|&i| Motion::Rotation(i));
            for motion in moves.chain(turns) {
                out.push(Mode::new(body, piece, motion, centre, rim, None));
            }
        }
    }
    out
}

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

    /// Contact along `directions` at the points of an interface, as if all of them had come to touch.
    pub fn interface(&mut self, interface: &Interface, directions: &[Vec3]) {
        let model = self.model;
        let body_of = |point: usize| model.bodies.iter().position(|b| b.points.contains(&point));
        let facing = match &interface.primary {
            Primary::Facets(facets) => facets.first().map(|f| interface.nodes[f.nodes[0]]),
            Primary::Rigid(..) => None,
        };
        let theirs = facing.and_then(body_of);
        let stride = interface.points.len().div_ceil(ASKED).max(1);
        let asked: Vec<_> = interface.points.iter().step_by(stride).collect();
        let weight = 1.0 / asked.len().max(1) as f64;
        for point in asked {
            let own = interface.nodes[point.nodes[0]];
            let ours = body_of(own);
            if ours == theirs {
                continue;
            }
            let x = interface.place(point);
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

impl Scene<'_> {
    /// Motions that neither supports, springs and couplings nor any contact could hold while the interfaces act as they do at `t`. Of contact
    /// the most is believed: that every point of a secondary meets what it faces, that gaps of couplings close, and that friction is as large as need be.
    /// Tied surfaces count without contact too.
    pub(crate) fn unheld(&self, t: f64, modes: &[Mode], contact: bool) -> Vec<Unheld> {
        let model = self.model;
        let count = modes.len();
        if count == 0 || count > MOST_MODES {
            return Vec::new();
        }
        let mut resisted = Resisted {
            model,
            modes,
            gram: vec![vec![0.0; count]; count],
        };
        let held = self.supported(t);
        let held = held.iter().enumerate().filter(|(_, held)| **held);
        held.for_each(|(dof, _)| resisted.dof(dof));
        for &(dof, k) in model.actions.springs.iter().flat_map(|s| s.entries()) {
            if k > 0.0 {
                resisted.dof(dof);
            }
        }
        let couplings = self.couplings();
        let stops = couplings.stops(t).filter(|_| contact);
        for row in couplings.acting(t).chain(stops) {
            let values: Vec<_> = modes
                .iter()
                .map(|m| m.along(model, row))
                .enumerate()
                .collect();
            resisted.row(&values, 1.0);
        }
        let acting = self
            .contact
            .interfaces
            .iter()
            .filter(|i| i.schedule.active(t));
        for interface in acting.filter(|i| contact || i.laws.tied) {
            let directions = directions(interface, t);
            resisted.interface(interface, &directions);
        }
        let (values, vectors) = symmetric_eigen(&resisted.gram);
        let largest = values.last().copied().unwrap_or(0.0).max(f64::MIN_POSITIVE);
        let none = values.iter().enumerate();
        let none = none.filter(|(_, v)| **v <= HELD * largest);
        let none = none.map(|(k, _)| (0..count).map(|i| vectors[i][k]).collect());
        plain(none.collect())
    }
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
        .filter(|(_, v)| **v > FLAT * whole);
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
            let parts = vector.iter().filter(|v| v.abs() > NO_PART).count();
            assert_eq!(parts, 1, "{simple:?}");
        }
    }
}
