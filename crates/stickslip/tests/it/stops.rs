//! Gaps and dashpots between points.

use crate::support;
use support::{Record, problem, run};

fn value(row: &support::Row, name: &str) -> f64 {
    row.get(name).unwrap_or_else(|| panic!("no column {name}"))
}

fn record(text: &str) -> Record {
    run(&problem(text)).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn end(text: &str) -> support::Row {
    record(text).increments.last().expect("a row").1.clone()
}

#[track_caller]
fn near(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{found} is not {expected}: {:e} apart",
        found - expected
    );
}

/// Two bars, each a spring of 250; one is pulled, its end meets that of the other after a clearance.
fn bars(more: &str) -> String {
    format!(
        r#"
format = 1
model.space = "plane-stress"
body.a = {{ generate.rectangle = {{ to = [4, 1], cells = [8, 2] }}, material = "m" }}
body.b = {{ generate.rectangle = {{ from = [0, 3], to = [4, 4], cells = [8, 2] }}, material = "m" }}
material.m.isotropic = {{ young = 1000.0, poisson = 0.0, density = 1.0 }}
support.a = {{ set = "a.left", x = 0 }}
support.b = {{ set = "b.left", x = 0 }}
support.sides = {{ set = "ends", y = 0 }}
set.ends = {{ union = ["a.bottom", "b.bottom"] }}
load.pull = {{ set = "a.right", traction = {{ value = [8, 0] }} }}
probe.a = {{ of = "a", point = [4, 0.5] }}
probe.b = {{ of = "b", point = [4, 3.5] }}
{more}"#
    )
}

/// The end of the other bar opens it.
fn gap(parameters: &str) -> String {
    format!(
        r#"coupling.stop.gap = {{ {parameters}, terms = [
    {{ set = "b.right", component = "x" }},
    {{ set = "a.right", component = "x", factor = -1 }},
] }}
"#
    )
}

#[test]
fn a_gap_passes_force_on_once_it_is_closed_whatever_the_method() {
    for method in ["sparse", "condensed", "multigrid"] {
        for (stiffness, per_end) in [("", f64::INFINITY), (", stiffness = 200.0", 600.0)] {
            let text = bars(&format!(
                "solver.method = \"{method}\"\n{}step = [{{ increments.fixed = 3 }}]\n",
                gap(&format!("clearance = 0.01{stiffness}"))
            ));
            let row = end(&text);
            // 250 a + f = 8, 250 b = f = k (a - b - 0.01); three points at an end.
            let series = 1.0 / (1.0 / 250.0 + 1.0 / per_end);
            let a = (8.0 + series * 0.01) / (250.0 + series);
            let f = series * (a - 0.01);
            // Springs at points do not share a force as a traction does: ends do not stay straight.
            let bent = if stiffness.is_empty() { 1e-6 } else { 1e-2 * f };
            near(value(&row, "stop.F"), -f, bent);
            near(value(&row, "b.RF1"), value(&row, "stop.F"), 1e-6);
            near(value(&row, "a.U1"), a, 2e-2 * a);
            near(
                value(&row, "ERESIDUAL"),
                0.0,
                1e-9 * value(&row, "ALLWK").max(1.0),
            );
        }
    }
}

#[test]
fn an_open_gap_does_nothing_and_a_closed_one_opens_again() {
    let open = end(&bars(
        &(gap("clearance = 0.1") + "step = [{ increments.fixed = 2 }]\n"),
    ));
    near(value(&open, "a.U1"), 0.032, 1e-12);
    near(value(&open, "stop.F"), 0.0, 1e-14);
    let text = bars(
        &(gap("clearance = 0.01")
            + "step = [{ increments.fixed = 2 }, { increments.fixed = 2, loads = [] }]\n"),
    );
    let record = record(&text);
    let rows: Vec<&support::Row> = record.increments.iter().map(|(_, r)| r).collect();
    assert!(value(rows[1], "stop.F") < -2.0);
    let last = rows[rows.len() - 1];
    near(value(last, "a.U1"), 0.0, 1e-12);
    near(value(last, "stop.F"), 0.0, 1e-12);
    near(value(last, "ERESIDUAL"), 0.0, 1e-9);
    // Left out of a step, it lets go.
    let text = bars(
        &(gap("clearance = 0.01")
            + "step = [{ increments.fixed = 2 }, { increments.fixed = 2, couplings = [] }]\n"),
    );
    near(value(&end(&text), "a.U1"), 0.032, 1e-9);
}

#[test]
fn an_overlap_of_a_gap_is_resolved() {
    // Without the load both bars are pushed apart by half of it: 250 a = -250 b.
    let text =
        bars(&(gap("clearance = -0.004") + "step = [{ increments.fixed = 2, loads = [] }]\n"));
    let row = end(&text);
    near(value(&row, "stop.F"), -0.5, 1e-6);
    near(value(&row, "ERESIDUAL"), 0.0, 1e-9);
}

/// Two blocks of mass 2 on rails, one of which is thrown at the other.
fn blocks(more: &str) -> String {
    format!(
        r#"
format = 1
model.space = "plane-stress"
body.a = {{ generate.rectangle = {{ to = [1, 1], cells = [2, 2] }}, material = "m" }}
body.b = {{ generate.rectangle = {{ from = [0, 3], to = [1, 4], cells = [2, 2] }}, material = "m" }}
material.m.isotropic = {{ young = 1000.0, poisson = 0.0, density = 2.0 }}
support.rails = {{ set = "all", y = 0 }}
set.all = {{ union = ["a", "b"] }}
probe.a = {{ of = "a", point = [1, 0.5] }}
probe.b = {{ of = "b", point = [1, 3.5] }}
initial.throw = {{ set = "a", velocity = [1, 0] }}
output.every = 0
{more}"#
    )
}

#[test]
fn a_dashpot_takes_the_energy_of_a_relative_motion() {
    // Nine dashpots of c/9 between two masses of 2: the difference of their velocities decays at the rate c (1/2 + 1/2).
    for (scheme, increments) in [
        ("newmark", "increments.fixed = 100,"),
        ("central-difference", ""),
    ] {
        let (c, t) = (4.0_f64, 0.25);
        let row = end(&blocks(&format!(
            r#"coupling.drag.dashpot = {{ coefficient = {}, terms = [
    {{ set = "a", component = "x" }},
    {{ set = "b", component = "x", factor = -1 }},
] }}
step = [{{ duration = {t}, {increments} dynamic = {{ scheme.{scheme} = {{}} }} }}]
"#,
            c / 9.0
        )));
        let apart = (-c * t).exp();
        let way = (1.0 - apart) / c;
        near(value(&row, "a.U1") - value(&row, "b.U1"), way, 2e-2 * way);
        // The centre goes on at half the speed with an energy of a half; the rest decays as the square.
        near(value(&row, "ALLKE"), 0.5 + 0.5 * apart * apart, 1e-2);
        near(value(&row, "ALLVD"), 0.5 * (1.0 - apart * apart), 1e-2);
        near(value(&row, "ERESIDUAL"), 0.0, 1e-6);
    }
}

#[test]
fn dashpots_do_nothing_at_rest_and_are_strong_without_bounding_an_implicit_increment() {
    let drag = |c: f64| {
        format!(
            r#"coupling.drag.dashpot = {{ coefficient = {c}, terms = [
    {{ set = "a.right", component = "x" }},
] }}
"#
        )
    };
    let row = end(&bars(&(drag(1e6) + "step = [{ increments.fixed = 2 }]\n")));
    near(value(&row, "a.U1"), 0.032, 1e-12);
    let strong = "step = [{ duration = 0.1, increments.fixed = 4, dynamic = {} }]\n";
    let row = end(&bars(&(drag(1e6) + strong)));
    // A hundredth of how far it would have come.
    assert!(value(&row, "a.U1").abs() < 1e-4, "{}", value(&row, "a.U1"));
}

#[test]
fn a_block_strikes_another_over_a_gap_in_explicit_steps() {
    // Equal masses exchange their velocities, but for what rings in the blocks.
    let text = blocks(
        r#"coupling.stop.gap = { clearance = 0.05, terms = [
    { set = "b", component = "x" },
    { set = "a", component = "x", factor = -1 },
] }
step = [{ duration = 0.2, dynamic = { scheme.central-difference = {} } }]
"#,
    );
    let row = end(&text);
    assert!(value(&row, "b.U1") > 0.1, "{}", value(&row, "b.U1"));
    assert!(value(&row, "a.U1") < 0.08, "{}", value(&row, "a.U1"));
    near(value(&row, "ERESIDUAL"), 0.0, 1e-3);
}
