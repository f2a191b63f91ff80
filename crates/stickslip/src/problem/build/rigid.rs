//! Rigid bodies: their mass from the mesh, and what is said of their points turned into something said of the bodies.

use super::super::BodyRotation;
use super::fault::problem_error;
use crate::body::{Elastic, Space, moments};
use crate::error::{Diagnostic, Error};
use crate::math::{Mat3, sub, symmetric_eigen};
use crate::model::{Body, Prescribed, Rigid};
use crate::system::{Dofs, Freedom, Link, Links, Motion, Row};
use crate::tolerance::NEGLIGIBLE;

/// Square of the part of a motion that a support may leave out of it, or take of it, without meaning to: a set that misses the centre
/// of mass by `1e-5` of the size of the body counts as lying there.
const SLIGHT_PART: f64 = 1e-10;

/// The link of a rigid body whose hidden points start at `hidden`, and its mass.
pub(super) fn link(
    elastic: &Elastic,
    points: std::ops::Range<usize>,
    hidden: usize,
    index: usize,
    rotation: &BodyRotation,
) -> (Link, Rigid) {
    let moments = moments::mass_moments(elastic);
    let freedom = freedom(elastic.space());
    let x = &elastic.mesh().points[points.clone()];
    let length = moments.radius();
    let inertia = moments.inertia();
    let over = |i: usize, j: usize| inertia[i][j] / (length * length);
    let spin: Mat3 = match freedom {
        Freedom::Space => std::array::from_fn(|i| std::array::from_fn(|j| over(i, j))),
        // one rotation, and dofs that are there but do not move
        _ => [
            [over(2, 2), 0.0, 0.0],
            [0.0, moments.mass, 0.0],
            [0.0, 0.0, moments.mass],
        ],
    };
    let link = Link {
        centre: moments.centre,
        arms: x.iter().map(|&x| sub(x, moments.centre)).collect(),
        points,
        hidden,
        length,
        freedom: match rotation.reference() {
            Some(_) => Freedom::Carried,
            None => freedom,
        },
        framed: !rotation.is_small(),
    };
    let rigid = Rigid {
        link: index,
        mass: moments.mass,
        spin,
    };
    (link, rigid)
}

/// What a rigid body may do in a space.
pub(super) fn freedom(space: Space) -> Freedom {
    match space {
        Space::Axisymmetric => Freedom::Axial,
        Space::PlaneStrain { .. } | Space::PlaneStress { .. } => Freedom::Plane,
        Space::Solid => Freedom::Space,
    }
}

/// What values at some points say of the motions of a rigid body.
struct Fit {
    /// Hidden dof, motion, its value by least squares, and which part of it the points determine: 1 all, 0 nothing.
    motions: Vec<(usize, Motion, f64, f64)>,
    /// Largest difference between a value and what the motions make of it.
    apart: f64,
}

fn fit(link: &Link, dofs: Dofs, rows: &[(Row, f64)]) -> Fit {
    let motions = link.motions(dofs);
    let n = motions.len();
    let place = |dof: usize| motions.iter().position(|(d, _)| *d == dof);
    let mut gram = vec![vec![0.0; n]; n];
    let mut right = vec![0.0; n];
    for (row, value) in rows {
        for (a, fa) in row.iter().filter_map(|&(d, f)| Some((place(d)?, f))) {
            right[a] += fa * value;
            for (b, fb) in row.iter().filter_map(|&(d, f)| Some((place(d)?, f))) {
                gram[a][b] += fa * fb;
            }
        }
    }
    let (values, vectors) = symmetric_eigen(&gram);
    let least = SLIGHT_PART * values.last().copied().unwrap_or(0.0);
    let mut solution = vec![0.0; n];
    let mut part = vec![0.0; n];
    for (k, &value) in values.iter().enumerate().filter(|(_, v)| **v > least) {
        let along: f64 = (0..n).map(|i| vectors[i][k] * right[i]).sum();
        for i in 0..n {
            solution[i] += vectors[i][k] * along / value;
            part[i] += vectors[i][k] * vectors[i][k];
        }
    }
    let moved = |row: &Row| -> f64 {
        let parts = row
            .iter()
            .filter_map(|&(d, f)| Some(f * solution[place(d)?]));
        parts.sum()
    };
    let apart = rows
        .iter()
        .fold(0.0_f64, |m, (row, value)| m.max((moved(row) - value).abs()));
    Fit {
        motions: motions
            .iter()
            .zip(solution.iter().zip(&part))
            .map(|(&(dof, motion), (&value, &part))| (dof, motion, value, part))
            .collect(),
        apart,
    }
}

/// The rigid bodies of a model by name, for messages.
pub(super) struct RigidBodies<'a> {
    pub links: &'a Links,
    pub bodies: &'a [Body],
    pub dofs: Dofs,
}

impl RigidBodies<'_> {
    fn name(&self, link: usize) -> &str {
        self.bodies
            .iter()
            .find(|b| b.rigid.is_some_and(|r| r.link == link))
            .map_or("?", |b| b.name.as_str())
    }

    /// The name of the body that has a hidden dof.
    pub fn of_hidden(&self, dof: usize) -> Option<&str> {
        let point = self.dofs.locate(dof).0;
        Some(self.name(self.links.of_hidden(point)?))
    }

    /// Turns what is prescribed at points of rigid bodies into conditions on their motions.
    pub fn support(
        &self,
        name: &str,
        entries: Vec<Prescribed>,
    ) -> Result<Vec<Prescribed>, Diagnostic> {
        let (bound, mut out) = self.split(entries, |e| e.dof);
        for (index, entries) in bound.iter().enumerate().filter(|(_, e)| !e.is_empty()) {
            let link = &self.links.all()[index];
            let rows: Vec<(Row, f64)> = entries
                .iter()
                .filter_map(|e| Some((self.links.row_at_start(e.dof)?, e.value)))
                .collect();
            let body = self.name(index);
            if link.freedom == Freedom::Carried {
                let message = format!("rigid body `{body}` is carried by a reference point");
                return Err(Diagnostic::new(format!("support.{name}.set"), message)
                    .help("support the reference point"));
            }
            let fit = fit(link, self.dofs, &rows);
            let unclear = |part: f64| part > SLIGHT_PART && part < 1.0 - SLIGHT_PART;
            if let Some((_, motion, ..)) = fit.motions.iter().find(|m| unclear(m.3)) {
                return Err(Diagnostic::new(
                    format!("support.{name}.set"),
                    format!(
                        "the support ties the {motion} of rigid body `{body}` to another of its motions and holds neither on its own"
                    ),
                )
                .help("support the whole body, or a set symmetric to its centre of mass"));
            }
            let largest = rows.iter().fold(0.0_f64, |m, (_, v)| m.max(v.abs()));
            if fit.apart > NEGLIGIBLE * largest {
                return Err(Diagnostic::new(
                    format!("support.{name}"),
                    format!("rigid body `{body}` cannot move like that"),
                )
                .help("around an axis a rigid body moves along y alone"));
            }
            let held = |c: Option<usize>| {
                let mut own = entries
                    .iter()
                    .filter(|e| c.is_none_or(|c| self.dofs.locate(e.dof).1 == c));
                own.all(|e| e.hold)
            };
            for (dof, motion, value, part) in fit.motions {
                if part > 0.5 {
                    let hold = match motion {
                        Motion::Translation(c) => held(Some(c)),
                        Motion::Rotation(_) => held(None),
                    };
                    out.push(Prescribed { dof, value, hold });
                }
            }
        }
        Ok(out)
    }

    /// Turns values at points of rigid bodies into those of their motions.
    pub fn initial(
        &self,
        key: &str,
        values: Vec<(usize, f64)>,
    ) -> Result<Vec<(usize, f64)>, Diagnostic> {
        let (bound, mut out) = self.split(values, |v| v.0);
        for (index, values) in bound.iter().enumerate().filter(|(_, v)| !v.is_empty()) {
            let rows: Vec<(Row, f64)> = values
                .iter()
                .filter_map(|&(dof, value)| Some((self.links.row_at_start(dof)?, value)))
                .collect();
            let body = self.name(index);
            let link = &self.links.all()[index];
            if link.freedom == Freedom::Carried {
                let message = format!("rigid body `{body}` is carried by a reference point");
                return Err(Diagnostic::new(key, message).help("give it to the reference point"));
            }
            let fit = fit(link, self.dofs, &rows);
            if fit.motions.iter().any(|m| m.3 < 0.5) {
                return Err(Diagnostic::new(
                    key,
                    format!("these points do not determine the motion of rigid body `{body}`"),
                )
                .help("give it for the whole body"));
            }
            let largest = rows.iter().fold(0.0_f64, |m, (_, v)| m.max(v.abs()));
            if fit.apart > NEGLIGIBLE * largest {
                return Err(Diagnostic::new(
                    key,
                    format!("the values are no rigid motion of body `{body}`"),
                )
                .help("rotations are linearised: all points move by q + θ × arm, around an axis along y alone"));
            }
            out.extend(fit.motions.iter().map(|&(dof, _, value, _)| (dof, value)));
        }
        Ok(out)
    }

    /// What belongs to each rigid body, and the rest.
    fn split<T>(&self, all: Vec<T>, dof: impl Fn(&T) -> usize) -> (Vec<Vec<T>>, Vec<T>) {
        let mut bound: Vec<Vec<T>> = self.links.all().iter().map(|_| Vec::new()).collect();
        let mut rest = Vec::new();
        for entry in all {
            match self.links.of_point(self.dofs.locate(dof(&entry)).0) {
                Some(link) => bound[link].push(entry),
                None => rest.push(entry),
            }
        }
        (bound, rest)
    }
}

/// The finding as an error.
pub(super) fn refuse<T>(outcome: Result<T, Diagnostic>) -> Result<T, Error> {
    outcome.map_err(|finding| problem_error(vec![finding]))
}
