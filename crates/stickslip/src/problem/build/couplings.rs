//! Equations and springs between points.

use super::super::Problem;
use super::fault::problem_error;
use super::schedules::Timeline;
use super::sets::Sets;
use crate::body::couplings::{Coupling, CouplingKind};
use crate::error::Error;
use crate::mesh::Mesh;

pub(super) fn build(
    problem: &Problem,
    sets: &Sets,
    mesh: &Mesh,
    timeline: &Timeline,
) -> Result<Vec<Coupling>, Error> {
    let dim = problem.model.space.dim();
    let mut all = Vec::new();
    for (name, coupling) in &problem.coupling {
        let model = CouplingKind::as_dyn(&coupling.kind);
        let key = format!(
            "coupling.{name}.{}",
            crate::registry::Family::kind(&coupling.kind)
        );
        let mut points = Vec::new();
        for (below, set) in model.sets() {
            points.push(sets.points(set, &format!("{key}.{below}"))?);
        }
        let rows = model.rows(&points, mesh, dim);
        let tie = model.tie();
        let amplitude = coupling.amplitude.as_deref();
        all.push(Coupling {
            name: name.clone(),
            rows: rows.map_err(|e| problem_error(vec![e.under(&key)]))?,
            schedule: match &tie {
                // What holds by a multiplier acts or does not.
                firm if firm.firm() => timeline.equation(problem, name, amplitude),
                _ => timeline.spring(problem, name, amplitude),
            },
            tie,
            table: amplitude.is_some(),
        });
    }
    Ok(all)
}
