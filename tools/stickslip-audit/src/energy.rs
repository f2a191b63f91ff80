//! Energies: those of the bodies by own matrices, the balance of the history with them, and what friction takes.

use crate::balance::ROUNDING;
use crate::bulk::Bulk;
use crate::contact::{Point, at, points};
use crate::external::External;
use crate::figure::Report;
use crate::law::laws;
use crate::results::{Before, Results};
use crate::side::Pair;
use crate::vec3::{Vec3, dot, norm};

/// Own strain energy of each state, springs included.
pub fn strain(results: &Results, bulk: &Bulk, external: &External) -> Vec<f64> {
    let dim = results.case.space.dim();
    let of = |state: &crate::results::State| {
        let force = bulk.elastic(&results.mesh, dim, &state.u);
        let bodies: f64 = force
            .iter()
            .zip(&state.u)
            .map(|(f, u)| 0.5 * dot(*f, *u))
            .sum();
        bodies + external.springs(results, state.t, &state.u).1
    };
    results.states.iter().map(of).collect()
}

/// The energies of all states, and what is in play: the largest that was stored or dissipated.
pub fn check(
    results: &Results,
    bulk: &Bulk,
    external: &External,
    pairs: &[Pair],
    report: &mut Report,
) {
    let own = strain(results, bulk, external);
    let moved = results
        .states
        .iter()
        .flat_map(|s| &s.u)
        .map(|u| norm(*u))
        .fold(0.0, f64::max);
    let rounding = bulk.stiffest() * (ROUNDING * moved).powi(2);
    let largest = own
        .iter()
        .copied()
        .fold(rounding.max(f64::MIN_POSITIVE), f64::max);
    let rows = results.history.rows();
    let at_row = |head: &str, row: usize| results.history.at(head, row);
    let stored = ["ALLSE", "ALLKE", "ALLCE", "ALLFD", "ALLVD", "ALLCD"];
    let play = (0..rows).map(|row| stored.iter().map(|h| at_row(h, row).abs()).sum::<f64>());
    let play = play.fold(f64::MIN_POSITIVE, f64::max).max(largest);
    let largest = largest.max(1e-9 * play);
    let times = results.history.column("TIME").unwrap_or(&[]);
    for (row, t) in times.iter().enumerate() {
        for head in ["ALLFD", "ALLVD", "ALLCD"] {
            let before = if row > 0 { at_row(head, row - 1) } else { 0.0 };
            report.note("backwards", head, (before - at_row(head, row)) / play, *t);
        }
        report.note("growth", "scheme", -at_row("ALLND", row) / play, *t);
        let supplied = at_row("ALLWK", row) + at_row("EINITIAL", row);
        let kept = [
            "ALLKE", "ALLCE", "ALLFD", "ALLVD", "ALLCD", "ALLND", "ALLAE",
        ];
        let kept: f64 = kept.iter().map(|h| at_row(h, row)).sum();
        let strain = match results.states.iter().position(|s| s.row == Some(row)) {
            Some(i) => own[i],
            None => at_row("ALLSE", row),
        };
        report.note(
            "energy",
            "ledger",
            (supplied - kept - strain).abs() / play,
            *t,
        );
    }
    // Of bodies that fly or fall, what their stiffness makes of rounded displacements is left on either side.
    let nodes = results.mesh.points.len() as f64;
    let left = 4.0 * f64::EPSILON * nodes * bulk.stiffest() * moved.powi(2);
    let written = results.states.iter().zip(&own);
    for (state, own) in written.filter(|(state, _)| state.row.is_some()) {
        let off = (results.at("ALLSE", state) - own).abs();
        report.note(
            "strain-energy",
            "bodies",
            (off - left).max(0.0) / largest,
            state.t,
        );
    }
    kinetic(results, bulk, report);
    for pair in pairs.iter().filter(|p| !p.tied && !p.belt && !p.two_sided) {
        dissipation(results, pair, play, report);
    }
}

/// `½ vᵀ M v` where masses are where the mesh has them.
fn kinetic(results: &Results, bulk: &Bulk, report: &mut Report) {
    let dim = results.case.space.dim();
    let explicit = |step: &crate::case::Step| {
        let dynamic = step.table.get("dynamic").and_then(toml::Value::as_table);
        let word = |key: &str| dynamic.and_then(|d| crate::case::text_of(d, key));
        let scheme = dynamic
            .and_then(|d| crate::case::kind(d, "scheme"))
            .map_or("", |s| s.0);
        (
            scheme == "central-difference" || word("mass") == Some("lumped"),
            word("contact-mass") == Some("as-meshed") || scheme == "central-difference",
        )
    };
    let of = |state: &crate::results::State| {
        let step = &results.case.steps[results.case.step_at(state.t)];
        let (lumped, meshed) = explicit(step);
        let rigid = bulk.rigid.iter().any(|r| *r);
        if !step.dynamic() || !meshed || rigid {
            return None;
        }
        let v: Vec<Vec3> = state.grid.vector("V");
        let momentum = bulk.inertia(&results.mesh, dim, &v, lumped);
        Some(
            momentum
                .iter()
                .zip(&v)
                .map(|(p, v)| 0.5 * dot(*p, *v))
                .sum::<f64>(),
        )
    };
    let own: Vec<Option<f64>> = results.states.iter().map(of).collect();
    let largest = own
        .iter()
        .flatten()
        .copied()
        .fold(f64::MIN_POSITIVE, f64::max);
    for (state, own) in results.states.iter().zip(own) {
        if let (Some(own), Some(_)) = (own, state.row) {
            let off = (results.at("ALLKE", state) - own).abs() / largest;
            report.note("kinetic-energy", "bodies", off, state.t);
        }
    }
}

/// Work of friction per area over an increment at a point that slips at its end, at least and at most: along its way the shear is between that at the end and what
/// its limit was at the start, which is nothing where it was open and else goes with the pressure. The files do not say when it began to slide. Under a
/// `smooth` rule a point slips with any shear, that at the start also.
fn taken(before: &Point, now: &Point, smooth: bool) -> [f64; 2] {
    let along = |shear: [f64; 2]| {
        let way = [0, 1].map(|k| now.slip[k] - before.slip[k]);
        (-shear[0] * way[0] - shear[1] * way[1]).max(0.0)
    };
    let end = along(now.shear);
    let start = match before.status {
        0.0 => 0.0,
        _ if smooth => along(before.shear),
        _ => end * before.pressure.max(0.0) / now.pressure,
    };
    [end.min(start), end.max(start)]
}

/// Friction over one increment after the other: what points take at least and at most, times the area that CFORCE and CPRESS give a node.
fn dissipation(results: &Results, pair: &Pair, play: f64, report: &mut Report) {
    let nodes = points(results, pair);
    let quadratic = results.mesh.cells.iter().any(|(kind, _)| kind.quadratic());
    if pair.mortar && quadratic {
        return; // forces of such points are spread over the nodes around: CFORCE has no area
    }
    if pair.points().is_none_or(|p| nodes.len() < p.len()) {
        return;
    }
    let table = &results.tables[&pair.name];
    // Areas from the last state; those of points that are open there are not known.
    let (mut own, mut whole) = ([0.0; 2], true);
    let mut last = vec![Point::default(); results.mesh.points.len()];
    for (i, state) in results.states.iter().enumerate() {
        match results.before(i) {
            None => {
                whole = false;
                break;
            }
            Some(Before::Written(old)) => last = at(old),
            Some(Before::Start) => {}
        }
        let now = at(state);
        let force = pair.gathered(state.grid.vector("CFORCE"));
        let laws = laws(&results.case, &pair.name, results.case.step_at(state.t));
        let smooth = laws.is_some_and(|l| l.epsilon.is_some());
        for node in &nodes {
            let point = now[*node];
            let slips = point.status == 2.0 || smooth;
            if !slips || point.pressure <= 0.0 {
                continue;
            }
            let size = point.pressure.hypot(point.carried());
            let area = norm(force[*node]) / size;
            for (own, taken) in own.iter_mut().zip(taken(&last[*node], &point, smooth)) {
                *own += area * taken;
            }
        }
        let said = results.at(&format!("{}.ALLFD", pair.name), state);
        let off = (said - own[1]).max(own[0] - said).max(0.0);
        report.note("dissipation", &pair.name, off / play, state.t);
    }
    if !whole || table.rows() == 0 {
        report.skip(format!(
            "friction of {} over increments that were not written",
            pair.name
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A point that pressed twice as much before it slid by 1e-3 against a shear of 3, and one that was open.
    #[test]
    fn friction_takes_what_lies_between_both_limits() {
        let at = |status: f64, pressure: f64, slip: f64| Point {
            pressure,
            shear: [-3.0, 0.0],
            slip: [slip, 0.0],
            status,
            ..Point::default()
        };
        let now = at(2.0, 10.0, 1e-3);
        let near = |found: [f64; 2], due: [f64; 2]| {
            assert!(
                found.iter().zip(due).all(|(a, b)| (a - b).abs() < 1e-15),
                "{found:?}"
            );
        };
        near(taken(&at(1.0, 20.0, 0.0), &now, false), [3e-3, 6e-3]);
        near(taken(&at(0.0, 0.0, 0.0), &now, false), [0.0, 3e-3]);
        // Friction gives nothing back.
        near(taken(&at(2.0, 10.0, 2e-3), &now, false), [0.0, 0.0]);
        // Under a smooth rule shear may have risen from anything.
        let before = |shear: f64| Point {
            shear: [shear, 0.0],
            ..at(1.0, 20.0, 0.0)
        };
        near(taken(&before(-1.0), &now, true), [1e-3, 3e-3]);
        near(taken(&before(2.0), &now, true), [0.0, 3e-3]);
    }
}
