//! Balance at every node: `K u = loads + RF + CFORCE` at rest; in motion see [`crate::inertia`].

use crate::bulk::Bulk;
use crate::case::text_of;
use crate::external::External;
use crate::figure::Report;
use crate::inertia;
use crate::results::{Results, State};
use crate::vec3::{Vec3, add, cross, norm, scale, sub};

/// The largest force on a node in the whole run, what forces are compared with: at least what rounding makes of displacements.
pub fn largest_force(results: &Results, bulk: &Bulk, external: &External) -> f64 {
    let dim = results.case.space.dim();
    let most = |forces: &[Vec3]| forces.iter().map(|f| norm(*f)).fold(0.0, f64::max);
    let of = |state: &State| {
        let elastic = most(&bulk.elastic(&results.mesh, dim, &state.u));
        let contact = most(&state.grid.vector("CFORCE"));
        let reaction = most(&state.grid.vector("RF"));
        let moved = most(&state.u);
        let rounding = ROUNDING * bulk.stiffest() * moved;
        elastic
            .max(contact)
            .max(reaction)
            .max(most(&external.at(results, state.t)))
            .max(rounding)
    };
    results
        .states
        .iter()
        .map(of)
        .fold(f64::MIN_POSITIVE, f64::max)
}

/// Forces below this part of stiffness times displacement, and energies below its square, are rounding.
pub const ROUNDING: f64 = 1e-6;

/// Balance of all states.
pub fn check(results: &Results, bulk: &Bulk, external: &External, report: &mut Report) {
    let largest = largest_force(results, bulk, external);
    for (i, state) in results.states.iter().enumerate() {
        let step = &results.case.steps[results.case.step_at(state.t)];
        match step.dynamic() {
            false => at_rest(results, bulk, external, state, largest, report),
            true => inertia::check(results, bulk, external, i, step, largest, report),
        }
        equations(results, external, state, report);
    }
}

fn at_rest(
    results: &Results,
    bulk: &Bulk,
    external: &External,
    state: &State,
    largest: f64,
    report: &mut Report,
) {
    let mesh = &results.mesh;
    let elastic = bulk.elastic(mesh, results.case.space.dim(), &state.u);
    let (contact, reaction) = (state.grid.vector("CFORCE"), state.grid.vector("RF"));
    let loads = external.at(results, state.t);
    let springs = external.springs(results, state.t, &state.u).0;
    let mut rest: Vec<Vec3> = (0..state.u.len())
        .map(|i| {
            let outer = add(add(loads[i], springs[i]), add(contact[i], reaction[i]));
            sub(elastic[i], outer)
        })
        .collect();
    external.without_released(results, state, &mut rest);
    external.without_equations(&mut rest);
    for (body, name) in mesh.names.iter().enumerate() {
        let points = mesh.of_body(body);
        if !bulk.rigid[body] {
            let worst = points.iter().map(|p| norm(rest[*p])).fold(0.0, f64::max);
            report.note("equilibrium", name, worst / largest, state.t);
            continue;
        }
        if crate::lone::supported(&results.case, mesh, &points) {
            report.skip(format!(
                "reactions of {name}, which is rigid: the fields have none"
            ));
            continue;
        }
        let sum = points.iter().fold([0.0; 3], |s, p| add(s, rest[*p]));
        let gross: f64 = points.iter().map(|p| norm(rest[*p])).sum();
        if results.case.space == crate::case::Space::Ring {
            report.note(
                "rigid-balance",
                name,
                sum[1].abs() / gross.max(largest),
                state.t,
            );
            continue;
        }
        report.note(
            "rigid-balance",
            name,
            norm(sum) / gross.max(largest),
            state.t,
        );
        let places = state.places();
        let centre = points.iter().fold([0.0; 3], |s, p| add(s, places[*p]));
        let centre = scale(1.0 / points.len() as f64, centre);
        let turn = |s: Vec3, p: &usize| add(s, cross(sub(places[*p], centre), rest[*p]));
        let moment = points.iter().fold([0.0; 3], turn);
        let size = mesh.size(Some(body));
        report.note(
            "rigid-moment",
            name,
            norm(moment) / (gross.max(largest) * size),
            state.t,
        );
    }
}

fn equations(results: &Results, external: &External, state: &State, report: &mut Report) {
    let most = |s: &State| {
        s.u.iter()
            .map(|u| norm(*u))
            .fold(f64::MIN_POSITIVE, f64::max)
    };
    // Where all loads are gone displacements are what tolerances leave of those before.
    let before = results.states.iter().map(most).fold(0.0, f64::max);
    let largest = most(state).max(1e-6 * before);
    for coupling in external.couplings.iter().filter(|c| c.stiffness.is_none()) {
        let Some(table) = results.case.of("coupling", &coupling.name) else {
            continue;
        };
        let step = results.case.step_at(state.t);
        // From the second step on values hold where no amplitude says otherwise; the way there is not followed.
        if !results.case.steps[step].lists("couplings", &coupling.name)
            || results.case.steps[step].end > state.t * (1.0 + 1e-9)
        {
            continue;
        }
        let factor =
            text_of(table, "amplitude").map_or(1.0, |a| results.case.amplitude(a, state.t));
        for row in &coupling.rows {
            let sum: f64 = row.iter().map(|((n, i), f)| f * state.u[*n][*i]).sum();
            report.note(
                "coupling",
                &coupling.name,
                (sum - factor * coupling.value).abs() / largest,
                state.t,
            );
        }
    }
}
