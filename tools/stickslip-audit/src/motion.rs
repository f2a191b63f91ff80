//! Whether supports hold what they promise, and whether the motion is one that linear elasticity can have.

use crate::case::{number, text_of};
use crate::figure::Report;
use crate::results::{Results, State};
use crate::vec3::{Vec3, add, cross, dot, norm, scale, sub};

/// Checks all states.
pub fn check(results: &Results, report: &mut Report) {
    let size = results.mesh.size(None);
    for (i, state) in results.states.iter().enumerate() {
        let sound = state.u.iter().flatten().all(|u| u.is_finite());
        report.note("finite", "U", f64::from(u8::from(!sound)), state.t);
        // What turns by any angle is held in a frame of its own.
        let turns = |body: &str| {
            let keys = results.case.of("body", body);
            keys.is_some_and(|k| k.contains_key("rotation"))
        };
        let turning = results.mesh.names.iter().any(|name| turns(name));
        if turning {
            report.skip("supports and rotations of bodies that turn by any angle".into());
        } else {
            supports(results, i, size, report);
        }
        let way = state.u.iter().map(|u| norm(*u)).fold(0.0, f64::max);
        report.note("way", "model", way / size, state.t);
        for body in (0..results.mesh.names.len()).filter(|_| !turning) {
            let angle = rotation(results, state, body);
            report.note("rotation", &results.mesh.names[body], angle, state.t);
        }
    }
    for (head, column) in &results.history.columns {
        let sound = column.iter().all(|x| x.is_finite());
        report.note("finite", head, f64::from(u8::from(!sound)), 0.0);
    }
}

fn supports(results: &Results, i: usize, size: f64, report: &mut Report) {
    let (case, state) = (&results.case, &results.states[i]);
    let step = case.step_at(state.t);
    for (name, support) in case.named("support") {
        let (factor, acts) = case.support_factor(name, support, state.t);
        let set = text_of(support, "set").and_then(|s| results.mesh.set(case, s));
        let (true, Some(set)) = (acts, set) else {
            continue;
        };
        // One that begins later leads from where the points are then.
        let first = case
            .steps
            .iter()
            .position(|s| s.lists("supports", name))
            .unwrap_or(0);
        let joined = step > 0 && !case.steps[step - 1].lists("supports", name);
        let led = joined && text_of(support, "amplitude").is_none();
        if led || (first < step && !(first..=step).all(|s| case.steps[s].lists("supports", name))) {
            continue;
        }
        for (axis, key) in ["x", "y", "z"].into_iter().enumerate() {
            let Some(value) = number(support, key) else {
                continue;
            };
            // A later step that began with a way of its own has reached the value at its end.
            let due = if first > 0 && text_of(support, "amplitude").is_none() {
                value
            } else {
                factor * value
            };
            let off = set
                .iter()
                .map(|p| (state.u[*p][axis] - due).abs())
                .fold(0.0, f64::max);
            report.note("support", name, off / size, state.t);
        }
    }
}

/// The rotation that fits the displacements of a body best: `I ω = Σ r × u` with the moments of inertia of its points.
fn rotation(results: &Results, state: &State, body: usize) -> f64 {
    let mesh = &results.mesh;
    if results.case.space == crate::case::Space::Ring {
        return 0.0; // a turned ring is no ring
    }
    let points: Vec<usize> = mesh.of_body(body).into_iter().collect();
    let mean = |values: &[Vec3]| {
        let sum = points.iter().fold([0.0; 3], |s, p| add(s, values[*p]));
        scale(1.0 / points.len().max(1) as f64, sum)
    };
    let (centre, shift) = (mean(&mesh.points), mean(&state.u));
    let (mut turn, mut inertia) = ([0.0; 3], [[0.0; 3]; 3]);
    for p in &points {
        let (r, u) = (sub(mesh.points[*p], centre), sub(state.u[*p], shift));
        turn = add(turn, cross(r, u));
        for i in 0..3 {
            inertia[i][i] += dot(r, r);
            for j in 0..3 {
                inertia[i][j] -= r[i] * r[j];
            }
        }
    }
    if results.case.space.dim() == 2 {
        return (turn[2] / inertia[2][2].max(f64::MIN_POSITIVE)).abs();
    }
    let minor = |r: usize, s: usize, p: usize, q: usize| {
        inertia[r][p] * inertia[s][q] - inertia[r][q] * inertia[s][p]
    };
    let det: f64 = (0..3)
        .map(|b| inertia[0][b] * minor(1, 2, (b + 1) % 3, (b + 2) % 3))
        .sum();
    let angle: Vec3 = std::array::from_fn(|a| {
        let column = |b: usize| minor((b + 1) % 3, (b + 2) % 3, (a + 1) % 3, (a + 2) % 3) / det;
        (0..3).map(|b| column(b) * turn[b]).sum()
    });
    norm(angle)
}
