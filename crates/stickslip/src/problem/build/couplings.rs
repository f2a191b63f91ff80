//! Equations and springs between points.

use super::super::Problem;
use super::fault::problem_error;
use super::schedules::Timeline;
use super::sets::Sets;
use crate::body::couplings::{Coupling, CouplingKind, Ground};
use crate::error::Error;

/// The couplings, and of each whether its rows say what the motions of a reference point are.
pub(super) fn build(
    problem: &Problem,
    sets: &Sets,
    ground: Ground,
    timeline: &Timeline,
) -> Result<(Vec<Coupling>, Vec<bool>), Error> {
    let (mut all, mut leads) = (Vec::new(), Vec::new());
    for (name, coupling) in &problem.coupling {
        let model = CouplingKind::as_dyn(&coupling.kind);
        let key = format!(
            "coupling.{name}.{}",
            crate::registry::Family::kind(&coupling.kind)
        );
        let mut points = Vec::new();
        for (below, set) in model.sets() {
            points.push(sets.any_points(set, &format!("{key}.{below}"))?);
        }
        let rows = model.rows(&points, ground);
        let tie = model.tie();
        let amplitude = coupling.amplitude.as_deref();
        leads.push(model.leads());
        all.push(Coupling {
            name: name.clone(),
            rows: rows.map_err(|e| problem_error(vec![e.under(&key)]))?,
            schedule: match &tie {
                // What holds by a multiplier acts or does not.
                firm if firm.firm() => timeline.equation(problem, name, amplitude),
                _ => timeline.spring(problem, name, amplitude),
            },
            tie,
            referred: model.reference().is_some(),
            table: amplitude.is_some(),
        });
    }
    Ok((all, leads))
}
