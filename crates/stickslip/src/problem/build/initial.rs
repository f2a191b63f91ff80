//! Initial displacements and velocities.

use std::path::Path;

use super::super::Problem;
use super::fault::problem_error;
use super::rigid::{RigidBodies, refuse};
use super::sets::Sets;
use crate::error::{Diagnostic, Error};
use crate::io::vtu;
use crate::math::{Vec3, add, cross, distance, scale, sub};
use crate::mesh::{Mesh, geometry};
use crate::model::{Initial, Support};
use crate::system::{Dofs, Motion};

fn vec3(v: &[f64]) -> Vec3 {
    std::array::from_fn(|i| v.get(i).copied().unwrap_or(0.0))
}

pub(super) fn build(
    problem: &Problem,
    sets: &Sets,
    mesh: &Mesh,
    rigid: &RigidBodies,
    folder: &Path,
) -> Result<Vec<Initial>, Error> {
    let dofs = rigid.dofs;
    let mut out = Vec::new();
    for (name, initial) in &problem.initial {
        let points = sets.any_points(&initial.set, &format!("initial.{name}.set"))?;
        let by_dof = |value: &dyn Fn(usize) -> Vec3| -> Vec<(usize, f64)> {
            let values = points.iter().flat_map(|&p| {
                let v = value(p);
                (0..dofs.dim).map(move |c| (dofs.of(p, c), v[c]))
            });
            values.collect()
        };
        let displacements = match &initial.displacement {
            Some(u) => by_dof(&|_| vec3(u)),
            None => Vec::new(),
        };
        let spin = match (initial.spin.as_deref(), dofs.dim) {
            (Some([w]), 2) => [0.0, 0.0, *w],
            (Some(w), _) => vec3(w),
            (None, _) => [0.0; 3],
        };
        let place = |p: usize| match rigid.links.of_hidden(p) {
            Some(link) => rigid.links.all()[link].centre,
            None => mesh.points[p],
        };
        let sum = points.iter().fold([0.0; 3], |s, &p| add(s, place(p)));
        let centre = scale(1.0 / points.len().max(1) as f64, sum);
        let v0 = vec3(initial.velocity.as_deref().unwrap_or_default());
        let velocities = if initial.velocity.is_some() || initial.spin.is_some() {
            let mut all = by_dof(&|p| add(v0, cross(spin, sub(place(p), centre))));
            let references = points.iter().filter_map(|&p| rigid.links.of_hidden(p));
            for link in references.map(|i| &rigid.links.all()[i]) {
                let turn = |(dof, motion)| match motion {
                    Motion::Rotation(axis) => Some((dof, spin[axis] * link.length)),
                    Motion::Translation(_) => None,
                };
                all.extend(link.motions(dofs).into_iter().filter_map(turn));
            }
            all
        } else {
            Vec::new()
        };
        let (displacements, velocities) = match &initial.result {
            Some(_) if points[0] >= mesh.points.len() => {
                let message = "a reference point is in no result file";
                return Err(problem_error(vec![Diagnostic::new(
                    format!("initial.{name}.result"),
                    message,
                )]));
            }
            Some(file) => from_result(name, &folder.join(file), &points, mesh, dofs)?,
            None => (displacements, velocities),
        };
        let step = problem.step.iter().position(|s| match &initial.step {
            Some(wanted) => s.name.as_ref() == Some(wanted),
            None => s.dynamic.is_some(),
        });
        let of_bodies = |what: &str, values: ByDof| {
            let key = match &initial.result {
                Some(_) => format!("initial.{name}.result"),
                None if what == "velocity" && initial.velocity.is_none() => {
                    format!("initial.{name}.spin")
                }
                None => format!("initial.{name}.{what}"),
            };
            refuse(rigid.initial(&key, values))
        };
        out.push(Initial {
            name: name.clone(),
            displacements: of_bodies("displacement", displacements)?,
            velocities: of_bodies("velocity", velocities)?,
            step: step.unwrap_or(0),
        });
    }
    Ok(out)
}

type ByDof = Vec<(usize, f64)>;

/// Displacements and velocities of these points from a result file, matched by their coordinates.
fn from_result(
    name: &str,
    path: &Path,
    points: &[usize],
    mesh: &Mesh,
    dofs: Dofs,
) -> Result<(ByDof, ByDof), Error> {
    let key = format!("initial.{name}.result");
    let fields = vtu::read(path)?;
    let found = match_points(points, mesh, &fields.points).map_err(|p| {
        let x: Vec<String> = mesh.points[p][..dofs.dim]
            .iter()
            .map(f64::to_string)
            .collect();
        problem_error(vec![
            Diagnostic::new(
                &key,
                format!(
                    "{} has no point at ({}), where node {} is",
                    path.display(),
                    x.join(", "),
                    mesh.point_ids[p]
                ),
            )
            .help("the result must come from the same mesh"),
        ])
    })?;
    let take = |array: &str| -> Option<ByDof> {
        let a = fields.arrays.get(array).filter(|a| a.components == 3)?;
        let mut out = Vec::new();
        for (&p, &at) in points.iter().zip(&found) {
            for c in 0..dofs.dim {
                out.push((dofs.of(p, c), a.values[3 * at + c]));
            }
        }
        Some(out)
    };
    let Some(displacements) = take("U") else {
        return Err(problem_error(vec![
            Diagnostic::new(&key, format!("{} has no displacements U", path.display()))
                .help("name a file fields_*.vtu of an earlier run"),
        ]));
    };
    // A quasi-static result has no velocities: the bodies start from rest.
    Ok((displacements, take("V").unwrap_or_default()))
}

/// For every point the index of the one at the same place, or the first that has none.
pub(super) fn match_points(
    points: &[usize],
    mesh: &Mesh,
    others: &[Vec3],
) -> Result<Vec<usize>, usize> {
    let reach = 1e-6 * geometry::diameter(mesh);
    let mut order: Vec<usize> = (0..others.len()).collect();
    order.sort_by(|&a, &b| others[a][0].total_cmp(&others[b][0]));
    points
        .iter()
        .map(|&p| {
            let x = mesh.points[p];
            if others.get(p).is_some_and(|&o| distance(o, x) <= reach) {
                return Ok(p);
            }
            let first = order.partition_point(|&i| others[i][0] < x[0] - reach);
            order[first..]
                .iter()
                .copied()
                .take_while(|&i| others[i][0] <= x[0] + reach)
                .find(|&i| distance(others[i], x) <= reach)
                .ok_or(p)
        })
        .collect()
}

/// A point that is supported moves as its support says.
pub(super) fn agree_with_supports(
    problem: &Problem,
    initials: &[Initial],
    supports: &[Support],
    mesh: &Mesh,
    rigid: &RigidBodies,
) -> Result<(), Error> {
    let mut findings = Vec::new();
    let mut starts = vec![0.0];
    for step in &problem.step {
        starts.push(starts[starts.len() - 1] + step.duration);
    }
    for initial in initials {
        let largest = initial
            .velocities
            .iter()
            .fold(0.0_f64, |m, (_, v)| m.max(v.abs()));
        let (start, end) = (starts[initial.step], starts[initial.step + 1]);
        let soon = start + 1e-6 * (end - start);
        for support in supports.iter().filter(|s| s.schedule.active(soon)) {
            let rate = (support.schedule.at(soon)
                - support.schedule.at(start + 1e-9 * (end - start)))
                / (soon - start - 1e-9 * (end - start));
            let wrong: Vec<usize> = support
                .entries
                .iter()
                .filter(|e| {
                    let wanted = if e.hold { 0.0 } else { rate * e.value };
                    initial
                        .velocities
                        .iter()
                        .any(|(dof, v)| *dof == e.dof && (v - wanted).abs() > 1e-6 * largest)
                })
                .map(|e| e.dof)
                .collect();
            let Some(&first) = wrong.first() else {
                continue;
            };
            let (point, component) = rigid.dofs.locate(first);
            let place = match rigid.of_hidden(first) {
                Some(body) => format!("in {} motions of rigid body `{body}`", wrong.len()),
                None if point >= mesh.points.len() => "at the reference point".into(),
                None => format!(
                    "at {} points; the first is node {} of {}",
                    wrong.len(),
                    mesh.point_ids[point],
                    ["x", "y", "z"][component]
                ),
            };
            findings.push(
                Diagnostic::new(
                    format!("initial.{}.velocity", initial.name),
                    format!(
                        "the velocity does not agree with support `{}` {place}",
                        support.name
                    ),
                )
                .help("leave supported points out of the set, or give the support the motion by an amplitude"),
            );
        }
    }
    if findings.is_empty() {
        Ok(())
    } else {
        Err(problem_error(findings))
    }
}
