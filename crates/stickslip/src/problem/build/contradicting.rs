//! Supports that prescribe different displacements for one point.

use std::collections::BTreeMap;

use super::fault::problem_error;
use crate::error::{Diagnostic, Error};
use crate::mesh::{Mesh, geometry};
use crate::model::definition::{Step, Support};
use crate::number::digits;
use crate::system::Dofs;
use crate::tolerance::{ROUNDING, SAME};

/// Refuses supports that prescribe different displacements of one point at the end of a step. In between, supports start from where they find the points.
pub(super) fn refuse(
    supports: &[Support],
    steps: &[Step],
    mesh: &Mesh,
    dofs: Dofs,
) -> Result<(), Error> {
    let rounding = ROUNDING * geometry::diameter(mesh);
    for t in steps.iter().map(|step| step.end) {
        let mut first: BTreeMap<usize, (&Support, f64)> = BTreeMap::new();
        for support in supports.iter().filter(|s| s.schedule.active(t)) {
            let factor = support.schedule.at(t);
            for entry in support.entries.iter().filter(|e| !e.hold) {
                let value = factor * entry.value;
                let &mut (other, was) = first.entry(entry.dof).or_insert((support, value));
                // What the supports of rigid bodies prescribe of their hidden points is rounded.
                if (value - was).abs() <= SAME * value.abs().max(was.abs()) + rounding {
                    continue;
                }
                let (point, component) = dofs.locate(entry.dof);
                let what = match mesh.point_ids.get(point) {
                    Some(id) => format!(
                        "displacements of node {id} in {}: {} and {}",
                        ["x", "y", "z"][component],
                        digits(was, 5),
                        digits(value, 5)
                    ),
                    // Rotations are dofs of a reference point or rigid body, too, times a length.
                    None => "motions of a reference point or rigid body".to_string(),
                };
                let message = format!(
                    "supports {} and {} prescribe different {what} at time {}",
                    other.name,
                    support.name,
                    digits(t, 5),
                );
                let key = format!("support.{}", support.name);
                let finding = Diagnostic::new(key, message).help(
                    "leave the common points out of one of the two sets, or let the supports act in different steps",
                );
                return Err(problem_error(vec![finding]));
            }
        }
    }
    Ok(())
}
