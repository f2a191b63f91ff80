//! Equations and springs between points.

use super::super::Problem;
use super::fault::problem_error;
use super::schedules::Timeline;
use super::sets::Sets;
use std::collections::BTreeSet;

use crate::body::couplings::{Coupling, CouplingKind, Ground, Tie};
use crate::error::{Diagnostic, Error};
use crate::model::Support;
use crate::model::definition::Step;
use crate::system::Links;

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

/// Refuses stops between points whose displacements are all prescribed: where these meet nothing can give way.
pub(super) fn refuse_prescribed_stops(
    couplings: &[Coupling],
    supports: &[Support],
    links: &Links,
    steps: &[Step],
) -> Result<(), Error> {
    let stops = couplings.iter();
    let mut stops = stops.filter(|c| matches!(c.tie, Tie::Gap { .. }) && c.tie.firm());
    let found = stops.find_map(|coupling| {
        let mut acting = steps.iter().filter(|step| {
            let middle = 0.5 * (step.start + step.end);
            coupling.schedule.active(middle)
        });
        acting.find_map(|step| {
            let middle = 0.5 * (step.start + step.end);
            let active = supports.iter().filter(|s| s.schedule.active(middle));
            let held: BTreeSet<usize> =
                (active.flat_map(|s| s.entries.iter().map(|e| e.dof))).collect();
            let prescribed = |dof: usize| match links.row_at_start(dof) {
                Some(row) => (row.iter()).all(|(own, a)| *a == 0.0 || held.contains(own)),
                None => held.contains(&dof),
            };
            let mut rows = coupling.rows.iter();
            let given = rows.any(|row| row.terms().all(|(dof, _)| prescribed(dof)));
            given.then_some((coupling, step))
        })
    });
    let Some((coupling, step)) = found else {
        return Ok(());
    };
    let message = format!(
        "supports prescribe all displacements of this stop in step {}: nothing can give way where it is met",
        step.name
    );
    let help = "let one of its points be free along its component, leave the coupling out of `couplings` of that step, or give it a `stiffness`";
    let key = format!("coupling.{}.gap.terms", coupling.name);
    Err(problem_error(vec![
        Diagnostic::new(key, message).help(help),
    ]))
}
