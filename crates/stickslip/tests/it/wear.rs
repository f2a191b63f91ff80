//! What sliding leaves on both sides: dissipated energy and wear against closed forms, and fields that are uniform where they should be.

use crate::support;
use stickslip::results::fields;
use stickslip::run::Simulation;

const PRESSURE: f64 = 40.0;
const SLIP: f64 = 0.05;
const MU: f64 = 0.25;
/// Slip of the step in which sliding begins. The shear is at its limit all the time that the block slides: under a constant pressure what rubs is the path.
const BEGIN: f64 = 1e-3;
const PATH: f64 = BEGIN + SLIP;
const RUBBED: f64 = PATH;

/// A block that is pressed on another, held across and with a mesh of its own, whose surface moves by `SLIP` in the last step: the pressure
/// is that of the load everywhere, and the shear `MU` times that. It begins to slide in the step before.
fn belt(dim: usize, element: &str) -> Simulation {
    let block = |from: &str, to: &str, cells: &str, element: &str| match dim {
        2 => format!(
            "generate.rectangle = {{ from = [{from}], to = [{to}], cells = [{cells}]{element} }}"
        ),
        _ => {
            format!("generate.box = {{ from = [{from}], to = [{to}], cells = [{cells}]{element} }}")
        }
    };
    let (space, lower, upper, across, belt) = match dim {
        2 => (
            "plane-strain",
            block("0, 0", "1, 1", "4, 1", ""),
            block("0, 1", "1, 2", "3, 2", element),
            "x = 0.0",
            format!(
                "[1, 0, 0], [1.5, 2e-3, 0], [2, 0, 0], [2.5, {}, 0], [3, 0, 0]",
                2.0 * SLIP
            ),
        ),
        _ => (
            "solid",
            block("0, 0, 0", "1, 1, 1", "4, 4, 1", ""),
            block("0, 0, 1", "1, 1, 2", "3, 3, 1", element),
            "x = 0.0, y = 0.0",
            format!(
                "[1, 0, 0, 0], [1.5, 2e-3, 0, 0], [2, 0, 0, 0], [2.5, {}, 0, 0], [3, 0, 0, 0]",
                2.0 * SLIP
            ),
        ),
    };
    let fixed = if dim == 2 {
        "x = 0.0, y = 0.0"
    } else {
        "x = 0.0, y = 0.0, z = 0.0"
    };
    let text = format!(
        r#"format = 1
model.space = "{space}"
body.lower = {{ {lower}, material = "soft" }}
body.upper = {{ {upper}, material = "soft" }}
material.soft.isotropic = {{ young = 1e4, poisson = 0.3 }}
support.lower = {{ set = "lower", {fixed} }}
support.upper = {{ set = "upper", {across} }}
load.press = {{ set = "upper.top", pressure.value = {PRESSURE} }}
step = [{{ name = "press", increments = {{ fixed = 1 }} }}, {{ name = "begin", increments = {{ fixed = 1 }} }}, {{ name = "slide", increments = {{ fixed = 4 }} }}]
[interface.joint]
secondary = "upper.bottom"
primary = "lower.top"
friction.coulomb = {{ mu = {MU} }}
enforcement.augmented-lagrangian = {{ error = 1e-9 }}
wear = {{ coefficient = 1e-6, primary-coefficient = 3e-6 }}
primary-velocity-table = [{belt}]
"#
    );
    let mut simulation = support::build(&support::problem(&text)).unwrap_or_else(|e| panic!("{e}"));
    simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
    simulation
}

/// Values of a field at the nodes of a body that lie in the interface, and have one.
fn on(simulation: &Simulation, body: usize, name: &str) -> Vec<f64> {
    let all = fields(&simulation.view());
    let field = all.get(name).unwrap_or_else(|| panic!("no field {name}"));
    let points = simulation.model.bodies[body].points.clone();
    let values = field.values[points].iter().copied();
    values.filter(|v| !v.is_nan()).collect()
}

fn uniform(values: &[f64], expected: f64, what: &str) {
    assert!(values.len() > 2, "{what}: {values:?}");
    for v in values {
        assert!(
            (v / expected - 1.0).abs() < 1e-4,
            "{what}: {v} for {expected}"
        );
    }
}

#[test]
fn a_block_that_slides_under_pressure_wears_and_dissipates_as_the_laws_say_on_both_sides() {
    for (dim, element) in [
        (2, ""),
        (2, ", element = \"quad8\""),
        (3, ""),
        (3, ", element = \"hex20\""),
        (3, ", element = \"tet10\""),
    ] {
        let simulation = belt(dim, element);
        let what = format!("{dim}D {element}");
        for body in 0..2 {
            let what = format!("{what}, body {body}");
            uniform(&on(&simulation, body, "CPRESS"), PRESSURE, &what);
            uniform(
                &on(&simulation, body, "CDISS"),
                MU * PRESSURE * RUBBED,
                &what,
            );
            let k = [3e-6, 1e-6][body];
            uniform(&on(&simulation, body, "CWEAR"), k * PRESSURE * PATH, &what);
        }
        let last = &simulation.summary.last;
        let close = |name: &str, expected: f64| {
            let value = last[name];
            assert!(
                (value / expected - 1.0).abs() < 1e-4,
                "{what}: {name} {value} for {expected}"
            );
        };
        close("joint.CWEARMAX", 3e-6 * PRESSURE * PATH);
        close("joint.CWEARVOL", 4e-6 * PRESSURE * PATH);
        close("joint.ALLFD", MU * PRESSURE * RUBBED);
        close("joint.CAREA", 1.0);
        close("joint.XN1", 0.5);
        close("joint.XN2", if dim == 2 { 1.0 } else { 0.5 });
    }
}

#[test]
fn what_slides_away_leaves_its_trace_where_it_was() {
    let text = r#"format = 1
model.space = "plane-strain"
body.rail = { generate.rectangle = { to = [4, 0.5], cells = [160, 1] }, material = "soft" }
body.slider = { generate.rectangle = { from = [0.5, 0.5], to = [1.5, 1], cells = [50, 2] }, material = "soft" }
material.soft.isotropic = { young = 1e4, poisson = 0.0 }
support.rail = { set = "rail", x = 0.0, y = 0.0 }
support.slider = { set = "slider", x = 2.0 }
load.press = { set = "slider.top", pressure.value = 40 }
step = [{ name = "press", increments = { fixed = 1 }, supports = ["rail", "still"] }, { name = "slide", increments = { fixed = 80 }, supports = ["rail", "slider"] }]
support.still = { set = "slider", x = 0.0 }
[interface.joint]
secondary = "slider.bottom"
primary = "rail.top"
friction.coulomb = { mu = 0.25 }
wear = { coefficient = 1e-6, primary-coefficient = 1e-6 }
"#;
    let mut simulation = support::build(&support::problem(text)).unwrap_or_else(|e| panic!("{e}"));
    simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
    let all = fields(&simulation.view());
    let worn = all.get("CWEAR").expect("wear is followed");
    let pressed = all.get("CPRESS").expect("an interface");
    let at = |x: f64| {
        let points = &simulation.model.mesh.points;
        let near = |p: usize| (points[p][0] - x).abs() < 1e-9 && (points[p][1] - 0.5).abs() < 1e-9;
        let point = simulation.model.bodies[0].points.clone().find(|&p| near(p));
        point.expect("a node of the rail")
    };
    let full = 1e-6 * 40.0;
    // All of the slider, one unit long, has passed over the middle of the rail; it has left where it began. A node is met from a facet
    // before to a facet behind, 0.025 each.
    for (x, depth) in [
        (1.8, 1.0),
        (2.0, 1.0),
        (2.2, 1.0),
        (1.0, 0.5),
        (3.0, 0.5),
        (0.2, 0.0),
        (3.8, 0.0),
    ] {
        let value = worn.values[at(x)];
        assert!((value - full * depth).abs() < 0.08 * full, "{x}: {value}");
    }
    assert!(pressed.values[at(1.0)].is_nan());
    let secondary = simulation.summary.last["joint.CWEARVOL"] / 2.0;
    assert!((secondary / (full * 2.0) - 1.0).abs() < 1e-3, "{secondary}");
}
