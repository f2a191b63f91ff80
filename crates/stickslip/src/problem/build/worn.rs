//! Surfaces that begin as earlier runs have worn them: their points are moved before anything is computed, so that all that follows from coordinates, factors as well, is that of the worn bodies.
//!
//! What a run wears off is added to gaps, to first order. Between two runs the depths become geometry: each point moves into its body along the normal of the surface as it was in that
//! run, and depths count from zero again.

use crate::contact::look;
use std::collections::BTreeMap;
use std::path::Path;

use super::super::Problem;
use super::fault::problem_error;
use super::initial::match_points;
use super::snap::Moves;
use crate::error::{Diagnostic, Error};
use crate::io::vtu;
use crate::math::{Vec3, scale};
use crate::model::Setup;
use crate::number::figure;

/// How many runs surfaces have been worn in, at most.
pub(super) fn rounds(problem: &Problem) -> usize {
    let runs = problem.interface.values().map(|i| i.worn.len());
    runs.max().unwrap_or(0)
}

/// Adds what one of these runs has worn off the surfaces of a setup, which are as they were in it. A point on two interfaces moves once.
///
/// # Errors
/// Those of the files; [`Error::Problem`] where one has no depths, or is of another mesh.
pub(super) fn add_round(
    problem: &Problem,
    folder: &Path,
    round: usize,
    setup: &Setup,
    moves: &mut Moves,
) -> Result<(), Error> {
    let mut moved: BTreeMap<usize, Vec3> = BTreeMap::new();
    for interface in &setup.contact.interfaces {
        let table = problem.interface.get(&interface.name);
        let Some(file) = table.and_then(|t| t.worn.get(round)) else {
            continue;
        };
        let path = folder.join(file);
        let wrong = |message: String| {
            let key = format!("interface.{}.worn", interface.name);
            let help = "name a file `fields_*.vtu` of a run of the same mesh in which the interface wears; of several runs the first one first, each begun from those before it";
            problem_error(vec![Diagnostic::new(key, message).help(help)])
        };
        let fields = vtu::read(&path)?;
        let depths = fields.arrays.get("CWEAR").filter(|a| a.components == 1);
        let Some(depths) = depths else {
            return Err(wrong(format!("{} has no depths CWEAR", path.display())));
        };
        let outward = look::outward(interface);
        let points: Vec<usize> = outward.iter().map(|(p, _)| *p).collect();
        let mesh = &setup.model.mesh;
        let found = match_points(&points, mesh, &fields.points).map_err(|p| {
            let node = mesh.point_ids[p];
            wrong(format!(
                "{} has no point where node {node} is",
                path.display()
            ))
        })?;
        let (mut count, mut largest) = (0, 0.0_f64);
        for ((point, normal), at) in outward.into_iter().zip(found) {
            let depth = depths.values[at];
            if depth.is_finite() && depth != 0.0 {
                count += 1;
                largest = largest.max(depth);
                moved.entry(point).or_insert(scale(-depth, normal));
            }
        }
        moves.notes.push(format!(
            "interface {}: {count} points of the mesh moved into their bodies as worn in {}, by {largest} at most",
            interface.name,
            file.display(),
            largest = figure(largest),
        ));
    }
    moves.add(moved);
    Ok(())
}
