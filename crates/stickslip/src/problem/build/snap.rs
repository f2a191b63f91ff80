//! Points of secondary surfaces that are moved onto the primary before anything is computed.

use std::collections::BTreeMap;

use super::super::Problem;
use crate::contact::interface::{Interface, Start};
use crate::error::Error;
use crate::math::{Vec3, add, norm};
use crate::mesh::Mesh;

/// By which vectors points of the mesh are to be moved, and a note for each interface that asks for it.
#[derive(Debug, Default)]
pub(super) struct Moves {
    pub points: BTreeMap<usize, Vec3>,
    pub notes: Vec<String>,
}

/// What the interfaces ask for. A point on two of them follows the first.
pub(super) fn moves(problem: &Problem, interfaces: &[Interface], start: f64) -> Moves {
    let mut moves = Moves::default();
    for interface in interfaces {
        let table = problem.interface.get(&interface.name);
        if table.is_none_or(|t| t.initial != Start::Snap) {
            continue;
        }
        let (mut count, mut largest) = (0, 0.0_f64);
        for (point, by) in interface.snaps(start) {
            count += 1;
            largest = largest.max(norm(by));
            moves.points.entry(point).or_insert(by);
        }
        moves.notes.push(format!(
            "interface {}: {count} points of the mesh moved onto the primary, by {largest:.3e} at most",
            interface.name
        ));
    }
    moves
}

/// Moves the points.
///
/// # Errors
/// A cell that is turned inside out.
pub(super) fn apply(moves: &Moves, mesh: &mut Mesh) -> Result<(), Error> {
    if moves.points.is_empty() {
        return Ok(());
    }
    for (&point, &by) in &moves.points {
        mesh.points[point] = add(mesh.points[point], by);
    }
    mesh.check().map_err(|mut e| {
        e.message = format!("after points were moved onto a primary: {}", e.message);
        e.help = Some(
            "give a smaller `initial-tolerance` or `initial-distance`, or `initial = \"offset\"`"
                .into(),
        );
        e.into()
    })
}
