//! The motions of bodies without strain: the basis in which all ask who ask what holds a body, what pushes it, and where it goes.

use super::super::definition::{Model, Reference};
use crate::body::couplings::Row;
use crate::body::{RigidMode, Space, rigid_modes};
use crate::math::{Vec3, add, cross, distance, norm, scale, sub};
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
                Some(_) => format!("{motion} {BEYOND_CUT}"),
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
pub(super) const BEYOND_CUT: &str = "beyond the cut";

/// The motions of all bodies, each of size one at the rim of the body.
pub(crate) fn modes(model: &Model) -> Vec<Mode> {
    let axes: (&[usize], &[usize]) = match model.space {
        Space::Axisymmetric => (&[1], &[]),
        Space::Solid => (&[0, 1, 2], &[0, 1, 2]),
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
            let rim = points().map(|x| distance(x, centre));
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

/// The motions of bodies together without strain, over all dofs.
pub(crate) fn together(model: &Model, bodies: &[usize]) -> Vec<RigidMode> {
    if let &[only] = bodies
        && let Some(rigid) = model.bodies[only].rigid
    {
        return motions(model, rigid.link);
    }
    let of = |&b: &usize| model.bodies[b].points.clone();
    let points: Vec<usize> = bodies.iter().flat_map(of).collect();
    let mut modes = rigid_modes(&model.mesh, &points, model.space);
    let centre = centre(model, &points);
    let links = bodies.iter().filter_map(|&b| model.bodies[b].rigid);
    let links: Vec<_> = links.map(|r| &model.links.all()[r.link]).collect();
    for mode in &mut modes {
        let (shift, turn) = shift_and_turn(&mode.name);
        mode.vector.resize(model.dofs.count(), 0.0);
        for link in &links {
            let moved = add(shift, cross(turn, sub(link.centre, centre)));
            for (dof, motion) in link.motions(model.dofs) {
                mode.vector[dof] = match motion {
                    Motion::Translation(i) => moved[i],
                    Motion::Rotation(i) => turn[i] * link.length,
                };
            }
        }
    }
    modes
}

/// The mean of points.
pub(super) fn centre(model: &Model, points: &[usize]) -> Vec3 {
    let sum = points
        .iter()
        .map(|&p| model.mesh.points[p])
        .fold([0.0; 3], add);
    scale(1.0 / points.len().max(1) as f64, sum)
}

/// What a motion of this name does: how it shifts and how it turns.
pub(super) fn shift_and_turn(name: &str) -> (Vec3, Vec3) {
    let unit = |kind: &str| -> Vec3 {
        let axis = name.strip_prefix(kind);
        ["x", "y", "z"].map(|a| f64::from(u8::from(axis == Some(a))))
    };
    (unit("translation "), unit("rotation about "))
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
