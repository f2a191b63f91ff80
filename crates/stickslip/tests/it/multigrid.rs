//! Multigrid finds what the sparse factor finds, in a bounded number of iterations.

use crate::support;
use stickslip::newton::Statistics;
use support::problem;

/// Two stacked cubes whose meshes do not match. `ENFORCEMENT` and `SLIDE` are filled in.
const CUBES: &str = r#"
format = 1
model.space = "solid"
body.lower = { generate.box = { to = [1, 1, 1], cells = [7, 7, 7] }, material = "steel" }
body.upper = { generate.box = { from = [0, 0, 1], to = [1, 1, 2], cells = [6, 6, 6] }, material = "steel" }
material.steel.isotropic = { young = 210e9, poisson = 0.3 }

[interface.joint]
roles = "as-named"
secondary = "upper.bottom"
primary = "lower.top"
friction.coulomb.mu = 0.3
discretisation.node-to-facet = {}
ENFORCEMENT

[support]
base = { set = "lower.bottom", x = 0, y = 0, z = 0 }
across = { set = "upper.top", y = 0 }
slide = { set = "upper.top", x = 1.0, amplitude = "slide" }
press = { set = "upper.top", z = -1e-3, amplitude = "press" }

[amplitude]
press.table = [[0, 0], [1, 1]]
slide.table = [[1, 0], [2, SLIDE]]

[[step]]
name = "press"
increments.fixed = 2

[[step]]
name = "slide"
increments.fixed = 2
"#;

/// The displacements at the end, and what they cost.
fn end(text: &str, method: &str) -> (Vec<f64>, Statistics) {
    let mut problem = problem(text);
    problem.solver.method = match method {
        "sparse" => stickslip::model::Solution::Sparse,
        _ => stickslip::model::Solution::Multigrid,
    };
    problem.solver.tolerance = 1e-10;
    problem.output.every = 0;
    let mut simulation = support::build(&problem).unwrap_or_else(|e| panic!("{e}"));
    simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
    // A note on the ledger is none on the way to solve.
    let notes = simulation.summary.notes.iter();
    let others = notes.filter(|n| {
        !n.starts_with("energy balance error") && !n.starts_with("frictional dissipation")
    });
    let others: Vec<&String> = others.collect();
    assert!(others.is_empty(), "{others:?}");
    let solver = simulation.summary.cost.solver;
    (simulation.run.frame.state.u, solver)
}

/// Runs by both, and returns the counts of multigrid.
fn same(name: &str, text: &str, most: usize) -> Statistics {
    let (expected, _) = end(text, "sparse");
    let (found, counts) = end(text, "multigrid");
    let size = expected.iter().fold(0.0, |m: f64, u| m.max(u.abs()));
    let apart = expected.iter().zip(&found);
    let apart = apart.fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
    let each = counts.krylov as f64 / counts.iterations as f64;
    println!("{name}: {apart:.1e} of {size:.1e}, {each:.1} iterations, {counts:?}");
    assert!(
        size > 0.0 && apart < 1e-7 * size,
        "{name}: {apart:e} of {size:e}"
    );
    assert!(
        counts.factorisations == 0 && counts.hierarchies.setups > 0,
        "{counts:?}"
    );
    assert!(each <= most as f64, "{name}: {each} iterations");
    counts
}

#[test]
fn cubes_stick_and_slip() {
    let augmented = "enforcement.augmented-lagrangian = {}";
    let exact = "";
    let penalty = "enforcement.penalty = { stiffness = 1e13, tangential-stiffness = 1e13 }";
    for enforcement in [exact, augmented, penalty] {
        for slide in ["5e-4", "3e-3"] {
            let text = CUBES
                .replace("ENFORCEMENT", enforcement)
                .replace("SLIDE", slide);
            let counts = same(&format!("{enforcement} {slide}"), &text, 30);
            assert_eq!(counts.hierarchies.setups, 1, "{counts:?}");
            let surfaces = text.replace("discretisation.node-to-facet = {}", "");
            same(&format!("mortar {enforcement} {slide}"), &surfaces, 45);
        }
    }
}

/// Points cross several facets: the finest level follows.
#[test]
fn pairs_that_drift_are_followed() {
    let text = CUBES.replace("ENFORCEMENT", "").replace("SLIDE", "0.3");
    let text = text.replace(
        "name = \"slide\"\nincrements.fixed = 2",
        "name = \"slide\"\nincrements.fixed = 6",
    );
    let counts = same("drift", &text, 30);
    assert!(
        counts.hierarchies.setups == 1 && counts.hierarchies.refreshes >= 5,
        "{counts:?}"
    );
}

/// Points between nodes have no gap variables: their stiffness is part of the matrix.
#[test]
fn points_between_nodes() {
    let text = CUBES
        .replace(
            "cells = [7, 7, 7]",
            "cells = [3, 3, 3], element = \"hex20\"",
        )
        .replace(
            "cells = [6, 6, 6]",
            "cells = [2, 2, 2], element = \"hex20\"",
        )
        .replace(
            "ENFORCEMENT",
            "enforcement.penalty = { stiffness = 1e12, tangential-stiffness = 1e12 }",
        )
        .replace("SLIDE", "5e-4");
    same("between nodes", &text, 60);
}

#[test]
fn a_ball_on_a_plane() {
    let text = r#"
        format = 1
        model.space = "axisymmetric"
        body.ball = { generate.half-disc = { radius = 10, symmetric = true, size = 1.5, refine = { finest = 0.1, width = 0.6, growth = 1.3 } }, material = "elastic" }
        material.elastic.isotropic = { young = 1e5, poisson = 0.3 }
        obstacle.floor.plane = { point = [0, -10], normal = [0, 1] }
        interface.contact = { secondary = "ball.arc", primary = "floor" }
        support.symmetry = { set = "ball.axis", x = 0 }
        support.top = { set = "ball.flat", y = -0.01 }
        load.force = { set = "ball.flat", pressure.value = 3.183098861837907 }
        [[step]]
        name = "touch"
        loads = []
        increments.fixed = 1
        [[step]]
        name = "press"
        supports = ["symmetry"]
        increments.fixed = 2
    "#;
    same("ball", text, 40);
}

#[test]
fn a_block_on_a_rough_plane() {
    let text = r#"
        format = 1
        model.space = "plane-strain"
        body.block = { generate.rectangle = { to = [0.04, 0.04], cells = [32, 10] }, material = "steel" }
        material.steel.isotropic = { young = 130e9, poisson = 0.2 }
        obstacle.floor.plane = { point = [0, 0], normal = [0, 1] }
        interface.base = { secondary = "block.bottom", primary = "floor", friction.coulomb.mu = 1.0, enforcement.augmented-lagrangian.error = 1e-8 }
        support.symmetry = { set = "block.right", x = 0 }
        load.top = { set = "block.top", pressure.value = 5e7 }
        load.side = { set = "block.left", pressure.value = 15e7 }
        [[step]]
        increments.fixed = 1
    "#;
    same("block", text, 40);
}

/// The upper cube is held by contact alone.
#[test]
fn a_floating_body_under_a_force() {
    let text = CUBES.replace("ENFORCEMENT", "").replace("SLIDE", "0");
    let (before, after) = text.split_once("across").expect("supports");
    let (_, after) = after.split_once("[[step]]").expect("a step");
    let load = "[load]\npress = { set = \"upper.top\", pressure.value = 1e8 }\n[[step]]";
    let after = after.split_once("[[step]]").expect("two steps").0;
    same("floating", &format!("{before}{load}{after}"), 40);
}

#[test]
fn a_bar_hits_a_wall() {
    let text = r#"
        format = 1
        model = { space = "plane-stress", thickness = 0.02 }
        body.bar = { generate.rectangle = { to = [0.2, 0.02], cells = [80, 8] }, material = "steel" }
        material.steel.isotropic = { young = 2e11, poisson = 0.3, density = 8000 }
        obstacle.wall.plane = { point = [-2e-5, 0], normal = [1, 0] }
        interface.hit = { secondary = "bar.left", primary = "wall", friction.coulomb.mu = 0.2 }
        initial.throw = { set = "bar", velocity = [-10, 1] }
        [[step]]
        duration = 2e-5
        increments.fixed = 10
        dynamic = {}
    "#;
    same("bar", text, 30);
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let text = CUBES.replace("ENFORCEMENT", "").replace("SLIDE", "0.1");
    let [one, four] = [1, 4].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let u = pool
            .build()
            .expect("threads")
            .install(|| end(&text, "multigrid").0);
        u.into_iter().map(f64::to_bits).collect::<Vec<_>>()
    });
    assert!(one == four);
}

#[test]
fn what_nothing_holds_is_singular() {
    let text = CUBES.replace("ENFORCEMENT", "").replace("SLIDE", "0");
    let (before, after) = text.split_once("across").expect("supports");
    let (_, after) = after.split_once("[[step]]").expect("a step");
    let load = "[load]\npull = { set = \"upper.top\", pressure.value = -1e8 }\n[solver]\nmethod = \"multigrid\"\n[[step]]";
    let after = after.split_once("[[step]]").expect("two steps").0;
    let complaint = support::complaint(&format!("{before}{load}{after}"));
    assert!(complaint.contains("there is no equilibrium"), "{complaint}");
}

/// Interfaces that meet at a node, beside axes that supports hold: no answer moves a support.
#[test]
fn supports_stay_where_they_are_where_interfaces_meet() {
    let last = |method: &str| {
        let text = format!(
            r#"format = 1
model.space = "axisymmetric"
solver.method = "{method}"
body.lower = {{ generate.rectangle = {{ from = [0, -0.02], to = [0.02, 0], cells = [4, 5] }}, material = "m" }}
body.upper = {{ generate.rectangle = {{ from = [0, 0], to = [0.02, 0.02], cells = [5, 5] }}, material = "m" }}
body.side = {{ generate.rectangle = {{ from = [0.02, -0.02], to = [0.03, 0.015], cells = [2, 6] }}, material = "m" }}
material.m.isotropic = {{ young = 1.8e7, poisson = 0.3 }}
interface.joint = {{ secondary = "upper.bottom", primary = "lower.top", friction.coulomb.mu = 0.3 }}
interface.low = {{ secondary = "lower.right", primary = "side.left", friction.coulomb.mu = 0.3 }}
interface.up = {{ secondary = "upper.right", primary = "side.left", friction.coulomb.mu = 0.3 }}
support.side = {{ set = "side.right", x = -6e-5, y = 0 }}
support.base = {{ set = "lower.bottom", y = 0 }}
support.axis-lower = {{ set = "lower.left", x = 0 }}
support.axis-upper = {{ set = "upper.left", x = 0 }}
support.press = {{ set = "upper.top", y = -1.5e-4 }}
step = [{{ increments.fixed = 2 }}]
"#
        );
        let record = support::run(&problem(&text)).unwrap_or_else(|e| panic!("{e}"));
        record.increments.last().expect("a row").1.clone()
    };
    let [grids, factor] = ["multigrid", "sparse"].map(last);
    for name in ["base.RF2", "side.RF1", "joint.CFN2", "ALLSE"] {
        let [a, b] = [&grids, &factor].map(|row| row.get(name).expect("a column"));
        assert!((a / b - 1.0).abs() < 1e-6, "{name}: {a} for {b}");
    }
}
