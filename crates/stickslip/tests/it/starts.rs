//! What becomes of the gaps that meshes have when an interface begins to act.

use crate::support;
use std::path::Path;

use stickslip::run::Simulation;

/// Two blocks, the upper one too high or too low by `gap`, pressed by a displacement or held.
fn blocks(gap: f64, press: f64, initial: &str) -> String {
    format!(
        r#"
format = 1
model.space = "plane-strain"
body.lower = {{ generate.rectangle = {{ to = [1, 1], cells = [6, 6] }}, material = "soft" }}
body.upper = {{ generate.rectangle = {{ from = [0, 1], to = [1, 2], cells = [6, 6] }}, translate = [0, {gap:?}], material = "soft" }}
material.soft.isotropic = {{ young = 1000.0, poisson = 0.0 }}
support.base = {{ set = "lower.bottom", x = 0, y = 0 }}
support.top = {{ set = "upper.top", x = 0, y = {press:?} }}
interface.joint = {{ secondary = "upper.bottom", primary = "lower.top", {initial} }}
step = [{{ increments.fixed = 4 }}]
"#
    )
}

fn run(text: &str) -> Simulation {
    let model = support::problem(text).build(Path::new("."));
    let simulation = model.and_then(Simulation::new);
    let mut simulation = simulation.unwrap_or_else(|e| panic!("{e}"));
    let outcome = simulation.run(&mut []);
    outcome.unwrap_or_else(|e| panic!("{e}"));
    simulation
}

fn force(text: &str) -> f64 {
    run(text).summary.last["joint.CFN2"]
}

fn near(a: f64, b: f64, tolerance: f64) {
    assert!(
        (a - b).abs() <= tolerance * b.abs().max(1e-12),
        "{a:e} instead of {b:e}"
    );
}

/// Without lateral contraction the two blocks are a bar of length 2: a shortening by `d` needs `500 d`.
#[test]
fn an_offset_closes_gaps_and_forgets_overlaps() {
    for gap in [5e-3, -5e-3] {
        near(
            force(&blocks(gap, -0.01, "initial = \"offset\"")),
            5.0,
            2e-2,
        );
    }
    // as meshed the gap has to be closed first
    near(
        force(&blocks(5e-3, -0.01, "initial = \"as-meshed\"")),
        2.5,
        2e-2,
    );
    // beyond the tolerance a gap is a gap
    let far = "initial = \"offset\", initial-tolerance = 1e-3";
    near(force(&blocks(5e-3, -0.01, far)), 2.5, 2e-2);
}

#[test]
fn snapped_points_lie_on_the_primary() {
    let text = blocks(5e-3, -0.01, "initial = \"snap\"");
    let simulation = run(&text);
    near(simulation.summary.last["joint.CFN2"], 5.0, 2e-2);
    let notes = simulation.summary.notes.join("\n");
    assert!(
        notes.contains("7 points of the mesh moved onto the primary, by 0.005"),
        "{notes}"
    );
    let mesh = &simulation.model.mesh;
    let on = mesh
        .points
        .iter()
        .filter(|x| (x[1] - 1.0).abs() < 1e-12)
        .count();
    assert_eq!(on, 14);
}

#[test]
fn a_snap_that_turns_a_cell_inside_out_is_refused() {
    let text = blocks(
        -0.12,
        -0.01,
        "initial = \"snap\", initial-tolerance = 100.0",
    )
    .replace(
        "cells = [6, 6] }, translate",
        "cells = [6, 12] }, translate",
    );
    let built = support::problem(&text).build(Path::new("."));
    let message = match built {
        Err(e) => e.to_string(),
        Ok(_) => panic!("built"),
    };
    assert!(
        message.contains("after points of surfaces were moved"),
        "{message}"
    );
}

#[test]
fn overlap_is_resolved_over_the_step() {
    let text = blocks(-0.01, 0.0, "initial = \"ramp\"");
    let mut record = support::Record::default();
    let model = support::problem(&text).build(Path::new("."));
    let mut simulation = model
        .and_then(Simulation::new)
        .unwrap_or_else(|e| panic!("{e}"));
    let outcome = simulation.run(&mut [&mut record]);
    outcome.unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(record.increments.len(), 4);
    // An overlap that is meant is no reason to mend the mesh.
    let said = support::build(&support::problem(&text)).map(|mut s| s.check().findings);
    assert_eq!(said.unwrap_or_else(|e| panic!("{e}")), Vec::new());
    for (k, (_, row)) in record.increments.iter().enumerate() {
        let column = row
            .names
            .iter()
            .position(|n| n == "joint.CFN2")
            .expect("a column");
        let part = (k + 1) as f64 / 4.0;
        near(row.values[column], 5.0 * part, 2e-2);
    }
    // what the overlap puts in is in the bodies, and the ledger knows
    let summary = &simulation.summary;
    assert!(
        summary.balance.energy_quality.met,
        "{:?}",
        summary.balance.energy
    );
    assert!(
        summary.balance.energy.residual.abs() < 1e-6 * summary.balance.energy.strain,
        "{:?}",
        summary.balance.energy
    );
    // the same at the end as at once
    near(
        force(&text),
        force(&blocks(-0.01, 0.0, "initial = \"as-meshed\"")),
        1e-6,
    );
}

/// Two equal bars that meet with the speed `v` press each other with `p = ρ c v / 2` until the wave comes back. A penalty lets it grow as
/// `p (1 - exp(-t / τ))`, `τ = ρ c / (2 k)`: each side yields by `p / (ρ c)`, the springs between them by `p' / k`.
#[test]
fn an_explicit_step_knows_the_start_as_well() {
    let (young, density, speed, penalty, time) = (1000.0_f64, 1.0, 0.1, 2e3, 5e-3);
    let impact = |initial: &str| {
        let initial = format!(
            "initial = \"{initial}\", initial-distance = 6e-3, enforcement.penalty = {{ stiffness = {penalty:e} }}"
        );
        let text = blocks(5e-3, -0.01, &initial)
            .replace("poisson = 0.0 }", &format!("poisson = 0.0, density = {density:?} }}"))
            .replace("cells = [6, 6]", "cells = [2, 60]")
            .replace("support.top", "#support.top")
            .replace(
                "step = [{ increments.fixed = 4 }]",
                &format!("initial.fall = {{ set = \"upper\", velocity = [0, {:?}] }}\nstep = [{{ duration = {time:?}, dynamic = {{ scheme.central-difference = {{}} }} }}]", -speed),
            );
        force(&text)
    };
    let impedance = density * (young / density).sqrt();
    let rise = 1.0 - (-time * 2.0 * penalty / impedance).exp();
    near(impact("offset"), 0.5 * impedance * speed * rise, 5e-2);
    // The gap as it is meshed takes ten times as long to close.
    assert_eq!(impact("as-meshed"), 0.0);
}

/// Only the points of a set are moved, and only within a distance.
#[test]
fn a_snap_may_be_of_some_points_and_within_a_distance() {
    let moved = |initial: &str| {
        let text = blocks(5e-3, -0.01, &format!("initial = \"snap\", {initial}"))
            + "set.half = { of = \"upper\", box = { from = [-1, 0], to = [0.55, 3] } }\n";
        let simulation = run(&text);
        let notes = simulation.summary.notes.join("\n");
        let count = notes.split(" points of the mesh moved").next();
        let count = count.and_then(|n| n.rsplit(' ').next());
        count.and_then(|n| n.parse::<usize>().ok())
    };
    assert_eq!(moved("initial-set = \"half\""), Some(4));
    assert_eq!(moved("initial-distance = 0.006"), Some(7));
    assert_eq!(moved("initial-distance = 0.004"), Some(0));
}

#[test]
fn a_snap_within_a_distance_takes_overlaps_away() {
    // Deeper than the distance, which is one of gaps.
    let simulation = run(&blocks(
        -0.02,
        -0.01,
        "initial = \"snap\", initial-distance = 0.001",
    ));
    near(simulation.summary.last["joint.CFN2"], 5.0, 3e-2);
}

#[test]
fn tied_surfaces_are_glued_up_to_a_distance() {
    // Two bars of length 1 in series, pulled; what is too far apart carries nothing.
    for (gap, key, wanted) in [
        (0.05, "initial-distance = 0.06", 5.0),
        (0.05, "initial-distance = 0.04", 0.0),
        (0.5, "initial-distance = 0.6", 5.0),
        (0.05, "initial-tolerance = 0.4", 5.0),
        (0.05, "initial-tolerance = 0.2", 0.0),
    ] {
        let text = blocks(
            gap,
            0.01,
            &format!("tied = true, kinematics.small-sliding = {{}}, {key}"),
        );
        let found = run(&text).summary.last["joint.CFN2"];
        assert!((found + wanted).abs() < 1e-6, "{key}: {found}");
    }
}
