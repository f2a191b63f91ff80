//! Points of secondary surfaces that are moved onto the primary before anything is computed.

use std::collections::BTreeMap;

use super::super::Problem;
use crate::contact::interface::{Interface, Start};
use crate::contact::look;
use crate::error::Error;
use crate::math::{Vec3, add as add_vectors, norm};
use crate::mesh::{Mesh, check};
use crate::number::figure;

/// By which vectors points of the mesh are to be moved, and a note for each interface that asks for it.
#[derive(Debug, Clone, Default)]
pub(super) struct Moves {
    pub points: BTreeMap<usize, Vec3>,
    pub notes: Vec<String>,
}

/// Adds what the interfaces ask for; whether one does. A point on two of them follows the first.
pub(super) fn add(
    problem: &Problem,
    interfaces: &[Interface],
    start: f64,
    moves: &mut Moves,
) -> bool {
    let mut snapped: BTreeMap<usize, Vec3> = BTreeMap::new();
    let mut asked = false;
    for interface in interfaces {
        let table = problem.interface.get(&interface.name);
        if table.is_none_or(|t| t.initial != Start::Snap) {
            continue;
        }
        asked = true;
        let (mut count, mut largest) = (0, 0.0_f64);
        for (point, by) in look::snaps(interface, start) {
            count += 1;
            largest = largest.max(norm(by));
            snapped.entry(point).or_insert(by);
        }
        moves.notes.push(format!(
            "interface {}: {count} points of the mesh moved onto the primary, by {largest} at most",
            interface.name,
            largest = figure(largest)
        ));
    }
    moves.add(snapped);
    asked
}

impl Moves {
    /// Adds some to those that there are.
    pub(super) fn add(&mut self, moved: BTreeMap<usize, Vec3>) {
        for (point, by) in moved {
            let sum = self.points.entry(point).or_default();
            *sum = add_vectors(*sum, by);
        }
    }
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
        mesh.points[point] = add_vectors(mesh.points[point], by);
    }
    check::check(mesh).map_err(|mut e| {
        e.message = format!("after points of surfaces were moved: {}", e.message);
        e.help = Some(
            "give a smaller `initial-tolerance` or `initial-distance`, or `initial = \"offset\"`; where surfaces are `worn`, cells higher than they are worn deep"
                .into(),
        );
        e.into()
    })
}
