//! Balance in motion: the equation of each scheme at nodes whose mass is where the mesh has it.

use crate::bulk::Bulk;
use crate::case::{Step, kind, number, text_of};
use crate::external::External;
use crate::figure::Report;
use crate::results::{Results, State};
use crate::vec3::{Vec3, add, along, norm, scale, sub};

/// `α_m` and `α_f` of Chung and Hulbert 1993 (eq. 17 and 25), with Newmark's β and γ.
fn alphas(step: &Step) -> Option<[f64; 4]> {
    let dynamic = step.table.get("dynamic")?.as_table()?;
    let (name, keys) = kind(dynamic, "scheme")?;
    let of = |key: &str, default: f64| number(keys, key).unwrap_or(default);
    let (am, af) = match name {
        "generalised-alpha" => {
            let rho = of("rho", 0.9);
            ((2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0))
        }
        // Hilber, Hughes and Taylor 1977: forces are weighed by 1 + α.
        "hht" => (0.0, -of("alpha", -0.05)),
        "newmark" => return Some([0.0, 0.0, of("beta", 0.25), of("gamma", 0.5)]),
        _ => return None,
    };
    let difference = am - af;
    Some([am, af, 0.25 * (1.0 - difference).powi(2), 0.5 - difference])
}

/// Nodes that are neither supported, nor in contact, nor of rigid bodies, nor near points whose mass was moved.
fn free_nodes(
    results: &Results,
    bulk: &Bulk,
    external: &External,
    step: &Step,
    state: &State,
) -> Option<Vec<bool>> {
    let dynamic = step.table.get("dynamic")?.as_table()?;
    let redistributed = match text_of(dynamic, "contact-mass") {
        Some(word) => word == "redistributed",
        None => {
            let explicit = kind(dynamic, "scheme").is_some_and(|s| s.0 == "central-difference");
            let unilateral =
                |t: &toml::Table| kind(t, "normal").is_none_or(|n| n.0 == "unilateral");
            !explicit
                && results
                    .case
                    .named("interface")
                    .iter()
                    .any(|(_, t)| unilateral(t))
        }
    };
    if redistributed {
        return None;
    }
    let (contact, reaction) = (state.grid.vector("CFORCE"), state.grid.vector("RF"));
    let [pressure, pull] = ["CPRESS", "TNORMAL"].map(|name| state.grid.scalar(name));
    let mut free: Vec<bool> = (0..state.u.len())
        .map(|i| {
            let there = !pressure[i].is_nan() || !pull[i].is_nan();
            let loaded = contact[i] != [0.0; 3] || reaction[i] != [0.0; 3] || there;
            !loaded && !bulk.rigid[results.mesh.body[i]]
        })
        .collect();
    for ((node, _), _) in external
        .couplings
        .iter()
        .flat_map(|c| c.rows.iter().flatten())
    {
        free[*node] = false;
    }
    for (name, support) in results.case.named("support") {
        let set = text_of(support, "set").and_then(|s| results.mesh.set(&results.case, s));
        match set {
            Some(set) => set.into_iter().for_each(|p| free[p] = false),
            None if step.lists("supports", name) => return None,
            None => {}
        }
    }
    Some(free)
}

/// Checks a state of a dynamic step against the one before.
pub fn check(
    results: &Results,
    bulk: &Bulk,
    external: &External,
    i: usize,
    step: &Step,
    largest: f64,
    report: &mut Report,
) {
    let state = &results.states[i];
    let Some(free) = free_nodes(results, bulk, external, step, state) else {
        return report.skip("balance in motion where masses are moved".into());
    };
    let (mesh, dim) = (&results.mesh, results.case.space.dim());
    let dynamic = step.table.get("dynamic").and_then(toml::Value::as_table);
    let scheme = dynamic.and_then(|d| kind(d, "scheme")).map_or("", |s| s.0);
    let lumped = scheme == "central-difference"
        || dynamic.and_then(|d| text_of(d, "mass")) == Some("lumped");
    let inner = |s: &State| -> Vec<Vec3> {
        let elastic = bulk.elastic(mesh, dim, &s.u);
        let damping = bulk.damping(mesh, dim, &s.grid.vector("V"), lumped);
        let loads = external.at(results, s.t);
        let springs = external.springs(results, s.t, &s.u).0;
        let all = elastic.iter().zip(damping).zip(loads).zip(springs);
        all.map(|(((e, d), l), k)| sub(add(*e, d), add(l, k)))
            .collect()
    };
    let inertia = |s: &State| bulk.inertia(mesh, dim, &s.grid.vector("A"), lumped);
    let mut check = |rest: Vec<Vec3>| {
        let free = rest.iter().zip(&free).filter(|(_, free)| **free);
        let worst = free.map(|(r, _)| norm(*r)).fold(0.0, f64::max);
        report.note("motion", "bodies", worst / largest, state.t);
    };
    if scheme == "central-difference" {
        // Damping is of the velocity half an increment before: without it the balance holds at the end.
        if bulk.rayleigh.iter().all(|r| *r == [0.0; 2]) {
            let rest = inertia(state)
                .into_iter()
                .zip(inner(state))
                .map(|(m, f)| add(m, f));
            check(rest.collect());
        }
        return;
    }
    let (Some([am, af, beta, gamma]), Some(crate::results::Before::Written(old))) =
        (alphas(step), results.before(i))
    else {
        return;
    };
    if old.t < step.start - 1e-9 * step.end || (old.t - step.start).abs() <= 1e-9 * step.end {
        return; // the state at the start of a step has no acceleration of this step
    }
    // Contact of masses with what does not give way is an impulse: it is in no acceleration, with a full mass matrix moves all nodes, and changes
    // velocities after damping has seen them.
    let interfaces = results.case.named("interface");
    let hard = |t: &toml::Table| {
        kind(t, "normal").is_none_or(|n| n.0 == "unilateral")
            && kind(t, "enforcement").is_none_or(|e| e.0 != "penalty")
    };
    let impulses = interfaces.iter().any(|(_, t)| hard(t));
    let parts = inertia(state)
        .into_iter()
        .zip(inertia(old))
        .zip(inner(state))
        .zip(inner(old));
    let rest = parts.map(|(((m1, m0), f1), f0)| {
        let mass = add(scale(1.0 - am, m1), scale(am, m0));
        add(mass, add(scale(1.0 - af, f1), scale(af, f0)))
    });
    if !impulses || bulk.rayleigh.iter().all(|r| *r == [0.0; 2]) {
        check(rest.collect());
    }
    if impulses {
        return report.skip("integration where masses meet what does not give way".into());
    }
    let dt = state.t - old.t;
    let (v0, a0, a1) = (
        old.grid.vector("V"),
        old.grid.vector("A"),
        state.grid.vector("A"),
    );
    let v1 = state.grid.vector("V");
    let reach = state
        .u
        .iter()
        .map(|u| norm(*u))
        .fold(f64::MIN_POSITIVE, f64::max);
    for p in (0..state.u.len()).filter(|p| free[*p]) {
        let mut u = along(old.u[p], dt, v0[p]);
        u = along(u, dt * dt * (0.5 - beta), a0[p]);
        u = along(u, dt * dt * beta, a1[p]);
        let v = along(along(v0[p], dt * (1.0 - gamma), a0[p]), dt * gamma, a1[p]);
        let off = norm(sub(u, state.u[p])).max(dt * norm(sub(v, v1[p])));
        report.note("integration", "bodies", off / reach, state.t);
    }
}
